//! The fluid, the bladders, their coupling to the beam, and cross-sections of ducts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::is_zero;
use crate::case::fluids::{NamedFluid, ROOM_C};

/// Standard atmosphere [Pa].
pub const ATMOSPHERE: f64 = 101_325.0;

/// Newtonian fluid in creeping flow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fluid {
    /// A fluid by name: density and viscosity that are not given beside it are its own at `temperature_c`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preset: Option<NamedFluid>,
    /// Temperature of a fluid by name [C]; absent: 20.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature_c: Option<f64>,
    /// Density `rho_f` at ambient pressure [kg/m^3]; 0 for massless fluid.
    #[schemars(range(min = 0.0))]
    pub density_kg_m3: f64,
    /// Dynamic viscosity `mu` [Pa s].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub viscosity_pa_s: f64,
    /// Liquid, or gas, whose density follows its pressure.
    #[serde(default, skip_serializing_if = "FluidKind::is_liquid")]
    pub kind: FluidKind,
    /// Bulk modulus K of a liquid [Pa]; absent: it is not compressed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub bulk_modulus_pa: Option<f64>,
    /// Part of a liquid's volume at ambient pressure that is free gas, x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0), extend("exclusiveMaximum" = 1))]
    pub gas_fraction: Option<f64>,
    /// Exponent n of gas, `p rho^-n` constant: 1 isothermal, which is also what absent means, 1.4 air without heat exchange.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1.0, max = 2.0))]
    pub polytropic_exponent: Option<f64>,
    /// Absolute pressure outside the beam [Pa], which pressures are measured against; absent: 101325. Gas has its density there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub ambient_pressure_pa: Option<f64>,
}

impl Fluid {
    /// True if the density depends on the pressure.
    pub fn is_compressible(&self) -> bool {
        self.gas() > 0.0 || self.bulk_modulus_pa.is_some()
    }

    /// Volume fraction of gas at ambient pressure, x.
    pub fn gas(&self) -> f64 {
        match self.kind {
            FluidKind::Gas => 1.0,
            FluidKind::Liquid => self.gas_fraction.unwrap_or(0.0),
        }
    }

    /// Vapor pressure, absolute [Pa], if known.
    pub fn vapor_pressure(&self) -> Option<f64> {
        self.preset?.vapor_pressure(self.temperature_c.unwrap_or(ROOM_C))
    }

    /// Gauge pressure below which a liquid boils [Pa]: from its vapor pressure if known, otherwise from vacuum. None for a gas.
    pub fn boils_below(&self) -> Option<f64> {
        let vapor = self.vapor_pressure().unwrap_or(0.0);
        (self.kind == FluidKind::Liquid).then(|| vapor - self.ambient_pressure())
    }

    /// Absolute pressure outside the beam [Pa].
    pub fn ambient_pressure(&self) -> f64 {
        self.ambient_pressure_pa.unwrap_or(ATMOSPHERE)
    }
}

/// State of matter of a fluid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FluidKind {
    /// Incompressible unless `bulk_modulus_pa` or `gas_fraction` is given.
    #[default]
    Liquid,
    /// Ideal gas.
    Gas,
}

impl FluidKind {
    fn is_liquid(&self) -> bool {
        *self == Self::Liquid
    }
}

/// Two rows of bladders, `per_row` each: upper `1..=per_row`, lower `-1..=-per_row`, root to tip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bladders {
    /// Bladders in each row, `n/2`.
    #[schemars(range(min = 1, max = 1000000))]
    pub per_row: usize,
    /// Length `l_b` of a bladder across the width of the beam, inlet to outlet [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length_m: f64,
    /// Height `h_b` [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub height_m: f64,
    /// Width `w_b`, along the beam [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub width_m: f64,
    /// Permeability `q1b` in `q = -(q1b/mu) dp/ds`, (A.13) [m^4]; absent or `null`: that of `cross_section`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub permeability_m4: Option<f64>,
    /// Cross-section from which the permeability follows; absent: `height_m` by `width_m`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cross_section: Option<CrossSection>,
    /// `a_p` in `a1 = a_p p + R A_M(M) + A_N(N)`, (A.15): area per pressure [m^2/Pa].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub area_per_pressure_m2_per_pa: f64,
    /// `a_x` in `a1_R = a_p p_R + a_x p_(-R) + ..`: area of a bladder per pressure of the other bladder of its segment [m^2/Pa]; negative
    /// if pressure in one row closes the other.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub area_per_other_pressure_m2_per_pa: f64,
    /// `aM-` (opening) and `aM+` (closing) in `A_M(M)`: area per bending moment [m^2/(N m)].
    pub area_per_moment_m2_per_n_m: AreaPerMoment,
    /// `aN-` (tension) and `aN+` (compression) in `A_N(N)`: area per normal force [m^2/N].
    pub area_per_force_m2_per_n: AreaPerForce,
    /// The lower row. Absent: the mirror image of the upper row, to which the values above belong.
    #[serde(default, skip_serializing_if = "LowerRow::is_mirrored")]
    pub lower: LowerRow,
    /// Strain of the beam by pressure: `lambda_p` and `alpha_p` in `N = EA (lambda - 1 - lambda_p)`, `M = EI (alpha - alpha_p)`.
    #[serde(default)]
    pub coupling: Coupling,
    /// Energy of the section beyond its quadratic part, where strains are large; with the reciprocal coupling and the conservative
    /// formulation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strain_energy: Option<StrainEnergy>,
    /// Walls that meet before the cross-section is gone; absent: a run ends where a bladder closes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub closing: Option<Closing>,
    /// Width of the smoothed kink between opening and closing slopes, relative to `EI/l_s` (moment) and `EA` (force).
    #[serde(default = "default_kink_width")]
    #[schemars(extend("exclusiveMinimum" = 0), range(max = 1.0))]
    pub kink_width: f64,
}

/// Placeholder for the bladders of a network without any; its sizes only scale unknowns.
pub static NO_BLADDERS: Bladders = Bladders {
    per_row: 0,
    length_m: 1.0,
    height_m: 1.0,
    width_m: 1.0,
    permeability_m4: None,
    cross_section: None,
    area_per_pressure_m2_per_pa: 1.0,
    area_per_other_pressure_m2_per_pa: 0.0,
    area_per_moment_m2_per_n_m: AreaPerMoment {
        opening: 0.0,
        closing: 0.0,
    },
    area_per_force_m2_per_n: AreaPerForce {
        tension: 0.0,
        compression: 0.0,
    },
    lower: LowerRow::Mirrored,
    coupling: Coupling::Reciprocal,
    strain_energy: None,
    closing: None,
    kink_width: 1.0,
};

/// The lower row of bladders.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum LowerRow {
    /// Mirror image of the upper row.
    #[default]
    Mirrored,
    /// No lower row.
    None,
    /// A row with values of its own.
    Unlike(RowBladders),
}

impl LowerRow {
    /// True for the mirror image of the upper row.
    pub fn is_mirrored(&self) -> bool {
        *self == Self::Mirrored
    }
}

/// Values of the bladders of one row. Sizes that it does not give are those of the upper row; coefficients that it does not give follow
/// its sizes by the scaling laws of their section.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RowBladders {
    /// Height [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub height_m: Option<f64>,
    /// Width, along the beam [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub width_m: Option<f64>,
    /// `a_p`: area per pressure [m^2/Pa].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub area_per_pressure_m2_per_pa: Option<f64>,
    /// Area per bending moment [m^2/(N m)].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area_per_moment_m2_per_n_m: Option<AreaPerMoment>,
    /// Area per normal force [m^2/N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area_per_force_m2_per_n: Option<AreaPerForce>,
    /// Permeability `q1b` [m^4].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub permeability_m4: Option<f64>,
}

/// Walls that touch, and press on each other with `P (below/x - 1)^2`, x the cross-section over that at rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Closing {
    /// Share of the cross-section at rest below which walls touch.
    #[schemars(extend("exclusiveMinimum" = 0), range(max = 0.9))]
    pub below: f64,
    /// `P`: what they press with where half of that is left [Pa].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness_pa: f64,
}

/// `P = sum P_k z^k`, `3 <= |k| <= degree`, with mirrored rows `k_2 + k_4` even: what a law at finite strain adds to
/// the potential of the section [N]. `z` are the stretch and the curvature that loads make and half of sum and difference of the upper
/// and the lower pressure, each over the largest of its limits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrainEnergy {
    /// Stretch less one below and above which `P` is not known, on its own.
    pub stretch: [f64; 2],
    /// Likewise the curvature [1/m].
    pub curvature_1_m: [f64; 2],
    /// Likewise the pressure of an upper bladder [Pa].
    pub upper_pressure_pa: [f64; 2],
    /// Likewise of a lower bladder [Pa].
    pub lower_pressure_pa: [f64; 2],
    /// Degree of `P`.
    #[schemars(range(min = 3, max = 6))]
    pub degree: usize,
    /// True if `P` has only the terms of a section with mirrored rows.
    #[serde(default = "yes", skip_serializing_if = "is_yes")]
    pub mirrored: bool,
    /// `P_k`: powers of sum and difference of the pressures outermost, by their sum; then those of stretch and curvature, by theirs [N].
    pub coefficients_n: Vec<f64>,
    /// Largest error of the first derivatives over the largest of their linear parts.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub error: f64,
}

impl StrainEnergy {
    /// Limits of stretch, curvature, upper and lower pressure.
    pub fn limits(&self) -> [[f64; 2]; 4] {
        [
            self.stretch,
            self.curvature_1_m,
            self.upper_pressure_pa,
            self.lower_pressure_pa,
        ]
    }
}

/// Slopes of bladder area against bending moment [m^2/(N m)].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AreaPerMoment {
    /// `aM-`: where bending opens the bladder [m^2/(N m)].
    #[schemars(range(min = 0.0))]
    pub opening: f64,
    /// `aM+ >= aM-`: where bending closes the bladder [m^2/(N m)].
    #[schemars(range(min = 0.0))]
    pub closing: f64,
}

/// Slopes of bladder area against normal force [m^2/N].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AreaPerForce {
    /// `aN-`: under tension [m^2/N].
    #[schemars(range(min = 0.0))]
    pub tension: f64,
    /// `aN+ >= aN-`: under compression [m^2/N].
    #[schemars(range(min = 0.0))]
    pub compression: f64,
}

/// Strain of the beam by pressure.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Coupling {
    /// Strains and areas from one potential, mean slopes: energy is conserved.
    #[default]
    Reciprocal,
    /// The same potential with the kinked slopes; offered only where it stays convex.
    ReciprocalKinked,
    /// The coefficients as the paper gives them, reciprocal or not.
    Published(PublishedCoupling),
}

/// Strain of one segment per unit of `pressure/E`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PublishedCoupling {
    /// `psi'`: slope per unit of `(p_d - p_u)/E` [rad]: `alpha_p = -phi_b psi' (p_d - p_u)/E`, (A.24).
    #[schemars(range(min = 0.0))]
    pub slope_per_pressure_rad: f64,
    /// `zeta'`: length per unit of `(p_u + p_d)/E` [m]: `lambda_p = phi_b zeta' (p_u + p_d)/E`.
    #[schemars(range(min = 0.0))]
    pub length_per_pressure_m: f64,
}

/// Cross-sections with a known permeability `q1` (no slip).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum CrossSection {
    /// Circle: `pi r^4/8`.
    Circle {
        /// Radius [m].
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius_m: f64,
    },
    /// Rectangle (a square when the sides are equal): series solution.
    Rectangle {
        /// One side [m].
        #[schemars(extend("exclusiveMinimum" = 0))]
        height_m: f64,
        /// The other side [m].
        #[schemars(extend("exclusiveMinimum" = 0))]
        width_m: f64,
    },
    /// Ellipse: `pi a^3 b^3/(4 (a^2 + b^2))`.
    Ellipse {
        /// Semi-axis a [m].
        #[schemars(extend("exclusiveMinimum" = 0))]
        semi_axis_a_m: f64,
        /// Semi-axis b [m].
        #[schemars(extend("exclusiveMinimum" = 0))]
        semi_axis_b_m: f64,
    },
    /// Equilateral triangle: `sqrt(3) a^4/320`.
    Triangle {
        /// Side [m].
        #[schemars(extend("exclusiveMinimum" = 0))]
        side_m: f64,
    },
}

fn yes() -> bool {
    true
}

fn is_yes(value: &bool) -> bool {
    *value
}

fn default_kink_width() -> f64 {
    1e-4
}
