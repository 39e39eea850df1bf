//! Figures of the window cover it from its exact beginning to its exact end, for any output times.

use super::common::{BEAM, finished, shipped, warning, written};
use slcbeam::discrete::System;

/// Goal: increments, extrema, means and last values of a window that begins and ends between two output times, without any output inside,
/// agree with those of a thousand outputs. Tolerance: 1e-3, that of the search for turning points.
fn alike(case: &str, window: &[&str], often: &str, rarely: &[&str]) {
    let with = |interval: &str| {
        let interval = format!("/time/output_interval_s={interval}");
        let fields = interval.replace("output", "fields");
        let sets = [window, &[interval.as_str(), fields.as_str()]].concat();
        finished(&if case.starts_with('{') {
            written(case, &sets)
        } else {
            shipped(case, &sets)
        })
    };
    let all = with(often);
    for interval in rarely {
        let few = with(interval);
        for (name, a) in &all.quantities {
            let b = few.quantities[name].figures().collect::<Vec<_>>();
            for (which, a) in a.figures() {
                let (_, b) = b.iter().find(|f| f.0 == which).expect("the same figures");
                let near = 1e-3 * a.abs() + 1e-12;
                assert!((b - a).abs() <= near, "{interval}: {name} {which}: {a} {b}");
            }
        }
        assert!(!few.warnings.iter().any(|w| w.contains("in the window")));
    }
}

#[test]
fn a_slow_load_in_a_window_without_outputs() {
    let load = r#"/loads=[{"force_x_n_m": {"signal": {"ramp": {"to": 5, "duration_s": 1}}}}]"#;
    let window = [load, "/time/window_s=0.1234"];
    alike(BEAM, &window, "1e-4", &["0.05", "0.3", "1"]);
}

#[test]
fn harvest_in_a_window_without_outputs() {
    let window = ["/time/end_s=0.15", "/time/window_s=0.0437"];
    alike("wiring-2", &window, "1e-4", &["0.01", "0.04", "0.1"]);
}

/// Goal: derivatives of root mean squares in a window use the output times only, and a message states it.
#[test]
fn derivatives_in_a_window_without_outputs_are_warned_of() {
    use slcbeam::case::parameter::Parameter;
    use slcbeam::run::{dynamics, record::Memory};
    let load = r#"/loads=[{"force_x_n_m": {"signal": {"ramp": {"to": 5, "duration_s": 1}}}}]"#;
    let case = |interval: &str| {
        let interval = format!("/time/output_interval_s={interval}");
        written(
            BEAM,
            &[load, "/time/window_s=0.1234", &interval, r#"/solver/rtol=1e-5"#],
        )
    };
    let with = |interval: &str| {
        let case = case(interval);
        let parameters = [Parameter::find(&case, "/beam/young_modulus_pa").expect("a number")];
        let outcome = dynamics::run_with(&case, System::new(&case).unwrap(), &parameters, &mut Memory::default())
            .expect("a recorder in memory");
        outcome.summary
    };
    let (often, rarely) = (with("1e-3"), with("0.3"));
    assert_eq!(warning(&often, "W015"), None);
    assert!(warning(&rarely, "W015").is_some_and(|w| w.contains("derivatives")));
    let increment = |s: &slcbeam::run::summary::Summary| {
        let q = &s.sensitivities["/beam/young_modulus_pa"].quantities;
        (q["input_energy_j"].window.unwrap(), q["tip_u1_m"].last.unwrap())
    };
    let (a, b) = (increment(&often), increment(&rarely));
    assert!(
        (a.0 / b.0 - 1.0).abs() < 1e-3 && (a.1 / b.1 - 1.0).abs() < 1e-3,
        "{a:?} {b:?}"
    );
}
