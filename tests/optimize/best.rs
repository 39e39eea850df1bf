//! The best is the best: against what is known, and against designs beside it.

use std::fs;

use serde_json::Value;
use slcbeam::case::parameter::with;
use slcbeam::case::{self, Case};
use slcbeam::study::analysis::{self, AnalysisKind, AnalysisRequest};

use crate::common::*;

const HARVESTER: &str = "cases/tour-harvester.json";
const CONDUCTANCE: &str = "/network/turbines/0/conductance/m3_s_pa";
const COARSE: [&str; 4] = [
    "--set",
    "/mesh/cells_per_segment=1",
    "--set",
    "/mesh/cells_per_bladder=1",
];
const POWER: &str = "harvested_power_w.mean";

fn figure(case: &Case, what: AnalysisKind, changes: &[(&str, f64)], name: &str) -> f64 {
    let case = with(case, changes).expect("a case");
    let ask = AnalysisRequest {
        what: &what,
        accuracy: None,
        from: None,
        meshes: false,
        waves: false,
    };
    let found = analysis::found(&case, ask, &|| false, &|case| analysis::run(case, ask, &|| false));
    found.expect("no interruption").figure(name).expect("a figure")
}

fn harvester(more: &[&str]) -> Case {
    let sets = COARSE.iter().chain(more).filter(|one| one.starts_with('/'));
    let sets: Vec<String> = sets.map(|set| (*set).to_owned()).collect();
    case::load(HARVESTER.as_ref(), &sets).expect("a case")
}

fn turbine(more: &[&str]) -> Value {
    let dir = tempfile::tempdir().expect("a folder");
    let vary = format!("{CONDUCTANCE}=1e-11:1e-8");
    let asked = [
        HARVESTER,
        "--vary",
        &vary,
        "--maximize",
        "harvested_power_w",
        "--command",
        "periodic",
    ];
    best(&dir, &[&asked[..], &COARSE, more].concat())
}

/// Goal: the turbine that takes most is found by exact derivatives of cycles in few designs, from another decade. Neighbours that would lose
/// a thousandth by the curvature that is told lose that much. At rtol 1e-5 the power is known to 5e-5, which hides where slopes end.
#[test]
fn a_turbine_takes_most() {
    const TIGHT: &str = "/solver/rtol=1e-6";
    let found = turbine(&["--set", TIGHT]);
    assert!(found["found"] == true && found["derivatives"] == "exact", "{found}");
    assert!(number(&found["evaluations"]) <= 12.0, "{found}");
    let [value, power] = [&found["variables"][0]["value"], &found["value"]].map(number);
    let [low, high] = [0, 1].map(|k| number(&found["variables"][0]["within_1_percent"][k]));
    assert!(low < value && value < high);
    for (far, share) in [(0.5_f64, 0.0025), (-0.5, 0.0025)] {
        let beside = value * (high / low).powf(0.5 * far);
        let lost = 1.0
            - figure(
                &harvester(&[TIGHT]),
                AnalysisKind::Periodic,
                &[(CONDUCTANCE, beside)],
                POWER,
            ) / power;
        // the fourth order of the curve, and the energies' own error
        assert!((lost / share - 1.0).abs() < 0.3, "{beside}: {lost}");
    }
}

/// Source: issue 20, within 0.1 % of a scan by brute force, in a tenth of its designs. Goal: the same at a tolerance at which a scan tells
/// its best to that.
#[test]
#[ignore = "two minutes"]
fn a_turbine_is_that_of_a_scan() {
    let found = turbine(&["--set", "/solver/rtol=1e-7"]);
    let case = harvester(&["/solver/rtol=1e-7"]);
    let count = 120;
    let at = |k: usize| 1e-11 * 1e3_f64.powf(k as f64 / count as f64);
    let values: Vec<f64> = (0..=count)
        .map(|k| figure(&case, AnalysisKind::Periodic, &[(CONDUCTANCE, at(k))], POWER))
        .collect();
    let best = (1..count)
        .max_by(|a, b| values[*a].total_cmp(&values[*b]))
        .expect("one");
    // the vertex of a parabola through five points about the best
    let [mut top, mut below] = [0.0, 0.0];
    for (j, weights) in [
        (-2.0, [-2.0, 2.0]),
        (-1.0, [-1.0, -1.0]),
        (0.0, [0.0, -2.0]),
        (1.0, [1.0, -1.0]),
        (2.0, [2.0, 2.0]),
    ] {
        let value = values[(best as f64 + j) as usize];
        top += weights[0] * value / 10.0;
        below += weights[1] * value / 14.0;
    }
    let vertex = best as f64 - top / (2.0 * below);
    let wanted = 1e-11 * 1e3_f64.powf(vertex / count as f64);
    let value = number(&found["variables"][0]["value"]);
    assert!((value / wanted - 1.0).abs() < 1e-3, "{value} and {wanted} by a scan");
    assert!(10.0 * number(&found["evaluations"]) < count as f64, "{found}");
}

/// Goal: under a limit the best lies at it, with what it costs: pressure at rest is that of the pump. The case that is written has it.
#[test]
fn a_limit_holds_the_pump() {
    let dir = tempfile::tempdir().expect("a folder");
    let pump = "/network/chains/0/ends/0/pressure_pa/ramp/to";
    let found = best(
        &dir,
        &[
            "cases/tour-actuator.json",
            "--vary",
            &format!("{pump}=1e4:8e4"),
            "--vary",
            "/beam/young_modulus_pa=1e6:1e7",
            "--maximize",
            "tip_u1_m",
            "--subject-to",
            "max_pressure_pa<=5e4",
            "--command",
            "equilibrium",
        ],
    );
    // the search has nothing to say; the plain command has, of fluid that comes to rest after the run
    let warnings = found["warnings"].as_array().expect("warnings");
    let codes: Vec<&str> = warnings.iter().filter_map(|one| one.as_str()?.get(..4)).collect();
    assert!(found["found"] == true && codes == ["W037"], "{found}");
    let by = |pointer: &str| {
        let all = found["variables"].as_array().expect("numbers");
        all.iter()
            .find(|one| one["pointer"] == pointer)
            .expect("a number")
            .clone()
    };
    assert!((number(&by(pump)["value"]) / 5e4 - 1.0).abs() < 1e-6, "{found}");
    assert_eq!(by("/beam/young_modulus_pa")["at_bound"], "low");
    assert_eq!(found["limits"][0]["reached"], true);
    let written = path(&dir, "out/optimum-case.json");
    let case = case::load(written.as_ref(), &[]).expect("a case");
    let own = figure(&case, AnalysisKind::Equilibrium, &[], "tip_u1_m");
    // an equilibrium is found to its tolerance
    assert!((own / number(&found["value"]) - 1.0).abs() < 1e-6);
    // what a unit of the limit brings is what the tip does for a unit of pressure
    let more = figure(&case, AnalysisKind::Equilibrium, &[(pump, 50_100.0)], "tip_u1_m");
    let gain = number(&found["limits"][0]["gain"]);
    assert!((gain / ((more - own) / 100.0) - 1.0).abs() < 1e-2, "{gain}");
    let page = fs::read_to_string(path(&dir, "out/report.html")).expect("a page");
    assert!(page.contains("The best between bounds"));
    let designs = fs::read_to_string(path(&dir, "out/designs.csv")).expect("a table");
    assert_eq!(designs.lines().count() as f64, 1.0 + number(&found["evaluations"]));
}

/// Goal: frequencies of a beam, least under a limit to the first; several searches come to the same.
#[test]
fn a_frequency_holds_another() {
    let dir = tempfile::tempdir().expect("a folder");
    let found = best(
        &dir,
        &[
            "cases/dry-cantilever.json",
            "--vary",
            "/beam/height_m=0.01:0.05",
            "--minimize",
            "mode_2",
            "--subject-to",
            "mode_1.frequency_hz>=12",
            "--command",
            "modes",
            "--starts",
            "3",
        ],
    );
    assert_eq!(found["goal"]["figure"], "mode_2.frequency_hz");
    assert!(
        (number(&found["limits"][0]["value"]) / 12.0 - 1.0).abs() < 2e-6,
        "{found}"
    );
    // what a unit of the limit brings is what one frequency does for the other
    let case = case::load("cases/dry-cantilever.json".as_ref(), &[]).expect("a case");
    let of = |height: f64, mode: &str| figure(&case, AnalysisKind::Modes, &[("/beam/height_m", height)], mode);
    let height = number(&found["variables"][0]["value"]);
    let change = |mode: &str| of(1.001 * height, mode) - of(0.999 * height, mode);
    let ratio = change("mode_2.frequency_hz") / change("mode_1.frequency_hz");
    assert!(
        (number(&found["limits"][0]["gain"]) / ratio - 1.0).abs() < 1e-3,
        "{ratio}: {found}"
    );
    let starts = found["starts"].as_array().expect("searches");
    for one in starts {
        assert!(
            one["held"] == true && (number(&one["value"]) / number(&found["value"]) - 1.0).abs() < 1e-5,
            "{found}"
        );
    }
    assert_eq!(starts.len(), 3);
}

/// Goal: a run at a bound, by derivatives along with it; a number that moves the period of a cycle by differences, which is said.
#[test]
fn bounds_and_differences_are_told() {
    let dir = tempfile::tempdir().expect("a folder");
    let found = best(
        &dir,
        &[
            "cases/two-bladders.json",
            "--vary",
            "/fluid/viscosity_pa_s=1e-4:1e-2",
            "--minimize",
            "tip_u1_m",
        ],
    );
    assert!(found["found"] == true && found["derivatives"] == "exact", "{found}");
    assert_eq!(found["variables"][0]["at_bound"], "low");
    assert_eq!(found["goal"]["figure"], "tip_u1_m.max_abs");
    let asked = [
        "cases/two-bladders.json",
        "--vary",
        "/fluid/viscosity_pa_s=1e-4:1e-2",
        "--minimize",
        "midspan_u1_m",
    ];
    let found = best(&dir, &asked);
    assert!(
        found["found"] == true && found["derivatives"] == "differences",
        "{found}"
    );
    let warnings = found["warnings"].to_string();
    assert!(
        warnings.contains("W035 derivatives are finite differences between designs"),
        "{warnings}"
    );
}

/// Goal: a figure that no number moves is told to be one, and what is told to begin with is that of the case, whichever search ends first.
#[test]
fn a_figure_that_nothing_moves() {
    let dir = tempfile::tempdir().expect("a folder");
    let strip = "cases/snap-strip.json";
    let asked = [
        strip,
        "--vary",
        "/beam/height_m=0.0002:0.02",
        "--maximize",
        "tip_u1_m",
        "--command",
        "equilibrium",
    ];
    let found = best(&dir, &asked);
    assert!(
        found["warnings"]
            .to_string()
            .contains("with respect to all optimized numbers are zero"),
        "{found}"
    );
    let found = best(
        &dir,
        &[
            &[
                "cases/dry-cantilever.json",
                "--vary",
                "/beam/height_m=0.01:0.05",
                "--maximize",
                "mode_1",
            ][..],
            &["--command", "modes", "--starts", "4", "--jobs", "4"],
        ]
        .concat(),
    );
    let case = case::load("cases/dry-cantilever.json".as_ref(), &[]).expect("a case");
    let own = figure(&case, AnalysisKind::Modes, &[], "mode_1.frequency_hz");
    assert!((number(&found["begin"]) / own - 1.0).abs() < 1e-9, "{found}");
}

/// Goal: what cannot be held is told, with what comes nearest, in files and words; the exit code is that of a computation without its result,
/// for numbers that are sought and for alternatives that are chosen from.
#[test]
fn limits_that_nothing_holds() {
    let dir = tempfile::tempdir().expect("a folder");
    let asked = "cases/dry-cantilever.json --maximize mode_2 --subject-to mode_1.frequency_hz>=100 --command modes";
    let asked: Vec<&str> = asked.split(' ').collect();
    let seek = ["--vary", "/beam/height_m=0.01:0.02"];
    let choose = ["--choose", "/beam/height_m=0.01|0.02"];
    for (option, chosen) in [(&seek[..], false), (&choose[..], true)] {
        let found = ended(&dir, &[&asked, option].concat(), 4);
        assert_eq!(found["found"], false);
        if !chosen {
            assert_eq!(found["variables"][0]["at_bound"], "high");
            assert!(found["limits"][0]["gain"].is_null());
        }
        let warnings = found["warnings"].to_string();
        assert!(
            warnings.contains("no design satisfies mode_1.frequency_hz >= 100"),
            "{warnings}"
        );
        for file in ["optimum.json", "optimum-case.json", "designs.csv", "report.html"] {
            assert!(dir.path().join("out").join(file).is_file(), "{file}");
        }
    }
}

/// Goal: a bound at which the key's own range ends can be reached: the mass that sits anywhere on a cantilever slows its first mode most at the tip,
/// and no design there is said to have failed.
#[test]
fn the_end_of_a_keys_range_is_reached() {
    let dir = tempfile::tempdir().expect("a folder");
    let asked = "cases/dry-cantilever.json --minimize mode_1 --command modes --vary /attachments/0/at=0.1:1 --set /mesh/cells_per_segment=1";
    let mass = r#"/attachments=[{"at": 0.7, "mass_kg": 0.02}]"#;
    let asked: Vec<&str> = asked.split(' ').chain(["--set", mass]).collect();
    let found = best(&dir, &asked);
    assert_eq!(number(&found["variables"][0]["value"]), 1.0, "{found}");
    assert_eq!(found["variables"][0]["at_bound"], "high");
    assert_eq!(found["failed"], serde_json::json!({}), "{found}");
    assert_eq!(found["found"], true, "{found}");
}

/// Goal: what the plain command warns of at the best is told with the best, that coefficients belong to another shape of section too, though the
/// case of the best has them written out.
#[test]
fn warnings_of_the_best_are_told() {
    let dir = tempfile::tempdir().expect("a folder");
    let asked = "cases/tour-actuator.json --minimize tip_u1_m --command equilibrium --vary /beam/height_m=0.024:0.025 \
                 --set /mesh/cells_per_segment=1 --set /mesh/cells_per_bladder=1";
    let found = best(&dir, &asked.split_whitespace().collect::<Vec<_>>());
    let warnings = found["warnings"].to_string();
    for code in ["W017", "W037"] {
        assert!(warnings.contains(code), "{code}: {warnings}");
    }
}
