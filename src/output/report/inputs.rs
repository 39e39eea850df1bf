//! Inputs of a beam over time, as columns beside the history.

use serde_json::{Value, json};

use super::base64;
use crate::case::schema::Load;
use crate::case::{Case, ResolvedEnd, Rotation, Translation};
use crate::functions::Signal;
use crate::model::ResolvedNetwork;
use crate::model::network::Feed;

/// Largest number of signals.
const MOST: usize = 40;

/// A signal with its name.
struct Input<'a> {
    label: String,
    unit: &'static str,
    signal: &'a Signal,
}

/// Columns of all inputs that vary in time, at the instants of a history. If `joined`, pairs of instants stand for stretches of time, and
/// the values are the extremes of the signal in each.
pub fn columns(case: &Case, times: &[f64], joined: bool) -> Vec<Value> {
    let network = ResolvedNetwork::from_case(case).ok().flatten();
    let ends = [("root", case.ends.root.resolve()), ("tip", case.ends.tip.resolve())];
    let mut all = loads(case);
    for (name, end) in &ends {
        of_end(name, end, &mut all);
    }
    if let Some(network) = &network {
        of_network(network, &mut all);
    }
    let changing = all.into_iter().filter(|one| !one.signal.is_constant()).take(MOST);
    let column = |(number, one): (usize, Input)| {
        json!({
            "name": format!("input_{}", number + 1), "unit": one.unit, "group": "What acts", "label": one.label,
            "about": "a signal of the case", "usual": true, "values": base64::numbers(values(one.signal, times, joined)),
        })
    };
    changing.enumerate().map(column).collect()
}

fn values(signal: &Signal, times: &[f64], joined: bool) -> Vec<f64> {
    let value = |t: f64| signal.value(t);
    if !joined {
        return times.iter().map(|&t| value(t)).collect();
    }
    let between = |k: usize| {
        let [from, to] = [k - k % 2, k - k % 2 + 1];
        match times.get(to) {
            Some(&end) if end > times[from] => {
                let range = signal.range(times[from], end);
                if k == from { range.low } else { range.high }
            }
            _ => value(times[k]),
        }
    };
    (0..times.len()).map(between).collect()
}

fn loads(case: &Case) -> Vec<Input<'_>> {
    let distributed = case.loads.iter().enumerate().filter_map(|(k, load)| {
        let (what, unit) = match load {
            Load::ForceXNM(_) => ("force across", "N/m"),
            Load::ForceZNM(_) => ("force along", "N/m"),
            Load::ForceNormalNM(_) => ("force normal to the beam", "N/m"),
            Load::ForceTangentialNM(_) => ("force tangential to the beam", "N/m"),
            Load::MomentXN(_) | Load::MomentZN(_) => ("couple", "N"),
            Load::BodyXMS2(_) => ("body force across", "m/s^2"),
            Load::BodyZMS2(_) => ("body force along", "m/s^2"),
            Load::RestCurvature(_) => ("curvature at rest", "1/m"),
            Load::Gravity { .. } => return None,
        };
        Some(Input {
            label: format!("load {}: {what}", k + 1),
            unit,
            signal: &load.distributed()?.1.signal,
        })
    });
    let attached = case.attachments.iter().enumerate().flat_map(|(k, one)| {
        one.forces().map(move |(key, signal)| Input {
            label: format!("attachment {}: {}", k + 1, key.trim_end_matches("_n").replace('_', " ")),
            unit: "N",
            signal,
        })
    });
    let frame = case.rotating_frame.iter().map(|frame| Input {
        label: "angular velocity of the frame".into(),
        unit: "rad/s",
        signal: &frame.angular_velocity_rad_s,
    });
    distributed.chain(attached).chain(frame).collect()
}

fn of_end<'a>(name: &str, end: &'a ResolvedEnd, all: &mut Vec<Input<'a>>) {
    let mut add = |what: &str, unit, signal| {
        all.push(Input {
            label: format!("{name}: {what}"),
            unit,
            signal,
        });
    };
    for (axis, symbol, one) in [("x", "u₁", &end.transverse), ("z", "u₃", &end.axial)] {
        match one {
            Translation::Displacement(signal) => add(symbol, "m", signal),
            Translation::Force(signal) => add(&format!("force {axis}"), "N", signal),
        }
    }
    match &end.rotation {
        Rotation::Slope(signal) => add("slope", "rad", signal),
        Rotation::Moment(signal) => add("moment", "N m", signal),
    }
    if let Some(follower) = &end.follower {
        add("force along the end", "N", &follower.normal);
        add("force across the end", "N", &follower.shear);
    }
}

fn of_network<'a>(network: &'a ResolvedNetwork, all: &mut Vec<Input<'a>>) {
    for port in &network.ports {
        all.push(Input {
            label: format!("pressure at {}", port.name),
            unit: "Pa",
            signal: &port.pressure,
        });
    }
    for source in &network.sources {
        let (what, unit) = match source.feed {
            Feed::Flow(_) => ("flow into", "m^3/s"),
            Feed::Volume(_) => ("volume into", "m^3"),
        };
        all.push(Input {
            label: format!("{what} {}", source.name),
            unit,
            signal: source.feed.signal(),
        });
    }
    for (k, link) in network.links.iter().enumerate() {
        if let Some(opening) = &link.opening {
            all.push(Input {
                label: format!("opening of link {}", k + 1),
                unit: "1",
                signal: opening,
            });
        }
        if let Some(pump) = &link.pump {
            all.push(Input {
                label: format!("pump of link {}", k + 1),
                unit: if pump.curve.is_none() { "Pa" } else { "1" },
                signal: &pump.pressure,
            });
        }
    }
}
