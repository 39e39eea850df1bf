//! `slcbeam sense` from outside: what it finds, what it refuses, what it says.

use std::fs;

use serde_json::Value;
use slcbeam::run::equilibrium::EquilibriumOptions;
use slcbeam::study::sense::basis::{self, Basis};
use slcbeam::study::sense::pressures_at_rest::{AtRest, labels, probed};
use tempfile::TempDir;

use crate::common::{QUICK, sensor};

const CASE: &str = "cases/tour-sensor.json";

pub struct Said {
    pub code: i32,
    pub out: String,
    pub err: String,
}

/// `sense` of the sensor's case without its own load on a quick mesh, `out` in the folder.
pub fn sense(dir: &TempDir, more: &[&str]) -> Said {
    let out = dir.path().join("out");
    let mut command = assert_cmd::Command::cargo_bin("slcbeam").unwrap();
    command.args(["sense", CASE]);
    QUICK.iter().for_each(|set| {
        command.args(["--set", set]);
    });
    command.args(more).args(["--quiet", "--out"]).arg(out);
    let output = command.output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Said {
        code: output.status.code().unwrap(),
        out: text(output.stdout),
        err: text(output.stderr),
    }
}

pub fn found(dir: &TempDir, more: &[&str]) -> Value {
    let said = sense(dir, more);
    assert_eq!(said.code, 0, "{}", said.err);
    serde_json::from_str(&fs::read_to_string(dir.path().join("out/sense.json")).unwrap()).unwrap()
}

/// A file in the folder.
pub fn file(dir: &TempDir, text: &str) -> String {
    let path = dir.path().join("p.csv");
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().into()
}

/// Pressures under loads (so many of their sizes), a row a set of loads, of the bladders with these labels.
pub fn pressures(sets: &[&str], loads: &[Basis], rows: &[&[f64]], bladders: &[i64]) -> (String, Vec<f64>) {
    let case = sensor(sets);
    let amplitudes = basis::amplitudes(&case, loads).unwrap();
    let (probed, names) = probed(&case).unwrap();
    let options = EquilibriumOptions::at(case.time.end_s);
    let mut model = AtRest::new(&probed, &names, &amplitudes, &options).unwrap();
    let all = labels(&case);
    let places: Vec<usize> = bladders
        .iter()
        .map(|b| all.iter().position(|l| l == b).unwrap())
        .collect();
    let headings: Vec<String> = bladders.iter().map(|b| format!("pressure_{b}_kpa")).collect();
    let mut text = headings.join(",") + "\n";
    for row in rows {
        let p = model.go(row).unwrap();
        let cells: Vec<String> = places.iter().map(|k| format!("{:.6}", p[*k] / 1e3)).collect();
        text += &(cells.join(",") + "\n");
    }
    (text, amplitudes.iter().map(|a| a.size).collect())
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Loads come back out of the pressures that they make, with files, page and words of all.
#[test]
fn loads_come_back_out_of_their_pressures() {
    let dir = tempfile::tempdir().unwrap();
    let loads = [Basis::TipForce, Basis::Uniform];
    let rows: [&[f64]; 2] = [&[0.3, -0.5], &[-0.2, 1.0]];
    let (text, sizes) = pressures(&[], &loads, &rows, &[1, 4, 7, -2]);
    let path = file(&dir, &text);
    let found = found(&dir, &[&path, "--noise", "0.001"]);
    for (row, truth) in rows.iter().enumerate() {
        for k in 0..2 {
            let told = &found["rows"][row]["amplitudes"][k];
            let (value, truth) = (number(&told["value"]), truth[k] * sizes[k]);
            // pressures are written to a thousandth of a Pa
            assert!((value - truth).abs() < 1e-4 * sizes[k], "{value}, not {truth}");
            assert!(number(&told["low"]) < truth && truth < number(&told["high"]));
        }
    }
    assert_eq!(found["amplitudes"][0]["name"], "tip_force");
    assert_eq!(found["warnings"], serde_json::json!([]));
    let table = fs::read_to_string(dir.path().join("out/sense.csv")).unwrap();
    assert!(
        table.starts_with("line,tip_force [N],tip_force standard error [N],tip_force low [N]"),
        "{table}"
    );
    assert_eq!(table.lines().count(), 3);
    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    assert!(page.contains("Loads from pressures") && dir.path().join("out/sense.svg").exists());
    let again = sense(&dir, &[&path, "--noise", "1"]);
    assert!(
        again.out.contains("tip_force is determined") && again.out.contains("files in"),
        "{}",
        again.out
    );
}

/// The upper bladders joined to one closed network have one pressure at rest: one combination of loads is told, no load by itself.
#[test]
fn what_cannot_be_told_apart_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let joined =
        r#"/network={"chains": [{"bladders": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], "ends": ["sealed", "sealed"]}]}"#;
    let loads = [Basis::TipForce, Basis::Uniform];
    let truth = [0.02, -0.05];
    let (text, sizes) = pressures(&[joined], &loads, &[&truth], &[1, 5, 9]);
    let path = file(&dir, &text);
    let more = [&path, "--set", joined, "--noise", "5"];
    let found = found(&dir, &more);
    assert_eq!(found["rows"][0]["amplitudes"], serde_json::json!([null, null]));
    let sum = &found["seen"]["together"][0];
    let truth: f64 = (0..2).map(|k| number(&sum["factors"][k]) * truth[k] * sizes[k]).sum();
    let told = &found["rows"][0]["together"][0];
    assert!(
        number(&told["low"]) < truth && truth < number(&told["high"]),
        "{told}: {truth}"
    );
    let said = sense(&dir, &more);
    for words in [
        "determined only together: tip_force + ",
        "not observable: ",
        "not determined",
    ] {
        assert!(said.out.contains(words), "{}", said.out);
    }
}

/// Goal: a column of a place without bladder names the cause and the bladders that exist.
#[test]
fn a_place_without_bladder_is_explained() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("p.csv");
    let probes = r#"/probes=[{"name":"a","at":0.005}]"#;
    for (column, words) in [
        (
            "a_pressure_lower_pa",
            "there is no bladder -1: /spans/0 has none in this row. The case has bladders -2 to -8 (lower row)",
        ),
        (
            "pressure_-9_pa",
            "there is no bladder -9: /spans/2 has none in this row",
        ),
        (
            "pressure_11_pa",
            "there is no bladder 11. The case has bladders -2 to -8",
        ),
    ] {
        fs::write(&file, format!("{column}\n-2\n")).unwrap();
        let mut command = assert_cmd::Command::cargo_bin("slcbeam").unwrap();
        command.args([
            "sense",
            "cases/tapered-finger.json",
            file.to_str().unwrap(),
            "--set",
            probes,
        ]);
        let output = command
            .args(["--noise", "20", "--out"])
            .arg(dir.path().join("o"))
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(words), "{said}");
    }
}

/// What is wrong is refused before anything is computed, in words.
#[test]
fn what_is_wrong_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let one = "pressure_1_pa,pressure_3_pa\n-100,-50\n";
    let clamped = r#"/ends/tip="clamped""#;
    // the two of a pair give each other what bending moves
    let pairs = r#"/network={"chains": [{"bladders": [1, -1], "ends": ["sealed", "sealed"]}]}"#;
    let cases: [(&str, &[&str], i32, &str); 19] = [
        ("pressure_11_pa\n1\n", &[], 2, "there is no bladder 11"),
        ("pressure_1_mm\n1\n", &[], 2, "is in mm"),
        ("pressure_1_pa\n", &[], 3, "no rows"),
        ("pressure_1_pa\nmuch\n", &[], 3, "is not a finite number"),
        ("tip_u1_m\n1\n", &[], 2, "no column contains the pressure of a bladder"),
        (one, &[], 2, "determine only the loads. Give the deviation of the noise"),
        (one, &["--noise", "0"], 2, "from 1e-6 to 1e9"),
        (one, &["--noise", "1e-300"], 2, "from 1e-6 to 1e9"),
        (
            one,
            &["--load", "profile:2"],
            2,
            "determine only the loads. Give the deviation of the noise",
        ),
        (
            one,
            &["--load", "profile:3", "--smoothing", "discrepancy"],
            2,
            "needs the noise of the pressures",
        ),
        (
            "pressure_1.5_kpa\n1\n",
            &[],
            2,
            "unknown name for the pressure of a bladder",
        ),
        (one, &["--load", "tip-forse"], 2, "nearest is tip-force"),
        (one, &["--load", "uniform", "--load", "uniform"], 2, "asked for twice"),
        (one, &["--load", "tip-force", "--set", clamped], 2, "the tip is fixed"),
        (
            one,
            &["--load", "tip-force", "--noise", "1", "--smoothing", "likelihood"],
            2,
            "smoothing applies to a profile or to a load over time",
        ),
        (one, &["--smoothing", "5"], 2, "--load profile:10"),
        (one, &["--smoothing", "much"], 2, "likelihood, discrepancy, off"),
        (
            "pressure_1_pa,pressure_1_sd_pa\n1,2\n",
            &["--noise", "1"],
            2,
            "leave out one of the two",
        ),
        (
            "pressure_1_pa,pressure_-1_pa\n-600,-600\n",
            &["--noise", "5", "--set", pairs],
            2,
            "joined with bladders whose volume changes by the opposite amount",
        ),
    ];
    for (text, more, code, words) in cases {
        let path = file(&dir, text);
        let said = sense(&dir, &[&[&*path], more].concat());
        assert_eq!(said.code, code, "{text}: {}", said.err);
        assert!(said.err.contains(words), "{text}: {}", said.err);
        assert!(!dir.path().join("out/sense.json").exists());
    }
    // without bladders; with bladders that have the pressure of ports at rest, whatever acts
    for (case, words) in [
        ("cases/bend-dry.json", "no fluid-filled bladders"),
        ("cases/tour-wiring.json", "is at the pressure of a port"),
    ] {
        let output = assert_cmd::Command::cargo_bin("slcbeam")
            .unwrap()
            .args(["sense", case, "--out"])
            .arg(dir.path().join("none"))
            .output()
            .unwrap();
        let err = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && err.contains(words), "{err}");
    }
}

/// Goal: of many places of a profile most leave no trace; how many, and which, is one line, not a line each.
#[test]
fn many_places_that_leave_no_trace_are_one_line() {
    let dir = tempfile::tempdir().unwrap();
    let said = sense(&dir, &["--load", "profile:60"]);
    assert_eq!(said.code, 0, "{}", said.err);
    let blind: Vec<&str> = said
        .out
        .lines()
        .filter(|line| line.contains("not observable"))
        .collect();
    assert_eq!(blind.len(), 1, "{}", said.out);
    assert!(
        blind[0].contains("not observable: ") && blind[0].contains("places of a profile, profile_"),
        "{}",
        blind[0]
    );
    let before = said.out.split("the best bladders").next().unwrap();
    assert!(
        before.lines().count() < 12 && before.lines().all(|line| line.len() < 400),
        "{before}"
    );
}

/// A buckled beam that a load pushes to the other side, and that stays where it is: the loads are found, but their path from rest leads to the
/// other side, W033.
#[test]
fn a_state_that_loads_do_not_lead_to_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let sets = [
        r#"/ends={"root": "pinned", "tip": {"pinned": {"u3_m": {"ramp": {"to": -0.01, "duration_s": 0.5}}}}}"#,
        r#"/loads=[{"force_x_n_m": {"signal": 2}}]"#,
    ];
    let size = pressures(&sets, &[Basis::Uniform], &[], &[1]).1[0];
    let rows = [-1.5, -3.0].map(|load| [load / size]);
    let rows: Vec<&[f64]> = rows.iter().map(|row| &row[..]).collect();
    let (text, _) = pressures(&sets, &[Basis::Uniform], &rows, &[1, 3, 5, 7, 9, -3, -8]);
    let lines: Vec<&str> = text.lines().collect();
    let ask = |line: &str| {
        let path = file(&dir, &format!("{}\n{line}\n", lines[0]));
        let told = found(
            &dir,
            &[
                &path, "--load", "uniform", "--noise", "10", "--set", sets[0], "--set", sets[1],
            ],
        );
        let aside = told["warnings"]
            .as_array()
            .unwrap()
            .iter()
            .any(|w| w.as_str().unwrap().starts_with("W033"));
        (number(&told["rows"][0]["amplitudes"][0]["value"]), aside)
    };
    let (value, aside) = ask(lines[1]);
    assert!((value + 1.5).abs() < 0.05 && !aside, "{value} {aside}");
    let (value, aside) = ask(lines[2]);
    assert!((value + 3.0).abs() < 0.05 && aside, "{value} {aside}");
}

/// The best bladders tell more than as many others, errors fall with their number, and without measurements that is all.
#[test]
fn the_best_bladders_tell_most() {
    let dir = tempfile::tempdir().unwrap();
    let all = found(&dir, &[]);
    let sets = all["choice"].as_array().unwrap();
    assert_eq!(sets.len(), 19);
    let error = |set: &Value, k: usize| number(&set["errors"][k]);
    for k in 0..2 {
        assert!(
            sets.windows(2)
                .all(|pair| error(&pair[1], k) < 1.0001 * error(&pair[0], k))
        );
    }
    let (text, _) = pressures(&[], &[Basis::Uniform], &[&[0.1]], &[8, 9]);
    let others = found(&dir, &[&file(&dir, &text), "--noise", "1", "--choose=volume"]);
    assert!(number(&others["amplitudes"][0]["error_per_pa"]) > 2.0 * error(&sets[0], 0));
    assert_eq!(others["choice"].as_array().unwrap().len(), 19);
    let table = fs::read_to_string(dir.path().join("out/sensors.csv")).unwrap();
    assert!(
        table.starts_with("count,bladders,tip_force standard error [N]"),
        "{table}"
    );
}

/// A profile: pressures of a load on the outer half show it there; a column of time is carried along, with a word on rest.
#[test]
fn a_profile_shows_where_a_load_is() {
    let dir = tempfile::tempdir().unwrap();
    let half = "/loads=[{\"force_x_n_m\": {\"signal\": 10, \"profile\": {\"table\": {\"positions\": [0, 0.3, 0.5, 1], \
                \"values\": [0, 0, 1, 1], \"interpolation\": \"linear\"}}}}]";
    let bladders: Vec<i64> = (1..=10).chain((1..=10).map(|k| -k)).collect();
    let (text, _) = pressures(&[half], &[Basis::Uniform], &[&[0.0]], &bladders);
    let (heading, row) = text.trim_end().split_once('\n').unwrap();
    let path = file(&dir, &format!("t_s,{heading}\n0.5,{row}\n"));
    let found = found(&dir, &[&path, "--load", "profile:7", "--noise", "1"]);
    let told = |k: usize| &found["rows"][0]["amplitudes"][k];
    for (k, truth) in [(1, 0.0), (3, 10.0), (4, 10.0)] {
        let value = number(&told(k)["value"]);
        assert!((value - truth).abs() < 4.0, "{k}: {value}");
        assert!(number(&told(k)["low"]) < value && value < number(&told(k)["high"]));
    }
    assert!(number(&found["smoothing"]["load_deviation_n_m"]) > 0.0);
    assert_eq!(found["rows"][0]["t_s"], 0.5);
    let said = sense(&dir, &[&path, "--load", "profile:7", "--noise", "1"]);
    assert!(said.out.contains("without inertia and flow"), "{}", said.out);
}

/// Goal: loads of the case that act besides are told: what is found comes on top of them.
#[test]
fn own_loads_are_told() {
    let dir = TempDir::new().unwrap();
    let said = sense(&dir, &[]);
    assert!(said.code == 0 && !said.out.contains("also act"), "{}", said.out);
    let said = sense(&dir, &["--set", r#"/loads=[{"gravity": {"x_m_s2": -9.81}}]"#]);
    assert!(
        said.out.contains("loads of the case also act") && said.out.contains("/loads/0/gravity"),
        "{}{}",
        said.out,
        said.err
    );
}
