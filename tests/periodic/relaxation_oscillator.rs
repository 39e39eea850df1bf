//! Self-oscillation of a network: a supply fills a bag until a dome snaps and opens a valve, which empties the bag until it snaps back.

use std::path::Path;

use nalgebra::{Complex, Matrix2};
use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::dynamics;
use slcbeam::run::energies::open_over_window;
use slcbeam::run::floquet::{self, CycleStability};
use slcbeam::run::modes::{self, ModeOptions};
use slcbeam::run::periodic::{record, scene, subharmonic};
use slcbeam::run::record::{Control, Memory, Unrecorded};
use slcbeam::run::summary::Status;
use slcbeam::study::analysis::{AnalysisKind, AnalysisRequest, found};

/// Resistances of supply, valve and dome [Pa s/m^3]; compliance of the bag [m^3/Pa].
const SUPPLY: f64 = 4e9;
const VALVE: f64 = 2e8;
const DOME: f64 = 2e8;
const BAG: f64 = 8e-11;
/// Points of the dome's pressure over volume: it snaps at 40 and at 15 kPa.
const VOLUMES: [f64; 4] = [0.0, 3e-8, 9e-8, 1.2e-7];
const PRESSURES: [f64; 4] = [0.0, 4e4, 1.5e4, 4e4];
/// Volumes between which the valve opens.
const OPENING: [f64; 2] = [4e-8, 8e-8];

/// The network under a supply pressure; the volumes of the dome are multiplied by `size`.
fn oscillator([supply, size, resistance]: [f64; 3], [end, rtol]: [f64; 2]) -> Case {
    let tube = |from: &str, to: &str, resistance: f64| json!({"from": {"junction": from}, "to": {"junction": to}, "length_m": 1, "permeability_m4": 1e-3 / resistance});
    let mut valve = tube("bag", "out", VALVE);
    let [closed, open] = OPENING.map(|volume| volume * size);
    valve["pilot"] = json!({"vessel": "dome", "closed_at_m3": closed, "open_at_m3": open});
    let volumes = VOLUMES.map(|volume| volume * size);
    let port = |at: &str, pressure: f64| json!({"name": at, "at": {"junction": at}, "pressure_pa": pressure});
    let case: Value = json!({
        "name": "oscillator", "ends": {"root": "clamped", "tip": "free"},
        "beam": {"length_m": 0.1, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1e6, "density_kg_m3": 1000,
            "damping": {"bending_time_s": 1e-2, "axial_time_s": 1e-2}},
        "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": 1e-3},
        "network": {
            "junctions": ["pump", "bag", "dome", "out"],
            "tubes": [tube("pump", "bag", SUPPLY), tube("bag", "dome", resistance), valve],
            "ports": [port("pump", supply), port("out", 0.0)],
            "accumulators": [
                {"name": "bag", "at": {"junction": "bag"}, "kind": {"elastic": {"compliance_m3_pa": BAG}}},
                {"name": "dome", "at": {"junction": "dome"}, "kind": {"curve": {"volume_m3": volumes, "pressure_pa": PRESSURES}}}]
        },
        "effects": {"tube_inertia": "off", "tube_losses": "off"}, "companion": "off",
        "mesh": {"segments": 2, "cells_per_segment": 1},
        "time": {"end_s": end, "output_interval_s": end / 2000.0}, "solver": {"rtol": rtol}
    });
    case::parse(&case.to_string(), Path::new("oscillator.json"), Path::new(""), &[]).unwrap()
}

/// Source: as the dome shrinks, its snaps are sudden, and the bag of capacity C relaxes exponentially between the two pressures: to that
/// of the supply `P` with `R C`, and behind the open valve to `P R_v/(R + R_v)` with `C R R_v/(R + R_v)`. The passage of a fold delays each
/// snap in proportion to `size^(2/3)` (Kuehn 2015, fast-slow fold).
/// Goal: the period tends to the sum of both times. Tolerance: 1e-4 after extrapolation in `size^(2/3)` and `size`.
#[test]
fn a_small_dome_snaps_after_logarithms() {
    let [high, low] = [PRESSURES[1], PRESSURES[2]];
    for supply in [8e4, 5.5e4] {
        let part = VALVE / (SUPPLY + VALVE);
        let dwell = |time: f64, [from, to, limit]: [f64; 3]| time * ((limit - from) / (limit - to)).ln();
        let exact = dwell(SUPPLY * BAG, [low, high, supply]) + dwell(SUPPLY * BAG * part, [high, low, supply * part]);
        let sizes = [1.0 / 8.0, 1.0 / 64.0, 1.0 / 512.0];
        let periods = sizes.map(|size| {
            let case = oscillator([supply, size, DOME], [2.0, 1e-8]);
            subharmonic::find(&case, 1).unwrap().0.drive.period
        });
        let terms = nalgebra::Matrix3::from_fn(|k, j| sizes[k].powf([0.0, 2.0 / 3.0, 1.0][j]));
        let found = terms.lu().solve(&nalgebra::Vector3::from(periods)).unwrap().x;
        println!(
            "{supply} Pa: {periods:?}, limit {found} for {exact}, difference {:.1e}",
            found / exact - 1.0
        );
        assert!((found / exact - 1.0).abs() < 1e-4, "{found} for {exact}");
        assert!(
            periods.iter().all(|period| (period / exact - 1.0).abs() > 1e-3),
            "{periods:?}"
        );
    }
}

/// Goal: the cycle is the end of a long run, its energies and volumes balance, and it is stable, at a usual tolerance and at a tight one.
#[test]
fn a_relaxation_oscillation_is_the_end_of_a_long_run() {
    for (rtol, within) in [(1e-5, 1e-3), (1e-8, 1e-5)] {
        let case = oscillator([8e4, 1.0, DOME], [3.0, rtol]);
        let (scene, mut cycle, _) = subharmonic::find(&case, 1).unwrap();
        let found = record::record(&case, &scene, &cycle, &mut Unrecorded(|_| Control::Continue)).unwrap();
        let long = oscillator([8e4, 1.0, DOME], [6.0, 1e-8]);
        let mut rows = Memory::default();
        let run = dynamics::run_with(&long, scene::system(&long).unwrap(), &[], &mut rows).unwrap();
        assert_eq!(run.summary.status, Status::Finished);
        let (t, p) = (
            rows.column("t").unwrap(),
            rows.column("accumulator_bag_pressure").unwrap(),
        );
        // on the slow branch, where an output interval is short
        let upward = (1..p.len()).filter(|k| p[k - 1] < 3e4 && p[*k] >= 3e4);
        let crossings: Vec<f64> = upward
            .map(|k| t[k - 1] + (3e4 - p[k - 1]) / (p[k] - p[k - 1]) * (t[k] - t[k - 1]))
            .collect();
        let last = crossings.len() - 1;
        let period = (crossings[last] - crossings[last - 20]) / 20.0;
        println!(
            "{rtol}: period {} for {period}: {:.1e}",
            scene.drive.period,
            scene.drive.period / period - 1.0
        );
        assert!((scene.drive.period / period - 1.0).abs() < within);
        let balances = &found.summary.balances;
        let largest = balances.energy_j.values().fold(0.0_f64, |m, x| m.max(x.abs()));
        let open = open_over_window(&found.summary.quantities, largest).unwrap();
        println!(
            "open part of the energy balance {open:.1e}, of the volume {:.1e}",
            balances.volume_residual_relative
        );
        assert!(open < 1e-3 && balances.volume_residual_relative < 1e-10);
        let stability = floquet::multipliers(&scene, &mut cycle, 3);
        let trivial = stability.trivial.unwrap();
        println!("trivial multiplier {}", trivial.re);
        assert!((trivial.re - 1.0).abs() < 100.0 * within, "{trivial:?}");
        assert_eq!(stability.verdict.stability, CycleStability::Stable);
    }
}

/// Slope of a cubic between two turning points.
fn falling(volume: f64) -> [f64; 2] {
    let ([v0, v1], [p0, p1]) = ([VOLUMES[1], VOLUMES[2]], [PRESSURES[1], PRESSURES[2]]);
    let x = (volume - v0) / (v1 - v0);
    [
        p0 + (p1 - p0) * x * x * (3.0 - 2.0 * x),
        (p1 - p0) * 6.0 * x * (1.0 - x) / (v1 - v0),
    ]
}

/// Opening of the valve and its slope.
fn opening(volume: f64) -> [f64; 2] {
    let range = OPENING[1] - OPENING[0];
    let x = ((volume - OPENING[0]) / range).clamp(0.0, 1.0);
    [
        x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x),
        30.0 * (x * (1.0 - x)).powi(2) / range,
    ]
}

/// Source: with the pressure p of the bag and the volume V of the dome, `C p' = (P - p)/R - o(V) p/R_v - (p - P_d(V))/R_d`,
/// `R_d V' = p - P_d(V)`. Goal: modes about the equilibrium in the middle have the eigenvalues of this system, and grow below the
/// resistance of the dome at which its trace vanishes: that of Hopf's bifurcation.
#[test]
fn a_relaxation_oscillation_begins_as_a_small_model_says() {
    let supply = 8e4;
    // equilibrium by bisection: the supply fills more than the valve empties below it
    let (mut low, mut high) = (VOLUMES[1], VOLUMES[2]);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let p = falling(middle)[0];
        let filled = (supply - p) / SUPPLY - opening(middle)[0] * p / VALVE;
        *(if filled > 0.0 { &mut low } else { &mut high }) = middle;
    }
    let ([p, slope], [open, opens]) = (falling(low), opening(low));
    let matrix = |resistance: f64| {
        Matrix2::new(
            -(1.0 / SUPPLY + open / VALVE + 1.0 / resistance) / BAG,
            (slope / resistance - opens * p / VALVE) / BAG,
            1.0 / resistance,
            -slope / resistance,
        )
    };
    let plan = ModeOptions {
        count: 12,
        near_hz: 0.0,
        limits: false,
    };
    // trace: -(g + 1/r)/C - P'/r = 0
    let onset = -(slope * BAG + 1.0) / (1.0 / SUPPLY + open / VALVE);
    println!("equilibrium at {p} Pa, {low} m³; onset at {onset:e} Pa s/m³");
    for share in [0.5, 0.95, 1.05, 2.0] {
        let resistance = share * onset;
        let trace = matrix(resistance).trace();
        let exact = matrix(resistance).complex_eigenvalues();
        let case = oscillator([supply, 1.0, resistance], [1.0, 1e-8]);
        let found = modes::compute(modes::at_equilibrium(&case, 1.0).unwrap(), &plan).unwrap();
        let nearest = |s: &Complex<f64>| {
            found
                .modes
                .iter()
                .map(|mode| (mode.s - s).norm())
                .fold(f64::INFINITY, f64::min)
        };
        println!(
            "{share}: {exact:?}, trace {trace}, differences {:?}",
            exact.map(|s| nearest(&s))
        );
        for s in exact.iter().filter(|s| s.im >= 0.0) {
            assert!(
                nearest(s) < 1e-6 * s.norm(),
                "{share}: {s} in {:?}",
                found.modes.iter().map(|m| m.s).collect::<Vec<_>>()
            );
        }
        let grows = found.modes.iter().any(|mode| mode.s.re > 0.0);
        assert_eq!(grows, trace > 0.0, "{share}");
    }
}

/// Goal: the analysis of `sweep` and `optimize` has the figures of the cycle, and fails where nothing oscillates.
#[test]
fn designs_have_periods_of_their_own() {
    let analysis = AnalysisKind::Periodic.analysis();
    let figures = |supply: f64, end: f64| {
        let case = oscillator([supply, 1.0, DOME], [end, 1e-6]);
        analysis.check(&case).unwrap();
        let ask = AnalysisRequest {
            what: &AnalysisKind::Periodic,
            accuracy: None,
            from: None,
            meshes: false,
            waves: false,
        };
        found(&case, ask, &|| false, &|_| unreachable!("no run is needed"))
    };
    let at = oscillator([8e4, 1.0, DOME], [2.0, 1e-6]);
    let period = subharmonic::find(&at, 1).unwrap().0.drive.period;
    let design = figures(8e4, 2.0).unwrap();
    assert!((design.figure("period_s").unwrap() / period - 1.0).abs() < 1e-5);
    assert_eq!(design.figure("stable"), Some(1.0));
    // the supply does not reach the pressure at which the dome snaps
    let resting = figures(3.5e4, 12.0).unwrap();
    let reason = resting.reason.unwrap();
    assert_eq!(resting.status, Status::Failed);
    assert!(
        reason.contains("comes to rest") && !reason.contains("Amplitude"),
        "{reason}"
    );
}

/// The shipped finger beats: its cycle is stable, and the tip moves by more than half of its largest deflection.
#[test]
fn the_shipped_finger_beats() {
    let case = case::load(
        Path::new("cases/relaxation-oscillator.json"),
        &["/companion=\"off\"".into()],
    )
    .unwrap();
    let (scene, mut cycle, _) = subharmonic::find(&case, 1).unwrap();
    let mut rows = Memory::default();
    record::record(&case, &scene, &cycle, &mut rows).unwrap();
    let tip = rows.column("tip_u1").unwrap();
    let [least, most] = [f64::max as fn(f64, f64) -> f64, f64::min].map(|of| tip.iter().copied().reduce(of).unwrap());
    let stability = floquet::multipliers(&scene, &mut cycle, 3);
    println!(
        "period {} s, tip {least} to {most} m, {:?}",
        scene.drive.period, stability.trivial
    );
    assert!(most < -4e-3 && least > 0.5 * most);
    assert_eq!(stability.verdict.stability, CycleStability::Stable);
}
