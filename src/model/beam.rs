//! The cross-section of the beam: mass, stiffness, rotary inertia, damping.

use super::BendingLaw;
use super::surroundings::AmbientSection;
use crate::case::schema::{Beam, Bladders, Case, Viscoelasticity};
use crate::case::spans::{self, SegmentValues};

/// Constants of the cross-section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// `f_m`: mass over that of the full solid section [1].
    pub mass_factor: f64,
    /// `m = rho_s w_s h_s f_m` [kg/m].
    pub mass_per_length: f64,
    /// `h_s/2` [m].
    pub half_height: f64,
    /// `z_n - z_r`: height of the neutral axis above the beam's line [m].
    pub offset: f64,
    /// `z_r`: height of the beam's line above mid-height [m].
    pub line_height: f64,
    /// `EA = E h_s w_s f_e` [N] (A.37).
    pub axial_stiffness: f64,
    /// `EI = E (w_s h_s^3/12) f_i` [N m^2] (A.38); of a moment-curvature law its slope at zero.
    pub bending_stiffness: f64,
    /// Largest slope of the moment over curvature [N m^2].
    pub steepest_bending: f64,
    /// `kGA` [N]; infinite without shear.
    pub shear_stiffness: f64,
    /// `y11 = (rho_s/m) (w_s h_s^3/12) f_i` [m^2].
    pub gyration_radius_squared: f64,
    /// `tau_a` [s].
    pub axial_damping_time: f64,
    /// `tau_b` [s].
    pub bending_damping_time: f64,
    /// `c` [N s/m^2].
    pub drag: f64,
    /// Ambient fluid.
    pub ambient: AmbientSection,
    /// `c_2` [N s^2/m^3].
    pub quadratic_drag: f64,
    /// `1 + Σ g`: instantaneous over long-term stiffness of a relaxing solid.
    pub stiffening: f64,
}

impl Section {
    /// Distance of the farthest fiber from the beam's line [m].
    pub fn farthest_fiber(&self) -> f64 {
        self.half_height + self.line_height.abs()
    }

    /// True if moments depend on rates of strain.
    pub fn bends_viscously(&self) -> bool {
        self.bending_damping_time > 0.0 || (self.axial_damping_time > 0.0 && self.offset != 0.0)
    }

    /// True if forces on the straight beam depend on its node velocities.
    pub fn resists_motion(&self) -> bool {
        self.drag > 0.0 || self.quadratic_drag > 0.0 || self.axial_damping_time > 0.0
    }

    /// Angular frequency of bending with shear [1/s]: `ω/√(1 + EI k²/(kGA))`, `k² = ω √(m/EI)`; exact for pinned ends.
    pub fn sheared(&self, omega: f64) -> f64 {
        let squared = omega * (self.mass_per_length / self.bending_stiffness).sqrt();
        omega / (1.0 + self.bending_stiffness * squared / self.shear_stiffness).sqrt()
    }

    /// `[E1]` (2, A.1):
    ///
    /// ```text
    /// f_m = (n w_b h_b l_b ρ_f + (l_s w_s h_s - n w_b h_b l_b) ρ_s)/(l_s w_s h_s ρ_s)
    /// m = ρ_s w_s h_s f_m    EA = E h_s w_s f_e    EI = E (w_s h_s³/12) f_i    y11 = (ρ_s/m) (w_s h_s³/12) f_i
    /// ```
    pub fn new(case: &Case) -> Self {
        let rows = spans::rows(case).into_iter().filter(|row| *row);
        Self::with_values(case, &case.beam, rows.flat_map(|_| &case.bladders))
    }

    /// Sections of the segments of a beam with spans.
    pub fn of_segments(case: &Case, values: &[SegmentValues]) -> Vec<Self> {
        let of = |one: &SegmentValues| Self::with_values(case, &one.beam, one.present());
        values.iter().map(of).collect()
    }

    /// Sections within the segments of tapers, at the ends and the midpoints of their cells alternately.
    pub fn within_segments(case: &Case, values: &[SegmentValues]) -> Vec<Vec<Self>> {
        let beams = spans::within(case, values, 2 * case.mesh.cells_per_segment);
        let of = |(one, beams): (&SegmentValues, Vec<Beam>)| {
            let each = beams.iter().map(|beam| Self::with_values(case, beam, one.present()));
            each.collect()
        };
        values.iter().zip(beams).map(of).collect()
    }

    /// Section with the mean mass and the mean compliances of segments of some lengths, the largest height and the largest offset: it
    /// has their extension by a constant force, and their deflection by a constant moment.
    pub fn mean(of: &[Self], lengths: &[f64]) -> Option<Self> {
        let first = of.first()?;
        if of.iter().all(|one| one == first) {
            return Some(*first);
        }
        let total: f64 = lengths.iter().sum();
        let mean = |value: &dyn Fn(&Self) -> f64| {
            let each = of.iter().zip(lengths);
            each.map(|(one, length)| value(one) * length).sum::<f64>() / total
        };
        let mass = mean(&|one| one.mass_per_length);
        let steepening = of.iter().map(|one| one.steepest_bending / one.bending_stiffness);
        let steepening = steepening.fold(1.0, f64::max);
        Some(Self {
            mass_factor: mean(&|one| one.mass_factor),
            mass_per_length: mass,
            half_height: of.iter().map(|one| one.half_height).fold(0.0, f64::max),
            offset: of
                .iter()
                .map(|one| one.offset)
                .fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a }),
            line_height: mean(&|one| one.line_height),
            axial_stiffness: 1.0 / mean(&|one| 1.0 / one.axial_stiffness),
            bending_stiffness: 1.0 / mean(&|one| 1.0 / one.bending_stiffness),
            steepest_bending: steepening / mean(&|one| 1.0 / one.bending_stiffness),
            shear_stiffness: 1.0 / mean(&|one| 1.0 / one.shear_stiffness),
            ambient: AmbientSection::mean(|value| mean(&|one: &Self| value(&one.ambient))),
            gyration_radius_squared: mean(&Self::rotary_inertia) / mass,
            axial_damping_time: mean(&|one| one.axial_damping_time),
            bending_damping_time: mean(&|one| one.bending_damping_time),
            ..*first
        })
    }

    /// `m` less the mass per length of the displaced ambient fluid [kg/m]; gravity acts on it.
    pub fn weighing_per_length(&self) -> f64 {
        self.mass_per_length - self.ambient.displaced
    }

    /// `m y11` [kg m].
    pub fn rotary_inertia(&self) -> f64 {
        self.mass_per_length * self.gyration_radius_squared
    }

    /// Section of a beam, with the mass of the cavities of its rows of bladders.
    fn with_values<'a>(case: &Case, beam: &Beam, rows: impl Iterator<Item = &'a Bladders>) -> Self {
        let solid = beam.length_m * beam.width_m * beam.height_m;
        let cavity = |b: &Bladders| b.per_row as f64 * b.width_m * b.height_m * b.length_m;
        let (cavities, fluid_density) = match &case.fluid {
            Some(f) => (rows.map(cavity).sum(), f.density_kg_m3),
            None => (0.0, 0.0),
        };
        let mass_factor = beam.mass_factor.unwrap_or(
            (cavities * fluid_density + (solid - cavities) * beam.density_kg_m3) / (solid * beam.density_kg_m3),
        );
        let mass_per_length = beam.density_kg_m3 * beam.width_m * beam.height_m * mass_factor;
        let relaxing = beam.viscoelasticity.as_ref().and_then(Viscoelasticity::branches);
        let ratios = relaxing.iter().flatten().map(|branch| branch.modulus_ratio);
        let second_moment = beam.second_moment();
        let law = beam.moment_curvature.as_ref().and_then(BendingLaw::new);
        Self {
            mass_factor,
            mass_per_length,
            half_height: 0.5 * beam.height_m,
            offset: beam.neutral_axis_m - beam.line_height(),
            line_height: beam.line_height(),
            axial_stiffness: beam.young_modulus_pa * beam.height_m * beam.width_m * beam.axial_stiffness_factor,
            bending_stiffness: beam.young_modulus_pa * second_moment,
            steepest_bending: law.map_or(beam.young_modulus_pa * second_moment, |law| law.steepest()),
            shear_stiffness: beam.shear_stiffness_n.unwrap_or(f64::INFINITY),
            ambient: (case.surroundings.as_ref())
                .map_or_else(AmbientSection::default, |around| AmbientSection::new(around, beam)),
            gyration_radius_squared: beam.density_kg_m3 / mass_per_length * second_moment,
            axial_damping_time: beam.damping.axial_time_s,
            bending_damping_time: beam.damping.bending_time_s,
            drag: beam.damping.drag_n_s_m2,
            quadratic_drag: beam.damping.quadratic_drag_n_s2_m3,
            stiffening: 1.0 + ratios.sum::<f64>(),
        }
    }
}
