//! Validity limits of the model: checked at every step and located within it.

use assert_cmd::Command;
use slcbeam::error::Code;
use slcbeam::run::summary::Status;

use super::common::{BEAM, EI, HALF, ended, finished, number_after, shipped, warning, written};

/// End moment [N m] that bends a beam to a given fiber strain: `M = EI κ`, `κ = ε/(h/2)`.
fn moment(strain: f64) -> f64 {
    EI * strain / HALF
}

/// Goal: the closing of a bladder between two output times is detected with place and time. Outputs every millisecond and a single output
/// give the same time to 1e-6 s, and earlier results are kept.
#[test]
fn a_bladder_that_closes_between_output_times() {
    let at = |interval: &str| {
        let (outcome, memory) = ended(&shipped("hard/closing-bladder", &[interval]));
        let s = &outcome.summary;
        assert_eq!(s.status, Status::OutOfRange, "{:?}", s.reason);
        assert_eq!(outcome.fault.map(|f| f.code), Some(Code::OutOfRange));
        assert!(s.reason.as_ref().unwrap().contains("closed"), "{:?}", s.reason);
        let opening = *memory.column("least_opening").unwrap().last().unwrap();
        assert!(opening <= 0.0 && opening > -1e-6, "{opening}");
        assert_eq!(*memory.column("t").unwrap().last().unwrap(), s.time_s);
        s.time_s
    };
    let (often, rarely) = (at("/time/output_interval_s=1e-3"), at("/time/output_interval_s=0.6"));
    assert!((often - rarely).abs() < 1e-6, "{often} {rarely}");
}

/// Goal: strains above one half between two output times are warned of, with their first time. The bending moment is a sine with its zeros
/// at the output times. Tolerance of the time: 2e-4 s, a hundredth of its sine; 1 % of the strain.
#[test]
fn strains_between_output_times() {
    let set = format!(
        r#"/ends/tip={{"free": {{"moment_n_m": {{"sine": {{"amplitude": {}, "frequency_hz": 10}}}}}}}}"#,
        moment(0.6)
    );
    let s = finished(&written(
        BEAM,
        &[
            &set,
            r#"/effects={"solid_inertia": "off"}"#,
            "/time/end_s=0.3",
            "/time/output_interval_s=0.1",
        ],
    ));
    let text = warning(&s, "W004").expect("strains are large");
    assert!((number_after(text, "reached ") - 0.6).abs() < 0.011, "{text}");
    let began = (0.5_f64 / 0.6).asin() / (20.0 * std::f64::consts::PI);
    assert!(
        (number_after(text, "from t = ") - began).abs() < 1e-3,
        "{text}: {began}"
    );
}

/// Goal: fast flow between two output times gives the same warning as with many output times.
#[test]
fn fast_flow_between_output_times() {
    let with = |interval: &str| {
        let s = finished(&shipped(
            "pluck",
            &[
                "/time/end_s=0.1",
                interval,
                r#"/effects={"tube_inertia":"off","tube_losses":"off"}"#,
            ],
        ));
        let text = s
            .warnings
            .iter()
            .find(|w| w.contains("Reynolds number reached"))
            .cloned();
        number_after(&text.expect("flow is fast"), "reached ")
    };
    let (often, rarely) = (
        with("/time/output_interval_s=1e-4"),
        with("/time/output_interval_s=0.1"),
    );
    assert!((rarely / often - 1.0).abs() < 0.02, "{often} {rarely}");
}

/// Goal: a run with a slowly growing moment ends where the strain of the outer fiber is one: at two thirds of the ramp to 1.5. Tolerance:
/// error of the strain by the solver tolerance, 1e-3.
#[test]
fn a_strain_of_one_ends_the_run() {
    let set = format!(
        r#"/ends/tip={{"free": {{"moment_n_m": {{"ramp": {{"to": {}, "duration_s": 1, "shape": "linear"}}}}}}}}"#,
        moment(1.5)
    );
    let (outcome, _) = ended(&written(
        BEAM,
        &[
            &set,
            r#"/effects={"solid_inertia": "off"}"#,
            "/time/output_interval_s=0.5",
        ],
    ));
    let s = outcome.summary;
    assert_eq!(s.status, Status::OutOfRange, "{:?}", s.reason);
    assert!(s.reason.as_ref().unwrap().contains("strain"), "{:?}", s.reason);
    assert!((s.time_s - 2.0 / 3.0).abs() < 2e-2, "{} s", s.time_s);
}

/// Goal: a pump that fills bladders beyond the half section of their segment ends the run: `a_p p = l_seg h_s/2 - h_b w_b`. A pump with the
/// flow of a river ends it at once, with exit code 4.
#[test]
fn bladders_beyond_the_section_end_the_run() {
    let pump = "/network/chains/0/ends/0/pressure_pa/ramp/to=5e5";
    let other = "/network/chains/1/ends/0/pressure_pa/ramp/to=5e5";
    let (outcome, _) = ended(&shipped(
        "hard/closing-bladder",
        &[pump, other, "/time/output_interval_s=0.6"],
    ));
    let s = outcome.summary;
    assert_eq!(s.status, Status::OutOfRange, "{:?}", s.reason);
    assert!(s.reason.as_ref().unwrap().contains("outgrown"), "{:?}", s.reason);
    let wanted = (0.01 * HALF - 0.0078 * 0.0078) / 1.75e-10 / 5e5;
    let rise = |s: f64| s * s * s * (10.0 + s * (6.0 * s - 15.0));
    let (mut low, mut high) = (0.0_f64, 1.0);
    for _ in 0..60 {
        let s = 0.5 * (low + high);
        *(if rise(s) < wanted { &mut low } else { &mut high }) = s;
    }
    assert!(
        (s.time_s - 0.5 * low).abs() < 1e-2,
        "{} s, expected {}",
        s.time_s,
        0.5 * low
    );
}

#[test]
fn a_river_into_a_bladder_exits_with_4() {
    let out = tempfile::tempdir().unwrap();
    let flow = r#"/network={"chains":[{"bladders":[1,2,3],"ends":[{"flow_m3_s":1e-3},"sealed"]}]}"#;
    let run = Command::new(env!("CARGO_BIN_EXE_slcbeam"))
        .args([
            "run",
            "cases/hard/closing-bladder.json",
            "--set",
            flow,
            "--quiet",
            "--json",
            "--out",
        ])
        .arg(out.path())
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&run.stdout).into_owned();
    assert_eq!(
        run.status.code(),
        Some(4),
        "{text}{}",
        String::from_utf8_lossy(&run.stderr)
    );
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(summary["status"], "out_of_range");
    assert!(String::from_utf8_lossy(&run.stderr).contains("E048"));
}
