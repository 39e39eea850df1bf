//! Rotation of sections: rotary inertia and shear, estimated with the second bending mode.

use super::EffectScene;

impl EffectScene<'_> {
    /// Second bending frequency [1/s] and wavenumber [1/m].
    fn second_mode(&self) -> (f64, f64) {
        let k = 4.694_091_132_974 / self.case.beam.length_m;
        let stiffness = self.section.bending_stiffness / self.section.mass_per_length;
        (k * k * stiffness.sqrt(), k)
    }

    /// True if loads act suddenly enough to excite bending waves of all lengths.
    pub fn sudden(&self, tolerance: f64) -> bool {
        self.inertia_ratio(self.second_mode().0) >= tolerance
    }

    /// `y11 k²/2 (1 + ω T)`: phase change of the second bending mode by rotary inertia over the whole run.
    pub fn rotary(&self) -> f64 {
        let (omega, k) = self.second_mode();
        0.5 * self.section.gyration_radius_squared * k * k * (1.0 + omega * self.case.time.end_s)
    }

    /// `EI k²/(kGA) (1 + r ω T/2)` for the second bending mode: the deflection added by shear, and the phase change of
    /// its vibration over the whole run. r is the vibrating fraction of the deflection.
    pub fn shear(&self) -> f64 {
        let (omega, k) = self.second_mode();
        let softer = self.section.bending_stiffness * k * k / self.section.shear_stiffness;
        let vibrates = self.inertia_ratio(self.bending).min(1.0);
        softer * (1.0 + 0.5 * vibrates * omega * self.case.time.end_s)
    }
}
