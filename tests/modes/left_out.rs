//! Errors of modes by effects left out.

use serde_json::{Value, json};
use slcbeam::run::modes::{self, Mode, ModeOptions, Modes, likeness};
use slcbeam::study::refine::meshes::judge_modes;

use crate::common::{across, checked, plan, slowest};

fn swinging(found: &Modes) -> Vec<&Mode> {
    found.modes.iter().filter(|m| m.kind.swings()).collect()
}

/// Goal: the error of a mode includes unsteady friction, which modes leave out: it is the change of the same mode when the case names the
/// effect, although its decays change the order of the modes. The warning names the effect; a case that names it leaves nothing out.
#[test]
fn errors_of_modes_include_the_effects_left_out() {
    let mut case = across(2, 1e-3, 1e-5);
    case["effects"] = "auto".into();
    let judged = |case: &Value| {
        let (mut found, plan) = (slowest(case, 6), plan(6));
        judge_modes(&checked(case), None, &plan, &mut found).unwrap();
        found
    };
    let found = judged(&case);
    assert_eq!(found.left_out.len(), 1, "{:?}", found.left_out);
    case["effects"] = json!({"unsteady_friction": "on"});
    let whole = judged(&case);
    assert!(whole.left_out.is_empty() && whole.modes.iter().all(|mode| mode.effects_error().is_none()));
    let near = |mode: &Mode| {
        let near_hz = mode.s.im / std::f64::consts::TAU;
        let others = modes::modes(&checked(&case), &ModeOptions { near_hz, ..plan(3) }).unwrap();
        let alike = swinging(&others)
            .into_iter()
            .filter(|other| likeness(&mode.shape, &other.shape) > 0.8);
        let apart = |other: &Mode| (other.s - mode.s).norm();
        alike
            .map(|other| (apart(other), other.s - mode.s))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let (mut compared, mut largest) = (0, 0.0_f64);
    for mode in swinging(&found) {
        let error = mode.effects_error().expect("an error by effects");
        println!(
            "{:.4} Hz, error {error:.2e}, of the rate {:?}",
            mode.s.im,
            mode.rate_effects_error()
        );
        largest = largest.max(mode.rate_effects_error().unwrap_or(0.0));
        let Some((_, change)) = near(mode) else { continue };
        compared += 1;
        assert!(
            (error - change.im.abs() / mode.s.im).abs() <= 1e-6 * (1.0 + error),
            "{error:e} {change}"
        );
        let [total, _] = mode.errors();
        assert!(total.unwrap() >= error);
    }
    let warning = found
        .warnings("the start")
        .into_iter()
        .find(|text| text.starts_with("W021"));
    println!("{compared} modes, largest {largest:e}: {warning:?}");
    assert!(compared >= 3 && largest > 0.05);
    let warning = warning.unwrap();
    assert!(
        warning.contains("unsteady_friction") && warning.contains("--set '/effects/unsteady_friction=\"on\"'"),
        "{warning}"
    );
}
