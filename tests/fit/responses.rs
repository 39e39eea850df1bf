//! Fits to measured frequency responses.

use std::fmt::Write as _;

use slcbeam::case::parameter::with;
use slcbeam::run::response::LinearResponse;

use crate::common::*;

const DAMPING: &str = "/beam/damping/bending_time_s";
const VISCOSITY: &str = "/fluid/viscosity_pa_s";
const INPUT: &str = "/ends/root/clamped/u1_m";
const WET: [&str; 5] = [
    "/bladders/coupling=\"reciprocal\"",
    "/formulation=\"conservative\"",
    "/beam/damping={\"bending_time_s\": 5e-4}",
    "/mesh/cells_per_segment=1",
    "/mesh/cells_per_bladder=1",
];

/// A table of amplitudes and phases, of a case with other numbers.
fn table(case: &str, sets: &[&str], changes: &[(&str, f64)], frequencies: &[f64]) -> String {
    let case = with(&load(case, sets), changes).expect("a case");
    let response = LinearResponse::new(&case, INPUT, &["tip_u1".into(), "tip_angle".into()], None).expect("a response");
    let mut solver = response.solver().expect("a solver");
    let mut text = String::from("f_khz,amplitude,phase_deg,turned,note\n");
    for hz in frequencies {
        let found = solver.at(*hz).expect("a solution");
        let (tip, turned) = (found[0], found[1].norm());
        // a phase that a laboratory has unwrapped downwards
        let phase = tip.arg().to_degrees() - 360.0;
        let _ = writeln!(text, "{},{:e},{phase},{turned:e},1", hz / 1e3, tip.norm());
    }
    text
}

/// Goal: modulus and damping of a dry beam, and viscosity and modulus of one with bladders, are found again to 1e-8 from a response at 16
/// frequencies, by amplitudes alone and with phases.
#[test]
fn the_numbers_that_made_a_response_are_found() {
    let dry = [
        "/ends/root={\"clamped\": {\"u1_m\": 0}}",
        "/beam/damping={\"bending_time_s\": 2e-3}",
        "/start={}",
    ];
    let dir = tempfile::tempdir().expect("a folder");
    let frequencies: Vec<f64> = (0..16).map(|k| 8.0 * 1.2_f64.powi(k)).collect();
    let amplitude = ["--match", "amplitude=tip_u1.amplitude"];
    let phase = ["--match", "phase_deg=tip_u1.phase"];
    let angle = ["--match", "turned=tip_angle_rad"];
    for (case, sets, truth, more) in [
        (
            "cases/dry-cantilever.json",
            &dry[..],
            [(YOUNG, 2.2e6), (DAMPING, 1.3e-3)],
            [&amplitude[..], &[]],
        ),
        (
            "cases/dry-cantilever.json",
            &dry,
            [(YOUNG, 2.2e6), (DAMPING, 1.3e-3)],
            [&amplitude, &phase],
        ),
        (
            "cases/shake-wet.json",
            &WET,
            [(YOUNG, 2.1e6), (VISCOSITY, 0.03)],
            [&phase, &angle],
        ),
    ] {
        let data = file(&dir, "data.csv", &table(case, sets, &truth, &frequencies));
        let out = path(&dir, "out");
        let set: Vec<&str> = sets.iter().flat_map(|set| ["--set", *set]).collect();
        let spans = truth.map(|(pointer, value)| format!("{pointer}={:e}:{:e}", 0.5 * value, 2.5 * value));
        let vary = ["--vary", &spans[0], "--vary", &spans[1]];
        let input = ["--input", INPUT, "--out", &out, "--force"];
        let found = json(&[&["fit", case, &data][..], &set, &vary, &more.concat(), &input].concat());
        assert!(found["found"] == true && found["command"] == "response", "{found}");
        assert_eq!(found["input"], INPUT);
        for (k, (pointer, value)) in truth.iter().enumerate() {
            let estimate = number(&found["parameters"][k]["value"]);
            assert!(
                (estimate / value - 1.0).abs() < 1e-8,
                "{pointer}: {estimate} for {value}"
            );
        }
        let page = std::fs::read_to_string(dir.path().join("out/report.html")).expect("a page");
        assert!(page.contains("slcbeam response fitted-case.json --input"));
        let csv = std::fs::read_to_string(dir.path().join("out/fit.csv")).expect("a table");
        assert!(csv.starts_with("frequency [Hz],"), "{}", &csv[..80]);
    }
}

/// Goal: tables and options that do not belong to a response are refused before anything is computed.
#[test]
fn tables_that_are_no_response_are_refused() {
    let dir = tempfile::tempdir().expect("a folder");
    let out = path(&dir, "out");
    let good = "frequency_hz,amplitude\n8,1\n9,2\n10,3\n";
    let amplitude = ["--match", "amplitude=tip_u1.amplitude"];
    let input = ["--input", INPUT];
    let with = |more: &[&'static str]| [&input[..], &amplitude, more].concat();
    for (text, asked, code, words) in [
        (
            "t_s,amplitude\n1,2\n2,3\n",
            with(&[]),
            2,
            "has no column frequency_hz or f_hz",
        ),
        (
            "f_hz,amplitude\n0,2\n2,3\n3,4\n",
            with(&[]),
            3,
            "line 2, column f_hz: expected a frequency above 0",
        ),
        (
            "f_mm,amplitude\n1,2\n2,3\n3,4\n",
            with(&[]),
            2,
            "the column f_mm is in mm, but frequency is in Hz",
        ),
        (
            good,
            with(&["--drive", "amplitude=/fluid/viscosity_pa_s"]),
            2,
            "cannot be used with",
        ),
        (
            good,
            with(&["--command", "run"]),
            2,
            "--input is an option of --command response only",
        ),
        (
            good,
            [&["--command", "response"][..], &amplitude].concat(),
            2,
            "--command response needs --input POINTER",
        ),
        (
            good,
            [&input[..], &["--match", "amplitude=tip_u2"]].concat(),
            2,
            "has no quantity tip_u2.amplitude; nearest is tip_u3.amplitude",
        ),
        (
            good,
            [&["--input", "/ends/root/u1"][..], &amplitude].concat(),
            2,
            "nearest is /ends/root/clamped/u1_m",
        ),
        (
            "f_hz,amplitude_kpa\n1,2\n2,3\n3,4\n",
            [&input[..], &["--match", "amplitude=tip_angle.amplitude"]].concat(),
            2,
            "is in kPa, but tip_angle.amplitude is in rad/m",
        ),
    ] {
        let data = file(&dir, "data.csv", text);
        let begin = [
            "fit",
            "cases/shake-wet.json",
            &data,
            "--vary",
            "/beam/young_modulus_pa=1e6:1e7",
            "--out",
            &out,
            "--quiet",
        ];
        let said = say(&[&begin[..], &asked].concat());
        let plain = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            said.code == code && plain.contains(words),
            "{words}: {}: {plain}",
            said.code
        );
        assert!(!dir.path().join("out").exists(), "something was written");
    }
}
