//! Loads, pressures and flows that no such beam withstands: almost always a wrong unit.

use super::bladders::PER_ROW;
use super::functions::controls;
use super::size::{size_along, size_of, size_of_integral};
use super::time::END;
use crate::case::faults::Violations;
use crate::case::numbers::digits;
use crate::case::schema::{AccumulatorKind, Bladders, Case, Load, Rectifier};
use crate::error::{Code, Violation};
use crate::functions::signals::Signal;

/// Largest strain, and largest pressure over the modulus. The model is valid up to a tenth of it, whatever the material.
const MOST: f64 = 10.0;
/// Largest number of bladder fillings in the time in which sound in the solid crosses the beam's height.
const FASTEST_FILL: f64 = 10.0;

/// Upper bound of a load, its unit, and its meaning.
struct Bound {
    largest: f64,
    /// Pointers of the values from which the bound is computed.
    of: &'static [&'static str],
    unit: &'static str,
    meaning: &'static str,
    hint: &'static str,
}

/// Pointers of the values that determine the bounds of loads: modulus, section, length, mass.
const BEAM: [&str; 8] = [
    "/beam/young_modulus_pa",
    "/beam/height_m",
    "/beam/width_m",
    "/beam/axial_stiffness_factor",
    "/beam/bending_stiffness_factor",
    "/beam/length_m",
    "/beam/density_kg_m3",
    "/beam/mass_factor",
];
/// Pointers of the values that determine the bounds of flows.
const FILLED: [&str; 7] = [
    BEAM[0],
    BEAM[1],
    "/beam/density_kg_m3",
    "/bladders/height_m",
    "/bladders/width_m",
    "/bladders/length_m",
    PER_ROW,
];
/// Pointers of the values that determine the bounds of volumes.
const ROOM: [&str; 8] = [
    BEAM[0],
    "/bladders/area_per_pressure_m2_per_pa",
    "/bladders/height_m",
    "/bladders/width_m",
    "/bladders/length_m",
    PER_ROW,
    "/fluid",
    "/network/accumulators",
];

/// Speed of sound in air [m/s]: no stream of the model is faster.
const SOUND: f64 = 343.0;

const PRESSURES: &str = "pressures are in Pa; a kPa is 1e3, a bar 1e5";
const FLOWS: &str = "flows are in m^3/s; a ml/s is 1e-6";
const VOLUMES: &str = "volumes are in m^3; a ml is 1e-6";

/// Bounds computed from the dimensions of the beam.
struct Bounds {
    pressure: Bound,
    /// Flow and volume of a port in a network without bladders.
    flow: Bound,
    volume: Bound,
    force: Bound,
    moment: Bound,
    force_along: Bound,
    moment_along: Bound,
    body: Bound,
    rotation: Bound,
    curvature: Bound,
    stream: Bound,
}

impl Bounds {
    /// `p = 10 E`, `F = 10 EA`, `M = 10 EI/(h/2)`; divided by the length for loads along the beam, by the mass for accelerations.
    fn new(case: &Case) -> Self {
        let beam = &case.beam;
        let area = beam.height_m * beam.width_m;
        let ea = beam.young_modulus_pa * area * beam.axial_stiffness_factor;
        let ei = beam.young_modulus_pa * beam.second_moment();
        let mass = beam.density_kg_m3 * area * beam.length_m * beam.mass_factor.unwrap_or(1.0);
        let (force, moment) = (MOST * ea, 2.0 * MOST * ei / beam.height_m);
        let strain = "the load that strains the beam by 1000 %";
        let bound = |largest, of, unit, meaning, hint| Bound {
            largest,
            of,
            unit,
            meaning,
            hint,
        };
        let newtons = "forces are in N; is this in mN?";
        Self {
            pressure: match case.bladders {
                Some(_) => bound(
                    MOST * beam.young_modulus_pa,
                    &BEAM[..1],
                    "Pa",
                    "ten times Young's modulus",
                    PRESSURES,
                ),
                None => bound(1e10, &[], "Pa", "pumps generate", PRESSURES),
            },
            flow: bound(1e3, &[], "m^3/s", "pumps deliver", FLOWS),
            volume: bound(1e6, &[], "m^3", "vessels contain", VOLUMES),
            force: bound(force, &BEAM[..5], "N", strain, newtons),
            moment: bound(
                moment,
                &BEAM[..5],
                "N m",
                strain,
                "moments are in N m; is this in N mm?",
            ),
            force_along: bound(force / beam.length_m, &BEAM[..6], "N/m", strain, newtons),
            moment_along: bound(
                moment / beam.length_m,
                &BEAM[..6],
                "N",
                strain,
                "first moments per length are in N",
            ),
            body: bound(force / mass, &BEAM, "m/s^2", strain, "accelerations are in m/s^2"),
            rotation: bound(
                force / mass,
                &BEAM,
                "m/s^2 at the far end of the beam",
                "the acceleration that strains the beam by 1000 %",
                "angular velocities are in rad/s; 1 rpm is 0.1047 rad/s",
            ),
            curvature: bound(
                2.0 * MOST / beam.height_m,
                &BEAM[1..2],
                "1/m",
                "ten over half the height",
                "is this in 1/mm?",
            ),
            stream: bound(
                SOUND,
                &[],
                "m/s",
                "the speed of sound in air",
                "velocities are in m/s; a km/h is 0.278",
            ),
        }
    }
}

/// Checks all loads, pressures, flows and volumes against their bounds.
pub(super) fn check(case: &Case, faults: &mut Violations) {
    if !case.spans.is_empty() {
        // each span by itself
        return;
    }
    let bounds = Bounds::new(case);
    let end = case.time.end_s;
    let timed = faults.are_sound(&[END]);
    let mut look = |pointer: String, size: f64, bound: &Bound| {
        if size > bound.largest && bound.largest.is_finite() && size.is_finite() {
            let what = format!("{} {} is more than {}", digits(size), bound.unit, bound.meaning);
            let allowed = format!("up to {} {}", digits(bound.largest), bound.unit);
            refuse(faults, &pointer, bound.of, what, allowed, bound.hint);
        }
    };
    for (i, load) in case.loads.iter().enumerate() {
        if let Load::Gravity { x_m_s2, z_m_s2 } = load {
            look(format!("/loads/{i}/gravity/x_m_s2"), x_m_s2.abs(), &bounds.body);
            look(format!("/loads/{i}/gravity/z_m_s2"), z_m_s2.abs(), &bounds.body);
        }
    }
    for (i, some) in case.start.pressures.iter().enumerate() {
        let pointer = format!("/start/pressures/{i}/pressure_pa");
        look(pointer, size_along(&some.pressure_pa), &bounds.pressure);
    }
    for (i, turbine) in case.network.iter().flat_map(|n| &n.turbines).enumerate() {
        if let Rectifier::CheckValves(valve) = &turbine.rectifier {
            let pointer = format!("/network/turbines/{i}/rectifier/check_valves/cracking_pressure_pa");
            look(pointer, valve.cracking_pressure_pa, &bounds.pressure);
        }
    }
    for (i, accumulator) in case.network.iter().flat_map(|n| &n.accumulators).enumerate() {
        let pointer = format!("/network/accumulators/{i}/start_pressure_pa");
        look(pointer, accumulator.start_pressure_pa.abs(), &bounds.pressure);
    }
    // signals are checked only if the end of the run is valid
    if !timed {
        return;
    }
    for (side, name) in [(&case.ends.root, "root"), (&case.ends.tip, "tip")] {
        let (form, given) = side.form();
        for (key, signal) in given.given() {
            let bound = match key {
                "force_x_n" | "force_z_n" | "follower_normal_n" | "follower_shear_n" => &bounds.force,
                "moment_n_m" => &bounds.moment,
                _ => continue,
            };
            look(format!("/ends/{name}/{form}/{key}"), size_of(signal, end), bound);
        }
    }
    for (i, load) in case.loads.iter().enumerate() {
        if let Some((key, load)) = load.distributed() {
            let bound = match key {
                "force_x_n_m" | "force_z_n_m" => &bounds.force_along,
                "moment_x_n" | "moment_z_n" => &bounds.moment_along,
                "rest_curvature_1_m" => &bounds.curvature,
                _ => &bounds.body,
            };
            let size = size_of(&load.signal, end) * size_along(&load.profile);
            look(format!("/loads/{i}/{key}"), size, bound);
        }
    }
    if let Some(around) = &case.surroundings {
        for (key, signal) in around.stream() {
            look(format!("/surroundings/{key}"), size_of(signal, end), &bounds.stream);
        }
    }
    if let Some(frame) = &case.rotating_frame {
        let most = frame.angular_velocity_rad_s.reaches(end);
        let pointer = "/rotating_frame/angular_velocity_rad_s";
        let [.., distance] = frame.reach(case.beam.length_m);
        for acceleration in [most.value * most.value * distance, most.rate * distance] {
            look(pointer.into(), acceleration.min(f64::MAX), &bounds.rotation);
        }
    }
    for (i, attachment) in case.attachments.iter().enumerate() {
        for (key, signal) in attachment.forces() {
            look(format!("/attachments/{i}/{key}"), size_of(signal, end), &bounds.force);
        }
    }
    for (pointer, signal) in inlets(case).pressures {
        look(pointer, size_of(signal, end), &bounds.pressure);
    }
    for (i, tube) in case.network.iter().flat_map(|n| &n.tubes).enumerate() {
        if let Some(valve) = &tube.check_valve {
            let pointer = format!("/network/tubes/{i}/check_valve/cracking_pressure_pa");
            look(pointer, valve.cracking_pressure_pa, &bounds.pressure);
        }
        if let Some((key, signal)) = tube.pump.as_ref().and_then(|pump| pump.signal()) {
            let points = tube.pump.iter().filter_map(|pump| pump.curve.as_ref());
            let points = points.flat_map(|curve| &curve.pressure_pa).map(|p| p.abs());
            let largest = points.reduce(f64::max).unwrap_or(1.0) * size_of(signal, end);
            look(format!("/network/tubes/{i}/pump/{key}"), largest, &bounds.pressure);
        }
    }
    match &case.bladders {
        Some(bladders) => flows(case, bladders, faults),
        None => {
            let found = inlets(case);
            for (pointer, signal) in found.flows {
                look(pointer, size_of(signal, end), &bounds.flow);
            }
            for (pointer, signal) in found.volumes {
                look(pointer, size_of(signal, end), &bounds.volume);
            }
        }
    }
}

/// Rejects flows that fill the bladders faster than sound crosses the beam. Without a pressure port, also rejects volumes larger than those
/// that ten times Young's modulus presses into bladders and accumulators.
fn flows(case: &Case, bladders: &Bladders, faults: &mut Violations) {
    let (beam, end) = (&case.beam, case.time.end_s);
    let found = inlets(case);
    let volume = bladders.height_m * bladders.width_m * bladders.length_m * 2.0 * bladders.per_row as f64;
    let sound = (beam.young_modulus_pa / beam.density_kg_m3).sqrt();
    let largest = FASTEST_FILL * volume * sound / beam.height_m;
    let of_flows = found.flows.iter().map(|(at, signal)| (at, size_of(signal, end), FLOWS));
    let of_volumes = found.volumes.iter();
    let of_volumes = of_volumes.map(|(at, signal)| (at, signal.largest(end).rate, VOLUMES));
    for (pointer, size, hint) in of_flows.chain(of_volumes) {
        if size > largest && size.is_finite() {
            let (size, volume) = (digits(size), digits(volume));
            let what = format!("{size} m^3/s fills all bladders, {volume} m^3, before sound has crossed the beam");
            let allowed = format!("up to {} m^3/s", digits(largest));
            refuse(faults, pointer, &FILLED, what, allowed, hint);
        }
    }
    if !found.pressures.is_empty() {
        return;
    }
    let pressure = MOST * beam.young_modulus_pa;
    let in_bladders =
        pressure * bladders.area_per_pressure_m2_per_pa * bladders.length_m * 2.0 * bladders.per_row as f64;
    let softness = case.fluid.as_ref().map_or(0.0, |fluid| {
        fluid.gas() / fluid.ambient_pressure() + fluid.bulk_modulus_pa.map_or(0.0, f64::recip)
    });
    let compressed = |volume: f64| volume * softness * pressure;
    let vessels = case.network.iter().flat_map(|network| &network.accumulators);
    let vessels = vessels.map(|one| match &one.kind {
        &AccumulatorKind::Elastic {
            compliance_m3_pa,
            volume_m3,
        } => pressure * compliance_m3_pa + compressed(volume_m3),
        AccumulatorKind::Tank { volume_m3 } => compressed(*volume_m3),
        AccumulatorKind::Gas { volume_m3, .. } => *volume_m3,
        AccumulatorKind::Curve { volume_m3, pressure_pa } => match (&volume_m3[..], &pressure_pa[..]) {
            // straight beyond the last point
            ([.., v0, v1], [.., p0, p1]) if p1 > p0 => v1 + (pressure - p1).max(0.0) * (v1 - v0) / (p1 - p0),
            _ => f64::INFINITY,
        },
    });
    let room = in_bladders + vessels.sum::<f64>();
    let beyond = format!(
        "bladders of {} m^3, more than a pressure of ten times Young's modulus fills in",
        digits(volume)
    );
    for (pointer, signal) in &found.volumes {
        let size = size_of(signal, end);
        if size > room {
            let what = format!("{} m^3 injected into {beyond}", digits(size));
            let allowed = format!("up to {} m^3", digits(room));
            refuse(faults, pointer, &ROOM, what, allowed, VOLUMES);
        }
    }
    let all: Vec<&Signal> = found.flows.iter().map(|(_, signal)| *signal).collect();
    let size = |(_, signal): &(String, &Signal)| size_of(signal, end);
    let main = found.flows.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
    if let (Some((pointer, _)), Some(left)) = (main, size_of_integral(&all, end))
        && left > room
    {
        let what = format!("flows inject {} m^3 into {beyond}", digits(left));
        let allowed = format!("up to {} m^3 by the end of the run", digits(room));
        refuse(faults, pointer, &ROOM, what, allowed, FLOWS);
    }
}

/// Rejects an implausible value, unless a fault exists at its pointer or at a pointer of its bound.
fn refuse(faults: &mut Violations, pointer: &str, of: &[&str], what: String, allowed: String, hint: &str) {
    let fault = Violation::new(Code::Implausible, pointer, what);
    faults.push_beside(of, fault.allowed(allowed).hint(hint));
}

/// Ports and ends of chains, by the quantity that they prescribe.
#[derive(Default)]
pub(super) struct Inlets<'a> {
    pub pressures: Vec<(String, &'a Signal)>,
    flows: Vec<(String, &'a Signal)>,
    pub volumes: Vec<(String, &'a Signal)>,
}

pub(super) fn inlets(case: &Case) -> Inlets<'_> {
    let mut all = Inlets::default();
    for (at, _, signal) in controls(case) {
        let of_port = ["/network/chains/", "/network/ports/"]
            .iter()
            .any(|part| at.starts_with(part));
        match at.rsplit('/').next().filter(|_| of_port) {
            Some("pressure_pa") => all.pressures.push((at, signal)),
            Some("flow_m3_s") => all.flows.push((at, signal)),
            Some("volume_m3") => all.volumes.push((at, signal)),
            _ => {}
        }
    }
    all
}
