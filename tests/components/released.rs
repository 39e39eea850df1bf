//! Fluid that moves by itself: pressure that a start releases, and steady flow through a network.

use std::f64::consts::PI;

use slcbeam::case::schema::Effect;
use slcbeam::discrete::System;
use slcbeam::model::network::tube::friction_ratio;

use super::{RIG, read, run};

/// Water in the paper's beam, ten bladders in a row behind a charged vessel and a tube.
const TANK: &str = r#"{
    "name": "tank", "preset": "matia-gat-beam", "ends": {"root": "clamped", "tip": "free"},
    "network": {
        "chains": [{"bladders": [-1, -2, -3, -4, -5, -6, -7, -8, -9, -10], "ends": ["connected", "sealed"]}],
        "junctions": ["t"],
        "tubes": [{"from": {"junction": "t"}, "to": {"bladder": -1, "end": "inlet"}, "length_m": 0.2,
                   "cross_section": {"circle": {"radius_m": 0.002}}}],
        "accumulators": [{"name": "t", "at": {"junction": "t"}, "kind": {"elastic": {"compliance_m3_pa": 1e-9}}, "start_pressure_pa": 5}]
    },
    "time": {"end_s": 1.0}
}"#;

const AUTO: &str = r#"/effects="auto""#;
const WATER: &str = r#"/fluid={"density_kg_m3": 1000, "viscosity_pa_s": 1e-3}"#;
/// 1 m of 4 mm bore.
const TUBE: &str = r#"/network/tubes=[{"from": {"junction": "a"}, "to": {"junction": "b"}, "length_m": 1,
    "cross_section": {"circle": {"radius_m": 0.002}}}]"#;
const CHARGED: &str = r#"/network/accumulators=[{"name": "v", "at": {"junction": "a"}, "kind": {"elastic": {"compliance_m3_pa": 1e-9}},
    "start_pressure_pa": 5000}]"#;
const OUTLET: &str = r#"/network/ports=[{"name": "out", "at": {"junction": "b"}, "pressure_pa": 0}]"#;
const BOTH: &str = r#"/network/ports=[{"name": "in", "at": {"junction": "a"}, "pressure_pa": 5000},
    {"name": "out", "at": {"junction": "b"}, "pressure_pa": 0}]"#;
const AT_REST: &str = r#"/start={"equilibrium": {}}"#;

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// Source: the full model. Goal: the effects that are chosen follow a vessel that empties into bladders to 0.1 %; without inertia in tubes
/// pressures were 40 % lower.
#[test]
fn a_charged_vessel_drives_bladders() {
    let of = |effects: &str| run(TANK, &[effects]).1.quantities["max_pressure_pa"].max_abs.unwrap();
    let (auto, full) = (of(AUTO), of(r#"/effects="full""#));
    assert!((auto / full - 1.0).abs() < 1e-3 && full > 7.0, "{auto} {full}");
}

/// Source: the full model. Goal: the largest flow out of a vessel through a long tube, to 0.1 %; friction alone lets 3.6 times as much through.
#[test]
fn a_charged_vessel_empties_with_inertia() {
    let of = |effects: &str| {
        let sets = [
            WATER,
            TUBE,
            CHARGED,
            OUTLET,
            "/time/end_s=0.5",
            "/time/output_interval_s=0.002",
            "/solver/rtol=1e-6",
            effects,
        ];
        largest(&run(RIG, &sets).0.column("port_out_flow").unwrap())
    };
    let (auto, full) = (of(AUTO), of(r#"/effects="full""#));
    assert!((auto / full - 1.0).abs() < 1e-3, "{auto:e} {full:e}");
    assert!((auto - 8.71e-6).abs() < 0.01e-6, "{auto:e}");
}

/// Goal: every stored source of motion keeps inertia, memory and losses of flow in tubes: a charged vessel of either kind, a vessel that empties
/// into another one, and a jump of pressure into a vessel. A steady flow from port to port keeps its losses.
#[test]
fn stored_sources_keep_effects_of_flow() {
    let kept = |sets: &[&str], effects: &[Effect]| {
        let sets = [&[WATER, TUBE, AUTO], sets].concat();
        let system = System::new(&read(RIG, &sets)).unwrap();
        for &effect in effects {
            let decision = system.model.effects.decision(effect);
            assert!(decision.on, "{sets:?}: {effect} {}", decision.cause);
        }
    };
    let flow = [Effect::TubeInertia, Effect::UnsteadyFriction, Effect::TubeLosses];
    let gas = CHARGED.replace(
        r#"{"elastic": {"compliance_m3_pa": 1e-9}}"#,
        r#"{"gas": {"volume_m3": 1e-4}}"#,
    );
    let charged = r#"{"name": "v", "at": {"junction": "a"}, "kind": {"elastic": {"compliance_m3_pa": 1e-9}}, "start_pressure_pa": 5000}"#;
    let empty = r#"{"name": "w", "at": {"junction": "b"}, "kind": {"elastic": {"compliance_m3_pa": 2e-9}}}"#;
    let two = format!("/network/accumulators=[{charged}, {empty}]");
    let filled = format!("/network/accumulators=[{empty}]");
    let jump = r#"/network/ports=[{"name": "in", "at": {"junction": "a"}, "pressure_pa": {"ramp": {"to": 5000, "start_s": 0.2, "duration_s": 0}}}]"#;
    kept(&[CHARGED, OUTLET], &flow);
    kept(&[&gas, OUTLET], &flow);
    kept(&[&two], &flow);
    kept(&[&filled, jump], &flow);
    kept(&[BOTH], &flow);
    kept(&[BOTH, AT_REST], &[Effect::TubeLosses]);
}

/// Source: Churchill's friction and the losses at ends, `R q f(Re) + K ρ v²/2 = p`, solved here. Goal: a run that starts from equilibrium with a
/// steady flow has it from the first instant on, to 1e-6, with and without inertia and memory of friction.
#[test]
fn a_start_in_steady_flow_is_steady() {
    let (radius, length, pressure) = (0.002_f64, 1.0, 5000.0);
    let area = PI * radius * radius;
    let local = 1.5 * 0.5 * 1000.0 / (area * area);
    let laminar = 8.0 * 1e-3 * length / (PI * radius.powi(4));
    let drop = |q: f64| {
        let reynolds = 2.0 * 1000.0 * q / (PI * 1e-3 * radius);
        laminar * q * friction_ratio(reynolds, 0.0).0 + local * q * q
    };
    let (mut low, mut high) = (0.0, pressure / laminar);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if drop(middle) > pressure {
            high = middle
        } else {
            low = middle
        }
    }
    let named = r#"/effects={"tube_inertia": "on", "unsteady_friction": "on", "tube_losses": "on"}"#;
    for effects in [AUTO, named] {
        let sets = [
            WATER,
            TUBE,
            BOTH,
            AT_REST,
            "/network/tubes/0/loss_coefficient=1.5",
            "/time/end_s=0.5",
            effects,
        ];
        let flows = run(RIG, &sets).0.column("port_in_flow").unwrap();
        let off = flows.iter().fold(0.0, |most: f64, q| most.max((q / low - 1.0).abs()));
        println!("{effects}: {off:e} of {low:e} m^3/s");
        assert!(off < 1e-6, "{effects}: {off:e}, {low:e} {:e}", flows[0]);
    }
}
