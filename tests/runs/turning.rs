//! What a run says of its errors where they add up without a vibration to lose its phase: beams that nothing turns back, rotational springs at
//! ends whose moment is given, steps that are rejected again and again.

use std::path::Path;

use slcbeam::case;
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};

/// The run of a scene with `sets`, as of `--set`.
fn run(scene: &str, sets: &[String]) -> Summary {
    let case = case::parse(scene, Path::new("scene.json"), Path::new("."), sets).unwrap();
    let summary = dynamics::run(&case, &mut Memory::default()).unwrap().summary;
    assert_eq!(summary.status, Status::Finished, "{:?}", summary.reason);
    summary
}

fn by(method: &str, rtol: f64) -> Vec<String> {
    vec![format!("/solver/method=\"{method}\""), format!("/solver/rtol={rtol:e}")]
}

fn told<'a>(summary: &'a Summary, code: &str) -> Option<&'a String> {
    summary.warnings.iter().find(|w| w.starts_with(code))
}

fn last(summary: &Summary, name: &str) -> f64 {
    summary.quantities[name].last.unwrap()
}

/// A beam pinned at its root that a moment turns ever faster, as far as the ends say.
fn turning(ends: &str, rest: &str, end: f64) -> String {
    format!(
        r#"{{"name": "turning", "beam": {{"length_m": 0.2, "height_m": 0.01, "width_m": 0.03, "young_modulus_pa": 2e6, "density_kg_m3": 1100}},
            "ends": {ends}, {rest} "mesh": {{"segments": 12, "cells_per_segment": 1, "order": 4}},
            "time": {{"end_s": {end}, "output_interval_s": {}}}}}"#,
        end / 100.0
    )
}

/// How far the tip is from where it belongs, over the largest displacement across, at most all; and what is told of it.
fn tips(summary: &Summary, exact: &Summary) -> [f64; 2] {
    let [x, z] = ["tip_u1_m", "tip_u3_m"].map(|name| last(summary, name) - last(exact, name));
    let truth = x.hypot(z) / exact.quantities["tip_u1_m"].max_abs.unwrap();
    let estimate = summary.estimate.as_ref().unwrap();
    [truth.min(1.0), estimate.quantities["tip_u1_m"].time.unwrap()]
}

/// Goal: the tip of a beam that a moment has turned fourteen times is off by 4 % of the largest at the default tolerance, by 40 % at a tenfold
/// one, since errors of the angular velocity add up; 0.02 % and 0.05 % were told and nothing was warned of. Reference: order 5 at rtol 1e-9.
#[test]
fn a_beam_that_spins_up_is_told() {
    let spin = turning(
        r#"{"root": {"pinned": {"moment_n_m": {"ramp": {"to": -0.005, "duration_s": 0.58}}}}, "tip": "free"}"#,
        "",
        5.8,
    );
    let exact = run(&spin, &by("esdirk57", 1e-9));
    for (method, rtol) in [
        ("auto", 1e-3),
        ("auto", 1e-4),
        ("auto", 1e-5),
        ("auto", 1e-6),
        ("ida", 1e-5),
        ("trbdf2", 1e-4),
        ("trbdf2", 1e-5),
        ("esdirk34", 1e-4),
        ("esdirk57", 1e-3),
        ("esdirk57", 1e-5),
    ] {
        let usual = run(&spin, &by(method, rtol));
        let [truth, time] = tips(&usual, &exact);
        println!("{method} {rtol:e}: true {truth:.2e}, estimated {time:.2e}");
        assert!(
            time > 0.9 * truth && time < 3.0 * truth,
            "{method} {rtol:e}: {truth} {time}"
        );
        let said = told(&usual, "W021").is_some_and(|w| w.contains("nothing turns the beam back"));
        assert_eq!(said, time > 0.05, "{:?}", usual.warnings);
    }
}

/// Goal: the same of beams that tumble freely, that a moment or a follower sets off, and of a pendulum, whose weight turns it back so that
/// errors swing: never five times too small where it matters.
#[test]
fn beams_that_turn_freely_are_judged_by_what_adds_up() {
    let pulse = |size: f64| {
        format!(
            r#"{{"table": {{"times_s": [0, 0.2, 0.4, 0.6], "values": [0, {size}, {size}, 0], "interpolation": "cubic"}}}}"#
        )
    };
    let free = r#"{"root": "free", "tip": "free"}"#.to_string();
    let rates = r#""start": {"u1_rate_m_s": {"polynomial": {"coefficients": [-1, 2]}}},"#;
    let weight = r#""loads": [{"gravity": {"x_m_s2": 9.81}}],"#;
    for (name, ends, rest, most) in [
        ("tumbles", free, rates, 3.0),
        (
            "moment",
            format!(
                r#"{{"root": {{"free": {{"moment_n_m": {}}}}}, "tip": "free"}}"#,
                pulse(-0.003)
            ),
            "",
            3.0,
        ),
        (
            "follower",
            format!(
                r#"{{"root": "pinned", "tip": {{"free": {{"follower_shear_n": {}}}}}}}"#,
                pulse(0.05)
            ),
            "",
            3.0,
        ),
        (
            "pendulum",
            r#"{"root": "pinned", "tip": "free"}"#.to_string(),
            weight,
            f64::INFINITY,
        ),
    ] {
        let scene = turning(&ends, rest, 5.0);
        let exact = run(&scene, &by("esdirk57", 1e-9));
        for (method, rtol) in [("auto", 1e-4), ("auto", 1e-5), ("trbdf2", 1e-4), ("esdirk57", 1e-3)] {
            let usual = run(&scene, &by(method, rtol));
            let [truth, time] = tips(&usual, &exact);
            println!("{name}, {method} {rtol:e}: true {truth:.2e}, estimated {time:.2e}");
            if truth > 0.01 {
                assert!(
                    time > 0.5 * truth && time < most * truth.max(0.02),
                    "{name} {method} {rtol:e}"
                );
            }
            assert!(usual.estimate.unwrap().turning.unwrap().turned_rad > 10.0, "{name}");
        }
    }
}

/// Goal: what something holds does not turn freely, and its estimate is what it was.
#[test]
fn beams_that_are_held_are_not_said_to_turn() {
    for (ends, rest) in [
        (r#"{"root": "clamped", "tip": "free"}"#, ""),
        (r#"{"root": "pinned", "tip": "pinned"}"#, ""),
        (r#"{"root": {"pinned": {"moment_n_m": 0.001}}, "tip": "guided"}"#, ""),
        (
            r#"{"root": {"pinned": {"moment_n_m": 0.001}}, "tip": "free"}"#,
            r#""attachments": [{"at": 0.5, "stiffness_rotation_n_m_rad": 0.01}],"#,
        ),
        (
            r#"{"root": {"pinned": {"moment_n_m": 0.001}}, "tip": "free"}"#,
            r#""attachments": [{"at": 1, "stiffness_x_n_m": 1}],"#,
        ),
    ] {
        let loads = r#""loads": [{"force_x_n_m": {"signal": 0.05}}],"#;
        let held = run(
            &turning(ends, &format!("{rest} {loads}"), 0.5),
            &["/mesh/order=2".to_string()],
        );
        assert_eq!(held.estimate.unwrap().turning, None, "{ends} {rest}");
    }
}

/// Source: the angle of a cantilever with a couple and a spring at its tip, `M l/(EI + k l)`. Goal: its error of first order, 10 % on 10 cells, of
/// which 1.7 % were told, and 2.5 % on 40, of which 0.1 % were; a spring at an end without a moment changes nothing of an estimate but that of the angle
/// there.
#[test]
fn a_spring_beside_a_given_moment_is_told() {
    let scene = |tip: &str, at: f64| {
        format!(
            r#"{{"name": "spring", "beam": {{"length_m": 0.2, "height_m": 0.002, "width_m": 0.03, "young_modulus_pa": 2e7, "density_kg_m3": 1100,
                "damping": {{"bending_time_s": 0.05, "axial_time_s": 0.05}}}}, "ends": {{"root": "pinned", "tip": {{"free": {tip}}}}},
                "attachments": [{{"at": {at}, "stiffness_rotation_n_m_rad": 0.002}}], "mesh": {{"segments": 10}}, "time": {{"end_s": 8}}}}"#
        )
    };
    let moment = r#"{"moment_n_m": {"ramp": {"to": -0.008, "duration_s": 5}}}"#;
    let clamped = scene(moment, 1.0).replace(r#""root": "pinned""#, r#""root": "clamped""#);
    let on = |scene: &str, cells: usize| run(scene, &[format!("/mesh/cells_per_segment={cells}")]);
    for cells in [1, 2, 4, 8] {
        let coarse = on(&clamped, cells);
        let truth = (last(&coarse, "tip_angle_rad").abs() / 2.0 - 1.0).abs();
        let estimate = coarse.estimate.as_ref().unwrap();
        let space = estimate.quantities["tip_angle_rad"].space.unwrap();
        println!("{cells}: true {truth:.2e}, estimated {space:.2e}");
        assert!(space > 0.9 * truth && space < 2.0 * truth, "{truth} {space}");
        let said = told(&coarse, "W021").is_some_and(|w| w.contains("a rotational spring"));
        assert_eq!(said, cells <= 2, "{:?}", coarse.warnings);
    }
    let elastic = scene(r#"{"force_x_n": {"ramp": {"to": 0.002, "duration_s": 5}}}"#, 0.0);
    let [coarse, fine] = [4, 16].map(|cells| on(&elastic, cells));
    let truth = (last(&coarse, "tip_angle_rad") / last(&fine, "tip_angle_rad") - 1.0).abs();
    let estimate = coarse.estimate.unwrap();
    println!("elastic clamp: true {truth:.2e}, estimated {:?}", estimate.space);
    assert!(truth < 5e-3 && estimate.couple.is_none() && estimate.space < 0.02);
}

/// Goal: IDA whose error test fails beside nearly every step takes 10 000 steps of order 1 where the method that the program chooses takes
/// some tens, and said nothing.
#[test]
fn steps_that_are_rejected_again_and_again_are_told() {
    let scene = r#"{"name": "stuck", "preset": "matia-gat-beam", "beam": {"damping": {"bending_time_s": 1e-3, "axial_time_s": 1e-3}},
        "bladders": {"coupling": "reciprocal"}, "ends": {"root": "free", "tip": "free"},
        "start": {"u1_rate_m_s": {"polynomial": {"coefficients": [-0.5, 1.5]}}},
        "mesh": {"cells_per_segment": 1}, "time": {"end_s": 0.1, "output_interval_s": 0.001}, "solver": {"rtol": 1e-6}}"#;
    let [stuck, usual] = ["ida", "auto"].map(|method| run(scene, &[format!("/solver/method=\"{method}\"")]));
    let [slow, fast] = [&stuck, &usual].map(|s| s.solver.steps);
    assert!(slow > 20 * fast, "{slow} {fast}");
    assert!(told(&stuck, "W011").is_some_and(|w| w.contains("IDA is stuck") && w.contains("/solver/method to auto")));
    assert_eq!(told(&usual, "W011"), None);
}
