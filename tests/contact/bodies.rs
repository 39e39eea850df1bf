//! A beam that moves as one body against a wall: flat, nothing bends it.

use serde_json::{Value, json};

use super::{beam, run};

/// `y' = f(y)` by Runge and Kutta's classical method, to each of some times.
fn integrated(times: &[f64], start: [f64; 2], f: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<[f64; 2]> {
    let along = |y: [f64; 2], h: f64, k: [f64; 2]| [y[0] + h * k[0], y[1] + h * k[1]];
    let mut y = start;
    let mut all = vec![y];
    for pair in times.windows(2) {
        let h = (pair[1] - pair[0]) / 500.0;
        for _ in 0..500 {
            let k1 = f(y);
            let k2 = f(along(y, 0.5 * h, k1));
            let k3 = f(along(y, 0.5 * h, k2));
            let k4 = f(along(y, h, k3));
            y = [0, 1].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        }
        all.push(y);
    }
    all
}

fn floor(more: Value) -> Value {
    let mut wall = json!({"name": "floor", "point_m": [-0.01, 0], "normal": [1, 0], "stiffness_pa": 1e4, "reach_m": 0, "smoothing_m": 2e-3});
    for (key, value) in more.as_object().unwrap() {
        wall[key] = value.clone();
    }
    json!([wall])
}

/// Source: `m x'' = k s(g) m(1 + c g') - m 9.81`, of one body, integrated here. Goal: 1e-6 of the way over three bounces, with damping
/// and without; without, the energy is kept.
#[test]
fn a_beam_that_falls_flat_bounces_as_one_body() {
    for damping in [0.0, 1.5] {
        let mut case = beam(json!("free"), json!("free"), floor(json!({"damping_s_m": damping})));
        case["loads"] = json!([{"gravity": {"x_m_s2": -9.81}}]);
        case["time"] = json!({"end_s": 0.4, "output_interval_s": 2e-3});
        case["solver"] = json!({"rtol": 1e-10});
        let (memory, summary) = run(&case);
        let exact = integrated(&memory.column("t").unwrap(), [0.0, 0.0], |[x, v]| {
            let g = -0.01 - x;
            let s = match g {
                g if g <= 0.0 => 0.0,
                g if g < 2e-3 => 0.5 * g * g / 2e-3,
                g => g - 1e-3,
            };
            let factor = match -damping * v {
                x if x >= -0.5 => 1.0 + x,
                x if x > -1.5 => 0.5 * (x + 1.5) * (x + 1.5),
                _ => 0.0,
            };
            [v, 1e4 * s * factor - 9.81]
        });
        let ours = memory.column("tip_u1").unwrap();
        let off = ours
            .iter()
            .zip(&exact)
            .map(|(a, b)| (a - b[0]).abs())
            .fold(0.0, f64::max);
        let turns = exact.windows(2).filter(|w| w[0][1] < 0.0 && w[1][1] > 0.0).count();
        println!(
            "c = {damping}: {off:e} {turns} {:e}",
            summary.balances.energy_residual_relative
        );
        assert!(turns >= 3 && off < 1e-8, "c = {damping}: {off:e}, {turns} bounces");
        assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
        if damping == 0.0 {
            assert!(
                memory
                    .column("dissipated_damping")
                    .unwrap()
                    .iter()
                    .all(|lost| *lost == 0.0)
            );
        }
    }
}

/// Source: Coulomb: a body that slides with v on the ground under its weight stops within `v²/(2 μ g)`. Goal: 1e-3, what the velocity below
/// which friction lets go leaves.
#[test]
fn a_beam_slides_to_rest() {
    let friction =
        json!({"friction_coefficient": 0.3, "friction_velocity_m_s": 1e-4, "damping_s_m": 1.0, "point_m": [0, 0]});
    let mut case = beam(json!("free"), json!("free"), floor(friction));
    case["loads"] = json!([{"gravity": {"x_m_s2": -9.81}}]);
    // at rest in the ground: k (g - d/2) = m 9.81
    case["start"] = json!({"u1_m": -(9.81e-4_f64 * 2.0 * 2e-3).sqrt(), "u3_rate_m_s": 0.5});
    case["time"] = json!({"end_s": 0.3, "output_interval_s": 2e-3});
    case["solver"] = json!({"rtol": 1e-7});
    let (memory, summary) = run(&case);
    let slid = *memory.column("tip_u3").unwrap().last().unwrap();
    let exact = 0.25 / (2.0 * 0.3 * 9.81);
    println!("{slid} {exact} {:e}", summary.balances.energy_residual_relative);
    assert!((slid / exact - 1.0).abs() < 1e-3, "{slid} {exact}");
    assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
    let friction = memory.column("contact_floor_friction_force").unwrap();
    let normal = memory.column("contact_floor_normal_force").unwrap();
    assert!((friction[20].abs() / normal[20] - 0.3).abs() < 1e-6);
}
