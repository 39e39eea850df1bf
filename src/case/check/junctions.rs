//! Checks of junctions. A junction stores nothing: its pressure is determined only if open branches join it to a bladder, an accumulator or
//! a pressure port.

use std::collections::{BTreeMap, BTreeSet};

use super::network::ConnectionTable;
use super::time::END;
use crate::case::faults::Violations;
use crate::case::schema::{Case, Elevation, Network};
use crate::case::wiring::WiringPoint;
use crate::case::wording::nearest;
use crate::error::{Code, Violation, listed};
use crate::functions::signals::Signal;

/// Openings below this value count as closed.
const CLOSED: f64 = 1e-9;
/// Number of instants at which branches are checked if a valve moves.
const INSTANTS: usize = 200;

pub(super) fn check(case: &Case, joined: &ConnectionTable, faults: &mut Violations) {
    let names = case.network.as_ref().map_or(&[][..], |network| &network.junctions);
    // of two junctions with one name, the first counts
    let first = |name: &String| names.iter().position(|other| other == name).map(WiringPoint::Junction);
    let used = |name: &String| first(name).is_some_and(|point| joined.attached.contains_key(&point));
    for (i, name) in names.iter().enumerate().filter(|(_, name)| !used(name)) {
        let fault = Violation::new(
            Code::Wiring,
            format!("/network/junctions/{i}"),
            format!("junction \"{name}\" is not used"),
        );
        faults.push(fault.hint("attach tubes to it or remove it"));
    }
    let mut dead: BTreeMap<usize, f64> = BTreeMap::new();
    let end = if faults.are_sound(&[END]) { case.time.end_s } else { 0.0 };
    for t in instants(joined, end) {
        let reached = reached(joined, t);
        for point in joined.attached.keys().filter(|point| !reached.contains(point)) {
            if let WiringPoint::Junction(i) = point {
                dead.entry(*i).or_insert(t);
            }
        }
    }
    for (i, t) in dead {
        let what = format!(
            "junction \"{}\" reaches no bladder, accumulator or pressure port at {t} s",
            names[i]
        );
        let fault = Violation::new(Code::Wiring, format!("/network/junctions/{i}"), what);
        faults.push(
            fault.hint("open a branch, or attach a bladder, accumulator or pressure port: a junction stores nothing, so its pressure is undefined"),
        );
    }
}

/// Reports a name that is not that of a junction.
pub(super) fn undeclared(junctions: &[String], name: &str, pointer: &str, faults: &mut Violations) {
    let names: Vec<&str> = junctions.iter().map(String::as_str).collect();
    let what = format!("junction \"{name}\" is not declared");
    let fault = Violation::new(Code::Wiring, format!("{pointer}/junction"), what);
    faults.push(Violation {
        nearest: nearest(name, names.iter().copied()),
        allowed: (!names.is_empty()).then(|| listed(names)),
        ..fault.hint("declare it under /network/junctions")
    });
}

/// Checks that each elevation is that of another junction.
pub(super) fn elevations(network: &Network, faults: &mut Violations) {
    for (i, one) in network.elevations.iter().enumerate() {
        let pointer = format!("/network/elevations/{i}");
        if !network.junctions.contains(&one.junction) {
            undeclared(&network.junctions, &one.junction, &pointer, faults);
        }
        let same = |other: &Elevation| other.junction == one.junction;
        if let Some(first) = network.elevations[..i].iter().position(same) {
            let what = format!(
                "a second elevation of junction \"{}\", the first is /network/elevations/{first}",
                one.junction
            );
            faults.push(Violation::new(Code::Wiring, pointer, what));
        }
    }
}

fn instants(joined: &ConnectionTable, end: f64) -> Vec<f64> {
    let mut instants = vec![0.0];
    let openings = joined.branches.iter().filter_map(|(_, opening)| *opening);
    let moving: Vec<&Signal> = openings.filter(|o| !o.is_constant()).collect();
    if !moving.is_empty() && end > 0.0 {
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

/// Points joined by open branches to a bladder, an accumulator or a pressure port.
fn reached(joined: &ConnectionTable, t: f64) -> BTreeSet<WiringPoint> {
    let mut reached = &joined.held | &joined.stores;
    let ends = joined.branches.iter().flat_map(|(points, _)| points);
    reached.extend(ends.filter(|point| matches!(point, WiringPoint::Bladder(..))));
    let open: Vec<_> = joined
        .branches
        .iter()
        .filter(|(_, opening)| opening.is_none_or(|o| o.value(t) > CLOSED))
        .collect();
    loop {
        let before = reached.len();
        for (points, _) in &open {
            if points.iter().any(|point| reached.contains(point)) {
                reached.extend(points);
            }
        }
        if reached.len() == before {
            return reached;
        }
    }
}
