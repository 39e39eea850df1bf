//! Spin-up of a flexible arm (Simo and Vu-Quoc 1986).

use std::f64::consts::{FRAC_PI_2, PI};

use serde_json::{Value, json};

use super::figure::ExactFigure;
use super::fit::{minimum, smooth_mean};
use super::problem::SolvedProblem;
use super::solve::{on_three_meshes, solve};
use crate::error::Result;
use crate::functions::{Signal, SmoothTime};

/// Length [m], stiffnesses [N], [N m^2], mass [kg/m], final speed [1/s], time of acceleration [s].
const LENGTH: f64 = 10.0;
const EA: f64 = 2.8e7;
const EI: f64 = 1.4e4;
const MASS: f64 = 1.2;
const SPEED: f64 = 6.0;
const RISE: f64 = 15.0;

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    vec![SolvedProblem::new(
        "spin-up",
        [
            "Simo & Vu-Quoc 1986; rotating bar: tan(k L)/k - L = 5.14317455e-4 m; transverse minimum of the unshearable arm about -0.57379 m",
            "large overall motion: an extension of 5e-5 of the radius under the centrifugal force, and the greatest lag on the way",
            "second order: (h/L)^2 of 40 cells is 6e-4, times a constant below 1 (extension) and below 3 (lag); the limit keeps the digits of the reference for the lag and rtol 1e-8 of 10 m, 2e-4 of the extension. A damping time of 1e-5 s (rate of the first mode 7e-5 1/s) quiets mesh-scale waves",
        ],
        || {
            let [extension, lag] = on_three_meshes(10, spin_up)?;
            let k = SPEED * (MASS / EA).sqrt();
            let steady = (k * LENGTH).tan() / k - LENGTH;
            Ok(vec![
                ExactFigure::converging("steady extension [m]", extension, steady, 6e-4, 2e-4),
                ExactFigure::converging("largest lag [m]", lag, -0.57379, 1.8e-3, 2e-4),
            ])
        },
    )]
}

/// `ψ = (6/15) [t²/2 + (15/2π)² (cos(2πt/15) - 1)]` up to 15 s, then `6 t - 45`: twice continuously differentiable.
fn angle() -> Value {
    let (rate, size) = (SPEED / RISE, (RISE / (2.0 * PI)).powi(2));
    let switch = |from: f64, to: f64| json!({"ramp": {"from": from, "to": to, "start_s": RISE, "duration_s": 0.0}});
    json!({"sum": [
        {"product": [switch(1.0, 0.0), {"sum": [
            {"polynomial": {"coefficients": [-rate * size, 0.0, 0.5 * rate]}},
            {"sine": {"amplitude": rate * size, "frequency_hz": 1.0 / RISE, "phase_rad": FRAC_PI_2}}
        ]}]},
        {"product": [switch(0.0, 1.0), {"polynomial": {"coefficients": [-0.5 * SPEED * RISE, SPEED]}}]}
    ]})
}

/// Mean extension of the axis over the last 4 s, and largest lag of the tip in the frame that rotates with the root
/// [m]. The extension is that of the axis: it does not include the shortening of the tip's distance by the small
/// remaining vibration.
fn spin_up(cells: usize) -> Result<[f64; 2]> {
    // Square section: EA/EI = 12/h².
    let side = (12.0 * EI / EA).sqrt();
    let case = json!({
        "name": "spin-up",
        "beam": {"length_m": LENGTH, "height_m": side, "width_m": side,
                 "young_modulus_pa": EA / (side * side), "density_kg_m3": MASS / (side * side),
                 "damping": {"bending_time_s": 1e-5}},
        "ends": {"root": {"clamped": {"slope_rad": angle()}}, "tip": "free"},
        "effects": {"solid_inertia": "on", "rotary_inertia": "off"},
        "mesh": {"segments": cells, "cells_per_segment": 1},
        "time": {"end_s": 20.0, "output_interval_s": 0.02},
        "solver": {"rtol": 1e-8}
    });
    let solved = solve(&case)?;
    let signal: Signal = serde_json::from_value(angle()).unwrap_or(Signal::Constant(f64::NAN));
    let across: Vec<f64> = solved
        .column("t")
        .iter()
        .zip(solved.column("tip_u1"))
        .zip(solved.column("tip_u3"))
        .map(|((&t, u1), u3)| {
            let (sine, cosine) = signal.jet(SmoothTime { t, within: t }).value.sin_cos();
            u1 * cosine - (LENGTH + u3) * sine
        })
        .collect();
    let steady = solved.field("u1_m").iter().zip(solved.field("u3_m")).skip(800);
    let extensions: Vec<f64> = steady.map(|(u1, u3)| length(u1, u3) - LENGTH).collect();
    Ok([smooth_mean(&extensions), minimum(&across)])
}

/// Length of the axis [m].
fn length(u1: &[f64], u3: &[f64]) -> f64 {
    let h = LENGTH / (u1.len() - 1) as f64;
    u1.windows(2)
        .zip(u3.windows(2))
        .map(|(x, z)| (x[1] - x[0]).hypot(h + z[1] - z[0]))
        .sum()
}
