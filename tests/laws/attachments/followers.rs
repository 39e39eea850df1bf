//! Forces that turn with the beam at places, [E68].
//!
//! Sources: Beck 1952 for the tip; the column's equation, `EI d⁴w + P d²w = ω² m w` below the force and without P beyond it, whose solutions
//! are added up here by Taylor's series; the followers of ends.

use serde_json::{Value, json};
use slcbeam::dae::{BeamDae, Dae as _};
use slcbeam::discrete::System;
use slcbeam::run::modes::{self, ModeOptions};

use super::{parse, slender};
use crate::chance::Random;

/// A cantilever, EI = m = l = 1, that a force pushes along its tangent at a place, at rest under it.
fn column(at: f64, force: f64, cells: usize, effects: &Value) -> Value {
    let push = json!([{"at": at, "force_tangential_n": -force}]);
    let mut case = slender(json!("clamped"), json!("free"), push, cells);
    case["start"] = json!({"equilibrium": {}});
    case["effects"] = effects.clone();
    case
}

/// Squares of the two lowest frequencies, which may be complex: their mean and the square of half their difference.
fn slowest(case: &Value) -> [f64; 2] {
    let plan = ModeOptions {
        count: 3,
        near_hz: 0.0,
        limits: false,
    };
    let found = modes::modes(&parse(case), &plan).unwrap();
    let [a, b, ..] = found.modes.as_slice() else {
        panic!("two modes")
    };
    let (a, b) = (-(a.s * a.s), -(b.s * b.s));
    let half = (a - b) * 0.5;
    [((a + b) * 0.5).re, (half * half).re]
}

/// Value and first three derivatives a length `x` on, of `d⁴w = ω² w - p d²w`.
pub fn onward(start: [f64; 4], p: f64, squared: f64, x: f64) -> [f64; 4] {
    let mut c = vec![start[0], start[1], start[2] / 2.0, start[3] / 6.0];
    for k in 0..60 {
        let n = k as f64;
        let next =
            (squared * c[k] - p * (n + 2.0) * (n + 1.0) * c[k + 2]) / ((n + 4.0) * (n + 3.0) * (n + 2.0) * (n + 1.0));
        c.push(next);
    }
    let mut values = [0.0; 4];
    for value in &mut values {
        *value = c.iter().rev().fold(0.0, |sum, c| sum * x + c);
        c = (1..c.len()).map(|k| k as f64 * c[k]).collect();
    }
    values
}

/// What is zero at a frequency of the cantilever: moment and shear at the tip of two solutions that are clamped at the root.
fn exact(at: f64, force: f64, squared: f64) -> f64 {
    let [a, b] = [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]].map(|root| {
        let place = onward(root, force, squared, at);
        onward(place, 0.0, squared, 1.0 - at)
    });
    a[2] * b[3] - a[3] * b[2]
}

/// The two lowest `ω²` by a fine search: none where they have met.
fn lowest(at: f64, force: f64) -> Vec<f64> {
    let f = |squared: f64| exact(at, force, squared);
    let step = 0.25;
    let places = (0..4000).map(|k| (k as f64 * step, (k + 1) as f64 * step));
    let found = places.filter(|(low, high)| f(*low) * f(*high) < 0.0);
    found
        .map(|(low, high)| super::root_between(f, low, high))
        .take(2)
        .collect()
}

/// Goal: frequencies below flutter, between nodes and at the tip. Second order; what two meshes leave is of fourth, some (β h)⁴ of the
/// second mode, 1e-4.
#[test]
fn a_column_that_a_follower_pushes_at_a_place() {
    let effects = json!({"finite_rotation": "off"});
    for (at, force) in [(0.37, 20.0), (0.63, 15.0), (1.0, 15.0)] {
        let exact = lowest(at, force);
        let (mean, square) = (0.5 * (exact[0] + exact[1]), 0.25 * (exact[0] - exact[1]).powi(2));
        let [coarse, fine] = [20, 60].map(|cells| slowest(&column(at, force, cells, &effects)));
        let limit = |k: usize| fine[k] + (fine[k] - coarse[k]) / 8.0;
        let errors = [limit(0) / mean - 1.0, limit(1) / square - 1.0];
        println!("{at}, {force}: {errors:?} of {exact:?}");
        assert!(errors.iter().all(|error| error.abs() < 1e-3));
    }
}

/// Goal: Beck's column flutters at `P l²/EI = 20.0509536`, whatever the kinematics that know of normal forces. The discriminant of the
/// two lowest modes goes through zero there; second order in the mesh, 0.5 % on 40 cells.
#[test]
fn becks_column_flutters() {
    for effects in [json!({"finite_rotation": "off"}), json!("full")] {
        let square = |force: f64| slowest(&column(1.0, force, 40, &effects))[1];
        let (mut a, mut b) = (19.5, 20.5);
        let (mut fa, mut fb) = (square(a), square(b));
        for _ in 0..4 {
            let next = b - fb * (b - a) / (fb - fa);
            (a, fa) = (b, fb);
            (b, fb) = (next, square(next));
            if (b - a).abs() < 1e-5 {
                break;
            }
        }
        println!("{effects}: {b}, {:.1e}", b / 20.050_953_6 - 1.0);
        assert!((b / 20.050_953_6 - 1.0).abs() < 5e-3);
    }
}

/// Goal: at the tip and at the root the equations are those of followers of ends, whatever the state, to round-off. N and V of the
/// root act on the beam with the opposite sign.
#[test]
fn a_follower_at_an_end_is_that_of_the_end() {
    for effects in [
        json!({}),
        json!({"finite_rotation": "off"}),
        json!({"finite_rotation": "off", "axial_force_on_bending": "off"}),
        json!({"shear": "on", "rotary_inertia": "on"}),
    ] {
        let ends = json!({"free": {"follower_normal_n": -7.0, "follower_shear_n": 3.0}});
        let place =
            |at: f64, sign: f64| json!({"at": at, "force_tangential_n": -7.0 * sign, "force_normal_n": 3.0 * sign});
        let by_ends = slender(ends.clone(), ends, json!([]), 6);
        let places = json!([place(0.0, -1.0), place(1.0, 1.0)]);
        let by_places = slender(json!("free"), json!("free"), places, 6);
        let residuals = [by_ends, by_places].map(|mut case| {
            case["effects"] = effects.clone();
            if effects["shear"] == "on" {
                case["beam"]["shear_stiffness_n"] = json!(5e4);
            }
            let mut dae = BeamDae::new(System::new(&parse(&case)).unwrap());
            let mut random = Random(3);
            let scales = dae.system().layout.scales.clone();
            let mut any = || -> Vec<f64> { scales.iter().map(|scale| random.between(-0.01, 0.01) / scale).collect() };
            let (y, yp) = (any(), any());
            let mut r = vec![0.0; y.len()];
            dae.residual(0.0, &y, &yp, &mut r).unwrap();
            let rows = r.iter().zip(&dae.system().layout.row_scales);
            rows.map(|(r, scale)| r * scale).collect::<Vec<_>>()
        });
        let largest = residuals[0].iter().fold(0.0_f64, |most, r| most.max(r.abs()));
        let pairs = residuals[0].iter().zip(&residuals[1]);
        let worst = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        println!("{effects}: {worst:.1e} of {largest:.1e}");
        assert!(worst < 1e-14 * largest);
    }
}
