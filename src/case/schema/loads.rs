//! Distributed loads, conditions at the ends, the state at the start.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::functions::profile::Profile;
use crate::functions::signals::Signal;

/// A distributed load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Load {
    /// Contact force per length in x (transverse) [N/m].
    ForceXNM(Distributed),
    /// Contact force per length in z (axial) [N/m].
    ForceZNM(Distributed),
    /// Force per length along the normal `e_n = (-cos phi, sin phi)`, which turns with the beam; above 0 it pushes a straight beam towards
    /// -x [N/m].
    ForceNormalNM(Distributed),
    /// Force per length along the tangent `e_t = (sin phi, cos phi)`, which turns with the beam [N/m].
    ForceTangentialNM(Distributed),
    /// First moment per length, x component `m b1_x` [N]: acts as a couple `m b1_x x'/lambda^2`.
    MomentXN(Distributed),
    /// First moment per length, z component `m b1_z` [N]; positive turns in the sense of M.
    MomentZN(Distributed),
    /// Body force per mass in x [m/s^2], acting on `m`.
    BodyXMS2(Distributed),
    /// Body force per mass in z [m/s^2], acting on `m`.
    BodyZMS2(Distributed),
    /// Curvature that the beam takes by itself where nothing acts on it [1/m]: of a beam made curved, or that something inside it bends.
    #[serde(rename = "rest_curvature_1_m")]
    RestCurvature(Distributed),
    /// Uniform constant gravity.
    Gravity {
        /// x component [m/s^2].
        #[serde(default)]
        x_m_s2: f64,
        /// z component [m/s^2].
        #[serde(default)]
        z_m_s2: f64,
    },
}

impl Load {
    /// True if the load acts on masses.
    pub fn is_body(&self) -> bool {
        matches!(self, Self::BodyXMS2(_) | Self::BodyZMS2(_) | Self::Gravity { .. })
    }

    /// True if the load turns with the beam.
    pub fn follows(&self) -> bool {
        matches!(self, Self::ForceNormalNM(_) | Self::ForceTangentialNM(_))
    }

    /// True if the load is a rest curvature, which bends the beam without a moment.
    pub fn is_rest(&self) -> bool {
        matches!(self, Self::RestCurvature(_))
    }

    /// Key and function of a load that has one.
    pub fn distributed(&self) -> Option<(&'static str, &Distributed)> {
        match self {
            Self::ForceXNM(load) => Some(("force_x_n_m", load)),
            Self::ForceZNM(load) => Some(("force_z_n_m", load)),
            Self::ForceNormalNM(load) => Some(("force_normal_n_m", load)),
            Self::ForceTangentialNM(load) => Some(("force_tangential_n_m", load)),
            Self::MomentXN(load) => Some(("moment_x_n", load)),
            Self::MomentZN(load) => Some(("moment_z_n", load)),
            Self::BodyXMS2(load) => Some(("body_x_m_s2", load)),
            Self::BodyZMS2(load) => Some(("body_z_m_s2", load)),
            Self::RestCurvature(load) => Some(("rest_curvature_1_m", load)),
            Self::Gravity { .. } => None,
        }
    }
}

/// Axes that turn in the plane of the beam: lengths, directions, ends, springs and walls of the case refer to them and turn with them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotatingFrame {
    /// Axis of rotation, x and z; absent: the root of the straight beam [m].
    #[serde(default, skip_serializing_if = "RotatingFrame::is_at_root")]
    pub center_m: [f64; 2],
    /// Angular velocity, without jumps; above 0 it turns the frame as a growing phi turns the beam, from z to x [rad/s].
    pub angular_velocity_rad_s: Signal,
}

impl RotatingFrame {
    fn is_at_root(center: &[f64; 2]) -> bool {
        *center == [0.0; 2]
    }

    /// Largest distance of the straight beam from the axis across, along, and in any direction [m].
    pub fn reach(&self, length: f64) -> [f64; 3] {
        let [x, z] = self.center_m;
        let along = z.abs().max((length - z).abs());
        [x.abs(), along, x.hypot(along)]
    }
}

/// `signal(t) * profile(theta/l_s)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Distributed {
    /// A number, or a function of time such as a sine, ramp or table.
    pub signal: Signal,
    /// Shape along the beam, a function of `theta/l_s`; absent: 1.
    #[serde(default = "Profile::one")]
    pub profile: Profile,
}

/// Conditions at the two ends (A.49-A.54).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ends {
    /// Conditions at the root, theta = 0: "clamped", "pinned", "free" or an object.
    pub root: End,
    /// Conditions at the tip, theta = l_s: "free", "clamped", "pinned" or an object.
    pub tip: End,
}

impl Default for Ends {
    fn default() -> Self {
        let free = || End::Free(EndConditions::default());
        Self {
            root: free(),
            tip: free(),
        }
    }
}

/// Exactly one of each pair {u1, force x}, {slope, moment}, {u3, force z}.
/// An end with given forces may add follower forces, which turn with the end angle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EndConditions {
    /// Transverse displacement `u1` [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub u1_m: Option<Signal>,
    /// Force in x on the end, dead [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_x_n: Option<Signal>,
    /// Slope angle `phi` [rad].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slope_rad: Option<Signal>,
    /// Bending moment `M` in the section [N m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment_n_m: Option<Signal>,
    /// Axial displacement `u3` [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub u3_m: Option<Signal>,
    /// Force in z on the end, dead [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_z_n: Option<Signal>,
    /// Section force `N` along the end's tangent (A.54) [N]; needs `force_x_n` and `force_z_n` (or neither named).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub follower_normal_n: Option<Signal>,
    /// Section force `V` along the end's normal `e_n` (A.53) [N]; likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub follower_shear_n: Option<Signal>,
}

/// Condition of one end, by its usual name or condition by condition.
/// Each name may stand alone as a string, then with zero motion and load.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// Nothing held: accepts `force_x_n`, `force_z_n`, `moment_n_m`, `follower_normal_n`, `follower_shear_n`.
    Free(EndConditions),
    /// u1, u3 and slope held or driven: accepts `u1_m`, `u3_m`, `slope_rad`.
    Clamped(EndConditions),
    /// u1 and u3 held or driven, free to turn: accepts `u1_m`, `u3_m`, `moment_n_m`.
    Pinned(EndConditions),
    /// Slope held, free to move across: accepts `slope_rad`, `force_x_n`, and `u3_m` (held, default) or `force_z_n`.
    Guided(EndConditions),
    /// One of each pair, all three given.
    Conditions(EndConditions),
}

/// State at t = 0 (A.55-A.58), each a function of `theta/l_s`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// Transverse displacement [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub u1_m: Option<Profile>,
    /// Axial displacement [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub u3_m: Option<Profile>,
    /// Transverse velocity [m/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub u1_rate_m_s: Option<Profile>,
    /// Axial velocity [m/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub u3_rate_m_s: Option<Profile>,
    /// Pressures; bladders not named start at zero.
    #[serde(default)]
    pub pressures: Vec<StartPressure>,
    /// Start in static equilibrium under the loads, end motions and port pressures of one instant, instead of given displacements.
    /// `pressures` then say how much fluid is in closed networks: that which gives them in the straight beam.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub equilibrium: Option<EquilibriumStart>,
}

/// Equilibrium in which a run starts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EquilibriumStart {
    /// Instant whose loads it holds [s]; a negative one sees signals as they were before the run: a ramp from 5 to 0 that starts
    /// at t = 0 lets go what it held.
    #[serde(default)]
    pub loads_at_s: f64,
    /// Instants whose loads are reached before, one after the other [s]: a preload that decides into which of several equilibria
    /// the beam goes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub via_s: Vec<f64>,
}

/// Initial pressure of some bladders.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StartPressure {
    /// Bladder indices `R j`.
    pub bladders: Vec<i64>,
    /// Gauge pressure [Pa], a function of `s/l_b` from inlet to outlet.
    pub pressure_pa: Profile,
}
