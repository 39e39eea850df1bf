//! Designs by their frequency response: the best resistance of tubes between bladders.

use serde_json::json;
use slcbeam::case::parameter::with;
use slcbeam::case::{self, Case};
use slcbeam::numerics::golden_section;
use slcbeam::study::analysis::{self, AnalysisKind, AnalysisRequest, ResponseAnalysis};

use crate::common::*;

const VISCOSITY: &str = "/fluid/viscosity_pa_s";
const INPUT: &str = "/ends/root/clamped/u1_m";

/// Bladders joined in pairs across the beam: without resistance, and with so much that nothing flows, no energy is lost in them.
fn sets() -> Vec<String> {
    let pair = |k: i64| json!({"bladders": [k, -k], "ends": ["sealed", "sealed"]});
    let pairs: Vec<_> = (1..=10).map(pair).collect();
    let chains = format!("/network/chains={}", json!(pairs));
    let rest = [
        "/bladders/coupling=\"reciprocal\"",
        "/formulation=\"conservative\"",
        "/beam/damping={\"bending_time_s\": 5e-4}",
        "/mesh/cells_per_segment=1",
        "/mesh/cells_per_bladder=1",
        "/effects/unsteady_friction=\"off\"",
        "/fluid/viscosity_pa_s=0.1",
    ];
    rest.into_iter().map(String::from).chain([chains]).collect()
}

fn figure(case: &Case, viscosity: f64, name: &str) -> f64 {
    let case = with(case, &[(VISCOSITY, viscosity)]).expect("a case");
    let what = AnalysisKind::Response(ResponseAnalysis {
        input: INPUT.into(),
        outputs: vec!["tip_u1".into()],
        band: [4.0, 40.0],
        frequencies: vec![12.0],
    });
    let ask = AnalysisRequest {
        what: &what,
        accuracy: None,
        from: None,
        meshes: false,
        waves: false,
    };
    let found = analysis::found(&case, ask, &|| false, &|_| unreachable!("no run is needed"));
    found.expect("a result").figure(name).expect("the figure")
}

/// Source: golden-section search by the plain analysis. Goal: the least peak, the largest damping ratio and the least amplitude at a
/// frequency are found with exact derivatives, to 1e-4 in the viscosity and 1e-7 in the figure.
#[test]
fn the_best_resistance_is_that_of_a_line_search() {
    let dir = tempfile::tempdir().expect("a folder");
    let sets = sets();
    let case = case::load("cases/shake-wet.json".as_ref(), &sets).expect("a case");
    let set: Vec<&str> = sets.iter().flat_map(|set| ["--set", set.as_str()]).collect();
    let asked = [
        "cases/shake-wet.json",
        "--command",
        "response",
        "--input",
        INPUT,
        "--output",
        "tip_u1",
        "--from",
        "4",
        "--to",
        "40",
        "--frequency",
        "12",
        "--vary",
        "/fluid/viscosity_pa_s=1e-3:10",
    ];
    for (goal, figure_of, sign) in [
        ("--minimize", "tip_u1_m.peak_1.amplitude", -1.0),
        ("--maximize", "tip_u1_m.peak_1.damping_ratio", 1.0),
        ("--minimize", "tip_u1_m.at_12_hz.amplitude", -1.0),
    ] {
        let found = best(&dir, &[&asked[..], &set, &[goal, figure_of]].concat());
        assert!(found["found"] == true && found["derivatives"] == "exact", "{found}");
        let of = |logarithm: f64| Ok::<_, ()>(sign * figure(&case, logarithm.exp(), figure_of));
        let ends = [0.01_f64.ln(), 0.3_f64.ln()];
        let exact = golden_section::maximum(ends, 30, of).expect("an optimum").exp();
        let viscosity = number(&found["variables"][0]["value"]);
        assert!(
            (viscosity / exact - 1.0).abs() < 1e-4,
            "{figure_of}: {viscosity} for {exact}"
        );
        let least = figure(&case, exact, figure_of);
        assert!(
            (number(&found["value"]) / least - 1.0).abs() < 1e-7,
            "{figure_of}: {found}"
        );
    }
}

/// Goal: a response without input, an input without response, unknown names, and a band without a peak are reported.
#[test]
fn what_a_response_lacks_is_told() {
    let dir = tempfile::tempdir().expect("a folder");
    let out = path(&dir, "out");
    let begin = [
        "optimize",
        "cases/shake-wet.json",
        "--vary",
        "/fluid/viscosity_pa_s=1e-3:1",
        "--quiet",
        "--out",
        &out,
    ];
    let coarse = [
        "--set",
        "/mesh/cells_per_segment=1",
        "--set",
        "/mesh/cells_per_bladder=1",
    ];
    let response = ["--command", "response"];
    let input = ["--input", INPUT];
    let tip = ["--output", "tip_u1", "--minimize", "tip_u1_m.peak_1.amplitude"];
    let other = ["--input", "/ends/root/clamped/u2_m"];
    for (asked, code, words) in [
        (
            [&response[..], &tip].concat(),
            2,
            "--command response needs --input POINTER",
        ),
        (
            [&input[..], &["--minimize", "tip_u1_m"]].concat(),
            2,
            "--input is an option of --command response only",
        ),
        (
            [&response[..], &other, &tip].concat(),
            2,
            "nearest is /ends/root/clamped/u1_m",
        ),
        (
            [
                &response[..],
                &input,
                &["--output", "tip_u2", "--minimize", "tip_u1_m.peak_1"],
            ]
            .concat(),
            2,
            "the case has no such linear output; nearest is tip_u3_m",
        ),
        (
            [
                &response[..],
                &input,
                &["--output", "tip_u1", "--minimize", "tip_u1_m.peek_1.amplitude"],
            ]
            .concat(),
            2,
            "nearest is tip_u1_m.peak_1.amplitude",
        ),
        (
            [&response[..], &input, &tip, &["--frequency", "12,0"]].concat(),
            2,
            "--frequency 0: expected a frequency above 0 Hz",
        ),
        (
            [&response[..], &input, &tip, &["--from", "9", "--to", "9"]].concat(),
            2,
            "the first above 0 and below the second",
        ),
        (
            [&response[..], &input, &tip, &["--from", "20", "--to", "25"], &coarse].concat(),
            4,
            "fewer peaks from 20 to 25 Hz. Widen the band",
        ),
    ] {
        let said = say(&[&begin[..], &asked].concat());
        let plain = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            said.code == code && plain.contains(words),
            "{words}: {}: {plain}",
            said.code
        );
    }
}
