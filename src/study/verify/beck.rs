//! Beck's column: flutter under a tip load that stays tangential.

use serde_json::{Value, json};

use super::figure::ExactFigure;
use super::fit::growth_of_spans;
use super::frequencies::free_shape;
use super::problem::SolvedProblem;
use super::scene::{SMALL, motion, unit_beam};
use super::solve::{modes, on_three_meshes, solve};
use crate::error::Result;

/// Flutter load `P L²/EI` and frequency `ω L² √(m/EI)`.
const LOAD: f64 = 20.0509536;
const FREQUENCY: f64 = 11.0155576;

/// Initial deflection [m], so small that 5 s of growth do not make it large.
const START: f64 = 1e-9;

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    vec![flutter(), below()]
}

/// The straight, compressed column under the load `p`.
fn column(cells: usize, p: f64, end: f64, interval: f64) -> Value {
    let mut case = motion(cells, |x| free_shape(1.875104068712, x), end, interval);
    case["beam"] = unit_beam(100.0);
    case["ends"]["tip"] = json!({"free": {"follower_normal_n": -p}});
    // Compressed at the start; otherwise an axial wave of the size of the load would travel along the column.
    case["start"]["u3_m"] = json!({"polynomial": {"coefficients": [0.0, -p / 1.2e7]}});
    case
}

/// Tip displacement after a small initial deflection under the load `p`, and the interval of its samples [s].
fn tip(cells: usize, p: f64, end: f64) -> Result<(Vec<f64>, f64)> {
    let interval = 0.02;
    let mut case = column(cells, p, end, interval);
    case["start"]["u1_m"] = json!({"product": [START / SMALL, case["start"]["u1_m"]]});
    case["solver"]["transverse_scale_m"] = json!(START);
    Ok((solve(&case)?.column("tip_u1"), interval))
}

/// Discriminant `((s1² - s2²)/2)²` and mean `-(s1² + s2²)/2` of the two slowest modes of the column. Both are smooth
/// functions of the load where the modes meet, and the discriminant passes through zero there.
fn slowest(cells: usize, p: f64) -> Result<(f64, f64)> {
    let mut case = column(cells, p, 1.0, 1.0);
    case["start"]["u1_m"] = json!(0.0);
    let found = modes(&case, 3)?;
    let [a, b, ..] = found.modes.as_slice() else {
        return Ok((f64::NAN, f64::NAN));
    };
    let (a, b) = (a.s * a.s, b.s * b.s);
    let half = (a - b) * 0.5;
    Ok(((half * half).re, -0.5 * (a + b).re))
}

/// Loads between which the onset of flutter is searched.
const BETWEEN: [f64; 2] = [19.5, 21.5];
/// Largest number of secant steps, each of which gains about two thirds more digits.
const STEPS: usize = 8;

/// Flutter load and frequency on a mesh: the root of the discriminant by secants.
fn onset(cells: usize) -> Result<[f64; 2]> {
    let [mut a, mut b] = BETWEEN;
    let (mut fa, mut fb) = (slowest(cells, a)?, slowest(cells, b)?);
    for _ in 0..STEPS {
        let next = b - fb.0 * (b - a) / (fb.0 - fa.0);
        // below this, the discriminant of two eigenvalues that meet is a rounding error
        if (next - b).abs() < 1e-7 {
            break;
        }
        (a, fa) = (b, fb);
        (b, fb) = (next, slowest(cells, next)?);
    }
    Ok([b, fb.1.sqrt()])
}

fn flutter() -> SolvedProblem {
    SolvedProblem::new(
        "beck-flutter",
        [
            "Beck 1952; Bolotin: P L^2/EI = 20.0509536, w L^2 sqrt(m/EI) = 11.0155576, undamped",
            "follower loads; loss of stability by flutter: the load at which the two slowest modes of the column meet",
            "second order: (pi h)^2 times a constant below 1, 1.5e-3 with 80 cells; the limit keeps h^4, (pi h)^4 = 3.8e-5 with 40, and              the shortening P/EA = 2e-6",
        ],
        || {
            let [load, frequency] = on_three_meshes(20, onset)?;
            Ok(vec![
                ExactFigure::converging("P L^2/EI", load, LOAD, 1.5e-3, 4e-5),
                ExactFigure::converging("w L^2 sqrt(m/EI)", frequency, FREQUENCY, 1.5e-3, 4e-5),
            ])
        },
    )
}

fn below() -> SolvedProblem {
    SolvedProblem::new(
        "beck-below",
        [
            "Beck 1952: undamped and below the flutter load every motion stays bounded",
            "no growth is made by follower load, mesh or integrator at P L^2/EI = 19.5",
            "the largest deflections of equal spans differ by where the beat of the two modes is met; at 20.6 the growth is 1.8 1/s",
        ],
        || {
            let (tip, interval) = tip(40, 19.5, 12.0)?;
            Ok(vec![ExactFigure::absolute(
                "growth rate L^2 sqrt(m/EI)",
                growth_of_spans(&tip, 150, interval, 0),
                0.0,
                0.02,
            )])
        },
    )
}
