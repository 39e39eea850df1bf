//! Builds the graph from the resolved network of a case. A point with several attachments gets its own pressure; others
//! are a cell or a port.

use std::collections::BTreeMap;

use super::{
    AccumulatorElement, AccumulatorLaw, AlongBladder, Bridge, CheckValveLaw, Feed, LinearTurbine, Link, LinkKind,
    NetworkNode, PrescribedFlow, PressurePort, PumpLaw, ResolvedNetwork, TubeFlow, ValvePilot, bladder_permeability,
    components,
};
use crate::case::schema::{Bladders, Fluid, Rectifier, TurbineConductance};
use crate::case::wiring::{PermeabilitySource, PortQuantity, Wiring, WiringPoint, WiringTube};
use crate::functions::signals::Signal;
use crate::model::duct;
use crate::model::mapping::TABLE_TUBE_RATIO;

/// An attachment to a point.
enum Thing<'a> {
    Tube {
        to: WiringPoint,
        tube: &'a WiringTube<'a>,
        order: usize,
    },
    Turbine {
        to: WiringPoint,
        index: usize,
    },
    Pressure {
        port: usize,
    },
    Source {
        name: String,
        feed: Feed,
    },
    Accumulator {
        index: usize,
    },
}

/// Graph of a network with permeabilities scaled by `factor`, and with a gravity [m/s^2].
pub(super) fn graph(
    wiring: &Wiring,
    [factor, gravity]: [f64; 2],
    fluid: &Fluid,
    bladders: &Bladders,
) -> ResolvedNetwork {
    let viscosity = fluid.viscosity_pa_s;
    let permeability = bladder_permeability(bladders);
    let chain_tubes = wiring.chain_tubes.len();
    let mut network = ResolvedNetwork {
        bladder_mobility: permeability * factor / viscosity,
        along_bladders: AlongBladder::new(bladders, fluid).filter(|_| bladders.per_row > 0),
        chains: wiring.chains.clone(),
        tubes: chain_tubes + wiring.tubes.len(),
        ..ResolvedNetwork::default()
    };
    let tube = wiring.chain_tubes.first().map_or(0.0, |tube| tube.length_m);
    let length = bladders.length_m * 2.0 * bladders.per_row as f64 + TABLE_TUBE_RATIO * tube * chain_tubes as f64;
    for (k, (_, written)) in wiring.turbines.iter().enumerate() {
        network.turbines.push(LinearTurbine {
            name: written.name.clone().unwrap_or_else(|| format!("turbine-{}", k + 1)),
            conductance: match written.conductance {
                TurbineConductance::M3SPa(g) => g,
                TurbineConductance::Kappa {
                    kappa,
                    network_length_m,
                } => permeability * kappa / (viscosity * network_length_m.unwrap_or(length)),
            },
        });
    }
    let things = things(wiring, &mut network.ports);
    let nodes = nodes(wiring, &things, &mut network);
    // accumulators of the case in the order of their points
    let mut in_order = vec![];
    // R = μ l_c/q1c
    let resistance = |tube: &WiringTube| viscosity * tube.length_m / (self::permeability(tube.bore) * factor);
    // weight per volume of the fluid
    let weight = fluid.density_kg_m3 * gravity;
    let head = |from: WiringPoint, to: WiringPoint| weight * (wiring.elevation(from) - wiring.elevation(to));
    for (at, thing) in things {
        let from = nodes[&at];
        match thing {
            Thing::Tube { to, tube, order } => network.links.push(Link {
                order,
                from,
                to: nodes[&to],
                resistance: resistance(tube),
                opening: (!tube.opening.is_one()).then(|| tube.opening.clone()),
                pilot: tube.pilot.map(|(vessel, pilot)| ValvePilot {
                    vessel,
                    closed_at: pilot.closed_at_m3,
                    open_at: pilot.open_at_m3,
                }),
                kind: LinkKind::Tube,
                radius: radius(tube),
                tube: Some(TubeFlow::new(tube, radius(tube), fluid)),
                check_valve: tube.check_valve.map(CheckValveLaw::from),
                pump: tube.pump.map(PumpLaw::new),
                head: head(at, to),
            }),
            Thing::Turbine { to, index } => join(
                &mut network,
                [from, nodes[&to]],
                index,
                &wiring.turbines[index].1.rectifier,
                head(at, to),
            ),
            Thing::Pressure { port } => {
                if let NetworkNode::Cell { .. } = from {
                    network.links.push(opening(from, NetworkNode::Port(port)));
                }
            }
            Thing::Source { name, feed } => network.sources.push(PrescribedFlow { into: from, feed, name }),
            Thing::Accumulator { index } => {
                if let NetworkNode::Junction(junction) = from {
                    let written = wiring.accumulators[index].1;
                    in_order.push(index);
                    network.accumulators.push(AccumulatorElement {
                        name: written.name.clone().unwrap_or_else(|| wiring.label(at)),
                        junction,
                        start_pressure: written.start_pressure_pa,
                        law: AccumulatorLaw::new(written, fluid.ambient_pressure()),
                    });
                }
            }
        }
    }
    for pilot in network.links.iter_mut().filter_map(|link| link.pilot.as_mut()) {
        let place = in_order.iter().position(|&index| index == pilot.vessel);
        pilot.vessel = place.unwrap_or_default();
    }
    if bladders.per_row == 0 {
        // conductance of the widest link, over the placeholder's length
        let conductances = network.links.iter().map(|link| 1.0 / link.resistance);
        let turbines = network.turbines.iter().map(|turbine| turbine.conductance);
        network.bladder_mobility = conductances.chain(turbines).fold(0.0, f64::max);
    }
    let heads = network.links.iter().map(|link| link.head);
    let heads = heads.chain(network.bridges.iter().map(|bridge| bridge.head));
    if heads.into_iter().any(|head| head != 0.0) {
        network.gravity = Some(Signal::one());
    }
    components::find(&mut network, 2 * bladders.per_row);
    network
}

/// Permeability `q1c` [m^4].
fn permeability(bore: PermeabilitySource) -> f64 {
    match bore {
        PermeabilitySource::Permeability(permeability) => permeability,
        PermeabilitySource::CrossSection(section) => duct::permeability(section),
        PermeabilitySource::Radius(radius) => duct::circle(radius),
    }
}

/// Radius of a tube, or of the circular tube of equal permeability [m].
fn radius(tube: &WiringTube) -> f64 {
    tube.radius_m.unwrap_or_else(|| duct::radius(permeability(tube.bore)))
}

/// All attachments, sorted by point; adds prescribed pressures to the ports.
fn things<'a>(wiring: &'a Wiring<'a>, ports: &mut Vec<PressurePort>) -> Vec<(WiringPoint, Thing<'a>)> {
    let mut things = vec![];
    for (order, tube) in wiring.chain_tubes.iter().chain(&wiring.tubes).enumerate() {
        let [from, to] = tube.points;
        things.push((from, Thing::Tube { to, tube, order }));
    }
    for port in wiring.chain_ports.iter().chain(&wiring.ports) {
        let name = port.name.map_or_else(|| wiring.label(port.at), str::to_owned);
        let thing = match port.given {
            PortQuantity::Flow(flow) => Thing::Source {
                name,
                feed: Feed::Flow(flow.clone()),
            },
            PortQuantity::Volume(volume) => Thing::Source {
                name,
                feed: Feed::Volume(volume.clone()),
            },
            PortQuantity::Pressure(pressure) => {
                let pressure = pressure.clone();
                ports.push(PressurePort { pressure, name });
                Thing::Pressure { port: ports.len() - 1 }
            }
        };
        things.push((port.at, thing));
    }
    for (index, &([from, to], _)) in wiring.turbines.iter().enumerate() {
        things.push((from, Thing::Turbine { to, index }));
    }
    for (index, &(at, _)) in wiring.accumulators.iter().enumerate() {
        things.push((at, Thing::Accumulator { index }));
    }
    things.sort_by_key(|(at, _)| *at);
    things
}

/// Node of every point with attachments. A point with several attachments, or with a rectifier of check valves, becomes
/// a junction or a port into which a bladder opens.
fn nodes(
    wiring: &Wiring,
    things: &[(WiringPoint, Thing)],
    network: &mut ResolvedNetwork,
) -> BTreeMap<WiringPoint, NetworkNode> {
    let real = |index: usize| matches!(wiring.turbines[index].1.rectifier, Rectifier::CheckValves(_));
    let mut meeting: BTreeMap<WiringPoint, (usize, bool)> = BTreeMap::new();
    let mut held: BTreeMap<WiringPoint, usize> = BTreeMap::new();
    let mut count = |point: WiringPoint, needs_node: bool| {
        let entry = meeting.entry(point).or_default();
        entry.0 += 1;
        entry.1 |= needs_node;
    };
    for (at, thing) in things {
        let (to, needs_node) = match thing {
            Thing::Tube { to, .. } => (Some(*to), false),
            Thing::Turbine { to, index } => (Some(*to), real(*index)),
            Thing::Pressure { port } => {
                held.entry(*at).or_insert(*port);
                (None, false)
            }
            Thing::Source { .. } => (None, false),
            Thing::Accumulator { .. } => (None, true),
        };
        count(*at, needs_node);
        to.into_iter().for_each(|to| count(to, needs_node));
    }
    let node = |(point, (things, needs_node)): (WiringPoint, (usize, bool))| {
        if let (WiringPoint::Bladder(bladder, end), 1, false) = (point, things, needs_node) {
            return (point, NetworkNode::Cell { bladder, end });
        }
        let here = held.get(&point).map_or_else(
            || {
                network.junctions.push(wiring.label(point));
                NetworkNode::Junction(network.junctions.len() - 1)
            },
            |port| NetworkNode::Port(*port),
        );
        if let WiringPoint::Bladder(bladder, end) = point {
            network.links.push(opening(NetworkNode::Cell { bladder, end }, here));
        }
        (point, here)
    };
    meeting.into_iter().map(node).collect()
}

/// Link from a bladder's end to a junction or a port.
fn opening(cell: NetworkNode, here: NetworkNode) -> Link {
    Link {
        order: 0,
        from: cell,
        to: here,
        resistance: 0.0,
        opening: None,
        pilot: None,
        kind: LinkKind::Opening,
        radius: 0.0,
        tube: None,
        check_valve: None,
        pump: None,
        head: 0.0,
    }
}

/// Adds a turbine between two points, with a bridge of check valves if it has one.
fn join(network: &mut ResolvedNetwork, [from, to]: [NetworkNode; 2], index: usize, rectifier: &Rectifier, head: f64) {
    match rectifier {
        Rectifier::Ideal => network.links.push(Link {
            order: 0,
            from,
            to,
            resistance: 1.0 / network.turbines[index].conductance,
            opening: None,
            pilot: None,
            kind: LinkKind::Turbine(index),
            radius: 0.0,
            tube: None,
            check_valve: None,
            pump: None,
            head,
        }),
        Rectifier::CheckValves(valve) => network.bridges.push(Bridge {
            from,
            to,
            turbine: index,
            valve: valve.into(),
            head,
        }),
    }
}
