//! A number of a case, and the cases in which it is a little different.

use std::path::Path;

use serde_json::Value;

use crate::case::locate::{child, tokens};
use crate::case::{self, Case};
use crate::dae::neighbours::{CHANGES, STEP};
use crate::error::{Error, Result};

/// Sections of a case that say how it is computed, not what.
const NUMERICS: [&str; 5] = ["mesh", "time", "solver", "effects", "effects_tolerance"];

/// A number of a case, by its JSON pointer.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Where it stands in the case with all defaults filled in: `/fluid/viscosity_pa_s`.
    pub pointer: String,
    /// Its value, in the unit that its key names.
    pub value: f64,
    /// The case with it changed by the factors `1 + ε k`, k of [`CHANGES`] and ε of [`STEP`].
    pub cases: [Case; 4],
}

impl Parameter {
    /// The number at a JSON pointer.
    ///
    /// # Errors
    /// [`Error::Usage`] when no number stands there, when it is an integer, zero or no parameter of the model, or when a changed value
    /// is refused by the case.
    pub fn of(case: &Case, pointer: &str) -> Result<Self> {
        let refuse = |what: String| Error::Usage(format!("--sensitivity '{pointer}': {what}"));
        if !pointer.starts_with('/') {
            let slashes = pointer.replace('.', "/");
            return Err(refuse(format!("a JSON pointer starts with `/`: /{slashes}")));
        }
        let section = tokens(pointer).next().unwrap_or_default();
        if NUMERICS.contains(&section.as_str()) {
            return Err(refuse(format!(
                "/{section} says how the case is computed; derivatives are with respect to numbers of the model"
            )));
        }
        let text = case.resolved_json();
        let whole: Value = serde_json::from_str(&text).unwrap_or_default();
        let value = number(&whole, pointer).map_err(refuse)?;
        let changed = |change: f64| -> Result<Case> {
            let set = format!("{pointer}={:e}", value * (1.0 + STEP * change));
            let loaded = case::parse(&text, Path::new("case.json"), Path::new(""), &[set]);
            loaded.map(|loaded| loaded.case).map_err(|error| refuse(refused(error)))
        };
        let [a, b, c, d] = CHANGES.map(changed);
        Ok(Self {
            pointer: pointer.to_owned(),
            value,
            cases: [a?, b?, c?, d?],
        })
    }
}

/// The number other than an integer and zero that stands at a pointer, or what stands in the way.
fn number(whole: &Value, pointer: &str) -> std::result::Result<f64, String> {
    let (mut place, mut here) = (whole, String::new());
    for token in tokens(pointer) {
        let next = match place {
            Value::Array(items) => token.parse().ok().and_then(|i: usize| items.get(i)),
            other => other.get(&token),
        };
        place = next.ok_or_else(|| unknown(place, &here, &token))?;
        here = child(&here, &token);
    }
    match place {
        Value::Number(n) if n.is_f64() => match n.as_f64().unwrap_or_default() {
            0.0 => Err("it is 0, and derivatives are taken over relative changes; give it a small value".into()),
            value => Ok(value),
        },
        Value::Number(n) => Err(format!("it is the integer {n}, which cannot change by little")),
        Value::Object(members) => {
            let names: Vec<&str> = members.keys().map(String::as_str).collect();
            Err(format!("it is an object, not a number; it has {}", names.join(", ")))
        }
        Value::Array(items) => Err(format!(
            "it is an array of {}, not a number; name one of its places",
            items.len()
        )),
        Value::Null => Err("it has no value in this case".into()),
        other => Err(format!("it is {other}, not a number")),
    }
}

fn unknown(place: &Value, here: &str, token: &str) -> String {
    let of = if here.is_empty() { "the case" } else { here };
    match place {
        Value::Object(members) => {
            let near = case::nearest(token, members.keys().map(String::as_str));
            let near = near.map_or(String::new(), |name| format!("; did you mean `{name}`?"));
            format!("{of} has no `{token}`{near}")
        }
        Value::Array(items) => format!(
            "{of} is an array of {}; `{token}` is not one of its places",
            items.len()
        ),
        other => format!("{of} is {other}, which has no member `{token}`"),
    }
}

/// What a changed case was refused for.
fn refused(error: Error) -> String {
    match error {
        Error::Case(fault) => {
            let what = fault.violations.first().map_or(String::new(), |v| v.what.clone());
            format!("the case is no longer valid when it changes by 0.2 %: {what}")
        }
        other => other.to_string(),
    }
}
