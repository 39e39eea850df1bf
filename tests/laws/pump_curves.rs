//! Pumps with a curve, [E87]: operating points, surge, parameters and mistakes of them and of networks without bladders.

use nalgebra::Complex;
use serde_json::{Value, json};
use slcbeam::case::Case;
use slcbeam::case::parameter::Parameter;
use slcbeam::case::schema::Effect;
use slcbeam::dae::{BeamDae, Dae as _};
use slcbeam::discrete::System;
use slcbeam::error::Error;
use slcbeam::run::dynamics;
use slcbeam::run::modes::{ModeOptions, modes};
use slcbeam::run::record::Memory;

use crate::network::{G, MU, RHO, at_rest, elastic, last, near, parse, run, still, tanks, tube};

/// Monotone cubics in Hermite's form, with the slopes of Fritsch and Butland, and straight continuations.
pub fn pchip(x: &[f64], y: &[f64], q: f64) -> f64 {
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
    let Err(Error::Case(refused)) = parse(&case).and_then(|case| System::new(&case)) else {
        panic!("no inertia")
    };
    assert!(
        refused.violations[0].what.contains("increases with flow"),
        "{:?}",
        refused.violations
    );
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
        let Err(Error::Case(refused)) = parse(&case).and_then(|case| System::new(&case)) else {
            panic!("{pointer} is accepted")
        };
        let found = refused
            .violations
            .iter()
            .any(|v| v.pointer == pointer && v.what.contains(words));
        assert!(found, "{pointer}: {:?}", refused.violations);
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
    let along = |case: &mut Value| case["effects"]["flow_along_bladders"] = json!("on");
    refused(&along, "/effects/flow_along_bladders", "no bladders");
}
