//! Free bending vibrations: modes of the linearized beam, and one mode by small motion in time.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::figure::ExactFigure;
use super::fit::oscillation;
use super::problem::SolvedProblem;
use super::scene::motion;
use super::solve::{modes, on_three_meshes, solve};
use crate::error::Result;
use crate::run::modes::Mode;

/// Samples per period, and periods of a run.
const SAMPLES: usize = 24;
const PERIODS: usize = 2;

/// First roots `β L` of the cantilever.
const FREE: [f64; 4] = [1.875104068712, 4.694091132974, 7.854757438238, 10.995540734875];

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    let mut all: Vec<SolvedProblem> = (1..)
        .zip(FREE)
        .map(|(mode, beta)| frequency(format!("frequency-clamped-free-{mode}"), mode, beta, json!("free")))
        .collect();
    all.push(frequency(
        "frequency-clamped-clamped".into(),
        1,
        4.7300407448627,
        json!("clamped"),
    ));
    all.push(frequency(
        "frequency-clamped-pinned".into(),
        1,
        3.9266023120479,
        json!("pinned"),
    ));
    all.push(in_time());
    all
}

fn frequency(name: String, mode: usize, beta: f64, tip: Value) -> SolvedProblem {
    SolvedProblem::new(
        name,
        [
            "Euler-Bernoulli beam: w L^2 sqrt(m/EI) = (beta L)^2 (Blevins)",
            "stiffness, mass and ends of the mesh, by the eigenvalues of the linearised beam",
            "second order, with 64 cells: (beta h)^2/10 for the waves (a 12th for short ones) and beta h^2/4 for each end; the limit keeps (beta h)^4",
        ],
        move || {
            let exact = beta * beta;
            let [w] = on_three_meshes(16, |cells| Ok([transverse(cells, mode, &tip)?]))?;
            let bound = (beta * beta / 10.0 + beta / 2.0) / 64.0_f64.powi(2);
            Ok(vec![ExactFigure::converging(
                "w L^2 sqrt(m/EI)",
                w,
                exact,
                bound,
                (beta / 32.0).powi(4),
            )])
        },
    )
}

/// Angular frequency of the `mode`-th bending mode on a mesh [1/s].
fn transverse(cells: usize, mode: usize, tip: &Value) -> Result<f64> {
    let mut case = motion(cells, |_| 0.0, 1.0, 1.0);
    case["ends"]["tip"] = tip.clone();
    let found = modes(&case, mode + 2)?;
    let across = |m: &&Mode| m.kind.swings() && m.shape.transverse() > 0.5;
    Ok(found
        .modes
        .iter()
        .filter(across)
        .nth(mode - 1)
        .map_or(f64::NAN, |m| m.s.im))
}

/// Compares the linearization with the nonlinear equations.
fn in_time() -> SolvedProblem {
    SolvedProblem::new(
        "frequency-in-time",
        [
            "eigenvalue of the linearised beam on the same mesh",
            "small free vibrations started in the second mode have the frequency of the linearisation",
            "the phase that the integrator loses, below (w step)^2/3 = 5e-6 at rtol 1e-6",
        ],
        || {
            let beta = FREE[1];
            let expected = transverse(40, 2, &json!("free"))?;
            Ok(vec![ExactFigure::relative(
                "w L^2 sqrt(m/EI)",
                measured(40, beta)?,
                expected,
                1e-5,
            )])
        },
    )
}

/// Angular frequency of a mode of a cantilever on a mesh, from a run [1/s].
fn measured(cells: usize, beta: f64) -> Result<f64> {
    let interval = 2.0 * PI / (beta * beta) / SAMPLES as f64;
    let end = interval * (SAMPLES * PERIODS) as f64;
    let solved = solve(&motion(cells, |x| free_shape(beta, x), end, interval))?;
    let coordinate: Vec<f64> = solved
        .field("u1_m")
        .iter()
        .map(|u1| {
            let terms = u1.iter().enumerate();
            terms.map(|(i, u)| u * free_shape(beta, i as f64 / cells as f64)).sum()
        })
        .collect();
    Ok(oscillation(&coordinate, interval).1)
}

/// Mode shape of a clamped-free beam; its absolute value at the tip is 2.
pub fn free_shape(beta: f64, x: f64) -> f64 {
    let ratio = (beta.cosh() + beta.cos()) / (beta.sinh() + beta.sin());
    let b = beta * x;
    b.cosh() - b.cos() - ratio * (b.sinh() - b.sin())
}
