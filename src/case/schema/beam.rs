//! The elastic beam and its damping.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Viscoelasticity, is_zero, one};
use crate::functions::{Interpolation, PiecewiseCurve};

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
    /// Moment over curvature, instead of `EI` and `bending_stiffness_factor`; absent: linear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment_curvature: Option<MomentCurvature>,
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

    /// `w_s h_s^3/12` [m^4].
    fn full_second_moment(&self) -> f64 {
        self.width_m * self.height_m.powi(3) / 12.0
    }

    /// `(w_s h_s^3/12) f_i` [m^4].
    pub fn second_moment(&self) -> f64 {
        self.full_second_moment() * self.bending_factor()
    }

    /// `f_i`: that of the slope of the moment-curvature law at zero, or the given one.
    pub fn bending_factor(&self) -> f64 {
        let full = self.young_modulus_pa * self.full_second_moment();
        let law = self.moment_curvature.as_ref().and_then(MomentCurvature::curve);
        law.map_or(self.bending_stiffness_factor, |curve| curve.at(0.0).rate / full)
    }
}

/// Elastic moment of a section over its curvature: monotone cubics through the points, straight beyond them with the slope between the
/// last two.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MomentCurvature {
    /// Curvatures, ascending, with 0 [1/m]. From 0 on: the law is odd.
    #[schemars(length(min = 2, max = 10000))]
    pub curvature_1_m: Vec<f64>,
    /// Moment at each curvature, ascending, 0 at 0 [N m].
    #[schemars(length(min = 2, max = 10000))]
    pub moment_n_m: Vec<f64>,
}

impl MomentCurvature {
    /// Curve through the points, those of the other sign and one beyond each end; none if these are not a curve.
    pub fn curve(&self) -> Option<PiecewiseCurve> {
        let points = self.curvature_1_m.iter().copied().zip(self.moment_n_m.iter().copied());
        let mut points: Vec<(f64, f64)> = points.collect();
        if points.first().is_some_and(|first| first.0 == 0.0) {
            let mirrored = points
                .iter()
                .skip(1)
                .rev()
                .map(|(curvature, moment)| (-curvature, -moment));
            points = mirrored.chain(points.iter().copied()).collect();
        }
        let beyond = |end: &(f64, f64), inner: &(f64, f64)| (2.0 * end.0 - inner.0, 2.0 * end.1 - inner.1);
        let (Some([first, second]), Some([inner, last])) = (points.first_chunk(), points.last_chunk()) else {
            return None;
        };
        let [before, after] = [beyond(first, second), beyond(last, inner)];
        let all = [before].into_iter().chain(points).chain([after]);
        let (curvatures, moments): (Vec<f64>, Vec<f64>) = all.unzip();
        PiecewiseCurve::through(&curvatures, &moments, Interpolation::Monotone)
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
