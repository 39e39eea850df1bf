//! Quantities of each port, accumulator, contact and reaction, and, for states at rest, of each bladder.

use super::evaluate::StateView;
use super::probes::{self, HistoryColumn, key};
use super::{Group, Observable, reactions};
use crate::case::wiring::BladderLabels;
use crate::discrete::ledger::ports;
use crate::discrete::{FluidMesh, System, beam_contacts, contact_points};
use crate::model::ControlledInput;
use crate::model::network::LinkKind;

/// Columns of all ports, accumulators, contacts and reactions of a system; with `at_rest` those of a state at rest.
pub fn columns(system: &System, at_rest: bool) -> Vec<HistoryColumn> {
    let mut all = of_state(system, at_rest);
    if !at_rest {
        all.extend(of_controllers(system));
    }
    all
}

/// The columns without those of controllers.
fn of_state(system: &System, at_rest: bool) -> Vec<HistoryColumn> {
    let mut all = of_network(system, at_rest);
    all.extend(reactions::columns(system, at_rest));
    let contacts = &system.model.contacts;
    let names = short("contact", contacts.iter().map(|one| &one.name));
    for (law, (name, short)) in contacts.iter().zip(names) {
        let kind = law.kind();
        let column = |what: &str, unit, about: &str| HistoryColumn {
            name: format!("{short}_{what}"),
            unit,
            about: format!("{about} the {kind} \"{name}\""),
        };
        all.push(column("normal_force", "N", "force on the beam out of"));
        if !at_rest {
            all.push(column("friction_force", "N", "force on the beam along the face of"));
        }
        all.push(column(
            "depth",
            "m",
            "largest depth, below 0 least distance, behind the face of",
        ));
        if law.bend_radius().is_some() {
            all.push(column("force_x", "N", "resultant force across on the beam by"));
            all.push(column(
                "force_z",
                "N",
                "resultant force along the straight beam on the beam by",
            ));
        }
    }
    let between = short("beam_contact", system.model.beam_contacts.iter().map(|one| &one.name));
    for (name, short) in between {
        all.push(HistoryColumn {
            name: format!("{short}_normal_force"),
            unit: "N",
            about: format!("force between the beams of the contact \"{name}\""),
        });
        all.push(HistoryColumn {
            name: format!("{short}_depth"),
            unit: "m",
            about: format!("largest depth, below 0 least distance, of the surfaces of the contact \"{name}\""),
        });
    }
    all
}

/// Output and setpoint of every controller.
fn of_controllers(system: &System) -> Vec<HistoryColumn> {
    let controllers = &system.model.controllers;
    let outputs: Vec<HistoryColumn> = short("controller", controllers.iter().map(|one| &one.controller.name))
        .into_iter()
        .zip(controllers)
        .map(|((name, short), one)| HistoryColumn {
            name: format!("{short}_output"),
            unit: one.unit,
            about: format!("output of the controller \"{name}\""),
        })
        .collect();
    let others = if controllers.is_empty() {
        vec![]
    } else {
        of_state(system, false)
    };
    let own = Observable::recorded(system).into_iter().map(HistoryColumn::from);
    let measurable: Vec<HistoryColumn> = own
        .chain(others)
        .chain(outputs.iter().cloned())
        .chain(probes::columns(system))
        .collect();
    let mut all = vec![];
    for (output, ControlledInput { controller, .. }) in outputs.into_iter().zip(controllers) {
        let measured = measurable.iter().find(|one| one.is_named(&controller.measures));
        let setpoint = HistoryColumn {
            name: format!("{}_setpoint", output.name.trim_end_matches("_output")),
            unit: measured.map_or("1", |one| one.unit),
            about: format!("setpoint of the controller \"{}\"", controller.name),
        };
        all.extend([output, setpoint]);
    }
    all
}

/// Columns that a controller may measure, with their indices among all columns of the history: not its time, the residual of its balance, and
/// setpoints.
pub fn measurable(system: &System) -> Vec<(usize, HistoryColumn)> {
    let own = Observable::recorded(system);
    let of_run = own.iter().map(|one| matches!(one.group(), Group::Time | Group::Open));
    let stations = columns(system, false);
    let inputs = 2 * system.model.controllers.len();
    let first = stations.len() - inputs;
    let left_out: Vec<bool> = of_run
        .chain((0..stations.len()).map(|k| k >= first && (k - first) % 2 == 1))
        .collect();
    let own = own.iter().map(|one| HistoryColumn::from(*one));
    let all = own.chain(stations).chain(probes::columns(system)).enumerate();
    all.filter(|(k, _)| !left_out.get(*k).copied().unwrap_or(false))
        .collect()
}

fn of_network(system: &System, at_rest: bool) -> Vec<HistoryColumn> {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return vec![];
    };
    let network = &wet.network;
    let names = network.ports.iter().map(|port| &port.name);
    let names = names.chain(network.sources.iter().map(|source| &source.name));
    let kept = fluid
        .accumulators
        .iter()
        .filter_map(|one| Some(&network.accumulators[one.number?].name));
    let mut all = vec![];
    for (name, short) in short("port", names) {
        let column = |what: &str, unit, about: &str| HistoryColumn {
            name: format!("{short}_{what}"),
            unit,
            about: format!("{about} the port \"{name}\""),
        };
        all.push(column("pressure", "Pa", "pressure at"));
        if !at_rest {
            all.push(column("flow", "m^3/s", "flow in through"));
            all.push(column("power", "W", "power supplied through"));
            all.push(column("volume", "m^3", "volume injected since the start through"));
        }
    }
    for (name, short) in short("accumulator", kept) {
        let column = |what: &str, unit, about: &str| HistoryColumn {
            name: format!("{short}_{what}"),
            unit,
            about: format!("{about} the accumulator \"{name}\""),
        };
        all.push(column("pressure", "Pa", "pressure in"));
        all.push(column(
            "volume",
            "m^3",
            "volume held beyond that at ambient pressure by",
        ));
    }
    if network.is_dry() {
        let names = plain_junctions(fluid).map(|k| &network.junctions[fluid.junctions[k]]);
        all.extend(short("junction", names).into_iter().map(|(name, short)| HistoryColumn {
            name: format!("{short}_pressure"),
            unit: "Pa",
            about: format!("pressure of the junction \"{name}\""),
        }));
        let tubes = tubes(fluid).filter(|_| !at_rest);
        all.extend(tubes.map(|(_, number)| HistoryColumn {
            name: format!("tube_{}_flow", network.links[number].order + 1),
            unit: "m^3/s",
            about: format!("flow through tube {} in its direction", network.links[number].order + 1),
        }));
    }
    if at_rest {
        all.extend(bladders(&wet.labels));
    }
    all
}

/// Junctions of the mesh without accumulator.
fn plain_junctions(fluid: &FluidMesh) -> impl Iterator<Item = usize> + '_ {
    let stores = |k: &usize| {
        fluid
            .accumulators
            .iter()
            .any(|one| one.junction == *k && one.number.is_some())
    };
    (0..fluid.junctions.len()).filter(move |k| !stores(k))
}

/// Links of the mesh that are tubes, each with its number in the network.
fn tubes(fluid: &FluidMesh) -> impl Iterator<Item = (usize, usize)> + '_ {
    let all = fluid
        .links
        .iter()
        .enumerate()
        .filter(|(_, link)| link.kind == Some(LinkKind::Tube));
    all.filter_map(|(k, link)| Some((k, link.number?)))
}

/// Mean pressure of every bladder; only for states at rest, because runs record pressures as fields.
fn bladders(labels: &BladderLabels) -> impl Iterator<Item = HistoryColumn> {
    (0..2 * labels.per_row).map(move |bladder| {
        let label = labels.label(bladder);
        HistoryColumn {
            name: format!("{}_pressure", begin("bladder", &label)),
            unit: "Pa",
            about: format!("mean pressure of bladder {label}"),
        }
    })
}

/// For each column of a run: the integrals of which it is the sum, if it is no part of a state.
pub fn integrated(system: &System) -> Vec<Vec<usize>> {
    let wet = system.model.wet.as_ref();
    let volume = |column: usize| {
        let wet = wet.filter(|wet| column < 4 * ports::count(wet) && column % 4 == 3);
        wet.map(|wet| ports::first(wet) + column / 4).into_iter().collect()
    };
    let mut all: Vec<_> = (0..of_network(system, false).len()).map(volume).collect();
    all.extend(reactions::integrals(system));
    all.resize(columns(system, false).len(), vec![]);
    all
}

/// Columns of a run for all flows and pressures of the network: their indices, and their names with units.
pub fn of_fluid(system: &System) -> impl Iterator<Item = (usize, String)> {
    let all = of_network(system, false).into_iter().enumerate();
    // not powers and volumes
    all.filter(|(_, one)| matches!(one.unit, "Pa" | "m^3/s"))
        .map(|(place, one)| (place, key(&one.name, one.unit)))
}

/// Columns of a run for outputs of controllers: their indices, and their names with units.
pub fn of_outputs(system: &System) -> Vec<(usize, String)> {
    if system.model.controllers.is_empty() {
        return vec![];
    }
    let all = columns(system, false);
    let first = all.len() - 2 * system.model.controllers.len();
    let outputs = all.iter().enumerate().skip(first).step_by(2);
    outputs.map(|(place, one)| (place, key(&one.name, one.unit))).collect()
}

/// Writes the values in a state; without integrals those of a state at rest.
pub fn values(look: &StateView, integrals: Option<&[f64]>, out: &mut [f64]) {
    let mut out = out.iter_mut();
    let mut put = |value: f64| {
        if let Some(place) = out.next() {
            *place = value;
        }
    };
    network_values(look, integrals, &mut put);
    reactions::values(look, integrals, &mut put);
    for (number, law) in look.system.model.contacts.iter().enumerate() {
        let felt = contact_points::felt(look.system, &look.w, number);
        put(felt.normal);
        if integrals.is_some() {
            put(felt.friction);
        }
        put(felt.depth);
        if law.bend_radius().is_some() {
            put(felt.force.x);
            put(felt.force.z);
        }
    }
    for number in 0..look.system.beam_contacts.len() {
        let felt = beam_contacts::felt(look.system, &look.w, number);
        put(felt.normal);
        put(felt.depth);
    }
    if integrals.is_some() {
        let clock = look.now.clock();
        for ControlledInput { controller, .. } in &look.system.model.controllers {
            put(controller.output(clock));
            put(controller.setpoint.value(clock.t));
        }
    }
}

fn network_values(look: &StateView, integrals: Option<&[f64]>, put: &mut impl FnMut(f64)) {
    let (Some(wet), Some(fluid)) = (&look.system.model.wet, &look.system.fluid) else {
        return;
    };
    let mut flows = vec![0.0; ports::count(wet)];
    ports::flows(look.system, look.now, &look.w, &mut flows);
    for (port, &flow) in flows.iter().enumerate() {
        let [pressure, power] = ports::pressure_and_power(look.system, look.now, &look.w, port, flow);
        put(pressure);
        if let Some(integrals) = integrals {
            put(flow);
            put(power);
            put(ports::let_in(look.system, integrals, port));
        }
    }
    let vessels = fluid.accumulators.iter().zip(&look.w.fluid.accumulated);
    for (one, &volume) in vessels.filter(|(one, _)| one.number.is_some()) {
        put(look.w.fluid.junction[one.junction]);
        put(volume);
    }
    if wet.network.is_dry() {
        plain_junctions(fluid).for_each(|k| put(look.w.fluid.junction[k]));
        if integrals.is_some() {
            tubes(fluid).for_each(|(k, _)| put(look.w.fluid.flow[k]));
        }
    }
    if integrals.is_none() {
        look.system.pressures_of_fluid(&look.w).for_each(put);
    }
}

/// Default first part of column names for `name`: its letters and digits in lower case.
pub fn begin(kind: &str, name: &str) -> String {
    let plain = |c: char| match c.is_alphanumeric() {
        true => c.to_ascii_lowercase(),
        false => '_',
    };
    format!("{kind}_{}", name.chars().map(plain).collect::<String>())
}

/// Each name with the first part of its column names: letters and digits, followed by a number if that is already in
/// use.
fn short<'a>(kind: &str, names: impl Iterator<Item = &'a String>) -> Vec<(&'a String, String)> {
    let mut all: Vec<(&String, String)> = vec![];
    for name in names {
        let begin = begin(kind, name);
        let taken = |one: &String| all.iter().any(|(_, other)| other == one);
        let numbered = (2..).map(|k| format!("{begin}_{k}"));
        let mut candidates = std::iter::once(begin.clone()).chain(numbered);
        let own = candidates.find(|one| !taken(one)).unwrap_or_default();
        all.push((name, own));
    }
    all
}
