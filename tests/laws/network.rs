//! Networks without bladders and elevations, [E88]: closed forms, Kirchhoff's laws, balances, differences.
//! The remaining error is that in time: at rtol 1e-9, 1e-6. Flows without storage are exact.

use std::path::Path;

use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::dae::{BeamDae, Dae as _};
use slcbeam::discrete::System;
use slcbeam::error::Result;
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::{Status, Summary};

use crate::differences::worst_difference;

pub const MU: f64 = 1e-3;
pub const RHO: f64 = 1000.0;
pub const G: f64 = 9.806_65;

pub fn parse(value: &Value) -> Result<Case> {
    case::parse(&value.to_string(), Path::new("mine.json"), Path::new(""), &[])
}

/// A short beam at rest beside a network of creeping flow. Permeabilities `μ l_c/R` give tubes of 1 m the resistance R.
pub fn still(network: Value, end: f64) -> Value {
    json!({
        "name": "network", "ends": {"root": "clamped", "tip": "free"},
        "beam": {"length_m": 0.1, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1e6, "density_kg_m3": 1000},
        "fluid": {"density_kg_m3": RHO, "viscosity_pa_s": MU}, "network": network,
        "effects": {"tube_inertia": "off", "tube_losses": "off"}, "companion": "off",
        "time": {"end_s": end, "output_interval_s": end / 50.0}, "solver": {"rtol": 1e-9}
    })
}

pub fn tube(from: &str, to: &str, resistance: f64) -> Value {
    json!({"from": {"junction": from}, "to": {"junction": to}, "length_m": 1, "permeability_m4": MU / resistance})
}

pub fn elastic(at: &str, compliance: f64, start: f64) -> Value {
    json!({"name": at, "at": {"junction": at}, "kind": {"elastic": {"compliance_m3_pa": compliance}}, "start_pressure_pa": start})
}

pub fn run(case: &Value) -> (Memory, Summary) {
    let mut memory = Memory::default();
    let summary = dynamics::run(&parse(case).unwrap(), &mut memory).unwrap().summary;
    assert_eq!(summary.status, Status::Finished, "{:?}", summary.reason);
    (memory, summary)
}

pub fn last(memory: &Memory, column: &str) -> f64 {
    *memory.column(column).expect(column).last().unwrap()
}

/// Value of a column in the equilibrium at an instant.
pub fn at_rest(case: &Value, name: &str) -> f64 {
    let case = parse(case).unwrap();
    let path = follow(&case, &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let at = columns(&system(&case, 1.0).unwrap())
        .iter()
        .position(|c| c.name == name);
    path.last().row[at.expect(name)]
}

pub fn near(what: &str, ours: f64, exact: f64, within: f64) {
    assert!(
        (ours - exact).abs() <= within * exact.abs(),
        "{what}: {ours:e} for {exact:e}"
    );
}

/// Two elastic tanks, the second higher, joined by a laminar tube.
pub fn tanks(height: f64) -> Value {
    still(
        json!({"junctions": ["a", "b"], "elevations": [{"junction": "b", "elevation_m": height}],
            "tubes": [tube("a", "b", 1e9)],
            "accumulators": [elastic("a", 2e-9, 2e4), elastic("b", 1e-9, 0.0)]}),
        3.0,
    )
}

/// Goal: `p_b - p_a + ρ g z` decays with `R C_a C_b/(C_a + C_b)`, volume is kept, gravity works `-ρ g z` times the volume lifted, and the
/// error follows the tolerance.
#[test]
fn two_tanks_drain_into_each_other() {
    let (ca, cb, height) = (2e-9, 1e-9, 0.5);
    let head = RHO * G * height;
    let tau = 1e9 * ca * cb / (ca + cb);
    let (memory, summary) = run(&tanks(height));
    let times = memory.column("t").unwrap();
    let [a, b] = ["a", "b"].map(|at| memory.column(&format!("accumulator_{at}_pressure")).unwrap());
    for ((t, a), b) in times.iter().zip(&a).zip(&b) {
        let drop = (2e4 - head) * (-t / tau).exp();
        assert!((a - b - head - drop).abs() < 1e-7 * 2e4, "{t}: {a} {b}");
        assert!((ca * a + cb * b - ca * 2e4).abs() < 1e-12 * ca * 2e4);
    }
    let lifted = (2e4 - head) * (1.0 - (-3.0 / tau).exp()) * ca * cb / (ca + cb);
    near("work", last(&memory, "work_loads"), -head * lifted, 1e-6);
    let lost = (2e4 - head).powi(2) * (1.0 - (-6.0 / tau).exp()) * 0.5 * ca * cb / (ca + cb);
    near("losses", last(&memory, "dissipated_tubes"), lost, 1e-6);
    assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
    // gravity of the loads replaces the standard one
    let mut moon = tanks(height);
    moon["effects"]["solid_inertia"] = json!("off");
    moon["loads"] = json!([{"gravity": {"x_m_s2": -1.2, "z_m_s2": 0.5}}]);
    let moon = run(&moon).0;
    let level = last(&moon, "accumulator_a_pressure") - last(&moon, "accumulator_b_pressure");
    let head = RHO * 1.3 * height;
    assert!((level - head - (2e4 - head) * (-3.0 / tau).exp()).abs() < 1e-6 * 2e4);
    let error = |rtol: f64| {
        let mut case = tanks(height);
        case["solver"] = json!({"rtol": rtol});
        let ours = last(&run(&case).0, "accumulator_b_volume");
        (ours / lifted - 1.0).abs()
    };
    let errors = [1e-3, 1e-5, 1e-7].map(error);
    assert!(errors[1] < 0.3 * errors[0] && errors[2] < 0.3 * errors[1], "{errors:?}");
    let rest = RHO * G * height;
    let level = at_rest(&tanks(height), "accumulator_a_pressure") - at_rest(&tanks(height), "accumulator_b_pressure");
    near("level at rest", level, rest, 1e-8);
}

/// A ring of four junctions at different heights with a chord, two of them at given pressures, one fed.
fn ring() -> (Value, Vec<(usize, usize, f64)>, [f64; 4]) {
    let names = ["a", "b", "c", "d"];
    let tubes = vec![(0, 1, 1e9), (1, 2, 2e9), (2, 3, 5e8), (3, 0, 4e9), (1, 3, 1.5e9)];
    let heights = [0.0, 0.3, -0.2, 0.1];
    let written: Vec<Value> = tubes.iter().map(|&(i, j, r)| tube(names[i], names[j], r)).collect();
    let elevations: Vec<Value> = (1..4)
        .map(|k| json!({"junction": names[k], "elevation_m": heights[k]}))
        .collect();
    let network = json!({"junctions": names, "tubes": written, "elevations": elevations, "ports": [
        {"name": "in", "at": {"junction": "a"}, "pressure_pa": 5000},
        {"name": "out", "at": {"junction": "d"}, "pressure_pa": 0},
        {"name": "feed", "at": {"junction": "c"}, "flow_m3_s": 2e-6}]});
    (still(network, 1.0), tubes, heights)
}

/// Goal: pressures and flows of a ring of tubes are those of Kirchhoff's equations for `p + ρ g z`, in a run and at rest.
#[test]
fn a_ring_of_tubes_obeys_kirchhoff() {
    let (case, tubes, heights) = ring();
    let (mut matrix, mut right) = (DMatrix::<f64>::zeros(4, 4), DVector::<f64>::zeros(4));
    for &(i, j, r) in &tubes {
        for (i, j) in [(i, j), (j, i)] {
            matrix[(i, i)] += 1.0 / r;
            matrix[(i, j)] -= 1.0 / r;
        }
    }
    right[2] = 2e-6;
    for (k, pressure) in [(0, 5000.0), (3, 0.0)] {
        matrix.row_mut(k).fill(0.0);
        matrix[(k, k)] = 1.0;
        right[k] = pressure + RHO * G * heights[k];
    }
    let levels = matrix.lu().solve(&right).unwrap();
    let (memory, summary) = run(&case);
    for (k, name) in [(1, "b"), (2, "c")] {
        let exact = levels[k] - RHO * G * heights[k];
        if k == 1 {
            near("junction", last(&memory, "junction_b_pressure"), exact, 1e-10);
        } else {
            near("feed", last(&memory, "port_feed_pressure"), exact, 1e-10);
        }
        near(
            "at rest",
            at_rest(&case, &format!("junction_{name}_pressure")),
            exact,
            1e-10,
        );
    }
    for (k, &(i, j, r)) in tubes.iter().enumerate() {
        let flow = last(&memory, &format!("tube_{}_flow", k + 1));
        near("flow", flow, (levels[i] - levels[j]) / r, 1e-10);
    }
    assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
    let highest = [1, 2]
        .map(|k| levels[k] - RHO * G * heights[k])
        .into_iter()
        .fold(f64::NEG_INFINITY, f64::max);
    near("highest", last(&memory, "max_pressure"), highest, 1e-10);
    assert!(memory.column("least_opening").is_none());
    assert_eq!(last(&memory, "tip_u1"), 0.0);
}

/// Goal: in an isothermal column of gas at rest `p_abs` falls as `exp(-ρ_0 g z/P_0)`, through any number of tubes.
#[test]
fn a_column_of_gas_is_barometric() {
    let height = 500.0;
    let tank = |at: &str| json!({"name": at, "at": {"junction": at}, "kind": {"tank": {"volume_m3": 1e-3}}});
    let mut case = still(
        json!({"junctions": ["low", "middle", "high"], "tubes": [tube("low", "middle", 1e6), tube("middle", "high", 1e7)],
            "elevations": [{"junction": "middle", "elevation_m": 200}, {"junction": "high", "elevation_m": height}],
            "accumulators": [tank("low"), tank("high")]}),
        20.0,
    );
    case["fluid"] = json!({"kind": "gas", "density_kg_m3": 1.2, "viscosity_pa_s": MU});
    let (memory, summary) = run(&case);
    let [low, high] = ["low", "high"].map(|at| last(&memory, &format!("accumulator_{at}_pressure")) + 101_325.0);
    near(
        "barometric",
        high / low,
        (-1.2 * G * height / 101_325.0_f64).exp(),
        1e-8,
    );
    assert!(
        summary.balances.energy_residual_relative.abs() < 1e-6,
        "{:?}",
        summary.balances
    );
}

/// A change of a case.
type Change<'a> = &'a dyn Fn(&mut Value);

/// The shipped case.
fn shipped() -> Value {
    serde_json::from_str(include_str!("../../cases/raised-tank.json")).unwrap()
}

/// Goal: balances close with creeping flow, inertia, losses, a check valve, compression and a rectifier; the vessel ends with the
/// pressure of the pump without flow less that of the water column.
#[test]
fn balances_close_and_the_jacobian_is_that_of_the_residual() {
    let valve = json!({"cracking_pressure_pa": 0, "forward_conductance_m3_s_pa": 1e-7, "reverse_conductance_m3_s_pa": 1e-14,
        "smoothing_pa": 100});
    let plain = |_: &mut Value| {};
    let checked = |case: &mut Value| case["network"]["tubes"][0]["check_valve"] = valve.clone();
    let compressed = |case: &mut Value| case["fluid"]["gas_fraction"] = json!(0.05);
    let turned = |case: &mut Value| {
        case["network"]["junctions"] = json!(["reservoir", "vessel", "outlet"]);
        case["network"]["ports"]
            .as_array_mut()
            .unwrap()
            .push(json!({"at": {"junction": "outlet"}, "pressure_pa": 0}));
        case["network"]["turbines"] = json!([{"from": {"junction": "vessel"}, "to": {"junction": "outlet"},
            "conductance": {"m3_s_pa": 1e-9}, "rectifier": {"check_valves": valve}}]);
    };
    let changes: [(&str, Change); 4] = [
        ("plain", &plain),
        ("check valve", &checked),
        ("gas", &compressed),
        ("turbine", &turned),
    ];
    for (what, change) in changes {
        for effects in [
            json!({"tube_inertia": "off", "tube_losses": "off"}),
            json!({"tube_inertia": "on", "unsteady_friction": "on", "tube_losses": "on"}),
            json!({"tube_inertia": "off", "tube_losses": "on"}),
        ] {
            let mut case = shipped();
            change(&mut case);
            case["effects"] = effects.clone();
            case["solver"] = json!({"rtol": 1e-9});
            case["companion"] = json!("off");
            case["time"] = json!({"end_s": 4});
            for seed in 1..=3 {
                let mut dae = BeamDae::new(System::new(&parse(&case).unwrap()).unwrap());
                dae.approach(37.0);
                let off = worst_difference(&mut dae, seed, 0.1);
                assert!(off < 1e-6, "{what} {effects} {seed}: {off:e}");
            }
            let (_, summary) = run(&case);
            let (energy, volume) = (
                summary.balances.energy_residual_relative,
                summary.balances.volume_residual_relative,
            );
            println!("{what} {effects}: {energy:e} {volume:e}");
            assert!(
                energy.abs() < 1e-6 && volume.abs() < 1e-6,
                "{what} {effects}: {energy:e} {volume:e}"
            );
        }
    }
    let rest = 29400.0 - 998.2 * G * 1.5;
    near("vessel", at_rest(&shipped(), "accumulator_vessel_pressure"), rest, 1e-3);
}
