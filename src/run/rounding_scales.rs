//! Rounding scales of a case: magnitudes below which results of a run are round-off.

use serde::{Deserialize, Serialize};

use crate::case::Case;
use crate::case::spans;
use crate::error::Result;
use crate::model::Model;

/// Quantities below this fraction of others of their unit, or of the magnitude expected of the case, are round-off.
pub const NOTHING: f64 = 1e-6;
/// Displacements below this fraction of the length, and pressures below this fraction of the modulus, may be round-off. The
/// rounding scale is smaller if the case is expected to move less.
const SMALL: f64 = 1e-9;

/// Rounding scale of each kind of quantity. If a run does not excite a kind, all its values are round-off, and there is no
/// larger value for comparison. Balances, errors of energies, estimates and accuracies are relative to at least these scales.
///
/// ```text
/// d  of displacements    energy EI d²/l³    momentum m l d ω    angular momentum m l² d ω    ω = (EI/m)^(1/2)/l²
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RoundingScales {
    /// Length of the beam [m].
    pub length: f64,
    /// Displacement [m]; also angle times length.
    pub displacement: f64,
    /// Pressure [Pa].
    pub pressure: f64,
    /// Energy [J].
    #[serde(default)]
    pub energy: f64,
    /// Momentum [N s].
    #[serde(default)]
    pub momentum: f64,
    /// Volume stored in a bladder at the rounding scale of pressure [m^3].
    #[serde(default)]
    pub volume: f64,
}

impl RoundingScales {
    /// Rounding scales of a case.
    pub fn from_case(case: &Case) -> Result<Self> {
        Ok(Self::of_model(case, &Model::new(case)?))
    }

    /// Rounding scales of a case and its model.
    pub fn of_model(case: &Case, model: &Model) -> Self {
        let (scales, section) = (&model.scales, &model.section);
        let (length, modulus) = (model.length, spans::softest_modulus(case));
        let displacement = (SMALL * length).min(NOTHING * scales.transverse.max(scales.axial));
        let pressure = (SMALL * modulus).min(NOTHING * scales.pressure);
        let stiffness = section.bending_stiffness;
        Self {
            length,
            displacement,
            pressure,
            energy: stiffness * displacement * displacement / length.powi(3),
            momentum: (stiffness * section.mass_per_length).sqrt() * displacement / length,
            volume: model
                .wet
                .as_ref()
                .map_or(0.0, |wet| wet.compliance() * pressure * wet.bladder_length),
        }
    }

    /// Rounding scale in the unit in which a quantity is compared; `energy` [J] is the largest energy.
    pub fn of_unit(&self, unit: &str, energy: f64) -> f64 {
        match unit {
            "m" => self.displacement,
            "Pa" => self.pressure,
            "J" => (NOTHING * energy).max(self.energy),
            _ => 0.0,
        }
    }
}
