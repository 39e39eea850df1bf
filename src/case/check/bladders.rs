//! Checks of bladders: required sections of the case, fit into the beam, order of the slopes.

use slcbeam_section::finite::energy::monomials;

use super::{coefficients, plausible};
use crate::case::bladder_numbers;
use crate::case::faults::Violations;
use crate::case::numbers::rounded;
use crate::case::schema::{
    Beam, Bladders, Case, Coupling, Formulation, LowerRow, ROUNDING, StrainEnergy, TurbineConductance,
};
use crate::case::spans;
use crate::case::wiring::{BladderLabels, bladder_index};
use crate::error::numbers::counted;
use crate::error::{Code, Violation};

pub(super) fn check(case: &Case, faults: &mut Violations) {
    match (&case.bladders, &case.fluid) {
        (Some(bladders), fluid) => {
            if fluid.is_none() {
                let fault = Violation::new(Code::Together, "/bladders", "bladders without a fluid to fill them");
                faults.push_at_key(fault.hint("add \"fluid\", or remove \"bladders\" for a dry beam"));
            }
            fits(case, bladders, faults);
            slopes(bladders, faults);
            lower_row(case, bladders, faults);
            coefficients::other_pressure(case, bladders, faults);
            if let Some(energy) = &bladders.strain_energy {
                strain_energy(case, bladders, energy, faults);
            }
            if bladders.permeability_m4.is_some() && bladders.cross_section.is_some() {
                two_permeabilities("/bladders", faults);
            }
        }
        (None, _) => dry(case, faults),
    }
}

/// Rejects values that require bladders, in a case without bladders. A network of junctions needs none.
fn dry(case: &Case, faults: &mut Violations) {
    let joined = case
        .network
        .as_ref()
        .map(|network| network.tubes.len() + network.turbines.len());
    match joined {
        Some(0) => {
            let fault = Violation::new(
                Code::Together,
                "/network",
                "a network without bladders, tubes and turbines",
            );
            faults.push_at_key(fault.hint("add \"bladders\" or tubes between junctions, or remove \"network\""));
        }
        Some(_) if case.fluid.is_none() => {
            let fault = Violation::new(Code::Together, "/network", "a network without a fluid to fill it");
            faults.push_at_key(fault.hint("add \"fluid\", or remove \"network\" for a dry beam"));
        }
        _ => {}
    }
    let turbines = case.network.iter().flat_map(|network| &network.turbines).enumerate();
    for (i, _) in turbines.filter(|(_, one)| matches!(one.conductance, TurbineConductance::Kappa { .. })) {
        let what = "kappa, a multiple of the conductance of a bladder, without bladders";
        let fault = Violation::new(Code::Together, format!("/network/turbines/{i}/conductance"), what);
        faults.push_at_key(fault.hint("give \"m3_s_pa\""));
    }
    let present = [
        ("/fluid", case.fluid.is_some() && joined.is_none()),
        ("/tubes", case.tubes.is_some() && joined.is_none()),
        ("/start/pressures", !case.start.pressures.is_empty()),
    ];
    for (pointer, _) in present.iter().filter(|(_, present)| *present) {
        let key = pointer.rsplit('/').next().unwrap_or_default();
        let fault = Violation::new(Code::Together, *pointer, format!("\"{key}\" without bladders"));
        faults.push_at_key(fault.hint("add \"bladders\", or remove this for a dry beam"));
    }
}

/// Index of a bladder by its number; reports a fault if there is none.
pub(super) fn existing(number: i64, case: &Case, pointer: &str, faults: &mut Violations) -> Option<usize> {
    let per_row = case.segments();
    if case.bladders.is_none() {
        let fault = Violation::new(
            Code::Wiring,
            pointer,
            format!("there is no bladder {number}: the case has no bladders"),
        );
        faults.push(fault.hint("add \"bladders\", or name a junction"));
        return None;
    }
    let index = bladder_index(number, per_row);
    let label = BladderLabels::from_case(case).of_number(number);
    if let Some((cause, hint)) = bladder_numbers::absence(case, number) {
        // one fault for all bladders of a row
        let fault = Violation::new(Code::Wiring, pointer, format!("there is no bladder {label}: {cause}"));
        faults.push_once(&cause, fault.hint(hint));
        return None;
    }
    if index.is_none() {
        let fault = Violation::new(Code::Wiring, pointer, format!("there is no bladder {label}"));
        faults.push(fault.allowed(bladder_numbers::existing(case)));
    }
    index
}

/// Why the bladders of the rows of a segment of this length [m] do not fit into it; none if they fit.
pub(super) fn too_large<'a>(
    beam: &Beam,
    rows: impl Iterator<Item = &'a Bladders> + Clone,
    segment: f64,
) -> Option<String> {
    let stacked: f64 = rows.clone().map(|bladders| bladders.height_m).sum();
    let largest = |size: fn(&Bladders) -> f64| rows.clone().map(size).fold(0.0, f64::max);
    let sizes = [
        (
            "the width of a bladder",
            largest(|bladders| bladders.width_m),
            "the length of a segment",
            segment,
        ),
        (
            "the height of the bladders",
            stacked,
            "the height of the beam",
            beam.height_m,
        ),
        (
            "the length of a bladder",
            largest(|bladders| bladders.length_m),
            "the width of the beam",
            beam.width_m,
        ),
    ];
    let large = sizes
        .into_iter()
        .find(|(_, size, _, room)| *size > room * (1.0 + ROUNDING));
    large.map(|(what, size, of, room)| format!("{what} is {} m in this span, {of} {} m", rounded(size), rounded(room)))
}

/// Pointer of the number of bladders per row.
pub(super) const PER_ROW: &str = "/bladders/per_row";

fn fits(case: &Case, bladders: &Bladders, faults: &mut Violations) {
    let beam = &case.beam;
    let mut refuse = |key: &str, beside: &[&str], what: String, allowed: String| {
        let fault = Violation::new(Code::Geometry, format!("/bladders/{key}"), what).allowed(allowed);
        faults.push_beside(beside, fault);
    };
    let segment = longest_segment(case);
    let exceeds = |size: f64, room: f64| size > room * (1.0 + ROUNDING);
    if exceeds(bladders.width_m, segment) {
        let what = format!(
            "no room along the beam for {} of width {} m",
            counted(bladders.per_row as u64, "bladder"),
            bladders.width_m
        );
        refuse(
            "width_m",
            &["/beam/length_m", PER_ROW],
            what,
            format!("at most {} m each, the length of the longest segment", rounded(segment)),
        );
    }
    let stacked = match &bladders.lower {
        LowerRow::Mirrored => 2.0 * bladders.height_m,
        LowerRow::None => bladders.height_m,
        LowerRow::Unlike(row) => bladders.height_m + row.height_m.unwrap_or(bladders.height_m),
    };
    if exceeds(stacked, beam.height_m) {
        let (what, allowed) = match &bladders.lower {
            LowerRow::Mirrored => (
                format!(
                    "two rows of bladders of height {} m do not fit above each other",
                    bladders.height_m
                ),
                format!(
                    "at most {} m, half the height of the beam",
                    rounded(beam.height_m / 2.0)
                ),
            ),
            _ => (
                format!("the bladders above each other are {} m high", rounded(stacked)),
                format!("at most {} m, the height of the beam", rounded(beam.height_m)),
            ),
        };
        let at = match &bladders.lower {
            LowerRow::Unlike(row) if row.height_m.is_some() => "lower/unlike/height_m",
            _ => "height_m",
        };
        refuse(at, &["/beam/height_m", "/bladders/lower"], what, allowed);
    }
    if exceeds(bladders.length_m, beam.width_m) {
        let what = format!(
            "a bladder of length {} m does not fit across the beam",
            bladders.length_m
        );
        refuse(
            "length_m",
            &["/beam/width_m"],
            what,
            format!("at most {} m, the width of the beam", beam.width_m),
        );
    }
    if let Some(segments) = case.mesh.segments.filter(|segments| *segments != bladders.per_row) {
        let fault = Violation::new(
            Code::Geometry,
            "/mesh/segments",
            format!(
                "{} for {} per row",
                counted(segments as u64, "segment"),
                counted(bladders.per_row as u64, "bladder")
            ),
        );
        let fault = fault.allowed(bladders.per_row.to_string());
        let hint = "leave it out: it is the number of bladders per row";
        faults.push_beside(&[PER_ROW], fault.hint(hint));
    }
}

pub(super) fn slopes(bladders: &Bladders, faults: &mut Violations) {
    let (moment, force) = (&bladders.area_per_moment_m2_per_n_m, &bladders.area_per_force_m2_per_n);
    let pairs = [
        (
            "/bladders/area_per_moment_m2_per_n_m",
            "closing",
            moment.closing,
            "opening",
            moment.opening,
        ),
        (
            "/bladders/area_per_force_m2_per_n",
            "compression",
            force.compression,
            "tension",
            force.tension,
        ),
    ];
    for (pointer, large_key, large, small_key, small) in pairs {
        if large < small {
            let what = format!("the slope {large_key} ({large}) is smaller than {small_key} ({small})");
            let fault = Violation::new(Code::Slopes, format!("{pointer}/{large_key}"), what);
            let fault = fault.allowed(format!("at least {small}"));
            let hint = "closing stiffens a bladder; are the two exchanged?";
            faults.push_beside(&[&format!("{pointer}/{small_key}")], fault.hint(hint));
        }
    }
}

/// Checks a lower row that is not the mirror image of the upper one.
fn lower_row(case: &Case, bladders: &Bladders, faults: &mut Violations) {
    const AT: &str = "/bladders/lower";
    if bladders.lower.is_mirrored() {
        return;
    }
    let mut refuse = |place: &str, what: &str, hint: &str| {
        let fault = Violation::new(Code::Together, place, format!("{what} needs two equal rows"));
        faults.push(fault.hint(hint));
    };
    if case.formulation == Formulation::Published {
        refuse(
            "/formulation",
            "the published form",
            "use \"conservative\", or remove /bladders/lower",
        );
    }
    if matches!(bladders.coupling, Coupling::Published(_)) {
        refuse(
            "/bladders/coupling",
            "the published coupling",
            "use \"reciprocal\", or remove /bladders/lower",
        );
    }
    if !matches!(bladders.lower, LowerRow::Unlike(_)) {
        return;
    }
    let Some(own) = spans::lower_bladders(case).filter(|_| faults.is_empty()) else {
        return;
    };
    if exceeds_segment(case, &own) {
        let fault = Violation::new(
            Code::Geometry,
            format!("{AT}/unlike/width_m"),
            "no room along the beam for the lower bladders",
        );
        faults.push(fault.allowed("at most the length of a segment"));
    }
    let mut found = Violations::default();
    if !case.plausibility.is_on() {
        found.take_as_meant();
    }
    slopes(&own, &mut found);
    let alone = Case {
        bladders: Some(Bladders {
            lower: LowerRow::None,
            ..own
        }),
        ..case.clone()
    };
    plausible::sizes(&alone, &mut found);
    coefficients::check(&alone, &mut found);
    if let Some(first) = found.first() {
        let key = first.pointer.trim_start_matches("/bladders/");
        faults.push(Violation {
            pointer: format!("{AT}/unlike"),
            what: format!("{} ({key} of the lower row)", first.what),
            ..first.clone()
        });
    }
}

/// Length of the longest segment [m] that may have bladders of the width of the case; each segment of a span is checked by itself.
fn longest_segment(case: &Case) -> f64 {
    if !spans::countable(case) {
        return 0.0;
    }
    let places = spans::places(case);
    let of_case = |k: usize| {
        places
            .get(k)
            .is_none_or(|(span, _)| case.spans[*span].bladders.width_m.is_none())
    };
    let lengths = spans::segment_lengths(case).into_iter().enumerate();
    let lengths = lengths.filter_map(|(k, length)| of_case(k).then_some(length));
    lengths.reduce(f64::max).unwrap_or(f64::INFINITY)
}

/// True if a bladder is wider than a segment is long.
fn exceeds_segment(case: &Case, bladders: &Bladders) -> bool {
    bladders.width_m > longest_segment(case) * (1.0 + ROUNDING)
}

/// Checks a strain energy: number of coefficients, limits on both sides of zero, reciprocal coupling, conservative formulation.
fn strain_energy(case: &Case, bladders: &Bladders, energy: &StrainEnergy, faults: &mut Violations) {
    let at = "/bladders/strain_energy";
    // an invalid degree already has its fault from the schema
    let (degree, given) = (energy.degree, energy.coefficients_n.len());
    let wanted = || monomials(degree, energy.mirrored).count();
    if faults.are_sound(&[at]) && given != wanted() {
        let what = format!("{given} coefficients of degree {degree}");
        let fault = Violation::new(Code::Count, format!("{at}/coefficients_n"), what);
        faults.push(fault.allowed(wanted().to_string()));
    }
    let keys = ["stretch", "curvature_1_m", "upper_pressure_pa", "lower_pressure_pa"];
    for (key, [low, high]) in keys.into_iter().zip(energy.limits()) {
        let absent = key.starts_with("lower") && bladders.lower == LowerRow::None;
        if low > 0.0 || high < 0.0 || (low == high && !absent) {
            let fault = Violation::new(Code::Range, format!("{at}/{key}"), format!("limits {low} and {high}"));
            faults.push(fault.allowed("one below zero and one above"));
        }
    }
    let mut refuse = |place: &str, what: &str, allowed: &str| {
        let what = format!("a section with a strain energy and {what}");
        let fault = Violation::new(Code::Together, place, what).allowed(allowed);
        faults.push(fault.hint("or leave the strain energy out: \"strain_energy\": null"));
    };
    if energy.mirrored && !bladders.lower.is_mirrored() {
        refuse(
            &format!("{at}/mirrored"),
            "rows that are not mirrored",
            "false, with coefficients of all terms",
        );
    }
    if bladders.coupling != Coupling::Reciprocal {
        let what = "a coupling that is not reciprocal";
        refuse("/bladders/coupling", what, "\"reciprocal\"");
    }
    if case.formulation != Formulation::Conservative {
        refuse("/formulation", "a formulation without a potential", "\"conservative\"");
    }
}

/// Reports a permeability given together with a cross-section, from which another permeability would follow.
pub(super) fn two_permeabilities(pointer: &str, faults: &mut Violations) {
    let fault = Violation::new(
        Code::Slopes,
        format!("{pointer}/cross_section"),
        "both a permeability and a cross-section, which determines the permeability",
    );
    faults.push_at_key(fault.hint("keep \"permeability_m4\" or \"cross_section\""));
}
