//! Cycles with a period of several drive periods.
//!
//! A cantilever axially shaken at its root at twice its first frequency. The straight beam is an unstable cycle of one period; the beam
//! oscillates transversely over two, with an amplitude limited by drag.

use std::f64::consts::{PI, TAU};

use serde_json::json;
use slcbeam::case::{self, Case};
use slcbeam::run::dynamics;
use slcbeam::run::floquet::{self, CycleStability};
use slcbeam::run::modes::{self, ModeOptions};
use slcbeam::run::periodic::subharmonic::{self, Periods};
use slcbeam::run::periodic::{Cycle, PeriodicScene, record};
use slcbeam::run::record::Memory;
use slcbeam::run::summary::Status;

const LENGTH: f64 = 0.2;
const HEIGHT: f64 = 1e-3;
const WIDTH: f64 = 0.02;
const DENSITY: f64 = 2700.0;
/// Damping ratio of the first mode.
const DAMPING: f64 = 0.004;
const DRAG: f64 = 1.2;

/// The beam, shaken at a frequency [Hz] with a stiffness modulation ε.
fn shaken(frequency: f64, first: f64, epsilon: f64, start: f64) -> Case {
    // ε = κ U Ω²/(l ω²), [E39]
    let amplitude = epsilon * LENGTH * (first / frequency).powi(2) / 1.57087818999;
    let value = json!({
        "name": "shaken",
        "beam": {"length_m": LENGTH, "height_m": HEIGHT, "width_m": WIDTH, "young_modulus_pa": 7e10, "density_kg_m3": DENSITY,
                 "damping": {"bending_time_s": 2.0 * DAMPING / (TAU * 20.57), "axial_time_s": 1e-6, "quadratic_drag_n_s2_m3": DRAG}},
        "ends": {"root": {"clamped": {"u3_m": {"sine": {"amplitude": amplitude, "frequency_hz": frequency, "ramp_cycles": 1}}}}, "tip": "free"},
        "start": {"u1_m": {"polynomial": {"coefficients": [0, 0, start]}}},
        "formulation": "conservative", "effects": "full",
        "mesh": {"segments": 16, "cells_per_segment": 1},
        "solver": {"rtol": 1e-6},
        "time": {"end_s": 1.0}
    });
    case::parse(&value.to_string(), "test.json".as_ref(), "".as_ref(), &[]).expect("a valid case")
}

/// The first frequency of the mesh [Hz].
fn first() -> f64 {
    let about = modes::linearise(&shaken(41.0, 20.5, 1e-6, 0.0), 0.0, None).expect("a state");
    let plan = ModeOptions {
        count: 1,
        near_hz: 20.0,
        limits: false,
    };
    modes::compute(about, &plan).expect("modes").modes[0]
        .frequency_hz()
        .expect("a swing")
}

/// Largest deflection of the tip over a cycle.
fn swing(case: &Case, scene: &PeriodicScene, cycle: &Cycle) -> f64 {
    let mut period = Memory::default();
    let outcome = record::record(case, scene, cycle, &mut period).expect("memory");
    assert_eq!(outcome.summary.status, Status::Finished);
    largest(&period.column("tip_u1").expect("a column"))
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// Source: Mathieu's equation with damping ζ and drag, `q'' + 2 ζ ω q' + δ |q'| q' + ω² (1 - ε cos 2pt) q = 0`, averaged over a period
/// (Nayfeh & Mook 1979, chapter 5). Drag acts like a damping rate `4 δ a p/3π`; in the steady state it and ζω balance the energy input by
/// shaking:
///
/// ```text
/// (ζ ω + 4 δ a p/3π)² + ((ω² - p²)/2p)² = (ε ω²/4p)²        δ = (c₂/m) ∫φ³/∫φ², φ = 1 at the tip
/// ```
///
/// Goal: at p = ω and beside it the cycle of two periods has that amplitude. Tolerance 2 %: averaging neglects terms of the order of ε =
/// 0.06 relative to one, halved here as harmonics of the motion do not meet its base at first order.
#[test]
fn doubled_period_has_the_averaged_amplitude() {
    let f = first();
    let beta = 1.875104068712_f64;
    let sigma = (beta.cosh() + beta.cos()) / (beta.sinh() + beta.sin());
    let shape = |x: f64| {
        let b = beta * x;
        0.5 * (b.cosh() - b.cos() - sigma * (b.sinh() - b.sin()))
    };
    let mean = |power: i32| {
        (0..2000)
            .map(|k| shape((f64::from(k) + 0.5) / 2000.0).powi(power))
            .sum::<f64>()
            / 2000.0
    };
    let delta = DRAG / (DENSITY * WIDTH * HEIGHT) * mean(3) / mean(2);
    let (epsilon, w) = (0.06, TAU * f);
    for ratio in [1.0, 1.006] {
        let case = shaken(2.0 * f * ratio, f, epsilon, 0.0);
        let (scene, mut cycle, periods) = subharmonic::find(&case, 2).expect("a cycle");
        assert_eq!((periods.asked, periods.shortest, periods.beside), (2, 2, true));
        let p = w * ratio;
        let fed = (epsilon * w * w / (4.0 * p)).powi(2) - ((w * w - p * p) / (2.0 * p)).powi(2);
        let exact = (fed.sqrt() - DAMPING * w) * 3.0 * PI / (4.0 * delta * p);
        let found = swing(&case, &scene, &cycle);
        println!(
            "ratio {ratio}: {found:e} m, averaged {exact:e}, off by {:.2e}; {}",
            found / exact - 1.0,
            periods.describe()
        );
        assert!((found / exact - 1.0).abs() < 0.02, "{ratio}: {found:e} {exact:e}");
        let verdict = floquet::multipliers(&scene, &mut cycle, 4).verdict;
        assert_eq!(verdict.stability, CycleStability::Stable, "{}", verdict.words);
    }
}

/// Goal: a run ends on that cycle. The transient decays at (ε/4 - ζ) ω = 1.4 1/s, over 6 s to 2e-4; the amplitude is sampled to 1e-4; the
/// run has rtol 1e-8, since steps at 1e-6 damp the oscillation by 1.8e-3. Tolerance: 1e-3 of the amplitude.
#[test]
fn a_long_run_ends_on_the_doubled_period() {
    let f = first();
    let mut case = shaken(2.0 * f, f, 0.06, 2e-3);
    let (scene, cycle, _) = subharmonic::find(&case, 2).expect("a cycle");
    let exact = swing(&case, &scene, &cycle);
    case.time.end_s = 6.0;
    case.solver.rtol = 1e-8;
    case.time.output_interval_s = Some(1.0 / (200.0 * f));
    let mut long = Memory::default();
    let outcome = dynamics::run(&case, &mut long).expect("memory");
    assert_eq!(outcome.summary.status, Status::Finished);
    let tip = long.column("tip_u1").expect("a column");
    let found = largest(&tip[tip.len() - 210..]);
    println!("{found:e} {exact:e}, off by {:.1e}", found / exact - 1.0);
    assert!((found / exact - 1.0).abs() < 1e-3, "{found:e} {exact:e}");
}

/// Goal: if the cycle of one period is stable and attracts the start of the case, the command finds and reports it; an invalid number of
/// periods is rejected.
#[test]
fn a_cycle_of_one_period_is_told_as_one() {
    let f = first();
    let case = shaken(2.0 * f, f, 0.008, 1e-3);
    let (_, _, periods) = subharmonic::find(&case, 2).expect("a cycle");
    assert_eq!((periods.asked, periods.shortest, periods.beside), (2, 1, false));
    assert!(periods.describe().contains("every period"), "{}", periods.describe());
    for wrong in [0, 65] {
        let error = subharmonic::find(&case, wrong).err().expect("refused").to_string();
        assert!(error.contains("from 1 to 64"), "{error}");
    }
    let told = Periods { shortest: 2, ..periods };
    assert!(told.describe().contains("after 2 periods"));
}
