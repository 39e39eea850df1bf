//! What comes suddenly keeps its inertia, whenever it comes and however short it is; estimates that stand in denominators are
//! lower bounds.

use slcbeam::case::Case;
use slcbeam::case::schema::Effect;
use slcbeam::discrete::System;

use super::common::{run, written};

/// A dry cantilever of the paper's size; its first bending period is 0.077 s.
const BEAM: &str = r#"{
  "name": "sudden",
  "beam": {"length_m": 0.1, "height_m": 0.0216, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950,
           "axial_stiffness_factor": 0.53, "bending_stiffness_factor": 0.6, "mass_factor": 0.481},
  "ends": {"root": "clamped", "tip": {"free": {"force_x_n": 0.1}}},
  "formulation": "conservative",
  "mesh": {"segments": 10},
  "time": {"end_s": 2, "output_interval_s": 1e-3}
}"#;

/// The same with bladders in two chains that end in ports.
const WET: &str = r#"{
  "name": "sudden-port",
  "beam": {"length_m": 0.1, "height_m": 0.0216, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950,
           "axial_stiffness_factor": 0.53, "bending_stiffness_factor": 0.6, "mass_factor": 0.481},
  "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": 8.68e-4},
  "bladders": {"per_row": 5, "length_m": 0.046, "height_m": 0.0078, "width_m": 0.0078, "permeability_m4": 1.55e-12,
               "area_per_pressure_m2_per_pa": 1.75e-10,
               "area_per_moment_m2_per_n_m": {"opening": 3.75e-6, "closing": 6.54e-6},
               "area_per_force_m2_per_n": {"tension": 3.64e-8, "compression": 6.31e-8},
               "coupling": "reciprocal"},
  "tubes": {"length_m": 0.02, "radius_m": 0.001, "permeability_m4": 6.72e-13},
  "network": {"chains": [{"bladders": [1, 2, 3, 4, 5], "ends": [{"pressure_pa": 0}, "sealed"]}]},
  "ends": {"root": "clamped", "tip": "free"},
  "formulation": "conservative",
  "mesh": {"segments": 5},
  "time": {"end_s": 5, "output_interval_s": 0.01}
}"#;

fn keeps(case: &Case, effect: Effect) -> (bool, String) {
    let effects = System::new(case).unwrap().model.effects;
    let decision = effects.decision(effect);
    (decision.on, decision.cause.to_string())
}

fn tip(signal: &str) -> String {
    format!(r#"/ends/tip={{"free":{{"force_x_n":{signal}}}}}"#)
}

#[test]
fn sudden_ramps_keep_inertia_at_any_time() {
    for duration in [1e-4, 1e-3] {
        for k in 0..24 {
            let start = 0.05 + 0.0713 * f64::from(k);
            for shape in ["linear", "smooth"] {
                let ramp =
                    format!(r#"{{"ramp":{{"to":1,"start_s":{start},"duration_s":{duration},"shape":"{shape}"}}}}"#);
                let (on, why) = keeps(&written(BEAM, &[tip(&ramp)]), Effect::SolidInertia);
                assert!(on, "{duration} s at {start} s: {why}");
            }
        }
    }
}

#[test]
fn runs_of_any_length_keep_inertia_of_a_sudden_ramp() {
    for k in 0..24 {
        let end = 0.8 + 0.1417 * f64::from(k);
        let sets = [
            tip(r#"{"ramp":{"to":1,"start_s":0.5,"duration_s":1e-4}}"#),
            format!("/time/end_s={end}"),
        ];
        let (on, why) = keeps(&written(BEAM, &sets), Effect::SolidInertia);
        assert!(on, "{end} s: {why}");
    }
}

/// The same beam with every effect agrees.
#[test]
fn a_sudden_ramp_is_right_by_default() {
    let ramp = tip(r#"{"ramp":{"to":1,"start_s":0.3,"duration_s":1e-4}}"#);
    let sets = |effects: &str| {
        [
            ramp.clone(),
            "/time/end_s=0.5".into(),
            format!("/effects=\"{effects}\""),
        ]
    };
    let [auto, full] = ["auto", "full"].map(|effects| run(&written(BEAM, &sets(effects))).max_abs("tip_u1_m"));
    println!("auto {auto}, full {full}");
    assert!((auto / full - 1.0).abs() < 5e-3, "{auto} {full}");
    assert!(auto > 0.01, "{auto}: not the static one");
}

#[test]
fn slow_loads_go_without_inertia() {
    let ramp = tip(r#"{"ramp":{"to":0.1,"duration_s":60}}"#);
    let (on, why) = keeps(&written(BEAM, &[ramp, "/time/end_s=100".into()]), Effect::SolidInertia);
    assert!(!on, "{why}");
}

/// 2 ms in 5 s, as a table and as a product of steps.
#[test]
fn short_pulses_at_a_port_keep_inertia() {
    for start in [0.1234, 1.0, 2.71, 4.9] {
        let pulses = [
            format!(
                r#"{{"table":{{"times_s":[{start},{},{}],"values":[0,2e4,0],"interpolation":"linear"}}}}"#,
                start + 1e-3,
                start + 2e-3
            ),
            format!(
                r#"{{"product":[2e4,{{"sigmoid":{{"amplitude":1,"steepness_per_s":1e4,"midpoint_s":{start}}}}},{{"sigmoid":{{"amplitude":1,"steepness_per_s":-1e4,"midpoint_s":{}}}}}]}}"#,
                start + 2e-3
            ),
        ];
        for pulse in pulses {
            let port = format!(r#"/network/chains/0/ends=[{{"pressure_pa":{pulse}}},"sealed"]"#);
            let case = written(WET, &[port]);
            let (on, why) = keeps(&case, Effect::SolidInertia);
            assert!(on, "{start} s: {why}");
            let scales = System::new(&case).unwrap().model.scales;
            assert!(scales.pressure > 1.9e4, "{start} s: {}", scales.pressure);
        }
    }
}

/// A tap of 0.2 ms acts by its impulse.
#[test]
fn a_hammer_tap_runs_by_default_and_agrees_with_the_full_model() {
    let tap = tip(r#"{"table":{"times_s":[0.05,0.0501,0.0502],"values":[0,20,0],"interpolation":"linear"}}"#);
    let sets = |effects: &str| {
        [
            tap.clone(),
            "/time/end_s=0.2".into(),
            "/mesh/cells_per_segment=1".into(),
            format!("/effects=\"{effects}\""),
        ]
    };
    let [auto, full] = ["auto", "full"].map(|effects| run(&written(BEAM, &sets(effects))));
    let [a, f] = [&auto, &full].map(|r| r.max_abs("tip_u1_m"));
    println!(
        "auto {a} in {} steps, full {f} in {} steps",
        auto.summary.solver.steps, full.summary.solver.steps
    );
    assert!((a / f - 1.0).abs() < 1e-2, "{a} {f}");
}

/// Half the instants at which samples are evenly spaced fall on zeros.
#[test]
fn compression_is_seen_between_samples() {
    // 1.15 of Euler's load, which is pi^2 EI/(4 l^2)
    let load = 1.15 * std::f64::consts::PI.powi(2) * 0.050_388_48 / 0.04;
    for end in [400.0, 390.0, 1e4] {
        let sine = format!(r#"{{"sine":{{"amplitude":{load},"frequency_hz":0.25,"ramp_cycles":1}}}}"#);
        let sets = [
            format!(r#"/ends/tip={{"free":{{"force_x_n":1e-4,"force_z_n":{sine}}}}}"#),
            format!("/time/end_s={end}"),
        ];
        let case = written(BEAM, &sets);
        for effect in [Effect::FiniteRotation, Effect::SolidInertia, Effect::AxialStretch] {
            let (on, why) = keeps(&case, effect);
            assert!(on, "{end} s, {effect}: {why}");
        }
    }
}

/// Root clamped, tip guided: a quarter of a cantilever's deflection, so bending draws in far less than a cantilever would.
#[test]
fn an_overestimated_deflection_does_not_drop_the_stretch() {
    for (across, along) in [(1e-3, 0.018), (1e-3, 0.01), (5e-4, 0.003)] {
        let sets = |effects: &str| {
            let ramp = |size: f64| format!(r#"{{"ramp":{{"to":{size},"duration_s":60}}}}"#);
            [
                format!(
                    r#"/ends/tip={{"guided":{{"force_x_n":{},"force_z_n":{}}}}}"#,
                    ramp(across),
                    ramp(along)
                ),
                "/beam/height_m=0.002".into(),
                r#"/time={"end_s":100,"output_interval_s":1}"#.into(),
                "/effects_tolerance=0.1".into(),
                format!("/effects=\"{effects}\""),
            ]
        };
        let auto = written(BEAM, &sets("auto"));
        let (on, why) = keeps(&auto, Effect::AxialStretch);
        assert!(on, "{across} N, {along} N: {why}");
        let [auto, full] = [auto, written(BEAM, &sets("full"))].map(|case| run(&case).last("tip_u3"));
        println!("{across} N, {along} N: {auto}, full {full}");
        assert!(
            (auto / full - 1.0).abs() < 0.05,
            "{across} N, {along} N: {auto}, full {full}"
        );
    }
}

/// A millionth of the load, at the beam's own frequency, in a long run.
#[test]
fn a_resonant_ripple_on_a_slow_load_keeps_inertia() {
    let ripple = |f: f64| {
        tip(&format!(
            r#"{{"sum":[{{"ramp":{{"to":0.1,"duration_s":60}}}},{{"sine":{{"amplitude":1e-6,"frequency_hz":{f},"ramp_cycles":1}}}}]}}"#
        ))
    };
    for f in [11.0, 13.0, 80.0] {
        let (on, why) = keeps(
            &written(BEAM, &[ripple(f), "/time/end_s=100".into()]),
            Effect::SolidInertia,
        );
        assert!(on, "{f} Hz: {why}");
    }
}

/// Steps never pass over a polynomial's narrow pulse, or that of a sine that starts within a small part of its period.
#[test]
fn largest_steps_see_what_no_break_marks() {
    let largest = |signal: &str, end: f64| {
        let case = written(BEAM, &[tip(signal), format!("/time/end_s={end}")]);
        slcbeam::run::max_step::StepLimits::new(&case, &System::new(&case).unwrap()).least()
    };
    let mut coefficients = vec!["0"; 60];
    coefficients.push("1");
    let pulse = format!(r#"{{"polynomial":{{"coefficients":[{}]}}}}"#, coefficients.join(","));
    let step = largest(&pulse, 1.0);
    assert!(step < 0.01, "{step}");
    let start = r#"{"sine":{"amplitude":1,"frequency_hz":0.1,"phase_rad":1.57,"ramp_cycles":0.001}}"#;
    let step = largest(start, 1.0);
    assert!(step < 1e-3, "{step}");
}
