//! Storage of fluid in bladders, and its unknowns.

use super::network::{Component, LinkKind, NetworkNode};
use super::{EffectSet, ResolvedNetwork};
use crate::case::schema::Case;
use crate::case::schema::Effect;
use crate::case::spans;
use crate::case::wiring::bladder_index;

/// `[E23]` Storage laws of a bladder's area and pressure:
///
/// ```text
/// flowing   Δs da/dt = inflow of each cell       p = (a - R A_M(Mbar) - A_N(Nbar))/a_p
/// kept      a = a0, what it was at the start     p = (a0 - R A_M(Mbar) - A_N(Nbar))/a_p
/// shared    a = a_p p + R A_M(Mbar) + A_N(Nbar)  p that of its lumped network, [E25]
/// ```
///
/// A sealed bladder with uniform initial pressure keeps it uniform: "kept" is exact. For connected bladders "kept" is
/// the limit of motion fast against the network, ω τ → ∞; "shared" is the limit ω τ → 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// The areas of its cells are unknowns.
    Flowing,
    /// Its volume keeps its initial value: no unknown.
    Kept,
    /// Its pressure is that of a lumped network, given by its index.
    Shared(usize),
    /// There is no bladder: no unknown, no pressure and no area.
    Absent,
}

/// `[E25]` Bladders with a common pressure p:
///
/// ```text
/// closed   l_b Σ_j (a_p p + R A_M(Mbar_j) + A_N(Nbar_j)) = V0        one unknown, p
/// port     p given                                                   none
/// fed      l_b Σ_j (a_p p + R A_M + A_N) = V,  dV/dt = Σ q           p and V
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LumpedNetwork {
    /// Component of the network.
    pub component: usize,
    /// Its bladders.
    pub bladders: Vec<usize>,
    /// Quantity that determines its pressure.
    pub kind: LumpedKind,
}

/// Quantity that determines the pressure of a lumped network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LumpedKind {
    /// Its volume, which is constant.
    Closed,
    /// A pressure port, given by its index.
    Port(usize),
    /// Its volume, fed by sources, given by their indices.
    Fed(Vec<usize>),
}

impl LumpedNetwork {
    /// Each network component as a lumped network, or the reason why it cannot be lumped.
    pub fn all(network: &ResolvedNetwork) -> impl Iterator<Item = Result<Self, String>> {
        let parts = Component::all(network).into_iter().enumerate();
        parts.map(|(component, part)| Self::new(network, component, part))
    }

    /// A network component as a lumped network, or the reason why it cannot be lumped.
    fn new(network: &ResolvedNetwork, component: usize, part: Component) -> Result<Self, String> {
        let mut ports = vec![];
        let links = part.links.iter().map(|&link| &network.links[link]);
        for link in links.filter(|link| !link.is_shut()) {
            if matches!(link.kind, LinkKind::Turbine(_)) {
                return Err("a turbine needs pressure differences".into());
            }
            if link.check_valve.is_some() {
                return Err("a check valve needs pressure differences".into());
            }
            if link.pump.is_some() {
                return Err("a pump needs pressure differences".into());
            }
            if link.head != 0.0 {
                return Err("points of different heights need pressure differences".into());
            }
            if link.pilot.is_some() || link.opening.as_ref().is_some_and(|o| !o.is_constant()) {
                return Err("a valve moves".into());
            }
            ports.extend([link.from, link.to].into_iter().filter_map(|node| match node {
                NetworkNode::Port(p) => Some(p),
                _ => None,
            }));
        }
        if part.accumulates {
            return Err("an accumulator needs pressure differences".into());
        }
        if part.bridged {
            return Err("a turbine needs pressure differences".into());
        }
        let pressure = |p: usize| &network.ports[p].pressure;
        if let Some(other) = ports.iter().find(|&&p| pressure(p) != pressure(ports[0])) {
            let (a, b) = (&network.ports[ports[0]].name, &network.ports[*other].name);
            return Err(format!("the ports \"{a}\" and \"{b}\" prescribe different pressures"));
        }
        Ok(Self {
            component,
            bladders: part.bladders,
            kind: match (ports.first(), part.sources.is_empty()) {
                (Some(&port), _) => LumpedKind::Port(port),
                (None, true) => LumpedKind::Closed,
                (None, false) => LumpedKind::Fed(part.sources),
            },
        })
    }
}

/// Storage law of every bladder, and the lumped networks.
pub fn of_bladders(case: &Case, network: &ResolvedNetwork, effects: &EffectSet) -> (Vec<Storage>, Vec<LumpedNetwork>) {
    let per_row = network.component_of_bladder.len() / 2;
    let exists = spans::bladders(case);
    let uneven = |bladder: usize| {
        case.start.pressures.iter().any(|start| {
            let here = |b: &i64| bladder_index(*b, per_row) == Some(bladder);
            start.bladders.iter().any(here) && !start.pressure_pa.is_uniform()
        })
    };
    let mut storage: Vec<Storage> = network
        .sealed()
        .enumerate()
        .map(|(bladder, sealed)| {
            if !exists(bladder) {
                Storage::Absent
            } else if !effects.has(Effect::Flow) || (sealed && !uneven(bladder)) {
                Storage::Kept
            } else {
                Storage::Flowing
            }
        })
        .collect();
    let mut lumped = vec![];
    if effects.has(Effect::Flow) && !effects.has(Effect::NetworkPressureDifferences) {
        for one in LumpedNetwork::all(network).flatten() {
            if one.bladders.iter().any(|&b| storage[b] == Storage::Flowing) {
                let shared = Storage::Shared(lumped.len());
                one.bladders.iter().for_each(|&b| storage[b] = shared);
                lumped.push(one);
            }
        }
    }
    (storage, lumped)
}
