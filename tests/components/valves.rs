//! Valves that open by themselves, and pumps.

use std::f64::consts::{PI, TAU};

use slcbeam::model::network::CheckValveLaw;

use super::{RIG, apart, integrated, run};

/// As the cases below write it.
const VALVE: CheckValveLaw = CheckValveLaw {
    cracking_pressure: 100.0,
    forward: 2e-9,
    reverse: 1e-11,
    width: 50.0,
};
const WRITTEN: &str = r#"/network/tubes/0/check_valve={"cracking_pressure_pa": 100, "forward_conductance_m3_s_pa": 2e-9,
    "reverse_conductance_m3_s_pa": 1e-11, "smoothing_pa": 50}"#;
const SWINGS: &str = r#"/network/ports=[{"name": "source", "at": {"junction": "a"}, "pressure_pa": {"sine": {"amplitude": 1000, "frequency_hz": 5}}}]"#;
const VESSEL: &str = r#"/network/accumulators=[{"name": "vessel", "at": {"junction": "b"}, "kind": {"elastic": {"compliance_m3_pa": 4e-11}}}]"#;

/// `8 μ l/(π r⁴)` of the rig's tube.
pub fn resistance(viscosity: f64) -> f64 {
    8.0 * viscosity * 0.1 / (PI * 1e-12)
}

pub fn fluid() -> (f64, f64) {
    let fluid = super::read(RIG, &[SWINGS]).fluid.unwrap();
    (fluid.density_kg_m3, fluid.viscosity_pa_s)
}

/// Source: `C p' = q(P sin ωt - p)`, q of the valve in series with the tube, integrated here. Goal: 1e-6 of the pressure of a vessel that
/// is filled through a check valve by a pressure that swings.
#[test]
fn a_swinging_pressure_fills_a_vessel() {
    let (memory, summary) = run(RIG, &[WRITTEN, SWINGS, VESSEL, "/solver/rtol=1e-11"]);
    let resistance = resistance(fluid().1);
    let exact = integrated(&memory.column("t").unwrap(), 400, |t, [p]| {
        let drop = 1000.0 * (TAU * 5.0 * t).sin() - p;
        [VALVE.flow_behind(resistance, drop) / 4e-11]
    });
    let exact: Vec<f64> = exact.iter().map(|[p]| *p).collect();
    let off = apart(&memory.column("accumulator_vessel_pressure").unwrap(), &exact);
    assert!(exact.last().unwrap() > &300.0, "{exact:?}");
    assert!(off < 1e-6, "{off:e}");
    assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
}

/// The same with the inertia of the fluid, `I q' + R q + Δ(q) = P sin ωt - p`, `C p' = q`: the valve shuts against flow. Goal: 1e-5.
#[test]
fn inertia_shuts_a_valve_late() {
    let inertial = r#"/effects={"tube_inertia": "on", "unsteady_friction": "off", "tube_losses": "off"}"#;
    let (memory, summary) = run(RIG, &[WRITTEN, SWINGS, VESSEL, inertial]);
    let (density, viscosity) = fluid();
    let (resistance, inertance) = (resistance(viscosity), 4.0 / 3.0 * density * 0.1 / (PI * 1e-6));
    let exact = integrated(&memory.column("t").unwrap(), 4000, |t, [p, q]| {
        let drop: f64 = VALVE.drop(q);
        let rate = (1000.0 * (TAU * 5.0 * t).sin() - p - drop - resistance * q) / inertance;
        [q / 4e-11, rate]
    });
    let exact: Vec<f64> = exact.iter().map(|[p, _]| *p).collect();
    let off = apart(&memory.column("accumulator_vessel_pressure").unwrap(), &exact);
    println!("{off:e} {:e}", summary.balances.energy_residual_relative);
    assert!(off < 1e-5, "{off:e}");
    assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
}

/// Source: by hand. A pump at a standstill presses its whole pressure; through a tube `q = p_pump/(R + R_pump)`; a relief valve beside it
/// takes what is beyond. Goal: 1e-8 of the flows.
#[test]
fn a_pump_works_against_a_relief_valve() {
    let pump = r#"/network/tubes/0/pump={"pressure_pa": 2000, "resistance_pa_s_m3": 3e9}"#;
    let back = r#"/network/tubes/-={"from": {"junction": "b"}, "to": {"junction": "a"}, "length_m": 0.1,
        "cross_section": {"circle": {"radius_m": 1e-3}}, "loss_coefficient": 0,
        "check_valve": {"cracking_pressure_pa": 900, "forward_conductance_m3_s_pa": 2e-9, "reverse_conductance_m3_s_pa": 1e-14, "smoothing_pa": 50}}"#;
    let drain = r#"/network/ports=[{"name": "tank", "at": {"junction": "a"}, "pressure_pa": 0}]"#;
    let (memory, summary) = run(RIG, &[pump, back, drain, VESSEL]);
    let resistance = resistance(fluid().1);
    let relief = CheckValveLaw {
        cracking_pressure: 900.0,
        reverse: 1e-14,
        ..VALVE
    };
    let exact = integrated(&memory.column("t").unwrap(), 400, |_, [p]| {
        let pumped = (2000.0 - p) / (resistance + 3e9);
        [(pumped - relief.flow_behind(resistance, p)) / 4e-11]
    });
    let exact: Vec<f64> = exact.iter().map(|[p]| *p).collect();
    let ours = memory.column("accumulator_vessel_pressure").unwrap();
    let off = apart(&ours, &exact);
    assert!(off < 1e-6, "{off:e}");
    // the valve holds the pressure within what its conductances leave, far below the pump's
    let end = *ours.last().unwrap();
    assert!(end > 900.0 && end < 1200.0, "{end}");
    // the pump's work is put in, and nothing comes through the port in the end
    assert!(*memory.column("work_ports").unwrap().last().unwrap() > 0.0);
    assert!(memory.column("port_tank_flow").unwrap().last().unwrap().abs() < 1e-12);
    assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
}
