//! Walls and circles that the beam may touch.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{is_false, is_zero};

/// An obstacle that does not move: a wall, the half-plane behind `point_m`, seen against `normal`, or a `circle`. It presses on the
/// beam all along with `stiffness_pa`, or at one place with `at` and `stiffness_n_m`. A beam that is away from it feels nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Name in outputs.
    #[schemars(length(min = 1))]
    pub name: String,
    /// A point of the wall's face, x and z [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point_m: Option<[f64; 2]>,
    /// Direction out of the wall, towards the free side, x and z; of any length but 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<[f64; 2]>,
    /// A circle, in place of `point_m` and `normal`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circle: Option<Circle>,
    /// Distance of the contact surface from the center line of the beam [m]; absent: half its height, its surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub reach_m: Option<f64>,
    /// Stiffness all along the beam: force per length over how deep it is pressed in [Pa].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness_pa: Option<f64>,
    /// The one place `theta/l_s` that it touches, 0 at the root and 1 at the tip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub at: Option<f64>,
    /// Stiffness at that place: force over how deep it is pressed in [N/m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness_n_m: Option<f64>,
    /// Depth over which the stiffness comes in [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub smoothing_m: f64,
    /// Damping, by the rate at which the beam is pressed in: the force is `1 + c d/dt(depth)` times as large, and never pulls (Hunt &
    /// Crossley 1975) [s/m].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub damping_s_m: f64,
    /// Coulomb's coefficient of friction.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub friction_coefficient: f64,
    /// Velocity below which friction falls with the velocity instead of holding: with friction, far below that of sliding [m/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub friction_velocity_m_s: Option<f64>,
}

impl Contact {
    /// Coordinates and lengths of its shape [m].
    pub fn coordinates(&self) -> impl Iterator<Item = f64> {
        let point = self
            .point_m
            .into_iter()
            .chain(self.circle.as_ref().map(|circle| circle.center_m))
            .flatten();
        let lengths = [self.circle.as_ref().map(|circle| circle.radius_m), self.reach_m];
        point.chain(lengths.into_iter().flatten())
    }

    /// Term of its shape.
    pub fn kind(&self) -> &'static str {
        if self.circle.is_some() { "circle" } else { "wall" }
    }
}

/// A circle that does not move: a disc beside the beam, or a round room around it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Circle {
    /// Its center, x and z [m].
    pub center_m: [f64; 2],
    /// Its radius [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius_m: f64,
    /// True if the beam is inside the circle, which surrounds it.
    #[serde(default, skip_serializing_if = "is_false")]
    pub inside: bool,
}
