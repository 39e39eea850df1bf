//! Cantilevers under end moment, dead tip load and dead uniform load: equilibria by KINSOL from rest.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::figure::ExactFigure;
use super::problem::SolvedProblem;
use super::scene::{growing, load_path, unit_beam};
use super::solve::{balance, on_three_meshes};
use crate::error::Result;

/// Cells of the coarsest mesh.
const CELLS: usize = 40;

/// Shortening `u/L`, deflection `w/L` and angle [rad] of the tip at the end of a load path.
fn tip(case: &Value) -> Result<[f64; 3]> {
    let solved = balance(case, 1.0)?;
    Ok([-solved.last("tip_u3"), solved.last("tip_u1"), solved.last("tip_angle")])
}

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    let mut all: Vec<SolvedProblem> = [
        ("quarter", 0.5 * PI),
        ("half", PI),
        ("ring", 2.0 * PI),
        ("two-turns", 4.0 * PI),
    ]
    .map(end_moment)
    .into();
    all.extend(
        [
            (1, [0.0564332362834, 0.301720773800, 0.461351949712]),
            (5, [0.387628360724, 0.713791523612, 1.21536811761]),
            (10, [0.554995597754, 0.810609024880, 1.43028553880]),
        ]
        .map(tip_load),
    );
    all.push(tip_load_stretch());
    all.extend(
        [
            (1, [0.008753605, 0.123471402, 0.165115561]),
            (4, [0.109889253, 0.425159284, 0.588592372]),
            (10, [0.343646239, 0.700199716, 1.052643117]),
        ]
        .map(uniform_load),
    );
    all
}

/// Curvature is constant, `φ' = -M/EI`; the mesh replaces the arc by chords of its midpoint tangents, which shortens
/// `sin k/k` by the factor `1 + (k h)²/24`.
fn end_moment((name, k): (&'static str, f64)) -> SolvedProblem {
    SolvedProblem::new(
        format!("end-moment-{name}"),
        [
            "constant curvature: tip at (sin k/k, (1 - cos k)/k) L, k = M L/EI",
            "finite rotations are exact over any number of turns; axial stiffness does not matter",
            "tangents are exact, positions a midpoint rule with the error (k h)^2/24, which vanishes for full turns; the rest is Newton's tolerance",
        ],
        move || {
            let [u, w, angle] = on_three_meshes(CELLS, |cells| {
                let turned = json!({"free": {"moment_n_m": growing(-k)}});
                tip(&load_path(unit_beam(1.0), cells, turned))
            })?;
            let exact = [1.0 - k.sin() / k, (1.0 - k.cos()) / k];
            let bound = (k / (4 * CELLS) as f64).powi(2) / 12.0;
            let full_turns = (0.5 * k / PI).fract() == 0.0;
            let place = |quantity, values: [f64; 3], exact| {
                let figure = ExactFigure::absolute(quantity, values[2], exact, if full_turns { 1e-7 } else { bound });
                if full_turns {
                    figure
                } else {
                    figure.on_meshes(values, 1e-7)
                }
            };
            let mut figures = vec![
                ExactFigure::absolute("shortening u/L", u[2], exact[0], 1e-7),
                place("deflection w/L", w, exact[1]),
                ExactFigure::relative("tip angle [rad]", angle[2], k, 1e-7),
            ];
            if !full_turns && k.sin().abs() > 0.5 {
                figures[0] = place("shortening u/L", u, exact[0]);
            }
            Ok(figures)
        },
    )
}

/// Figures of [`tip`].
const TIP: [&str; 3] = ["shortening u/L", "deflection w/L", "tip angle [rad]"];

/// Figures of the tip on three meshes.
fn of_tip(names: [&str; 3], values: [[f64; 3]; 3], exact: [f64; 3], tolerance: f64) -> Vec<ExactFigure> {
    let all = names.into_iter().zip(values).zip(exact);
    all.map(|((name, values), exact)| ExactFigure::converging(name, values, exact, tolerance, 1e-6))
        .collect()
}

fn tip_load((load, exact): (u32, [f64; 3])) -> SolvedProblem {
    SolvedProblem::new(
        format!("tip-load-{load}"),
        [
            "Bisshopp & Drucker 1945: P L^2/EI, elastica without stretch",
            "large deflection under a dead transverse tip load",
            "second order: h^2 of 160 cells is 4e-5, times a constant below 2; the limit keeps the stretch P/EA < 1e-7 (EA L^2/EI = 1.2e8) and h^4",
        ],
        move || {
            let values = on_three_meshes(CELLS, |cells| {
                let pulled = json!({"free": {"force_x_n": growing(f64::from(load))}});
                tip(&load_path(unit_beam(1000.0), cells, pulled))
            })?;
            Ok(of_tip(TIP, values, exact, 8e-5))
        },
    )
}

fn tip_load_stretch() -> SolvedProblem {
    SolvedProblem::new(
        "tip-load-stretch",
        [
            "closed form of the extensible elastica; Exudyn's ANCFCable2D tends to it",
            "bending and stretch together: L 2 m, section 0.1 m x 0.1 m, E 2.07e11 Pa, F = 3 EI/L^2",
            "second order: h^2 of 160 cells is 4e-5, times a constant below 2; the limit keeps h^4",
        ],
        || {
            let beam = json!({
                "length_m": 2.0, "height_m": 0.1, "width_m": 0.1, "young_modulus_pa": 2.07e11, "density_kg_m3": 7850
            });
            let force = 3.0 * 2.07e11 * 0.1_f64.powi(4) / 12.0 / 4.0;
            let values = on_three_meshes(CELLS, |cells| {
                let pulled = json!({"free": {"force_x_n": growing(-force)}});
                let solved = balance(&load_path(beam.clone(), cells, pulled), 1.0)?;
                Ok(["tip_u3", "tip_u1", "tip_angle"].map(|name| solved.last(name)))
            })?;
            let exact = [-0.508537304326, -1.207239854550, -0.986237330266];
            let names = [
                "axial displacement [m]",
                "transverse displacement [m]",
                "tip angle [rad]",
            ];
            Ok(of_tip(names, values, exact, 8e-5))
        },
    )
}

fn uniform_load((load, exact): (u32, [f64; 3])) -> SolvedProblem {
    SolvedProblem::new(
        format!("uniform-load-{load}"),
        [
            "Rohde 1953: q L^3/EI, elastica without stretch",
            "large deflection under a dead uniform load; half a cell's load at the end nodes",
            "second order: h^2 of 160 cells is 4e-5, times a constant below 3; the limit keeps the nine digits given, the stretch q L/EA < 1e-7 and h^4",
        ],
        move || {
            let values = on_three_meshes(CELLS, |cells| {
                let mut case = load_path(unit_beam(1000.0), cells, json!("free"));
                case["loads"] = json!([{"force_x_n_m": {"signal": growing(f64::from(load))}}]);
                tip(&case)
            })?;
            Ok(of_tip(TIP, values, exact, 1.2e-4))
        },
    )
}
