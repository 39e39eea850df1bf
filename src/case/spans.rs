//! Values of beam and bladders along the axis: those of each segment, from the spans of a case.

use std::iter;
use std::ops::RangeInclusive;

use serde_json::{Value, json};

use super::scaling::CoefficientSizes;
use super::schema::{AreaPerForce, AreaPerMoment, Beam, Bladders, Case, LowerRow, Span, SpanLengths, SpanRows};
use crate::functions::Profile;

/// `kGA/(E A)` of a full rectangle, nearly incompressible: 5/6 of a third.
const FULL_SHEAR: f64 = 5.0 / 18.0;

/// Beam and bladders of one segment.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentValues {
    /// Rows that have a bladder here: upper, lower.
    pub rows: [bool; 2],
    /// Values of the solid. Its length is that of a beam of as many segments, all like this one.
    pub beam: Beam,
    /// Values of the bladders of the upper row and of the lower one; none for a dry beam.
    pub bladders: Option<[Bladders; 2]>,
}

impl SegmentValues {
    /// Values of the bladders that exist here.
    pub fn present(&self) -> impl Iterator<Item = &Bladders> {
        let both = self.bladders.iter().flatten().zip(self.rows);
        both.filter(|(_, there)| *there).map(|(bladders, _)| bladders)
    }
}

/// Numbers of segments that the schema allows; a list of more may not fit into memory.
const POSSIBLE: RangeInclusive<usize> = 1..=1_000_000;

/// True if all numbers of segments are those that the schema allows, so that spans can be resolved.
pub fn countable(case: &Case) -> bool {
    let of_spans = case.spans.iter().filter_map(|span| span.segments);
    of_spans
        .chain([case.segments()])
        .all(|number| POSSIBLE.contains(&number))
}

/// Length of each segment [m].
pub fn segment_lengths(case: &Case) -> Vec<f64> {
    let (places, lengths) = (places(case), SpanLengths::new(case));
    match places.len() == case.segments() {
        true => places.into_iter().map(|(span, _)| lengths.pitch_of(span)).collect(),
        // without spans, or with faulty ones
        false => vec![lengths.pitch; case.segments()],
    }
}

/// Place of the root end of each segment, and of the tip [m].
pub fn segment_ends(case: &Case) -> Vec<f64> {
    let lengths = segment_lengths(case);
    let mut end = 0.0;
    let ends = lengths.into_iter().map(|length| {
        end += length;
        end
    });
    iter::once(0.0).chain(ends).collect()
}

/// Span and place within it, from 0 to 1, of the middle of each segment; empty for a beam without spans or with faulty lengths.
pub fn places(case: &Case) -> Vec<(usize, f64)> {
    if case.spans.is_empty() || !countable(case) {
        return vec![];
    }
    // at most all segments, so that a list of them fits into memory
    let counts: Option<Vec<usize>> = SpanLengths::new(case).counts.into_iter().collect();
    let all = counts.filter(|counts| {
        counts.iter().try_fold(0, |sum: usize, count| sum.checked_add(*count)) == Some(case.segments())
    });
    let within = |(span, count): (usize, usize)| (0..count).map(move |k| (span, (k as f64 + 0.5) / count as f64));
    all.into_iter().flatten().enumerate().flat_map(within).collect()
}

/// True if a bladder `0..n`, upper row first, exists.
pub fn has_bladder(case: &Case, bladder: usize) -> bool {
    bladders(case)(bladder)
}

/// Existence of each bladder `0..n`, upper row first.
pub fn bladders(case: &Case) -> impl Fn(usize) -> bool + '_ {
    let (segments, places) = (case.segments().max(1), places(case));
    let rows = rows(case);
    // faulty spans are reported by themselves
    let uniform = places.len() != segments;
    move |bladder| {
        let row = (bladder / segments).min(1);
        rows[row] && (uniform || case.spans[places[bladder % segments].0].rows.has()[row])
    }
}

/// Rows that the bladders of a case have outside of spans: upper, lower.
pub fn rows(case: &Case) -> [bool; 2] {
    let bladders = case.bladders.as_ref();
    [
        bladders.is_some(),
        bladders.is_some_and(|bladders| bladders.lower != LowerRow::None),
    ]
}

/// Values of each segment; empty for a uniform beam with two equal rows or none, with the values of the case everywhere. Coefficients that
/// a span or a row does not give follow modulus and sizes.
pub fn segments(case: &Case) -> Vec<SegmentValues> {
    let mirrored = case
        .bladders
        .as_ref()
        .is_none_or(|bladders| bladders.lower.is_mirrored());
    if (mirrored && case.spans.is_empty()) || !countable(case) {
        return vec![];
    }
    let (whole, pitch) = (both_rows(case), SpanLengths::new(case).pitch);
    if case.spans.is_empty() {
        return vec![values(case, &whole, &Span::default(), 0.5, None); case.segments()];
    }
    let all = places(case).into_iter().zip(segment_lengths(case));
    let all: Vec<SegmentValues> = all
        .map(|((span, x), length)| {
            let own = Some(length).filter(|length| *length != pitch);
            let of_beam = own.map(|length| length * case.segments() as f64);
            values(case, &whole, &case.spans[span], x, of_beam)
        })
        .collect();
    let rows = [case.bladders.is_some(); 2];
    let own = |bladders: &[Bladders; 2]| bladders.iter().all(|own| Some(own) == case.bladders.as_ref());
    let uniform =
        |one: &SegmentValues| one.rows == rows && one.beam == case.beam && one.bladders.as_ref().is_none_or(own);
    match all.iter().all(uniform) {
        true => vec![],
        false => all,
    }
}

/// Values of the solid within the segments of tapers, from those in the middle of each segment: at the ends of `parts` equal parts of the
/// segment. Empty for segments with constant values, and for a beam without tapers. A moment-curvature law belongs to a whole segment.
pub fn within(case: &Case, segments: &[SegmentValues], parts: usize) -> Vec<Vec<Beam>> {
    let graded = |span: &Span| span.beam.given().any(|(_, profile)| profile.uniform().is_none());
    if segments.is_empty() || bends_nonlinearly(case) || !case.spans.iter().any(graded) {
        return vec![];
    }
    let counts = SpanLengths::new(case).counts.into_iter().flatten();
    let all = case.spans.iter().zip(counts).flat_map(|(span, count)| {
        let index = move |k: usize, part: usize| (k as f64 + part as f64 / parts as f64) / count as f64;
        (0..count).map(move |k| (span, (0..=parts).map(move |part| index(k, part))))
    });
    let of = |(middle, (span, x)): (&SegmentValues, (&Span, _))| match graded(span) {
        true => Iterator::map(x, |x| taper(span, &middle.beam, x)).collect(),
        false => vec![],
    };
    segments.iter().zip(all).map(of).collect()
}

/// Values of the solid at places, each a segment and the place within it from 0 to 1.
pub fn solids(case: &Case, at: &[(usize, f64)]) -> Vec<Beam> {
    let (segments, places, counts) = (segments(case), places(case), SpanLengths::new(case).counts);
    let whole = bends_nonlinearly(case);
    let of = |(segment, at): &(usize, f64)| {
        let Some(middle) = segments.get(*segment) else {
            return case.beam.clone();
        };
        match places.get(*segment) {
            Some(&(span, x)) if !whole => {
                let count = counts[span].unwrap_or(1) as f64;
                taper(&case.spans[span], &middle.beam, x + (at - 0.5) / count)
            }
            _ => middle.beam.clone(),
        }
    };
    at.iter().map(of).collect()
}

/// Values of the solid at a place of a span, from those at another place. Those that the span does not give follow the scaling laws of
/// its section.
fn taper(span: &Span, other: &Beam, x: f64) -> Beam {
    let (mut beam, given) = (other.clone(), &span.beam);
    let here = |profile: &Option<Profile>| profile.as_ref().map(|profile| profile.value(x));
    let set = |value: &mut f64, profile: &Option<Profile>| *value = here(profile).unwrap_or(*value);
    set(&mut beam.height_m, &given.height_m);
    set(&mut beam.width_m, &given.width_m);
    set(&mut beam.young_modulus_pa, &given.young_modulus_pa);
    set(&mut beam.density_kg_m3, &given.density_kg_m3);
    set(&mut beam.axial_stiffness_factor, &given.axial_stiffness_factor);
    set(&mut beam.bending_stiffness_factor, &given.bending_stiffness_factor);
    let stiffness = |beam: &Beam| beam.young_modulus_pa * beam.height_m * beam.width_m;
    let [stiffer, higher] = [stiffness(&beam) / stiffness(other), beam.height_m / other.height_m];
    beam.neutral_axis_m *= higher;
    set(&mut beam.neutral_axis_m, &given.neutral_axis_m);
    let shear = beam.shear_stiffness_n.map(|shear| shear * stiffer);
    beam.shear_stiffness_n = here(&given.shear_stiffness_n).or(shear);
    beam.mass_factor = here(&given.mass_factor).or(beam.mass_factor);
    beam.reference_axis_m = here(&given.reference_axis_m).or(beam.reference_axis_m);
    beam
}

/// A case in JSON with the bladders of the upper row and of the lower one.
fn both_rows(case: &Case) -> [Value; 2] {
    let mut beam = json!(case.beam);
    if case.spans.iter().any(|span| span.segments.is_some()) {
        beam["length_m"] = (SpanLengths::new(case).pitch * case.segments() as f64).into();
    }
    if gives_axes(case) {
        // the line stays where it is if the neutral axis of a span is elsewhere
        beam["reference_axis_m"] = case.beam.line_height().into();
    }
    let part = |bladders: Option<&Bladders>| json!({"beam": beam, "bladders": bladders, "fluid": case.fluid, "tubes": case.tubes});
    let lower = lower_bladders(case);
    [case.bladders.as_ref(), lower.as_ref()].map(part)
}

/// First span that has bladders, but not the elastic section, the bladders and the rows of the case.
pub fn first_of_other_section(case: &Case) -> Option<usize> {
    let mut usual = values(case, &both_rows(case), &Span::default(), 0.5, None);
    let unlike = |one: &SegmentValues| {
        // mass and damping do not strain the section
        usual.beam.damping = one.beam.damping.clone();
        usual.beam.density_kg_m3 = one.beam.density_kg_m3;
        usual.beam.mass_factor = one.beam.mass_factor;
        one.present().next().is_some() && *one != usual
    };
    let first = segments(case).iter().position(unlike)?;
    Some(places(case).get(first)?.0)
}

/// True if the beam or a span gives the height of an axis; otherwise all are at mid-height.
pub fn gives_axes(case: &Case) -> bool {
    let in_span = |span: &Span| span.beam.neutral_axis_m.is_some() || span.beam.reference_axis_m.is_some();
    let in_beam = case.beam.neutral_axis_m != 0.0 || case.beam.reference_axis_m.is_some();
    in_beam || case.spans.iter().any(in_span)
}

/// True if the neutral axis is beside the beam's line somewhere.
pub fn is_eccentric(case: &Case) -> bool {
    any_off_line(case, |_| true)
}

/// True if the neutral axis is beside the beam's line where the beam has bladders.
pub fn has_eccentric_bladders(case: &Case) -> bool {
    any_off_line(case, |one| one.present().next().is_some())
}

/// True if the neutral axis is beside the beam's line in a segment; a uniform beam counts as one.
fn any_off_line(case: &Case, segment: impl Fn(&SegmentValues) -> bool) -> bool {
    let off = |beam: &Beam| beam.neutral_axis_m != beam.line_height();
    match case.spans.is_empty() {
        true => off(&case.beam),
        false => gives_axes(case) && segments(case).iter().any(|one| segment(one) && off(&one.beam)),
    }
}

/// Bladders of the lower row of a case with the values of its own row; those of the case if it is mirrored or missing.
pub fn lower_bladders(case: &Case) -> Option<Bladders> {
    let bladders = case.bladders.as_ref()?;
    let LowerRow::Unlike(row) = &bladders.lower else {
        return Some(bladders.clone());
    };
    let mut own = json!({"beam": case.beam, "bladders": bladders, "fluid": case.fluid, "tubes": case.tubes});
    let given = [
        ("height_m", row.height_m),
        ("width_m", row.width_m),
        ("area_per_pressure_m2_per_pa", row.area_per_pressure_m2_per_pa),
        ("permeability_m4", row.permeability_m4),
    ];
    let given = given.into_iter().filter_map(|(key, value)| Some((key, value?)));
    let mut numbers: Vec<(String, f64)> = given.map(|(key, value)| (format!("/bladders/{key}"), value)).collect();
    numbers.extend(slopes(&row.area_per_moment_m2_per_n_m, &row.area_per_force_m2_per_n));
    change(&mut own, &numbers);
    serde_json::from_value(own["bladders"].take()).ok()
}

/// Pointers and values of the slopes of a row or a span.
fn slopes(
    by_moment: &Option<AreaPerMoment>,
    by_force: &Option<AreaPerForce>,
) -> impl Iterator<Item = (String, f64)> + use<> {
    let by_moment = by_moment.as_ref().map(|slopes| {
        [
            ("area_per_moment_m2_per_n_m/opening", slopes.opening),
            ("area_per_moment_m2_per_n_m/closing", slopes.closing),
        ]
    });
    let by_force = by_force.as_ref().map(|slopes| {
        [
            ("area_per_force_m2_per_n/tension", slopes.tension),
            ("area_per_force_m2_per_n/compression", slopes.compression),
        ]
    });
    let all = by_moment.into_iter().chain(by_force).flatten();
    all.map(|(key, value)| (format!("/bladders/{key}"), value))
}

/// Sets numbers of a case in JSON, also those that it leaves out, and scales its other coefficients.
fn change(case: &mut Value, numbers: &[(String, f64)]) {
    for (pointer, _) in numbers {
        if let Some((part, key)) = pointer[1..].split_once('/')
            && let Some(Value::Object(part)) = case.get_mut(part)
            && !key.contains('/')
        {
            part.entry(key).or_insert(Value::Null);
        }
    }
    let numbers: Vec<(&str, f64)> = numbers.iter().map(|(pointer, x)| (pointer.as_str(), *x)).collect();
    CoefficientSizes::default().change(case, &numbers);
}

/// True if the beam or a span has a moment-curvature law.
pub fn bends_nonlinearly(case: &Case) -> bool {
    let mut spans = case.spans.iter().map(|span| &span.beam.moment_curvature);
    case.beam.moment_curvature.is_some() || spans.any(Option::is_some)
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
    let span_of = move |k: usize| places.get(k).map_or(0, |place| place.0);
    (0..all.len()).filter_map(move |k| {
        let span = span_of(k);
        if k > 0 && span_of(k - 1) == span && all[k - 1] == all[k] {
            return None;
        }
        let uniform = Case {
            spans: vec![],
            beam: all[k].beam.clone(),
            bladders: all[k].bladders.as_ref().map(|[upper, _]| upper.clone()),
            ..case.clone()
        };
        Some((k, span, uniform))
    })
}

/// Values at a place of a span, from those of a case in JSON with the bladders of the upper and of the lower row. `length` is that of a
/// beam with segments like this one [m], if they are not those of the case.
fn values(case: &Case, whole: &[Value; 2], span: &Span, x: f64, length: Option<f64>) -> SegmentValues {
    let given = span.given();
    let mut numbers: Vec<(String, f64)> = given
        .map(|(part, key, profile)| (format!("/{part}/{key}"), profile.value(x)))
        .chain(length.map(|length| ("/beam/length_m".to_owned(), length)))
        .collect();
    let own = &span.bladders;
    numbers.extend(slopes(&own.area_per_moment_m2_per_n_m, &own.area_per_force_m2_per_n));
    let here = |whole: &Value| {
        let mut here = whole.clone();
        change(&mut here, &numbers);
        here
    };
    let [mut upper, mut lower] = match whole[0] == whole[1] {
        true => {
            let both = here(&whole[0]);
            [both.clone(), both]
        }
        false => [here(&whole[0]), here(&whole[1])],
    };
    let mut beam: Beam = serde_json::from_value(upper["beam"].take()).unwrap_or_else(|_| case.beam.clone());
    span.beam.damping.apply(&mut beam.damping);
    if let Some(law) = &span.beam.moment_curvature {
        beam.moment_curvature = Some(law.clone());
    }
    let row = |here: &mut Value| -> Option<Bladders> {
        serde_json::from_value(here["bladders"].take()).unwrap_or_else(|_| case.bladders.clone())
    };
    let bladders = row(&mut upper).zip(row(&mut lower));
    let possible = rows(case);
    let there = span.rows.has();
    let rows = [0, 1].map(|row| possible[row] && there[row]);
    if span.rows == SpanRows::None && case.bladders.is_some() {
        let own = |profile: &Option<_>, full: f64, value: f64| if profile.is_some() { value } else { full };
        beam.axial_stiffness_factor = own(&span.beam.axial_stiffness_factor, 1.0, beam.axial_stiffness_factor);
        beam.bending_stiffness_factor = own(&span.beam.bending_stiffness_factor, 1.0, beam.bending_stiffness_factor);
        beam.moment_curvature.clone_from(&span.beam.moment_curvature);
        beam.neutral_axis_m = own(&span.beam.neutral_axis_m, 0.0, beam.neutral_axis_m);
        beam.mass_factor = beam.mass_factor.filter(|_| span.beam.mass_factor.is_some());
        if span.beam.shear_stiffness_n.is_none() {
            let full = FULL_SHEAR * beam.young_modulus_pa * beam.height_m * beam.width_m;
            beam.shear_stiffness_n = beam.shear_stiffness_n.map(|_| full);
        }
    }
    SegmentValues {
        rows,
        beam,
        bladders: bladders.map(|(upper, lower)| [upper, lower]),
    }
}
