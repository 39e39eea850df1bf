//! Values of beam and bladders along the axis: those of each segment, from the spans of a case.

use std::ops::RangeInclusive;

use serde_json::{Value, json};

use super::scaling::CoefficientSizes;
use super::schema::{Beam, Bladders, Case, Span, SpanRows};

/// Relative deviation of a span's length from whole segments that counts as rounding.
const WHOLE: f64 = 1e-6;

/// Beam and bladders of one segment.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentValues {
    /// Rows that have a bladder here: upper, lower.
    pub rows: [bool; 2],
    /// Values of the solid.
    pub beam: Beam,
    /// Values of the bladders; none for a dry beam.
    pub bladders: Option<Bladders>,
}

/// Numbers of segments that the schema allows; a list of more may not fit into memory.
const POSSIBLE: RangeInclusive<usize> = 1..=1_000_000;

/// True if the number of segments is one that the schema allows, so that spans can be resolved.
pub fn countable(case: &Case) -> bool {
    POSSIBLE.contains(&case.segments())
}

/// Length of a segment [m].
pub fn segment_length(case: &Case) -> f64 {
    case.beam.length_m / case.segments() as f64
}

/// Number of segments of each span; none for a length that is not a whole number of segments, if nothing is left for a span without
/// length, or if the number of all segments is not allowed.
pub fn counts(case: &Case) -> Vec<Option<usize>> {
    if !countable(case) {
        return vec![None; case.spans.len()];
    }
    let pitch = segment_length(case);
    let whole = |length: f64| {
        let count = (length / pitch).round();
        let fits = count >= 1.0 && count <= case.segments() as f64;
        (fits && (length / pitch - count).abs() <= WHOLE * count).then_some(count as usize)
    };
    let given: Vec<Option<usize>> = case.spans.iter().map(|span| span.length_m.and_then(whole)).collect();
    // each count is at most that of all segments, so that no sum overflows
    let rest = case.segments().saturating_sub(given.iter().flatten().sum());
    let rest = Some(rest).filter(|rest| *rest > 0);
    let counts = case.spans.iter().zip(given);
    counts
        .map(|(span, given)| if span.length_m.is_none() { rest } else { given })
        .collect()
}

/// Span and place within it, from 0 to 1, of the middle of each segment; empty for a beam without spans.
pub fn places(case: &Case) -> Vec<(usize, f64)> {
    let all = counts(case).into_iter().enumerate();
    let within = |(span, count): (usize, Option<usize>)| {
        let count = count.unwrap_or(0);
        (0..count).map(move |k| (span, (k as f64 + 0.5) / count as f64))
    };
    all.flat_map(within).collect()
}

/// True if a bladder `0..n`, upper row first, exists.
pub fn has_bladder(case: &Case, bladder: usize) -> bool {
    bladders(case)(bladder)
}

/// Existence of each bladder `0..n`, upper row first.
pub fn bladders(case: &Case) -> impl Fn(usize) -> bool + '_ {
    let (segments, places) = (case.segments(), places(case));
    // faulty spans are reported by themselves
    let faulty = places.len() != segments;
    move |bladder| faulty || case.spans[places[bladder % segments].0].rows.has()[bladder / segments]
}

/// Values of each segment; empty for a uniform beam, with the values of the case everywhere. Coefficients that a span does not give
/// follow modulus and sizes.
pub fn segments(case: &Case) -> Vec<SegmentValues> {
    if case.spans.is_empty() {
        return vec![];
    }
    let whole = json!({"beam": case.beam, "bladders": case.bladders, "fluid": case.fluid, "tubes": case.tubes});
    let places = places(case);
    let all: Vec<SegmentValues> = places
        .iter()
        .map(|&(span, x)| values(case, &whole, &case.spans[span], x))
        .collect();
    let rows = [case.bladders.is_some(); 2];
    let uniform = |one: &SegmentValues| one.rows == rows && one.beam == case.beam && one.bladders == case.bladders;
    match all.iter().all(uniform) {
        true => vec![],
        false => all,
    }
}

/// Least Young's modulus of the solid [Pa].
pub fn softest_modulus(case: &Case) -> f64 {
    let moduli = segments(case).into_iter().map(|values| values.beam.young_modulus_pa);
    moduli.reduce(f64::min).unwrap_or(case.beam.young_modulus_pa)
}

/// Cases of uniform beams with the values of each segment, of equal neighbors in a span one; each with its first segment and its span.
pub fn uniform_cases(case: &Case) -> impl Iterator<Item = (usize, usize, Case)> + '_ {
    let all = segments(case);
    let places = places(case);
    (0..all.len()).filter_map(move |k| {
        let span = places[k].0;
        if k > 0 && places[k - 1].0 == span && all[k - 1] == all[k] {
            return None;
        }
        let uniform = Case {
            spans: vec![],
            beam: all[k].beam.clone(),
            bladders: all[k].bladders.clone(),
            ..case.clone()
        };
        Some((k, span, uniform))
    })
}

/// Values at a place of a span.
fn values(case: &Case, whole: &Value, span: &Span, x: f64) -> SegmentValues {
    let mut here = whole.clone();
    let mut numbers: Vec<(String, f64)> = vec![];
    for (part, key, profile) in span.given() {
        // an optional number that the case leaves out
        if let Some(Value::Object(part)) = here.get_mut(part) {
            part.entry(key).or_insert(Value::Null);
        }
        numbers.push((format!("/{part}/{key}"), profile.value(x)));
    }
    if let Some(slopes) = &span.bladders.area_per_moment_m2_per_n_m {
        let key = "/bladders/area_per_moment_m2_per_n_m";
        numbers.extend([
            (format!("{key}/opening"), slopes.opening),
            (format!("{key}/closing"), slopes.closing),
        ]);
    }
    if let Some(slopes) = &span.bladders.area_per_force_m2_per_n {
        let key = "/bladders/area_per_force_m2_per_n";
        numbers.extend([
            (format!("{key}/tension"), slopes.tension),
            (format!("{key}/compression"), slopes.compression),
        ]);
    }
    let numbers: Vec<(&str, f64)> = numbers.iter().map(|(pointer, x)| (pointer.as_str(), *x)).collect();
    CoefficientSizes::default().change(&mut here, &numbers);
    let mut beam: Beam = serde_json::from_value(here["beam"].take()).unwrap_or_else(|_| case.beam.clone());
    let bladders: Option<Bladders> =
        serde_json::from_value(here["bladders"].take()).unwrap_or_else(|_| case.bladders.clone());
    let rows = match &bladders {
        Some(_) => span.rows,
        None => SpanRows::None,
    };
    if rows == SpanRows::None && case.bladders.is_some() {
        let own = |profile: &Option<_>, full: f64, value: f64| if profile.is_some() { value } else { full };
        beam.axial_stiffness_factor = own(&span.beam.axial_stiffness_factor, 1.0, beam.axial_stiffness_factor);
        beam.bending_stiffness_factor = own(&span.beam.bending_stiffness_factor, 1.0, beam.bending_stiffness_factor);
        beam.mass_factor = beam.mass_factor.filter(|_| span.beam.mass_factor.is_some());
    }
    SegmentValues {
        rows: rows.has(),
        beam,
        bladders,
    }
}
