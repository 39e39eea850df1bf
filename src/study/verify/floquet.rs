//! Mathieu's tongue from multipliers of the period map: its edges, and growth with damping.

use std::f64::consts::TAU;

use serde_json::{Value, json};

use super::figure::ExactFigure;
use super::fit::secant;
use super::problem::SolvedProblem;
use super::scene::unit_beam;
use super::solve::{on_three_meshes, parse};
use crate::error::Result;
use crate::model::characteristic::{MATHIEU_COUPLING, mathieu_growth};
use crate::run::floquet::{self, Multiplier, shape::EnergyPart};
use crate::run::periodic::scene::fault;
use crate::run::periodic::{PeriodicScene, shoot};

const BETA: f64 = 1.875104068712;
/// Number of multipliers computed: without damping, several modes lie on the unit circle besides the first.
const COUNT: usize = 16;
/// Modulation of the edges.
const NARROW: f64 = 0.1;
/// Modulation and damping ratio of the growth.
const WIDE: (f64, f64) = (0.2, 0.01);

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    let source = "Mathieu: q'' + 2 z w1 q' + [w1^2 - 1.57087818999 a(t)/L] q = 0; edges a1(q), b1(q) = 1 -/+ q - q^2/8 +/- q^3/64, \
                  a = (2 w1/W)^2, q = a eps/2 (Abramowitz & Stegun 20.2.25); growth from its monodromy matrix";
    vec![
        SolvedProblem::new(
            "floquet-tongue-edges",
            [
                source,
                "edges of the principal tongue from multipliers, eps = 0.1; to first order they lie at 1 -/+ eps/4",
                "second order: w1 and with it the edges are off by (beta h)^2/3; the limit keeps what the second mode adds, below (eps w1/w2)^2, and the stretch of the axis, eps/4 (W/w_axial)^2 = 5e-6",
            ],
            || {
                let [lower, upper] = on_three_meshes(6, |cells| Ok([edge(cells, -1.0)?, edge(cells, 1.0)?]))?;
                let bound = (BETA / 24.0).powi(2) / 3.0;
                Ok(vec![
                    ExactFigure::converging("lower edge W/(2 w1)", lower, exact_edge(-1.0), bound, 3e-4),
                    ExactFigure::converging("upper edge W/(2 w1)", upper, exact_edge(1.0), bound, 3e-4),
                ])
            },
        ),
        SolvedProblem::new(
            "floquet-damped-growth",
            [
                source,
                "growth in the middle of the tongue with damping, eps = 0.2, z = 0.01: that of the undamped beam of w1^2 (1 - z^2), less z w1",
                "second order: the growth follows w1; a single mode leaves out the second, (eps w1/w2)^2 = 1e-3, and its stiffness moves W = 2 w1 off the middle",
            ],
            || {
                let (epsilon, zeta) = WIDE;
                let w = BETA * BETA;
                let exact = mathieu_growth(w * w * (1.0 - zeta * zeta), epsilon * w * w, 2.0 * w) - zeta * w;
                let [growth] = on_three_meshes(6, |cells| Ok([first(cells, 1.0, WIDE)?[0].growth_per_s]))?;
                Ok(vec![ExactFigure::relative(
                    "growth L^2 sqrt(m/EI)",
                    growth[2],
                    exact,
                    3e-3,
                )])
            },
        ),
    ]
}

/// Multipliers of the first mode under shaking at `ratio` times `2 ω1`, largest first: two real ones, or one of a
/// complex pair.
fn first(cells: usize, ratio: f64, (epsilon, zeta): (f64, f64)) -> Result<Vec<Multiplier>> {
    let w = BETA * BETA;
    let omega = 2.0 * w * ratio;
    let amplitude = epsilon * w * w / MATHIEU_COUPLING / (omega * omega);
    let mut beam = unit_beam(1.0);
    beam["damping"] = json!({"bending_time_s": 2.0 * zeta / w});
    let text = json!({
        "name": "tongue", "beam": beam,
        "ends": {
            "root": {"clamped": {"u3_m": {"sine": {"amplitude": amplitude, "frequency_hz": omega / TAU}}}}, "tip": "free"
        },
        "effects": {"rotary_inertia": "off"},
        "mesh": {"segments": cells, "cells_per_segment": 1},
        "time": {"end_s": 1.0},
        "solver": {"rtol": 1e-6}
    });
    bending(&text)
}

/// Multipliers of the first bending mode of a case, largest first.
pub fn bending(case: &Value) -> Result<Vec<Multiplier>> {
    let case = parse(case)?;
    let scene = PeriodicScene::new(&case, None)?;
    let mut cycle = shoot(&scene, None).map_err(fault)?;
    let mut found = floquet::multipliers(&scene, &mut cycle, COUNT).multipliers;
    found.retain(|m| m.part == EnergyPart::Bending(1));
    Ok(found)
}

/// Half the trace of the first mode's period map, plus one: 0 on the edges, negative in the tongue.
pub fn above_tongue(found: &[Multiplier]) -> f64 {
    1.0 + match found {
        [a, b, ..] if a.im == 0.0 => 0.5 * (a.re + b.re),
        [a, ..] => a.re,
        [] => f64::NAN,
    }
}

/// Edge of the tongue on a mesh, below (`side = -1`) or above `2 ω1`, by the secant method.
fn edge(cells: usize, side: f64) -> Result<f64> {
    let guess = 1.0 + 0.25 * side * NARROW;
    secant([guess - 2e-3 * side, guess + 2e-3 * side], |ratio| {
        Ok(above_tongue(&first(cells, ratio, (NARROW, 0.0))?))
    })
}

/// Edge of the tongue of Mathieu's equation: `1/x² = 1 ∓ q - q²/8 ± q³/64`, `q = ε/(2x²)`, by bisection.
fn exact_edge(side: f64) -> f64 {
    let gap = |x: f64| {
        let a = 1.0 / (x * x);
        let q = 0.5 * a * NARROW;
        // the lower edge in frequency is the upper edge in a
        a - (1.0 - side * q - q * q / 8.0 + side * q * q * q / 64.0)
    };
    let (mut lo, mut hi) = (0.8, 1.2);
    for _ in 0..60 {
        let middle = 0.5 * (lo + hi);
        if gap(middle) > 0.0 { lo = middle } else { hi = middle }
    }
    0.5 * (lo + hi)
}
