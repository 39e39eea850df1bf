//! Long undamped motion: energy, steps, rejections.

use std::f64::consts::PI;
use std::path::Path;

use slcbeam::case;
use slcbeam::onestep::tableau::TableauMethod;
use slcbeam::run::record::Memory;
use slcbeam::run::{dynamics, summary::Status};

/// First mode of a continuous cantilever at the nodes of eight cells [m]; tip 1e-5 m.
const CONTINUOUS: &str =
    "[0, 2.5893634e-7, 9.7285808e-7, 2.048379e-6, 3.3952311e-6, 4.929465e-6, 6.577473e-6, 8.2805824e-6, 1e-5]";
/// First mode of the discrete beam at the same nodes [m].
const DISCRETE: &str = "[0, 2.7030191956e-7, 9.8929692637e-7, 2.0656657939e-6, 3.410812361e-6, 4.9420336476e-6, 6.5864694025e-6, 8.2855887495e-6, 1e-5]";

/// Angular frequency of this mode on the mesh [1/s], from `slcbeam modes`.
const OMEGA: f64 = 2.0 * PI * 12.176;

/// A run of a released cantilever.
struct Released {
    steps: f64,
    rejected: f64,
    /// Relative change of the stored energy.
    gain: f64,
}

/// Releases the dry cantilever with eight cells from a shape.
fn release(shape: &str, effects: &str, rtol: f64, end: f64) -> Released {
    let sets = [
        r#"/mesh={"segments":8,"cells_per_segment":1}"#.to_owned(),
        format!("/effects={effects}"),
        format!(
            r#"/start/u1_m={{"table":{{"positions":[0,0.125,0.25,0.375,0.5,0.625,0.75,0.875,1],"values":{shape}}}}}"#
        ),
        format!("/time/end_s={end}"),
        format!("/time/output_interval_s={}", end / 10.0),
        r#"/solver/method="esdirk46""#.to_owned(),
        format!("/solver/rtol={rtol:e}"),
    ];
    let case = case::load(Path::new("cases/dry-cantilever.json"), &sets).unwrap();
    let mut memory = Memory::default();
    let summary = dynamics::run(&case, &mut memory).unwrap().summary;
    assert_eq!(summary.status, Status::Finished);
    let stored: Vec<Vec<f64>> = ["kinetic_energy", "rotary_energy", "axial_energy", "bending_energy"]
        .into_iter()
        .filter_map(|name| memory.column(name))
        .collect();
    let at = |row: usize| stored.iter().map(|column| column[row]).sum::<f64>();
    Released {
        steps: summary.solver.steps as f64,
        rejected: summary.solver.error_test_failures as f64,
        gain: at(stored[0].len() - 1) / at(0) - 1.0,
    }
}

/// Goal: the remainder of Newton's iteration adds no energy to undamped motion, at any tolerance, for a start with one mode or all.
/// Tolerance: rounding over some 1e4 steps.
#[test]
fn undamped_motion_gains_no_energy() {
    for (shape, effects) in [
        (CONTINUOUS, r#"{"finite_rotation":"off","axial_inertia":"off"}"#),
        (DISCRETE, r#"{"finite_rotation":"off","axial_stretch":"off"}"#),
    ] {
        let mut before = f64::INFINITY;
        for rtol in [1e-4, 1e-5, 1e-6] {
            let gain = release(shape, effects, rtol, 25.0).gain;
            println!("{effects} rtol {rtol:e}: energy {gain:+.2e}");
            assert!(gain < 1e-10, "{effects}, rtol {rtol:e}: energy grows by {gain:e}");
            assert!(
                -gain < 0.5 * before,
                "{effects}, rtol {rtol:e}: {gain:e} after {before:e}"
            );
            before = -gain;
        }
    }
}

/// Goal: one mode loses exactly the energy of the method's damping: `1 - |R(i h ω)|²` per step. Steps follow the order: a tenfold tolerance
/// changes their number by `10^(1/4) = 1.8`, up to 2.5 since step sizes below 1.5 times the last are not used; none is rejected.
///
/// Tolerance: 20 %, since the loss is proportional to the sixth power of the step and of the frequency, which is known to 0.5 %.
#[test]
fn one_mode_loses_the_energy_that_the_method_takes() {
    let tableau = TableauMethod::Esdirk46.tableau();
    let mut before: Option<f64> = None;
    for rtol in [1e-4, 1e-5, 1e-6] {
        let end = 25.0;
        let run = release(
            DISCRETE,
            r#"{"finite_rotation":"off","axial_inertia":"off"}"#,
            rtol,
            end,
        );
        let (re, im) = tableau.stability((0.0, OMEGA * end / run.steps));
        let expected = re.hypot(im).powf(2.0 * run.steps) - 1.0;
        println!(
            "rtol {rtol:e}: {} steps, energy {:+.3e}, by the method {expected:+.3e}",
            run.steps, run.gain
        );
        assert!(
            (run.gain / expected - 1.0).abs() < 0.2,
            "rtol {rtol:e}: {:e} {expected:e}",
            run.gain
        );
        assert!(
            run.rejected <= 0.01 * run.steps,
            "rtol {rtol:e}: {} rejected",
            run.rejected
        );
        if let Some(before) = before {
            let ratio = run.steps / before;
            assert!((1.5..2.5).contains(&ratio), "rtol {rtol:e}: {ratio} times the steps");
        }
        before = Some(run.steps);
    }
}

/// Goal: error estimates of superposed oscillations fluctuate, but few steps are rejected because of it. A start by `u1` alone excites
/// axial waves of 1e-8 of the length; steps do not resolve them to the tolerance of bending.
#[test]
fn superposed_waves_reject_few_steps() {
    for (what, shape, effects, rtol, end, most) in [
        (
            "bending",
            CONTINUOUS,
            r#"{"finite_rotation":"off","axial_inertia":"off"}"#,
            1e-6,
            8.0,
            40_000.0,
        ),
        (
            "small rotations",
            DISCRETE,
            r#"{"finite_rotation":"off"}"#,
            1e-5,
            10.0,
            4_000.0,
        ),
        (
            "finite rotations",
            CONTINUOUS,
            r#"{"finite_rotation":"on"}"#,
            1e-5,
            10.0,
            8_000.0,
        ),
    ] {
        let run = release(shape, effects, rtol, end);
        println!(
            "{what}: {} steps, {} rejected, energy {:+.2e}",
            run.steps, run.rejected, run.gain
        );
        assert!(
            run.rejected < 0.04 * run.steps,
            "{what}: {} of {} rejected",
            run.rejected,
            run.steps
        );
        assert!(run.steps < most, "{what}: {} steps", run.steps);
        assert!(run.gain < 1e-10, "{what}: energy grows by {:e}", run.gain);
    }
}
