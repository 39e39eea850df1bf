//! Which physical effects are simulated.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which physical effects are simulated: `"auto"`, `"full"` or choice by choice.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Effects {
    /// The program chooses and says why.
    #[default]
    Auto,
    /// Everything the case describes.
    Full,
    /// Named choices; the others are `auto`.
    Chosen(EffectChoices),
}

/// Named effects.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectChoices {
    /// Motion across the beam, with slopes and moments; off: a bar, which can only stretch. Needs that nothing moves or loads it
    /// across.
    #[serde(default)]
    pub transverse_motion: Choice,
    /// Rotations of any size; off: small ones, `u3' + u1'^2/2` the strain and `u1'` the angle. Needs the conservative
    /// formulation.
    #[serde(default)]
    pub finite_rotation: Choice,
    /// The normal force that acts on bending (geometric stiffness); off: the linear beam. Needs `finite_rotation` off.
    #[serde(default)]
    pub axial_force_on_bending: Choice,
    /// Stretch along the beam; off: the beam draws in only as it bends, and the normal force follows from the loads. Needs
    /// `finite_rotation` off, one end that holds or drives `u3`, and one that is free along.
    #[serde(default)]
    pub axial_stretch: Choice,
    /// Inertia of the solid; off: quasi-static solid.
    #[serde(default)]
    pub solid_inertia: Choice,
    /// Inertia along the beam, axial waves; off: the beam is carried along by its driven ends, with the force that this
    /// takes. Needs an end that holds or drives `u3`.
    #[serde(default)]
    pub axial_inertia: Choice,
    /// Inertia of the section's rotation, `m y11`.
    #[serde(default)]
    pub rotary_inertia: Choice,
    /// The fluid in the bladders; off: a dry beam with the mass of the filled one.
    #[serde(default)]
    pub fluid: Choice,
    /// Flow between bladders; off: every bladder keeps its volume.
    #[serde(default)]
    pub flow: Choice,
    /// Pressure differences within each network; off: one pressure for all bladders that are joined. Not possible with
    /// turbines, moving valves, or ports of different pressures.
    #[serde(default)]
    pub network_pressure_differences: Choice,
    /// Pressure differences along each bladder; off: one finite volume a bladder, whatever `/mesh/cells_per_bladder` says.
    #[serde(default)]
    pub flow_along_bladders: Choice,
    /// Pressure bends the beam, `alpha_p`.
    #[serde(default)]
    pub pressure_to_curvature: Choice,
    /// Pressure stretches the beam, `lambda_p`.
    #[serde(default)]
    pub pressure_to_stretch: Choice,
    /// Bending changes the area of bladders, `A_M`.
    #[serde(default)]
    pub moment_to_area: Choice,
    /// Normal force changes the area of bladders, `A_N`.
    #[serde(default)]
    pub force_to_area: Choice,
    /// Different opening and closing slopes of the bladder area.
    #[serde(default)]
    pub asymmetry: Choice,
}

/// On, off, or chosen by the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Choice {
    /// Chosen by the program.
    #[default]
    Auto,
    /// Simulated.
    On,
    /// Left out.
    Off,
}
