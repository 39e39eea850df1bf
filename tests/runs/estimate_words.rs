//! What the estimate of a run's errors says: which figures, why and what to set, and of what it says nothing.

use std::path::Path;

use slcbeam::case::{self, Case};
use slcbeam::run::summary::Summary;

use super::run;

fn warned(summary: &Summary, code: &str) -> bool {
    summary.warnings.iter().any(|w| w.starts_with(code))
}

/// Error of a final value over the largest of its quantity.
fn apart(name: &str, a: &Summary, b: &Summary) -> f64 {
    let last = |s: &Summary| s.quantities[name].last.unwrap();
    (last(a) - last(b)).abs() / b.quantities[name].max_abs.unwrap()
}

/// A slender beam of a metre, 40 cells; `rest` are further sections of the case as JSON.
fn slender(rest: &str) -> Case {
    let text = format!(
        r#"{{"name": "slender", "beam": {{"length_m": 1, "height_m": 0.01, "width_m": 0.05, "young_modulus_pa": 2e9, "density_kg_m3": 1200}}, {rest}}}"#
    );
    case::parse(&text, Path::new("slender.json"), Path::new("."), &[]).unwrap()
}

/// The warning of the estimate; there is one at most.
fn told(summary: &Summary) -> Option<&str> {
    let mut all = summary.warnings.iter().filter(|w| w.starts_with("W021"));
    let first = all.next().map(String::as_str);
    assert_eq!(all.next(), None, "{:?}", summary.warnings);
    first
}

/// Source: Fig. 4 of Matia & Gat, valves open. Goal: in a Mathieu tongue the deflection grows by a factor of tens, and what the mesh
/// changes of it is not what it changes of a vibration, 0.1 of the truth: the estimate grows with it, and says so.
#[test]
fn errors_grow_with_a_deflection_that_grows_by_itself() {
    let on = |cells: &str| {
        let sets = [
            format!("/mesh/cells_per_segment={cells}"),
            "/time/output_interval_s=0.001".to_string(),
        ];
        run(&case::load(Path::new("cases/valves-open.json"), &sets).unwrap())
    };
    let (coarse, fine) = (on("2"), on("6"));
    let estimate = coarse.estimate.as_ref().unwrap();
    assert!(estimate.growth.unwrap() > 10.0, "{estimate:?}");
    for name in ["tip_u1_m", "tip_angle_rad"] {
        let (truth, told) = (apart(name, &coarse, &fine), estimate.quantities[name].total.unwrap());
        println!("{name}: true {truth:.2}, estimated {told:.2}");
        assert!(told > 0.5 * truth.min(1.0), "{name}: true {truth}, estimated {told}");
    }
    let words = told(&coarse).unwrap();
    assert!(
        words.contains("grows by a factor") && words.contains("tip_u1_m"),
        "{words}"
    );
    // what is shaken along does not grow
    assert!(estimate.quantities["tip_u3_m"].total.unwrap() < 0.05, "{estimate:?}");
}

/// Goal: forty waves of a load that the mesh sees as nothing leave a deflection of 1e-17 m, of which no figure is relative to another:
/// the load that is not resolved is told, and no balance, energy or estimate of round-off.
#[test]
fn round_off_has_no_errors() {
    let aliased = run(&slender(
        r#""ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1},
           "loads": [{"force_x_n_m": {"signal": {"ramp": {"to": 1, "duration_s": 0.3}}, "profile": {"cosine": {"waves": 40}}}}]"#,
    ));
    assert!(aliased.quantities["tip_u1_m"].max_abs.unwrap() < 1e-12);
    assert!(warned(&aliased, "W016"), "{:?}", aliased.warnings);
    for code in ["W008", "W018", "W020", "W021"] {
        assert!(!warned(&aliased, code), "{code}: {:?}", aliased.warnings);
    }
    assert!(aliased.balances.energy_residual_relative < 1e-3);
}

/// Goal: an energy goes as the square of the motion: where figures are off by a few per cent it is off by more, which is told of it by
/// name, and no less than half the truth.
#[test]
fn energies_are_named_beside_the_motion() {
    let load = r#""ends": {"root": "pinned", "tip": "pinned"}, "time": {"end_s": 1},
        "loads": [{"force_x_n_m": {"signal": {"ramp": {"to": 50, "duration_s": 0.01, "start_s": 0.1}}}}]"#;
    let usual = run(&slender(&format!(r#"{load}, "solver": {{"rtol": 1e-3}}"#)));
    let tight = run(&slender(&format!(
        r#"{load}, "mesh": {{"cells_per_segment": 12}}, "solver": {{"rtol": 1e-7}}"#
    )));
    let last = |s: &Summary| s.quantities["input_energy_j"].last.unwrap();
    let truth = (last(&usual) / last(&tight) - 1.0).abs();
    let estimate = usual.estimate.as_ref().unwrap().quantities["input_energy_j"]
        .total
        .unwrap();
    println!("true {truth:.3}, estimated {estimate:.3}");
    assert!(
        truth > 0.05 && estimate > 0.5 * truth,
        "true {truth}, estimated {estimate}"
    );
    assert!(told(&usual).unwrap().contains("input_energy_j"), "{:?}", usual.warnings);
    assert!(told(&tight).is_none(), "{:?}", tight.warnings);
}

/// Goal: where a drive comes near a vibration that the mesh misplaces, one warning names what is off, the mesh as its cause and cells that
/// do, and no tolerance, which has nothing to do with it.
#[test]
fn a_warning_names_figures_cause_and_remedy() {
    let mut case = slender(
        r#""ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 0.5, "output_interval_s": 2e-4},
           "loads": [{"force_x_n_m": {"signal": {"sine": {"amplitude": 10, "frequency_hz": 165, "ramp_cycles": 20}},
                                      "profile": {"sine": {"waves": 2.75}}}}]"#,
    );
    case.beam.damping.bending_time_s = 3e-5;
    case.beam.damping.axial_time_s = 3e-5;
    let near = run(&case);
    let words = told(&near).unwrap();
    for part in [
        "tip_u1_m",
        "tip_u3_m",
        "midspan_u1_m",
        "input_energy_j",
        "mostly by the mesh",
        "/mesh/cells_per_segment=",
        "comes near",
        "largest values are off as well",
    ] {
        assert!(words.contains(part), "{part}: {words}");
    }
    assert!(!words.contains("/solver/rtol"), "{words}");
    let all = &near.estimate.as_ref().unwrap().quantities;
    assert!(all["tip_u3_m"].time.unwrap() < 0.1, "{all:?}");
}

/// Goal: a vibration that something drives near its own frequency is no free one that has only lost its phase: how far it swings depends on
/// how near its frequency is, and that is not denied.
#[test]
fn a_driven_vibration_is_not_only_out_of_phase() {
    let on = |cells: usize| {
        run(&slender(&format!(
            r#""ends": {{"root": {{"clamped": {{"u1_m": {{"sine": {{"amplitude": 1e-5, "frequency_hz": 70.5, "ramp_cycles": 10}}}}}}}}, "tip": "free"}},
               "time": {{"end_s": 1, "output_interval_s": 5e-4}}, "mesh": {{"cells_per_segment": {cells}}}"#
        )))
    };
    let (coarse, fine) = (on(2), on(8));
    let most = |s: &Summary| s.quantities["tip_u1_m"].max_abs.unwrap();
    let truth = (most(&coarse) / most(&fine) - 1.0).abs();
    println!("true {truth:.2}: {:?}", told(&coarse));
    assert!(truth > 0.1, "{truth}");
    let words = told(&coarse).unwrap();
    assert!(!words.contains("hardly affected"), "{words}");
}

/// Goal: what a beam draws in is a thousandth of what the tolerance was told to expect, and right all the same, since steps are held by
/// something else: nothing is said of it.
#[test]
fn a_tolerance_that_is_not_used_spoils_nothing() {
    let load = r#""ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1},
        "loads": [{"moment_z_n": {"signal": {"ramp": {"to": 1, "duration_s": 0.3}}, "profile": {"table": {
            "positions": [0, 0.505, 0.512, 0.518, 1], "values": [0, 0, 1, 0, 0], "interpolation": "linear"}}}}]"#;
    let damped = |more: &str| {
        let mut case = slender(&format!("{load}{more}"));
        case.beam.damping.bending_time_s = 0.005;
        case.beam.damping.axial_time_s = 0.005;
        run(&case)
    };
    let (usual, tight) = (damped(""), damped(r#", "solver": {"rtol": 1e-8}"#));
    let truth = apart("tip_u3_m", &usual, &tight);
    let time = usual.estimate.as_ref().unwrap().quantities["tip_u3_m"].time.unwrap();
    println!("true {truth:.1e}, estimated {time:.1e}");
    assert!(time > 0.5 * truth, "true {truth:e}, estimated {time:e}");
    assert!(told(&usual).is_none(), "{:?}", usual.warnings);
}

/// Goal: a tone near a vibration that does a ten-thousandth of the motion, beside a slow one at resonance, spoils nothing.
#[test]
fn a_tone_that_hardly_moves_anything_is_not_told() {
    let beat = run(&slender(
        r#""ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1, "output_interval_s": 5e-4},
           "loads": [{"force_x_n_m": {"signal": {"product": [{"sine": {"amplitude": 0.5, "frequency_hz": 100}},
                                                            {"sine": {"amplitude": 1, "frequency_hz": 102.08}}]}}}]"#,
    ));
    assert!(beat.estimate.as_ref().unwrap().near.is_some(), "{:?}", beat.estimate);
    assert!(told(&beat).is_none(), "{:?}", beat.warnings);
}
