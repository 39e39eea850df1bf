//! `slcbeam new`: a starting case with remarks, to be changed.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use serde_json::json;

use crate::case::{rewrite, schema_json};
use crate::error::{Error, Result};
use crate::output::folder::replace;

/// Name of the schema that is put beside a case.
const SCHEMA: &str = "slcbeam.schema.json";

/// `new`.
#[derive(Debug, Args)]
pub struct NewArguments {
    /// What to begin with
    pub kind: Kind,
    /// The file; the case is named like it [default: <kind>.json]
    pub file: Option<PathBuf>,
    /// Print as JSON which files were written
    #[arg(long)]
    pub json: bool,
}

/// What one can begin with: the cases of the tours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// Bladders joined in a wiring of your own, in a beam that is shaken
    Wiring,
    /// A beam that bends by pumping up one row of bladders
    Actuator,
    /// Two rows of bladders with a turbine between them, under a swinging load
    Harvester,
    /// Sealed bladders whose pressures tell where something presses
    Sensor,
    /// A dry beam that is let go
    Beam,
}

impl Kind {
    fn text(self) -> &'static str {
        match self {
            Self::Wiring => include_str!("../../cases/tour-wiring.json"),
            Self::Actuator => include_str!("../../cases/tour-actuator.json"),
            Self::Harvester => include_str!("../../cases/tour-harvester.json"),
            Self::Sensor => include_str!("../../cases/tour-sensor.json"),
            Self::Beam => include_str!("../../cases/tour-beam.json"),
        }
    }
}

/// Writes the case, named as its file, and the schema beside it; nothing is written over.
pub fn new(asked: &NewArguments) -> Result<ExitCode> {
    let named = asked
        .kind
        .to_possible_value()
        .map_or_else(String::new, |v| v.get_name().to_owned());
    let path = asked
        .file
        .clone()
        .unwrap_or_else(|| PathBuf::from(format!("{named}.json")));
    let stem = path.file_stem().and_then(|s| s.to_str()).unwrap_or(&named);
    // the name of a case is that of a folder
    let name: String = stem
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() || "-_".contains(c) {
                c
            } else {
                '-'
            }
        })
        .collect();
    let text = [("name", name.as_str()), ("$schema", SCHEMA)]
        .into_iter()
        .try_fold(asked.kind.text().to_owned(), |text, (key, value)| {
            rewrite(&text, key, &value.into())
        })
        .unwrap_or_default();
    if path.exists() {
        return Err(Error::Usage(format!(
            "{} is there already and is not written over; give another file: slcbeam new {named} FILE",
            path.display()
        )));
    }
    let schema = path.with_file_name(SCHEMA);
    replace(&path, &text)?;
    replace(&schema, &format!("{:#}\n", schema_json()))?;
    super::print(&if asked.json {
        format!("{:#}\n", json!({"case": path, "schema": schema}))
    } else {
        let quoted = if path.to_string_lossy().contains(' ') {
            format!("'{}'", path.display())
        } else {
            path.display().to_string()
        };
        format!(
            "wrote {quoted}, a starting case with remarks, and {}, by which editors explain its keys\nnext: slcbeam check {quoted}; slcbeam run {quoted}\n",
            schema.display()
        )
    })?;
    Ok(ExitCode::SUCCESS)
}
