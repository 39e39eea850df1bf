//! Output files of a study, `study.csv`, `study.json` and `study.svg`, and its text.
//!
//! ```text
//! table  for the terminal, and as CSV
//! text   the closing sentence
//! ```

mod table;
mod text;

use std::path::PathBuf;

use super::folder::ResultFolder;
use super::plot::workprecision::{self, BalanceMark, MeshLine, RunMarker, WorkPrecision};
use crate::error::Result;
use crate::results;
use crate::study::accuracy::Study;

pub use table::{csv, table};
pub use text::sentence;

/// One row per setting and measure.
pub const CSV: &str = "study.csv";
/// Complete result.
pub const JSON: &str = "study.json";
/// Error and time.
pub const PICTURE: &str = "study.svg";

/// Text of `study.json`; numbers that are not finite are null.
pub fn json(study: &Study) -> String {
    results::text_with(study, Some(&sentence(study)))
}

/// Writes the files into a folder; other files in it stay.
pub fn write(folder: &mut ResultFolder, study: &Study) -> Result<Vec<PathBuf>> {
    let picture = picture(study).and_then(|data| workprecision::draw(&data));
    let mut files = vec![(CSV, csv(study)), (JSON, json(study))];
    files.extend(picture.map(|text| (PICTURE, text)));
    folder.fill(files)
}

/// Data of the picture; `None` if nothing could be compared.
pub fn picture(study: &Study) -> Option<WorkPrecision> {
    let measure = study.measure()?;
    let mut lines = vec![];
    for &scheme in &study.plan.schemes {
        for &cells in &study.plan.cells {
            let markers = study.line(cells, scheme).into_iter().filter_map(|k| {
                let trial = &study.points[k].trial;
                let error = study.error(k)?;
                Some(RunMarker {
                    error: error.total.max,
                    temporal: error.temporal.map(|e| e.max),
                    least_s: trial.wall_min_s,
                    median_s: trial.wall_median_s,
                    rtol: trial.setting.rtol,
                    judged: error.judged,
                    front: study.points[k].on_front,
                })
            });
            let balance = study.balances.iter().find(|b| (b.cells, b.scheme) == (cells, scheme));
            lines.push(MeshLine {
                cells,
                scheme,
                markers: markers.collect(),
                balance: balance.map(|b| BalanceMark {
                    error: b.at.error,
                    seconds: b.at.cost,
                }),
            });
        }
    }
    let repeats = study.points.iter().map(|p| p.trial.repeats).max().unwrap_or(1);
    Some(WorkPrecision {
        case: study.case.clone(),
        measure: text::spoken(&measure.name),
        own: measure.own().max,
        repeats,
        lines,
        split: study.references.len() > 1,
    })
}
