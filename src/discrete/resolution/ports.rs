//! Resolution of port pressures and flows: changes faster than diffusion through a cell of the adjacent bladder, and pressure drops along
//! such a cell.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};
use std::f64::consts::{PI, TAU};

use super::LeftOut;
use crate::case::schema::{BladderEnd, Case, Effect};
use crate::case::wiring::bladder_index;
use crate::functions::signals::{Signal, SmoothTime};
use crate::model::network::{Feed, LinkKind, NetworkNode, PrescribedFlow, PressurePort};
use crate::model::{Model, Storage, Wet, characteristic};

/// Mesh error relative to the penetration depth of a wave in a bladder, for half a cell of that depth; measured with 1 to 32 cells.
const LEFT_OUT: f64 = 1.0 / 3.0;
/// Frequency of the pressure overshoot after a jump, which excites axial vibrations of the beam, relative to the first
/// axial frequency; measured.
const RUNG: f64 = 3.0;
/// Phase angle of the first axial vibration below which a change acts like a jump.
const SUDDEN: f64 = 1.5;
/// Ratio of bladder length to penetration depth of that vibration above which the fluid damps it.
const DAMPED: f64 = 2.0;
/// A signal that returns below this fraction of its largest value is a pulse.
const BACK: f64 = 0.5;

/// Effect of a port or a pump on the adjacent bladders.
pub struct PortEffect {
    pointer: String,
    /// Ratio of bladder length to the penetration depth of an oscillating signal; 0 without oscillation.
    depths: f64,
    /// Pressure drop along the adjacent bladder by a flow to another port, relative to the largest pressure.
    falls: f64,
    /// For a pressure that changes and stays: half the bladder length over the penetration depth of the change at the end of the run.
    lag: f64,
}

impl PortEffect {
    /// JSON pointer in the case.
    pub fn pointer(&self) -> String {
        self.pointer.clone()
    }

    /// Relative error of the pressure behind the port for a number of cells along a bladder, and its description. For a flow to another
    /// port, the largest pressure on the mesh is that in the middle of the first cell, half a cell from the port.
    pub(super) fn left_out(&self, cells: usize) -> LeftOut {
        let swings = (LEFT_OUT * self.depths / cells as f64).min(1.0);
        let flows = 0.5 * self.falls / cells as f64;
        let swings = swings.max((self.lag / cells as f64).min(1.0));
        match flows > swings {
            true => LeftOut {
                share: flows,
                what: "the largest pressure by its flow (middle of the first cell)",
                at_rest: true,
            },
            false => LeftOut {
                share: swings,
                what: "the pressure along the bladder behind it",
                at_rest: false,
            },
        }
    }
}

/// Effects of all ports, and of pumps and turbines at bladders. The penetration depth of an oscillation in a bladder is
///
/// ```text
/// a_p dp/dt = (q1b/μ) d²p/ds²     δ = (q1b/(μ a_p ω))^(1/2),   ω of its highest tone, its shortest time, or of
///                                                            the beam that a jump makes ring
/// ```
///
/// If the pressure differs from that of another port, it drops by `|p - p'| r/R` along a bladder. r is the resistance of a bladder, R
/// that of the easiest path to the other port.
pub fn ports(case: &Case, model: &Model, wet: &Wet) -> Vec<PortEffect> {
    let end = case.time.end_s;
    let network = &wet.network;
    let ringing = model.effects.has(Effect::SolidInertia);
    let ringing = ringing.then(|| characteristic::first_axial_frequency(model));
    let in_depths = |omega: f64| {
        wet.bladder_length * (wet.slowest_diffusion() * wet.compliance() * omega / network.bladder_mobility).sqrt()
    };
    let depths = |signal: &Signal, begins: bool| {
        let sudden = |first: &f64| {
            let time = signal.shortest_time_s(end).filter(|time| time * first < SUDDEN);
            begins || time.is_some() || signal.jumps_at_samples() || signal.first_jump(end).is_some()
        };
        let rung = ringing.filter(sudden).map(|first| RUNG * first);
        // fluid motion that does not penetrate further does not excite the beam
        let rung = rung.filter(|omega| in_depths(*omega) < DAMPED);
        let tones = fastest(signal, end).into_iter().chain(rung);
        tones.reduce(f64::max).map_or(0.0, in_depths)
    };
    let falls = falls(end, wet);
    let pressures = network.ports.iter().map(|port| (&port.name, &port.pressure));
    let flows = network
        .sources
        .iter()
        .map(|source| (&source.name, source.feed.signal()));
    let ports = pressures.chain(flows).zip(falls);
    let lags = lags(case, wet).into_iter().chain(std::iter::repeat(0.0));
    let ports = ports
        .zip(lags)
        .enumerate()
        .map(|(k, (((name, signal), falls), lag))| PortEffect {
            pointer: format!("the port \"{name}\""),
            depths: depths(signal, k < network.ports.len() && begins_with_jump(case, signal)),
            falls,
            lag,
        });
    let tubes = case.network.iter().flat_map(|network| network.tubes.iter().enumerate());
    let at_bladders = tubes.filter(|(_, tube)| tube.from.bladder.or(tube.to.bladder).is_some());
    let pumps = at_bladders.filter_map(|(k, tube)| {
        Some(PortEffect {
            pointer: format!("/network/tubes/{k}/pump"),
            depths: depths(tube.pump.as_ref()?.signal()?.1, false),
            falls: 0.0,
            lag: 0.0,
        })
    });
    let tone = characteristic::forcing_frequency(case).map_or(0.0, |f| in_depths(TAU * f));
    let bladder = wet.bladder_length / network.bladder_mobility;
    let mut turbine_at_bladder = vec![false; network.turbines.len()];
    for link in &network.links {
        if let LinkKind::Turbine(k) = link.kind {
            turbine_at_bladder[k] |= [link.from, link.to]
                .iter()
                .any(|node| matches!(node, NetworkNode::Cell { .. }));
        }
    }
    let turbines = network
        .turbines
        .iter()
        .zip(turbine_at_bladder)
        .filter(|(_, at_bladder)| *at_bladder);
    let turbines = turbines.map(|(turbine, _)| PortEffect {
        pointer: format!("the turbine \"{}\"", turbine.name),
        // only a small part of the pressure drop is in a bladder before a turbine of much higher resistance; the factor
        // 0.5 is measured
        depths: 0.5 * tone * bladder / (bladder + 1.0 / turbine.conductance),
        falls: 0.0,
        lag: 0.0,
    });
    ports.chain(pumps).chain(turbines).collect()
}

/// True if the pressure of a port at the start differs from that of the fluid behind it.
fn begins_with_jump(case: &Case, signal: &Signal) -> bool {
    let within = 0.5 * signal.smooth_intervals(case.time.end_s)[0].1;
    let first = signal.jet(SmoothTime { t: 0.0, within }).value;
    case.start.pressures.is_empty() && first != case.held_at_start(signal)
}

/// For each pressure port at a bladder: half the bladder's length over the penetration depth of its pressure change at the end of the
/// run:
///
/// ```text
/// p(x, t)/p_port = erfc(x/(4 D t)^(1/2)) = 1 - x/(π D t)^(1/2) + ...       D = q1b/(μ a_p)
/// ```
///
/// where t is the time since nine tenths of the change were reached, at least a quarter of the time before.
fn lags(case: &Case, wet: &Wet) -> Vec<f64> {
    const SAMPLES: usize = 200;
    const REACHED: f64 = 0.9;
    let (end, network) = (case.time.end_s, &wet.network);
    let diffusivity = network.bladder_mobility / (wet.slowest_diffusion() * wet.compliance());
    let open = at_open_ends(wet);
    let lag = |(port, open): (&PressurePort, Option<(usize, BladderEnd)>)| {
        if open.is_none() {
            return 0.0;
        }
        let signal = &port.pressure;
        let start = match case.start.pressures.is_empty() {
            true => case.held_at_start(signal),
            false => signal.value(0.0),
        };
        let change = (signal.value(end) - start).abs();
        let largest = signal.largest(end).value;
        if change <= BACK * largest || change == 0.0 {
            return 0.0;
        }
        let times = (0..=SAMPLES).map(|i| end * i as f64 / SAMPLES as f64);
        let mut late = times.skip_while(|t| (signal.value(*t) - start).abs() < REACHED * change);
        let reached = late.next().unwrap_or(end);
        let time = (end - reached).max(0.25 * reached);
        0.5 * wet.bladder_length / (PI * diffusivity * time).sqrt()
    };
    network.ports.iter().zip(open).map(lag).collect()
}

/// For each pressure port: the bladder end to which it is directly connected, if any.
fn at_open_ends(wet: &Wet) -> Vec<Option<(usize, BladderEnd)>> {
    let network = &wet.network;
    let mut open = vec![None; network.ports.len()];
    for link in network.links.iter().filter(|link| link.kind == LinkKind::Opening) {
        match (link.from, link.to) {
            (NetworkNode::Port(k), NetworkNode::Cell { bladder, end })
            | (NetworkNode::Cell { bladder, end }, NetworkNode::Port(k)) => {
                open[k] = Some((bladder, end));
            }
            _ => {}
        }
    }
    open
}

/// A port whose pressure jumps at the open end of a bladder. After a jump by Δp, until the pressure has penetrated the bladder, the flow
/// is
///
/// ```text
/// q(t) = Δp (q1b/μ)/(π D t)^(1/2)       D = q1b/(μ a_p)
/// ```
///
/// and therefore unbounded. On a mesh its largest value is `2 Δp q1b/(μ Δs)`.
pub struct JumpIntoBladder {
    /// Number of the port among the pressure ports.
    pub port: usize,
    /// Name of the port.
    pub name: String,
    /// Times of the first and the last jump [s].
    pub times: [f64; 2],
}

impl JumpIntoBladder {
    /// Jump of a port at a bladder end; none if pressure does not diffuse along the bladder, or does not jump.
    fn new(case: &Case, wet: &Wet, port: usize, (bladder, end): (usize, BladderEnd)) -> Option<Self> {
        let PressurePort { name, pressure, .. } = &wet.network.ports[port];
        let begins = match case.start.pressures.is_empty() {
            true => begins_with_jump(case, pressure),
            false => pressure.value(0.0) != given_at_start(case, wet, bladder, end),
        };
        let end = case.time.end_s;
        let later = pressure.each_jump(end).map(|[t, ..]| t);
        let mut times: Vec<f64> = begins.then_some(0.0).into_iter().chain(later).collect();
        if pressure.jumps_at_samples() {
            times = vec![0.0, end];
        }
        let times = [*times.first()?, *times.last()?];
        let name = name.clone();
        (wet.storage[bladder] == Storage::Flowing).then_some(Self { port, name, times })
    }
}

/// All ports whose pressure jumps at the open end of a bladder in which pressure diffuses.
pub fn jumps_into_bladders(case: &Case, wet: &Wet) -> Vec<JumpIntoBladder> {
    let open = at_open_ends(wet).into_iter().enumerate();
    open.filter_map(|(port, open)| JumpIntoBladder::new(case, wet, port, open?))
        .collect()
}

/// Pressure given by the case at a bladder end at the start [Pa].
fn given_at_start(case: &Case, wet: &Wet, bladder: usize, end: BladderEnd) -> f64 {
    let own = |label: &i64| bladder_index(*label, wet.per_row) == Some(bladder);
    let given = case
        .start
        .pressures
        .iter()
        .rev()
        .find(|one| one.bladders.iter().any(own));
    let place = if end == BladderEnd::Inlet { 0.0 } else { 1.0 };
    given.map_or(0.0, |one| one.pressure_pa.value(place))
}

/// Largest pressure drop along the adjacent bladder for each port (pressure ports first), relative to the largest pressure. For a
/// pressure port it is `|p - p'| r/R`. For a flow to a pressure port it is `q r/(q R + p')`. For a flow to another flow port it is
/// `2 r/R`, because at least half of the drop between both is above the mean.
fn falls(end: f64, wet: &Wet) -> Vec<f64> {
    let network = &wet.network;
    let bladder = wet.bladder_length / network.bladder_mobility;
    let ways = ways(wet, bladder);
    let size = |signal: &Signal| signal.largest(end).value;
    let largest = network.ports.iter().map(|port| size(&port.pressure));
    let largest = largest.fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let difference = |a: &Signal, b: &Signal| {
        let less = Signal::Product(vec![Signal::Constant(-1.0), b.clone()]);
        Signal::Sum(vec![a.clone(), less]).largest(end).value
    };
    let of_pressure = |(k, port): (usize, &PressurePort)| {
        let others = ways[k].iter().filter(|(j, _)| *j != k);
        others
            .filter_map(|&(j, way)| Some((network.ports.get(j)?, way)))
            .filter(|(other, _)| other.pressure != port.pressure)
            // the largest pressure of a flow is at its source
            .filter(|(other, _)| size(&other.pressure) <= size(&port.pressure))
            .map(|(other, way)| difference(&port.pressure, &other.pressure) / largest * bladder / way)
            .fold(0.0, f64::max)
    };
    let ports = network.ports.len();
    let of_flow = |(k, source): (usize, &PrescribedFlow)| {
        let (ways, flow) = (&ways[ports + k], source.feed.largest_flow(end));
        let fall = |&(j, way): &(usize, f64)| match network.ports.get(j) {
            Some(port) if flow > 0.0 => flow * bladder / (flow * way + size(&port.pressure)),
            None if against(&source.feed, &network.sources[j - ports].feed, end) => 2.0 * bladder / way,
            _ => 0.0,
        };
        ways.iter().map(fall).fold(0.0, f64::max)
    };
    let pressures = network.ports.iter().enumerate().map(of_pressure);
    let flows = network.sources.iter().enumerate().map(of_flow);
    pressures.chain(flows).collect()
}

/// True if one flow may enter while the other one leaves; always true for volumes, whose rates are unbounded.
fn against(a: &Feed, b: &Feed, end: f64) -> bool {
    let (Feed::Flow(a), Feed::Flow(b)) = (a, b) else {
        return true;
    };
    let (a, b) = (a.range(0.0, end), b.range(0.0, end));
    (a.high > 0.0 && b.low < 0.0) || (a.low < 0.0 && b.high > 0.0)
}

/// For each port (pressure ports first): the ports connected to it via a bladder, with the resistance of the easiest path.
fn ways(wet: &Wet, bladder: f64) -> Vec<Vec<(usize, f64)>> {
    let network = &wet.network;
    let (ports, bladders) = (network.ports.len(), network.component_of_bladder.len());
    let place = |node: NetworkNode| match node {
        NetworkNode::Port(port) => port,
        NetworkNode::Cell { bladder, end } => ports + 2 * bladder + usize::from(end == BladderEnd::Outlet),
        NetworkNode::Junction(junction) => ports + 2 * bladders + junction,
    };
    let size = ports + 2 * bladders + network.junctions.len();
    let within = (0..bladders).map(|b| (ports + 2 * b, ports + 2 * b + 1, bladder));
    let links = network.links.iter().filter(|link| !link.is_shut());
    let links = links.map(|link| (place(link.from), place(link.to), link.resistance));
    let turbines = network.bridges.iter().map(|bridge| {
        let conductance = network.turbines[bridge.turbine].conductance;
        (place(bridge.from), place(bridge.to), 1.0 / conductance)
    });
    let mut beside = vec![vec![]; size];
    for (a, b, resistance) in within.chain(links).chain(turbines) {
        beside[a].push((b, resistance));
        beside[b].push((a, resistance));
    }
    let ends: Vec<usize> = (0..ports)
        .chain(network.sources.iter().map(|source| place(source.into)))
        .collect();
    let mut ends_at = HashMap::<usize, Vec<usize>>::new();
    for (number, &place) in ends.iter().enumerate() {
        ends_at.entry(place).or_default().push(number);
    }
    // often only a small part of a large network is reachable
    let from = |start: usize| {
        let mut far = HashMap::from([(start, 0.0_f64)]);
        // the nearest place first (Dijkstra); the bits of nonnegative numbers have the same order as the numbers
        let mut next = BinaryHeap::from([Reverse((0, start))]);
        while let Some(Reverse((bits, a))) = next.pop() {
            // a path does not lead through another port, whose pressure is given
            let here = f64::from_bits(bits);
            if here > far[&a] || (a < ports && a != start) {
                continue;
            }
            for &(b, resistance) in &beside[a] {
                let way = here + resistance;
                let known = far.entry(b).or_insert(f64::INFINITY);
                if way < *known {
                    *known = way;
                    next.push(Reverse((way.to_bits(), b)));
                }
            }
        }
        far
    };
    ends.iter()
        .map(|&start| {
            let far = from(start).into_iter().filter(|(_, way)| *way >= bladder);
            let reached = far.filter_map(|(place, way)| Some((ends_at.get(&place)?, way)));
            let mut reached: Vec<_> = reached
                .flat_map(|(ends, way)| ends.iter().map(move |&j| (j, way)))
                .collect();
            reached.sort_by_key(|(j, _)| *j);
            reached
        })
        .collect()
}

/// Angular frequency of an oscillating signal [1/s]; for a pulse the inverse of its duration; none for a change that
/// stays.
fn fastest(signal: &Signal, end: f64) -> Option<f64> {
    let tone = signal.highest_tone_hz().map(|f| TAU * f);
    let back = signal.value(end).abs() < BACK * signal.largest(end).value;
    let pulse = signal.shortest_time_s(end).filter(|_| back).map(f64::recip);
    tone.into_iter().chain(pulse).reduce(f64::max)
}
