//! Networks over several beams.
//!
//! Source: circuit theory: laminar tubes and rigid bladders are resistances, elastic bladders capacitances.

use serde_json::{Value, json};

use crate::plans::{at_rest, beam, held, joint, near};
use crate::scene::finished;

const MU: f64 = 8.68e-4;
/// Resistance of a bladder [Pa s/m^3].
const BLADDER: f64 = MU * 0.046 / 1.55e-12;
/// Resistance of a tube of 0.020 m [Pa s/m^3].
const TUBE: f64 = MU * 0.02 / 6.72e-13;
/// Compliance of a bladder [m^3/Pa].
const C: f64 = 1.75e-10 * 0.046;

/// Beams a and b with three and two bladders, at a right angle; areas of bladders depend on their pressures alone.
fn over_two_beams(network: Value, end: f64) -> Value {
    json!({
        "name": "networks",
        "beam": {"height_m": 0.0216, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950,
                 "damping": {"bending_time_s": 0.001, "axial_time_s": 0.001}},
        "beams": [held(beam("a", 0.03, 0.0, 3), "root", json!("clamped")), beam("b", 0.02, 90.0, 2)],
        "joints": [joint("rigid", &["a.tip", "b.root"])],
        "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": MU},
        "bladders": {"length_m": 0.046, "height_m": 0.0078, "width_m": 0.0078, "permeability_m4": 1.55e-12,
            "area_per_pressure_m2_per_pa": 1.75e-10, "area_per_moment_m2_per_n_m": {"opening": 0, "closing": 0},
            "area_per_force_m2_per_n": {"tension": 0, "compression": 0}},
        "tubes": {"length_m": 0.02, "radius_m": 0.001, "permeability_m4": 6.72e-13},
        "network": network, "effects": {"tube_inertia": "off", "tube_losses": "off", "solid_inertia": "off"},
        "mesh": {"cells_per_segment": 1, "cells_per_bladder": 1}, "companion": "off",
        "time": {"end_s": end}, "solver": {"rtol": 1e-9}
    })
}

fn chain(beam: &str, bladders: usize) -> Value {
    let row: Vec<String> = (1..=bladders).map(|k| format!("{beam}:{k}")).collect();
    json!({"bladders": row, "ends": ["connected", "connected"]})
}

fn tube(from: Value, to: Value) -> Value {
    json!({"from": from, "to": to})
}

fn junction(name: &str) -> Value {
    json!({"junction": name})
}

fn bladder(name: &str, end: &str) -> Value {
    json!({"bladder": name, "end": end})
}

fn ports(given: &[(&str, f64)]) -> Value {
    let all = given
        .iter()
        .map(|(name, pressure)| json!({"name": name, "at": {"junction": name}, "pressure_pa": pressure}));
    all.collect()
}

/// Goal: a feed that branches into the bladders of both beams, each with an outlet of its own.
#[test]
fn a_junction_feeds_two_beams_as_by_circuit_theory() {
    let case = over_two_beams(
        json!({"junctions": ["in", "y", "of_a", "of_b"], "chains": [chain("a", 3), chain("b", 2)],
            "tubes": [
                tube(junction("in"), junction("y")),
                tube(junction("y"), bladder("a:1", "inlet")), tube(bladder("a:3", "outlet"), junction("of_a")),
                tube(junction("y"), bladder("b:1", "inlet")), tube(bladder("b:2", "outlet"), junction("of_b"))
            ],
            "ports": ports(&[("in", 9000.0), ("of_a", 2000.0), ("of_b", -1000.0)])}),
        1.0,
    );
    let last = at_rest(&case);
    let (a, b) = (3.0 * BLADDER + 4.0 * TUBE, 2.0 * BLADDER + 3.0 * TUBE);
    let y = (9000.0 / TUBE + 2000.0 / a - 1000.0 / b) / (1.0 / TUBE + 1.0 / a + 1.0 / b);
    let behind_a = |resistance: f64| y - (y - 2000.0) * resistance / a;
    let behind_b = |resistance: f64| y - (y + 1000.0) * resistance / b;
    // mean pressures: half a bladder behind its inlet
    for (bladder, exact) in [
        ("a_1", behind_a(TUBE + 0.5 * BLADDER)),
        ("a_2", behind_a(2.0 * TUBE + 1.5 * BLADDER)),
        ("a_3", behind_a(3.0 * TUBE + 2.5 * BLADDER)),
        ("b_1", behind_b(TUBE + 0.5 * BLADDER)),
        ("b_2", behind_b(2.0 * TUBE + 1.5 * BLADDER)),
    ] {
        near("bladder", last(&format!("bladder_{bladder}_pressure")), exact, 1e-9);
    }
}

/// Goal: a ring through the bladders of both beams and a tube, fed and drained at two of its junctions: the flow divides as by the resistances
/// of both ways.
#[test]
fn a_ring_over_two_beams_divides_its_flow() {
    let case = over_two_beams(
        json!({"junctions": ["in", "out"], "chains": [chain("a", 3), chain("b", 2)],
            "tubes": [
                tube(junction("in"), bladder("a:1", "inlet")), tube(bladder("a:3", "outlet"), junction("out")),
                tube(junction("in"), bladder("b:2", "outlet")), tube(bladder("b:1", "inlet"), junction("out"))
            ],
            "ports": [{"name": "in", "at": {"junction": "in"}, "flow_m3_s": 1e-7},
                      {"name": "out", "at": {"junction": "out"}, "pressure_pa": 500.0}]}),
        1.0,
    );
    let last = at_rest(&case);
    let (a, b) = (3.0 * BLADDER + 4.0 * TUBE, 2.0 * BLADDER + 3.0 * TUBE);
    near(
        "pressure at the feed",
        last("port_in_pressure"),
        500.0 + 1e-7 * a * b / (a + b),
        1e-9,
    );
    // bladders of b from its tip to its root
    let way = |share: f64| 500.0 + 1e-7 * a * b / (a + b) * (1.0 - share);
    near(
        "bladder of a",
        last("bladder_a_2_pressure"),
        way((2.0 * TUBE + 1.5 * BLADDER) / a),
        1e-9,
    );
    near(
        "bladder of b",
        last("bladder_b_2_pressure"),
        way((TUBE + 0.5 * BLADDER) / b),
        1e-9,
    );
}

/// Goal: bladders of both beams in a ring of five equal ones with equal tubes: a pressure in the form of the first mode of the ring decays
/// with `(2 - 2 cos(2π/5))/(R C)`, wherever its bladders are.
#[test]
fn a_ring_of_bladders_over_two_beams_decays_as_by_circuit_theory() {
    let row = json!({"bladders": ["a:1", "a:2", "a:3", "b:1", "b:2"], "ends": ["connected", "connected"]});
    let network = json!({"chains": [row], "tubes": [tube(bladder("b:2", "outlet"), bladder("a:1", "inlet"))]});
    let theta = std::f64::consts::TAU / 5.0;
    let rate = (2.0 - 2.0 * theta.cos()) / ((BLADDER + TUBE) * C);
    let mut case = over_two_beams(network, 1.0 / rate);
    let start = |k: usize| 1000.0 * (theta * k as f64 + 0.3).cos();
    case["start"]["pressures"] = (0..5)
        .map(|k| {
            let name = if k < 3 {
                format!("a:{}", k + 1)
            } else {
                format!("b:{}", k - 2)
            };
            json!({"bladders": [name], "pressure_pa": start(k)})
        })
        .collect();
    let memory = finished(&case).0;
    let bladders = memory.header.axes.iter().find(|axis| axis.name == "bladder").unwrap();
    let pressures = memory.field("pressure_pa").unwrap().last().unwrap();
    for k in 0..5 {
        let cell = bladders.values.iter().position(|b| *b == (k + 1) as f64).unwrap();
        near(
            &format!("bladder {}", k + 1),
            pressures[cell],
            start(k) * (-1.0_f64).exp(),
            1e-6,
        );
    }
}
