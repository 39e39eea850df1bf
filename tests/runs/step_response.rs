//! Rise, settling and overshoot of a step response.

use std::path::Path;

use crate::scene::finished;
use serde_json::{Value, json};
use slcbeam::case;
use slcbeam::run::step_response::StepResponse;

const EA: f64 = 1e6 * 0.02 * 0.004;
const FORCE: f64 = 0.08;

/// A bar pulled at its tip by a force that starts at 0.1 s.
fn bar(sets: &Value) -> Value {
    let mut case = json!({
        "name": "bar",
        "beam": {"length_m": 0.1, "height_m": 0.004, "width_m": 0.02, "young_modulus_pa": 1e6, "density_kg_m3": 1.0,
                 "damping": {"axial_time_s": 0.05}},
        "ends": {"root": "clamped", "tip": {"free": {"force_z_n": {"ramp": {"to": FORCE, "start_s": 0.1, "duration_s": 0}}}}},
        "step_response": {"at_s": 0.1},
        "effects": {"solid_inertia": "off"},
        "mesh": {"segments": 4, "cells_per_segment": 1},
        "time": {"end_s": 1.6, "output_interval_s": 0.4, "window_s": 0.1},
        "solver": {"rtol": 1e-9}
    });
    for (key, value) in sets.as_object().unwrap() {
        case[key] = value.clone();
    }
    case
}

fn told(case: &Value) -> StepResponse {
    finished(case).1.step_response["tip_u3_m"].clone()
}

fn close(told: Option<f64>, exact: f64, part: f64) {
    assert!(
        told.is_some_and(|told| (told / exact - 1.0).abs() < part),
        "{told:?} {exact}"
    );
}

/// Source: `u = (F l/EA) (1 - e^(-t/τ))` of a Kelvin-Voigt bar: rise in τ ln 9, within 2 % after τ ln 50, within 5 % after τ ln 20. Goal:
/// to 1e-4, for any output times.
#[test]
fn an_exponential_rises_and_settles() {
    let found = told(&bar(&json!({})));
    close(Some(found.last), FORCE * 0.1 / EA, 1e-4);
    close(found.rise_time_s, 0.05 * 9_f64.ln(), 1e-4);
    close(found.settling_time_2_percent_s, 0.05 * 50_f64.ln(), 1e-4);
    close(found.settling_time_5_percent_s, 0.05 * 20_f64.ln(), 1e-4);
    assert!(found.overshoot_percent.unwrap().abs() < 1e-4 && found.reason.is_none());
}

/// Source: the oscillator `M u'' + (EA/l) (u + τ u') = F`: overshoot `e^(-π ζ/√(1 - ζ²))` at `π/(ω √(1 - ζ²))`, ζ = ω τ/2. Goal: to 1e-3;
/// the mass of the bar is 1e-4 of the mass at its tip.
#[test]
fn an_oscillator_overshoots() {
    let mass = 0.08;
    let omega = (EA / 0.1 / mass).sqrt();
    let zeta = 0.2;
    let mut case = bar(&json!({
        "attachments": [{"at": 1, "mass_kg": mass}], "effects": {"rotary_inertia": "off"},
        "time": {"end_s": 0.9, "output_interval_s": 0.4, "window_s": 0.1}
    }));
    case["beam"]["damping"]["axial_time_s"] = json!(2.0 * zeta / omega);
    let found = told(&case);
    let root = (1.0 - zeta * zeta).sqrt();
    close(
        found.overshoot_percent,
        100.0 * (-std::f64::consts::PI * zeta / root).exp(),
        1e-3,
    );
    close(found.peak_time_s, std::f64::consts::PI / (omega * root), 1e-3);
    assert!(found.settling_time_5_percent_s.unwrap() > found.peak_time_s.unwrap());
}

/// Goal: a response that has not settled, or that ends where it began, gives a reason instead of numbers; a step after the end is rejected.
#[test]
fn what_has_no_final_value_is_told() {
    let early = told(&bar(
        &json!({"time": {"end_s": 0.15, "output_interval_s": 0.05, "window_s": 0.05}}),
    ));
    assert!(early.rise_time_s.is_none() && early.settling_time_5_percent_s.is_none());
    assert!(early.reason.unwrap().contains("final value"));
    let still = told(&bar(
        &json!({"ends": {"root": "clamped", "tip": {"free": {"force_z_n": FORCE}}},
        "start": {"equilibrium": {"loads_at_s": 0}}}),
    ));
    assert!(still.rise_time_s.is_none() && still.reason.is_some());
    let late = bar(&json!({"step_response": {"at_s": 2}})).to_string();
    let refused = format!(
        "{:?}",
        case::parse(&late, Path::new("late.json"), Path::new(""), &[]).unwrap_err()
    );
    assert!(refused.contains("\"/step_response/at_s\""), "{refused}");
}
