//! `slcbeam export`: a result for spreadsheets, pandas, MATLAB and ParaView.

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use serde_json::json;

use crate::case;
use crate::error::{Error, Result};
use crate::output::export::{self, Written, instants, tables, vtk};
use crate::output::folder::CASE;
use crate::output::kind::Kind;
use crate::output::numbers::{counted, significant};

/// `export`.
#[derive(Debug, Args)]
pub struct ExportArguments {
    /// Result folder of a run
    pub dir: PathBuf,
    /// Formats: csv/FIELD.csv with a row an instant and a column a place; vtk/CASE.pvd with beam, bladders and tubes
    #[arg(
        long,
        value_enum,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "csv,vtk"
    )]
    pub format: Vec<Format>,
    /// Only these instants of the fields, in seconds: times and ranges, such as 0.1,0.45:0.5 [default: all]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub times: Option<String>,
    /// Only every so many of these instants
    #[arg(long, value_name = "COUNT", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub every: u32,
    /// Folder in which csv and vtk are made [default: the result folder]
    #[arg(short, long, value_name = "DIR", value_parser = super::line::output_path())]
    pub out: Option<PathBuf>,
    /// Print what was written as JSON
    #[arg(long)]
    pub json: bool,
}

/// Formats of `export`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Tables.
    Csv,
    /// Surfaces.
    Vtk,
}

/// Reads the folder, writes each format asked for, prints where.
pub fn export(asked: &ExportArguments) -> Result<ExitCode> {
    let from = export::read(&asked.dir)?;
    let chosen = instants::choose(&from.field_times, asked.times.as_deref(), asked.every as usize)?;
    let out = asked.out.as_deref().unwrap_or(&asked.dir);
    let elsewhere = fs::canonicalize(out).ok() != fs::canonicalize(&asked.dir).ok();
    if let Some(kind) = Kind::within(out).filter(|_| elsewhere) {
        return Err(Error::Usage(format!(
            "--out {}: it holds the result of `slcbeam {}`, beside which these files would pass for its own; name another folder",
            out.display(),
            kind.command()
        )));
    }
    let mut all: Vec<(&str, Written)> = vec![];
    if asked.format.contains(&Format::Csv) {
        all.push(("csv", tables::write(out, &from, &chosen)?));
    }
    if asked.format.contains(&Format::Vtk) {
        let case = case::load(&asked.dir.join(CASE), &[])?;
        all.push(("vtk", vtk::write(out, &case, &from, &chosen)?));
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
            "{} from {} s to {} s\n",
            counted(times.len() as u64, "instant"),
            significant(first, 6),
            significant(last, 6)
        );
        for (name, w) in &all {
            let size = significant(w.bytes as f64 / 1e6, 3);
            text += &format!(
                "{name}  {}  {}, {size} MB\n",
                w.path.display(),
                counted(w.files as u64, "file")
            );
        }
        super::print(&text)?;
    }
    Ok(ExitCode::SUCCESS)
}
