//! Coefficients of a section about its neutral axis.

use slcbeam_section::coefficients::{Numbers, RowCoefficients};
use slcbeam_section::input::Section;

use super::unit_cell::ALIKE;

/// Stiffness and areas about the neutral axis, from the compliance about mid-height: with `M = M_n + d N`,
///
/// ```text
/// d = -C_NM/C_MM      1/EA = C_NN - C_NM²/C_MM      1/EI = C_MM      φ_b l_b an_R = C_NR + d C_MR      φ_b l_b R am_R = C_MR
/// ```
pub(super) struct AboutNeutralAxis {
    /// `d` [m]; 0 if force and curvature are not coupled.
    pub offset: f64,
    /// `f_e` about the neutral axis.
    pub axial_stiffness_factor: f64,
}

impl AboutNeutralAxis {
    pub fn new(section: &Section, numbers: &Numbers) -> Self {
        let c = &numbers.compliance;
        if numbers.force_curvature_coupling.abs() <= ALIKE {
            return Self {
                offset: 0.0,
                axial_stiffness_factor: numbers.axial_stiffness_factor,
            };
        }
        let axial = c[0][0] - c[0][1] * c[0][1] / c[1][1];
        let full = section.material.young_modulus_pa * section.height_m * section.width_m;
        Self {
            offset: -c[0][1] / c[1][1],
            axial_stiffness_factor: 1.0 / (axial * full),
        }
    }

    /// `am` and `an` of a row, `sign` its R.
    pub fn slopes(&self, row: &RowCoefficients, sign: f64) -> (f64, f64) {
        let of_moment = row.area_per_moment_m2_per_n_m;
        (of_moment, row.area_per_force_m2_per_n + self.offset * sign * of_moment)
    }
}
