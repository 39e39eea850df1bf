//! Inputs of a beam over time, as columns beside the history.

use serde_json::{Value, json};

use super::{base64, scene};
use crate::case::{Case, ResolvedEnd, Rotation, Translation};
use crate::functions::Signal;
use crate::model::ResolvedNetwork;
use crate::model::network::Feed;

/// Largest number of signals.
const MOST: usize = 40;

/// A signal with its label and unit.
type Input<'a> = (String, &'static str, &'a Signal);

/// Columns of all inputs that vary in time, at the instants of a history. If `joined`, pairs of instants stand for stretches of time, and
/// the values are the extremes of the signal in each.
pub fn columns(case: &Case, times: &[f64], joined: bool) -> Vec<Value> {
    let network = ResolvedNetwork::from_case(case).ok().flatten();
    let ends = [("root", case.ends.root.resolve()), ("tip", case.ends.tip.resolve())];
    let mut all = loads(case);
    all.extend(ends.iter().flat_map(|(name, end)| of_end(name, end)));
    all.extend(network.iter().flat_map(of_network));
    // outputs of controllers are columns of the history
    let follows = |signal: &Signal| !signal.is_constant() && !signal.is_controlled();
    let changing = all.into_iter().filter(|(.., signal)| follows(signal)).take(MOST);
    let column = |(number, (label, unit, signal)): (usize, Input)| {
        json!({
            "name": format!("input_{}", number + 1), "unit": unit, "group": "What acts", "label": label,
            "about": "a signal of the case", "usual": true, "values": base64::numbers(values(signal, times, joined)),
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
        let (name, distributed) = load.distributed()?;
        let [_, what, unit] = scene::words_of(name);
        let label = format!("load {}: {what}", k + 1);
        Some((label, unit, &distributed.signal))
    });
    let attached = case.attachments.iter().enumerate().flat_map(|(k, one)| {
        let label = move |key: &str| format!("attachment {}: {}", k + 1, key.trim_end_matches("_n").replace('_', " "));
        one.forces().map(move |(key, signal)| (label(key), "N", signal))
    });
    let turns = case.rotating_frame.iter().map(|frame| &frame.angular_velocity_rad_s);
    let frame = turns.map(|signal| ("angular velocity of the frame".into(), "rad/s", signal));
    distributed.chain(attached).chain(frame).collect()
}

fn of_end<'a>(name: &str, end: &'a ResolvedEnd) -> Vec<Input<'a>> {
    let translation = |[axis, symbol]: [&str; 2], one: &'a Translation| match one {
        Translation::Displacement(signal) => (format!("{name}: {symbol}"), "m", signal),
        Translation::Force(signal) => (format!("{name}: force {axis}"), "N", signal),
    };
    let rotation = match &end.rotation {
        Rotation::Slope(signal) => (format!("{name}: slope"), "rad", signal),
        Rotation::Moment(signal) => (format!("{name}: moment"), "N m", signal),
    };
    let mut all = vec![
        translation(["x", "u₁"], &end.transverse),
        translation(["z", "u₃"], &end.axial),
        rotation,
    ];
    if let Some(follower) = &end.follower {
        all.push((format!("{name}: force along the end"), "N", &follower.normal));
        all.push((format!("{name}: force across the end"), "N", &follower.shear));
    }
    all
}

fn of_network(network: &ResolvedNetwork) -> Vec<Input<'_>> {
    let ports = network.ports.iter();
    let ports = ports.map(|port| (format!("pressure at {}", port.name), "Pa", &port.pressure));
    let sources = network.sources.iter().map(|source| {
        let (what, unit) = match source.feed {
            Feed::Flow(_) => ("flow into", "m^3/s"),
            Feed::Volume(_) => ("volume into", "m^3"),
        };
        (format!("{what} {}", source.name), unit, source.feed.signal())
    });
    let links = network.links.iter().enumerate().flat_map(|(k, link)| {
        let opening = link.opening.as_ref();
        let opening = opening.map(|signal| (format!("opening of link {}", k + 1), "1", signal));
        let pump = link.pump.as_ref().map(|pump| {
            let unit = if pump.curve.is_none() { "Pa" } else { "1" };
            (format!("pump of link {}", k + 1), unit, &pump.pressure)
        });
        opening.into_iter().chain(pump)
    });
    ports.chain(sources).chain(links).collect()
}
