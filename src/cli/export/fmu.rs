//! `slcbeam export --fmu`: a case as a model for co-simulation in other programs.

use std::path::Path;
use std::process::ExitCode;

use serde_json::{Value, json};

use super::state_space::TestedModel;
use super::{ExportArguments, joined};
use crate::case::{self, Case};
use crate::cli::arguments::parse_all;
use crate::error::{Error, Result, usage};
use crate::output::columns::warnings;
use crate::output::fmu::{FmuContents, FmuInput, Libraries};
use crate::output::numbers::{counted, significant};
use crate::run::dynamics::simulator::{Simulator, SimulatorInput};
use crate::run::record::HistoryColumn;
use crate::run::response::find;

/// An argument of `--input`.
struct InputArgument {
    pointer: String,
    range: Option<[f64; 2]>,
}

impl InputArgument {
    fn new(text: &str) -> Result<Self> {
        let (pointer, range) = text
            .split_once('=')
            .map_or((text, None), |(pointer, range)| (pointer, Some(range)));
        let number = |text: &str| text.trim().parse::<f64>().ok();
        let range = range.map(|range| {
            let ends = range.split_once(',').and_then(|(low, high)| Some([number(low)?, number(high)?]));
            ends.ok_or_else(|| {
                Error::Usage(format!(
                    "--input {text}: expected the smallest and the largest value behind the pointer, such as {pointer}=0,1"
                ))
            })
        });
        Ok(Self {
            pointer: pointer.to_owned(),
            range: range.transpose()?,
        })
    }

    /// Range that is given, else that of the signal in the case, else that of an opening. An unknown signal has none.
    fn range(&self, case: &Case) -> Result<[f64; 2]> {
        if let Some(range) = self.range {
            return Ok(range);
        }
        let all = case::controls(case);
        let below = format!("{}/signal", self.pointer);
        let found = all.iter().find(|(at, ..)| *at == self.pointer || *at == below);
        let Some((.., signal)) = found else {
            return Ok([0.0, 1.0]);
        };
        let range = signal.range(0.0, case.time.end_s);
        if self.pointer.ends_with("/opening") {
            return Ok([0.0, 1.0]);
        }
        if range.low < range.high {
            return Ok([range.low, range.high]);
        }
        usage(format!(
            "--input {0}: the signal is constant in the case, so that the range of its values is unknown. Give it: --input {0}=LOW,HIGH",
            self.pointer
        ))
    }
}

/// Writes the FMU, and prints its variables.
pub(super) fn fmu(asked: &ExportArguments, file: &Path) -> Result<ExitCode> {
    let refused = |why: &str| usage(format!("--fmu {}: {why}", file.display()));
    if file.extension().is_none_or(|ending| ending != "fmu") {
        return refused("expected a file name that ends in .fmu");
    }
    if file.exists() && !asked.force {
        return refused("the file exists and is not overwritten; name another file, or use --force");
    }
    if asked.error.is_none() && (asked.at.is_some() || asked.no_self_test) {
        return refused("--at and --no-self-test belong to a linear model, which --error requests");
    }
    let case = case::load(&asked.dir, &asked.sets)?;
    let given: Vec<InputArgument> = parse_all(&asked.input, InputArgument::new)?;
    if given.is_empty() {
        let known: Vec<String> = case::controls(&case).into_iter().map(|(at, ..)| at).collect();
        return refused(&match known.is_empty() {
            true => {
                "the case has no signals that could be inputs. Add a load, a moving end, a port or a valve".to_owned()
            }
            false => format!(
                "choose inputs with --input; the signals of the case are {}",
                known.join(", ")
            ),
        });
    }
    let libraries = Libraries::find()?;
    let (contents, facts, text, found) = match asked.error {
        Some(_) => linear(asked, &case, &given)?,
        None => nonlinear(asked, &case, &given)?,
    };
    let bytes = contents.write(file, &libraries)?;
    let value = || {
        let inputs: Vec<_> = contents.inputs.iter().map(FmuInput::name).collect();
        joined(json!({"path": file, "bytes": bytes, "inputs": inputs}), facts)
    };
    let text = || {
        let inputs: String = contents.inputs.iter().map(describe).collect();
        let size = significant(bytes as f64 / 1e6, 3);
        format!("{inputs}{text}{}  {size} MB\n{}", file.display(), warnings(&found))
    };
    crate::cli::answer(asked.json, value, text)
}

/// Line about an input.
fn describe(input: &FmuInput) -> String {
    let range = input.range;
    let range = range.map_or_else(String::new, |[low, high]| format!(", from {low} to {high}"));
    format!(
        "input {} [{}]: {} at the start{range}\n",
        input.name(),
        input.unit(),
        input.start
    )
}

/// Contents of an FMU, facts for scripts, facts for readers, warnings.
type Found<'a> = (FmuContents<'a>, Value, String, Vec<String>);

/// The case itself.
fn nonlinear<'a>(asked: &ExportArguments, case: &'a Case, given: &[InputArgument]) -> Result<Found<'a>> {
    let ranges: Vec<SimulatorInput> = given
        .iter()
        .map(|one| {
            Ok(SimulatorInput {
                pointer: one.pointer.clone(),
                range: one.range(case)?,
            })
        })
        .collect::<Result<_>>()?;
    let simulator = Simulator::new(case, &ranges)?;
    let inputs = ranges
        .into_iter()
        .zip(simulator.values())
        .map(|(input, start)| FmuInput {
            pointer: input.pointer,
            range: Some(input.range),
            start,
        });
    let columns = simulator.columns();
    let is_output = |column: &HistoryColumn| column.name != "t";
    let mut outputs: Vec<HistoryColumn> = vec![];
    for name in &asked.output {
        let column = &columns[find(columns, name, "output", is_output)?];
        if !outputs.contains(column) {
            outputs.push(column.clone());
        }
    }
    if asked.output.is_empty() {
        outputs = columns.iter().filter(|column| is_output(column)).cloned().collect();
    }
    let names: Vec<&str> = outputs.iter().map(|column| column.name.as_str()).collect();
    let warnings = simulator.warnings();
    let facts = json!({"outputs": names, "warnings": warnings});
    let text = match asked.output.is_empty() {
        true => format!(
            "{}: all columns of the history\n",
            counted(names.len() as u64, "output")
        ),
        false => format!("outputs {}\n", names.join(", ")),
    };
    let inputs = inputs.collect();
    let contents = FmuContents {
        case,
        inputs,
        outputs,
        linear: None,
    };
    Ok((contents, facts, text, warnings))
}

/// Small motions of the case.
fn linear<'a>(asked: &ExportArguments, case: &'a Case, given: &[InputArgument]) -> Result<Found<'a>> {
    let [input] = given else {
        return usage(format!("--error: a linear model has one --input, not {}", given.len()));
    };
    if asked.output.is_empty() {
        return usage("--error: name the outputs of the linear model with --output");
    }
    let found = TestedModel::new(asked, case, &input.pointer)?;
    if let Some([low, high]) = input
        .range
        .filter(|[low, high]| !(low..=high).contains(&&found.model.u0))
    {
        return usage(format!(
            "--input {}={low},{high}: the range must contain the value of the case at the operating point, {}",
            found.input, found.model.u0
        ));
    }
    let contents = FmuContents {
        case,
        inputs: vec![FmuInput {
            pointer: found.input.clone(),
            range: input.range,
            start: found.model.u0,
        }],
        outputs: found.outputs.clone(),
        linear: Some(found.model.clone()),
    };
    Ok((contents, found.json(), found.text(), found.warnings))
}
