//! Modes of a solid that relaxes.

use std::f64::consts::{PI, TAU};

use nalgebra::Complex;
use serde_json::{Value, json};
use slcbeam::run::modes::{self, ModeOptions};

use crate::{BRANCHES, parse, prony, strip};

fn first(case: &Value, near_hz: f64) -> Complex<f64> {
    let plan = ModeOptions {
        count: 1,
        near_hz,
        limits: false,
    };
    modes::modes(&parse(case), &plan).unwrap().modes[0].s
}

/// Source: the root of `s² + ω² (1 + Σ g s τ/(1 + s τ)) = 0` nearest to the frequency asked for, by Newton.
fn swinging(omega: f64, branches: &[[f64; 2]], near: f64) -> Complex<f64> {
    let mut s = Complex::new(0.0, near);
    let one = Complex::new(1.0, 0.0);
    for _ in 0..50 {
        let (mut stiff, mut slope) = (one, Complex::new(0.0, 0.0));
        for [g, tau] in branches {
            stiff += s * *tau * *g / (one + s * *tau);
            slope += one * (*g * *tau) / (one + s * *tau).powi(2);
        }
        s -= (s * s + stiff * omega * omega) / (s * 2.0 + slope * omega * omega);
    }
    s
}

/// Goal: frequency and damping of a mode are those of the exact root, to 1e-8: the mesh has them like the beam, since every mode has its own.
#[test]
fn modes_are_the_roots_of_the_relaxing_oscillator() {
    let dry = strip(Value::Null, json!({}));
    for branches in [&BRANCHES[..], &[[0.2, 0.01]]] {
        let relaxing = strip(prony(branches), json!({}));
        for near_hz in [2.0, 10.0] {
            let omega = first(&dry, near_hz).im;
            let exact = swinging(omega, branches, omega);
            let found = first(&relaxing, exact.im / TAU);
            assert!(
                (found - exact).norm() < 1e-8 * exact.norm(),
                "{near_hz} Hz: {found} {exact}"
            );
        }
    }
}

/// Goal: with bladders and many branches each mode is one of the whole equations: its frequency lies between those of the long term and at once,
/// and the strip, whose modulus goes with s^β over the band, `β = (2/π) atan η`, has the damping ratio `-cos(π/(2 - β))` in every mode.
#[test]
fn modes_with_many_branches() {
    let band = json!({"loss_factor": {"value": 0.3, "from_hz": 0.1, "to_hz": 1000}});
    let plan = ModeOptions {
        count: 6,
        near_hz: 0.0,
        limits: false,
    };
    let found = modes::modes(
        &parse(&strip(band.clone(), json!({"effects": {"rotary_inertia": "off"}}))),
        &plan,
    )
    .unwrap();
    assert!(found.lost == 0 && found.modes.len() == 6);
    let exact = -(PI / (2.0 - 2.0 / PI * 0.3_f64.atan())).cos();
    for mode in &found.modes {
        let ratio = mode.damping_ratio().unwrap();
        assert!((ratio / exact - 1.0).abs() < 0.01, "{ratio} {exact}");
    }
    let wet = |viscoelasticity: Value| {
        let mut case = json!({
            "name": "wet", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"},
            "network": {"chains": [{"bladders": [1, 2, 3, 4, 5]}]},
            "ends": {"root": "clamped", "tip": "free"}, "effects": {"tube_inertia": "off", "tube_losses": "off"},
            "time": {"end_s": 0.1}
        });
        if !viscoelasticity.is_null() {
            case["beam"] = json!({"viscoelasticity": viscoelasticity});
        }
        let found = modes::modes(
            &parse(&case),
            &ModeOptions {
                near_hz: 12.0,
                count: 4,
                ..plan
            },
        )
        .unwrap();
        let swinging = found.modes.iter().filter(|mode| mode.kind.swings());
        (swinging.map(|mode| mode.s.im).fold(f64::INFINITY, f64::min), found.lost)
    };
    let ((elastic, _), (relaxing, lost)) = (wet(Value::Null), wet(band));
    assert!(
        lost == 0 && relaxing > 1.2 * elastic && relaxing < 3.7 * elastic,
        "{elastic} {relaxing}"
    );
}
