//! Checks of attachments to the beam.

use crate::case::faults::Violations;
use crate::case::numbers::{digits, rounded};
use crate::case::schema::Case;
use crate::error::{Code, Violation};

/// Largest offset of a center of mass from its attachment point, in beam lengths.
const FAR: f64 = 10.0;
/// Largest rotary inertia of an attachment, in beam masses at the distance `FAR`.
const HEAVY: f64 = 100.0;

/// Places at which a stiffness is checked.
const SAMPLES: u32 = 1000;

const LENGTH: &str = "/beam/length_m";
/// Pointers of the values that determine the mass of the beam.
const MASS: [&str; 5] = [
    LENGTH,
    "/beam/height_m",
    "/beam/width_m",
    "/beam/density_kg_m3",
    "/beam/mass_factor",
];

/// Checks that a foundation has a stiffness, nowhere below 0.
fn foundation(case: &Case, faults: &mut Violations) {
    let Some(foundation) = &case.foundation else { return };
    let given = foundation.stiffness();
    for (key, profile) in given.into_iter().filter_map(|(key, profile)| Some((key, profile?))) {
        let least = (0..=SAMPLES)
            .map(|k| profile.value(f64::from(k) / f64::from(SAMPLES)))
            .fold(f64::INFINITY, f64::min);
        if least < 0.0 {
            let what = format!("the stiffness of the foundation falls to {} N/m^2", digits(least));
            let fault = Violation::new(Code::Range, format!("/foundation/{key}"), what);
            faults.push(fault.allowed("0 or more along the whole beam"));
        }
    }
    if given.iter().all(|(_, profile)| profile.is_none()) {
        let fault = Violation::new(Code::Missing, "/foundation", "a foundation without stiffness");
        let fault = fault.allowed("stiffness_x_n_m2 (across), stiffness_z_n_m2 (along)");
        faults.push(fault.hint("give one of them, or remove the foundation"));
    }
}

pub(super) fn check(case: &Case, faults: &mut Violations) {
    foundation(case, faults);
    let beam = &case.beam;
    let far = FAR * beam.length_m;
    let volume = beam.height_m * beam.width_m * beam.length_m;
    let hardest = HEAVY * beam.density_kg_m3 * volume * beam.mass_factor.unwrap_or(1.0) * far * far;
    for (i, attachment) in case.attachments.iter().enumerate() {
        let pointer = format!("/attachments/{i}");
        for (key, offset) in attachment.offsets().into_iter().filter(|(_, offset)| *offset != 0.0) {
            let at = format!("{pointer}/{key}");
            if attachment.mass_kg == 0.0 {
                let fault = Violation::new(Code::Together, at, "an offset without a mass");
                faults.push(fault.hint("give mass_kg, or leave it out"));
            } else if offset.abs() > far {
                let what = format!("a mass centre {offset} m from the attachment point");
                let fault = Violation::new(Code::Implausible, at, what);
                let fault = fault.allowed(format!("-{0} to {0} m, ten lengths of the beam", rounded(far)));
                faults.push_beside(&[LENGTH], fault);
            }
        }
        let inertia = attachment.rotary_inertia_kg_m2;
        if inertia > hardest && hardest > 0.0 {
            let what = format!(
                "{} kg m^2 is more than 100 beam masses at a distance of ten beam lengths have",
                digits(inertia)
            );
            let fault = Violation::new(Code::Implausible, format!("{pointer}/rotary_inertia_kg_m2"), what);
            let hint = "rotary inertias are in kg m^2; a g mm^2 is 1e-9";
            let fault = fault.allowed(format!("up to {} kg m^2", digits(hardest)));
            faults.push_beside(&MASS, fault.hint(hint));
        }
        if attachment.is_empty() {
            let what = format!("nothing is attached at {}", attachment.at);
            faults.push(
                Violation::new(Code::Missing, pointer, what)
                    .allowed("mass_kg, rotary_inertia_kg_m2, stiffness_x_n_m, stiffness_z_n_m, stiffness_rotation_n_m_rad, damping_x_n_s_m, damping_z_n_s_m above 0; force_x_n, force_z_n, force_tangential_n, force_normal_n")
                    .hint("give one of them, or remove the entry"),
            );
        }
    }
}
