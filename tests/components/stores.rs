//! Accumulators, and ports that prescribe volumes.

use std::f64::consts::{PI, TAU};

use slcbeam::numerics::gauss::Gauss;
use slcbeam::run::equilibrium;
use slcbeam::run::modes::{self, ModeOptions};
use slcbeam::run::record::Control;

use super::valves::{fluid, resistance};
use super::{RIG, apart, read, run};

const HELD: &str = r#"/network/ports=[{"name": "source", "at": {"junction": "a"}, "pressure_pa": 20000}]"#;

/// Source: `t = ∫ R dV/(P - p(V))`, p of gas above the fluid, by quadrature. Goal: the time at which each volume is reached, 1e-6 of the
/// run, for isothermal and polytropic gas; elastic walls fill exponentially.
#[test]
fn vessels_fill_as_their_laws_say() {
    let resistance = resistance(fluid().1);
    let gauss = Gauss::new(16);
    for exponent in [1.0, 1.4] {
        let vessel = format!(
            r#"/network/accumulators=[{{"name": "vessel", "at": {{"junction": "b"}}, "kind": {{"gas": {{"volume_m3": 5e-5, "polytropic_exponent": {exponent}}}}}}}]"#
        );
        let (memory, summary) = run(
            RIG,
            &[HELD, &vessel, "/time/end_s=0.15", "/time/output_interval_s=0.005"],
        );
        let slowness = |v: f64| {
            let pressure = 101_325.0 * ((1.0 - v / 5e-5).powf(-exponent) - 1.0);
            resistance / (20_000.0 - pressure)
        };
        let (times, volumes) = (
            memory.column("t").unwrap(),
            memory.column("accumulator_vessel_volume").unwrap(),
        );
        let reached: Vec<f64> = volumes
            .iter()
            .map(|v| {
                let pieces = 64;
                let width = v / f64::from(pieces);
                let piece = |k: i32| {
                    let on = gauss.on(f64::from(k) * width, f64::from(k + 1) * width);
                    on.map(|(v, weight)| weight * slowness(v)).sum::<f64>()
                };
                (0..pieces).map(piece).sum()
            })
            .collect();
        let off = apart(&reached, &times);
        assert!(volumes.last().unwrap() > &1e-6, "{volumes:?}");
        assert!(off < 1e-6, "n = {exponent}: {off:e}");
        assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
    }
    let elastic = r#"/network/accumulators=[{"at": {"junction": "b"}, "kind": {"elastic": {"compliance_m3_pa": 4e-11}}, "start_pressure_pa": 5000}]"#;
    let (memory, _) = run(RIG, &[HELD, elastic]);
    let exact: Vec<f64> = memory
        .column("t")
        .unwrap()
        .iter()
        .map(|t| 20_000.0 - 15_000.0 * (-t / (resistance * 4e-11)).exp())
        .collect();
    let off = apart(&memory.column("accumulator_b_pressure").unwrap(), &exact);
    assert!(off < 1e-6, "{off:e}");
}

/// Source: `ω² = (1/C_a + 1/C_b)/I`, damped by `R/(2I)`. Goal: fluid swings between two vessels so, in a run 1e-6 and as a mode 1e-9.
#[test]
fn fluid_swings_between_two_vessels() {
    let vessels = r#"/network/accumulators=[
        {"at": {"junction": "a"}, "kind": {"elastic": {"compliance_m3_pa": 1e-11}}, "start_pressure_pa": 100},
        {"at": {"junction": "b"}, "kind": {"elastic": {"compliance_m3_pa": 3e-11}}}]"#;
    let inertial = r#"/effects={"tube_inertia": "on", "unsteady_friction": "off", "tube_losses": "off"}"#;
    let thin = "/fluid/viscosity_pa_s=1e-3";
    let (memory, summary) = run(RIG, &[vessels, inertial, thin]);
    let inertance = 4.0 / 3.0 * fluid().0 * 0.1 / (PI * 1e-6);
    let (stiffness, decay) = (1.0 / 1e-11 + 1.0 / 3e-11, 0.5 * resistance(1e-3) / inertance);
    let omega = (stiffness / inertance - decay * decay).sqrt();
    assert!(omega > 3.0 * decay, "{omega} {decay}");
    // volumes swing about the common pressure
    let common = 100.0 * 1e-11 / 4e-11;
    let exact: Vec<f64> = memory
        .column("t")
        .unwrap()
        .iter()
        .map(|t| {
            let swing = (-decay * t).exp() * ((omega * t).cos() + decay / omega * (omega * t).sin());
            common + (100.0 - common) * swing
        })
        .collect();
    let off = apart(&memory.column("accumulator_a_pressure").unwrap(), &exact);
    assert!(off < 1e-6, "{off:e}");
    assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
    let plan = ModeOptions {
        count: 1,
        near_hz: omega / TAU,
        limits: false,
    };
    let found = modes::modes(&read(RIG, &[vessels, inertial, thin]), &plan)
        .unwrap()
        .modes[0]
        .s;
    assert!(
        (found.im.abs() / omega - 1.0).abs() < 1e-9 && (-found.re / decay - 1.0).abs() < 1e-8,
        "{found}"
    );
}

/// Goal: what a syringe presses into a vessel is what that holds, and its port tells its power: the rate of the vessel's energy.
/// Tolerance: volumes are exact; work is an integral over the few steps that a syringe alone asks for, some thousand times rtol.
#[test]
fn a_syringe_presses_its_volume_in() {
    let syringe = r#"/network/ports=[{"name": "syringe", "at": {"junction": "a"}, "volume_m3":
        {"ramp": {"from": 0, "to": 1e-8, "start_s": 0.2, "duration_s": 0.3, "shape": "smooth"}}}]"#;
    let vessel = r#"/network/accumulators=[{"name": "vessel", "at": {"junction": "a"}, "kind": {"elastic": {"compliance_m3_pa": 1e-12}}}]"#;
    let shut = "/network/tubes/0/opening=0";
    let far = r#"/network/ports/-={"at": {"junction": "b"}, "pressure_pa": 0}"#;
    let (memory, summary) = run(RIG, &[syringe, vessel, shut, far]);
    let exact: Vec<f64> = memory
        .column("t")
        .unwrap()
        .iter()
        .map(|t| {
            let x = ((t - 0.2) / 0.3).clamp(0.0, 1.0);
            // the smooth ramp's polynomial
            1e-8 * x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x)
        })
        .collect();
    let held = memory.column("accumulator_vessel_volume").unwrap();
    let told = memory.column("port_syringe_volume").unwrap();
    let off = [apart(&held, &exact), apart(&told, &exact)];
    println!("{off:?}");
    let pressure: Vec<f64> = held.iter().map(|v| v / 1e-12).collect();
    assert!(apart(&memory.column("port_syringe_pressure").unwrap(), &pressure) < 1e-9);
    assert!(off[0] < 1e-14 && off[1] < 1e-14, "{off:?}");
    assert!(
        summary.balances.energy_residual_relative.abs() < 3e-6,
        "{:e}",
        summary.balances.energy_residual_relative
    );
}

/// Goal: the equilibrium of a beam that a syringe has bent is where a run with damping comes to rest, 1e-6, volumes told alike; with
/// accumulators that were full at the start among what is joined.
#[test]
fn equilibrium_knows_volumes() {
    let text = include_str!("../../cases/syringe-finger.json");
    let sets = [
        "/network/accumulators/0/start_pressure_pa=500",
        "/beam/damping={\"bending_time_s\": 0.02, \"axial_time_s\": 0.02}",
        "/time/end_s=8",
        "/solver/rtol=1e-9",
        "/effects=\"full\"",
    ];
    let (memory, _) = run(text, &sets);
    let case = read(text, &sets);
    let found = equilibrium::follow(&case, &equilibrium::EquilibriumOptions::at(8.0), &mut |_| {
        Control::Continue
    })
    .unwrap();
    let last = found.last();
    let columns = equilibrium::columns(&equilibrium::system(&case, 8.0).unwrap());
    for name in [
        "tip_u1",
        "tip_u3",
        "max_pressure",
        "port_syringe_pressure",
        "accumulator_line_volume",
    ] {
        let at_rest = columns
            .iter()
            .zip(&last.row)
            .find(|(column, _)| column.name == name)
            .unwrap()
            .1;
        let end = *memory.column(name).unwrap().last().unwrap();
        println!("{name} {at_rest:e} {end:e}");
        assert!((at_rest / end - 1.0).abs() < 1e-6, "{name}: {at_rest:e} {end:e}");
    }
}
