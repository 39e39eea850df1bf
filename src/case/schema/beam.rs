//! The elastic beam and its damping.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Viscoelasticity, is_zero, one};

/// The elastic beam; stiffness of the honeycomb through two correction factors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// Length `l_s` [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length_m: f64,
    /// Height `h_s` of the cross-section, in the plane of bending [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub height_m: f64,
    /// Width `w_s` of the cross-section [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub width_m: f64,
    /// Young's modulus `E` [Pa].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub young_modulus_pa: f64,
    /// Density `rho_s` of the solid material [kg/m^3].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density_kg_m3: f64,
    /// `f_e`: axial stiffness over that of the full section, `EA = E h_s w_s f_e`.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub axial_stiffness_factor: f64,
    /// `f_i`: bending stiffness over that of the full section, `EI = E w_s h_s^3/12 f_i`.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub bending_stiffness_factor: f64,
    /// `z_n`: height of the neutral axis above mid-height; stiffness and areas of bladders are those about it [m].
    #[serde(default, skip_serializing_if = "is_zero")]
    pub neutral_axis_m: f64,
    /// `z_r`: height of the beam's line above mid-height; ends and loads act there, and displacements are its own; absent: at the neutral
    /// axis [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_axis_m: Option<f64>,
    /// `kGA`: shear force over shear strain of the section, of a full rectangle about 5/6 of its area times the shear modulus; absent:
    /// sections stay across the beam [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub shear_stiffness_n: Option<f64>,
    /// `f_m`: mass over that of a full section of the solid, `m = rho_s w_s h_s f_m`; absent: from bladders and fluid, 1 when dry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass_factor: Option<f64>,
    /// Material damping and external drag; absent: undamped.
    #[serde(default)]
    pub damping: Damping,
    /// Relaxation of the material; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscoelasticity: Option<Viscoelasticity>,
}

impl Beam {
    /// Height `z_r` of the beam's line above mid-height [m].
    pub fn line_height(&self) -> f64 {
        self.reference_axis_m.unwrap_or(self.neutral_axis_m)
    }
}

/// Kelvin-Voigt material damping and external drag (not in the paper).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// `tau_a`: `N_total = N + EA tau_a d(lambda)/dt` [s].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub axial_time_s: f64,
    /// `tau_b`: `M_total = M + EI tau_b d(kappa)/dt` [s].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub bending_time_s: f64,
    /// `c`: external force per length `-c v` [N s/m^2].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub drag_n_s_m2: f64,
    /// `c_2`: force per length across the beam `-c_2 v_n |v_n|` of what it moves through; of a plate of width w in a fluid
    /// `C_d rho w/2`, `C_d` about 2 [N s^2/m^3].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub quadratic_drag_n_s2_m3: f64,
}
