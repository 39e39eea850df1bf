//! The network as a graph: bladder ends, junctions and ports joined by conductances.
//!
//! ```text
//! link               links, and valves that a vessel opens
//! graph              graph of a resolved case
//! components         connected components
//! tube               inertia, unsteady friction and losses in tubes
//! bladder_flow       flow along a bladder
//! unsteady_friction  unsteady friction
//! check_valve        check valves and relief valves
//! ends               ends of tubes with inertia
//! accumulator        vessels that store fluid under pressure
//! pressure_volume    pressure of a vessel over its volume, from points
//! pump               pressure of a pump over its flow
//! ```

mod accumulator;
mod bladder_flow;
mod check_valve;
mod components;
mod ends;
mod graph;
mod link;
mod pressure_volume;
mod pump;
pub mod tube;
mod unsteady_friction;

use super::{Wet, duct};
use crate::case::schema::{Bladders, Case};
use crate::case::wiring::Wiring;
use crate::error::Result;
use crate::functions::signals::Signal;

pub use accumulator::{AccumulatorElement, AccumulatorLaw};
pub use bladder_flow::AlongBladder;
pub use check_valve::CheckValveLaw;
pub use components::Component;
pub use ends::TubeEnd;
pub use link::{Link, LinkKind, NetworkNode, ValvePilot};
pub use pressure_volume::PressureVolumeCurve;
pub use pump::{PumpCharacteristic, PumpLaw};
pub use tube::{FlowLaw, TubeFlow};
pub use unsteady_friction::{BRANCHES, Ladder};

/// Prescribed flow into a cell or a junction.
#[derive(Clone, Debug)]
pub struct PrescribedFlow {
    /// Cell or junction that it feeds.
    pub into: NetworkNode,
    /// Prescribed quantity.
    pub feed: Feed,
    /// Name.
    pub name: String,
}

/// Prescribed quantity of a source.
#[derive(Clone, Debug, PartialEq)]
pub enum Feed {
    /// Flow [m^3/s].
    Flow(Signal),
    /// Injected volume [m^3]; the flow is its rate.
    Volume(Signal),
}

impl Feed {
    /// Prescribed signal.
    pub const fn signal(&self) -> &Signal {
        let (Self::Flow(signal) | Self::Volume(signal)) = self;
        signal
    }

    /// Prescribed signal, mutable.
    pub const fn signal_mut(&mut self) -> &mut Signal {
        let (Self::Flow(signal) | Self::Volume(signal)) = self;
        signal
    }

    /// Largest flow between t = 0 and `end` [m^3/s].
    pub fn largest_flow(&self, end: f64) -> f64 {
        match self {
            Self::Flow(flow) => flow.largest(end).value,
            Self::Volume(volume) => volume.largest(end).rate,
        }
    }
}

/// A prescribed pressure.
#[derive(Clone, Debug)]
pub struct PressurePort {
    /// Pressure [Pa].
    pub pressure: Signal,
    /// Name.
    pub name: String,
}

/// A bridge of four equal real check valves in front of a turbine, between two junctions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bridge {
    /// First terminal: a junction or a pressure port.
    pub from: NetworkNode,
    /// Second terminal.
    pub to: NetworkNode,
    /// Index of its turbine.
    pub turbine: usize,
    /// Law of one valve.
    pub valve: CheckValveLaw,
    /// Hydrostatic pressure difference between its terminals, as of a link [Pa].
    pub head: f64,
}

/// A turbine: conductance and name.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearTurbine {
    /// Name in outputs.
    pub name: String,
    /// `G` [m^3/(s Pa)].
    pub conductance: f64,
}

/// The resolved network.
#[derive(Clone, Debug, Default)]
pub struct ResolvedNetwork {
    /// `q1b/mu`, permeability factor included [m^4/(Pa s)].
    pub bladder_mobility: f64,
    /// Momentum along bladders; none for creeping flow.
    pub along_bladders: Option<AlongBladder>,
    /// Conductances between points.
    pub links: Vec<Link>,
    /// Prescribed flows.
    pub sources: Vec<PrescribedFlow>,
    /// Prescribed pressures.
    pub ports: Vec<PressurePort>,
    /// Names of the junctions whose pressures are unknowns.
    pub junctions: Vec<String>,
    /// Turbines.
    pub turbines: Vec<LinearTurbine>,
    /// Real rectifiers.
    pub bridges: Vec<Bridge>,
    /// Accumulators, each at its own junction.
    pub accumulators: Vec<AccumulatorElement>,
    /// Part of gravity that acts on the fluid: 1, or the load factor of an equilibrium; none if all points are equally high.
    pub gravity: Option<Signal>,
    /// True if prescribed volumes inject no flow: for equilibria.
    pub still: bool,
    /// True if time steps resolve prescribed volumes even without other reasons: for runs, which integrate their work.
    pub paced: bool,
    /// Component of each bladder; components are joined by links, not through pressure ports.
    pub component_of_bladder: Vec<usize>,
    /// Component of each junction.
    pub component_of_junction: Vec<usize>,
    /// Number of components.
    pub components: usize,
    /// Components with a port or a source.
    pub open: Vec<usize>,
    /// Chains of bladders in their order in the case, which the network coordinate follows.
    pub chains: Vec<Vec<usize>>,
    /// Tubes of all chains and free tubes, `n_c`.
    pub tubes: usize,
}

impl ResolvedNetwork {
    /// Network of a case; none for a dry beam without network.
    ///
    /// # Errors
    /// Returns the errors of [`Wiring::from_case`].
    pub fn from_case(case: &Case) -> Result<Option<Self>> {
        let Some((fluid, bladders)) = case.fluid.as_ref().zip(case.network_bladders()) else {
            return Ok(None);
        };
        let factor = case.network.as_ref().map_or(1.0, |network| network.permeability_factor);
        let wiring = Wiring::from_case(case)?;
        Ok(Some(graph::graph(&wiring, [factor, case.gravity()], fluid, bladders)))
    }

    /// True if there are no bladders.
    pub fn is_dry(&self) -> bool {
        self.component_of_bladder.is_empty()
    }

    /// True if no port or source touches the component.
    pub fn is_closed(&self, component: usize) -> bool {
        self.open_number(component).is_none()
    }

    /// Index of a component among the open ones.
    pub fn open_number(&self, component: usize) -> Option<usize> {
        self.open.binary_search(&component).ok()
    }

    /// True if a pressure port is joined to a component, so that fluid can leave it.
    pub fn lets_out(&self, component: usize) -> bool {
        let inside = |node: NetworkNode| self.component_of(node) == Some(component);
        let port = |node: NetworkNode| matches!(node, NetworkNode::Port(_));
        let links = self.links.iter().filter(|link| !link.is_shut()).map(|l| (l.from, l.to));
        let mut ways = links.chain(self.bridges.iter().map(|b| (b.from, b.to)));
        ways.any(|(a, b)| inside(a) && port(b) || port(a) && inside(b))
    }

    /// For each bladder, true if nothing ever flows into it or out of it.
    pub fn sealed(&self) -> impl Iterator<Item = bool> + use<> {
        let mut sealed = vec![true; self.component_of_bladder.len()];
        let links = self.links.iter().filter(|l| !l.is_shut());
        let joined = links.flat_map(|l| [l.from, l.to]);
        for node in joined.chain(self.sources.iter().map(|s| s.into)) {
            if let NetworkNode::Cell { bladder, .. } = node {
                sealed[bladder] = false;
            }
        }
        sealed.into_iter()
    }

    /// First source into a group of junctions with tubes only, whose inertia prevents a prescribed flow.
    pub fn fed_junction(&self) -> Option<&PrescribedFlow> {
        let adrift = self.adrift();
        let fed = |source: &&PrescribedFlow| {
            adrift
                .iter()
                .flatten()
                .any(|&j| NetworkNode::Junction(j) == source.into)
        };
        self.sources.iter().find(fed)
    }

    /// Groups of junctions joined by links without inertia, and connected to the rest only by tubes with inertia.
    pub fn adrift(&self) -> Vec<Vec<usize>> {
        components::adrift(self)
    }

    /// True if sources or pumps drive flow at a pressure that is unknown in advance.
    pub fn pumped(&self) -> bool {
        !self.sources.is_empty() || self.gravity.is_some() || self.links.iter().any(|link| link.pump.is_some())
    }

    /// Upper bound of the pressure by sources [Pa]. Each fills one bladder alone, or drives its flow through all links
    /// of its component in series if these lead to a port and have no valves.
    pub(super) fn pumped_pressure(&self, wet: &Wet, end: f64) -> f64 {
        let bladder = wet.bladder_length / self.bladder_mobility;
        let of = |source: &PrescribedFlow| {
            let own = self.component_of(source.into);
            let inside = |node: NetworkNode| self.component_of(node) == own;
            let volume = match &source.feed {
                Feed::Flow(flow) => flow.largest_integral(end),
                Feed::Volume(volume) => volume.largest(end).value,
            };
            let filled = match self.is_dry() {
                true => volume / self.compliance_at(source.into, wet),
                false => volume / (wet.compliance() * wet.bladder_length),
            };
            let mut links = self.links.iter().filter(|l| inside(l.from) || inside(l.to));
            let lets_out = |l: &Link| matches!((l.from, l.to), (NetworkNode::Port(_), _) | (_, NetworkNode::Port(_)));
            let steady = |l: &Link| l.check_valve.is_none() && l.opening.is_none() && l.pilot.is_none();
            let open = links.clone().any(lets_out) && links.clone().all(steady);
            let in_series = links.try_fold(0.0, |sum, link| {
                (link.resistance.is_finite()).then_some(sum + link.resistance)
            });
            let bladders = self.component_of_bladder.iter().filter(|c| Some(**c) == own).count();
            match in_series {
                Some(sum) if open => filled.min(source.feed.largest_flow(end) * (sum + bladders as f64 * bladder)),
                _ => filled,
            }
        };
        self.sources.iter().map(of).sum()
    }

    /// Compliance of the component of a point, at ambient pressure [m^3/Pa].
    pub fn compliance_at(&self, node: NetworkNode, wet: &Wet) -> f64 {
        let own = self.component_of(node);
        let here = |component: &&usize| Some(**component) == own;
        let bladders = self.component_of_bladder.iter().filter(here).count();
        let vessels = self
            .accumulators
            .iter()
            .filter(|one| here(&&self.component_of_junction[one.junction]));
        bladders as f64 * wet.compliance() * wet.bladder_length
            + vessels.map(|one| wet.vessel_compliance(&one.law, 0.0)).sum::<f64>()
    }

    /// Largest prescribed flow into a component with tubes until `end` [s]: an upper bound of the prescribed flow
    /// through a tube [m^3/s].
    pub fn fed_tubes(&self, end: f64) -> f64 {
        let mut fed = vec![0.0; self.components];
        for source in &self.sources {
            if let Some(component) = self.component_of(source.into) {
                fed[component] += source.feed.largest_flow(end);
            }
        }
        let tubes = self
            .links
            .iter()
            .filter(|link| link.kind == LinkKind::Tube && !link.is_shut());
        let of = |link: &Link| {
            [link.from, link.to]
                .into_iter()
                .find_map(|node| self.component_of(node))
        };
        tubes.filter_map(of).map(|component| fed[component]).fold(0.0, f64::max)
    }

    /// Sum of the conductances of all links with open valves, and of a bladder between two cells of length `cell` [m],
    /// in [m^3/(s Pa)]. An upper bound of the flow per pressure difference.
    pub fn conductance(&self, cell: f64) -> f64 {
        let within = self.bladder_mobility / cell;
        let of = |link: &Link| {
            let cells = [link.from, link.to]
                .into_iter()
                .filter(|n| matches!(n, NetworkNode::Cell { .. }));
            (0.5 * cells.count() as f64 / within + link.resistance).recip()
        };
        let links = self.links.iter().filter(|link| !link.is_shut()).map(of);
        let valves = self.bridges.iter().map(|bridge| 2.0 * bridge.valve.forward);
        within + links.chain(valves).filter(|g| g.is_finite()).sum::<f64>()
    }

    /// Component of a point; `None` for a pressure port.
    pub fn component_of(&self, node: NetworkNode) -> Option<usize> {
        match node {
            NetworkNode::Cell { bladder, .. } => Some(self.component_of_bladder[bladder]),
            NetworkNode::Junction(j) => Some(self.component_of_junction[j]),
            NetworkNode::Port(_) => None,
        }
    }
}

/// Unscaled permeability `q1b` of the bladders [m^4].
pub fn bladder_permeability(bladders: &Bladders) -> f64 {
    bladders
        .permeability_m4
        .unwrap_or_else(|| match &bladders.cross_section {
            Some(section) => duct::permeability(section),
            None => duct::rectangle(bladders.height_m, bladders.width_m),
        })
}
