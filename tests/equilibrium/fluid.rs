//! Equilibria with fluid, and runs that start from them.

use std::f64::consts::PI;

use serde_json::json;
use slcbeam::case::Case;
use slcbeam::dae::{Dae as _, Seeds, StaticBeam};
use slcbeam::discrete::start;
use slcbeam::run::equilibrium::{EquilibriumOptions, system};
use slcbeam::run::record::Memory;
use slcbeam::run::{dynamics, summary::Status};

use crate::common::{path_of, shipped, solved};

/// Goal: the exact tangent. The static Jacobian, including volumes of closed networks, agrees with fourth-order differences.
#[test]
fn static_jacobian_is_that_of_differences() {
    for name in [
        "wiring-3",
        "network-tour",
        "harvester-crossover-wave",
        "curl",
        "ring-network",
    ] {
        let case = shipped(name, &[]);
        let of = system(&case, case.time.end_s).unwrap();
        let mut beam = slcbeam::dae::BeamDae::new(of.clone());
        let (inside, now) = beam.instant(0.0);
        let rest = start::state(inside, &case, now);
        let mut statics = StaticBeam::from_nothing(of, &rest, &[]);
        let n = statics.len();
        let y: Vec<f64> = (0..n).map(|k| 0.03 * (1.7 * k as f64).sin()).collect();
        let mut values = vec![0.0; statics.pattern().entries()];
        statics
            .jacobian(0.7, &y, &[], Seeds::Step { cj: 0.0 }, &mut values)
            .expect("a Jacobian");
        let pattern = statics.pattern().clone();
        let mut at: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; n]);
        for column in (0..n).step_by(7) {
            let step = 5e-6;
            for (at, steps) in at.iter_mut().zip([-2.0, -1.0, 1.0, 2.0]) {
                let mut moved = y.clone();
                moved[column] += steps * step;
                statics.residual(0.7, &moved, &[], at).expect("a residual");
            }
            let mut exact = vec![0.0; n];
            for entry in pattern.column(column) {
                exact[pattern.rows[entry] as usize] = values[entry];
            }
            let size = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for row in 0..n {
                let [before, below, above, beyond] = at.each_ref().map(|r| r[row]);
                let difference = (8.0 * (above - below) - (beyond - before)) / (12.0 * step);
                // rounding errors of the residuals, 1e-16 of their size, over a step; the fifth derivative is smaller
                assert!(
                    (difference - exact[row]).abs() < 1e-6 * size.max(1.0),
                    "{name}: {row}, {column}: {difference:e} instead of {:e}",
                    exact[row]
                );
            }
        }
    }
}

/// Goal: a steady flow is an equilibrium, too. Ports of different pressures drive fluid through the chain; the pressures satisfy
/// Kirchhoff's equations, linear along equal resistances.
#[test]
fn steady_streaming_is_an_equilibrium() {
    let case = shipped(
        "wiring-2",
        &[
            "/network/chains/1/ends=[{\"pressure_pa\":1000},{\"pressure_pa\":0}]",
            "/bladders/coupling=\"reciprocal\"",
            "/ends/root=\"clamped\"",
        ],
    );
    let (path, last) = solved(&case);
    // The center of the first cell is a quarter of a bladder's resistance behind the port: 1/4 of 19 resistances.
    let resistances = 10.0 + 9.0 * (0.020 / 6.72e-13) / (0.046 / 1.55e-12);
    let first = 1000.0 * (1.0 - 0.25 / resistances);
    assert!(
        (last("max_pressure") / first - 1.0).abs() < 1e-6,
        "{} {first}",
        last("max_pressure")
    );
    assert!(path.last().stability.is_some_and(|s| s.unstable == 0));
}

/// Goal: 400 bladders within a second: 23 Newton steps measured, some milliseconds each.
#[test]
fn four_hundred_bladders_take_few_newton_steps() {
    let upper: Vec<i64> = (1..=200).collect();
    let lower: Vec<i64> = upper.iter().map(|b| -b).collect();
    let case = shipped(
        "curl",
        &[
            "/beam/length_m=2.0",
            "/bladders/per_row=200",
            &format!(
                "/network/chains={}",
                json!([
                    {"bladders": upper, "ends": [{"pressure_pa": 50000}, "sealed"]},
                    {"bladders": lower, "ends": ["sealed", "sealed"]},
                ])
            ),
        ],
    );
    let (path, last) = solved(&case);
    assert!(last("tip_angle").abs() > 1.0, "{}", last("tip_angle"));
    assert!(path.work.factorizations < 60, "{:?}", path.work);
}

/// Goal: pressure curls an actuator by more than half a turn from rest.
#[test]
fn actuator_curls_beyond_half_a_turn() {
    let (path, last) = solved(&shipped("curl", &[]));
    assert!(last("tip_angle").abs() > PI, "{}", last("tip_angle"));
    assert!(path.events.is_empty());
}

/// Goal: a run that starts in equilibrium remains there, whatever effects it omits: velocities are rounding errors of the solution, 1e-10
/// of the deflection times the first frequencies.
#[test]
fn run_stays_in_its_equilibrium() {
    for effects in [
        "\"full\"",
        "\"auto\"",
        "{\"finite_rotation\":\"off\"}",
        "{\"network_pressure_differences\":\"off\"}",
    ] {
        let case = shipped(
            "pluck",
            &[
                "/ends/tip={\"free\":{\"force_x_n\":0.5}}",
                "/start={\"equilibrium\":{},\"pressures\":[{\"bladders\":[1,2,3,4,5,6,7,8,9,10],\"pressure_pa\":2000}]}",
                "/time/end_s=0.05",
                &format!("/effects={effects}"),
            ],
        );
        let mut record = Memory::default();
        let outcome = dynamics::run(&case, &mut record).expect("memory");
        assert_eq!(outcome.summary.status, Status::Finished, "{:?}", outcome.summary.reason);
        let tip = record.column("tip_u1").expect("a column");
        let pressure = record.column("max_pressure").expect("a column");
        assert!(tip[0].abs() > 1e-3 && pressure[0] > 1000.0);
        for (now, first) in [(&tip, tip[0]), (&pressure, pressure[0])] {
            let moved = now.iter().fold(0.0_f64, |m, x| m.max((x / first - 1.0).abs()));
            assert!(moved < 1e-6, "{effects}: {moved:e}");
        }
    }
}

/// Goal: a held beam is released. The run begins bent by the force before t = 0, with the energy of that state.
#[test]
fn plucked_beam_is_let_go() {
    let case = shipped("pluck", &["/time/end_s=0.1"]);
    let mut record = Memory::default();
    let outcome = dynamics::run(&case, &mut record).expect("memory");
    assert_eq!(outcome.summary.status, Status::Finished);
    let held = path_of(&case, &EquilibriumOptions::at(-1.0));
    let tip = record.column("tip_u1").expect("a column");
    let last = held.last().u1.last().copied().expect("a node");
    assert!((tip[0] / last - 1.0).abs() < 1e-9, "{} {last}", tip[0]);
    assert!(outcome.summary.balances.energy_residual_relative < 1e-3);
    assert!(tip.iter().any(|u| u * last < 0.0), "it swings through");
}

/// Goal: fluid that only enters leaves no equilibrium; equal inflow and outflow do.
#[test]
fn closed_network_that_is_fed_is_refused() {
    let with = |outlet: &str| {
        let ends = format!("/network/chains/1/ends=[{{\"flow_m3_s\":1e-7}},{outlet}]");
        let case = shipped("pluck", &[&ends, "/start={}"]);
        path_of(&case, &EquilibriumOptions::at(case.time.end_s))
    };
    let fault = with("\"sealed\"").fault.expect("no equilibrium");
    assert!(fault.what.contains("1.000e-7 m^3/s"), "{}", fault.what);
    assert!(with("{\"flow_m3_s\":-1e-7}").fault.is_none());
    assert!(with("{\"pressure_pa\":0}").fault.is_none());
}

/// Goal: a flow at the zero of its sine counts as none, though rounding leaves 1e-16 of its size. The fluid that entered before remains:
/// that of half a period, a/(pi f), as if a port prescribed it. Before, the equilibrium was rejected, as the network took in 1.2e-22 m^3/s.
#[test]
fn a_flow_at_its_zero_is_none() {
    let at = |port: serde_json::Value, at: f64| {
        let chains = format!("/network/chains/0/ends/0={port}");
        path_of(
            &shipped("pluck", &[&chains, "/start={}", "/time/end_s=2"]),
            &EquilibriumOptions::at(at),
        )
    };
    let pumped = json!({"flow_m3_s": {"sine": {"amplitude": 1e-7 * PI, "frequency_hz": 0.5}}});
    let (pumps, still) = (at(pumped.clone(), 0.5), at(pumped, 1.0));
    assert!(pumps.fault.is_some() && still.fault.is_none(), "{:?}", still.fault);
    let held = at(json!({"volume_m3": {"ramp": {"to": 2e-7, "duration_s": 0.5}}}), 1.0);
    for (a, b) in still.last().row.iter().zip(&held.last().row).skip(1).take(3) {
        assert!((a / b - 1.0).abs() < 1e-9, "{a:e} {b:e}");
    }
}

/// An actuator behind a check valve that opens at once, with an almost closed outlet; `more` changes it.
fn behind_check_valve(smoothing_pa: f64, reverse: f64, more: &[&str]) -> Case {
    let circle = |radius: f64| json!({"circle": {"radius_m": radius}});
    let case = json!({
        "name": "checked", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"},
        "network": {
            "chains": [
                {"bladders": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], "ends": ["connected", "sealed"]},
                {"bladders": [-1, -2, -3, -4, -5, -6, -7, -8, -9, -10], "ends": [{"pressure_pa": 0}, "sealed"]}
            ],
            "junctions": ["a", "b", "o"],
            "tubes": [
                {"from": {"junction": "a"}, "to": {"bladder": 1, "end": "inlet"}, "length_m": 0.02, "cross_section": circle(3e-4)},
                {"from": {"junction": "b"}, "to": {"junction": "a"}, "length_m": 1, "cross_section": circle(2e-3),
                 "check_valve": {"cracking_pressure_pa": 0, "forward_conductance_m3_s_pa": 3e-8,
                                 "reverse_conductance_m3_s_pa": reverse, "smoothing_pa": smoothing_pa}},
                {"from": {"junction": "a"}, "to": {"junction": "o"}, "length_m": 0.02, "cross_section": circle(3e-4), "opening": 0.01}
            ],
            "ports": [
                {"name": "o", "at": {"junction": "o"}, "pressure_pa": 0},
                {"name": "b", "at": {"junction": "b"}, "pressure_pa": 4e4}
            ]
        },
        "beam": {"damping": {"bending_time_s": 1e-3, "axial_time_s": 1e-4}},
        "fluid": {"viscosity_pa_s": 0.01, "density_kg_m3": 970},
        "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 3}
    });
    let sets: Vec<String> = more.iter().map(ToString::to_string).collect();
    let path = std::path::Path::new("test.json");
    slcbeam::case::parse(&case.to_string(), path, std::path::Path::new(""), &sets).expect("a valid case")
}

/// Goal: for a valve that opens over a pressure far below the acting ones, with conductances of any size, the path is found. The pressure
/// behind the valve is that of tube, valve and outlet in series, `p - p_a = q/G_t + sqrt(2 w q/G_f)` with `q = G_o p_a`.
#[test]
fn a_valve_opens_over_a_small_part_of_the_pressure() {
    let poiseuille = |radius: f64, length: f64| PI * radius.powi(4) / (8.0 * 0.01 * length);
    for (smoothing, reverse) in [(5.0, 1e-14), (5.0, 1e-12), (0.05, 1e-14), (5e3, 1e-17)] {
        for more in [&[][..], &["/loads=[{\"gravity\": {\"x_m_s2\": -9.81}}]"]] {
            let (path, at) = solved(&behind_check_valve(smoothing, reverse, more));
            let pushed = 4e4;
            let outlet = 0.01 * poiseuille(3e-4, 0.02);
            let mut behind = pushed;
            for _ in 0..100 {
                let flow = outlet * behind;
                behind = pushed - flow / poiseuille(2e-3, 1.0) - (2.0 * smoothing * flow / 3e-8).sqrt();
            }
            let found = at("max_pressure");
            assert!(
                (found - behind).abs() < 2e-4 * behind,
                "w {smoothing}, G_r {reverse:e}: {found} instead of {behind}"
            );
            assert!(path.states.len() < 100, "{} states", path.states.len());
        }
    }
}

/// Goal: a pump before the valve gives the same pressure as its port.
#[test]
fn a_pump_opens_a_valve_over_a_small_part_of_its_pressure() {
    let pump = "/network/tubes/1/pump={\"pressure_pa\": 4e4, \"resistance_pa_s_m3\": 1e3}";
    let pumped = behind_check_valve(5.0, 1e-14, &["/network/ports/1/pressure_pa=0", pump]);
    let [by_port, by_pump] = [behind_check_valve(5.0, 1e-14, &[]), pumped].map(|case| solved(&case).1("max_pressure"));
    assert!((by_pump / by_port - 1.0).abs() < 1e-6, "{by_pump} {by_port}");
}
