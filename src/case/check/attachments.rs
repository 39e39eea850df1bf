//! What is attached to the beam.

use crate::case::faults::Violations;
use crate::case::schema::Case;
use crate::error::{Code, Violation};

pub(super) fn check(case: &Case, faults: &mut Violations) {
    for (i, attachment) in case.attachments.iter().enumerate().filter(|(_, a)| a.is_empty()) {
        let what = format!("nothing is attached at {}", attachment.at);
        faults.push(
            Violation::new(Code::Missing, format!("/attachments/{i}"), what)
                .allowed("mass_kg, stiffness_x_n_m, stiffness_z_n_m, stiffness_rotation_n_m_rad, damping_x_n_s_m, damping_z_n_s_m above 0; force_x_n, force_z_n, force_tangential_n, force_normal_n")
                .hint("give one of them, or remove the entry"),
        );
    }
}
