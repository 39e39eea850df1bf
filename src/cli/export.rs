//! `slcbeam export`: a result for spreadsheets, pandas, MATLAB and ParaView; a case as a state-space model.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::response::check_band;
use crate::case;
use crate::error::numbers::error_percent;
use crate::error::{Code, Error, Result};
use crate::output::columns::warnings;
use crate::output::export::{self, ExportedFiles, instants, tables, vtk};
use crate::output::folder::CASE;
use crate::output::kind::FolderKind;
use crate::output::numbers::{counted, significant};
use crate::output::state_space as files;
use crate::run::record::HistoryColumn;
use crate::run::response::LinearResponse;
use crate::run::response::self_test::SelfTest;
use crate::run::response::state_space::{ModelReduction, StateSpace};
use crate::study::response::reduced::reduce;
use crate::study::response::{cautions, growing, poles};

/// `export`.
#[derive(Debug, Args)]
pub struct ExportArguments {
    /// Result folder of a run; a case with --state-space
    pub dir: PathBuf,
    /// Write the state-space model of small motions of a case, matrices A, B, C and D, to this file: .npz, .mat or .json
    #[arg(long, value_name = "FILE", requires = "input", requires = "output", conflicts_with_all = ["format", "times", "every", "out"], value_parser = super::progress_line::output_path())]
    pub state_space: Option<PathBuf>,
    /// Change a value of the case first; repeatable
    #[arg(long = "set", value_name = "POINTER=JSON", requires = "state_space")]
    pub sets: Vec<String>,
    /// Write over a file that is there
    #[arg(long, requires = "state_space")]
    pub force: bool,
    /// Its input, as that of `response`
    #[arg(long, value_name = "POINTER", requires = "state_space")]
    pub input: Option<String>,
    /// Its outputs, as those of `response`
    #[arg(long, value_name = "NAME", requires = "state_space", value_delimiter = ',')]
    pub output: Vec<String>,
    /// The state about which, as that of `response`
    #[arg(long, value_name = "SECONDS", requires = "state_space", allow_hyphen_values = true, value_parser = super::progress_line::instant)]
    pub at: Option<f64>,
    /// Write a reduced model instead: the smallest found whose error is at most this fraction of the amplitude, or of its median over
    /// the band
    #[arg(long, value_name = "FRACTION", requires = "state_space", allow_negative_numbers = true, value_parser = super::progress_line::ratio)]
    pub error: Option<f64>,
    /// First frequency of the reduced model [Hz]; its static gain is exact too
    #[arg(long, value_name = "HZ", default_value_t = 0.01, requires = "error", allow_negative_numbers = true, value_parser = super::progress_line::frequency)]
    pub from: f64,
    /// Last frequency of the reduced model [Hz]
    #[arg(long, value_name = "HZ", default_value_t = 200.0, requires = "error", allow_negative_numbers = true, value_parser = super::progress_line::frequency)]
    pub to: f64,
    /// Omit the self-test of the model, which compares it with the nonlinear equations
    #[arg(long, requires = "state_space")]
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
    #[arg(short, long, value_name = "DIR", value_parser = super::progress_line::output_path())]
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
    if let (Some(file), Some(input)) = (&asked.state_space, &asked.input) {
        return state_space(asked, file, input);
    }
    let from = export::read(&asked.dir)?;
    let chosen = instants::choose(&from.field_times, asked.times.as_deref(), asked.every as usize)?;
    let out = asked.out.as_deref().unwrap_or(&asked.dir);
    let elsewhere = fs::canonicalize(out).ok() != fs::canonicalize(&asked.dir).ok();
    if let Some(kind) = FolderKind::within(out).filter(|_| elsewhere) {
        return Err(Error::Usage(format!(
            "--out {}: it contains the result of `slcbeam {}`, and these files would seem to belong to that result; \
             name another folder",
            out.display(),
            kind.command()
        )));
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
    if asked.json {
        let formats = all.iter().map(|(name, w)| {
            let about = json!({"path": w.path, "files": w.files, "bytes": w.bytes});
            (name.to_string(), about)
        });
        let formats: serde_json::Map<_, _> = formats.collect();
        let summary = json!({"from_s": first, "to_s": last, "instants": times.len(), "formats": formats});
        super::print(&format!("{summary:#}\n"))?;
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

/// Smallest error of a reduced model: below it, rounding errors of responses near sharp peaks.
const MIN_ERROR: f64 = 1e-6;
/// Largest number of states of a model, whose matrices are full.
const MOST_STATES: usize = 4000;

fn state_space(asked: &ExportArguments, file: &Path, input: &str) -> Result<ExitCode> {
    if file.exists() && !asked.force {
        return Err(Error::Usage(format!(
            "--state-space {}: the file exists and is not overwritten; name another file, or use --force",
            file.display()
        )));
    }
    if file.exists() && !replaceable(file) {
        return Err(Error::Usage(format!(
            "--state-space {}: the file contains something else than a state-space model and is not overwritten; name another file",
            file.display()
        )));
    }
    if let Some(error) = asked.error {
        check_band([asked.from, asked.to], 2, asked.from < asked.to, "below")?;
        if !(MIN_ERROR..1.0).contains(&error) {
            return Err(Error::Usage(format!(
                "--error {error}: expected at least {MIN_ERROR:e}, below 1"
            )));
        }
    }
    let case = case::load(&asked.dir, &asked.sets)?;
    let response = LinearResponse::new(&case, input, &asked.output, asked.at)?;
    let (model, growing) = match asked.error {
        Some(error) => {
            let band = [asked.from, asked.to];
            let poles = poles(&case, asked.at, &response, band);
            let mut known = poles.as_ref().cloned().unwrap_or_default();
            let model = reduce(&response, band, &mut known, error)?;
            // the model's own poles are among them now
            let growing = match known.growth_unknown.filter(|_| known.growing.is_empty()) {
                Some(why) => Err(why),
                None => Ok(known.growing.len()),
            };
            (model, poles.and(growing))
        }
        None if response.about.y.len() > MOST_STATES => {
            return Err(Error::Usage(format!(
                "--state-space: {} are too many for full matrices (at most {MOST_STATES}); use --error 1e-3 for a reduced model",
                counted(response.about.y.len() as u64, "unknown")
            )));
        }
        None => (StateSpace::new(&response)?, growing(&case, asked.at, &response)),
    };
    let outputs: Vec<String> = response.outputs.iter().map(HistoryColumn::key).collect();
    let known = growing.as_ref().copied().unwrap_or(0);
    let tested = (!asked.no_self_test).then(|| SelfTest::new(&response, &model, known));
    files::write(
        file,
        &case.name,
        &response.input,
        outputs.clone(),
        response.about.at,
        (&model, tested.as_ref().and_then(|tested| tested.as_ref().ok())),
    )?;
    let states = model.b.len();
    let mut found = match growing {
        Ok(growing) => cautions(growing, response.about.moving()),
        Err(why) => vec![Code::ErrorEstimate.warning(format!("not known: poles: {why}"))],
    };
    let (self_test, about_test) = match &tested {
        Some(Ok(test)) => {
            let (worst, difference) = test.worst();
            let line = format!(
                "self-test: input changed by {} within {} s; largest difference from the nonlinear equations: {} of the largest change of {}, over {} s\n",
                significant(test.step, 2),
                significant(test.ramp_s, 2),
                error_percent(difference),
                outputs[worst],
                significant(test.time_s, 3),
            );
            if !test.passed() {
                found.push(Code::ErrorEstimate.warning(format!(
                    "the self-test failed: {} differs from the nonlinear equations by {} of its largest change (limit {}). Motions faster \
                     than the band, or a law with a kink at this state, are not in the model. Increase --to, or use another state (--at)",
                    outputs[worst],
                    error_percent(difference),
                    error_percent(test.limit)
                )));
            }
            (serde_json::to_value(test).unwrap_or_default(), line)
        }
        Some(Err(why)) => (json!({"reason": why}), format!("no self-test: {why}\n")),
        None => (Value::Null, String::new()),
    };
    if asked.json {
        let mut answer = json!({"path": file, "states": states, "outputs": outputs, "input": response.input, "input_rate": model.input_rate, "warnings": found});
        if tested.is_some() {
            answer["self_test"] = self_test;
        }
        if let Some(reduction) = model.reduction {
            let [modes, kept] = reduction.modes;
            answer["reduction"] = json!({"band_hz": reduction.band, "error": reduction.error, "static_gain": reduction.static_gain, "modes": modes, "modes_in_model": kept, "solved": reduction.solved});
        }
        super::print(&format!("{answer:#}\n"))?;
    } else {
        let of = ["", "rate of ", "second rate of "][model.input_rate.min(2)];
        super::print(&format!(
            "{}, input {of}{}, outputs {}\n{}{about_test}{}\n{}",
            counted(states as u64, "state"),
            response.input,
            outputs.join(", "),
            model
                .reduction
                .map_or_else(String::new, |reduction| describe(&reduction)),
            file.display(),
            warnings(&found)
        ))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// True if a file may be overwritten: a JSON file contains matrices, so that no case and no result is lost.
fn replaceable(file: &Path) -> bool {
    let json = file.extension().is_some_and(|kind| kind.eq_ignore_ascii_case("json"));
    let read = || {
        fs::read(file)
            .ok()
            .and_then(|text| serde_json::from_slice::<Value>(&text).ok())
    };
    !json || read().is_some_and(|found| found["a"].is_array() && found["x0"].is_array())
}

/// Text of a reduction.
fn describe(reduction: &ModelReduction) -> String {
    let [from, to] = reduction.band.map(|hz| significant(hz, 4));
    let [modes, kept] = reduction.modes;
    format!(
        "error from {from} to {to} Hz: at most {} of the amplitude, or of its median over the band if that is larger (solved at {} frequencies)\n\
         static gain: {}\n\
         poles: {kept} of the {} found in the band{}\n",
        error_percent(reduction.error),
        reduction.solved,
        if reduction.static_gain { "exact" } else { "none" },
        counted(modes as u64, "mode"),
        if kept < modes {
            "; the permitted error needs no others"
        } else {
            ""
        },
    )
}
