//! Tubes, chains, junctions, ports and turbines.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{CrossSection, is_zero, one};
use crate::functions::signals::Signal;

/// Default properties of tubes: rigid, slender, without storage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TubeDefaults {
    /// Length `l_c` [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length_m: f64,
    /// Radius `r_c` [m].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius_m: f64,
    /// Permeability `q1c` [m^4]; absent or `null`: Hagen-Poiseuille, `pi r_c^4/8`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub permeability_m4: Option<f64>,
    /// `K`: losses at both ends, in bends and orifices, `K rho v^2/2`; absent: 1.5, sharp edges (entrance 0.5, exit 1). Counts with
    /// the effect `tube_losses`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub loss_coefficient: Option<f64>,
    /// Roughness of the wall [m]; absent: smooth. Counts with the effect `tube_losses`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub roughness_m: Option<f64>,
}

/// Any graph of tubes between bladder ends and junctions; without bladders, between junctions alone.
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
    /// Heights of junctions; absent: 0, the height of all bladders.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub elevations: Vec<Elevation>,
    /// Single tubes between any two points.
    #[serde(default)]
    pub tubes: Vec<Tube>,
    /// Points with prescribed pressure, flow or volume.
    #[serde(default)]
    pub ports: Vec<Port>,
    /// Vessels that take in fluid as their pressure rises.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub accumulators: Vec<Accumulator>,
    /// Conductances that harvest energy, between two points.
    #[serde(default)]
    pub turbines: Vec<Turbine>,
}

/// Height of a junction with its ports and vessels. Gravity then drives flow: that of the loads, else 9.80665 m/s^2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Elevation {
    /// Name of a junction listed under `/network/junctions`.
    pub junction: String,
    /// Height above the bladders [m].
    #[schemars(range(min = -10000.0, max = 10000.0))]
    pub elevation_m: f64,
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
    /// Volume let into the network beyond what it holds at the start [m^3]: a syringe.
    VolumeM3(Signal),
}

/// A point of the network: `{"bladder": 3, "end": "outlet"}` or `{"junction": "tee"}`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Endpoint {
    /// Bladder index `R j`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bladder: Option<i64>,
    /// End of that bladder.
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

impl std::fmt::Display for BladderEnd {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(match self {
            Self::Inlet => "inlet",
            Self::Outlet => "outlet",
        })
    }
}

/// A tube between two points, `q = (q1c/(mu l_c)) (p_from - p_to)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tube {
    /// Start of the tube.
    pub from: Endpoint,
    /// End of the tube.
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
    /// `K`: losses at both ends, in bends and orifices, `K rho v^2/2`; absent: that of `/tubes`, else 1.5.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub loss_coefficient: Option<f64>,
    /// Roughness of the wall [m]; absent: that of `/tubes`, else smooth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub roughness_m: Option<f64>,
    /// Opening `o(t)` of its valve, 0 (closed) to 1 (open).
    #[serde(default = "Signal::one", skip_serializing_if = "Signal::is_one")]
    pub opening: Signal,
    /// Vessel whose volume opens the valve, beside `opening`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pilot: Option<Pilot>,
    /// Check valve or relief valve in it, which lets fluid through from `from` to `to`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub check_valve: Option<CheckValve>,
    /// Pump in it, which presses from `from` to `to`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pump: Option<Pump>,
}

/// A vessel whose volume opens the valve of a tube, smoothly between two volumes: 0 at one, 1 at the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pilot {
    /// Name of an accumulator; of one without a name, that of its point.
    pub vessel: String,
    /// Its volume at and before which the valve is closed [m^3].
    pub closed_at_m3: f64,
    /// Its volume at and beyond which the valve is open [m^3]; below `closed_at_m3` for a valve that it closes.
    pub open_at_m3: f64,
}

/// A point with prescribed pressure, flow or volume; exactly one of the three.
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
    /// Volume let into the network beyond what it holds at the start [m^3]: a syringe, whose flow is the rate of this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume_m3: Option<Signal>,
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
    CheckValves(CheckValve),
}

/// A check valve; with a high cracking pressure a relief valve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CheckValve {
    /// Pressure drop at which it opens [Pa].
    #[schemars(range(min = 0.0))]
    pub cracking_pressure_pa: f64,
    /// Conductance of the open valve beyond cracking [m^3/(s Pa)].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub forward_conductance_m3_s_pa: f64,
    /// Leakage conductance of the closed valve [m^3/(s Pa)].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub reverse_conductance_m3_s_pa: f64,
    /// Range of pressure over which it opens smoothly, from cracking on [Pa].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub smoothing_pa: f64,
}

/// A pump in a tube, which adds `pressure_pa - resistance_pa_s_m3 q`, or the pressure of its curve, in the tube's direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pump {
    /// Pressure that it adds where nothing flows, over time [Pa]; instead of `curve`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure_pa: Option<Signal>,
    /// Decrease of its pressure per flow [Pa s/m^3], beside `pressure_pa`.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub resistance_pa_s_m3: f64,
    /// Its pressure over its flow; instead of `pressure_pa`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<PumpCurve>,
}

impl Pump {
    /// Signal of its pressure, or of the factor of its curve, with its pointer below the pump.
    pub fn signal(&self) -> Option<(&'static str, &Signal)> {
        let curve = self.curve.as_ref().map(|curve| ("curve/factor", &curve.factor));
        curve.or_else(|| Some(("pressure_pa", self.pressure_pa.as_ref()?)))
    }
}

/// Pressure of a pump over its flow: monotone cubics through the points, straight beyond them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PumpCurve {
    /// Flows in the direction of the tube, ascending [m^3/s].
    #[schemars(length(min = 2, max = 10000))]
    pub flow_m3_s: Vec<f64>,
    /// Pressure that the pump adds at each flow [Pa].
    #[schemars(length(min = 2, max = 10000))]
    pub pressure_pa: Vec<f64>,
    /// Factor of all pressures over time.
    #[serde(default = "Signal::one", skip_serializing_if = "Signal::is_one")]
    pub factor: Signal,
}

/// A vessel that takes in fluid as its pressure rises.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Accumulator {
    /// Name in outputs; absent: made from the point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The point.
    pub at: Endpoint,
    /// Source of the pressure on its fluid: elastic walls, or gas above it.
    pub kind: AccumulatorKind,
    /// Gauge pressure in it at the start [Pa]; of several volumes with this pressure in a curve, the smallest.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub start_pressure_pa: f64,
}

/// Source of the pressure on the fluid in an accumulator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum AccumulatorKind {
    /// Elastic walls, `V = C p`: the compliance of a syringe, of a soft tube.
    Elastic {
        /// `C` [m^3/Pa].
        #[schemars(extend("exclusiveMinimum" = 0))]
        compliance_m3_pa: f64,
        /// Fluid in it at ambient pressure [m^3]: it counts where that is compressed, and a vessel of gas must say it.
        #[serde(default, skip_serializing_if = "is_zero")]
        #[schemars(range(min = 0.0))]
        volume_m3: f64,
    },
    /// A rigid tank, of fluid that is compressed: of compressed air, say.
    Tank {
        /// Its volume [m^3].
        #[schemars(extend("exclusiveMinimum" = 0))]
        volume_m3: f64,
    },
    /// Gas above the fluid.
    Gas {
        /// Volume of the gas at ambient pressure [m^3].
        #[schemars(extend("exclusiveMinimum" = 0))]
        volume_m3: f64,
        /// `n` of `p V^n`: 1 isothermal (slow), up to its ratio of heats (fast).
        #[serde(default = "one")]
        #[schemars(range(min = 1.0, max = 2.0))]
        polytropic_exponent: f64,
    },
    /// Walls with a measured pressure over volume, which may fall in between: a balloon, or a dome that snaps. Monotone cubics through
    /// the points, straight beyond them. Beyond both ends the pressure rises with volume.
    Curve {
        /// Volumes beyond that at ambient pressure, ascending [m^3].
        #[schemars(length(min = 2, max = 10000))]
        volume_m3: Vec<f64>,
        /// Gauge pressure at each volume [Pa].
        #[schemars(length(min = 2, max = 10000))]
        pressure_pa: Vec<f64>,
    },
}

impl Accumulator {
    /// Name in outputs: its own, or that of its point.
    pub fn label(&self) -> String {
        let of_point = || match (self.at.bladder, self.at.end, &self.at.junction) {
            (Some(bladder), Some(end), _) => format!("{end} of bladder {bladder}"),
            (_, _, junction) => junction.clone().unwrap_or_default(),
        };
        self.name.clone().unwrap_or_else(of_point)
    }
}
