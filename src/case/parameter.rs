//! Numbers of a case with respect to which results are differentiated.

use serde::{Deserialize, Serialize};
use std::path::Path;

use serde_json::Value;
use slcbeam_section::input::Section;

use super::origins::Origin;
use super::schema::{Case, FluidKind, SpanRows};
use super::wording::nearest;
use super::{parse, section};
use crate::error::{Error, Result};

/// Parts of a case that describe the physical model, not the computation.
const PARTS: [&str; 17] = [
    "beam",
    "fluid",
    "bladders",
    "spans",
    "beams",
    "joints",
    "tubes",
    "network",
    "loads",
    "attachments",
    "foundation",
    "contacts",
    "beam_contacts",
    "surroundings",
    "rotating_frame",
    "ends",
    "start",
];

/// A number of a case, given by its JSON pointer; unwritten defaults are included.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// JSON pointer.
    pub pointer: String,
    /// Its value.
    pub value: f64,
}

/// Option that requests derivatives.
const OPTION: &str = "--sensitivity";

impl Parameter {
    /// Finds the numbers at some pointers, each once.
    ///
    /// # Errors
    /// As [`Parameter::find`].
    pub fn find_all(case: &Case, pointers: &[String]) -> Result<Vec<Self>> {
        let mut all: Vec<Self> = vec![];
        for pointer in pointers {
            if all.iter().all(|other| other.pointer != *pointer) {
                all.push(Self::find(case, pointer)?);
            }
        }
        Ok(all)
    }

    /// Finds the number at a pointer.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no number, or one with respect to which results cannot be differentiated.
    pub fn find(case: &Case, pointer: &str) -> Result<Self> {
        Self::find_as(OPTION, case, pointer)
    }

    /// Finds the number at a pointer, which the option `option` requests.
    ///
    /// # Errors
    /// As [`Parameter::find`].
    pub fn find_as(option: &str, case: &Case, pointer: &str) -> Result<Self> {
        let found = Self::number(option, case, pointer)?;
        if found.value == 0.0 {
            let what = "it is 0, which gives no scale for a finite difference; set it to a small value";
            return Err(Error::Usage(format!("{option} {pointer}: {what}")));
        }
        Ok(found)
    }

    /// Finds the number at a pointer; it may be 0.
    ///
    /// # Errors
    /// [`Error::Usage`] if the model has no such parameter.
    pub fn number(option: &str, case: &Case, pointer: &str) -> Result<Self> {
        let usage = |what: String| Err(Error::Usage(format!("{option} {pointer}: {what}")));
        let resolved = written_out(case);
        let part = pointer.split('/').nth(1).unwrap_or_default();
        let (in_span, inner) = in_span(pointer);
        if inner.starts_with("/section/") {
            return usage(
                "the numbers of a section are not parameters of the model; use the coefficients computed from it"
                    .into(),
            );
        }
        if pointer.starts_with('/') && resolved.get(part).is_some() && !PARTS.contains(&part) {
            return usage(format!(
                "/{part} is not a part of the model; parameters are under /{}",
                PARTS.join(", /")
            ));
        }
        if let Some(section) = pitched_section(case, pointer) {
            return usage(format!(
                "it changes the distance of bladders, for which the coefficients of {section} are computed; use \
                 `slcbeam sweep --vary` with whole pitches, which computes the section again"
            ));
        }
        let stiffness = case.origins.get(&format!("{in_span}/beam/axial_stiffness_factor"));
        if section::SIZES.contains(&inner) && matches!(stiffness, Some(Origin::Section { .. })) {
            return usage(
                "the section defines it, and the coefficients computed from the section would not change with it"
                    .into(),
            );
        }
        let density = case.origins.get("/fluid/density_kg_m3");
        if pointer == "/fluid/ambient_pressure_pa"
            && matches!(density, Some(Origin::Fluid(..)))
            && case.fluid.as_ref().is_some_and(|fluid| fluid.kind == FluidKind::Gas)
        {
            return usage(
                "the density of a gas by name depends on it but would not change with it; give density_kg_m3".into(),
            );
        }
        match resolved.pointer(pointer) {
            Some(Value::Number(number)) if number.is_f64() => {
                let value = number.as_f64().unwrap_or_default();
                let pointer = pointer.to_owned();
                Ok(Self { pointer, value })
            }
            Some(Value::Number(_)) => usage("a count has no derivative".into()),
            Some(_) => usage("there is no number at this pointer".into()),
            None => {
                let mut all = vec![];
                numbers(&resolved, String::new(), &mut all);
                all.retain(|p| PARTS.contains(&p.split('/').nth(1).unwrap_or_default()));
                let meant = nearest(pointer, all.iter().map(String::as_str));
                let meant = meant.map_or(String::new(), |p| format!("; nearest is {p}"));
                usage(format!("the case has no value at this pointer{meant}"))
            }
        }
    }

    /// Finds the numbers at some pointers, each as [`Parameter::find`].
    pub fn all(case: &Case, pointers: &[String]) -> Result<Vec<Self>> {
        pointers.iter().map(|pointer| Self::find(case, pointer)).collect()
    }

    /// Returns the case with another value of the parameter.
    ///
    /// # Errors
    /// The case is invalid with this value.
    pub fn changed(&self, case: &Case, value: f64) -> Result<Case> {
        with(case, &[(&self.pointer, value)])
    }
}

/// Pointer of the span in which a pointer is, and the pointer within it; empty, and the pointer itself outside of spans.
fn in_span(pointer: &str) -> (&str, &str) {
    let inner = pointer.strip_prefix("/spans/").and_then(|rest| rest.find('/'));
    pointer.split_at(inner.map_or(0, |at| at + "/spans/".len()))
}

/// Pointer of a section with bladders whose pitch would change with the length at a pointer: in the span itself or in the rest of the beam.
fn pitched_section(case: &Case, pointer: &str) -> Option<String> {
    let has_bladders = |section: &Section| section::rows(section) != SpanRows::None;
    let of_case = case.section.as_ref().is_some_and(has_bladders);
    let own = match pointer.strip_suffix("/length_m")? {
        "/beam" if case.spans.is_empty() => return of_case.then(|| "/section".into()),
        "/beam" => None,
        span => Some(span.strip_prefix("/spans/")?.parse().ok()?),
    };
    let rest = case.spans.iter().position(|span| span.length_m.is_none());
    own.into_iter().chain(rest).find_map(|k: usize| {
        let span = case.spans.get(k)?;
        let pitched = match &span.section {
            Some(section) if has_bladders(section) => return Some(format!("/spans/{k}/section")),
            Some(_) => span.segments.is_none(),
            None => span.segments.is_none() || span.rows != SpanRows::None,
        };
        (of_case && pitched).then(|| "/section".into())
    })
}

/// Returns a case as JSON with every default filled in, including openings of fully open valves, which files omit.
fn written_out(case: &Case) -> Value {
    let mut resolved = serde_json::to_value(case.resolved()).unwrap_or_default();
    for part in ["/network/tubes", "/network/chains"] {
        let all = resolved.pointer_mut(part).and_then(Value::as_array_mut);
        for one in all.into_iter().flatten().filter_map(Value::as_object_mut) {
            one.entry("opening").or_insert_with(|| 1.0.into());
        }
    }
    resolved
}

/// Returns a case with other values at existing JSON pointers. Coefficients are scaled to the new modulus and dimensions, except those at
/// the pointers.
///
/// # Errors
/// The case is invalid with these values.
pub fn with(case: &Case, values: &[(&str, f64)]) -> Result<Case> {
    let mut resolved = written_out(case);
    section::remove(&mut resolved);
    let mut origins = case.origins.clone();
    origins.given.change(&mut resolved, values);
    let changes: Vec<String> = values
        .iter()
        .map(|(pointer, value)| format!("{pointer} = {value}"))
        .collect();
    let name = format!("{} with {}", case.name, changes.join(", "));
    // written in lines, because a fault quotes one line
    let mut changed = parse(&format!("{resolved:#}"), Path::new(&name), Path::new(""), &[])?;
    // origins remain valid, although all values are written out here
    values.iter().for_each(|(pointer, _)| origins.forget(pointer));
    changed.origins = origins;
    Ok(changed)
}

/// Collects the pointers of all numbers that are not counts.
pub(super) fn numbers(value: &Value, at: String, all: &mut Vec<String>) {
    match value {
        Value::Object(members) => members
            .iter()
            .for_each(|(key, v)| numbers(v, format!("{at}/{key}"), all)),
        Value::Array(items) => items
            .iter()
            .enumerate()
            .for_each(|(k, v)| numbers(v, format!("{at}/{k}"), all)),
        Value::Number(number) if number.is_f64() => all.push(at),
        _ => {}
    }
}

/// Steps of a fourth-order difference, in units of the relative change of the parameter, and their weights.
pub const STEPS: [(f64, f64); 4] = [
    (1.0, 8.0 / 12.0),
    (-1.0, -8.0 / 12.0),
    (2.0, -1.0 / 12.0),
    (-2.0, 1.0 / 12.0),
];

/// Relative change of a parameter in a difference. The differentiated function is smooth and in closed form, so that the fourth order
/// leaves a relative error of 1e-12.
const CHANGE: f64 = 1e-3;
/// Largest motion of a contact by that change, relative to the length over which its force begins.
const WITHIN_SMOOTHING: f64 = 1e-3;

/// Relative change of a parameter in a difference: 1e-3, and less where contact forces would change their law within it.
pub fn change(case: &Case) -> f64 {
    let between = case
        .beam_contacts
        .iter()
        .map(|contact| WITHIN_SMOOTHING * contact.smoothing_m / case.beam.length_m);
    let contacts = case.contacts.iter();
    let least = contacts.map(|contact| {
        let largest = contact
            .coordinates()
            .fold(case.beam.length_m, |most, x| most.max(x.abs()));
        WITHIN_SMOOTHING * contact.smoothing_m / largest
    });
    least.chain(between).fold(CHANGE, f64::min)
}
