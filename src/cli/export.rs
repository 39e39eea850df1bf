//! `slcbeam export`: a result for spreadsheets, pandas, MATLAB and ParaView.

use std::process::ExitCode;

use serde_json::json;

use super::arguments::{ExportArguments, Format};
use crate::case;
use crate::error::Result;
use crate::output::export::{self, Written, instants, tables, vtk};
use crate::output::folder::CASE;
use crate::output::numbers::{count, significant};

/// Reads the folder, writes each format asked for, prints where.
pub fn export(asked: &ExportArguments) -> Result<ExitCode> {
    let from = export::read(&asked.dir)?;
    let chosen = instants::choose(&from.field_times, asked.times.as_deref(), asked.every as usize)?;
    let out = asked.out.as_deref().unwrap_or(&asked.dir);
    let mut all: Vec<(&str, Written)> = vec![];
    if asked.format.contains(&Format::Csv) {
        all.push(("csv", tables::write(out, &from, &chosen)?));
    }
    if asked.format.contains(&Format::Vtk) {
        let loaded = case::load(&asked.dir.join(CASE), &[])?;
        all.push(("vtk", vtk::write(out, &loaded.case, &from, &chosen)?));
    }
    let times: Vec<f64> = chosen.iter().map(|&k| from.field_times[k]).collect();
    let (first, last) = (times[0], times[times.len() - 1]);
    if asked.json {
        let formats = all.iter().map(|(name, w)| {
            let about = json!({"path": w.path, "files": w.files, "bytes": w.bytes});
            (name.to_string(), about)
        });
        let formats: serde_json::Map<_, _> = formats.collect();
        let told = json!({"from_s": first, "to_s": last, "instants": times.len(), "formats": formats});
        super::print(&format!("{told:#}\n"))?;
    } else {
        let mut text = format!(
            "{} instants from {} s to {} s\n",
            count(times.len() as u64),
            significant(first, 6),
            significant(last, 6)
        );
        for (name, w) in &all {
            let size = significant(w.bytes as f64 / 1e6, 3);
            text += &format!(
                "{name}  {}  {} files, {size} MB\n",
                w.path.display(),
                count(w.files as u64)
            );
        }
        super::print(&text)?;
    }
    Ok(ExitCode::SUCCESS)
}
