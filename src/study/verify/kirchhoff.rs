//! A steady network as a network of resistors.

use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};

use super::figure::ExactFigure;
use super::problem::SolvedProblem;
use super::solve::solve;
use super::wet::{BLADDER, TUBE, case};
use crate::error::Result;

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    vec![SolvedProblem::new(
        "network-kirchhoff",
        [
            "Kirchhoff 1847: conductances times pressures, a dense solve",
            "tees, loops, ports at three pressures, a source, a turbine: steady pressures and the power put in",
            "after 60 of the slowest decay times e^-60 is left of the start; what remains is Newton's tolerance, rtol 1e-9",
        ],
        compare,
    )]
}

/// Nodes of the resistor network: centers of bladders 1 to 4, then two tees.
const NODES: usize = 6;
const PRESSURES: [f64; 3] = [1000.0, -400.0, 150.0];
const SOURCE: f64 = 2e-6;
const TURBINE: f64 = 1.3e-8;

fn network() -> Value {
    let bladder = |index: i64, end: &str| json!({"bladder": index, "end": end});
    let tee = |name: &str| json!({"junction": name});
    json!({
        "junctions": ["left", "right"],
        "tubes": [
            {"from": bladder(1, "outlet"), "to": tee("left")},
            {"from": tee("left"), "to": bladder(2, "inlet"), "length_m": 0.03},
            {"from": tee("left"), "to": bladder(3, "inlet")},
            {"from": bladder(2, "outlet"), "to": tee("right")},
            {"from": bladder(3, "outlet"), "to": tee("right"), "length_m": 0.05},
            {"from": tee("right"), "to": bladder(4, "inlet")}
        ],
        "turbines": [{"from": tee("left"), "to": tee("right"), "conductance": {"m3_s_pa": TURBINE}}],
        "ports": [
            {"at": bladder(1, "inlet"), "pressure_pa": PRESSURES[0]},
            {"at": bladder(4, "outlet"), "pressure_pa": PRESSURES[1]},
            {"at": tee("right"), "flow_m3_s": SOURCE}
        ]
    })
}

fn compare() -> Result<Vec<ExactFigure>> {
    let end = 0.05;
    let solved = solve(&case(4, network(), end, end / 10.0))?;
    let (exact, power) = resistors();
    let last = solved.field("pressure_pa").last().cloned().unwrap_or_default();
    let work = solved.column("work_ports");
    let computed = match work[..] {
        [.., before, now] => (now - before) / (end / 10.0),
        _ => f64::NAN,
    };
    let mut figures: Vec<ExactFigure> = (0..4)
        .map(|b| {
            let p = last.get(b).copied().unwrap_or(f64::NAN);
            ExactFigure::relative(format!("pressure of bladder {} [Pa]", b + 1), p, exact[b], 1e-6)
        })
        .collect();
    let turbine = TURBINE * (exact[4] - exact[5]).powi(2);
    figures.push(ExactFigure::relative(
        "power of the turbine [W]",
        solved.last("turbine_power"),
        turbine,
        1e-6,
    ));
    figures.push(ExactFigure::relative("power put in [W]", computed, power, 1e-6));
    Ok(figures)
}

/// Pressures of the nodes [Pa] and the power put in [W].
fn resistors() -> (DVector<f64>, f64) {
    let half = 0.5 * BLADDER;
    let branches = [
        (0, 4, half + TUBE),
        (4, 1, 1.5 * TUBE + half),
        (4, 2, TUBE + half),
        (1, 5, half + TUBE),
        (2, 5, half + 2.5 * TUBE),
        (5, 3, TUBE + half),
        (4, 5, 1.0 / TURBINE),
    ];
    let mut matrix = DMatrix::zeros(NODES, NODES);
    let mut flow = DVector::zeros(NODES);
    for (a, b, resistance) in branches {
        let g = 1.0 / resistance;
        for (i, j) in [(a, b), (b, a)] {
            matrix[(i, i)] += g;
            matrix[(i, j)] -= g;
        }
    }
    for (node, pressure) in [(0, PRESSURES[0]), (3, PRESSURES[1])] {
        matrix[(node, node)] += 1.0 / half;
        flow[node] += pressure / half;
    }
    flow[5] += SOURCE;
    let pressures = matrix
        .lu()
        .solve(&flow)
        .unwrap_or_else(|| DVector::from_element(NODES, f64::NAN));
    let inflow = |node: usize, pressure: f64| (pressure - pressures[node]) / half;
    let power = PRESSURES[0] * inflow(0, PRESSURES[0]) + PRESSURES[1] * inflow(3, PRESSURES[1]) + SOURCE * pressures[5];
    (pressures, power)
}
