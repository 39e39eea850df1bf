//! Source: `docs/model.md` section 7 (second order in space in all end combinations), BDF of order 2 in time.
//! Goal: observed orders of 2 for tip deflection and pressure, in space and in time, on problems with smooth solutions: motions that start
//! with a ramp, mean slopes instead of kinks.
//! Tolerance: 0.1 on an observed order. In space, all meshes use the same steps, so that the error in time cancels in differences; in time,
//! one mesh is used throughout.

use super::common::{AS_PUBLISHED, CONSERVATIVE, RECIPROCAL, Run, STEADY, difference, listed, run_shipped};

const NAMES: [&str; 4] = ["tip u1", "tip u3", "pressure of bladder 1", "pressure of bladder 10"];

fn series(run: &Run) -> [Vec<f64>; 4] {
    [
        run.column("tip_u1"),
        run.column("tip_u3"),
        run.bladder_pressure(1),
        run.bladder_pressure(10),
    ]
}

/// A root shaken for two cycles, transversely at 8 Hz or axially at 20 Hz. Steps are at most `step`, and rarely shorter; Newton's error is
/// far below that of the step.
fn smooth(case: &str, formulation: &str, step: f64, more: &[String]) -> Run {
    let (signal, end) = match case {
        "shake-wet" => ("u1_m", 0.25),
        _ => ("u3_m", 0.1),
    };
    let mut sets = vec![
        format!("/ends/root/clamped/{signal}/sine/ramp_cycles=2"),
        RECIPROCAL.into(),
        formulation.into(),
        format!("/time/end_s={end}"),
        format!("/time/output_interval_s={}", end / 20.0),
        format!("/time/fields_interval_s={}", end / 20.0),
        format!("/time/window_s={}", end / 10.0),
        "/solver/rtol=1e-2".into(),
        r#"/solver/method="ida""#.into(),
        "/solver/nonlinear_coefficient=1e-6".into(),
        format!("/solver/max_step_s={step}"),
    ];
    sets.extend_from_slice(more);
    run_shipped(case, &sets)
}

/// Meshes 2, 4, 8 and 16 cells a segment with 1, 2, 4, 8 cells a bladder: successive differences fall by four.
fn second_order_in_space(case: &str, formulation: &str) {
    let step = 5e-5;
    let meshes: Vec<[Vec<f64>; 4]> = [(2, 1), (4, 2), (8, 4), (16, 8)]
        .into_iter()
        .map(|(k, cells)| {
            let mesh = [
                format!("/mesh/cells_per_segment={k}"),
                format!("/mesh/cells_per_bladder={cells}"),
                STEADY.to_owned(),
            ];
            series(&smooth(case, formulation, step, &mesh))
        })
        .collect();
    for (q, name) in NAMES.iter().enumerate() {
        let change: Vec<f64> = meshes.windows(2).map(|m| difference(&m[0][q], &m[1][q])).collect();
        let orders: Vec<f64> = change.windows(2).map(|c| (c[0] / c[1]).log2()).collect();
        println!(
            "{case} {formulation} {name}: changes {}, orders {orders:.2?}",
            listed(&change)
        );
        for order in orders {
            assert!((order - 2.0).abs() < 0.1, "{name}: {order}");
        }
    }
}

#[test]
fn second_order_in_space_shaken_along() {
    second_order_in_space("wiring-2", CONSERVATIVE);
    second_order_in_space("wiring-2", AS_PUBLISHED);
}

/// Goal: steps halved from 1 ms to 1/16 ms at order 2 are compared with steps of 1/128 ms. Runs in which IDA chose order 1 have the error
/// of that order; they are printed and excluded.
#[test]
fn second_order_in_time_shaken_across() {
    let reference = series(&smooth("shake-wet", CONSERVATIVE, 1.0 / 128e3, &[]));
    let mut seen: Vec<(f64, Vec<f64>)> = vec![];
    for halvings in 0..5 {
        let step = 1e-3 / f64::from(1 << halvings);
        let run = smooth("shake-wet", CONSERVATIVE, step, &[]);
        let by_order = &run.summary.solver.steps_by_order;
        let now = series(&run);
        let errors: Vec<f64> = (0..NAMES.len()).map(|q| difference(&now[q], &reference[q])).collect();
        println!(
            "steps of {step:.3e} s, {by_order:?} by order: errors {}",
            listed(&errors)
        );
        if by_order[0] <= 2 {
            seen.push((step, errors));
        }
    }
    assert!(seen.len() >= 3);
    for pair in seen.windows(2) {
        for (q, name) in NAMES.iter().enumerate() {
            let order = (pair[0].1[q] / pair[1].1[q]).ln() / (pair[0].0 / pair[1].0).ln();
            println!("{name}: order {order:.2}");
            assert!((order - 2.0).abs() < 0.1, "{name}: {order}");
        }
    }
}

/// Goal: the error falls with the tolerance: as the second power of the number of steps with IDA, as the fourth with ESDIRK46. Step choices
/// scatter single pairs, so the slope is that from the loosest to the tightest tolerance.
#[test]
fn the_error_follows_the_tolerance() {
    follows_the_tolerance("ida", 2.0);
    follows_the_tolerance("esdirk46", 4.0);
}

fn follows_the_tolerance(method: &str, order: f64) {
    let at = |rtol: &str| {
        let sets = [
            "/ends/root/clamped/u1_m/sine/ramp_cycles=2",
            RECIPROCAL,
            CONSERVATIVE,
            "/time/end_s=0.25",
            "/time/output_interval_s=0.0125",
            "/time/fields_interval_s=0.0125",
            &format!("/solver/rtol={rtol}"),
            &format!(r#"/solver/method="{method}""#),
        ];
        let run = run_shipped("shake-wet", &sets);
        (run.summary.solver.steps as f64, series(&run))
    };
    let (_, exact) = at("1e-9");
    let runs: Vec<(f64, f64)> = ["1e-4", "1e-5", "1e-6", "1e-7"]
        .into_iter()
        .map(|rtol| {
            let (steps, now) = at(rtol);
            let error = difference(&now[0], &exact[0]);
            println!("{method}, rtol {rtol}: {steps} steps, error of tip u1 {error:.2e}");
            (steps, error)
        })
        .collect();
    assert!(runs.windows(2).all(|r| r[1].1 < r[0].1));
    let slope = (runs[0].1 / runs[3].1).ln() / (runs[3].0 / runs[0].0).ln();
    println!("{method}: error against steps: order {slope:.2}");
    assert!((slope / order - 1.0).abs() < 0.25, "{method}: {slope}");
}
