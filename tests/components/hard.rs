//! Valves that are hard for an integrator.

use std::path::Path;

use slcbeam::case;
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::Status;

use super::run;

const PUMP: &str = include_str!("../../cases/bladder-pump.json");

/// A check valve of the pump's case, sharper and tighter.
fn sharp(tube: usize) -> String {
    format!(
        r#"/network/tubes/{tube}/check_valve={{"cracking_pressure_pa": 0, "forward_conductance_m3_s_pa": 1e-8,
            "reverse_conductance_m3_s_pa": 1e-17, "smoothing_pa": 1}}"#
    )
}

/// Goal: valves a thousand times as sharp and tight as they are in the pump's case, shaken hard, at loose and at tight tolerance, with
/// water and by each kind of method: runs end, and the balance of energy stays open by no more than the tolerance explains. Before a
/// Jacobian of another state of a valve was refused, Newton's iteration took a valve that shuts for one that does not, and energy was
/// open by all of itself.
#[test]
fn sharp_valves_chatter() {
    let (first, second) = (sharp(0), sharp(1));
    let thin = r#"/fluid={"density_kg_m3": 1000, "viscosity_pa_s": 1e-3}"#;
    for effects in [
        r#"/effects={"tube_inertia": "on", "unsteady_friction": "on", "tube_losses": "on"}"#,
        r#"/effects={"tube_inertia": "on", "unsteady_friction": "off", "tube_losses": "off"}"#,
        r#"/effects={"tube_inertia": "off", "tube_losses": "off"}"#,
        r#"/effects={"tube_inertia": "off", "tube_losses": "on"}"#,
    ] {
        for (method, rtol, most) in [
            ("ida", "1e-3", 2e-2),
            ("ida", "1e-6", 1e-4),
            ("esdirk46", "1e-3", 2e-2),
            ("esdirk46", "1e-6", 1e-4),
        ] {
            let sets = [
                first.as_str(),
                &second,
                thin,
                effects,
                &format!("/solver/method=\"{method}\""),
                &format!("/solver/rtol={rtol}"),
                "/time/end_s=0.3",
                "/ends/root/clamped/u1_m/sine/amplitude=4e-3",
            ];
            let (_, summary) = run(PUMP, &sets);
            let (energy, volume) = (
                summary.balances.energy_residual_relative,
                summary.balances.volume_residual_relative,
            );
            println!(
                "{effects} {method} {rtol}: {energy:e} {volume:e} {} steps",
                summary.solver.steps
            );
            assert!(
                energy.abs() < most && volume.abs() < 1e-10,
                "{sets:?}: {energy:e} {volume:e}"
            );
        }
    }
}

/// Goal: where valves of a bridge open within a stage Newton's iteration goes on with a matrix made on its way. (At 1e-3 the step became
/// too small before, fluid swinging along bladders; at 1e-2 it still does.)
#[test]
fn valves_open_within_a_step() {
    for rtol in [1e-1, 1e-3, 1e-4] {
        let case = case::load(
            Path::new("cases/network-tour.json"),
            &[format!("/solver/rtol={rtol:e}")],
        )
        .unwrap();
        let summary = dynamics::run(&case, &mut Memory::default()).unwrap().summary;
        assert_eq!(summary.status, Status::Finished, "{rtol:e}: {:?}", summary.reason);
    }
}
