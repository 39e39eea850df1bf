//! Free bending vibrations: small motion started in the shape of a mode, its frequency from the modal coordinate.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::figure::Figure;
use super::fit::oscillation;
use super::row::Row;
use super::scene::motion;
use super::solve::{on_three_meshes, solve};
use crate::error::Result;

/// Samples a period, periods run.
const SAMPLES: usize = 24;
const PERIODS: usize = 2;

/// All rows.
pub fn rows() -> Vec<Row> {
    let free = [1.875104068712, 4.694091132974, 7.854757438238, 10.995540734875];
    let mut all: Vec<Row> = (1..)
        .zip(free)
        .map(|(mode, beta)| {
            frequency(
                format!("frequency-clamped-free-{mode}"),
                beta,
                json!("free"),
                free_shape,
            )
        })
        .collect();
    all.push(frequency(
        "frequency-clamped-clamped".into(),
        4.7300407448627,
        json!("clamped"),
        held_shape,
    ));
    all.push(frequency(
        "frequency-clamped-pinned".into(),
        3.9266023120479,
        json!("pinned"),
        held_shape,
    ));
    all
}

fn frequency(name: String, beta: f64, tip: Value, shape: fn(f64, f64) -> f64) -> Row {
    Row::new(
        name,
        [
            "Euler-Bernoulli beam: w L^2 sqrt(m/EI) = (beta L)^2 (Blevins)",
            "stiffness, mass and ends of the mesh; small free vibrations started in the mode",
            "second order: (beta h)^2 times a constant below 1/3; the limit keeps (beta h)^4 and the integrator's phase, below (w step)^2/3 = 5e-6 at rtol 1e-6",
        ],
        move || {
            let exact = beta * beta;
            let [w] = on_three_meshes(20, |cells| Ok([measured(cells, beta, &tip, shape)?]))?;
            let bound = (beta / 80.0).powi(2) / 3.0;
            Ok(vec![
                Figure::relative("w L^2 sqrt(m/EI)", w[2], exact, bound).on_meshes(w, 1e-5 + (beta / 40.0).powi(4)),
            ])
        },
    )
}

/// Angular frequency of the mode on a mesh [1/s].
fn measured(cells: usize, beta: f64, tip: &Value, shape: fn(f64, f64) -> f64) -> Result<f64> {
    let interval = 2.0 * PI / (beta * beta) / SAMPLES as f64;
    let mut case = motion(
        cells,
        |x| shape(beta, x),
        interval * (SAMPLES * PERIODS) as f64,
        interval,
    );
    case["ends"]["tip"] = tip.clone();
    let solved = solve(&case)?;
    let coordinate: Vec<f64> = solved
        .field("u1_m")
        .iter()
        .map(|u1| {
            u1.iter()
                .enumerate()
                .map(|(i, u)| u * shape(beta, i as f64 / cells as f64))
                .sum()
        })
        .collect();
    Ok(oscillation(&coordinate, interval).1)
}

/// Mode of a clamped-free beam, 2 at the tip but for its sign.
pub fn free_shape(beta: f64, x: f64) -> f64 {
    clamped(beta, x, (beta.cosh() + beta.cos()) / (beta.sinh() + beta.sin()))
}

/// Mode of a beam clamped at the root that does not move at the tip.
fn held_shape(beta: f64, x: f64) -> f64 {
    clamped(beta, x, (beta.cosh() - beta.cos()) / (beta.sinh() - beta.sin()))
}

fn clamped(beta: f64, x: f64, ratio: f64) -> f64 {
    let b = beta * x;
    b.cosh() - b.cos() - ratio * (b.sinh() - b.sin())
}
