//! Checks of bladders: required sections of the case, fit into the beam, order of the slopes.

use slcbeam_section::finite::energy::monomials;

use crate::case::faults::Violations;
use crate::case::numbers::rounded;
use crate::case::schema::{Beam, Bladders, Case, Coupling, Formulation, StrainEnergy, TurbineConductance};
use crate::case::spans;
use crate::case::wiring::bladder_index;
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
    if index.is_some_and(|index| !spans::has_bladder(case, index)) {
        let segment = number.unsigned_abs() as usize - 1;
        let span = spans::places(case).get(segment).map_or(0, |place| place.0);
        let what = format!("there is no bladder {number}: /spans/{span} has none in this row");
        let fault = Violation::new(Code::Wiring, pointer, what);
        faults.push(fault.hint(format!(
            "change /spans/{span}/rows, or name another bladder; numbers count segments"
        )));
        return None;
    }
    if index.is_none() {
        let fault = Violation::new(Code::Wiring, pointer, format!("there is no bladder {number}"));
        let allowed = format!("1 to {per_row} (upper row) and -1 to -{per_row} (lower row)");
        faults.push(fault.allowed(allowed));
    }
    index
}

/// Why bladders do not fit into a segment of this length [m] with these rows; none if they fit.
pub(super) fn too_large(beam: &Beam, bladders: &Bladders, segment: f64, rows: [bool; 2]) -> Option<String> {
    let stacked = rows.iter().filter(|row| **row).count() as f64;
    let sizes = [
        (
            "the width of a bladder",
            bladders.width_m,
            "the length of a segment",
            segment,
        ),
        (
            "the height of the bladders",
            stacked * bladders.height_m,
            "the height of the beam",
            beam.height_m,
        ),
        (
            "the length of a bladder",
            bladders.length_m,
            "the width of the beam",
            beam.width_m,
        ),
    ];
    let large = sizes.into_iter().find(|(_, size, _, room)| *size > room * (1.0 + 1e-9));
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
    let segment = beam.length_m / bladders.per_row.max(1) as f64;
    // Tolerance for rounding errors of decimal fractions.
    let exceeds = |size: f64, room: f64| size > room * (1.0 + 1e-9);
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
            format!("at most {} m each, the length of a segment", rounded(segment)),
        );
    }
    if exceeds(2.0 * bladders.height_m, beam.height_m) {
        let what = format!(
            "two rows of bladders of height {} m do not fit above each other",
            bladders.height_m
        );
        refuse(
            "height_m",
            &["/beam/height_m"],
            what,
            format!(
                "at most {} m, half the height of the beam",
                rounded(beam.height_m / 2.0)
            ),
        );
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

/// Checks a strain energy: number of coefficients, limits on both sides of zero, reciprocal coupling, conservative formulation.
fn strain_energy(case: &Case, bladders: &Bladders, energy: &StrainEnergy, faults: &mut Violations) {
    let at = "/bladders/strain_energy";
    // an invalid degree already has its fault from the schema
    let (degree, given) = (energy.degree, energy.coefficients_n.len());
    let wanted = || monomials(degree).count();
    if faults.are_sound(&[at]) && given != wanted() {
        let what = format!("{given} coefficients of degree {degree}");
        let fault = Violation::new(Code::Count, format!("{at}/coefficients_n"), what);
        faults.push(fault.allowed(wanted().to_string()));
    }
    let keys = ["stretch", "curvature_1_m", "upper_pressure_pa", "lower_pressure_pa"];
    for (key, [low, high]) in keys.into_iter().zip(energy.limits()) {
        if low > 0.0 || high < 0.0 || low == high {
            let fault = Violation::new(Code::Range, format!("{at}/{key}"), format!("limits {low} and {high}"));
            faults.push(fault.allowed("one below zero and one above"));
        }
    }
    let mut refuse = |place: &str, what: &str, allowed: &str| {
        let what = format!("a section with a strain energy and {what}");
        let fault = Violation::new(Code::Together, place, what).allowed(allowed);
        faults.push(fault.hint("or leave the strain energy out: \"strain_energy\": null"));
    };
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
