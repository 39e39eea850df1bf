//! Flow, volume and pressure of each port.

use super::ENERGY_RATES;
use super::fluid::{beyond_stored, component, stored_rate};
use crate::discrete::fluid_mesh::{LinkEnd, MeshBridge};
use crate::discrete::residual::fluid::{pressure_at, through_bridge};
use crate::discrete::{System, TimeData, Workspace, injected_volume};
use crate::model::network::Feed;
use crate::model::{LumpedKind, Wet};

/// Number of ports of a network: first those of given pressure, then those that prescribe flow or volume.
pub fn count(wet: &Wet) -> usize {
    wet.network.ports.len() + wet.network.sources.len()
}

/// Index of the first inflow volume of ports among the integrals.
pub fn first(wet: &Wet) -> usize {
    ENERGY_RATES.len() + 4 * wet.network.open.len()
}

/// Volume that has entered through a port [m^3].
pub fn let_in(system: &System, integrals: &[f64], port: usize) -> f64 {
    let wet = system.model.wet.as_ref();
    wet.and_then(|wet| integrals.get(first(wet) + port))
        .copied()
        .unwrap_or(0.0)
}

/// Adds the inflow of each port [m^3/s]. For ports of given pressure it is the rate of storage in their network, shared according to the
/// ports' law, whose pressure differences may be rounding errors. The workspace must contain [`super::complete`] of the state.
pub fn flows(system: &System, now: &TimeData, w: &Workspace<f64>, out: &mut [f64]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let mut across = |from: LinkEnd, to: LinkEnd, q: f64| {
        for (place, sign) in [(from, 1.0), (to, -1.0)] {
            if let LinkEnd::Port(port) = place {
                out[port] += sign * q;
            }
        }
    };
    for &k in &fluid.sorted.at_ports {
        let (link, q) = (&fluid.links[k], w.fluid.flow[k]);
        let components = [link.from, link.to].map(|place| component(&wet.network, fluid, place));
        across(
            link.from,
            link.to,
            q - beyond_stored(w, link.conductance(now, w, k), components),
        );
    }
    for (k, &MeshBridge { from, to, .. }) in fluid.bridges.iter().enumerate() {
        across(from, to, through_bridge(wet, fluid, k, now, w));
    }
    of_lumped(system, w, out);
    for (out, &flow) in out[wet.network.ports.len()..].iter_mut().zip(&now.source_flow) {
        *out += flow;
    }
}

/// Adds the inflow of ports in networks of one pressure, which equals the rate of storage.
fn of_lumped(system: &System, w: &Workspace<f64>, out: &mut [f64]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    for lumped in &wet.lumped {
        if let LumpedKind::Port(port) = lumped.kind {
            out[port] += stored_rate(fluid, w, lumped);
        }
    }
}

/// Inflow through ports in zero time, for networks of one pressure when it jumps.
pub(super) fn lumped_jump(system: &System, w: &Workspace<f64>, out: &mut [f64]) {
    if let Some(wet) = &system.model.wet {
        of_lumped(system, w, &mut out[first(wet)..]);
    }
}

/// Replaces integrals of the flow rate of ports with prescribed volume by the exact volume from their signal. This applies to the volume
/// of each port and, if it stays in its network, to the outflow of the network. Otherwise ports of given pressure release the difference.
pub fn settle(system: &System, now: &TimeData, integrals: &mut [f64]) {
    let Some(wet) = &system.model.wet else { return };
    let (network, own) = (&wet.network, first(wet) + wet.network.ports.len());
    for (k, source) in network.sources.iter().enumerate() {
        let Feed::Volume(volume) = &source.feed else { continue };
        // relative to the start, at which the signal may already have a volume
        let let_in = now.source_volume[k] - volume.value(0.0);
        let more = let_in - integrals[own + k];
        integrals[own + k] = let_in;
        let component = network.component_of(source.into);
        if let Some(open) = component.and_then(|own| network.open_number(own)) {
            let [left, by_law] = [2 * open, 2 * (network.open.len() + open)];
            for entry in [left, by_law]
                .into_iter()
                .filter(|_| injected_volume::is_kept(network, k))
            {
                integrals[ENERGY_RATES.len() + entry] -= more;
            }
        }
    }
}

/// Adds the flows of [`flows`] to the rates of all integrals.
pub(super) fn rates(system: &System, now: &TimeData, w: &Workspace<f64>, out: &mut [f64]) {
    if let Some(wet) = &system.model.wet {
        let first = first(wet);
        flows(system, now, w, &mut out[first..first + count(wet)]);
    }
}

/// Pressure at a port, outside the half cell behind it [Pa], for its inflow `flow`.
pub fn pressure(system: &System, now: &TimeData, w: &Workspace<f64>, port: usize, flow: f64) -> f64 {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return 0.0;
    };
    let ports = wet.network.ports.len();
    if port < ports {
        return now.port_pressure[port];
    }
    let source = port - ports;
    match fluid.sources.iter().find(|one| one.number == source) {
        Some(own) => {
            let (inside, lost) = (pressure_at(own.into, now, w), own.half_cell * flow);
            match &wet.compression {
                None => inside + lost,
                Some(compression) => compression.pressure_of_potential(compression.potential(inside) + lost),
            }
        }
        // network of one pressure
        None => {
            let component = wet.network.component_of(wet.network.sources[source].into);
            let own = wet.lumped.iter().position(|lumped| Some(lumped.component) == component);
            own.map_or(0.0, |lumped| w.fluid.lumped[lumped])
        }
    }
}

/// Pressure at a port [Pa], and the power of its inflow [W].
pub fn pressure_and_power(system: &System, now: &TimeData, w: &Workspace<f64>, port: usize, flow: f64) -> [f64; 2] {
    let pressure = pressure(system, now, w, port, flow);
    let wet = system.model.wet.as_ref();
    [pressure, wet.map_or(0.0, |wet| wet.enthalpy(pressure) * flow)]
}
