//! Beams that come to lie on a wall: equilibria under their weight.

use serde_json::{Value, json};
use slcbeam::run::equilibrium::{EquilibriumOptions, follow};
use slcbeam::run::record::Control;

use super::{parse, run};

/// Weight of the beam [N/m].
const WEIGHT: f64 = 1000.0 * 0.005 * 0.02 * 9.81;

/// A soft cantilever that its weight presses onto a wall at a distance below it.
fn lying(gap: f64, stiffness: f64, smoothing: f64) -> Value {
    json!({
        "name": "lying",
        "beam": {"length_m": 0.2, "height_m": 0.005, "width_m": 0.02, "young_modulus_pa": 1e6, "density_kg_m3": 1000},
        "ends": {"root": "clamped", "tip": "free"},
        "contacts": [{"name": "wall", "point_m": [-0.0025 - gap, 0], "normal": [1, 0], "stiffness_pa": stiffness, "smoothing_m": smoothing}],
        "mesh": {"segments": 10},
        "time": {"end_s": 1, "output_interval_s": 0.01},
        "loads": [{"gravity": {"x_m_s2": -9.81}}]
    })
}

/// Depth at which a wall of this stiffness and smoothing carries the weight [m].
fn depth(stiffness: f64, smoothing: f64) -> f64 {
    let whole = WEIGHT / stiffness + 0.5 * smoothing;
    if whole >= smoothing {
        whole
    } else {
        (2.0 * smoothing * WEIGHT / stiffness).sqrt()
    }
}

/// Source: far from the root every length of the beam is carried by the wall under it. Goal: 30 scenes over gap, stiffness and smoothing all have
/// an equilibrium in which the whole weight is carried; the tip is off the wall's depth by less than 0.5 %, which the bent part near the
/// root leaves on the softest walls.
#[test]
fn beams_come_to_lie_on_walls() {
    for gap in [0.0, 1e-5, 1e-4, 1e-3, 1e-2] {
        for stiffness in [2e3, 2e4, 1e6] {
            for smoothing in [1e-6, 1e-4] {
                let case = parse(&lying(gap, stiffness, smoothing));
                let path = follow(&case, &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
                assert!(path.fault.is_none(), "{gap} {stiffness} {smoothing}: {:?}", path.fault);
                let tip = *path.last().u1.last().unwrap();
                let exact = -(gap + depth(stiffness, smoothing));
                let scene = format!("{gap} {stiffness} {smoothing}: {tip} in place of {exact}");
                assert!((tip / exact - 1.0).abs() < 5e-3, "{scene}");
                assert_eq!(path.last().stability.unwrap().unstable, 0, "{scene}");
            }
        }
    }
}

/// Goal: a run that begins in that equilibrium stays there, within 1e-6 of the depth.
#[test]
fn runs_begin_on_walls() {
    let mut case = lying(0.0, 2e4, 1e-5);
    case["start"] = json!({"equilibrium": {"loads_at_s": 0}});
    case["time"] = json!({"end_s": 0.05});
    let (memory, _) = run(&case);
    let tip = memory.column("tip_u1").unwrap();
    let exact = -depth(2e4, 1e-5);
    assert!(tip.iter().all(|u| (u / exact - 1.0).abs() < 1e-3), "{tip:?}");
    assert!(tip.iter().all(|u| (u / tip[0] - 1.0).abs() < 1e-6), "{tip:?}");
}
