//! `slcbeam export`: a result for spreadsheets, pandas, MATLAB and ParaView; a case as a state-space model or as an FMU.

mod fmu;
mod state_space;

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use serde_json::{Map, Value, json};

use crate::case;
use crate::cli::progress_line;
use crate::error::{Result, usage};
use crate::output::export::{self, ExportedFiles, instants, tables, vtk};
use crate::output::folder::CASE;
use crate::output::kind::FolderKind;
use crate::output::numbers::{counted, significant};

/// `export`.
#[derive(Debug, Args)]
pub struct ExportArguments {
    /// Result folder of a run; a case with --state-space or --fmu
    pub dir: PathBuf,
    /// Write a case as an FMU for co-simulation (FMI 3.0, Linux x86-64) to this file
    #[arg(long, value_name = "FILE", group = "model", conflicts_with_all = ["format", "times", "every", "out"], value_parser = progress_line::output_path())]
    pub fmu: Option<PathBuf>,
    /// Write the state-space model of small motions of a case, matrices A, B, C and D, to this file: .npz, .mat or .json
    #[arg(long, value_name = "FILE", group = "model", conflicts_with_all = ["format", "times", "every", "out"], value_parser = progress_line::output_path())]
    pub state_space: Option<PathBuf>,
    /// Change a value of the case first; repeatable
    #[arg(long = "set", value_name = "POINTER=JSON", requires = "model")]
    pub sets: Vec<String>,
    /// Write over a file that is there
    #[arg(long, requires = "model")]
    pub force: bool,
    /// Its input, as that of `response`; for an FMU repeatable, with the range of values [default range: that of the signal in the case]
    #[arg(long, value_name = "POINTER[=LOW,HIGH]", requires = "model")]
    pub input: Vec<String>,
    /// Its outputs, as those of `response`; for an FMU any columns of the history [default: all]
    #[arg(long, value_name = "NAME", requires = "model", value_delimiter = ',')]
    pub output: Vec<String>,
    /// The state about which, as that of `response`
    #[arg(long, value_name = "SECONDS", requires = "model", allow_hyphen_values = true, value_parser = progress_line::instant)]
    pub at: Option<f64>,
    /// Write a reduced model of small motions: the smallest found whose error is at most this fraction of the amplitude, or of its median over
    /// the band
    #[arg(long, value_name = "FRACTION", requires = "model", allow_negative_numbers = true, value_parser = progress_line::ratio)]
    pub error: Option<f64>,
    /// First frequency of the reduced model [Hz]; its static gain is exact too
    #[arg(long, value_name = "HZ", default_value_t = 0.01, requires = "error", allow_negative_numbers = true, value_parser = progress_line::frequency)]
    pub from: f64,
    /// Last frequency of the reduced model [Hz]
    #[arg(long, value_name = "HZ", default_value_t = 200.0, requires = "error", allow_negative_numbers = true, value_parser = progress_line::frequency)]
    pub to: f64,
    /// Omit the self-test of the model, which compares it with the nonlinear equations
    #[arg(long, requires = "model")]
    pub no_self_test: bool,
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
    #[arg(short, long, value_name = "DIR", value_parser = progress_line::output_path())]
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

/// Reads the folder, writes each requested format, prints the paths.
pub fn export(asked: &ExportArguments) -> Result<ExitCode> {
    if let Some(file) = &asked.state_space {
        return state_space::state_space(asked, file);
    }
    if let Some(file) = &asked.fmu {
        return fmu::fmu(asked, file);
    }
    let from = export::read(&asked.dir)?;
    let chosen = instants::choose(&from.field_times, asked.times.as_deref(), asked.every as usize)?;
    let out = asked.out.as_deref().unwrap_or(&asked.dir);
    let elsewhere = fs::canonicalize(out).ok() != fs::canonicalize(&asked.dir).ok();
    if let Some(kind) = FolderKind::within(out).filter(|_| elsewhere) {
        return usage(format!(
            "--out {}: it contains the result of `slcbeam {}`, and these files would seem to belong to that result; \
             name another folder",
            out.display(),
            kind.command()
        ));
    }
    let mut all: Vec<(&str, ExportedFiles)> = vec![];
    if asked.format.contains(&Format::Csv) {
        all.push(("csv", tables::write(out, &from, &chosen)?));
    }
    if asked.format.contains(&Format::Vtk) {
        let case = case::load(&asked.dir.join(CASE), &[])?;
        all.push(("vtk", vtk::write(out, &case, &from, &chosen)?));
    }
    let times: Vec<f64> = chosen.iter().map(|&k| from.field_times[k]).collect();
    let (first, last) = (times[0], times[times.len() - 1]);
    let value = || {
        let about = |w: &ExportedFiles| json!({"path": w.path, "files": w.files, "bytes": w.bytes});
        let formats: Map<_, _> = all.iter().map(|(name, w)| (name.to_string(), about(w))).collect();
        json!({"from_s": first, "to_s": last, "instants": times.len(), "formats": formats})
    };
    let text = || {
        let [from, to] = [first, last].map(|t| significant(t, 6));
        let files = all.iter().map(|(name, w)| {
            let (files, size) = (counted(w.files as u64, "file"), significant(w.bytes as f64 / 1e6, 3));
            format!("{name}  {}  {files}, {size} MB\n", w.path.display())
        });
        let instants = counted(times.len() as u64, "instant");
        files.fold(format!("{instants} from {from} s to {to} s\n"), |text, line| {
            text + &line
        })
    };
    crate::cli::answer(asked.json, value, text)
}

/// Members of a JSON object, and those of another.
fn joined(mut own: Value, others: Value) -> Value {
    if let (Value::Object(all), Value::Object(more)) = (&mut own, others) {
        all.extend(more);
    }
    own
}
