//! Networks without bladders, pumps with a curve, [E87], and elevations, [E88]: closed forms, Kirchhoff's laws, balances, differences.
//! The remaining error is that in time: at rtol 1e-9, 1e-6. Flows without storage are exact.

use std::path::Path;

use nalgebra::{Complex, DMatrix, DVector};
use serde_json::{Value, json};
use slcbeam::case::parameter::Parameter;
use slcbeam::case::schema::Effect;
use slcbeam::case::{self, Case};
use slcbeam::dae::{BeamDae, Dae as _};
use slcbeam::discrete::System;
use slcbeam::error::{Error, Result};
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::modes::{ModeOptions, modes};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::{Status, Summary};

use crate::differences::worst_difference;

const MU: f64 = 1e-3;
const RHO: f64 = 1000.0;
const G: f64 = 9.806_65;

fn parse(value: &Value) -> Result<Case> {
    case::parse(&value.to_string(), Path::new("mine.json"), Path::new(""), &[])
}

/// A short beam at rest beside a network of creeping flow. Permeabilities `μ l_c/R` give tubes of 1 m the resistance R.
fn still(network: Value, end: f64) -> Value {
    json!({
        "name": "network", "ends": {"root": "clamped", "tip": "free"},
        "beam": {"length_m": 0.1, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1e6, "density_kg_m3": 1000},
        "fluid": {"density_kg_m3": RHO, "viscosity_pa_s": MU}, "network": network,
        "effects": {"tube_inertia": "off", "tube_losses": "off"}, "companion": "off",
        "time": {"end_s": end, "output_interval_s": end / 50.0}, "solver": {"rtol": 1e-9}
    })
}

fn tube(from: &str, to: &str, resistance: f64) -> Value {
    json!({"from": {"junction": from}, "to": {"junction": to}, "length_m": 1, "permeability_m4": MU / resistance})
}

fn elastic(at: &str, compliance: f64, start: f64) -> Value {
    json!({"name": at, "at": {"junction": at}, "kind": {"elastic": {"compliance_m3_pa": compliance}}, "start_pressure_pa": start})
}

fn run(case: &Value) -> (Memory, Summary) {
    let mut memory = Memory::default();
    let summary = dynamics::run(&parse(case).unwrap(), &mut memory).unwrap().summary;
    assert_eq!(summary.status, Status::Finished, "{:?}", summary.reason);
    (memory, summary)
}

fn last(memory: &Memory, column: &str) -> f64 {
    *memory.column(column).expect(column).last().unwrap()
}

/// Value of a column in the equilibrium at an instant.
fn at_rest(case: &Value, name: &str) -> f64 {
    let case = parse(case).unwrap();
    let path = follow(&case, &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let at = columns(&system(&case, 1.0).unwrap())
        .iter()
        .position(|c| c.name == name);
    path.last().row[at.expect(name)]
}

fn near(what: &str, ours: f64, exact: f64, within: f64) {
    assert!(
        (ours - exact).abs() <= within * exact.abs(),
        "{what}: {ours:e} for {exact:e}"
    );
}

/// Two elastic tanks, the second higher, joined by a laminar tube.
fn tanks(height: f64) -> Value {
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

/// Monotone cubics in Hermite's form, with the slopes of Fritsch and Butland, and straight continuations.
fn pchip(x: &[f64], y: &[f64], q: f64) -> f64 {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let s: Vec<f64> = y.windows(2).zip(&h).map(|(w, h)| (w[1] - w[0]) / h).collect();
    let end = |h0: f64, h1: f64, s0: f64, s1: f64| {
        let d = ((2.0 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
        match () {
            () if d * s0 <= 0.0 => 0.0,
            () if s0 * s1 < 0.0 && d.abs() > 3.0 * s0.abs() => 3.0 * s0,
            () => d,
        }
    };
    let slope = |k: usize| match k {
        0 => end(h[0], h[1], s[0], s[1]),
        k if k == n - 1 => end(h[n - 2], h[n - 3], s[n - 2], s[n - 3]),
        k if s[k - 1] * s[k] <= 0.0 => 0.0,
        k => {
            let (w0, w1) = (2.0 * h[k] + h[k - 1], h[k] + 2.0 * h[k - 1]);
            (w0 + w1) / (w0 / s[k - 1] + w1 / s[k])
        }
    };
    if q < x[0] {
        return y[0] + slope(0) * (q - x[0]);
    }
    if q > x[n - 1] {
        return y[n - 1] + slope(n - 1) * (q - x[n - 1]);
    }
    let k = (0..n - 2).find(|&k| q < x[k + 1]).unwrap_or(n - 2);
    let t = (q - x[k]) / h[k];
    let (one, two) = (1.0 - t, t * t);
    y[k] * (1.0 + 2.0 * t) * one * one + h[k] * slope(k) * t * one * one + y[k + 1] * two * (3.0 - 2.0 * t)
        - h[k] * slope(k + 1) * two * one
}

const FLOWS: [f64; 5] = [0.0, 1e-5, 3e-5, 5e-5, 6e-5];
const PRESSURES: [f64; 5] = [3e4, 2.8e4, 2e4, 9e3, 0.0];

fn pumped(resistance: f64, outlet: f64) -> Value {
    let mut tube = tube("in", "out", resistance);
    tube["pump"] = json!({"curve": {"flow_m3_s": FLOWS, "pressure_pa": PRESSURES}});
    let port = |at: &str, pressure: f64| json!({"name": at, "at": {"junction": at}, "pressure_pa": pressure});
    still(
        json!({"junctions": ["in", "out"], "tubes": [tube], "ports": [port("in", 0.0), port("out", outlet)]}),
        1.0,
    )
}

/// Goal: the operating point `f P(q) = R q + p + ρ g z` within, before and beyond the points of the curve, and its power.
#[test]
fn a_pump_works_where_its_curve_meets_the_tube() {
    for (resistance, outlet, factor, height) in [
        (2e8, 1e3, 1.0, 0.0),
        (2e8, 1e3, 0.6, 0.7),
        (1e7, -2e4, 1.0, 0.0),
        (2e8, 6e4, 1.0, 0.2),
        (2e8, 5e3, 0.0, 0.0),
    ] {
        let mut case = pumped(resistance, outlet);
        case["network"]["tubes"][0]["pump"]["curve"]["factor"] = json!(factor);
        case["network"]["elevations"] = json!([{"junction": "out", "elevation_m": height}]);
        let head = RHO * G * height;
        let over = |q: f64| factor * pchip(&FLOWS, &PRESSURES, q) - resistance * q - outlet - head;
        let (mut low, mut high) = (-1e-2, 1e-2);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if over(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let (memory, summary) = run(&case);
        let what = format!("{resistance:e} {outlet} {factor} {height}");
        near(&what, last(&memory, "tube_1_flow"), low, 1e-9);
        near(&what, last(&memory, "work_loads"), -head * low, 1e-6);
        let work = factor * pchip(&FLOWS, &PRESSURES, low) * low - outlet * low;
        near(&what, last(&memory, "work_ports"), work, 1e-6);
        assert!(summary.balances.energy_residual_relative.abs() < 1e-6, "{what}");
    }
}

/// Goal: a falling line as a curve is the linear pump, with fewer losses and less work by `R_pump q²`.
#[test]
fn a_straight_curve_is_a_linear_pump() {
    let mut line = pumped(2e8, 1e3);
    line["network"]["tubes"][0]["pump"] = json!({"curve": {"flow_m3_s": [0, 1e-4], "pressure_pa": [3e4, 1e4]}});
    let mut linear = line.clone();
    linear["network"]["tubes"][0]["pump"] = json!({"pressure_pa": 3e4, "resistance_pa_s_m3": 2e8});
    let [line, linear] = [line, linear].map(|case| run(&case).0);
    let flow = last(&line, "tube_1_flow");
    near("flow", flow, last(&linear, "tube_1_flow"), 1e-12);
    let more = last(&linear, "work_ports") - last(&line, "work_ports");
    near("work", more, 2e8 * flow * flow, 1e-7);
}

/// A pump whose pressure first rises with flow, into a vessel with an outlet of conductance `q/p`.
fn surging(outlet: f64) -> Value {
    let mut pump = tube("in", "vessel", 1e7);
    pump["pump"] =
        json!({"curve": {"flow_m3_s": [0, 2e-5, 6e-5, 8e-5, 1.2e-4], "pressure_pa": [1e4, 1.1e4, 2e4, 2e4, 0]}});
    let port = |at: &str| json!({"name": at, "at": {"junction": at}, "pressure_pa": 0});
    let network = json!({"junctions": ["in", "vessel", "out"], "tubes": [pump, tube("vessel", "out", 1.0 / outlet)],
        "accumulators": [elastic("vessel", 1e-8, 0.0)], "ports": [port("in"), port("out")]});
    let mut case = still(network, 60.0);
    case["effects"] = json!({"tube_losses": "off", "unsteady_friction": "off"});
    case["start"] = json!({"equilibrium": {"loads_at_s": 0}});
    case
}

/// Source: Greitzer, J. Eng. Power 98 (1976) 190, linearised: `I q' = (P' - R) q - p`, `C p' = q - G p`. Goal: growth and frequency at an
/// operating point on the rising branch; inertia cannot be omitted there.
#[test]
fn a_rising_curve_is_unstable_as_greitzer_says() {
    // an outlet through which 4e-5 m^3/s flows at the pressure of the curve, less that in the tube
    let (x, y) = ([0.0, 2e-5, 6e-5, 8e-5, 1.2e-4], [1e4, 1.1e4, 2e4, 2e4, 0.0]);
    let flow = 4e-5;
    let pressure = pchip(&x, &y, flow) - 1e7 * flow;
    let outlet = flow / pressure;
    let mut case = surging(outlet);
    // the second tube is short of inertia: its conductance is that of creeping flow
    case["network"]["tubes"][1]["length_m"] = json!(1e-6);
    case["network"]["tubes"][1]["permeability_m4"] = json!(MU * 1e-6 * outlet);
    let parsed = parse(&case).unwrap();
    let system = System::new(&parsed).unwrap();
    let decision = system.model.effects.decision(Effect::TubeInertia);
    assert!(
        decision.on && decision.cause.to_string().contains("pump"),
        "{}",
        decision.cause
    );
    near("flow", at_rest(&case, "accumulator_vessel_pressure"), pressure, 1e-8);
    let wet = system.model.wet.as_ref().unwrap();
    let pump = wet.network.links.iter().find(|link| link.pump.is_some()).unwrap();
    let inertance = pump.tube.unwrap().law.inertance;
    let slope = (pchip(&x, &y, flow + 1e-9) - pchip(&x, &y, flow - 1e-9)) / 2e-9 - 1e7;
    let (a, d) = (slope / inertance, -outlet / 1e-8);
    let inner = Complex::new((0.5 * (a - d)).powi(2) - 1.0 / (inertance * 1e-8), 0.0);
    let root = inner.sqrt() + 0.5 * (a + d);
    let plan = ModeOptions {
        count: 2,
        near_hz: root.im.abs() / std::f64::consts::TAU,
        limits: false,
    };
    let found = modes(&parsed, &plan).unwrap();
    let ours = found.modes.iter().map(|mode| mode.s);
    let ours = ours
        .min_by(|p, q| (p - root).norm().total_cmp(&(q - root).norm()))
        .unwrap();
    assert!(
        root.re > 0.0 && (ours - root).norm() < 1e-4 * root.norm(),
        "{ours} {root}"
    );
    case["effects"]["tube_inertia"] = json!("off");
    let Err(Error::Case(told)) = parse(&case).and_then(|case| System::new(&case)) else {
        panic!("no inertia")
    };
    assert!(
        told.violations[0].what.contains("increases with flow"),
        "{:?}",
        told.violations
    );
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
    let changes: [(&str, &dyn Fn(&mut Value)); 4] = [
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

/// Goal: elevations and points of a curve are parameters; their changes move the operating point.
#[test]
fn numbers_of_the_network_are_parameters() {
    let mut case = pumped(2e8, 1e3);
    case["network"]["elevations"] = json!([{"junction": "out", "elevation_m": 0.5}]);
    let case = parse(&case).unwrap();
    let flow = |case: &Case| {
        let mut memory = Memory::default();
        dynamics::run(case, &mut memory).unwrap();
        last(&memory, "tube_1_flow")
    };
    for (pointer, sign) in [
        ("/network/elevations/0/elevation_m", -1.0),
        ("/network/tubes/0/pump/curve/pressure_pa/2", 1.0),
        ("/network/tubes/0/pump/curve/flow_m3_s/2", 1.0),
    ] {
        let parameter = Parameter::number("--vary", &case, pointer).unwrap();
        let more = flow(&parameter.changed(&case, 1.1 * parameter.value).unwrap()) - flow(&case);
        assert!(sign * more > 0.0, "{pointer}: {more:e}");
    }
}

/// Goal: equal heights add no unknown, and every mistake is explained at its place.
#[test]
fn mistakes_are_explained() {
    let len = |case: &Value| BeamDae::new(System::new(&parse(case).unwrap()).unwrap()).len();
    assert_eq!(len(&tanks(0.0)), len(&tanks(1.0)));
    let refused = |change: &dyn Fn(&mut Value), pointer: &str, words: &str| {
        let mut case = pumped(2e8, 1e3);
        change(&mut case);
        let Err(Error::Case(told)) = parse(&case).and_then(|case| System::new(&case)) else {
            panic!("{pointer} is accepted")
        };
        let found = told
            .violations
            .iter()
            .any(|v| v.pointer == pointer && v.what.contains(words));
        assert!(found, "{pointer}: {:?}", told.violations);
    };
    const PUMP: &str = "/network/tubes/0/pump";
    let elevate = |heights: Value| move |case: &mut Value| case["network"]["elevations"] = heights.clone();
    let curve = |key: &'static str, value: Value| {
        move |case: &mut Value| case["network"]["tubes"][0]["pump"]["curve"][key] = value.clone()
    };
    let pump = |key: &'static str, value: Value| {
        move |case: &mut Value| case["network"]["tubes"][0]["pump"][key] = value.clone()
    };
    let set = |key: &'static str, value: Value| move |case: &mut Value| case[key] = value.clone();
    let at = |name: &str, height: f64| json!({"junction": name, "elevation_m": height});
    refused(
        &elevate(json!([at("tank", 1.0)])),
        "/network/elevations/0/junction",
        "not declared",
    );
    refused(
        &elevate(json!([at("in", 1.0), at("in", 2.0)])),
        "/network/elevations/1",
        "a second elevation",
    );
    refused(
        &elevate(json!([at("in", 1e300)])),
        "/network/elevations/0/elevation_m",
        "",
    );
    refused(&pump("pressure_pa", json!(1e3)), PUMP, "both a pressure and a curve");
    refused(
        &|case| case["network"]["tubes"][0]["pump"] = json!({}),
        PUMP,
        "without pressure",
    );
    refused(
        &pump("resistance_pa_s_m3", json!(1e3)),
        "/network/tubes/0/pump/resistance_pa_s_m3",
        "beside a curve",
    );
    refused(
        &curve("flow_m3_s", json!([0, 1])),
        "/network/tubes/0/pump/curve/flow_m3_s",
        "2 flows for 5 pressures",
    );
    refused(
        &curve("flow_m3_s", json!([0, 1, 1, 2, 3])),
        "/network/tubes/0/pump/curve/flow_m3_s/2",
        "flow 1 after flow 1",
    );
    refused(
        &curve("flow_m3_s", json!([0, 1e-300, 1, 2, 3])),
        "/network/tubes/0/pump/curve/flow_m3_s",
        "too close",
    );
    refused(
        &curve("pressure_pa", json!([1e300, 0, 0, 0, 0])),
        "/network/tubes/0/pump/curve/factor",
        "pumps generate",
    );
    let rising = |case: &mut Value| {
        case["fluid"]["density_kg_m3"] = json!(0);
        case["network"]["tubes"][0]["pump"]["curve"]["pressure_pa"] = json!([1, 2, 3, 2, 1]);
    };
    refused(&rising, "/network/tubes/0/pump/curve", "without mass");
    refused(&set("fluid", json!(null)), "/network", "without a fluid");
    refused(
        &set("network", json!({"junctions": []})),
        "/network",
        "without bladders, tubes and turbines",
    );
    let kappa = |case: &mut Value| {
        case["network"]["turbines"] =
            json!([{"from": {"junction": "in"}, "to": {"junction": "out"}, "conductance": {"kappa": {"kappa": 1}}}]);
    };
    refused(&kappa, "/network/turbines/0/conductance", "without bladders");
    let bladder = |case: &mut Value| case["network"]["tubes"][0]["to"] = json!({"bladder": 1, "end": "inlet"});
    refused(&bladder, "/network/tubes/0/to/bladder", "the case has no bladders");
    let flow = |case: &mut Value| {
        case["network"]["ports"][0] = json!({"at": {"junction": "in"}, "flow_m3_s": 1e6});
    };
    refused(&flow, "/network/ports/0/flow_m3_s", "pumps deliver");
}
