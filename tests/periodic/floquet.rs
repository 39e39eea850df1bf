//! Floquet multipliers: the derivative of the period map, Mathieu's equation, modes of undriven cases.

use std::f64::consts::TAU;
use std::path::Path;

use nalgebra::Complex;
use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::error::Error;
use slcbeam::model::characteristic::{MATHIEU_COUPLING, mathieu_growth};
use slcbeam::run::floquet::{self, CycleStability, Floquet, shape::EnergyPart};
use slcbeam::run::modes;
use slcbeam::run::periodic::{PeriodicScene, scene, shoot};
use slcbeam::study::effects::full_model::{full, full_of};

fn case_of(value: &Value) -> Case {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), &[]).unwrap()
}

fn shipped(name: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    case::load(format!("cases/{name}.json").as_ref(), &sets).unwrap()
}

fn stability(case: &Case, period: Option<f64>, count: usize) -> (PeriodicScene, Floquet) {
    let scene = PeriodicScene::new(case, period).unwrap();
    let mut cycle = shoot(&scene, None).unwrap();
    let found = floquet::multipliers(&scene, &mut cycle, count);
    (scene, found)
}

/// A dry cantilever with length, mass and bending stiffness of one, axially stiff.
fn dry(cells: usize, damping_s: f64, u3: Value) -> Value {
    json!({
        "name": "dry",
        "beam": {
            "length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4,
            "damping": {"bending_time_s": damping_s}
        },
        "ends": {"root": {"clamped": {"u3_m": u3}}, "tip": "free"},
        "effects": {"rotary_inertia": "off"},
        "mesh": {"segments": cells, "cells_per_segment": 1},
        "time": {"end_s": 1.0},
        "solver": {"rtol": 1e-6}
    })
}

const FIRST: f64 = 1.875_104_068_712;

/// Shaken at `ratio` of twice the first frequency, so that the squared frequency is modulated by `epsilon`.
fn shaken(cells: usize, damping_s: f64, ratio: f64, epsilon: f64) -> Value {
    let omega = 2.0 * FIRST * FIRST * ratio;
    let amplitude = epsilon * FIRST.powi(4) / MATHIEU_COUPLING / (omega * omega);
    dry(
        cells,
        damping_s,
        json!({"sine": {"amplitude": amplitude, "frequency_hz": omega / TAU}}),
    )
}

/// Goal: the derivative is that of the map. Central differences with a step d have errors of d² times third derivatives, and of rounding
/// over d: 1e-6 of the largest at d = 1e-5 for a map that is smooth on the scale of its unknowns.
#[test]
fn carried_disturbances_are_differences_of_the_period_map() {
    // the published coupling has sharp kinks in the area laws; here there are none
    let case = shipped(
        "wiring-2",
        &["/mesh/cells_per_segment=2", "/bladders/coupling=\"reciprocal\""],
    );
    let scene = PeriodicScene::new(&case, None).unwrap();
    let mut start = scene.guess.clone();
    for (k, y) in start.iter_mut().enumerate() {
        *y += 0.01 * (k as f64).sin();
    }
    let mut march = scene.map(scene.dae(), &start).unwrap();
    let n = start.len();
    let mut go = |d: &[f64], sign: f64| {
        let (mut y, mut yp) = (start.clone(), vec![0.0; n]);
        y.iter_mut().zip(d).for_each(|(y, d)| *y += sign * 1e-5 * d);
        march.go(&mut y, &mut yp, &mut |_, _, _| {}).unwrap();
        y
    };
    let mut d: Vec<f64> = (0..n).map(|k| (1.0 + 3.7 * k as f64).cos()).collect();
    scene.admit(&mut d);
    let (ahead, behind) = (go(&d, 1.0), go(&d, -1.0));
    go(&d, 0.0);
    let mut difference: Vec<f64> = ahead.iter().zip(&behind).map(|(a, b)| (a - b) / 2e-5).collect();
    scene.admit(&mut difference);
    march.propagate(&mut d);
    scene.admit(&mut d);
    let largest = d.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for k in 0..n {
        let gap = (d[k] - difference[k]).abs() / largest;
        assert!(
            gap < 1e-6,
            "{}: {} against {}",
            scene.system.layout.name(k),
            d[k],
            difference[k]
        );
    }
}

/// Goal: closed volumes are conserved: left vectors of M with multiplier one, removed by `admit`.
#[test]
fn conserved_volumes_are_multipliers_of_one() {
    let case = shipped("wiring-2", &["/mesh/cells_per_segment=2"]);
    let scene = PeriodicScene::new(&case, None).unwrap();
    assert_eq!(scene.conserved.len(), 1, "the sealed chain; the other is open");
    let mut march = scene.map(scene.dae(), &scene.guess).unwrap();
    let (mut y, mut yp) = (scene.guess.clone(), vec![0.0; scene.guess.len()]);
    march.go(&mut y, &mut yp, &mut |_, _, _| {}).unwrap();
    let w = &scene.conserved[0];
    let dot = |a: &[f64]| a.iter().zip(w).map(|(a, w)| a * w).sum::<f64>();
    let mut d: Vec<f64> = (0..y.len()).map(|k| (2.0 + 1.3 * k as f64).cos()).collect();
    let before = dot(&d);
    march.propagate(&mut d);
    // rounding errors of some hundred solutions
    assert!((dot(&d) - before).abs() < 1e-9 * before.abs(), "{} {before}", dot(&d));
    assert!((dot(&y) - dot(&scene.guess)).abs() < 1e-10);
}

/// Source: single-mode Mathieu equation with modal damping ζ: its growth is that of the undamped one with `ω²(1 - ζ²)`, less ζ ω. Goal:
/// growth in the tongue. Tolerance: a mesh of 24 cells has the frequency to (β h)²/3 = 2e-3. The growth in the middle of the tongue has the
/// same relative error; off the middle, at 0.02 of a half width of 0.05, ten times as much. The second mode adds (ε ω1/ω2)² = 1e-3.
#[test]
fn growth_in_the_tongue_is_mathieus() {
    let (zeta, epsilon, w) = (0.01, 0.2, FIRST * FIRST);
    for ratio in [0.98, 1.0, 1.02] {
        let (_, found) = stability(&case_of(&shaken(24, 2.0 * zeta / w, ratio, epsilon)), None, 6);
        let exact = mathieu_growth(w * w * (1.0 - zeta * zeta), epsilon * w * w, 2.0 * w * ratio) - zeta * w;
        let first = &found.multipliers[0];
        assert!(
            (first.growth_per_s / exact - 1.0).abs() < if ratio == 1.0 { 5e-3 } else { 3e-2 },
            "{ratio}: {} against {exact}",
            first.growth_per_s
        );
        assert_eq!(first.part, EnergyPart::Bending(1));
        assert_eq!(found.verdict.stability, CycleStability::Unstable);
        assert!(
            found
                .verdict
                .words
                .starts_with("parametric resonance of mode 1 (subharmonic"),
            "{}",
            found.verdict.words
        );
        // numerical damping of the steps is negligible
        assert!(first.numerical_damping_per_s < 1e-4 * exact);
    }
}

/// Goal: outside the tongue the damped beam is stable and decays at ζ ω, to the square of the modulation.
#[test]
fn beside_the_tongue_disturbances_decay() {
    let (zeta, w) = (0.01, FIRST * FIRST);
    let (_, found) = stability(&case_of(&shaken(24, 2.0 * zeta / w, 1.15, 0.2)), None, 6);
    assert_eq!(found.verdict.stability, CycleStability::Stable);
    assert!(
        (found.verdict.growth_per_s / (-zeta * w) - 1.0).abs() < 0.05,
        "{}",
        found.verdict.words
    );
    // without damping nothing decays, and nothing grows
    let (_, found) = stability(&case_of(&shaken(24, 0.0, 1.15, 0.2)), None, 6);
    assert_eq!(
        found.verdict.stability,
        CycleStability::Neutral,
        "{}",
        found.verdict.words
    );
}

/// Source: `exp(s T)` of the modes of the linearized equations, an eigenvalue problem without steps. Tolerance: the error of steps of order
/// four in a phase of ω T, which the error test bounds only for the motion: the comparison includes modes that turn by less than half a
/// radian per step.
#[test]
fn multipliers_of_what_nothing_drives_are_those_of_its_modes() {
    let mut value = serde_json::to_value(shipped("wiring-2", &["/mesh/cells_per_segment=2"])).unwrap();
    value["ends"]["root"] = json!("clamped");
    value["bladders"]["coupling"] = json!("reciprocal");
    let case = case_of(&value);
    let period = 0.02;
    let (_, found) = stability(&case, Some(period), 14);
    assert!(!found.driven);
    let plan = modes::ModeOptions {
        count: 60,
        near_hz: 0.0,
        limits: false,
    };
    let rates = modes::modes(&case, &plan).unwrap();
    let exact: Vec<Complex<f64>> = rates.modes.iter().map(|m| (m.s * period).exp()).collect();
    let mut compared = 0;
    for m in &found.multipliers {
        let value = Complex::new(m.re, m.im);
        let gap = |e: &Complex<f64>| (e - value).norm().min((e.conj() - value).norm());
        let nearest = exact.iter().map(gap).fold(f64::INFINITY, f64::min);
        if m.modulus > 0.01 && m.frequency_hz * TAU * period < 16.0 {
            assert!(nearest < 2e-4, "{value} is no exp(s T): {nearest:e}");
            compared += 1;
        }
    }
    assert!(compared >= 3, "{compared}");
}

/// Goal: a case without a period is rejected, with the reason.
#[test]
fn what_has_no_period_is_refused() {
    let refusal = |u3: Value, period| match PeriodicScene::new(&case_of(&dry(10, 0.0, u3)), period) {
        Err(Error::Usage(words)) => words,
        other => panic!("{:?}", other.map(|_| ())),
    };
    let sine = |f: f64| json!({"sine": {"amplitude": 1e-3, "frequency_hz": f}});
    assert!(refusal(json!(0.0), None).contains("--period"));
    assert!(refusal(json!({"polynomial": {"coefficients": [0.0, 0.1]}}), None).contains("polynomial"));
    assert!(refusal(json!({"sum": [sine(1.0), sine(std::f64::consts::SQRT_2)]}), None).contains("common period"));
    assert!(refusal(sine(1.0), Some(0.3)).contains("a period of its own"));
    assert!(refusal(json!(0.0), Some(-1.0)).contains("> 0"));
    // a smooth start and a ramp that ends both come to rest
    let ramp = json!({"sum": [{"ramp": {"to": 0.01, "duration_s": 2.0}}, sine(4.0)]});
    let scene = PeriodicScene::new(&case_of(&dry(10, 0.0, ramp)), None).unwrap();
    assert_eq!(scene.drive.period, 0.25);
}

/// Goal: the axial motion has its own frequency for any drive, not one shifted by a multiple of the drive's. Sealed bladders stiffen the
/// beam axially by a third compared with the dry one; `modes` gives the frequency at rest. Shaken by half a millimeter the frequency agrees
/// to 1 %.
#[test]
fn the_motion_along_the_beam_keeps_its_frequency() {
    let at_rest = shipped("shaken-sealed", &["/ends/root/clamped/u3_m=0"]);
    let plan = modes::ModeOptions {
        count: 4,
        near_hz: 90.0,
        limits: false,
    };
    let found = modes::modes(&at_rest, &plan).unwrap();
    let along = found
        .modes
        .iter()
        .filter(|mode| mode.kind.swings() && mode.shape.transverse() < 0.5);
    let own = along
        .filter_map(|mode| mode.frequency_hz())
        .fold(f64::INFINITY, f64::min);
    assert!((own - 100.0).abs() < 2.0, "{own}");
    for drive in [22.5, 60.0, 84.0] {
        let sets = [
            format!("/ends/root/clamped/u3_m/sine/frequency_hz={drive}"),
            "/ends/root/clamped/u3_m/sine/amplitude=0.0005".into(),
        ];
        let case = shipped("shaken-sealed", &sets.each_ref().map(String::as_str));
        let (_, found) = stability(&case, None, 5);
        let named = found
            .multipliers
            .iter()
            .find(|m| m.part == EnergyPart::Along)
            .expect("one of them");
        assert!((named.frequency_hz / own - 1.0).abs() < 0.01, "{drive}: {named:?}");
    }
}

/// Goal: mode 1 keeps its name at resonance with large bending. Before, with the stretch along the straight axis instead of the tangents,
/// it was called axial motion (92 %), with an aliased frequency.
#[test]
fn a_mode_of_a_bent_beam_keeps_its_name() {
    for frequency in ["12.3", "13.25"] {
        let drive = format!("/ends/root/clamped/u1_m/sine/frequency_hz={frequency}");
        let sets = ["/mesh/cells_per_segment=1", "/mesh/cells_per_bladder=1", &drive];
        let (_, found) = stability(&shipped("tour-wiring", &sets), None, 2);
        let first = &found.multipliers[0];
        assert!(
            first.part == EnergyPart::Bending(1) && first.share > 0.9,
            "{frequency}: {first:?}"
        );
        // near a mode of 12.4 Hz, within the shift by a drive of this strength
        assert!((first.frequency_hz - 12.4).abs() < 0.4, "{frequency}: {first:?}");
    }
}

/// Goal: cycles and multipliers have no error by effects left out, since their model has every effect that a run leaves out.
#[test]
fn cycles_leave_no_effect_out() {
    let mut left_out = 0;
    for entry in std::fs::read_dir("cases").unwrap().map(|entry| entry.unwrap().path()) {
        let is_case = entry.extension().is_some_and(|x| x == "json") && !entry.ends_with("schema.json");
        let Some(case) = is_case.then(|| case::load(&entry, &[]).ok()).flatten() else {
            continue;
        };
        left_out += usize::from(full(&case).unwrap().is_some());
        let found = full_of(&case, &scene::whole).unwrap();
        assert!(found.is_none(), "{}: {:?}", case.name, found.map(|full| full.left_out));
    }
    assert!(left_out >= 5, "{left_out} cases leave an effect out");
}
