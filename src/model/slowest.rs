//! How fast pressures of a network become equal.

use nalgebra::DMatrix;

use super::Wet;
use super::network::{Component, Network, Node};
use crate::functions::signals::Clock;

/// `[E20]` Slowest relaxation time of each component of the network [s], each bladder one volume; `None` for a
/// single sealed bladder and where the component is too large for a dense eigenvalue problem.
///
/// ```text
/// C dp/dt = -L p    L the graph Laplacian of the conductances, ports grounded, junctions eliminated
/// ```
pub fn times(wet: &Wet) -> Vec<Option<f64>> {
    let parts = Component::all(&wet.network);
    parts.iter().map(|part| time(wet, part)).collect()
}

fn time(wet: &Wet, component: &Component) -> Option<f64> {
    const LARGEST: usize = 400;
    let network: &Network = &wet.network;
    let Component {
        bladders,
        junctions,
        links,
        ..
    } = component;
    let (nb, nj) = (bladders.len(), junctions.len());
    if nb == 0 || nb + nj > LARGEST {
        return None;
    }
    let half = 0.5 * wet.bladder_length / network.bladder_mobility;
    let slot = |node: Node| match node {
        Node::Cell { bladder, .. } => bladders.binary_search(&bladder).ok(),
        Node::Junction(j) => junctions.binary_search(&j).ok().map(|k| nb + k),
        Node::Port(_) => None,
    };
    let mut laplacian = DMatrix::<f64>::zeros(nb + nj, nb + nj);
    let clock = Clock { t: 0.0, within: 0.0 };
    let mut grounded = false;
    for link in links.iter().map(|&link| &network.links[link]) {
        let (a, b) = (slot(link.from), slot(link.to));
        if a.is_none() && b.is_none() {
            continue;
        }
        let cells = [link.from, link.to]
            .iter()
            .filter(|n| matches!(n, Node::Cell { .. }))
            .count() as f64;
        let opening = link.opening.as_ref().map_or(1.0, |o| o.jet(clock).value);
        let g = opening / (opening * half * cells + link.resistance);
        grounded |= a.is_none() || b.is_none();
        for (i, j) in [(a, b), (b, a)] {
            if let Some(i) = i {
                laplacian[(i, i)] += g;
                if let Some(j) = j {
                    laplacian[(i, j)] -= g;
                }
            }
        }
    }
    // Eliminate junctions one by one (Schur complement).
    for k in (nb..nb + nj).rev() {
        let pivot = laplacian[(k, k)];
        if pivot <= 0.0 {
            return None;
        }
        for i in 0..k {
            for j in 0..k {
                let change = laplacian[(i, k)] * laplacian[(k, j)] / pivot;
                laplacian[(i, j)] -= change;
            }
        }
    }
    let reduced = laplacian.view((0, 0), (nb, nb)).into_owned();
    let mut values: Vec<f64> = reduced.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    let slowest = values.get(usize::from(!grounded)).copied()?;
    let largest = values.last().copied()?;
    (slowest > 1e-12 * largest).then(|| wet.compliance() * wet.bladder_length / slowest)
}
