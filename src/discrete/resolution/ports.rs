//! Pressures and flows of ports that change faster than they get through a cell of the bladder behind them, and pressures that fall along
//! such a cell.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};
use std::f64::consts::{PI, TAU};

use super::LeftOut;
use crate::case::schema::{BladderEnd, Case, Effect};
use crate::case::wiring::bladder_index;
use crate::functions::signals::{Clock, Signal};
use crate::model::network::{Feed, LinkKind, Node, PressurePort, Source};
use crate::model::{Model, Storage, Wet, characteristic};

/// Part of the depth that a wave gets into a bladder which half a cell of that depth leaves out; measured with 1 to 32 cells.
const LEFT_OUT: f64 = 1.0 / 3.0;
/// A jump makes the beam ring along; the overshoot of the pressure has this multiple of the first frequency, measured.
const RUNG: f64 = 3.0;
/// A change is like a jump where it takes less than this angle of the first vibration along.
const SUDDEN: f64 = 1.5;
/// Length of a bladder over the depth of that ringing from which on the fluid damps it.
const DAMPED: f64 = 2.0;
/// What comes back to less than this part of its largest value is a pulse.
const BACK: f64 = 0.5;

/// What a port or a pump does to the bladders behind it.
pub struct Port {
    pointer: String,
    /// Length of a bladder over the depth that what goes to and fro gets into one; 0: nothing does.
    depths: f64,
    /// Of a flow through to another port, what its pressure falls by along the bladder behind this one, over the largest pressure.
    falls: f64,
    /// Of a pressure that changes and stays, half a bladder over the depth that the change gets into it by the end of the run.
    lag: f64,
}

impl Port {
    /// Where it stands in the case.
    pub fn pointer(&self) -> String {
        self.pointer.clone()
    }

    /// Share of the pressure behind the port that so many cells along a bladder leave out, and in words what that is. A flow through has
    /// its largest pressure in the middle of the first cell, half a cell from the port.
    pub(super) fn left_out(&self, cells: usize) -> LeftOut {
        let swings = (LEFT_OUT * self.depths / cells as f64).min(1.0);
        let flows = 0.5 * self.falls / cells as f64;
        let swings = swings.max((self.lag / cells as f64).min(1.0));
        match flows > swings {
            true => LeftOut {
                share: flows,
                what: "the largest pressure of a flow through, in the middle of the first cell,",
                at_rest: true,
            },
            false => LeftOut {
                share: swings,
                what: "pressure along the bladder behind it",
                at_rest: false,
            },
        }
    }
}

/// Of every port and of every pump at a bladder, what its pressure or flow does. Where that goes to and fro, the depth in a bladder is
///
/// ```text
/// a_p dp/dt = (q1b/μ) d²p/ds²     δ = (q1b/(μ a_p ω))^(1/2),   ω of its highest tone, its shortest time, or of
///                                                            the beam that a jump makes ring
/// ```
///
/// Where it differs from another port's, a bladder's pressure falls by `|p - p'| r/R`, r the resistance of a bladder, R that of the easiest
/// way to the other one.
pub fn ports(case: &Case, model: &Model, wet: &Wet) -> Vec<Port> {
    let end = case.time.end_s;
    let network = &wet.network;
    let ringing = model.effects.has(Effect::SolidInertia);
    let ringing = ringing.then(|| characteristic::first_axial_frequency(model));
    let in_depths = |omega: f64| wet.bladder_length * (wet.compliance() * omega / network.bladder_mobility).sqrt();
    let depths = |signal: &Signal, begins: bool| {
        let sudden = |first: &f64| {
            let time = signal.shortest_time_s(end).filter(|time| time * first < SUDDEN);
            begins || time.is_some() || signal.first_jump(end).is_some()
        };
        let rung = ringing.filter(sudden).map(|first| RUNG * first);
        // fluid that gets in no further than that does not make the beam ring
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
        .map(|(k, (((name, signal), falls), lag))| Port {
            pointer: format!("the port \"{name}\""),
            depths: depths(signal, k < network.ports.len() && begins_with_jump(case, signal)),
            falls,
            lag,
        });
    let tubes = case.network.iter().flat_map(|network| network.tubes.iter().enumerate());
    let at_bladders = tubes.filter(|(_, tube)| tube.from.bladder.or(tube.to.bladder).is_some());
    let pumps = at_bladders.filter_map(|(k, tube)| {
        Some(Port {
            pointer: format!("/network/tubes/{k}/pump"),
            depths: depths(&tube.pump.as_ref()?.pressure_pa, false),
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
                .any(|node| matches!(node, Node::Cell { .. }));
        }
    }
    let turbines = network
        .turbines
        .iter()
        .zip(turbine_at_bladder)
        .filter(|(_, at_bladder)| *at_bladder);
    let turbines = turbines.map(|(turbine, _)| Port {
        pointer: format!("the turbine \"{}\"", turbine.name),
        // little of a pressure falls in a bladder before a turbine of much more resistance; a half is measured
        depths: 0.5 * tone * bladder / (bladder + 1.0 / turbine.conductance),
        falls: 0.0,
        lag: 0.0,
    });
    ports.chain(pumps).chain(turbines).collect()
}

/// True if a port has another pressure at the start than the fluid behind it.
fn begins_with_jump(case: &Case, signal: &Signal) -> bool {
    let within = 0.5 * signal.smooth_intervals(case.time.end_s)[0].1;
    let first = signal.jet(Clock { t: 0.0, within }).value;
    case.start.pressures.is_empty() && first != case.held_at_start(signal)
}

/// Of every port of pressure at a bladder, half the bladder's length over the depth to which its change has come by the end of the run:
///
/// ```text
/// p(x, t)/p_port = erfc(x/(4 D t)^(1/2)) = 1 - x/(π D t)^(1/2) + ...       D = q1b/(μ a_p)
/// ```
///
/// with t since nine tenths of the change were reached, a quarter of the time before at least.
fn lags(case: &Case, wet: &Wet) -> Vec<f64> {
    const SAMPLES: usize = 200;
    const REACHED: f64 = 0.9;
    let (end, network) = (case.time.end_s, &wet.network);
    let diffusivity = network.bladder_mobility / wet.compliance();
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

/// Of every port of pressure, the end of a bladder that it is at, with nothing in between.
fn at_open_ends(wet: &Wet) -> Vec<Option<(usize, BladderEnd)>> {
    let network = &wet.network;
    let mut open = vec![None; network.ports.len()];
    for link in network.links.iter().filter(|link| link.kind == LinkKind::Opening) {
        match (link.from, link.to) {
            (Node::Port(k), Node::Cell { bladder, end }) | (Node::Cell { bladder, end }, Node::Port(k)) => {
                open[k] = Some((bladder, end));
            }
            _ => {}
        }
    }
    open
}

/// A port whose pressure jumps at the open end of a bladder. After a jump by Δp the flow is, as long as the pressure has not come through,
///
/// ```text
/// q(t) = Δp (q1b/μ)/(π D t)^(1/2)       D = q1b/(μ a_p)
/// ```
///
/// so that there is no largest flow. On a mesh it is `2 Δp q1b/(μ Δs)`.
pub struct JumpIntoBladder {
    /// Number of the port among those of pressure.
    pub port: usize,
    /// Its name.
    pub name: String,
    /// Times of the first and the last jump [s].
    pub times: [f64; 2],
}

impl JumpIntoBladder {
    /// Of a port at an end of a bladder; none where pressure does not diffuse along the bladder, or does not jump.
    fn new(case: &Case, wet: &Wet, port: usize, (bladder, end): (usize, BladderEnd)) -> Option<Self> {
        let PressurePort { name, pressure, .. } = &wet.network.ports[port];
        let begins = match case.start.pressures.is_empty() {
            true => begins_with_jump(case, pressure),
            false => pressure.value(0.0) != given_at_start(case, wet, bladder, end),
        };
        let later = pressure.each_jump(case.time.end_s).map(|[t, ..]| t);
        let times: Vec<f64> = begins.then_some(0.0).into_iter().chain(later).collect();
        let times = [*times.first()?, *times.last()?];
        let name = name.clone();
        (wet.storage[bladder] == Storage::Flowing).then_some(Self { port, name, times })
    }
}

/// Every port whose pressure jumps at the open end of a bladder along which pressure diffuses.
pub fn jumps_into_bladders(case: &Case, wet: &Wet) -> Vec<JumpIntoBladder> {
    let open = at_open_ends(wet).into_iter().enumerate();
    open.filter_map(|(port, open)| JumpIntoBladder::new(case, wet, port, open?))
        .collect()
}

/// Pressure that the case gives at the start at an end of a bladder [Pa].
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

/// Of every port, those of pressure first, the largest fall along the bladder behind it, over the largest pressure: from a port of
/// pressure `|p - p'| r/R`; from one of flow that goes out at a port of pressure `q r/(q R + p')`, and `2 r/R` where it is taken out as
/// a flow, as half of what falls between the two is above the mean at least.
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
            // a flow has its largest pressure where it comes from
            .filter(|(other, _)| size(&other.pressure) <= size(&port.pressure))
            .map(|(other, way)| difference(&port.pressure, &other.pressure) / largest * bladder / way)
            .fold(0.0, f64::max)
    };
    let ports = network.ports.len();
    let of_flow = |(k, source): (usize, &Source)| {
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

/// Whether one flow comes in while the other may go out; of volumes, of whose rates there are no bounds, always.
fn against(a: &Feed, b: &Feed, end: f64) -> bool {
    let (Feed::Flow(a), Feed::Flow(b)) = (a, b) else {
        return true;
    };
    let (a, b) = (a.range(0.0, end), b.range(0.0, end));
    (a.high > 0.0 && b.low < 0.0) || (a.low < 0.0 && b.high > 0.0)
}

/// Of every port, those of pressure first, the ports to which a way leads through a bladder, with the resistance of the easiest.
fn ways(wet: &Wet, bladder: f64) -> Vec<Vec<(usize, f64)>> {
    let network = &wet.network;
    let (ports, bladders) = (network.ports.len(), network.component_of_bladder.len());
    let place = |node: Node| match node {
        Node::Port(port) => port,
        Node::Cell { bladder, end } => ports + 2 * bladder + usize::from(end == BladderEnd::Outlet),
        Node::Junction(junction) => ports + 2 * bladders + junction,
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
    // what it reaches is often little of a large network
    let from = |start: usize| {
        let mut far = HashMap::from([(start, 0.0_f64)]);
        // the nearest place first (Dijkstra); what is not negative is in order of its bits
        let mut next = BinaryHeap::from([Reverse((0, start))]);
        while let Some(Reverse((bits, a))) = next.pop() {
            // a way does not lead through another port, whose pressure is given
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

/// Angular frequency of what goes to and fro [1/s], of a pulse one over its time; none of what comes and stays.
fn fastest(signal: &Signal, end: f64) -> Option<f64> {
    let tone = signal.highest_tone_hz().map(|f| TAU * f);
    let back = signal.value(end).abs() < BACK * signal.largest(end).value;
    let pulse = signal.shortest_time_s(end).filter(|_| back).map(f64::recip);
    tone.into_iter().chain(pulse).reduce(f64::max)
}
