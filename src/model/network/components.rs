//! Connected components of a network, and groups of junctions connected only through tubes with inertia.

use std::collections::BTreeSet;

use super::{NetworkNode, ResolvedNetwork};
use crate::numerics::sets::Sets;

/// Numbers the connected components of bladders and junctions, and lists those with a port or a source.
pub(super) fn find(network: &mut ResolvedNetwork, bladders: usize) {
    let links = network.links.iter().filter(|l| !l.is_shut()).map(|l| (l.from, l.to));
    let joined: Vec<_> = links.chain(network.bridges.iter().map(|b| (b.from, b.to))).collect();
    let slot = |node: NetworkNode| match node {
        NetworkNode::Cell { bladder, .. } => Some(bladder),
        NetworkNode::Junction(j) => Some(bladders + j),
        NetworkNode::Port(_) => None,
    };
    let slots = bladders + network.junctions.len();
    let mut sets = Sets::new(slots);
    for &(from, to) in &joined {
        if let (Some(a), Some(b)) = (slot(from), slot(to)) {
            sets.join(a, b);
        }
    }
    // the root of a set is its first member
    let mut component = vec![];
    for i in 0..slots {
        let first = sets.root(i);
        component.push(if first == i {
            network.components
        } else {
            component[first]
        });
        network.components += usize::from(first == i);
    }
    let of = |node: NetworkNode| slot(node).map(|slot| component[slot]);
    let mut open: BTreeSet<usize> = network.sources.iter().filter_map(|s| of(s.into)).collect();
    for (from, to) in joined {
        if let (Some(touched), None) | (None, Some(touched)) = (of(from), of(to)) {
            open.insert(touched);
        }
    }
    network.open = open.into_iter().collect();
    network.component_of_junction = component.split_off(bladders);
    network.component_of_bladder = component;
}

/// Members of one component, as ascending indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Component {
    /// Bladders.
    pub bladders: Vec<usize>,
    /// Junctions.
    pub junctions: Vec<usize>,
    /// Links that touch it, including shut ones.
    pub links: Vec<usize>,
    /// True if a bridge touches it.
    pub bridged: bool,
    /// True if it contains an accumulator.
    pub accumulates: bool,
    /// Sources into it.
    pub sources: Vec<usize>,
}

impl Component {
    /// Returns all components of a network, in order.
    pub fn all(network: &ResolvedNetwork) -> Vec<Self> {
        let mut all = vec![Self::default(); network.components];
        for (bladder, &of) in network.component_of_bladder.iter().enumerate() {
            all[of].bladders.push(bladder);
        }
        for (junction, &of) in network.component_of_junction.iter().enumerate() {
            all[of].junctions.push(junction);
        }
        for (number, link) in network.links.iter().enumerate() {
            let [from, to] = [link.from, link.to].map(|node| network.component_of(node));
            for of in from.into_iter().chain(to.filter(|_| to != from)) {
                all[of].links.push(number);
            }
        }
        for node in network.bridges.iter().flat_map(|bridge| [bridge.from, bridge.to]) {
            network.component_of(node).iter().for_each(|&of| all[of].bridged = true);
        }
        for one in &network.accumulators {
            all[network.component_of_junction[one.junction]].accumulates = true;
        }
        for (number, source) in network.sources.iter().enumerate() {
            network
                .component_of(source.into)
                .iter()
                .for_each(|&of| all[of].sources.push(number));
        }
        all
    }
}

/// Groups of junctions joined by links without inertia, and connected to the rest only by tubes with inertia. A group
/// contains no accumulator, and touches no bladder or port directly. Flows into a group sum to zero, and its pressure
/// level follows from accelerations.
pub fn adrift(network: &ResolvedNetwork) -> Vec<Vec<usize>> {
    let held = network.junctions.len();
    let slot = |node: NetworkNode| match node {
        NetworkNode::Junction(j) => j,
        NetworkNode::Cell { .. } | NetworkNode::Port(_) => held,
    };
    let mut sets = Sets::new(held + 1);
    let links = network
        .links
        .iter()
        .filter(|link| !link.is_shut() && link.inertance() == 0.0);
    let joined = links.map(|link| (link.from, link.to));
    for (from, to) in joined.chain(network.bridges.iter().map(|bridge| (bridge.from, bridge.to))) {
        sets.join(slot(from), slot(to));
    }
    for one in &network.accumulators {
        sets.join(one.junction, held);
    }
    let held = sets.root(held);
    let mut groups = vec![vec![]; network.junctions.len()];
    for junction in 0..network.junctions.len() {
        let first = sets.root(junction);
        if first != held {
            groups[first].push(junction);
        }
    }
    groups.retain(|group| !group.is_empty());
    groups
}
