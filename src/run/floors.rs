//! Sizes below which what a run finds is round-off, known from the case alone.

use serde::{Deserialize, Serialize};

use crate::case::Case;
use crate::discrete::quantities::Interest;
use crate::error::Result;
use crate::model::Model;

/// Quantities whose size is below this part of others of their unit, or of what the case is expected to do, are round-off.
pub const NOTHING: f64 = 1e-6;
/// Displacements below this part of the length, and pressures below this part of the modulus, need not be more than round-off;
/// they count where the case is expected to do no more.
const SMALL: f64 = 1e-9;

/// Of a run in which nothing of a kind happens every figure of that kind is round-off, and none stands beside a larger one. One
/// function for whatever is told relative to what was seen: balances, errors of energies, estimates, accuracies.
///
/// ```text
/// d  of displacements    energy EI d²/l³    momentum m l d ω    angular momentum m l² d ω    ω = (EI/m)^(1/2)/l²
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Floors {
    /// Length of the beam [m].
    pub length: f64,
    /// Displacement [m], and angle times length.
    pub displacement: f64,
    /// Pressure [Pa].
    pub pressure: f64,
    /// Energy [J].
    #[serde(default)]
    pub energy: f64,
    /// Momentum [N s].
    #[serde(default)]
    pub momentum: f64,
    /// Volume that a floor of pressure stores in a bladder [m^3].
    #[serde(default)]
    pub volume: f64,
}

impl Floors {
    /// Of a case.
    pub fn of(case: &Case) -> Result<Self> {
        Ok(Self::of_model(case, &Model::new(case)?))
    }

    /// Of a case and its model.
    pub fn of_model(case: &Case, model: &Model) -> Self {
        let (scales, section) = (&model.scales, &model.section);
        let (length, modulus) = (model.length, case.beam.young_modulus_pa);
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

    /// In the unit that a quantity is compared in, beside a largest energy [J].
    pub fn of_unit(&self, unit: &str, energy: f64) -> f64 {
        match unit {
            "m" => self.displacement,
            "Pa" => self.pressure,
            "J" => (NOTHING * energy).max(self.energy),
            _ => 0.0,
        }
    }

    /// Unit and size in which a quantity of a name and size is compared with others: an angle as the displacement that it makes.
    pub fn weighed(&self, name: &str, size: f64) -> (&'static str, f64) {
        match Interest::named(name).map_or("1", Interest::unit) {
            "rad" => ("m", size * self.length),
            unit => (unit, size),
        }
    }
}
