//! A run of IDA whose error test fails repeatedly.

use std::path::Path;

use slcbeam::case;
use slcbeam::run::summary::Summary;

use super::run;

fn told<'a>(summary: &'a Summary, code: &str) -> Option<&'a String> {
    summary.warnings.iter().find(|w| w.starts_with(code))
}

/// Goal: IDA, whose error test fails at nearly every step, needs 10 000 steps of order 1 where the program's chosen method needs some tens.
/// A warning states it; before, there was none.
#[test]
fn steps_that_are_rejected_again_and_again_are_told() {
    let scene = r#"{"name": "stuck", "preset": "matia-gat-beam", "beam": {"damping": {"bending_time_s": 1e-3, "axial_time_s": 1e-3}},
        "bladders": {"coupling": "reciprocal"}, "ends": {"root": "free", "tip": "free"},
        "start": {"u1_rate_m_s": {"polynomial": {"coefficients": [-0.5, 1.5]}}},
        "mesh": {"cells_per_segment": 1}, "time": {"end_s": 0.1, "output_interval_s": 0.001}, "solver": {"rtol": 1e-6}}"#;
    let [stuck, usual] = ["ida", "auto"].map(|method| {
        run(&case::parse(
            scene,
            Path::new("scene.json"),
            Path::new("."),
            &[format!("/solver/method=\"{method}\"")],
        )
        .unwrap())
    });
    let [slow, fast] = [&stuck, &usual].map(|s| s.solver.steps);
    assert!(slow > 20 * fast, "{slow} {fast}");
    assert!(told(&stuck, "W011").is_some_and(|w| w.contains("IDA is stuck") && w.contains("/solver/method to auto")));
    assert_eq!(told(&usual, "W011"), None);
}
