//! Backbone curves, compared with closed forms.

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::stop::StopFlag;
use slcbeam::study::evaluations::Evaluations;
use slcbeam::study::stability::{CyclePath, PathRequest, backbone};

/// Backbone over the amplitudes of a sine.
fn over_amplitudes(load: &str, values: &[f64], case_at: &dyn Fn(f64) -> Case) -> CyclePath {
    let cases: Vec<_> = values.iter().map(|value| (*value, case_at(*value))).collect();
    let sine = format!("{load}/sine");
    let request = PathRequest {
        pointer: &format!("{sine}/amplitude"),
        logarithmic: true,
        cases: &cases,
        case_at: &|value| Ok(case_at(value)),
    };
    let frequency = format!("{sine}/frequency_hz");
    let found = backbone(
        &request,
        &frequency,
        &Evaluations::default(),
        &StopFlag::default(),
        &|_| {},
    )
    .unwrap();
    assert_eq!(found.missing, []);
    found
}

/// Relative change of the frequency of resonance between the first and the last member, over that of the squared amplitude in units of
/// `length`.
fn hardening(found: &CyclePath, quantity: &str, length: f64) -> f64 {
    let [first, .., last] = &found.members[..] else {
        panic!("{found:?}")
    };
    let square =
        |m: &slcbeam::study::stability::CycleMember| (m.quantities[quantity].window_max_abs.unwrap() / length).powi(2);
    let hz = |m: &slcbeam::study::stability::CycleMember| m.resonance_hz.unwrap();
    (hz(last) / hz(first) - 1.0) / (square(last) - square(first))
}

/// A strip clamped at both ends, or a cantilever, under a uniform force per length [N/m].
fn strip(held: bool, cells: usize, force: f64, near_hz: f64) -> Case {
    let sine = json!({"sine": {"amplitude": force, "frequency_hz": near_hz}});
    let mut text: Value = json!({
        "name": "strip",
        "beam": {"length_m": 0.1, "height_m": 1e-3, "width_m": 0.01, "young_modulus_pa": 2e6, "density_kg_m3": 1000,
                 "damping": {"drag_n_s_m2": 0.00058, "axial_time_s": 1e-3}},
        "loads": [{"force_x_n_m": {"signal": sine}}],
        "ends": {"root": "clamped", "tip": if held { "clamped" } else { "free" }},
        "formulation": "conservative",
        "effects": {"rotary_inertia": "off"},
        "mesh": {"segments": cells, "cells_per_segment": 1},
        "time": {"end_s": 1},
        "solver": {"rtol": 1e-5}
    });
    if held {
        text["effects"] = json!({"finite_rotation": "off", "axial_inertia": "off", "rotary_inertia": "off"});
    }
    case::parse(&text.to_string(), "strip.json".as_ref(), ".".as_ref(), &[]).unwrap()
}

/// Source: in the frame of a shaken root the beam is loaded by `-ü` times its mass. Goal: both resonate at one frequency, to 1e-6, also with
/// strong damping; the motion of the root was subtracted twice.
#[test]
fn a_shaken_root_resonates_as_a_body_load() {
    let case = |shaken: bool, amplitude: f64| {
        let sine = json!({"sine": {"amplitude": amplitude, "frequency_hz": 12.0}});
        let mut text: Value = json!({
            "name": "shaken",
            "beam": {"length_m": 0.1, "height_m": 0.01, "width_m": 0.02, "young_modulus_pa": 6e5, "density_kg_m3": 1000,
                     "damping": {"bending_time_s": 5e-3, "axial_time_s": 5e-4}},
            "ends": {"root": "clamped", "tip": "free"}, "mesh": {"segments": 8, "cells_per_segment": 1}, "time": {"end_s": 1}
        });
        match shaken {
            true => text["ends"]["root"] = json!({"clamped": {"u1_m": sine}}),
            false => text["loads"] = json!([{"body_x_m_s2": {"signal": sine}}]),
        }
        case::parse(&text.to_string(), "shaken.json".as_ref(), ".".as_ref(), &[]).unwrap()
    };
    let hz = |shaken: bool, load: &str, amplitudes: [f64; 2]| {
        let found = over_amplitudes(load, &amplitudes, &|amplitude| case(shaken, amplitude));
        found.members[0].resonance_hz.unwrap()
    };
    let root = hz(true, "/ends/root/clamped/u1_m", [1e-6, 2e-6]);
    let body = hz(false, "/loads/0/body_x_m_s2/signal", [1e-2, 2e-2]);
    assert!((root / body - 1.0).abs() < 1e-6, "{root} {body}");
}

/// Source: ω/ω₀ = 1 + 0.269735 (a/h)² of a clamped-clamped rectangle with fixed ends. Goal: to 0.3 % after extrapolation from 12 and 24
/// cells, whose errors are of second order.
#[test]
fn a_clamped_strip_hardens() {
    let of = |cells: usize| {
        let found = over_amplitudes("/loads/0/force_x_n_m/signal", &[1e-7, 1e-6], &|force| {
            strip(true, cells, force, 4.5)
        });
        hardening(&found, "midspan_u1_m", 1e-3)
    };
    let [coarse, fine] = [12, 24].map(of);
    println!("{coarse} {fine}");
    let extrapolated = fine + (fine - coarse) / 3.0;
    assert!((extrapolated / 0.269735 - 1.0).abs() < 3e-3, "{extrapolated}");
}

/// Source: inextensible cantilever, mode 1 hardens by 0.019384 (a/l)² of its tip amplitude a, mode 2 softens. Goal: to 1 % after
/// extrapolation, and the sign for mode 2.
#[test]
fn a_cantilever_hardens_in_its_first_mode_and_softens_in_its_second() {
    let of = |cells: usize, near_hz: f64, forces: [f64; 2]| {
        let found = over_amplitudes("/loads/0/force_x_n_m/signal", &forces, &|force| {
            strip(false, cells, force, near_hz)
        });
        println!(
            "{:?}",
            found
                .members
                .iter()
                .map(|m| (m.resonance_hz, m.quantities["tip_u1_m"].window_max_abs))
                .collect::<Vec<_>>()
        );
        hardening(&found, "tip_u1_m", 0.1)
    };
    let [coarse, fine] = [8, 16].map(|cells| of(cells, 0.7, [1e-6, 2e-5]));
    println!("{coarse} {fine}");
    let extrapolated = fine + (fine - coarse) / 3.0;
    assert!((extrapolated / 0.019384 - 1.0).abs() < 1e-2, "{extrapolated}");
    let second = of(16, 4.5, [1e-6, 1e-4]);
    println!("{second}");
    assert!(second < 0.0, "{second}");
}
