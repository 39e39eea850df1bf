//! Relaxation times of network pressures.

use nalgebra::DMatrix;

use super::Wet;
use super::network::{Component, Link, NetworkNode, ResolvedNetwork};
use crate::functions::signals::SmoothTime;

/// `[E20]` Slowest relaxation time of each network component [s], with one volume per bladder. `None` for a single
/// sealed bladder, and for components too large for a dense eigenvalue problem.
///
/// ```text
/// C dp/dt = -L p    L the graph Laplacian of the conductances, ports grounded, junctions eliminated
/// ```
pub fn times(wet: &Wet) -> Vec<Option<f64>> {
    let parts = Component::all(&wet.network);
    parts.iter().map(|part| time(wet, part, 0.0)).collect()
}

/// The slowest component.
#[derive(Clone, Debug, PartialEq)]
pub struct Slowest {
    /// Its relaxation time [s].
    pub time: f64,
    /// Ends of its link with the smallest conductance.
    pub between: [String; 2],
}

impl Slowest {
    /// Slowest component with valve openings at an instant [s].
    pub fn at(wet: &Wet, t: f64) -> Option<Self> {
        let parts = Component::all(&wet.network);
        let times = parts.iter().filter_map(|part| Some((time(wet, part, t)?, part)));
        let (time, part) = times.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let links = part.links.iter().map(|&link| &wet.network.links[link]);
        let open = links.filter_map(|link| Some((conductance(wet, link, t), link)).filter(|(g, _)| *g > 0.0));
        let (_, tightest) = open.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let name = |node: NetworkNode| match node {
            NetworkNode::Cell { bladder, end } => format!("{end} of bladder {}", wet.labels.label(bladder)),
            NetworkNode::Junction(j) => wet.network.junctions[j].clone(),
            NetworkNode::Port(port) => wet.network.ports[port].name.clone(),
        };
        Some(Self {
            time,
            between: [tightest.from, tightest.to].map(name),
        })
    }
}

/// Conductance of a link at an instant, without its pump.
fn conductance(wet: &Wet, link: &Link, t: f64) -> f64 {
    let half = 0.5 * wet.bladder_length / wet.network.bladder_mobility;
    let cells = [link.from, link.to].into_iter().filter_map(|node| match node {
        NetworkNode::Cell { bladder, .. } => Some(1.0 / wet.mobility_ratio(bladder)),
        _ => None,
    });
    let cells: f64 = cells.sum();
    let clock = SmoothTime { t, within: t };
    let opening = link.opening.as_ref().map_or(1.0, |o| o.jet(clock).value);
    opening / (opening * half * cells + link.resistance)
}

fn time(wet: &Wet, component: &Component, t: f64) -> Option<f64> {
    const LARGEST: usize = 400;
    let network: &ResolvedNetwork = &wet.network;
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
    let slot = |node: NetworkNode| match node {
        NetworkNode::Cell { bladder, .. } => bladders.binary_search(&bladder).ok(),
        NetworkNode::Junction(j) => junctions.binary_search(&j).ok().map(|k| nb + k),
        NetworkNode::Port(_) => None,
    };
    let mut laplacian = DMatrix::<f64>::zeros(nb + nj, nb + nj);
    let mut grounded = false;
    for link in links.iter().map(|&link| &network.links[link]) {
        let (a, b) = (slot(link.from), slot(link.to));
        if a.is_none() && b.is_none() {
            continue;
        }
        let g = conductance(wet, link, t);
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
    let mut reduced = laplacian.view((0, 0), (nb, nb)).into_owned();
    // symmetric form of C dp/dt = -L p for bladders of different compliances C
    let ratios: Vec<f64> = bladders
        .iter()
        .map(|bladder| wet.compliance_ratio(*bladder).sqrt())
        .collect();
    if ratios.iter().any(|ratio| *ratio != 1.0) {
        for (i, j) in (0..nb).flat_map(|i| (0..nb).map(move |j| (i, j))) {
            reduced[(i, j)] /= ratios[i] * ratios[j];
        }
    }
    let mut values: Vec<f64> = reduced.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    let slowest = values.get(usize::from(!grounded)).copied()?;
    let largest = values.last().copied()?;
    (slowest > 1e-12 * largest).then(|| wet.compliance() * wet.bladder_length / slowest)
}
