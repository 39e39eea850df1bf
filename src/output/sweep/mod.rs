//! Output files of many designs.
//!
//! ```text
//! journal   designs.jsonl: one line per design, safe on disk as soon as it is computed
//! table     sweep.csv: one row per design
//! arrays    sweep.npz: the same numbers
//! warnings  modes that change places between neighboring designs; warnings of designs, counted
//! pictures  sweep.svg, map.svg
//! text      text of many designs
//! script    jobs for Slurm and GNU parallel
//! shards    joins shards
//! ```
//!
//! Rows are read from the journal one by one, in the order of their numbers. Memory contains only the offset of each line.

pub mod arrays;
pub mod journal;
pub mod pictures;
pub mod script;
pub mod shards;
pub mod table;
pub mod text;
mod warnings;

use std::fs;
use std::io::Write as _;
use std::path::PathBuf;

use serde_json::Value;

use super::folder::{REPORT, ResultFolder, entries, fault, name_of, put_whole, result};
use super::kind::FolderKind;
use crate::case::CaseText;
use crate::error::Result;
use crate::results;
use crate::results::sweep::{Sweep, SweepColumn, SweepPlan};
use crate::study::analysis::word;
pub use crate::study::sweep::unit::unit;

pub use super::journal::Journal;
pub use journal::JournalSummary;
pub use warnings::warnings;

/// The requested sweep; exists from the beginning.
pub const PLAN: &str = "plan.json";
/// One line per design.
pub const JOURNAL: &str = "designs.jsonl";
/// Description of the table.
pub const JSON: &str = "sweep.json";
/// The table.
pub const TABLE: &str = "sweep.csv";
/// The table's numbers.
pub const ARRAYS: &str = "sweep.npz";
/// Pictures; only informative ones exist.
pub const PICTURES: [&str; 2] = ["sweep.svg", "map.svg"];
/// Cases of designs, on request.
pub const CASES: &str = "cases";
/// Result folders of designs, on request.
pub const FOLDERS: &str = "designs";

/// Reads the plan of a folder, if it has one.
///
/// # Errors
/// The plan cannot be read.
pub fn plan(folder: &ResultFolder) -> Result<Option<SweepPlan>> {
    let path = folder.path(PLAN);
    if path.exists() {
        result::<SweepPlan>(&path).map(|found| Some(found.result))
    } else {
        Ok(None)
    }
}

/// Prepares a folder for a plan: removes the files of another sweep or command.
///
/// # Errors
/// A file cannot be removed or written.
pub fn begin(folder: &mut ResultFolder, plan: &SweepPlan, first: &CaseText) -> Result<()> {
    if FolderKind::within(folder.dir()) == Some(FolderKind::Designs) {
        for name in [CASES, FOLDERS] {
            remove_numbered(folder.path(name))?;
        }
    }
    folder.clear()?;
    for name in FolderKind::Designs.files() {
        folder.remove(name)?;
    }
    folder.write_case(first)?;
    folder.write(PLAN, results::text(plan).as_bytes())?;
    folder.secure()
}

/// Removes files and folders of designs of another sweep; others stay.
fn remove_numbered(dir: PathBuf) -> Result<()> {
    if !dir.is_dir() {
        return Ok(());
    }
    for path in entries(&dir)? {
        let name = name_of(&path);
        let stem = name.strip_suffix(".json").unwrap_or(&name);
        if stem.is_empty() || !stem.bytes().all(|b| b.is_ascii_digit()) {
            continue;
        }
        let gone = if path.is_dir() {
            fs::remove_dir_all(&path)
        } else {
            fs::remove_file(&path)
        };
        gone.map_err(|e| fault("remove", &path, e))?;
    }
    // removes only an empty folder
    let _ = fs::remove_dir(&dir);
    Ok(())
}

/// Name of the case or folder of a design.
pub fn numbered(plan: &SweepPlan, number: usize) -> String {
    let width = plan.designs.to_string().len().max(5);
    format!("{number:0width$}")
}

/// Stores the case of a design under a name.
///
/// # Errors
/// The case cannot be written.
pub fn keep_case(folder: &ResultFolder, name: &str, case: &CaseText) -> Result<()> {
    let dir = folder.path(CASES);
    fs::create_dir_all(&dir).map_err(|e| fault("create", &dir, e))?;
    for (table, text) in &case.tables {
        let path = dir.join(table);
        // designs share tables, whose names contain their checksums
        if !path.exists() {
            put_whole(&path, |file| file.write_all(text.as_bytes()))?;
        }
    }
    put_whole(&dir.join(format!("{name}.json")), |file| {
        file.write_all(case.json.as_bytes())
    })
}

/// Description of the table of all existing rows, with warnings.
///
/// # Errors
/// The journal cannot be read.
pub fn summarize(plan: &SweepPlan, survey: &JournalSummary) -> Result<Sweep> {
    Ok(Sweep {
        warnings: warnings(plan, survey)?,
        ..about(plan, survey)
    })
}

/// Writes table, arrays and their description for all existing rows; then pictures, unless `lean`.
///
/// # Errors
/// A file cannot be read or written.
pub fn write(
    folder: &ResultFolder,
    plan: &SweepPlan,
    survey: &JournalSummary,
    sweep: &Sweep,
    lean: bool,
) -> Result<()> {
    table::write(folder, plan, survey, &sweep.columns)?;
    arrays::write(folder, plan, survey, &sweep.columns)?;
    folder.write(JSON, results::text(sweep).as_bytes())?;
    let drawn = if lean { vec![] } else { pictures::draw(plan, survey)? };
    for name in PICTURES {
        match drawn.iter().find(|(own, _)| *own == name) {
            Some((_, picture)) => folder.write(name, picture.as_bytes()).map(|_| ())?,
            None => folder.remove(name)?,
        }
    }
    if lean {
        folder.remove(REPORT)?;
    }
    folder.secure()
}

/// Description of the table of these rows, without warnings.
pub fn about(plan: &SweepPlan, survey: &JournalSummary) -> Sweep {
    let (rows, expected) = (survey.count(), plan.share());
    let statuses = survey
        .statuses
        .iter()
        .map(|(status, count)| (word(*status).to_owned(), *count));
    Sweep {
        case: plan.case.clone(),
        plan: plan.clone(),
        complete: rows == expected,
        rows,
        missing: expected.saturating_sub(rows),
        statuses: statuses.collect(),
        columns: columns(plan, survey),
        warnings: vec![],
    }
}

/// Columns of the table.
fn columns(plan: &SweepPlan, survey: &JournalSummary) -> Vec<SweepColumn> {
    let mut used = std::collections::BTreeSet::new();
    let mut column = |name: &str, unit: &str, text: bool| {
        let plain: String = name
            .trim_start_matches('/')
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
            .collect();
        let mut array = plain.clone();
        let mut k = 2;
        while !text && !used.insert(array.clone()) {
            array = format!("{plain}_{k}");
            k += 1;
        }
        SweepColumn {
            name: name.into(),
            array: (!text).then_some(array),
            unit: unit.into(),
        }
    };
    let mut all = vec![column("design", "1", false), column("case", "", true)];
    // the case as its index in the list, the status as its code
    all[1].array = Some("case".into());
    all.extend(
        plan.axes
            .iter()
            .map(|axis| column(&axis.pointer, "as in the case", false)),
    );
    all.push(column("status", "", false));
    all.push(column("reason", "", true));
    all.extend(survey.figures.iter().map(|name| column(name, unit(name), false)));
    all.push(column("warnings", "", true));
    all.push(column("steps", "1", false));
    all.push(column("wall_s", "s", false));
    all
}

/// A varied value as a number; `None` if it is not a number.
pub fn numeric(value: &Value) -> Option<f64> {
    value
        .as_f64()
        .or_else(|| value.as_bool().map(|b| f64::from(u8::from(b))))
}
