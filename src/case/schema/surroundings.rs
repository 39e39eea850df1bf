//! Fluid around the beam.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{given, is_zero, one};
use crate::functions::signals::Signal;

/// A fluid around the beam, at rest or streaming past it: inertia and drag across the beam, and buoyancy against gravity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Surroundings {
    /// Its density [kg/m^3].
    #[schemars(range(min = 0.0))]
    pub density_kg_m3: f64,
    /// `C_d` of the drag across, on the beam's width: about 2 of a flat plate. Absent: no drag.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub drag_coefficient: f64,
    /// `C_a` of the added mass across, `C_a pi/4 rho w^2` per length: 1 of a thin plate.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0))]
    pub added_mass_coefficient: f64,
    /// Velocity of the stream in x [m/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stream_x_m_s: Option<Signal>,
    /// Velocity of the stream in z [m/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stream_z_m_s: Option<Signal>,
}

impl Surroundings {
    /// Given velocities of the stream, with their keys.
    pub fn stream(&self) -> impl Iterator<Item = (&'static str, &Signal)> {
        given([
            ("stream_x_m_s", &self.stream_x_m_s),
            ("stream_z_m_s", &self.stream_z_m_s),
        ])
    }
}
