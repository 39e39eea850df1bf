//! Checks of spans: whole segments that fill the beam, positive values, bladders that fit, and settings that require a uniform beam.

use super::{bladders, coefficients, plausible, span_sections, strength};
use crate::case::faults::Violations;
use crate::case::numbers::rounded as plain;
use crate::case::schema::{Beam, Bladders, Case, Formulation, ROUNDING, Span, SpanLengths, SpanRows};
use crate::case::{section, spans};
use crate::error::numbers::{counted, significant};
use crate::error::{Code, Violation};

/// Key of the area per pressure of the other row.
const OTHER_PRESSURE: &str = "area_per_other_pressure_m2_per_pa";

pub(super) fn check(case: &Case, faults: &mut Violations) {
    // a number of segments that is not allowed is reported by the schema
    if case.spans.is_empty() || !spans::countable(case) {
        return;
    }
    lengths(case, faults);
    for (k, span) in case.spans.iter().enumerate() {
        if let Some(section) = &span.section {
            span_sections::check(case, k, section, faults);
        }
        let of_section = span.section.is_some();
        for (key, given) in [
            ("rows", span.rows != SpanRows::Both),
            ("bladders", !span.bladders.is_empty()),
        ] {
            if case.bladders.is_none() && given && !of_section {
                let what = format!("\"{key}\" of a span without bladders: the case has none");
                let fault = Violation::new(Code::Together, format!("/spans/{k}/{key}"), what);
                faults.push(fault.hint("remove it for a dry beam, or add \"bladders\" to the case"));
            }
        }
        // values that a section with bladders gives are not those of the file, and other rows are reported by the section
        let written = match &span.section {
            Some(section) => section::rows(section) == SpanRows::None,
            None => case.bladders.is_some(),
        };
        if written && span.rows == SpanRows::None && !span.bladders.is_empty() {
            let what = "the span has values of bladders, but no bladders";
            let fault = Violation::new(Code::Together, format!("/spans/{k}/bladders"), what);
            faults.push(fault.hint("give \"rows\", or remove \"bladders\" from the span"));
        }
        if span.rows != SpanRows::Both && span.bladders.area_per_other_pressure_m2_per_pa.is_some() {
            let pointer = format!("/spans/{k}/bladders/{OTHER_PRESSURE}");
            let what = "the span has an area per pressure of the other row, but not both rows";
            faults
                .push(Violation::new(Code::Together, pointer, what).hint("remove it: its bladders have no other row"));
        }
        if span.beam.shear_stiffness_n.is_some() && case.beam.shear_stiffness_n.is_none() {
            let pointer = format!("/spans/{k}/beam/shear_stiffness_n");
            let fault = Violation::new(Code::Together, pointer, "shear in one span of a beam without shear");
            faults.push(fault.hint("give /beam/shear_stiffness_n for the other spans"));
        }
        positive(k, span, faults);
    }
    let none = case.bladders.is_some() && case.spans.iter().all(|span| span.rows == SpanRows::None);
    if none {
        let fault = Violation::new(Code::Together, "/spans", "no span has bladders");
        faults.push(fault.hint("give \"rows\" of a span, or null for /bladders, /fluid and /network: a dry beam"));
    }
    near_borders(case, faults);
    // values that stand in for those of an invalid section are doubtful
    if !faults.are_sound(&["/beam", "/bladders"]) {
        return;
    }
    if faults.is_empty() {
        values(case, faults);
    }
    let energy = |bladders: &Bladders| bladders.strain_energy.is_some();
    if faults.is_empty()
        && case.bladders.as_ref().is_some_and(energy)
        && let Some(span) = spans::first_of_other_section(case)
    {
        let what = "the span has bladders in another section than that of /bladders/strain_energy";
        let fault = Violation::new(Code::Together, format!("/spans/{span}"), what);
        let allowed = "the section, the bladders and the rows of the case, or \"rows\": \"none\"";
        faults.push(
            fault
                .allowed(allowed)
                .hint("or remove the strain energy; the section is then linear"),
        );
    }
    if faults.is_empty() {
        let (all, lengths) = (spans::segments(case), spans::segment_lengths(case));
        for ((span, _), (values, length)) in spans::places(case).into_iter().zip(all.iter().zip(lengths)) {
            if let (Some([upper, lower]), [true, true]) = (&values.bladders, values.rows)
                && let Some(fault) = coefficients::not_passive(upper, lower, &format!("/spans/{span}"))
            {
                faults.push(fault);
                break;
            }
            let rows = values.present().collect::<Vec<_>>();
            if let Some(what) = bladders::too_large(&values.beam, rows.into_iter(), length) {
                let fault = Violation::new(Code::Geometry, format!("/spans/{span}"), what);
                faults.push(fault.hint("give fewer segments, smaller bladders or a larger section in this span"));
                break;
            }
        }
    }
}

/// Checks the heights of the neutral axis and of the beam's line, and rejects settings of which the equations need both at one height.
pub(super) fn axes(case: &Case, faults: &mut Violations) {
    let uniform = [(None, case.beam.clone())];
    let graded = !case.spans.is_empty() && spans::countable(case) && spans::gives_axes(case);
    let graded = graded.then(|| spans::uniform_cases(case)).into_iter().flatten();
    let graded = graded.map(|(_, span, uniform)| (Some(span), uniform.beam));
    for (span, beam) in uniform.into_iter().chain(graded) {
        let half = 0.5 * beam.height_m * (1.0 + ROUNDING);
        let both = [
            (
                "neutral_axis_m",
                beam.neutral_axis_m,
                half,
                "the neutral axis is inside the section: at most half the height from mid-height",
            ),
            (
                "reference_axis_m",
                beam.line_height(),
                2.0 * half,
                "the beam's line is at most one height from mid-height",
            ),
        ];
        for (key, value, most, why) in both {
            if value.abs() > most && beam.height_m > 0.0 {
                let mut what = format!("{} m, in a section {} m high", plain(value), plain(beam.height_m));
                let given = span.map(|k| &case.spans[k].beam).is_none_or(|own| match key {
                    "neutral_axis_m" => own.neutral_axis_m.is_some(),
                    _ => own.reference_axis_m.is_some(),
                });
                // a span that gives no height has that of the case
                let (at, key) = match (given, span) {
                    (true, None) => ("/beam".to_owned(), key),
                    (true, Some(k)) => (format!("/spans/{k}/beam"), key),
                    _ if case.beam.reference_axis_m.is_some() => ("/beam".to_owned(), "reference_axis_m"),
                    _ => ("/beam".to_owned(), "neutral_axis_m"),
                };
                if let Some(k) = span.filter(|_| !given) {
                    what = format!("{what} in /spans/{k}");
                }
                let fault = Violation::new(Code::Range, format!("{at}/{key}"), what);
                faults.push(
                    fault
                        .allowed(format!("{} to {} m", plain(-most), plain(most)))
                        .hint(why),
                );
                return;
            }
        }
    }
    let raised = |beam: &Beam| beam.line_height() != 0.0;
    let in_spans = || spans::gives_axes(case) && spans::segments(case).iter().any(|one| raised(&one.beam));
    if (raised(&case.beam) || in_spans())
        && let Some(k) = case.contacts.iter().position(|contact| contact.reach_m.is_none())
    {
        let what = "contact of a beam whose line is not at mid-height";
        let fault = Violation::new(Code::Together, format!("/contacts/{k}"), what);
        faults.push(fault.hint("give reach_m: the distance of the touching surface from the beam's line"));
    }
    if !spans::is_eccentric(case) {
        return;
    }
    let mut refuse = |pointer: &str, what: &str, hint: &str| {
        let what = format!("{what} with a neutral axis that is not at the beam's line");
        faults.push(Violation::new(Code::Together, pointer, what).hint(hint));
    };
    let same = "give neutral_axis_m in /beam instead of in spans, without reference_axis_m: the beam's line is then at the neutral axis";
    if case.formulation == Formulation::Published {
        refuse(
            "/formulation",
            "the published form",
            "use \"conservative\", or set both axes to one height",
        );
    }
    if case.beam.viscoelasticity.is_some() {
        refuse("/beam/viscoelasticity", "a relaxing material", same);
    }
    let energy = |bladders: &Bladders| bladders.strain_energy.is_some() && spans::has_eccentric_bladders(case);
    if case.bladders.as_ref().is_some_and(energy) {
        refuse("/bladders/strain_energy", "a section at finite strain", same);
    }
    if case.segments().saturating_mul(case.mesh.cells_per_segment) < 2 {
        refuse("/mesh", "a mesh of one cell", "use at least two cells");
    }
}

/// Applies the rules for values of a beam to the uniform beam of each span, and reports the first fault of each span.
fn values(case: &Case, faults: &mut Violations) {
    let mut known = vec![];
    for (_, span, mut uniform) in spans::uniform_cases(case) {
        if known.contains(&span) {
            continue;
        }
        uniform.beam.length_m = case.beam.length_m;
        let mut own = Violations::default();
        if !case.plausibility.is_on() {
            own.take_as_meant();
        }
        for rule in [
            plausible::sizes,
            plausible::proportions,
            coefficients::check,
            strength::check,
        ] {
            rule(&uniform, &mut own);
        }
        let slopes = uniform
            .bladders
            .as_ref()
            .filter(|_| case.spans[span].rows != SpanRows::None);
        slopes.iter().for_each(|bladders| bladders::slopes(bladders, &mut own));
        if let Some(first) = own.first() {
            known.push(span);
            let what = format!("{} (at {} of this span)", first.what, first.pointer);
            let fault = Violation {
                pointer: format!("/spans/{span}"),
                what,
                ..first.clone()
            };
            faults.push(fault);
        }
    }
}

/// Checks that bodies with rotary inertia or an offset keep away from borders: their couple is distributed to cells of one section.
fn near_borders(case: &Case, faults: &mut Violations) {
    let (places, lengths) = (spans::places(case), spans::segment_lengths(case));
    let (total, per_segment) = (case.beam.length_m, case.mesh.cells_per_segment.max(1) as f64);
    let mut end = 0.0;
    let mut borders = vec![];
    for (k, pair) in places.windows(2).enumerate() {
        end += lengths[k] / total;
        if pair[0].0 != pair[1].0 {
            let cells = [lengths[k], lengths[k + 1]].map(|length| length / total / per_segment);
            borders.push((end, cells));
        }
    }
    for (k, one) in case.attachments.iter().enumerate() {
        let turns = one.rotary_inertia_kg_m2 > 0.0 || one.offset_across_m != 0.0 || one.offset_along_m != 0.0;
        let room = |(border, cells): &(f64, [f64; 2])| 2.0 * cells[usize::from(one.at > *border)];
        let near = |border: &&(f64, [f64; 2])| (one.at - border.0).abs() < room(border);
        if let Some(border) = borders.iter().find(near).filter(|_| turns) {
            let what = format!(
                "a body that turns with the beam, near the border of spans at {}",
                plain(border.0)
            );
            let fault = Violation::new(Code::Geometry, format!("/attachments/{k}/at"), what);
            let fault = fault.allowed(format!(
                "at least 2 cells ({} of the length) from the border",
                plain(room(border))
            ));
            faults.push(fault.hint("move the attachment, use more cells per segment, or leave out inertia and offset"));
        }
    }
}

/// Checks that the spans fill the beam with whole segments.
fn lengths(case: &Case, faults: &mut Violations) {
    let number = match case.bladders {
        Some(_) => "/bladders/per_row",
        None => "/mesh/segments",
    };
    let (all, segments, whole) = (SpanLengths::new(case), case.segments(), case.beam.length_m);
    let open: Vec<usize> = (0..case.spans.len())
        .filter(|&k| case.spans[k].length_m.is_none())
        .collect();
    if let [_, second, ..] = open[..] {
        let what = format!("{} without length", counted(open.len() as u64, "span"));
        let fault = Violation::new(Code::Geometry, format!("/spans/{second}"), what);
        faults.push(fault.allowed("one span without length_m: it is the rest of the beam"));
        return;
    }
    let given: f64 = case.spans.iter().filter_map(|span| span.length_m).sum();
    let longer = |span: &Span| span.length_m.is_some_and(|length| length > whole * (1.0 + ROUNDING));
    for k in (0..case.spans.len()).filter(|k| longer(&case.spans[*k])) {
        let what = format!("{} m is longer than the beam", plain(all.lengths[k]));
        let fault = Violation::new(Code::Geometry, format!("/spans/{k}/length_m"), what);
        faults.push_beside(
            &["/beam/length_m"],
            fault.allowed(format!("at most {} m", plain(whole))),
        );
    }
    if case.spans.iter().any(longer) {
        return;
    }
    if let Some(k) = open.first().filter(|_| given >= whole * (1.0 - ROUNDING)) {
        let what = "nothing of the beam is left for the span without length_m";
        let fault = Violation::new(Code::Geometry, format!("/spans/{k}"), what);
        faults.push(fault.hint("shorten other spans, or remove this one"));
        return;
    }
    if open.is_empty() && (given - whole).abs() > ROUNDING * whole {
        let what = format!(
            "the spans are {} m long together, the beam {} m",
            plain(given),
            plain(whole)
        );
        let fault = Violation::new(Code::Geometry, "/spans", what);
        faults.push(fault.hint("change a length_m, or omit that of one span: it is then the rest of the beam"));
        if case.spans.iter().any(|span| span.segments.is_some()) {
            return;
        }
    }
    counts(case, &all, number, segments, faults);
}

/// Checks the numbers of segments of spans whose lengths fill the beam.
fn counts(case: &Case, all: &SpanLengths, number: &str, segments: usize, faults: &mut Violations) {
    let given = case.spans.iter().filter_map(|span| span.segments);
    let given = given.fold(0, usize::saturating_add);
    let others = case.spans.iter().filter(|span| span.segments.is_none()).count();
    if (others == 0 && given != segments) || (others > 0 && given.saturating_add(others) > segments) {
        let what = match others {
            0 => format!(
                "the spans have {} together, {number} is {segments}",
                counted(given as u64, "segment")
            ),
            _ => format!(
                "{number} is {segments}, but the spans have {} and {} without a number of them",
                counted(given as u64, "segment"),
                counted(others as u64, "span")
            ),
        };
        let fault = Violation::new(Code::Geometry, "/spans", what);
        let allowed = match others {
            0 => format!("{number} {given}"),
            _ => format!("{number} of at least {}", given.saturating_add(others)),
        };
        faults.push(
            fault
                .allowed(allowed)
                .hint(format!("change {number} or the segments of a span")),
        );
        return;
    }
    let (pitch, own) = (all.pitch, all.left);
    for k in (0..case.spans.len()).filter(|k| all.counts[*k].is_none()) {
        let (length, key) = match case.spans[k].length_m {
            Some(length) => (length, format!("/spans/{k}/length_m")),
            None => (all.lengths[k], format!("/spans/{k}")),
        };
        let nearest = (length / pitch).round().max(1.0) * pitch;
        let of = match given {
            0 => format!(
                "(/beam/length_m {} m over {number} {segments})",
                plain(case.beam.length_m)
            ),
            _ => format!("({own} segments are left for spans without a number of them)"),
        };
        let what = format!(
            "{} m is not a whole number of segments of {} m {of}",
            plain(length),
            plain(pitch)
        );
        let fault = Violation::new(Code::Geometry, key, what);
        let fault = fault.allowed(format!("multiples of {} m; nearest {}", plain(pitch), plain(nearest)));
        faults.push(fault.hint(format!(
            "give \"segments\" of this span, or change its length, /beam/length_m or {number}"
        )));
    }
}

/// Checks that every value is positive and finite throughout the span.
fn positive(k: usize, span: &Span, faults: &mut Violations) {
    let signed = |key: &str| key.contains("axis") || key == OTHER_PRESSURE;
    for (part, key, profile) in span.given().filter(|(_, key, _)| !signed(key)) {
        if let Some(place) = profile.vanishes() {
            let value = significant(profile.value(place), 3);
            let what = format!("the value is {value} at {} of this span", significant(place, 3));
            let fault = Violation::new(Code::Range, format!("/spans/{k}/{part}/{key}"), what);
            faults.push(fault.allowed("numbers above 0 throughout the span"));
        }
    }
}
