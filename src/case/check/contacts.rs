//! Checks of walls: direction of the normal, stiffness, and friction.

use std::collections::HashMap;

use crate::case::faults::Violations;
use crate::case::schema::Case;
use crate::error::{Code, Violation};

pub(super) fn check(case: &Case, faults: &mut Violations) {
    let mut known = HashMap::new();
    for (i, contact) in case.contacts.iter().enumerate() {
        let pointer = format!("/contacts/{i}");
        let mut fault = |key: &str, what: &str, hint: &str| {
            let at = if key.is_empty() {
                pointer.clone()
            } else {
                format!("{pointer}/{key}")
            };
            faults.push(Violation::new(Code::Together, at, what).hint(hint));
        };
        if contact.normal.iter().all(|x| *x == 0.0) {
            fault(
                "normal",
                "a normal of length zero",
                "[1, 0] is a wall below the beam, [-1, 0] one above it",
            );
        }
        match (contact.stiffness_pa, contact.at, contact.stiffness_n_m) {
            (Some(_), None, None) | (None, Some(_), Some(_)) => {}
            _ => fault(
                "",
                "a wall without a unique stiffness",
                "give stiffness_pa for a wall along the whole beam, or at and stiffness_n_m for contact at one place",
            ),
        }
        if contact.friction_coefficient > 0.0 && contact.friction_velocity_m_s.is_none() {
            fault(
                "friction_coefficient",
                "friction without friction_velocity_m_s",
                "give friction_velocity_m_s, about a hundredth of the sliding velocity",
            );
        }
        if contact.friction_coefficient == 0.0 && contact.friction_velocity_m_s.is_some() {
            fault(
                "friction_velocity_m_s",
                "a friction velocity without friction",
                "give friction_coefficient, or leave it out",
            );
        }
        if let Some(first) = known.insert(&contact.name, i) {
            let what = format!("a second contact \"{}\", the first is /contacts/{first}", contact.name);
            fault(
                "name",
                &what,
                "columns of outputs have these names: give each contact its own",
            );
        }
    }
}
