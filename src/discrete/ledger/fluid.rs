//! Contributions of the fluid to the balances.

use std::ops::Range;

use super::{ENERGY_RATES, EnergyRate, Rates, add, add_all, compressed, tubes};
use crate::case::schema::Effect;
use crate::discrete::fluid_mesh::{LinkEnd, MeshBridge};
use crate::discrete::residual::fluid::{driving, look_along, over_bridge, pressure_at, pump_pressure, through_bridge};
use crate::discrete::residual::rows::{driven, mean_force, mean_moment};
use crate::discrete::residual::{nonlinear, von_karman};
use crate::discrete::{FluidMesh, System, TimeData, Workspace, injected_volume};
use crate::model::bladder::kink_curvature;
use crate::model::network::{LinkKind, ResolvedNetwork};
use crate::model::{AreaLaw, CouplingLaw, LumpedKind, LumpedNetwork, ROWS, Wet};

/// Computes quantities needed only for balances: means, pressure rates of lumped networks, and area rates of their
/// bladders.
pub fn complete(system: &System, now: &TimeData, yp: &[f64], w: &mut Workspace<f64>) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    for j in 0..wet.per_row {
        if !wet.takes_moments {
            w.coupling.mean_moment[j] = mean_moment(system, w, j);
        }
        if !wet.takes_forces {
            w.coupling.mean_force[j] = mean_force(system, w, j);
        }
        let own = &system.layout.coupling;
        let rate = |means: &Range<usize>| yp[means.clone()].get(j).copied().unwrap_or(0.0);
        w.coupling.mean_moment_rate[j] = rate(&own.mean_moment);
        w.coupling.mean_force_rate[j] = match now.statics.mean_rate.get(j) {
            Some(&given) => given,
            None => rate(&own.mean_force),
        };
    }
    // equations use only Ψ of these
    if wet.compression.is_some() {
        for (k, link) in fluid.links.iter().enumerate().filter(|(_, link)| link.is_plain()) {
            look_along(wet, link, now, w, k);
        }
    }
    for (bladder, unknown) in system.layout.coupling.excess() {
        w.coupling.excess_area_rate[bladder] = yp[unknown];
    }
    for (k, lumped) in wet.lumped.iter().enumerate() {
        w.fluid.lumped_rate[k] = match (&lumped.kind, system.layout.network.lumped_pressure[k]) {
            (LumpedKind::Port(port), _) => now.port_pressure_rate[*port],
            (_, Some(unknown)) => yp[unknown] + injected_volume::pressing(wet, lumped, now)[1],
            _ => 0.0,
        };
        for &bladder in &lumped.bladders {
            let rate = imposed_rate(wet, w, bladder);
            let cell = fluid.cells_of(bladder).start;
            let [_, stored] =
                compressed::shared_rates(wet, wet.area_of(bladder), w, cell, w.fluid.lumped_rate[k], rate);
            w.fluid.area_rate[fluid.cells_of(bladder)].fill(stored);
        }
    }
    surplus(system, now, w);
}

/// Rate of a bladder's area by moment, force, finite strain and the pressure of the other bladder.
pub(super) fn imposed_rate(wet: &Wet, w: &Workspace<f64>, bladder: usize) -> f64 {
    let (j, row) = wet.place(bladder);
    let law = wet.area_of(bladder);
    law.moment_slope(w.coupling.mean_moment[j], row) * w.coupling.mean_moment_rate[j]
        + law.force_slope(w.coupling.mean_force[j]) * w.coupling.mean_force_rate[j]
        + w.coupling.excess_area_rate.get(bladder).copied().unwrap_or(0.0)
}

/// Stretch by pressure of an otherwise inextensible beam, and the resulting axial motion, `[E28]`.
pub fn foreshorten(system: &System, now: &TimeData, w: &mut Workspace<f64>) {
    if let Some(wet) = &system.model.wet
        && system.model.effects.has(Effect::PressureToStretch)
    {
        for j in 0..wet.per_row {
            let [upper, lower] = wet.pair(j).map(|bladder| w.fluid.mean_pressure[bladder]);
            let (coupling, strains) = wet.strains_of(j);
            w.coupling.pressure_stretch[j] = coupling.stretch(strains, w.coupling.mean_force[j], upper, lower);
        }
    }
    let stretch_rate = |w: &Workspace<f64>, j| {
        let wet = system.model.wet.as_ref().filter(|wet| wet.per_row > 0);
        wet.map_or(0.0, |wet| {
            SegmentRates::new(system, wet, w, j).strain_rates(wet.strains_of(j)).0
        })
    };
    von_karman::foreshorten(system, now, stretch_rate, w);
}

/// Adds the power of a coupling without reciprocity; returns the rates of stretch by pressure, and of curvature at an end with a given
/// moment, less that of `M/EI`.
///
/// ```text
/// P_reciprocity = l_seg Σ_j { Nbar d/dt(φ_b [l_b A_N' - ζ'/E] (p_u + p_d))
///                           + Mbar d/dt(φ_b [(p_d - p_u)(ψ'/E - l_b am) - l_b dm σ'(Mbar)(p_u + p_d)]) }
/// ```
pub fn rates<'a>(
    system: &'a System,
    w: &Workspace<f64>,
    out: &mut [f64],
) -> impl Fn(&Workspace<f64>, usize) -> [f64; 2] + use<'a> {
    if let Some(wet) = &system.model.wet {
        for j in 0..wet.per_row {
            let s = SegmentRates::new(system, wet, w, j);
            let length_ratio = wet.length_ratio_of(j, system.model.length);
            let reciprocal = CouplingLaw::Reciprocal { length_ratio };
            let (stretch, curvature) = s.strain_rates(wet.strains_of(j));
            let (stretch_0, curvature_0) = s.strain_rates((&reciprocal, wet.areas_of(j)));
            let power = s.force * (stretch_0 - stretch) + s.moment * (curvature_0 - curvature);
            add(out, EnergyRate::Reciprocity, system.mesh.segment_lengths[j] * power);
        }
    }
    move |w, node| {
        let Some(wet) = system.model.wet.as_ref().filter(|wet| wet.per_row > 0) else {
            return [0.0; 2];
        };
        let j = system.mesh.segments_of_node(node).0;
        let (stretch, curvature) = SegmentRates::new(system, wet, w, j).strain_rates(wet.strains_of(j));
        [stretch, curvature + nonlinear::end_rate(system, w, node)]
    }
}

/// Rates of the mean pressures of a segment's upper and lower bladder [Pa/s]; requires [`complete`].
pub fn pressure_rates(system: &System, wet: &Wet, w: &Workspace<f64>, j: usize) -> [f64; 2] {
    SegmentRates::new(system, wet, w, j).pressure_rate
}

/// Pressures, means and their rates in one segment.
pub(super) struct SegmentRates {
    pub(super) moment: f64,
    pub(super) force: f64,
    moment_rate: f64,
    force_rate: f64,
    pressure: [f64; 2],
    pressure_rate: [f64; 2],
}

impl SegmentRates {
    pub(super) fn new(system: &System, wet: &Wet, w: &Workspace<f64>, j: usize) -> Self {
        let (moment, force) = (w.coupling.mean_moment[j], w.coupling.mean_force[j]);
        let (moment_rate, force_rate) = (w.coupling.mean_moment_rate[j], w.coupling.mean_force_rate[j]);
        let mut pressure = [0.0; 2];
        let mut pressure_rate = [0.0; 2];
        for (k, bladder) in wet.pair(j).into_iter().enumerate() {
            pressure[k] = w.fluid.mean_pressure[bladder];
            let cells = system.fluid.as_ref().map_or(0..0, |f| f.cells_of(bladder));
            pressure_rate[k] = compressed::mean_pressure_rate(wet, w, bladder, cells);
        }
        Self {
            moment,
            force,
            moment_rate,
            force_rate,
            pressure,
            pressure_rate,
        }
    }

    /// Rates of `lambda_p` and `alpha_p` for a coupling.
    pub(super) fn strain_rates(&self, (coupling, laws): (&CouplingLaw, &[AreaLaw; 2])) -> (f64, f64) {
        let [pu, pd] = self.pressure;
        let [pu_t, pd_t] = self.pressure_rate;
        match *coupling {
            CouplingLaw::Published {
                stretch_per_pressure,
                curvature_per_pressure,
            } => (
                stretch_per_pressure * (pu_t + pd_t),
                curvature_per_pressure * (pu_t - pd_t),
            ),
            CouplingLaw::Reciprocal { length_ratio } => {
                let (mut stretch, mut curvature) = (0.0, 0.0);
                for ((law, row), (p, p_t)) in laws.iter().zip(ROWS).zip([(pu, pu_t), (pd, pd_t)]) {
                    let force_kink = kink_curvature(self.force, law.force_width) * self.force_rate;
                    let moment_kink = kink_curvature(self.moment, law.moment_width) * self.moment_rate;
                    stretch += law.force_slope(self.force) * p_t - law.force_half_difference * force_kink * p;
                    curvature +=
                        law.moment_slope(self.moment, row) * p_t - law.moment_half_difference * moment_kink * p;
                }
                (length_ratio * stretch, length_ratio * curvature)
            }
        }
    }
}

/// Dissipation, harvested power, power of ports, and the outflow of every component.
///
/// Flow through a pressure port is `g (p_port - p)`: for a large g, rounding errors of p make it noise. The total
/// inflow of a component through its pressure ports is therefore computed exactly from its storage. `g (p_port - p)`
/// only determines the shares of the ports.
pub fn flows(system: &System, now: &TimeData, w: &mut Workspace<f64>, out: &mut [f64]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let network = &wet.network;
    for face in fluid.creeping_faces() {
        let lost = compressed::lost_between(
            wet,
            w,
            fluid.conductance_of(wet, face[0] / fluid.cells_per_bladder),
            face,
        );
        add(out, EnergyRate::Bladders, lost);
    }
    let component = |place: LinkEnd| component(network, fluid, place);
    let w = &*w;
    let count = network.open.len();
    // `noise` is the reference flow of the law's relative error: `g |p|` of a pressure port.
    let leave = |component: usize, [outward, by_law, noise]: [f64; 3], out: &mut [f64]| {
        if let Some(open) = network.open_number(component) {
            out[ENERGY_RATES.len() + 2 * open] += outward;
            out[ENERGY_RATES.len() + 2 * open + 1] += outward.abs();
            out[ENERGY_RATES.len() + 2 * (count + open)] += by_law;
            out[ENERGY_RATES.len() + 2 * (count + open) + 1] += noise;
        }
    };
    for (k, lumped) in wet.lumped.iter().enumerate() {
        let (power, outward) = lumped_ports(wet, fluid, now, w, k, lumped);
        add(out, EnergyRate::Ports, power);
        leave(lumped.component, [outward, outward, 0.0], out);
    }
    let cross = |from: LinkEnd, to: LinkEnd, [q, by_law, noise]: [f64; 3], out: &mut [f64]| {
        for (place, sign) in [(from, 1.0), (to, -1.0)] {
            let outward = sign * q;
            match (place, component(place)) {
                (LinkEnd::Port(p), _) => add(out, EnergyRate::Ports, wet.enthalpy(now.port_pressure[p]) * outward),
                (_, Some(c)) if component(from) != component(to) => leave(c, [outward, sign * by_law, noise], out),
                _ => {}
            }
        }
    };
    add_all(out, along_links(fluid, now, w));
    for &k in &fluid.sorted.at_ports {
        let (link, q) = (&fluid.links[k], w.fluid.flow[k]);
        let conductance = link.conductance(now, w, k);
        let surplus = beyond_stored(w, conductance, [component(link.from), component(link.to)]);
        let ends = [link.from, link.to].map(|place| wet.potential(pressure_at(place, now, w)).abs());
        let size = ends[0].max(ends[1]);
        cross(link.from, link.to, [q - surplus, q, conductance * size], out);
    }
    for source in &fluid.sources {
        let (q, place) = (now.source_flow[source.number], source.into);
        let [power, lost] = compressed::fed(wet, pressure_at(place, now, w), source.half_cell, q);
        add(out, EnergyRate::Ports, power);
        add(out, EnergyRate::Bladders, lost);
        if let Some(c) = component(place) {
            leave(c, [-q, -q, 0.0], out);
        }
    }
    for (b, &MeshBridge { number, from, to }) in fluid.bridges.iter().enumerate() {
        let bridge = &network.bridges[number];
        let ((forward, backward), _) = over_bridge(wet, fluid, b, now, w);
        let (qf, qb) = (bridge.valve.flow(forward), bridge.valve.flow(backward));
        let conductance = network.turbines[bridge.turbine].conductance;
        add(
            out,
            EnergyRate::Turbines,
            conductance * w.fluid.bridge[b] * w.fluid.bridge[b],
        );
        add(out, EnergyRate::Rectifiers, 2.0 * (qf * forward + qb * backward));
        let q = through_bridge(wet, fluid, b, now, w);
        add(out, EnergyRate::Loads, q * bridge.head * now.gravity);
        cross(from, to, [q, q, 0.0], out);
    }
}

/// Dissipation and harvested power of flow along links, and the power of pumps.
fn along_links(fluid: &FluidMesh, now: &TimeData, w: &Workspace<f64>) -> Rates {
    let mut rates = Rates::default();
    for (k, link) in fluid.links.iter().enumerate() {
        let volume = w.fluid.at_mean_density(k, w.fluid.flow[k]);
        let in_halves = volume * volume * link.half_cells;
        if let Some(pump) = link.pump {
            let pressure = pump_pressure(link, pump, now, w, k);
            add(&mut rates, EnergyRate::Ports, volume * pressure);
        }
        if link.head != 0.0 {
            add(&mut rates, EnergyRate::Loads, w.fluid.flow[k] * link.head * now.gravity);
        }
        let [in_valve, in_bladders, rest] = match &link.flow {
            None => {
                let between = volume * driving(link, now, w, k) - in_halves;
                tubes::creeping(link, [now.conductance[k], volume, between])
            }
            Some(flow) => {
                let resistance = match link.pilot {
                    None => now.resistance[k],
                    Some(_) => link.resistance / link.opening(now, w, k),
                };
                tubes::dissipation(link, flow, [resistance, volume, driven(link, now, w, k)], k, w)
            }
        };
        add(&mut rates, EnergyRate::Bladders, in_halves + in_bladders);
        add(&mut rates, EnergyRate::Rectifiers, in_valve);
        let of_rest = match link.kind {
            Some(LinkKind::Turbine(_)) => EnergyRate::Turbines,
            _ => EnergyRate::Tubes,
        };
        add(&mut rates, of_rest, rest);
    }
    rates
}

/// Rate of the volume stored in the bladders of a lumped network [m^3/s].
pub fn stored_rate(fluid: &FluidMesh, w: &Workspace<f64>, lumped: &LumpedNetwork) -> f64 {
    let cells = lumped.bladders.iter().flat_map(|&b| fluid.cells_of(b));
    cells.map(|cell| w.fluid.area_rate[cell]).sum::<f64>() * fluid.ds
}

/// Power and outflow of a lumped network through its ports.
fn lumped_ports(
    wet: &Wet,
    fluid: &FluidMesh,
    now: &TimeData,
    w: &Workspace<f64>,
    k: usize,
    lumped: &LumpedNetwork,
) -> (f64, f64) {
    let gain = match &lumped.kind {
        LumpedKind::Closed => 0.0,
        LumpedKind::Fed(sources) => sources.iter().map(|&s| now.source_flow[s]).sum(),
        LumpedKind::Port(_) => stored_rate(fluid, w, lumped),
    };
    (wet.enthalpy(w.fluid.lumped[k]) * gain, -gain)
}

/// Power and outflow of lumped networks of given pressure, whose areas jump with their pressure or with the beam.
pub fn lumped_jump(system: &System, now: &TimeData, w: &Workspace<f64>, out: &mut [f64]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let count = wet.network.open.len();
    for (k, lumped) in wet.lumped.iter().enumerate() {
        if !matches!(lumped.kind, LumpedKind::Port(_)) {
            continue;
        }
        let (power, outward) = lumped_ports(wet, fluid, now, w, k, lumped);
        add(out, EnergyRate::Ports, power);
        if let Some(open) = wet.network.open_number(lumped.component) {
            out[ENERGY_RATES.len() + 2 * open] += outward;
            out[ENERGY_RATES.len() + 2 * open + 1] += outward.abs();
            out[ENERGY_RATES.len() + 2 * (count + open)] += outward;
        }
    }
}

/// Part of the flow along a link to a pressure port that its component does not store: the link's share of [`surplus`].
pub(super) fn beyond_stored(w: &Workspace<f64>, conductance: f64, components: [Option<usize>; 2]) -> f64 {
    let share = |c: usize| w.fluid.volume_defect[c] * conductance / w.fluid.port_conductance[c].max(f64::MIN_POSITIVE);
    match components {
        [None, Some(c)] => share(c),
        [Some(c), None] => -share(c),
        _ => 0.0,
    }
}

/// Component of a place; none for a port.
pub(super) fn component(network: &ResolvedNetwork, fluid: &FluidMesh, place: LinkEnd) -> Option<usize> {
    match place {
        LinkEnd::Cell(c) => Some(network.component_of_bladder[c / fluid.cells_per_bladder]),
        LinkEnd::Junction(j) => Some(network.component_of_junction[fluid.junctions[j]]),
        LinkEnd::Port(_) => None,
    }
}

/// Sums the inflow that is not stored, and the conductances to pressure ports, for each component of the network.
fn surplus(system: &System, now: &TimeData, w: &mut Workspace<f64>) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let network = &wet.network;
    if network.ports.is_empty() {
        return;
    }
    w.fluid.volume_defect.fill(0.0);
    w.fluid.port_conductance.fill(0.0);
    for (bladder, &component) in network.component_of_bladder.iter().enumerate() {
        let cells = fluid.cells_of(bladder);
        let inflow: f64 = w.fluid.inflow[cells.clone()].iter().sum();
        let stored: f64 = w.fluid.area_rate[cells].iter().sum();
        w.fluid.volume_defect[component] += inflow - stored * fluid.ds;
    }
    for (inflow, &junction) in w.fluid.junction_inflow.iter().zip(&fluid.junctions) {
        w.fluid.volume_defect[network.component_of_junction[junction]] += inflow;
    }
    for (one, rate) in fluid.accumulators.iter().zip(&w.fluid.accumulated_rate) {
        w.fluid.volume_defect[one.component] -= rate;
    }
    for &k in &fluid.sorted.at_ports {
        let ends = [fluid.links[k].from, fluid.links[k].to];
        for inside in ends.into_iter().filter_map(|end| component(network, fluid, end)) {
            w.fluid.port_conductance[inside] += fluid.links[k].conductance(now, w, k);
        }
    }
}
