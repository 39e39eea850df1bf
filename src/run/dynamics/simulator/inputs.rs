//! Inputs: signals of a case that are set from outside.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use super::oscillations::InputOscillations;
use crate::case::schema::Method;
use crate::case::{self, Case};
use crate::discrete::System;
use crate::error::numbers::counted;
use crate::error::{Error, Result};
use crate::functions::signals::Table;
use crate::functions::{PiecewiseCurve, Ramp, RampShape, Signal};
use crate::onestep::OneStepOptions;
use crate::run::method::{self, IntegratorOptions};

/// A signal of the case that is set from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatorInput {
    /// JSON pointer of the signal.
    pub pointer: String,
    /// Smallest and largest value, in the unit of the signal's key. The effects that the model includes, and the scales of unknowns,
    /// follow from them.
    pub range: [f64; 2],
}

/// An input and its present value.
#[derive(Clone, Debug)]
pub(super) struct HeldInput {
    /// The input.
    pub input: SimulatorInput,
    /// Value of the input.
    pub value: f64,
    /// Indices of the system's signals that it sets, in the order in which they are visited.
    pub places: Vec<usize>,
    /// True if it is the opening of valves.
    pub opens: bool,
    /// Record of its oscillations.
    pub swings: InputOscillations,
    /// Course of an input that must not jump; none for others.
    pub path: Option<PiecewiseCurve>,
}

impl HeldInput {
    /// Signal of the input from now on.
    pub fn signal(&self) -> Signal {
        match &self.path {
            Some(path) => Signal::Table(Table::from_curve(path.clone())),
            None => Signal::Constant(self.value),
        }
    }

    /// Changes to a value: by a jump at the first of two instants [s], or from there to the second for an input that must not jump. Returns
    /// the signal of the change.
    pub fn change(&mut self, [t, until]: [f64; 2], value: f64) -> Signal {
        if let Some(path) = &mut self.path {
            *path = path.moved([t, until], value);
            return self.signal();
        }
        Signal::Ramp(Ramp {
            from: self.value,
            to: value,
            start_s: t,
            duration_s: 0.0,
            shape: RampShape::default(),
        })
    }

    /// True if the input moves beyond time `t` [s].
    pub fn moves_after(&self, t: f64) -> bool {
        let ends = self.path.as_ref().and_then(PiecewiseCurve::ends);
        ends.is_some_and(|[_, end]| end > t)
    }
}

/// Hash that identifies a case and its inputs.
pub(super) fn mark(case: &Case, inputs: &[SimulatorInput]) -> String {
    let mut hasher = DefaultHasher::new();
    serde_json::to_string(&case.resolved())
        .unwrap_or_default()
        .hash(&mut hasher);
    for input in inputs {
        input.pointer.hash(&mut hasher);
        input.range.map(f64::to_bits).hash(&mut hasher);
    }
    format!("{:016x}", hasher.finish())
}

/// Returns the case with signals that span the whole ranges of its inputs in their place, by which the model is chosen. Also returns
/// its system, and the inputs with the places at which they act.
pub(super) fn taken(case: &Case, inputs: &[SimulatorInput]) -> Result<(Case, System, Vec<HeldInput>)> {
    let all = case::controls(case);
    let mut held: Vec<HeldInput> = vec![];
    let mut sets = vec![];
    for (k, input) in inputs.iter().enumerate() {
        let usage = |what: String| Error::Usage(format!("input {}: {what}", input.pointer));
        let below = format!("{}/signal", input.pointer);
        let found = all.iter().find(|(at, ..)| *at == input.pointer || *at == below);
        let Some((pointer, jumps, signal)) = found else {
            let known = all.iter().map(|(at, ..)| at.as_str());
            let meant = case::nearest(&input.pointer, known.clone());
            let meant = meant.map_or_else(String::new, |near| format!("; nearest is {near}"));
            let known: Vec<&str> = known.collect();
            return Err(usage(format!(
                "the case has no such signal{meant}; its signals are {}",
                known.join(", ")
            )));
        };
        if signal.is_controlled() {
            return Err(usage("a controller of the case sets it".into()));
        }
        if held.iter().any(|one| one.input.pointer == *pointer) {
            return Err(usage("it is given twice".into()));
        }
        let ([low, high], value) = (input.range, signal.value(0.0));
        let range = format!("its range, {low} to {high}, must");
        if !(low.is_finite() && high.is_finite()) {
            return Err(usage(format!("{range} consist of finite numbers")));
        }
        if low >= high {
            return Err(usage(format!("{range} increase")));
        }
        if !(low..=high).contains(&value) {
            return Err(usage(format!("{range} contain the initial value of the case, {value}")));
        }
        // spans its range within the run, and differs from all other signals
        let end = case.time.end_s;
        let times = [0.0, 0.3 * end, 0.6 * end, end * (1.0 + 1e-3 * (k + 1) as f64)];
        sets.push(format!(
            r#"{pointer}={{"table": {{"times_s": {times:?}, "values": {:?}, "interpolation": "linear"}}}}"#,
            [value, low, high, value]
        ));
        held.push(HeldInput {
            input: SimulatorInput {
                pointer: pointer.clone(),
                range: input.range,
            },
            value,
            places: vec![],
            swings: InputOscillations::new(value),
            opens: pointer.contains("/opening"),
            path: (!jumps).then(|| PiecewiseCurve::constant(0.0, value)),
        });
    }
    let resolved = serde_json::to_value(case.resolved()).unwrap_or_default();
    let path = &case.source.path;
    let base = path.parent().unwrap_or(path);
    let marked = case::parse(&resolved.to_string(), path, base, &sets).map_err(|error| of_range(error, &held))?;
    let mut system = System::new(&marked)?;
    let marks = case::controls(&marked);
    for one in &mut held {
        let mark = marks
            .iter()
            .find(|(at, ..)| *at == one.input.pointer)
            .map(|(.., signal)| *signal);
        one.places = mark.map_or_else(Vec::new, |mark| system.places_of(mark));
        if one.places.is_empty() {
            let what = format!("input {}: nothing in the scene depends on it", one.input.pointer);
            return Err(Error::Usage(what));
        }
    }
    Ok((marked, system, held))
}

/// Converts an error about values of a substituted signal to one about the range of its input, which the user gave.
fn of_range(error: Error, held: &[HeldInput]) -> Error {
    let Error::Case(fault) = &error else { return error };
    let text = fault.violations.iter().find_map(|violation| {
        let input = held.iter().map(|one| &one.input);
        let mut own = input.filter(|input| violation.pointer.starts_with(&input.pointer));
        own.next().map(|input| {
            let [low, high] = input.range;
            let allowed = violation.allowed.as_ref();
            let allowed = allowed.map_or_else(String::new, |allowed| format!("; allowed is {allowed}"));
            let what = format!("{}{allowed}", violation.what);
            format!(
                "input {}: its range, {low} to {high}, is not allowed: {what}",
                input.pointer
            )
        })
    });
    text.map_or(error, Error::Usage)
}

/// Options of the one-step method that the case requests, else of ESDIRK46, which needs no history.
pub(super) fn options(case: &Case, system: &System, max_step: f64) -> Result<OneStepOptions> {
    let mut case = case.clone();
    if case.solver.method == Method::Auto && method::choose(&case, system).one_step.is_none() {
        case.solver.method = Method::Esdirk46;
    }
    match IntegratorOptions::new(&case, system, &method::choose(&case, system), max_step) {
        IntegratorOptions::OneStep(options) => Ok(options),
        IntegratorOptions::Ida(_) => Err(Error::Usage(
            "a simulator restarts its integrator at every change of its inputs, for which IDA is slow: set \
             /solver/method to esdirk46 or auto"
                .into(),
        )),
    }
}

/// Checks that there is one value for each input, within its range.
pub(super) fn admit(held: &[HeldInput], values: &[f64]) -> Result<()> {
    if values.len() != held.len() {
        return Err(Error::Usage(format!(
            "{} for {}: give one value for each input, in the order of the inputs",
            counted(values.len() as u64, "value"),
            counted(held.len() as u64, "input")
        )));
    }
    for (HeldInput { input, .. }, value) in held.iter().zip(values) {
        let [low, high] = input.range;
        if !(low..=high).contains(value) {
            return Err(Error::Usage(format!(
                "{}: {value} is outside its range, {low} to {high}",
                input.pointer
            )));
        }
    }
    Ok(())
}
