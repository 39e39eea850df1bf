//! Beams of a structure and their joints.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Attachment, Case, End, Load, Probe, Span, SpanBeam, SpanBladders, SpanRows, is_zero};
use crate::error::{Error, Result};

/// A beam of a structure. Values of section and bladders that it does not give are those of `beam` and `bladders`, as in a span. Lengths,
/// loads, ends, attachments and probes refer to its own axes: z along the straight beam from its root, x across.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlacedBeam {
    /// Name, with which joints, bladders and outputs refer to it: letters, digits, `-` and `_`.
    #[schemars(length(min = 1))]
    pub name: String,
    /// Position of its root, x and z; absent: where a joint puts it, of the first beam 0 [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin_m: Option<[f64; 2]>,
    /// Direction of the straight beam: the angle from z towards x, as phi [rad].
    #[serde(default, skip_serializing_if = "is_zero")]
    pub angle_rad: f64,
    /// Length; absent: `/beam/length_m` [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length_m: Option<f64>,
    /// Number of its segments; absent: `/bladders/per_row`, of a dry beam `/mesh/segments`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 100000))]
    pub segments: Option<usize>,
    /// Rows that have bladders.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rows: Option<SpanRows>,
    /// Values of the solid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beam: Option<SpanBeam>,
    /// Values of the bladders.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bladders: Option<SpanBladders>,
    /// Parts of the beam, root to tip, with values of their own, in place of `rows`, `beam` and `bladders`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub spans: Vec<Span>,
    /// Conditions at its ends; an end with a joint has none.
    #[serde(default, skip_serializing_if = "PlacedEnds::is_empty")]
    pub ends: PlacedEnds,
    /// Loads on this beam alone, in its own axes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 10000))]
    pub loads: Vec<Load>,
    /// Point masses, springs, dashpots and forces at places along the beam, in its own axes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub attachments: Vec<Attachment>,
    /// Recorded places.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub probes: Vec<Probe>,
}

/// Conditions at the ends of a beam of a structure.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlacedEnds {
    /// Conditions at the root; absent: free, or those of its joint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub root: Option<End>,
    /// Conditions at the tip; absent: free, or those of its joint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tip: Option<End>,
}

impl PlacedEnds {
    /// True if neither end has conditions.
    pub fn is_empty(&self) -> bool {
        self.root.is_none() && self.tip.is_none()
    }

    /// Conditions at the root and at the tip.
    pub fn both(&self) -> [Option<&End>; 2] {
        [self.root.as_ref(), self.tip.as_ref()]
    }
}

/// A joint of two or more beams, at ends of theirs or between segments. Beams of a hinge meet at one position; in other joints they may be
/// apart, as at a rigid body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Joined places: `"NAME.root"`, `"NAME.tip"`, or `"NAME.3"` for the place behind the third segment.
    #[schemars(length(min = 1, max = 1000))]
    pub at: Vec<String>,
    /// Kind of the joint.
    pub kind: JointKind,
    /// Mass of a body at the first place; gravity and body forces of the case act on it [kg].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub mass_kg: f64,
    /// Rotary inertia of that body, which turns with the first place [kg m^2].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub rotary_inertia_kg_m2: f64,
}

/// Kinds of joints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum JointKind {
    /// All beams turn alike.
    Rigid(RigidJoint),
    /// Every beam turns by itself.
    Hinge(Hinge),
    /// Springs in all directions between the first beam and each further one.
    Elastic(ElasticJoint),
    /// Each further beam slides along a slot of the first one, and turns in it against `turning_stiffness_n_m_rad`.
    Slider(Slider),
}

/// An elastic joint: force and moment by the displacement and the rotation of a further beam relative to the first, along the axes of the
/// first one, which turn with it: (across, along, rotation).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElasticJoint {
    /// Stiffness matrix, symmetric and without negative energy, [[N/m, N/m, N/rad], [N/m, N/m, N/rad], [N, N, N m/rad]].
    pub stiffness: [[f64; 3]; 3],
    /// Damping matrix, the same per velocity; absent: none.
    #[serde(default, skip_serializing_if = "is_undamped")]
    pub damping: [[f64; 3]; 3],
}

impl ElasticJoint {
    /// True if displacements are damped, not the rotation alone.
    pub fn damps_motion(&self) -> bool {
        let [x, z, _] = self.damping;
        x != [0.0; 3] || z != [0.0; 3]
    }
}

/// True for a joint without damping, the default that a case may omit.
fn is_undamped(damping: &[[f64; 3]; 3]) -> bool {
    *damping == [[0.0; 3]; 3]
}

/// A slider: a slot along the first beam or at an angle to it. Its walls are elastic; the stiffer they are, the less the further beam leaves
/// the slot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Slider {
    /// Angle of the slot to the straight first beam, from its z towards its x [rad].
    #[serde(default, skip_serializing_if = "is_zero")]
    pub angle_rad: f64,
    /// Stiffness of its walls across [N/m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wall_stiffness_n_m: f64,
    /// Stiffness against turning in it; 0 for a pin in a slot [N m/rad].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub turning_stiffness_n_m_rad: f64,
    /// Stiffness of a spring along it [N/m].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub stiffness_n_m: f64,
    /// Damping along it [N s/m].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub damping_n_s_m: f64,
}

impl Slider {
    /// Elastic joint with the same forces.
    pub fn elastic(&self) -> ElasticJoint {
        let along = [self.angle_rad.sin(), self.angle_rad.cos()];
        let across = [along[1], -along[0]];
        let (mut stiffness, mut damping) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        for i in 0..2 {
            for j in 0..2 {
                let parts = [across[i] * across[j], along[i] * along[j]];
                stiffness[i][j] = self.wall_stiffness_n_m * parts[0] + self.stiffness_n_m * parts[1];
                damping[i][j] = self.damping_n_s_m * parts[1];
            }
        }
        stiffness[2][2] = self.turning_stiffness_n_m_rad;
        ElasticJoint { stiffness, damping }
    }
}

/// A rigid joint; it has no values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidJoint {}

/// A hinge. Spring, damper and stop act on the rotation of each further beam relative to the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    /// Stiffness of the spring [N m/rad].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub stiffness_n_m_rad: f64,
    /// Rotation at which the spring is at rest [rad].
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rest_rad: f64,
    /// Damping [N m s/rad].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub damping_n_m_s_rad: f64,
    /// Range of free rotation. Absent: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop: Option<HingeStop>,
}

/// Elastic stops at both ends of the range of a hinge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HingeStop {
    /// Least free rotation [rad].
    pub from_rad: f64,
    /// Largest free rotation [rad].
    pub to_rad: f64,
    /// Stiffness of the stops [N m/rad].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness_n_m_rad: f64,
    /// Rotation over which the stiffness comes in [rad].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub smoothing_rad: f64,
}

/// Contact of beams with each other, or of one with itself: their surfaces press on each other where they overlap. Places of one beam, or of
/// two joined ones, that are nearer to each other than half a turn of the least circle in the straight structure do not touch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BeamContact {
    /// Name in outputs.
    #[schemars(length(min = 1))]
    pub name: String,
    /// Names of both beams; twice the same for a beam that touches itself. Absent: all beams, also themselves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between: Option<[String; 2]>,
    /// Stiffness along the beams: force per length over the depth of overlap [Pa].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness_pa: f64,
    /// Depth over which the stiffness comes in [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub smoothing_m: f64,
    /// Damping, as of an obstacle [s/m].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub damping_s_m: f64,
    /// Coulomb's coefficient of friction.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub friction_coefficient: f64,
    /// Velocity below which friction falls with the velocity instead of holding [m/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub friction_velocity_m_s: Option<f64>,
}

impl Case {
    /// True if the case has several beams, or one that is placed.
    pub fn is_structure(&self) -> bool {
        !self.beams.is_empty()
    }

    /// Rejects a structure.
    ///
    /// # Errors
    /// [`Error::Usage`] for a case with several beams; `what` needs a single one.
    pub fn single(&self, what: &str) -> Result<()> {
        match self.is_structure() {
            false => Ok(()),
            true => Err(Error::Usage(format!(
                "{what}: {} has several beams, but a single one is needed. Use a case of the beam in question, without /beams",
                self.name
            ))),
        }
    }
}
