//! Permeabilities of cross-sections, from the input power of a tube under a pressure drop.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::figure::ExactFigure;
use super::problem::SolvedProblem;
use super::solve::solve;
use super::wet::{TUBE_LENGTH, VISCOSITY, case};
use crate::error::Result;

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    let a: f64 = 2e-3;
    vec![
        duct(
            "circle",
            "Hagen-Poiseuille: pi r^4/8",
            json!({"circle": {"radius_m": a}}),
            PI * a.powi(4) / 8.0,
            "closed form: round-off and the integrator's",
            1e-9,
        ),
        duct(
            "square",
            "White, Viscous Fluid Flow: 0.0351443 a^4",
            json!({"rectangle": {"height_m": a, "width_m": a}}),
            0.0351443 * a.powi(4),
            "half of the last digit given, 5e-8 of 0.035, is 1.4e-6",
            1.5e-6,
        ),
        duct(
            "slot",
            "White, Viscous Fluid Flow, plate limit: a b^3/12 (1 - 192 zeta(5)(31/32) b/(pi^5 a)), a = 10 b",
            json!({"rectangle": {"height_m": a, "width_m": 0.1 * a}}),
            slot(a, 0.1 * a),
            "for a = 10 b every tanh of the series is 1 to 1e-13",
            1e-9,
        ),
        duct(
            "ellipse",
            "integral of (1 - (x/a)^2 - (y/b)^2)/(2 (1/a^2 + 1/b^2)): pi a^3 b^3/(4 (a^2 + b^2))",
            json!({"ellipse": {"semi_axis_a_m": a, "semi_axis_b_m": 0.3 * a}}),
            PI * 0.027 * a.powi(4) / (4.0 * 1.09),
            "closed form: round-off and the integrator's",
            1e-9,
        ),
        duct(
            "triangle",
            "integral of d1 d2 d3/H (distances from the sides, height H): sqrt(3) a^4/320",
            json!({"triangle": {"side_m": a}}),
            3.0_f64.sqrt() * a.powi(4) / 320.0,
            "closed form: round-off and the integrator's",
            1e-9,
        ),
    ]
}

/// `a b³/12 (1 - (192 b/π⁵ a) Σ_{odd k} k⁻⁵)` with `Σ = 31 ζ(5)/32`.
fn slot(a: f64, b: f64) -> f64 {
    let sum = 31.0 / 32.0 * 1.036_927_755_143_37;
    a * b.powi(3) / 12.0 * (1.0 - 192.0 * b / (PI.powi(5) * a) * sum)
}

fn duct(
    name: &str,
    source: &'static str,
    section: Value,
    exact: f64,
    reason: &'static str,
    tolerance: f64,
) -> SolvedProblem {
    SolvedProblem::new(
        format!("duct-{name}"),
        [
            source,
            "permeability of a tube given by its cross-section, q1 = P mu l/drop^2 from the power P put in",
            reason,
        ],
        move || {
            Ok(vec![ExactFigure::relative(
                "q1 [m^4]",
                permeability(&section)?,
                exact,
                tolerance,
            )])
        },
    )
}

/// Permeability of the tube between two junctions at given pressures.
fn permeability(section: &Value) -> Result<f64> {
    const DROP: f64 = 100.0;
    let network = json!({
        "junctions": ["high", "low"],
        "tubes": [{"from": {"junction": "high"}, "to": {"junction": "low"}, "cross_section": section}],
        "ports": [
            {"at": {"junction": "high"}, "pressure_pa": DROP},
            {"at": {"junction": "low"}, "pressure_pa": 0}
        ]
    });
    let end = 1.0;
    let work = solve(&case(1, network, end, end))?.last("work_ports");
    Ok(work / end * VISCOSITY * TUBE_LENGTH / (DROP * DROP))
}
