//! Values of a structure that follow from others: lengths and numbers of segments, the spans of all beams one after the other.

use std::collections::HashMap;

use serde_json::{Map, Value, json};

use crate::case::presets::Preset;
use crate::case::schema::{Span, SpanLengths};
use crate::case::wording::nearest;
use crate::error::{Code, Violation};

/// Number of segments of a dry beam that gives none.
const SEGMENTS: u64 = 10;

/// Completes a structure in JSON. Unreadable parts remain as they are; the schema and the checks report them.
pub fn fill(case: &mut Value) {
    let Some(beams) = case
        .get("beams")
        .and_then(Value::as_array)
        .filter(|all| !all.is_empty())
    else {
        return;
    };
    let mut beams = beams.clone();
    let preset = case.get("preset").map(|_| Preset::MatiaGatBeam.values());
    let given = |pointer: &str| {
        let own = case.pointer(pointer);
        own.or_else(|| preset.as_ref()?.pointer(pointer)).cloned()
    };
    let dry = case.get("bladders").is_none_or(Value::is_null) && given("/bladders").is_none();
    let number = if dry { "/mesh/segments" } else { "/bladders/per_row" };
    let usual = [
        ("length_m", given("/beam/length_m")),
        ("segments", given(number).or_else(|| dry.then(|| SEGMENTS.into()))),
    ];
    let (mut spans, mut total, mut counts, mut first) = (vec![], 0.0, 0_u64, HashMap::new());
    for beam in beams.iter_mut().filter_map(Value::as_object_mut) {
        if beam.get("segments").is_none()
            && let Some(own) = segments_of_spans(beam)
        {
            beam.insert("segments".into(), own.into());
        }
        for (key, value) in &usual {
            if let Some(value) = value
                && !beam.contains_key(*key)
            {
                beam.insert((*key).into(), value.clone());
            }
        }
        let (length, segments) = size(beam);
        let name = beam.get("name").and_then(Value::as_str).unwrap_or_default();
        first.insert(name.to_owned(), (counts, segments));
        spans.extend(spans_of(beam, length, segments));
        (total, counts) = (total + length, counts.saturating_add(segments));
    }
    let Some(case) = case.as_object_mut() else { return };
    for key in ["network", "start"] {
        if let Some(part) = case.get_mut(key) {
            number_bladders(part, &first);
        }
    }
    case.insert("beams".into(), beams.into());
    case.insert("spans".into(), spans.into());
    set(case, "beam", "length_m", total.into());
    set(case, "mesh", "segments", counts.into());
    if !dry {
        set(case, "bladders", "per_row", counts.into());
    }
    case.entry("ends")
        .or_insert_with(|| json!({"root": "free", "tip": "free"}));
}

/// Sets a value of a part of the case, which a preset may supply.
fn set(case: &mut Map<String, Value>, part: &str, key: &str, value: Value) {
    let part = case.entry(part).or_insert_with(|| json!({}));
    if let Some(part) = part.as_object_mut() {
        part.insert(key.into(), value);
    }
}

/// Sum of the segments of the spans of a beam, if all give their number.
fn segments_of_spans(beam: &Map<String, Value>) -> Option<u64> {
    let spans = beam.get("spans")?.as_array().filter(|spans| !spans.is_empty())?;
    spans.iter().map(|span| span.get("segments")?.as_u64()).sum()
}

/// Length [m] and number of segments of a beam.
fn size(beam: &Map<String, Value>) -> (f64, u64) {
    let length = beam.get("length_m").and_then(Value::as_f64).unwrap_or(1.0);
    let segments = beam.get("segments").and_then(Value::as_u64).unwrap_or(SEGMENTS);
    (length, segments)
}

/// Spans of a beam, with lengths and numbers of segments.
fn spans_of(beam: &Map<String, Value>, length: f64, segments: u64) -> Vec<Value> {
    let given = beam
        .get("spans")
        .and_then(Value::as_array)
        .filter(|spans| !spans.is_empty());
    let Some(given) = given else {
        let mut span = Map::new();
        for key in ["rows", "beam", "bladders"] {
            if let Some(value) = beam.get(key) {
                span.insert(key.into(), value.clone());
            }
        }
        span.insert("length_m".into(), length.into());
        span.insert("segments".into(), segments.into());
        return vec![span.into()];
    };
    let mut spans = given.clone();
    let outlines = Span::outlines(&json!({"spans": given}));
    if outlines.len() == spans.len() {
        let lengths = SpanLengths::resolve(&outlines, length, segments as usize);
        let both = lengths.lengths.iter().zip(&lengths.counts);
        for (span, (length, count)) in spans.iter_mut().zip(both) {
            if let (Some(span), Some(count)) = (span.as_object_mut(), count) {
                span.insert("length_m".into(), (*length).into());
                span.insert("segments".into(), (*count).into());
            }
        }
    }
    spans
}

/// Replaces `"NAME:3"` by the number of that bladder among those of all beams.
fn number_bladders(value: &mut Value, first: &HashMap<String, (u64, u64)>) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(|item| number_bladders(item, first)),
        Value::Object(members) => members.values_mut().for_each(|member| number_bladders(member, first)),
        Value::String(text) => {
            if let Some(number) = numbered(text, first) {
                *value = number.into();
            }
        }
        _ => {}
    }
}

/// Number of a bladder `"NAME:3"` among those of all beams.
fn numbered(text: &str, first: &HashMap<String, (u64, u64)>) -> Option<i64> {
    let (name, number) = text.rsplit_once(':')?;
    let (before, segments) = first.get(name)?;
    let number: i64 = number.parse().ok()?;
    let there = (1..=*segments).contains(&number.unsigned_abs());
    there.then(|| number + number.signum() * *before as i64)
}

/// Faults of bladders of a filled structure whose names were not replaced by numbers.
pub fn unknown_bladders(case: &Value) -> Vec<Violation> {
    let beams = case.get("beams").and_then(Value::as_array);
    let beams: Vec<(&str, u64)> = beams
        .into_iter()
        .flatten()
        .filter_map(|beam| Some((beam.get("name")?.as_str()?, size(beam.as_object()?).1)))
        .collect();
    let mut faults = vec![];
    if !beams.is_empty() {
        for key in ["network", "start"] {
            let part = case.get(key).unwrap_or(&Value::Null);
            named_bladders(part, &format!("/{key}"), false, &mut |pointer, text| {
                faults.push(unknown_bladder(pointer, text, &beams));
            });
        }
    }
    faults
}

/// Visits the texts that stand for bladders.
fn named_bladders(value: &Value, pointer: &str, within: bool, each: &mut impl FnMut(&str, &str)) {
    match value {
        Value::Array(items) => {
            for (k, item) in items.iter().enumerate() {
                named_bladders(item, &format!("{pointer}/{k}"), within, each);
            }
        }
        Value::Object(members) => {
            for (key, member) in members {
                let within = key == "bladder" || key == "bladders";
                named_bladders(member, &format!("{pointer}/{key}"), within, each);
            }
        }
        Value::String(text) if within => each(pointer, text),
        _ => {}
    }
}

fn unknown_bladder(pointer: &str, text: &str, beams: &[(&str, u64)]) -> Violation {
    let allowed = "the name of a beam with a number, \"left:3\" in the upper and \"left:-3\" in the lower row";
    let names = || beams.iter().map(|(name, _)| *name);
    let (name, number) = text.rsplit_once(':').unwrap_or((text, ""));
    match beams.iter().find(|(known, _)| *known == name) {
        Some((name, segments)) if number.parse::<i64>().is_ok() => {
            let fault = Violation::new(Code::Name, pointer, format!("there is no bladder \"{text}\""));
            fault.allowed(format!(
                "{name}:1 to {name}:{segments} and {name}:-1 to {name}:-{segments}"
            ))
        }
        Some(_) => Violation::new(Code::Name, pointer, format!("\"{text}\" is not a bladder")).allowed(allowed),
        None => Violation {
            nearest: nearest(name, names()).map(|name| format!("{name}:{number}")),
            ..Violation::new(Code::Name, pointer, format!("there is no beam \"{name}\"")).allowed(allowed)
        },
    }
}
