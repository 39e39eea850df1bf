//! `slcbeam floquet` and `slcbeam periodic` from outside: exit codes, streams, files. Meshes are coarse, since the tests concern the
//! command line.

use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;
use slcbeam::output::floquet::map_csv;
use slcbeam::study::stability::tongue::{Map, MapPoint, Sheet};
use tempfile::TempDir;

const COARSE: [&str; 2] = ["--set", "/mesh/cells_per_segment=1"];

struct Said {
    code: i32,
    out: String,
    err: String,
}

fn say(arguments: &[&str], folder: &Path) -> Said {
    let mut command = Command::cargo_bin("slcbeam").unwrap();
    command.args(arguments).args(["--quiet", "--out"]).arg(folder);
    let output = command.output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Said {
        code: output.status.code().unwrap(),
        out: text(output.stdout),
        err: text(output.stderr),
    }
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Goal: a cycle along the beam alone has multipliers, without modes across.
#[test]
fn a_bar_has_multipliers() {
    let dir = TempDir::new().unwrap();
    let sine = r#"/ends/root={"clamped":{"u3_m":{"sine":{"amplitude":1e-4,"frequency_hz":20}}}}"#;
    let bar = [
        "floquet",
        "cases/stretch-dry.json",
        "--set",
        sine,
        "--set",
        r#"/effects={"transverse_motion":"off"}"#,
    ];
    let said = say(
        &[&bar[..], &["--set", "/beam/damping/axial_time_s=0.001"], &COARSE].concat(),
        dir.path(),
    );
    assert_eq!(said.code, 0, "{}", said.err);
    assert_eq!(
        json(&dir.path().join("floquet.json"))["floquet"]["verdict"]["stability"],
        "stable"
    );
}

#[test]
fn floquet_tells_whether_a_cycle_is_stable() {
    let dir = TempDir::new().unwrap();
    let said = say(
        &[&["floquet", "cases/valves-open.json"], &COARSE[..]].concat(),
        dir.path(),
    );
    assert_eq!(said.code, 0, "{}", said.err);
    assert!(
        said.out.contains("parametric resonance of mode 1 (subharmonic"),
        "{}",
        said.out
    );
    let found = json(&dir.path().join("floquet.json"));
    assert_eq!(found["floquet"]["verdict"]["stability"], "unstable");
    let table = std::fs::read_to_string(dir.path().join("floquet.csv")).unwrap();
    assert!(table.starts_with("real part [1],imaginary part [1]"));
    assert_eq!(
        table.lines().count() - 1,
        found["floquet"]["multipliers"].as_array().unwrap().len()
    );
    assert!(
        std::fs::read_to_string(dir.path().join("floquet.svg"))
            .unwrap()
            .contains("Floquet multipliers")
    );
}

/// Goal: an accuracy is reached, or reported as not reached, in the text and in the file; an invalid one is rejected.
#[test]
fn multipliers_and_cycles_know_an_accuracy() {
    let dir = TempDir::new().unwrap();
    let asked = ["floquet", "cases/wiring-1.json", "--count", "2", "--accuracy"];
    let said = say(&[&asked[..], &["0.1"]].concat(), dir.path());
    assert_eq!(said.code, 0, "{}", said.err);
    assert!(said.out.contains("accuracy 10 % reached"), "{}", said.out);
    let found = json(&dir.path().join("floquet.json"));
    assert_eq!(found["accuracy"]["reached"], true);
    let estimates = found["accuracy"]["quantities"].as_object().unwrap();
    assert!(!estimates.is_empty() && estimates.values().all(|e| e["total"].as_f64().unwrap() < 0.1));
    assert_eq!(say(&[&asked[..], &["3"]].concat(), dir.path()).code, 2);
    let cycle = ["periodic", "cases/wiring-1.json", "--accuracy", "0.3"];
    let beside = dir.path().join("cycle");
    let said = say(&cycle, &beside);
    assert_eq!(said.code, 0, "{}", said.err);
    assert!(said.out.contains("put in over the cycle"), "{}", said.out);
    assert_eq!(json(&beside.join("summary.json"))["accuracy"]["reached"], true);
    assert_eq!(json(&beside.join("cycle.json"))["accuracy"]["reached"], true);
}

#[test]
fn a_map_has_a_row_a_point_and_a_panel_a_permeability() {
    let dir = TempDir::new().unwrap();
    let map = [
        "--map",
        "frequency,amplitude",
        "--range",
        "16:20,0.01:0.03",
        "--points",
        "2,2",
    ];
    let said = say(
        &[&["floquet", "cases/valves-open.json"], &COARSE[..], &map].concat(),
        dir.path(),
    );
    assert_eq!(said.code, 0, "{}", said.err);
    let table = std::fs::read_to_string(dir.path().join("map.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 2 * 2 * 2);
    let picture = std::fs::read_to_string(dir.path().join("map.svg")).unwrap();
    assert!(
        picture.contains(">permeabilities × 1<") && picture.contains("permeabilities × 0.01"),
        "panels"
    );
    assert_eq!(
        json(&dir.path().join("map.json"))["sheets"].as_array().unwrap().len(),
        2
    );
}

/// Goal: names with quotes and commas are read back from a table as written.
#[test]
fn words_in_a_table_read_back_as_they_are() {
    let words = "no cycle: a \"tooth\" jumps, twice";
    let point = MapPoint {
        growth_per_s: None,
        multiplier: Some((0.5, -0.25)),
        stability: None,
        words: words.into(),
    };
    let map = Map {
        case: "case".into(),
        own: (1.0, 1.0),
        frequencies_hz: vec![2.0],
        amplitudes_m: vec![1e-3],
        sheets: vec![Sheet {
            permeability_factor: None,
            points: vec![vec![point]],
        }],
        mathieu: None,
        warnings: vec![],
    };
    let text = map_csv(&map);
    let row = csv::Reader::from_reader(text.as_bytes())
        .records()
        .next()
        .unwrap()
        .unwrap();
    assert_eq!(
        row.iter().collect::<Vec<_>>(),
        ["", "2", "0.001", "", "0.5", "-0.25", words]
    );
}

#[test]
fn periodic_leaves_a_result_folder_and_a_sweep_a_table() {
    let dir = TempDir::new().unwrap();
    let said = say(
        &[&["periodic", "cases/wiring-1.json"], &COARSE[..]].concat(),
        dir.path(),
    );
    assert_eq!(said.code, 0, "{}", said.err);
    for name in [
        "summary.json",
        "history.csv",
        "fields.npz",
        "cycle.json",
        "deflection.svg",
    ] {
        assert!(dir.path().join(name).is_file(), "{name}");
    }
    assert_eq!(json(&dir.path().join("summary.json"))["status"], "finished");
    let sweep = ["--sweep", "/network/permeability_factor=0.5:1:2"];
    let beside = dir.path().join("sweep");
    let said = say(
        &[&["periodic", "cases/wiring-1.json"], &COARSE[..], &sweep].concat(),
        &beside,
    );
    assert_eq!(said.code, 0, "{}", said.err);
    assert_eq!(
        std::fs::read_to_string(beside.join("sweep.csv"))
            .unwrap()
            .lines()
            .count(),
        3
    );
}

/// Goal: one cycle, cycles along a number and the table of designs report harvested energy, mean power and efficiency alike, each with its
/// error.
#[test]
fn cycles_of_a_harvester_tell_energy_power_and_efficiency() {
    let dir = TempDir::new().unwrap();
    let coarse = [&COARSE[..], &["--set", "/mesh/cells_per_bladder=1"]].concat();
    let asked = |more: &[&'static str]| {
        [
            &["periodic", "cases/harvester-parallel-uniform.json"],
            &coarse[..],
            more,
        ]
        .concat()
    };
    let beside = dir.path().join("sweep");
    let said = say(&asked(&["--sweep", "/network/permeability_factor=0.5:1:2"]), &beside);
    assert_eq!(said.code, 0, "{}", said.err);
    for heading in ["harvested [J]", "mean power [W]", "efficiency", "±"] {
        assert!(said.out.contains(heading), "{heading}: {}", said.out);
    }
    let rows: Vec<std::collections::BTreeMap<String, String>> = csv::Reader::from_path(beside.join("sweep.csv"))
        .unwrap()
        .deserialize()
        .collect::<Result<_, _>>()
        .unwrap();
    let members = &json(&beside.join("sweep.json"))["members"];
    for (row, member) in rows.iter().zip(members.as_array().unwrap()) {
        let number = |name: &str| row[name].parse::<f64>().unwrap();
        let energy = number("harvested_energy_j.window");
        let period = member["floquet"]["period_s"].as_f64().unwrap();
        assert_eq!(number("harvested_power_w.mean"), energy / period);
        assert!(energy > 0.0 && number("efficiency.window") > 0.0);
        // no figure is reported with an error above a tenth by its balance, as for one cycle
        for name in [
            "harvested_energy_j.window",
            "harvested_power_w.mean",
            "efficiency.window",
        ] {
            assert!(
                (0.0..0.1).contains(&number(&format!("{name}_error"))),
                "{name}: {row:?}"
            );
        }
        let kept = &member["quantities"]["harvested_energy_j"];
        assert_eq!(kept["window"].as_f64(), Some(energy));
        assert_eq!(
            kept["window_error"].as_f64(),
            Some(number("harvested_energy_j.window_error"))
        );
    }
    let page = std::fs::read_to_string(beside.join("report.html")).unwrap();
    assert!(page.contains("mean power [W]"), "the page");
    let said = say(&asked(&[]), &dir.path().join("one"));
    assert_eq!(said.code, 0, "{}", said.err);
    let line = said
        .out
        .lines()
        .find(|line| line.starts_with("mean power "))
        .unwrap_or_default();
    assert!(
        line.contains("W (residual of the energy balance ") && line.contains("estimated error "),
        "{}",
        said.out
    );
}

#[test]
fn what_makes_no_sense_is_a_usage_error() {
    let dir = TempDir::new().unwrap();
    let valves = "cases/valves-open.json";
    for (arguments, words) in [
        (vec!["floquet", "cases/bend-dry.json"], "period"),
        (vec!["periodic", "cases/bend-dry.json"], "nothing dissipates energy"),
        (vec!["floquet", valves, "--map", "amplitude"], "frequency,amplitude"),
        (
            vec!["floquet", valves, "--map", "frequency,amplitude", "--points", "0,3"],
            "--points",
        ),
        (
            vec!["floquet", valves, "--map", "frequency,amplitude", "--range", "3:1,0:1"],
            "--range",
        ),
        (vec!["floquet", valves, "--count", "0"], "--count"),
        (vec!["floquet", valves, "--period", "1"], "a period of its own"),
        (
            vec![
                "floquet",
                "cases/harvester-parallel-uniform.json",
                "--map",
                "frequency,amplitude",
            ],
            "does not oscillate along the beam",
        ),
        (
            vec!["periodic", valves, "--sweep", "/network/permeability_factor=0:1:5:log"],
            "--sweep",
        ),
        (vec!["periodic", valves, "--sweep", "nothing"], "--sweep"),
    ] {
        let said = say(&arguments, dir.path());
        assert_eq!(said.code, 2, "{arguments:?}: {}", said.err);
        assert!(said.err.contains(words), "{arguments:?}: {}", said.err);
    }
    let said = say(&["periodic", valves, "--sweep", "/nowhere=1:2:2"], dir.path());
    assert_eq!(said.code, 3, "{}", said.err);
}

/// Goal: an invalid or missing number of periods gives one message.
#[test]
fn periods_that_cannot_be_are_refused() {
    let dir = TempDir::new().unwrap();
    for (more, words) in [
        (&["--periods", "0"][..], "--periods 0: must be from 1 to 64"),
        (
            &["--periods", "2", "--sweep", "/network/permeability_factor=0.1:1:2"],
            "--periods applies to one cycle",
        ),
    ] {
        let said = say(&[&["periodic", "cases/valves-open.json"], more].concat(), dir.path());
        assert_eq!(said.code, 2, "{}", said.err);
        assert!(said.err.contains(words), "{}", said.err);
    }
}
