//! Axial base acceleration: parametric resonance of the first bending mode.

use std::f64::consts::PI;

use serde_json::json;

use super::figure::ExactFigure;
use super::fit::growth_of_spans;
use super::frequencies::free_shape;
use super::problem::SolvedProblem;
use super::scene::motion;
use super::solve::solve;
use crate::error::Result;
use crate::model::characteristic::{MATHIEU_COUPLING, mathieu_growth};

const BETA: f64 = 1.875104068712;
/// `ε = κ1 A/(L ω1²)`.
const MODULATION: f64 = 0.2;
/// Samples per period of the base motion.
const SAMPLES: usize = 20;

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    let source = "single mode: q'' + [w1^2 - 1.57087818999 a(t)/L] q = 0, growth from its monodromy matrix; unstable where |W/(2 w1) - 1| < eps/4";
    vec![
        SolvedProblem::new(
            "mathieu-inside",
            [
                source,
                "growth in the middle of the principal tongue, eps = 0.2, W = 2 w1",
                "a single mode leaves out the second: (eps w1/w2)^2, 1e-3; w1 of 40 cells is off by 5e-4 of W, a hundredth of the half width",
            ],
            || {
                let exact = mathieu_growth(BETA.powi(4), MODULATION * BETA.powi(4), 2.0 * BETA * BETA);
                Ok(vec![ExactFigure::relative(
                    "growth rate L^2 sqrt(m/EI)",
                    growth(1.0)?,
                    exact,
                    3e-3,
                )])
            },
        ),
        SolvedProblem::new(
            "mathieu-outside",
            [
                source,
                "no growth outside the principal tongue, eps = 0.2, W = 2.2 w1: 10 % off, twice the half width of 5 %",
                "bounded motion beats: spans differ, but without a trend; inside the tongue the growth is 0.18 1/s",
            ],
            || {
                Ok(vec![ExactFigure::absolute(
                    "growth rate L^2 sqrt(m/EI)",
                    growth(1.1)?,
                    0.0,
                    0.01,
                )])
            },
        ),
    ]
}

/// Growth rate of the tip deflection if the base is shaken at `2 ω1 detuning` [1/s].
fn growth(detuning: f64) -> Result<f64> {
    let first = BETA * BETA;
    let omega = 2.0 * first * detuning;
    let amplitude = MODULATION * first * first / MATHIEU_COUPLING / (omega * omega);
    let interval = 2.0 * PI / omega / SAMPLES as f64;
    let periods = 36;
    let mut case = motion(
        40,
        |x| free_shape(BETA, x),
        (periods * SAMPLES) as f64 * interval,
        interval,
    );
    case["ends"]["root"] =
        json!({"clamped": {"u3_m": {"sine": {"amplitude": amplitude, "frequency_hz": omega / (2.0 * PI)}}}});
    // The whole beam starts with the velocity of the base; otherwise the velocity jump would excite an axial wave.
    case["start"]["u3_rate_m_s"] = json!(amplitude * omega);
    let tip = solve(&case)?.column("tip_u1");
    Ok(growth_of_spans(&tip, 4 * SAMPLES, interval, 3))
}
