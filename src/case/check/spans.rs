//! Checks of spans: whole segments that fill the beam, positive values, bladders that fit, and settings that require a uniform beam.

use super::bladders;
use crate::case::faults::Violations;
use crate::case::schema::{Case, Span, SpanRows};
use crate::case::spans;
use crate::error::numbers::{counted, significant};
use crate::error::{Code, Violation};

pub(super) fn check(case: &Case, faults: &mut Violations) {
    if case.spans.is_empty() {
        return;
    }
    lengths(case, faults);
    for (k, span) in case.spans.iter().enumerate() {
        if case.bladders.is_none() && (span.rows != SpanRows::Both || !span.bladders.is_empty()) {
            let what = "the span has values of bladders, but the case has no bladders";
            let fault = Violation::new(Code::Together, format!("/spans/{k}"), what);
            faults.push(fault.hint("add \"bladders\", or remove \"rows\" and \"bladders\" from the span"));
        }
        if span.beam.shear_stiffness_n.is_some() && case.beam.shear_stiffness_n.is_none() {
            let pointer = format!("/spans/{k}/beam/shear_stiffness_n");
            let fault = Violation::new(Code::Together, pointer, "shear in one span of a beam without shear");
            faults.push(fault.hint("give /beam/shear_stiffness_n for the other spans"));
        }
        positive(case, k, span, faults);
    }
    let none = case.bladders.is_some() && case.spans.iter().all(|span| span.rows == SpanRows::None);
    if none {
        let fault = Violation::new(Code::Together, "/spans", "no span has bladders");
        faults.push(fault.hint("give \"rows\" of a span, or null for /bladders, /fluid and /network: a dry beam"));
    }
    uniform_only(case, faults);
    if faults.is_empty() {
        let all = spans::segments(case);
        for ((span, _), values) in spans::places(case).into_iter().zip(&all) {
            let Some(own) = values.bladders.as_ref().filter(|_| values.rows != [false; 2]) else {
                continue;
            };
            if let Some(what) = bladders::too_large(&values.beam, own, spans::segment_length(case), values.rows) {
                let fault = Violation::new(Code::Geometry, format!("/spans/{span}"), what);
                faults.push(fault.hint("give smaller bladders or a larger section in this span"));
                break;
            }
        }
    }
}

/// Checks that the spans are whole segments and fill the beam.
fn lengths(case: &Case, faults: &mut Violations) {
    let (pitch, segments) = (spans::segment_length(case), case.segments());
    let counts = spans::counts(case);
    let open: Vec<usize> = (0..counts.len())
        .filter(|&k| case.spans[k].length_m.is_none())
        .collect();
    if let [_, second, ..] = open[..] {
        let what = format!("{} without length", counted(open.len() as u64, "span"));
        let fault = Violation::new(Code::Geometry, format!("/spans/{second}"), what);
        faults.push(fault.allowed("one span without length_m: it is the rest of the beam"));
        return;
    }
    let mut whole = true;
    for (k, (span, count)) in case.spans.iter().zip(&counts).enumerate() {
        let Some(length) = span.length_m.filter(|_| count.is_none()) else {
            continue;
        };
        whole = false;
        let nearest = (length / pitch).round().max(1.0) * pitch;
        let what = format!("{} m is not a whole number of segments", significant(length, 6));
        let fault = Violation::new(Code::Geometry, format!("/spans/{k}/length_m"), what).allowed(format!(
            "multiples of {} m; nearest {}",
            significant(pitch, 6),
            significant(nearest, 6)
        ));
        faults.push(fault.hint(match case.bladders {
            Some(_) => "segments have the length of the beam over /bladders/per_row; change one of the three",
            None => "segments have the length of the beam over /mesh/segments; change one of the three",
        }));
    }
    let total: usize = counts.iter().flatten().sum();
    if whole && (total != segments || counts.contains(&None)) {
        let what = format!(
            "the spans have {}, the beam has {segments} ({} m)",
            counted(total as u64, "segment"),
            significant(case.beam.length_m, 6)
        );
        let fault = Violation::new(Code::Geometry, "/spans", what);
        faults.push(fault.hint("omit length_m of one span: it is the rest of the beam"));
    }
}

/// Checks that every value is positive in the middle of every segment.
fn positive(case: &Case, k: usize, span: &Span, faults: &mut Violations) {
    let of_beam = span.beam.given().map(|(key, profile)| ("beam", key, profile));
    let of_bladders = span.bladders.given().map(|(key, profile)| ("bladders", key, profile));
    for (part, key, profile) in of_beam.chain(of_bladders) {
        let places = spans::places(case).into_iter().filter(|(span, _)| *span == k);
        let values = places.map(|(_, x)| profile.value(x));
        if let Some(value) = values.chain([profile.value(0.5)]).find(|v| !v.is_normal() || *v <= 0.0) {
            let what = format!("the value is {} in this span", significant(value, 3));
            let fault = Violation::new(Code::Range, format!("/spans/{k}/{part}/{key}"), what);
            faults.push(fault.allowed("numbers above 0 throughout the span"));
        }
    }
}

/// Rejects settings of which the equations are those of uniform beams.
fn uniform_only(case: &Case, faults: &mut Violations) {
    let mut refuse = |pointer: &str, what: &str, hint: &str| {
        let fault = Violation::new(Code::Together, pointer, format!("{what} is not available with spans"));
        faults.push(fault.hint(hint));
    };
    let sections = |span: &Span| span.beam.height_m.is_some() || span.beam.width_m.is_some();
    if case.spans.iter().any(sections) {
        let hint = "give all spans the height and width of the beam; grade young_modulus_pa and density_kg_m3";
        if case.surroundings.is_some() {
            refuse(
                "/surroundings",
                "an ambient fluid around sections of different sizes",
                hint,
            );
        }
        if !case.contacts.is_empty() {
            refuse("/contacts", "contact of sections of different sizes", hint);
        }
    }
    let Some(bladders) = &case.bladders else { return };
    if bladders.strain_energy.is_some() {
        let hint = "remove the strain energy; the section is then linear";
        refuse("/bladders/strain_energy", "a section at finite strain", hint);
    }
    let sizes = |span: &Span| span.bladders.height_m.is_some() || span.bladders.width_m.is_some();
    if case.spans.iter().any(sizes) {
        let hint = "give all bladders the same height and width, and grade area_per_pressure_m2_per_pa";
        if bladders.closing.is_some() {
            refuse(
                "/bladders/closing",
                "contact of the walls of bladders of different sizes",
                hint,
            );
        }
        if case.fluid.as_ref().is_some_and(|fluid| fluid.is_compressible()) {
            refuse("/fluid", "a compressible fluid in bladders of different sizes", hint);
        }
    }
}
