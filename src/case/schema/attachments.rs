//! Attachments to the beam.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{given, is_zero};
use crate::functions::profile::Profile;
use crate::functions::signals::Signal;

/// Something attached to the beam at one place: a mass with rotary inertia, at its place or beside it, springs and dashpots to ground, forces; one of them at least. Springs are
/// at rest in the straight beam.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// Place `theta/l_s`, 0 at the root and 1 at the tip.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub at: f64,
    /// Mass; gravity and body forces act on it [kg].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub mass_kg: f64,
    /// Rotary inertia about the mass centre [kg m^2].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub rotary_inertia_kg_m2: f64,
    /// From the place to the mass centre, across: on the side of +x in a straight beam, and turning with it [m].
    #[serde(default, skip_serializing_if = "is_zero")]
    pub offset_across_m: f64,
    /// From the place to the mass centre, along: towards the tip and beyond, and turning with the beam [m].
    #[serde(default, skip_serializing_if = "is_zero")]
    pub offset_along_m: f64,
    /// Spring to ground across, force `-k u1` [N/m].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub stiffness_x_n_m: f64,
    /// Spring to ground along, force `-k u3` [N/m].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub stiffness_z_n_m: f64,
    /// Rotational spring to ground, couple `-k phi` [N m/rad].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub stiffness_rotation_n_m_rad: f64,
    /// Dashpot to ground across, force `-c v1` [N s/m].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub damping_x_n_s_m: f64,
    /// Dashpot to ground along, force `-c v3` [N s/m].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub damping_z_n_s_m: f64,
    /// Dead force in x [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_x_n: Option<Signal>,
    /// Dead force in z [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_z_n: Option<Signal>,
    /// Force along the tangent `e_t = (sin phi, cos phi)`, which turns with the beam; below 0 it pushes towards the root [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_tangential_n: Option<Signal>,
    /// Force along the normal `e_n = (-cos phi, sin phi)`, which turns with the beam; above 0 it pushes a straight beam towards -x [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_normal_n: Option<Signal>,
}

/// Elastic foundation (Winkler): springs to ground along the beam, at rest in the straight beam. One stiffness at least.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Foundation {
    /// Stiffness across, force per length `-k u1`, a number or a function of `theta/l_s` [N/m^2].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness_x_n_m2: Option<Profile>,
    /// Stiffness along, force per length `-k u3`, a number or a function of `theta/l_s` [N/m^2].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness_z_n_m2: Option<Profile>,
}

impl Foundation {
    /// Stiffness across and along, with their keys.
    pub fn stiffness(&self) -> [(&'static str, Option<&Profile>); 2] {
        [
            ("stiffness_x_n_m2", self.stiffness_x_n_m2.as_ref()),
            ("stiffness_z_n_m2", self.stiffness_z_n_m2.as_ref()),
        ]
    }
}

impl Attachment {
    /// Creates an empty attachment at a fraction of the length.
    pub fn at(at: f64) -> Self {
        Self {
            at,
            mass_kg: 0.0,
            rotary_inertia_kg_m2: 0.0,
            offset_across_m: 0.0,
            offset_along_m: 0.0,
            stiffness_x_n_m: 0.0,
            stiffness_z_n_m: 0.0,
            stiffness_rotation_n_m_rad: 0.0,
            damping_x_n_s_m: 0.0,
            damping_z_n_s_m: 0.0,
            force_x_n: None,
            force_z_n: None,
            force_tangential_n: None,
            force_normal_n: None,
        }
    }

    /// Given forces, with their keys.
    pub fn forces(&self) -> impl Iterator<Item = (&'static str, &Signal)> {
        given([
            ("force_x_n", &self.force_x_n),
            ("force_z_n", &self.force_z_n),
            ("force_tangential_n", &self.force_tangential_n),
            ("force_normal_n", &self.force_normal_n),
        ])
    }

    /// Offsets of the center of mass from the place, with their keys [m].
    pub fn offsets(&self) -> [(&'static str, f64); 2] {
        [
            ("offset_across_m", self.offset_across_m),
            ("offset_along_m", self.offset_along_m),
        ]
    }

    /// True if the center of mass is offset from the place.
    pub fn is_eccentric(&self) -> bool {
        self.offsets().iter().any(|(_, offset)| *offset != 0.0)
    }

    /// True if the attachment does not act on the beam.
    pub fn is_empty(&self) -> bool {
        let sizes = [
            self.mass_kg,
            self.rotary_inertia_kg_m2,
            self.stiffness_x_n_m,
            self.stiffness_z_n_m,
            self.stiffness_rotation_n_m_rad,
            self.damping_x_n_s_m,
            self.damping_z_n_s_m,
        ];
        sizes.iter().all(|size| *size == 0.0) && self.forces().next().is_none()
    }
}
