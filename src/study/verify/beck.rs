//! Beck's column: flutter under a tip load that stays tangential.

use serde_json::json;

use super::figure::Figure;
use super::fit::{growth_of_spans, oscillation, through};
use super::frequencies::free_shape;
use super::row::Row;
use super::scene::{SMALL, motion, unit_beam};
use super::solve::{on_three_meshes, solve};
use crate::error::Result;

/// Flutter load `P L²/EI` and frequency `ω L² √(m/EI)`.
const LOAD: f64 = 20.0509536;
const FREQUENCY: f64 = 11.0155576;

/// Deflection at the start [m], so small that 5 s of growth do not make it large.
const START: f64 = 1e-9;

/// All rows.
pub fn rows() -> Vec<Row> {
    vec![flutter(), below()]
}

/// Tip displacement after a small push under the load `p`, and the interval of its samples [s].
fn tip(cells: usize, p: f64, end: f64) -> Result<(Vec<f64>, f64)> {
    let interval = 0.02;
    let mut case = motion(cells, |x| free_shape(1.875104068712, x), end, interval);
    case["beam"] = unit_beam(100.0);
    case["ends"]["tip"] = json!({"free": {"follower_normal_n": -p}});
    // Compressed from the start, else an axial wave of the size of the load would run to and fro.
    case["start"]["u3_m"] = json!({"polynomial": {"coefficients": [0.0, -p / 1.2e7]}});
    case["start"]["u1_m"] = json!({"product": [START / SMALL, case["start"]["u1_m"]]});
    case["solver"]["transverse_scale_m"] = json!(START);
    Ok((solve(&case)?.column("tip_u1"), interval))
}

/// Where two modes meet, `λ²` has a square root of `P - Pc`: the square of its imaginary part goes through zero at the
/// flutter load, its real part is `-ω²` there; both are smooth in P.
fn flutter() -> Row {
    Row::new(
        "beck-flutter",
        [
            "Beck 1952; Bolotin: P L^2/EI = 20.0509536, w L^2 sqrt(m/EI) = 11.0155576, undamped",
            "follower loads; loss of stability by flutter. Growth rates and frequencies at 20.6 to 21.5 taken back to where growth begins",
            "second order: (pi h)^2 times a constant below 1, 1.5e-3 with 80 cells; the limit keeps h^4, the curvature beyond a cubic through four loads, the shortening P/EA = 2e-6 and the integrator, rtol 1e-6",
        ],
        || {
            let [load, frequency] = on_three_meshes(20, |cells| {
                let mut growth = vec![];
                let mut square = vec![];
                for p in [20.6, 20.9, 21.2, 21.5] {
                    let (tip, interval) = tip(cells, p, 5.0)?;
                    // After 3 s the growing pair of modes is alone: the others are less than e^-10 of it.
                    let (rate, w) = oscillation(&tip[3 * tip.len() / 5..], interval);
                    growth.push(((2.0 * rate * w).powi(2), p));
                    square.push((p, w * w - rate * rate));
                }
                let load = through(&growth, 0.0);
                Ok([load, through(&square, load).sqrt()])
            })?;
            Ok(vec![
                Figure::relative("P L^2/EI", load[2], LOAD, 1.5e-3).on_meshes(load, 2e-4),
                Figure::relative("w L^2 sqrt(m/EI)", frequency[2], FREQUENCY, 1.5e-3).on_meshes(frequency, 2e-4),
            ])
        },
    )
}

fn below() -> Row {
    Row::new(
        "beck-below",
        [
            "Beck 1952: undamped and below the flutter load every motion stays bounded",
            "no growth is made by follower load, mesh or integrator at P L^2/EI = 19.5",
            "the largest deflections of equal spans differ by where the beat of the two modes is met; at 20.6 the growth is 1.8 1/s",
        ],
        || {
            let (tip, interval) = tip(40, 19.5, 12.0)?;
            Ok(vec![Figure::absolute(
                "growth rate L^2 sqrt(m/EI)",
                growth_of_spans(&tip, 150, interval, 0),
                0.0,
                0.02,
            )])
        },
    )
}
