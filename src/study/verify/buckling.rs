//! Euler's column, a column under its own weight, the elastica beyond buckling.

use std::f64::consts::PI;

use serde_json::json;

use super::figure::ExactFigure;
use super::problem::SolvedProblem;
use super::scene::{growing, load_path, unit_beam};
use super::solve::{balance, on_three_meshes};

/// Euler's load of the unit cantilever [N].
const EULER: f64 = PI * PI / 4.0;

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    vec![
        euler(),
        self_weight(),
        elastica(20, 1.015396866, None),
        elastica(60, 1.15171962, Some([0.7410196, 0.5932076])),
    ]
}

fn euler() -> SolvedProblem {
    SolvedProblem::new(
        "euler-load",
        [
            "Euler 1744: P L^2/EI = pi^2/4, clamped-free",
            "geometric stiffness: the load at which the buckled path crosses the straight one",
            "second order: (pi h/2)^2/12 for the chain of links, a quarter of that band left; the limit keeps h^4, EI/EA L^2 = 1e-8, and the square of the last step, 1e-4",
        ],
        || {
            let [load] = on_three_meshes(20, |cells| {
                let pressed = json!({"free": {"force_z_n": growing(-EULER)}});
                let case = load_path(unit_beam(1000.0), cells, pressed);
                Ok([EULER * balance(&case, 1.01)?.bifurcation()])
            })?;
            Ok(vec![ExactFigure::converging("P L^2/EI", load, EULER, 5e-5, 1e-6)])
        },
    )
}

fn self_weight() -> SolvedProblem {
    const EXACT: f64 = 7.83734743894;
    SolvedProblem::new(
        "self-weight",
        [
            "Greenhill 1881: q L^3/EI = 7.83734743894",
            "geometric stiffness of a distributed axial load",
            "second order, constant below 1 with 80 cells: h^2 = 1.6e-4; the limit keeps h^4 and the square of the last step, 1e-4",
        ],
        || {
            let [load] = on_three_meshes(20, |cells| {
                let mut case = load_path(unit_beam(1000.0), cells, json!("free"));
                case["loads"] = json!([{"force_z_n_m": {"signal": growing(-EXACT)}}]);
                Ok([EXACT * balance(&case, 1.01)?.bifurcation()])
            })?;
            Ok(vec![ExactFigure::converging("q L^3/EI", load, EXACT, 1.6e-4, 1e-6)])
        },
    )
}

/// The buckled branch, entered where it crosses the straight one.
fn elastica(degrees: u32, ratio: f64, place: Option<[f64; 2]>) -> SolvedProblem {
    SolvedProblem::new(
        format!("elastica-{degrees}-degrees"),
        [
            "Timoshenko & Gere, Theory of Elastic Stability, 2.7 (elastica by elliptic integrals)",
            "the buckled branch beyond Euler's load, entered from the straight one",
            "second order; near the critical load an error of the load turns into one of the angle 4/angle^2 times as large (33 times at 20 degrees): of Euler's load on the mesh, 2e-6 with 320 cells; the limit keeps the stretch P/EA = 2e-8",
        ],
        move || {
            let [angle, z, x] = on_three_meshes(80, |cells| {
                let pressed = json!({"free": {"force_z_n": growing(-ratio * EULER)}});
                let solved = balance(&load_path(unit_beam(1000.0), cells, pressed), 1.0)?;
                let degrees = solved.last("tip_angle").to_degrees();
                Ok([degrees, 1.0 + solved.last("tip_u3"), solved.last("tip_u1")])
            })?;
            let magnified = 4.0 / f64::from(degrees).to_radians().powi(2);
            let mut figures = vec![ExactFigure::converging(
                "tip angle [degrees]",
                angle,
                f64::from(degrees),
                4e-6 * magnified,
                3e-8 * magnified,
            )];
            if let Some([along, across]) = place {
                figures.push(ExactFigure::converging("x/L", z, along, 2e-5, 2e-7));
                figures.push(ExactFigure::converging("y/L", x, across, 2e-5, 2e-7));
            }
            Ok(figures)
        },
    )
}
