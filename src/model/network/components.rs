//! What is joined to what, not through ports.

use std::collections::BTreeSet;

use super::{Network, Node};

/// Numbers the connected components of bladders and junctions, and finds those that a port or a source touches.
pub(super) fn find(network: &mut Network, bladders: usize) {
    let links = network.links.iter().filter(|l| !l.is_shut()).map(|l| (l.from, l.to));
    let joined: Vec<_> = links.chain(network.bridges.iter().map(|b| (b.from, b.to))).collect();
    let slot = |node: Node| match node {
        Node::Cell { bladder, .. } => Some(bladder),
        Node::Junction(j) => Some(bladders + j),
        Node::Port(_) => None,
    };
    let mut parent: Vec<usize> = (0..bladders + network.junctions.len()).collect();
    for &(from, to) in &joined {
        if let (Some(a), Some(b)) = (slot(from), slot(to)) {
            let (a, b) = (root(&mut parent, a), root(&mut parent, b));
            parent[a.max(b)] = a.min(b);
        }
    }
    // the root of a component is its first member
    let mut component = vec![];
    for i in 0..parent.len() {
        let first = root(&mut parent, i);
        component.push(if first == i {
            network.components
        } else {
            component[first]
        });
        network.components += usize::from(first == i);
    }
    let of = |node: Node| slot(node).map(|slot| component[slot]);
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

fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}
