//! Signals of a case that are set from outside.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use super::swings::Swings;
use crate::case::schema::Method;
use crate::case::{self, Case};
use crate::discrete::System;
use crate::error::numbers::counted;
use crate::error::{Error, Result};
use crate::onestep::OneStepOptions;
use crate::run::method::{self, Options};

/// A signal of the case that is set from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Its JSON pointer.
    pub pointer: String,
    /// Smallest and largest value that it may be given, in the unit of its key. What the scene calls for, and the sizes of unknowns,
    /// follow from them.
    pub range: [f64; 2],
}

/// An input as it stands.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// Which.
    pub input: Input,
    /// Its value.
    pub value: f64,
    /// Signals of the system that it is, in the order in which they are visited.
    pub places: Vec<usize>,
    /// Whether it is the opening of valves.
    pub opens: bool,
    /// What it has been through.
    pub swings: Swings,
}

/// What tells a case and its inputs from others.
pub(super) fn mark(case: &Case, inputs: &[Input]) -> String {
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

/// The case with signals that go through the whole of their ranges in place of its inputs, by which the model is chosen; its system, and where in
/// it each of them acts.
pub(super) fn taken(case: &Case, inputs: &[Input]) -> Result<(Case, System, Vec<Held>)> {
    let all = case::controls(case);
    let mut held: Vec<Held> = vec![];
    let mut sets = vec![];
    for (k, input) in inputs.iter().enumerate() {
        let usage = |what: String| Error::Usage(format!("input {}: {what}", input.pointer));
        let below = format!("{}/signal", input.pointer);
        let found = all.iter().find(|(at, ..)| *at == input.pointer || *at == below);
        let Some((pointer, jumps, signal)) = found else {
            let known = all.iter().filter(|(_, jumps, _)| *jumps).map(|(at, ..)| at.as_str());
            let meant = case::nearest(&input.pointer, known.clone());
            let meant = meant.map_or_else(String::new, |near| format!("; nearest is {near}"));
            let known: Vec<&str> = known.collect();
            return Err(usage(format!(
                "no signal stands there{meant}; signals are {}",
                known.join(", ")
            )));
        };
        if !jumps {
            return Err(usage(
                "it moves something, which must not jump; give a force, pressure, flow or opening".into(),
            ));
        }
        if held.iter().any(|one| one.input.pointer == *pointer) {
            return Err(usage("it is there twice".into()));
        }
        let ([low, high], value) = (input.range, signal.value(0.0));
        let range = format!("its range, {low} to {high}, must");
        if !(low.is_finite() && high.is_finite()) {
            return Err(usage(format!("{range} be of finite numbers")));
        }
        if low >= high {
            return Err(usage(format!("{range} lead from a number to a larger one")));
        }
        if !(low..=high).contains(&value) {
            return Err(usage(format!(
                "{range} hold the value with which the case begins, {value}"
            )));
        }
        // goes through all of its range within the run, and is like no other signal
        let end = case.time.end_s;
        let times = [0.0, 0.3 * end, 0.6 * end, end * (1.0 + 1e-3 * (k + 1) as f64)];
        sets.push(format!(
            r#"{pointer}={{"table": {{"times_s": {times:?}, "values": {:?}, "interpolation": "linear"}}}}"#,
            [value, low, high, value]
        ));
        held.push(Held {
            input: Input {
                pointer: pointer.clone(),
                range: input.range,
            },
            value,
            places: vec![],
            swings: Swings::of(value),
            opens: pointer.contains("/opening"),
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

/// Of values that the case cannot have, in the words of their range: what was set in its place nobody has written.
fn of_range(error: Error, held: &[Held]) -> Error {
    let Error::Case(fault) = &error else { return error };
    let told = fault.violations.iter().find_map(|violation| {
        let input = held.iter().map(|one| &one.input);
        let mut own = input.filter(|input| violation.pointer.starts_with(&input.pointer));
        own.next().map(|input| {
            let [low, high] = input.range;
            let allowed = violation.allowed.as_ref();
            let allowed = allowed.map_or_else(String::new, |allowed| format!("; allowed is {allowed}"));
            let what = format!("{}{allowed}", violation.what);
            format!("input {}: its range, {low} to {high}, cannot be: {what}", input.pointer)
        })
    });
    told.map_or(error, Error::Usage)
}

/// Those of the one-step method that the case asks for, else of ESDIRK46: it needs no past.
pub(super) fn options(case: &Case, system: &System, max_step: f64) -> Result<OneStepOptions> {
    let mut case = case.clone();
    if case.solver.method == Method::Auto && method::choose(&case, system).one_step.is_none() {
        case.solver.method = Method::Esdirk46;
    }
    match Options::new(&case, system, &method::choose(&case, system), max_step) {
        Options::OneStep(options) => Ok(options),
        Options::Ida(_) => Err(Error::Usage(
            "a simulator starts afresh at every change of its inputs, for which IDA is slow: give /solver/method esdirk46, or auto".into(),
        )),
    }
}

/// Values within their ranges, as many as there are inputs.
pub(super) fn admit(held: &[Held], values: &[f64]) -> Result<()> {
    if values.len() != held.len() {
        return Err(Error::Usage(format!(
            "{} for {}: one each is wanted, in their order",
            counted(values.len() as u64, "value"),
            counted(held.len() as u64, "input")
        )));
    }
    for (Held { input, .. }, value) in held.iter().zip(values) {
        let [low, high] = input.range;
        if !(low..=high).contains(value) {
            return Err(Error::Usage(format!(
                "{}: {value} lies outside of its range, {low} to {high}",
                input.pointer
            )));
        }
    }
    Ok(())
}
