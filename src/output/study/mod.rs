//! Output files of a study, `study.csv`, `study.json` and `study.svg`, and its text.
//!
//! ```text
//! picture  error and time of every run
//! table    for the terminal, and as CSV
//! text     the closing sentence
//! ```

mod picture;
mod table;
mod text;

use super::folder::ResultFolder;
use crate::error::Result;
use crate::results;
use crate::study::accuracy::Study;

pub use picture::{MeshLine, RunMarker, draw, mesh_lines};
pub use table::{csv, table};
pub use text::{sentence, spoken};

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
pub fn write(folder: &mut ResultFolder, study: &Study) -> Result<()> {
    folder.fill([(CSV, csv(study)), (JSON, json(study))], [(PICTURE, draw(study))])
}
