//! Checks of contacts: shape, stiffness, and friction.

use std::collections::HashMap;

use crate::case::faults::Violations;
use crate::case::numbers::digits;
use crate::case::schema::{Case, Contact};
use crate::error::{Code, Violation};

/// Largest radius and distance of a circle, in lengths of the beam: rounding errors of depths are below 1e-9 lengths. Its inverse is
/// the smallest radius.
const LARGEST: f64 = 1e6;
/// Smallest velocity over which friction is smoothed [m/s].
const SLOWEST: f64 = 1e-9;

/// Checks that a contact has a unique shape of a plausible size.
fn shape(case: &Case, contact: &Contact, pointer: &str, faults: &mut Violations) {
    let mut fault = |code, key: &str, what: &str, allowed: Option<String>, hint: &str| {
        let fault = Violation::new(code, format!("{pointer}{key}"), what).hint(hint);
        faults.push(allowed.into_iter().fold(fault, Violation::allowed));
    };
    let Some(circle) = &contact.circle else {
        match (&contact.point_m, &contact.normal) {
            (Some(_), Some(normal)) if normal.iter().all(|x| *x == 0.0) => {
                let hint = "[1, 0] is a wall below the beam, [-1, 0] one above it";
                fault(Code::Together, "/normal", "a normal of length zero", None, hint);
            }
            (Some(_), Some(_)) => {}
            _ => {
                let hint = "give point_m and normal of a wall, or circle";
                fault(Code::Missing, "", "a contact without a shape", None, hint);
            }
        }
        return;
    };
    if contact.point_m.is_some() || contact.normal.is_some() {
        let hint = "remove point_m and normal, or circle; a further obstacle is a further contact";
        let what = "a contact that is both a wall and a circle";
        fault(Code::Together, "/circle", what, None, hint);
    }
    let length = case.beam.length_m;
    let [smallest, largest] = [length / LARGEST, length * LARGEST];
    if circle.radius_m > largest || (0.0 < circle.radius_m && circle.radius_m < smallest) {
        let what = format!("a circle with a radius of {} m", digits(circle.radius_m));
        let hint = "radius_m is in meters; a circle without visible curvature is a wall: give point_m and normal";
        let allowed = format!(
            "{} to {} m, from a millionth to a million lengths of the beam",
            digits(smallest),
            digits(largest)
        );
        fault(Code::Implausible, "/circle/radius_m", &what, Some(allowed), hint);
    } else if circle.center_m.iter().any(|x| x.abs() > largest) {
        let what = "a center more than a million lengths of the beam away";
        let hint = "center_m is in meters";
        fault(Code::Implausible, "/circle/center_m", what, None, hint);
    }
    let reach = contact.reach_m.unwrap_or(0.5 * case.beam.height_m);
    if circle.inside && circle.radius_m <= reach {
        let what = format!(
            "the beam reaches {} m from its center line, which the circle does not contain",
            digits(reach)
        );
        let allowed = Some(format!("more than {} m", digits(reach)));
        let hint = "increase the radius, or give a smaller reach_m";
        fault(Code::Together, "/circle/radius_m", &what, allowed, hint);
    }
}

pub(super) fn check(case: &Case, faults: &mut Violations) {
    let mut known = HashMap::new();
    for (i, contact) in case.contacts.iter().enumerate() {
        let pointer = format!("/contacts/{i}");
        shape(case, contact, &pointer, faults);
        let mut fault = |key: &str, what: &str, hint: &str| {
            let at = if key.is_empty() {
                pointer.clone()
            } else {
                format!("{pointer}/{key}")
            };
            faults.push(Violation::new(Code::Together, at, what).hint(hint));
        };
        match (contact.stiffness_pa, contact.at, contact.stiffness_n_m) {
            (Some(_), None, None) | (None, Some(_), Some(_)) => {}
            _ => fault(
                "",
                &format!("a {} without a unique stiffness", contact.kind()),
                "give stiffness_pa for contact along the whole beam, or at and stiffness_n_m for contact at one place",
            ),
        }
        if contact
            .reach_m
            .is_some_and(|reach| reach > LARGEST * case.beam.length_m)
        {
            fault(
                "reach_m",
                "the touching surface is more than 1e6 beam lengths from the beam's line",
                "reach_m is in meters; absent: half the height",
            );
        }
        friction(
            &pointer,
            contact.friction_coefficient,
            contact.friction_velocity_m_s,
            faults,
        );
        named_once(&mut known, (&contact.name, &pointer), faults);
    }
}

/// Checks the coefficient of friction of a contact with the velocity below which friction falls.
pub(super) fn friction(pointer: &str, coefficient: f64, velocity: Option<f64>, faults: &mut Violations) {
    let mut fault = |key: &str, what: &str, hint: &str| {
        faults.push(Violation::new(Code::Together, format!("{pointer}/{key}"), what).hint(hint));
    };
    if velocity.is_some_and(|v| v < SLOWEST) {
        fault(
            "friction_velocity_m_s",
            "a friction velocity below 1e-9 m/s",
            "give about a hundredth of the sliding velocity",
        );
    }
    if coefficient > 0.0 && velocity.is_none() {
        fault(
            "friction_coefficient",
            "friction without friction_velocity_m_s",
            "give friction_velocity_m_s, about a hundredth of the sliding velocity",
        );
    }
    if coefficient == 0.0 && velocity.is_some() {
        fault(
            "friction_velocity_m_s",
            "a friction velocity without friction",
            "give friction_coefficient, or leave it out",
        );
    }
}

/// Checks that the name of a contact with this pointer is not that of one before, which are `known` with their pointers.
pub(super) fn named_once<'a>(
    known: &mut HashMap<&'a str, String>,
    (name, pointer): (&'a str, &str),
    faults: &mut Violations,
) {
    if let Some(first) = known.insert(name, pointer.to_owned()) {
        let what = format!("a second contact \"{name}\", the first is {first}");
        let fault = Violation::new(Code::Together, format!("{pointer}/name"), what);
        faults.push(fault.hint("columns of outputs have these names: give each contact its own"));
    }
}
