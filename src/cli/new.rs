//! `slcbeam new`: a starting case with remarks, to be changed.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use serde_json::json;

use crate::case::{rewrite, schema_json};
use crate::error::{Result, usage};
use crate::output::folder::replace;

/// Name of the schema file beside a case.
const SCHEMA: &str = "slcbeam.schema.json";

/// `new`.
#[derive(Debug, Args)]
pub struct NewArguments {
    /// Kind of the starting case
    pub kind: StarterCase,
    /// The file; the case is named like it [default: <kind>.json]
    #[arg(value_parser = super::progress_line::output_path())]
    pub file: Option<PathBuf>,
    /// Section of `new section` [default: honeycomb]; the others have one row
    #[arg(long, value_name = "NAME")]
    pub of: Option<SectionKind>,
    /// Write over a file that is there
    #[arg(long)]
    pub force: bool,
    /// Print as JSON which files were written
    #[arg(long)]
    pub json: bool,
}

/// Starting cases: those of the tours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StarterCase {
    /// Bladders joined in a wiring of your own, in a beam that is shaken
    Wiring,
    /// A beam that bends by pumping up one row of bladders
    Actuator,
    /// Two rows of bladders with a turbine between them, under a swinging load
    Harvester,
    /// Sealed bladders whose pressures determine place and size of a load
    Sensor,
    /// A dry beam that is let go
    Beam,
    /// The geometry and material of a beam of your own, from which coefficients are computed: --of
    Section,
}

/// Sections to begin with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SectionKind {
    /// The paper's honeycomb: two rows
    Honeycomb,
    /// A row of chambers over a sheet that hardly stretches
    Pneunet,
    /// A row of round channels in silicone
    Channels,
    /// A chamber between threads, over a sheet that hardly stretches
    Fibre,
}

impl SectionKind {
    fn text(self) -> &'static str {
        match self {
            Self::Honeycomb => include_str!("sections/honeycomb.json"),
            Self::Pneunet => include_str!("sections/pneunet.json"),
            Self::Channels => include_str!("sections/channels.json"),
            Self::Fibre => include_str!("sections/fibre.json"),
        }
    }
}

impl StarterCase {
    fn text(self, of: SectionKind) -> &'static str {
        match self {
            Self::Wiring => include_str!("../../cases/tour-wiring.json"),
            Self::Actuator => include_str!("../../cases/tour-actuator.json"),
            Self::Harvester => include_str!("../../cases/tour-harvester.json"),
            Self::Sensor => include_str!("../../cases/tour-sensor.json"),
            Self::Beam => include_str!("../../cases/tour-beam.json"),
            Self::Section => of.text(),
        }
    }
}

/// Writes the case, named after its file, and the schema beside it. Overwrites an existing case file only with
/// `--force`.
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
    // the name of a case is also that of a folder
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
    let of = asked.of.unwrap_or(SectionKind::Honeycomb);
    if asked.of.is_some() && asked.kind != StarterCase::Section {
        return usage(format!(
            "--of chooses a section, for `new section` only: write slcbeam new section --of NAME, not new {named}"
        ));
    }
    let text = asked.kind.text(of);
    let keys = [("name", name.as_str()), ("$schema", SCHEMA)];
    let text = keys
        .into_iter()
        .try_fold(text.to_owned(), |text, (key, value)| rewrite(&text, key, &value.into()))
        .unwrap_or_default();
    if path.exists() && !asked.force {
        return usage(format!(
            "{} exists and is not overwritten; name another file, slcbeam new {named} FILE, or use --force",
            path.display()
        ));
    }
    replace(&path, &text)?;
    let quoted = if path.to_string_lossy().contains(' ') {
        format!("'{}'", path.display())
    } else {
        path.display().to_string()
    };
    let schema = path.with_file_name(SCHEMA);
    replace(&schema, format!("{:#}\n", schema_json()))?;
    let text = || {
        format!(
            "wrote {quoted}, a starting case with remarks, and {}, by which editors explain its keys\nnext: slcbeam check {quoted}; slcbeam run {quoted}\n",
            schema.display()
        )
    };
    super::answer(asked.json, || json!({"case": path, "schema": schema}), text)
}
