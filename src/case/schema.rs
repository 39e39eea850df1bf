//! The case as the user writes it: these structures *are* the JSON (externally tagged enums, unknown
//! keys refused), every key in SI units with its unit in its name. The JSON Schema that editors use is
//! generated from this file, doc comments included; `case.json` of a result folder is this structure
//! written back with every default filled in.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::profile::Profile;
use super::signals::Signal;

/// A case: one beam, its bladders and tubes, what is done to it, and how it is to be solved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "slcbeam case")]
pub struct Case {
    /// The JSON Schema that describes this file, for editors; not read.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Short name; the default result folder is `out/<name>`. Letters, digits, `-`, `_` and `.`.
    pub name: String,
    /// What the case shows and where it comes from.
    #[serde(default)]
    pub about: String,
    /// The solid.
    pub beam: Beam,
    /// The fluid that fills bladders and tubes. Absent together with `bladders`: a dry beam.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fluid: Option<Fluid>,
    /// The two rows of bladders. Absent: a dry beam.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bladders: Option<Bladders>,
    /// What a tube is unless it says otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tubes: Option<TubeDefaults>,
    /// How the bladders are joined. Absent: every bladder is sealed singly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub network: Option<Network>,
    /// Distributed forces and moments, body force, gravity. They add.
    #[serde(default)]
    pub loads: Vec<Load>,
    /// Conditions at the root (theta = 0) and the tip (theta = length).
    pub ends: Ends,
    /// State at t = 0; what is not given is zero.
    #[serde(default)]
    pub start: Start,
    /// Form of the momentum balance.
    #[serde(default)]
    pub formulation: Formulation,
    /// Which physical effects are simulated.
    #[serde(default)]
    pub effects: Effects,
    /// Resolution in space.
    #[serde(default)]
    pub mesh: Mesh,
    /// Simulated time and output times.
    pub time: Time,
    /// Time integration.
    #[serde(default)]
    pub solver: Solver,
}

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
    /// Material damping and external drag; absent: undamped.
    #[serde(default)]
    pub damping: Damping,
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
}

/// Newtonian fluid in creeping flow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fluid {
    /// Density `rho_f` [kg/m^3]; 0 for massless fluid.
    #[schemars(range(min = 0.0))]
    pub density_kg_m3: f64,
    /// Dynamic viscosity `mu` [Pa s].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub viscosity_pa_s: f64,
}

/// Two rows of equal bladders, `per_row` each: upper `1..=per_row`, lower `-1..=-per_row`, root to tip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bladders {
    /// Bladders in each row, `n/2`.
    #[schemars(range(min = 1, max = 10000))]
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
    /// Permeability `q1b` in `q = -(q1b/mu) dp/ds` [m^4]; absent: that of `cross_section`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub permeability_m4: Option<f64>,
    /// Cross-section from which the permeability follows; absent: `height_m` by `width_m`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cross_section: Option<CrossSection>,
    /// `a_p`: area per pressure [m^2/Pa].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub area_per_pressure_m2_per_pa: f64,
    /// `aM-` (opening) and `aM+` (closing): area per bending moment.
    pub area_per_moment_m2_per_n_m: AreaPerMoment,
    /// `aN-` (tension) and `aN+` (compression): area per normal force.
    pub area_per_force_m2_per_n: AreaPerForce,
    /// How pressure strains the beam.
    #[serde(default)]
    pub coupling: Coupling,
    /// Width of the smoothed kink between opening and closing slopes, relative to `EI/l_s` (moment) and `EA` (force).
    #[serde(default = "default_kink_width")]
    #[schemars(extend("exclusiveMinimum" = 0), range(max = 1.0))]
    pub kink_width: f64,
}

/// Slopes of bladder area against bending moment [m^2/(N m)].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AreaPerMoment {
    /// `aM-`: where bending opens the bladder.
    #[schemars(range(min = 0.0))]
    pub opening: f64,
    /// `aM+ >= aM-`: where bending closes the bladder.
    #[schemars(range(min = 0.0))]
    pub closing: f64,
}

/// Slopes of bladder area against normal force [m^2/N].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AreaPerForce {
    /// `aN-`: under tension.
    #[schemars(range(min = 0.0))]
    pub tension: f64,
    /// `aN+ >= aN-`: under compression.
    #[schemars(range(min = 0.0))]
    pub compression: f64,
}

/// How pressure strains the beam.
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
    /// `psi'`: slope per unit of `(p_d - p_u)/E` [rad].
    #[schemars(range(min = 0.0))]
    pub slope_per_pressure_rad: f64,
    /// `zeta'`: length per unit of `(p_u + p_d)/E` [m].
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

/// What a tube is unless it says otherwise: rigid, slender, without storage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TubeDefaults {
    /// Length `l_c` [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length_m: f64,
    /// Radius `r_c` [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius_m: f64,
    /// Permeability `q1c` [m^4]; absent: Hagen-Poiseuille, `pi r_c^4/8`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub permeability_m4: Option<f64>,
}

/// How the bladders are joined: any graph of tubes between bladder ends and junctions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Network {
    /// Scales `q1b` and `q1c` of all bladders and tubes (the paper's valves).
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub permeability_factor: f64,
    /// Rows of bladders joined outlet to inlet by equal tubes.
    #[serde(default)]
    pub chains: Vec<Chain>,
    /// Names of junctions, points without storage where several tubes meet.
    #[serde(default)]
    pub junctions: Vec<String>,
    /// Single tubes between any two points.
    #[serde(default)]
    pub tubes: Vec<Tube>,
    /// Points with prescribed pressure or flow.
    #[serde(default)]
    pub ports: Vec<Port>,
    /// Conductances that harvest energy, between two points.
    #[serde(default)]
    pub turbines: Vec<Turbine>,
}

impl Default for Network {
    fn default() -> Self {
        Self { permeability_factor: 1.0, chains: vec![], junctions: vec![], tubes: vec![], ports: vec![], turbines: vec![] }
    }
}

/// Bladders joined outlet to inlet in the order given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chain {
    /// Bladder indices `R j`: positive upper, negative lower row.
    #[schemars(length(min = 1))]
    pub bladders: Vec<i64>,
    /// Condition at the first bladder's inlet and at the last one's outlet.
    #[serde(default)]
    pub ends: [ChainEnd; 2],
    /// Opening `o(t)` of the valve on each tube of the chain, 0 (closed) to 1 (open).
    #[serde(default = "Signal::one", skip_serializing_if = "Signal::is_one")]
    pub opening: Signal,
}

/// Condition at the end of a chain.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ChainEnd {
    /// No flow.
    #[default]
    Sealed,
    /// A tube, port or turbine listed elsewhere is attached here.
    Connected,
    /// Prescribed gauge pressure [Pa] behind the half-cell resistance (A.68).
    PressurePa(Signal),
    /// Prescribed flow into the network [m^3/s] (A.69).
    FlowM3S(Signal),
}

/// A point of the network: `{"bladder": 3, "end": "outlet"}` or `{"junction": "tee"}`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Endpoint {
    /// Bladder index `R j`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bladder: Option<i64>,
    /// Which end of that bladder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<BladderEnd>,
    /// Name of a junction listed under `/network/junctions`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub junction: Option<String>,
}

/// The two ends of a bladder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BladderEnd {
    /// s = 0.
    Inlet,
    /// s = l_b.
    Outlet,
}

/// A tube between two points, `q = (q1c/(mu l_c)) (p_from - p_to)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tube {
    /// Where it starts.
    pub from: Endpoint,
    /// Where it ends.
    pub to: Endpoint,
    /// Length [m]; absent: that of `/tubes`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length_m: Option<f64>,
    /// Permeability [m^4]; absent: that of `cross_section`, else of `/tubes`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub permeability_m4: Option<f64>,
    /// Cross-section from which the permeability follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cross_section: Option<CrossSection>,
    /// Opening `o(t)` of its valve, 0 (closed) to 1 (open).
    #[serde(default = "Signal::one", skip_serializing_if = "Signal::is_one")]
    pub opening: Signal,
}

/// A point with prescribed pressure or flow; exactly one of the two.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Port {
    /// Name in outputs; absent: made from the point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The point.
    pub at: Endpoint,
    /// Gauge pressure [Pa].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure_pa: Option<Signal>,
    /// Flow into the network [m^3/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flow_m3_s: Option<Signal>,
}

/// A turbine: `q = G (p_from - p_to)`, power `G (p_from - p_to)^2`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Turbine {
    /// Name in outputs; absent: `turbine-<k>`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// One port.
    pub from: Endpoint,
    /// The other port.
    pub to: Endpoint,
    /// Conductance `G`.
    pub conductance: TurbineConductance,
    /// Rectifier in front of the turbine.
    #[serde(default)]
    pub rectifier: Rectifier,
}

/// Conductance of a turbine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum TurbineConductance {
    /// `G` [m^3/(s Pa)].
    M3SPa(#[schemars(extend("exclusiveMinimum" = 0))] f64),
    /// The paper's `kappa_turb`: `G = q1b kappa/(mu l_X)` with `q1b` the unscaled bladder permeability.
    Kappa {
        /// `kappa_turb` [1].
        #[schemars(extend("exclusiveMinimum" = 0))]
        kappa: f64,
        /// `l_X`, the length that scales the network coordinate [m]; absent: `l_b n + 0.92 l_c n_c`, n_c
        /// the tubes of all chains (0.92: the paper's tables use 0.0184 m for a tube of 0.020 m).
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0))]
        network_length_m: Option<f64>,
    },
}

/// Full-wave rectifier in front of a turbine.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Rectifier {
    /// Ideal check valves: the turbine sees `|p_from - p_to|`; a linear turbine is not changed.
    #[default]
    Ideal,
    /// Four equal real check valves in a bridge.
    CheckValves {
        /// Pressure drop at which a valve opens [Pa].
        #[schemars(range(min = 0.0))]
        cracking_pressure_pa: f64,
        /// Conductance of an open valve beyond cracking [m^3/(s Pa)].
        #[schemars(extend("exclusiveMinimum" = 0))]
        forward_conductance_m3_s_pa: f64,
        /// Leakage conductance of a closed valve [m^3/(s Pa)].
        #[schemars(extend("exclusiveMinimum" = 0))]
        reverse_conductance_m3_s_pa: f64,
        /// Pressure range over which the valve opens smoothly [Pa].
        #[schemars(extend("exclusiveMinimum" = 0))]
        smoothing_pa: f64,
    },
}

/// A distributed load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Load {
    /// Contact force per length in x (transverse) [N/m].
    ForceXNM(Distributed),
    /// Contact force per length in z (axial) [N/m].
    ForceZNM(Distributed),
    /// First moment per length, x component `m b1_x` [N]: acts as a couple `m b1_x x'/lambda^2`.
    MomentXN(Distributed),
    /// First moment per length, z component `m b1_z` [N]; positive turns in the sense of M.
    MomentZN(Distributed),
    /// Body force per mass in x [m/s^2], acting on `m`.
    BodyXMS2(Distributed),
    /// Body force per mass in z [m/s^2], acting on `m`.
    BodyZMS2(Distributed),
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

/// `signal(t) * profile(theta/l_s)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Distributed {
    /// Time function.
    pub signal: Signal,
    /// Shape along the beam, a function of `theta/l_s`; absent: 1.
    #[serde(default = "Profile::one")]
    pub profile: Profile,
}

/// Conditions at the two ends (A.49-A.54).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ends {
    /// theta = 0.
    pub root: End,
    /// theta = l_s.
    pub tip: End,
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
    /// Nothing held: takes `force_x_n`, `force_z_n`, `moment_n_m`, `follower_normal_n`, `follower_shear_n`.
    Free(EndConditions),
    /// u1, u3 and slope held or driven: takes `u1_m`, `u3_m`, `slope_rad`.
    Clamped(EndConditions),
    /// u1 and u3 held or driven, free to turn: takes `u1_m`, `u3_m`, `moment_n_m`.
    Pinned(EndConditions),
    /// Slope held, free to move across: takes `slope_rad`, `force_x_n`, and `u3_m` (held, default) or `force_z_n`.
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

/// Form of the momentum balance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Formulation {
    /// `m a = b + (N e_t + V e_n + r d1)'`: conserves momentum and energy.
    #[default]
    Conservative,
    /// (A.5) to the letter.
    Published,
}

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
    /// Inertia of the section's rotation, `m y11`.
    #[serde(default)]
    pub rotary_inertia: Choice,
    /// Inertia of the solid; off: quasi-static solid.
    #[serde(default)]
    pub solid_inertia: Choice,
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

/// Resolution in space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// `K`: beam cells per segment.
    #[serde(default = "four")]
    #[schemars(range(min = 1, max = 1000))]
    pub cells_per_segment: usize,
    /// Finite volumes along each bladder.
    #[serde(default = "two")]
    #[schemars(range(min = 1, max = 1000))]
    pub cells_per_bladder: usize,
    /// Segments of a dry beam; with bladders it is their number per row. Absent: 10.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 100000))]
    pub segments: Option<usize>,
}

impl Default for Mesh {
    fn default() -> Self {
        Self { cells_per_segment: 4, cells_per_bladder: 2, segments: None }
    }
}

/// Simulated time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// End of the run [s].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub end_s: f64,
    /// Interval between rows of `history.csv` [s]; absent: a thousandth of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub output_interval_s: Option<f64>,
    /// Interval between entries of `fields.npz` [s], a multiple of the output interval; absent: the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub fields_interval_s: Option<f64>,
    /// Last part of the run over which "window" figures are taken [s]; absent: a tenth of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub window_s: Option<f64>,
}

/// Time integration by IDA.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solver {
    /// Tolerance relative to each unknown's scale.
    #[serde(default = "default_rtol")]
    #[schemars(range(min = 1e-13, max = 0.1))]
    pub rtol: f64,
    /// Highest BDF order.
    #[serde(default)]
    pub max_order: MaxOrder,
    /// IDA's nonlinear convergence coefficient.
    #[serde(default = "default_nonlinear_coefficient")]
    #[schemars(extend("exclusiveMinimum" = 0), range(max = 1.0))]
    pub nonlinear_coefficient: f64,
    /// Relative change of the step coefficient that asks for a new Jacobian (IDA's `dcj`).
    #[serde(default = "default_delta_cj")]
    #[schemars(extend("exclusiveMinimum" = 0), extend("exclusiveMaximum" = 1))]
    pub delta_cj_setup: f64,
    /// First step [s]; absent: IDA's choice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub initial_step_s: Option<f64>,
    /// Largest step [s]; absent: a tenth of the run, at most a 16th of the shortest period among the signals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub max_step_s: Option<f64>,
    /// Stop, with everything computed so far, after this many steps.
    #[serde(default = "default_max_steps")]
    #[schemars(range(min = 1))]
    pub max_steps: u64,
    /// Characteristic transverse displacement [m] to which `rtol` refers; absent: estimated from the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub transverse_scale_m: Option<f64>,
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            rtol: default_rtol(),
            max_order: MaxOrder::Auto,
            nonlinear_coefficient: default_nonlinear_coefficient(),
            delta_cj_setup: default_delta_cj(),
            initial_step_s: None,
            max_step_s: None,
            max_steps: default_max_steps(),
            transverse_scale_m: None,
        }
    }
}

/// Highest BDF order: `"auto"` or 1 to 5.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MaxOrder {
    /// Decided from the scene: 2 with undamped inertia, 5 without inertia.
    #[default]
    Auto,
    /// As given.
    Order(u8),
}

fn one() -> f64 {
    1.0
}
fn two() -> usize {
    2
}
fn four() -> usize {
    4
}
fn default_kink_width() -> f64 {
    1e-4
}
fn default_rtol() -> f64 {
    1e-5
}
fn default_nonlinear_coefficient() -> f64 {
    0.33
}
fn default_delta_cj() -> f64 {
    0.25
}
fn default_max_steps() -> u64 {
    20_000_000
}
