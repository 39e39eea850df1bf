//! Euler's column, a column under its own weight, the elastica beyond buckling.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::figure::Figure;
use super::fit::through;
use super::row::Row;
use super::scene::{growing, load_path, unit_beam};
use super::solve::{on_three_meshes, solve};
use crate::error::Result;

/// Euler's load of the unit cantilever [N].
const EULER: f64 = PI * PI / 4.0;

/// All rows.
pub fn rows() -> Vec<Row> {
    vec![
        euler(),
        self_weight(),
        elastica(20, 1.015396866, None),
        elastica(60, 1.15171962, Some([0.7410196, 0.5932076])),
    ]
}

/// Load at which the lateral stiffness `f/w` of the tip vanishes, as a multiple of `expected`, which the case reaches at
/// time 1 s: the polynomial through loads over stiffnesses along the path, taken at zero stiffness. A tip force `f` of
/// 1e-6 N keeps the deflection so small that nothing but the load softens the column.
fn vanishing_stiffness(mut case: Value) -> Result<f64> {
    case["ends"]["tip"]["free"]["force_x_n"] = json!(1e-6);
    // Samples between steps are the integrator's polynomial: its tolerance is theirs.
    case["solver"]["rtol"] = json!(1e-9);
    case["solver"]["transverse_scale_m"] = json!(1e-6);
    let solved = solve(&case)?;
    let loads = solved.column("t");
    let points: Vec<(f64, f64)> = solved
        .column("tip_u1")
        .iter()
        .map(|w| 1e-6 / w)
        .zip(loads)
        .skip(14)
        .collect();
    Ok(through(&points, 0.0))
}

fn euler() -> Row {
    Row::new(
        "euler-load",
        [
            "Euler 1744: P L^2/EI = pi^2/4, clamped-free",
            "geometric stiffness: the load at which the lateral stiffness of the column vanishes",
            "second order: (pi h/2)^2/12 for the chain of links, a quarter of that band left; the limit keeps h^4, EI/EA L^2 = 1e-8 and Newton's tolerance over the stiffness",
        ],
        || {
            let [load] = on_three_meshes(20, |cells| {
                let mut case = load_path(unit_beam(1000.0), cells, 0.95, 0.05);
                case["ends"]["tip"] = json!({"free": {"force_z_n": growing(-EULER)}});
                Ok([EULER * vanishing_stiffness(case)?])
            })?;
            Ok(vec![
                Figure::relative("P L^2/EI", load[2], EULER, 5e-5).on_meshes(load, 1e-6),
            ])
        },
    )
}

fn self_weight() -> Row {
    const EXACT: f64 = 7.83734743894;
    Row::new(
        "self-weight",
        [
            "Greenhill 1881: q L^3/EI = 7.83734743894",
            "geometric stiffness of a distributed axial load",
            "second order, constant below 1 with 80 cells: h^2 = 1.6e-4; the limit keeps h^4 and Newton's tolerance over the stiffness",
        ],
        || {
            let [load] = on_three_meshes(20, |cells| {
                let mut case = load_path(unit_beam(1000.0), cells, 0.95, 0.05);
                case["ends"]["tip"] = json!({"free": {}});
                case["loads"] = json!([{"force_z_n_m": {"signal": growing(-EXACT)}}]);
                Ok([EXACT * vanishing_stiffness(case)?])
            })?;
            Ok(vec![
                Figure::relative("q L^3/EI", load[2], EXACT, 1.6e-4).on_meshes(load, 1e-6),
            ])
        },
    )
}

/// The column is bent by a lateral force, loaded, and the lateral force taken away: what stays is the buckled branch,
/// without imperfection.
fn elastica(degrees: u32, ratio: f64, place: Option<[f64; 2]>) -> Row {
    Row::new(
        format!("elastica-{degrees}-degrees"),
        [
            "Timoshenko & Gere, Theory of Elastic Stability, 2.7 (elastica by elliptic integrals)",
            "the buckled branch beyond Euler's load, reached through a lateral force that is taken away again",
            "second order; near the critical load an error of the load turns into one of the angle 4/angle^2 times as large (33 times at 20 degrees): of Euler's load on the mesh, 2e-6 with 320 cells; the limit keeps the stretch P/EA = 2e-8",
        ],
        move || {
            let [angle, z, x] = on_three_meshes(80, |cells| {
                let mut case = load_path(unit_beam(1000.0), cells, 4.0, 4.0);
                let step = |from: f64, to: f64, start: f64| json!({"ramp": {"from": from, "to": to, "start_s": start, "duration_s": 1.0}});
                let bend = 0.05;
                case["ends"]["tip"] = json!({"free": {
                    "force_x_n": {"sum": [step(0.0, bend, 0.0), step(0.0, -bend, 2.0)]},
                    "force_z_n": step(0.0, -ratio * EULER, 1.0)
                }});
                let solved = solve(&case)?;
                let degrees = solved.last("tip_angle").to_degrees();
                Ok([degrees, 1.0 + solved.last("tip_u3"), solved.last("tip_u1")])
            })?;
            let magnified = 4.0 / f64::from(degrees).to_radians().powi(2);
            let mut figures = vec![
                Figure::relative("tip angle [degrees]", angle[2], f64::from(degrees), 4e-6 * magnified)
                    .on_meshes(angle, 3e-8 * magnified),
            ];
            if let Some([along, across]) = place {
                figures.push(Figure::relative("x/L", z[2], along, 2e-5).on_meshes(z, 2e-7));
                figures.push(Figure::relative("y/L", x[2], across, 2e-5).on_meshes(x, 2e-7));
            }
            Ok(figures)
        },
    )
}
