//! Links of a network: points joined by resistances, valves and pumps.

use super::{CheckValveLaw, PumpLaw, TubeFlow};
use crate::case::schema::BladderEnd;
use crate::functions::signals::Signal;
use crate::numerics::Scalar;

/// A point of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NetworkNode {
    /// The outermost cell of a bladder, behind its half-cell resistance.
    Cell {
        /// Bladder, `0..n`: upper row first.
        bladder: usize,
        /// End of the bladder.
        end: BladderEnd,
    },
    /// A junction without storage; its pressure is an unknown.
    Junction(usize),
    /// A point with prescribed pressure.
    Port(usize),
}

/// Kind of resistance of a link, besides half cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkKind {
    /// No resistance: a bladder's end at a junction or a port.
    Opening,
    /// A tube.
    Tube,
    /// A turbine; index.
    Turbine(usize),
}

/// `[E6]` A link between two points (A.13, A.67), with the opening `o` of its valve and its pump:
///
/// ```text
/// q = g (p_a - p_b + p_pump)    g = o/(o (R_half,a + R_half,b + R_pump) + R)    R = μ l_c/q1c
/// ```
///
/// A check valve is in series with all of these, [E7].
#[derive(Clone, Debug)]
pub struct Link {
    /// Place of a tube among those of the case, tubes of chains first; 0 for other links.
    pub order: usize,
    /// Start of positive flow.
    pub from: NetworkNode,
    /// End of positive flow.
    pub to: NetworkNode,
    /// Resistance between the points, half cells excluded [Pa s/m^3].
    pub resistance: f64,
    /// Opening of the valve; `None`: no valve.
    pub opening: Option<Signal>,
    /// Vessel that opens the valve.
    pub pilot: Option<ValvePilot>,
    /// Kind of link.
    pub kind: LinkKind,
    /// Radius of a tube, or of the circular tube of equal permeability [m]; 0 for other links.
    pub radius: f64,
    /// Inertia and losses of a tube; none for creeping flow.
    pub tube: Option<TubeFlow>,
    /// Check valve.
    pub check_valve: Option<CheckValveLaw>,
    /// Pump.
    pub pump: Option<PumpLaw>,
    /// Hydrostatic pressure difference `ρ g (z_from - z_to)` [Pa], [E88].
    pub head: f64,
}

impl Link {
    /// True if its valve never opens.
    pub fn is_shut(&self) -> bool {
        let shut = |o: &Signal| o.is_constant() && o.value(0.0) <= 0.0;
        self.opening.as_ref().is_some_and(shut)
    }

    /// Inertance of the fluid [kg/m^4]; 0 without inertia.
    pub fn inertance(&self) -> f64 {
        self.tube.map_or(0.0, |tube| tube.law.inertance)
    }
}

/// `[E103]` Vessel of volume V that opens the valve of a link:
///
/// ```text
/// o = o(t) S((V - V_closed)/(V_open - V_closed))      S(x) = x³ (10 - 15 x + 6 x²) between 0 and 1
/// ```
///
/// S is 0 below 0, 1 above 1, and twice continuously differentiable. A vessel that snaps between two volumes, [E102], gives the valve the
/// hysteresis of its pressures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValvePilot {
    /// Index of the vessel among the accumulators.
    pub vessel: usize,
    /// `V_closed` [m^3].
    pub closed_at: f64,
    /// `V_open` [m^3], below `V_closed` for a valve that the vessel closes.
    pub open_at: f64,
}

impl ValvePilot {
    /// `S` at a volume [m^3].
    #[inline]
    pub fn opening<T: Scalar>(&self, volume: T) -> T {
        volume.lift(|volume| {
            let range = self.open_at - self.closed_at;
            let x = ((volume - self.closed_at) / range).clamp(0.0, 1.0);
            let rest = x * (1.0 - x);
            (x * x * x * (10.0 + x * (6.0 * x - 15.0)), 30.0 * rest * rest / range)
        })
    }
}
