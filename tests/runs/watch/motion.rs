//! Extrema and means are those of the motion, not of its samples.

use super::common::{BEAM, finished, shipped, written};

const DRIVE: &str =
    r#"/ends/root={"clamped": {"u1_m": {"sine": {"amplitude": 1e-3, "frequency_hz": 10, "ramp_cycles": 2}}}}"#;

/// Goal: in a thousand cycles with default output times, each at a zero of the drive, the largest deflection equals that of twenty output
/// times per cycle. Tolerance: 1e-3, that of the search for turning points.
#[test]
fn a_thousand_cycles_between_output_times() {
    let long = finished(&written(BEAM, &[DRIVE, "/time/end_s=100"]));
    let short = finished(&written(
        BEAM,
        &[DRIVE, "/time/end_s=3", "/time/output_interval_s=1e-3"],
    ));
    for name in ["tip_u1_m", "tip_angle_rad", "midspan_u1_m", "largest_u1_m"] {
        let (a, b) = (&long.quantities[name], &short.quantities[name]);
        println!("{name}: {a:?} {b:?}");
        let near = |a: Option<f64>, b: Option<f64>, tolerance: f64| {
            let (a, b) = (a.unwrap(), b.unwrap());
            assert!((a / b - 1.0).abs() < tolerance, "{name}: {a} is not {b}");
        };
        near(a.max_abs, b.max_abs, 1e-3);
        near(a.window_max_abs, b.window_max_abs, 2e-3);
        near(a.window_rms, b.window_rms, 2e-3);
    }
}

/// Goal: output times more often than steps, and a hundred times less often, give the same figures; the root mean square is an integral
/// over time. Tolerance: 2e-3.
#[test]
fn figures_do_not_depend_on_output_times() {
    let with = |interval: &str, rtol: &str| finished(&written(BEAM, &[DRIVE, "/time/end_s=1", interval, rtol]));
    for rtol in ["/solver/rtol=1e-4", "/solver/rtol=1e-2"] {
        let often = with("/time/output_interval_s=1e-4", rtol);
        let rarely = with("/time/output_interval_s=0.25", rtol);
        for (name, a) in &often.quantities {
            let b = &rarely.quantities[name];
            for ((which, a), (_, b)) in a.figures().zip(b.figures()) {
                if ["max_abs", "window_max_abs", "window_rms"].contains(&which) && a > 1e-9 {
                    assert!((b / a - 1.0).abs() < 2e-3, "{rtol}: {name} {which}: {a} {b}");
                }
            }
        }
    }
}

/// Goal: the largest displacement is found between nodes: meshes of 24 and of 27 cells, with different nodes, agree. The largest nodal
/// values differed by 1 %. Tolerance: 1e-3, that of the search for turning points.
#[test]
fn the_largest_displacement_lies_between_nodes() {
    let with = |cells: usize| {
        let case = format!(
            r#"{{"name": "between", "beam": {{"length_m": 0.2, "height_m": 0.01, "width_m": 0.02, "young_modulus_pa": 1e6, "density_kg_m3": 1000,
            "damping": {{"bending_time_s": 0.01, "axial_time_s": 0.002}}}}, "ends": {{"root": "clamped", "tip": "clamped"}},
            "loads": [{{"force_x_n_m": {{"signal": {{"ramp": {{"to": 0.8333, "duration_s": 0.1}}}}, "profile": {{"sine": {{"waves": 0.5}}}}}}}}],
            "mesh": {{"segments": {cells}, "cells_per_segment": 1, "order": 4}}, "time": {{"end_s": 0.2}}}}"#
        );
        finished(&written(&case, &[]))
    };
    let (a, b) = (with(24), with(27));
    for name in ["largest_u1_m", "largest_u3_m"] {
        let [a, b] = [&a, &b].map(|s| s.quantities[name].max_abs.unwrap());
        println!("{name}: {a:e} {b:e}");
        assert!((a / b - 1.0).abs() < 1e-3, "{name}: {a} {b}");
    }
}

/// Goal: the largest pressure, whose cell changes, agrees in the same way.
#[test]
fn the_largest_pressure_lies_between_output_times() {
    let with = |interval: &str| {
        finished(&shipped(
            "shaken-sealed",
            &[
                "/time/end_s=0.06",
                "/time/window_s=0.03",
                "/time/fields_interval_s=0.03",
                interval,
            ],
        ))
    };
    let (often, rarely) = (
        with("/time/output_interval_s=2e-5"),
        with("/time/output_interval_s=0.03"),
    );
    let [a, b] = [&often, &rarely].map(|s| s.quantities["max_pressure_pa"].max_abs.unwrap());
    println!("largest pressure {a} {b} Pa");
    assert!((b / a - 1.0).abs() < 5e-3, "{a} {b}");
}
