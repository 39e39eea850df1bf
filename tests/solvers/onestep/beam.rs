//! The beam with one-step methods: same answers as IDA, same bits after a checkpoint, closed balances.

use std::path::Path;

use slcbeam::case::{self, Case};
use slcbeam::discrete::System;
use slcbeam::run::{dynamics, record::Memory, summary::Status};

fn load(name: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    let path = format!("cases/{name}.json");
    case::load(Path::new(&path), &sets).unwrap()
}

fn run(case: &Case) -> (Memory, dynamics::Outcome) {
    let mut memory = Memory::default();
    let outcome = dynamics::run(case, &mut memory).unwrap();
    assert_eq!(outcome.summary.status, Status::Finished, "{:?}", outcome.fault);
    (memory, outcome)
}

const COARSE: [&str; 2] = ["/mesh/cells_per_segment=2", "/mesh/cells_per_bladder=1"];

/// Goal: two cases of the paper, with impulsive starts. Tolerance: local errors of 1e-7 over some thousand steps; 2e-4 of the largest value
/// leaves a margin for the phase of fast waves.
#[test]
fn answers_are_those_of_ida() {
    for (name, end) in [("wiring-2", "/time/end_s=0.05"), ("valves-open", "/time/end_s=0.05")] {
        let solve = |method: &str| {
            let method = format!("/solver/method=\"{method}\"");
            let sets = [
                COARSE[0],
                COARSE[1],
                end,
                "/solver/rtol=1e-7",
                &method,
                "/time/window_s=0.01",
            ];
            run(&load(name, &sets)).0
        };
        let ida = solve("ida");
        for method in ["esdirk34", "esdirk46"] {
            let other = solve(method);
            for column in ["tip_u1 [m]", "tip_u3 [m]", "max_pressure [Pa]"] {
                let column = column.split(' ').next().unwrap();
                let (a, b) = (ida.column(column).unwrap(), other.column(column).unwrap());
                let size = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                let apart = a.iter().zip(&b).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()));
                assert!(
                    apart <= 2e-4 * size,
                    "{name}, {method}, {column}: {apart:e} of {size:e}"
                );
            }
        }
    }
}

/// Goal: a run continued from a checkpoint repeats the uninterrupted one bit for bit; its summary names the method.
#[test]
fn resumed_runs_repeat_uninterrupted_ones() {
    for method in ["trbdf2", "esdirk34", "esdirk46", "esdirk57"] {
        let method = format!("/solver/method=\"{method}\"");
        let sets = [
            COARSE[0],
            COARSE[1],
            "/time/end_s=0.1",
            "/time/checkpoint_interval_s=0.03",
            &method,
        ];
        let case = load("wiring-2", &sets);
        let (whole, outcome) = run(&case);
        assert_eq!(whole.checkpoints.len(), 3);
        for checkpoint in &whole.checkpoints {
            let mut rest = Memory::default();
            let resumed = dynamics::resume(&case, System::new(&case).unwrap(), checkpoint, &mut rest).unwrap();
            assert_eq!(whole.rows[checkpoint.next_output as usize..], rest.rows[..]);
            assert_eq!(outcome.summary.balances, resumed.summary.balances);
            assert_eq!(outcome.summary.solver, resumed.summary.solver);
        }
        let chosen = &outcome.summary.effects["method"];
        assert_eq!(chosen.reason, "as requested");
        assert_eq!(
            outcome.summary.effects["max_order"].value,
            outcome.summary.solver.max_order.to_string()
        );
    }
}

/// Goal: residuals of the ledger are integration errors: a thousandth of the tolerance leaves at most a fiftieth. Closed networks keep
/// their volume at any tolerance: 1e-10 is the rounding of some thousand steps.
#[test]
fn balances_close_with_the_tolerance() {
    for method in ["esdirk34", "esdirk46"] {
        let residual = |rtol: &str| {
            let (method, rtol) = (format!("/solver/method=\"{method}\""), format!("/solver/rtol={rtol}"));
            let sets = [COARSE[0], COARSE[1], "/time/end_s=0.1", &method, &rtol];
            let balances = run(&load("shaken-sealed", &sets)).1.summary.balances;
            assert!(balances.closed_volume_residual_relative < 1e-10, "{balances:?}");
            balances.energy_residual_relative
        };
        let (loose, tight) = (residual("1e-3"), residual("1e-6"));
        assert!(tight < 0.02 * loose, "{method}: {loose:e} {tight:e}");
    }
}
