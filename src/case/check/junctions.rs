//! Junctions have no storage: each must reach a bladder or a pressure port through open branches, or its pressure
//! is not determined.

use std::collections::{BTreeMap, BTreeSet};

use super::network::Point;
use crate::case::faults::Faults;
use crate::case::schema::{BladderEnd, Case, Endpoint, Network};
use crate::case::signals::Signal;
use crate::error::{Code, Violation};

/// An opening below this is closed.
const CLOSED: f64 = 1e-9;
/// Instants at which the branches are looked at when a valve moves.
const INSTANTS: usize = 200;

/// A tube or turbine between two points.
struct Branch<'a> {
    points: [Point; 2],
    opening: Option<&'a Signal>,
}

pub(super) fn check(case: &Case, network: &Network, attached: &BTreeMap<Point, Vec<String>>, faults: &mut Faults) {
    let branches = branches(network);
    let held: BTreeSet<Point> = network
        .ports
        .iter()
        .filter(|port| port.pressure_pa.is_some())
        .filter_map(|port| point(&port.at))
        .collect();
    let names: BTreeSet<&String> = network.junctions.iter().collect();
    let used = |name: &str| attached.contains_key(&Point::Junction(name.to_owned()));
    for (i, name) in network.junctions.iter().enumerate().filter(|(_, name)| !used(name)) {
        let fault = Violation::new(
            Code::Junction,
            format!("/network/junctions/{i}"),
            format!("junction \"{name}\" is not used"),
        );
        faults.push(fault.hint("attach tubes to it or remove it"));
    }
    let mut dead: BTreeMap<&String, f64> = BTreeMap::new();
    for t in instants(&branches, case.time.end_s) {
        let reached = reached(&branches, &held, t);
        for name in names
            .iter()
            .copied()
            .filter(|name| used(name) && !reached.contains(&Point::Junction((*name).clone())))
        {
            dead.entry(name).or_insert(t);
        }
    }
    for (name, t) in dead {
        let i = network.junctions.iter().position(|n| n == name).unwrap_or_default();
        let what = format!("junction \"{name}\" reaches neither a bladder nor a pressure port at {t} s");
        let fault = Violation::new(Code::Junction, format!("/network/junctions/{i}"), what);
        faults.push(
            fault.hint("open a branch or attach a bladder: a junction stores nothing, so its pressure is undefined"),
        );
    }
}

fn branches(network: &Network) -> Vec<Branch<'_>> {
    let tubes = network
        .tubes
        .iter()
        .map(|tube| (&tube.from, &tube.to, Some(&tube.opening)));
    let turbines = network
        .turbines
        .iter()
        .map(|turbine| (&turbine.from, &turbine.to, None));
    let branch = |(from, to, opening)| {
        Some(Branch {
            points: [point(from)?, point(to)?],
            opening,
        })
    };
    tubes.chain(turbines).filter_map(branch).collect()
}

fn point(endpoint: &Endpoint) -> Option<Point> {
    match (endpoint.bladder, &endpoint.junction) {
        (Some(index), None) => Some(Point::Bladder(index, endpoint.end.unwrap_or(BladderEnd::Inlet))),
        (None, Some(name)) => Some(Point::Junction(name.clone())),
        _ => None,
    }
}

fn instants(branches: &[Branch], end: f64) -> Vec<f64> {
    let mut instants = vec![0.0];
    let moving: Vec<&Signal> = branches
        .iter()
        .filter_map(|b| b.opening)
        .filter(|o| !o.is_constant())
        .collect();
    if !moving.is_empty() {
        instants.extend((1..=INSTANTS).map(|i| end * i as f64 / INSTANTS as f64));
        for opening in moving {
            instants.extend(
                opening
                    .smooth_intervals(end)
                    .iter()
                    .map(|(start, stop)| 0.5 * (start + stop)),
            );
        }
        instants.sort_by(f64::total_cmp);
    }
    instants
}

/// Points joined by open branches to a bladder or a pressure port.
fn reached(branches: &[Branch], held: &BTreeSet<Point>, t: f64) -> BTreeSet<Point> {
    let mut reached = held.clone();
    let ends = branches.iter().flat_map(|branch| &branch.points);
    reached.extend(ends.filter(|point| matches!(point, Point::Bladder(..))).cloned());
    let open: Vec<_> = branches
        .iter()
        .filter(|b| b.opening.is_none_or(|o| o.value(t) > CLOSED))
        .collect();
    loop {
        let before = reached.len();
        for branch in &open {
            if branch.points.iter().any(|point| reached.contains(point)) {
                reached.extend(branch.points.iter().cloned());
            }
        }
        if reached.len() == before {
            return reached;
        }
    }
}
