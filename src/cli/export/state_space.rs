//! `slcbeam export --state-space`: matrices of small motions, also for a linear FMU.

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use serde_json::{Value, json};

use super::{ExportArguments, joined};
use crate::case::{self, Case};
use crate::cli::response::check_band;
use crate::error::numbers::error_percent;
use crate::error::{Code, Result, usage};
use crate::output::columns::warnings;
use crate::output::numbers::{counted, significant};
use crate::output::state_space as files;
use crate::run::control_loop;
use crate::run::record::HistoryColumn;
use crate::run::response::LinearResponse;
use crate::run::response::self_test::SelfTest;
use crate::run::response::state_space::{ModelReduction, StateSpace};
use crate::study::response::reduced::reduce;
use crate::study::response::{cautions, growing, poles};

/// Smallest error of a reduced model: below it, rounding errors of responses near sharp peaks.
const MIN_ERROR: f64 = 1e-6;
/// Largest number of states of a model, whose matrices are full.
const MOST_STATES: usize = 4000;

/// A state-space model with its self-test.
pub(super) struct TestedModel {
    /// Pointer of the input.
    pub input: String,
    /// Time of the operating point [s].
    at: f64,
    /// Columns of the outputs.
    pub outputs: Vec<HistoryColumn>,
    /// The model.
    pub model: StateSpace,
    tested: Option<std::result::Result<SelfTest, String>>,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl TestedModel {
    /// Computes the model that the arguments request.
    pub fn new(asked: &ExportArguments, case: &Case, input: &str) -> Result<Self> {
        if let Some(error) = asked.error {
            check_band([asked.from, asked.to], 2, asked.from < asked.to, "below")?;
            if !(MIN_ERROR..1.0).contains(&error) {
                return usage(format!("--error {error}: expected at least {MIN_ERROR:e}, below 1"));
            }
        }
        let response = LinearResponse::new(case, input, &asked.output, asked.at)?;
        let (model, growing) = match asked.error {
            Some(error) => {
                let band = [asked.from, asked.to];
                let poles = poles(case, asked.at, &response, band);
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
                return usage(format!(
                    "--state-space: {} are too many for full matrices (at most {MOST_STATES}); use --error 1e-3 for a reduced model",
                    counted(response.about.y.len() as u64, "unknown")
                ));
            }
            None => (StateSpace::new(&response)?, growing(case, asked.at, &response)),
        };
        let known = growing.as_ref().copied().unwrap_or(0);
        let tested = (!asked.no_self_test).then(|| SelfTest::new(&response, &model, known));
        let mut warnings = match growing {
            Ok(growing) => cautions(growing, response.about.moving()),
            Err(why) => vec![Code::ErrorEstimate.warning(format!("not known: poles: {why}"))],
        };
        warnings.extend(control_loop::held(response.about.system()));
        if let Some(Ok(test)) = tested
            .as_ref()
            .filter(|tested| tested.as_ref().is_ok_and(|test| !test.passed()))
        {
            let (worst, difference) = test.worst();
            warnings.push(Code::ErrorEstimate.warning(format!(
                "the self-test failed: {} differs from the nonlinear equations by {} of its largest change (limit {}). Motions faster \
                 than the band, or a law with a kink at this state, are not in the model. Increase --to, or use another state (--at)",
                response.outputs[worst].key(),
                error_percent(difference),
                error_percent(test.limit)
            )));
        }
        Ok(Self {
            at: response.about.at,
            outputs: response.outputs.clone(),
            input: response.input,
            model,
            tested,
            warnings,
        })
    }

    /// Names of the outputs, with units.
    fn names(&self) -> Vec<String> {
        self.outputs.iter().map(HistoryColumn::key).collect()
    }

    /// Facts for scripts.
    pub fn json(&self) -> Value {
        let model = &self.model;
        let mut answer = json!({"states": model.b.len(), "outputs": self.names(), "input": self.input, "input_rate": model.input_rate, "warnings": self.warnings});
        match &self.tested {
            Some(Ok(test)) => answer["self_test"] = serde_json::to_value(test).unwrap_or_default(),
            Some(Err(why)) => answer["self_test"] = json!({"reason": why}),
            None => {}
        }
        if let Some(reduction) = model.reduction {
            let [modes, kept] = reduction.modes;
            answer["reduction"] = json!({"band_hz": reduction.band, "error": reduction.error, "static_gain": reduction.static_gain, "modes": modes, "modes_in_model": kept, "solved": reduction.solved});
        }
        answer
    }

    /// Facts for readers.
    pub fn text(&self) -> String {
        let names = self.names();
        let about_test = match &self.tested {
            Some(Ok(test)) => {
                let (worst, difference) = test.worst();
                format!(
                    "self-test: input changed by {} within {} s; largest difference from the nonlinear equations: {} of the largest change of {}, over {} s\n",
                    significant(test.step, 2),
                    significant(test.ramp_s, 2),
                    error_percent(difference),
                    names[worst],
                    significant(test.time_s, 3),
                )
            }
            Some(Err(why)) => format!("no self-test: {why}\n"),
            None => String::new(),
        };
        let of = ["", "rate of ", "second rate of "][self.model.input_rate.min(2)];
        format!(
            "{}, input {of}{}, outputs {}\n{}{about_test}",
            counted(self.model.b.len() as u64, "state"),
            self.input,
            names.join(", "),
            self.model
                .reduction
                .map_or_else(String::new, |reduction| describe(&reduction)),
        )
    }
}

/// Writes the matrices.
pub(super) fn state_space(asked: &ExportArguments, file: &Path) -> Result<ExitCode> {
    if file.exists() && !asked.force {
        return usage(format!(
            "--state-space {}: the file exists and is not overwritten; name another file, or use --force",
            file.display()
        ));
    }
    if file.exists() && !replaceable(file) {
        return usage(format!(
            "--state-space {}: the file contains something else than a state-space model and is not overwritten; name another file",
            file.display()
        ));
    }
    let [input] = &asked.input[..] else {
        return usage(format!(
            "--state-space: one --input is needed, not {}",
            asked.input.len()
        ));
    };
    if asked.output.is_empty() {
        return usage("--state-space: name its outputs with --output");
    }
    let case = case::load(&asked.dir, &asked.sets)?;
    let found = TestedModel::new(asked, &case, input)?;
    files::write(
        file,
        &case.name,
        &found.input,
        found.names(),
        found.at,
        (
            &found.model,
            found.tested.as_ref().and_then(|tested| tested.as_ref().ok()),
        ),
    )?;
    let text = || format!("{}{}\n{}", found.text(), file.display(), warnings(&found.warnings));
    crate::cli::answer(asked.json, || joined(json!({"path": file}), found.json()), text)
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
