//! What is read from the user: very many entries, very large sizes, tables from files, text that a terminal would obey.

mod text;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::time::Instant;

use serde_json::{Value, json};

use super::program::{PATIENCE, answer, bounded, slcbeam, stderr};

fn beam() -> Value {
    json!({
        "name": "dry",
        "beam": {"length_m": 0.1, "height_m": 0.002, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950},
        "ends": {"root": "clamped", "tip": "free"},
        "mesh": {"segments": 2, "cells_per_segment": 2},
        "time": {"end_s": 0.02, "output_interval_s": 0.001}
    })
}

fn put(dir: &Path, case: &Value) -> PathBuf {
    let path = dir.join("case-in.json");
    fs::write(&path, case.to_string()).expect("the case");
    path
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

fn check(case: &Path, more: &[&str]) -> Output {
    slcbeam().arg("check").arg(case).args(more).output().expect("it starts")
}

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Goal: what no person writes is refused soon, with the bound.
#[test]
fn very_many_entries_are_refused_soon() {
    let dir = folder();
    let constants = |count: usize| Value::from(vec![1; count]);
    let load = |signal: Value| json!({"force_x_n_m": {"signal": signal}});
    let ramp = json!({"ramp": {"to": 1.0, "duration_s": 1.0}});
    let tens = Value::from(vec![json!({"sum": constants(900)}); 10]);
    for (loads, bound) in [
        (Value::from(vec![load(json!(1)); 300_000]), "at most 10000"),
        (json!([load(json!({"sum": constants(1_000_000)}))]), "at most 1000"),
        (json!([load(json!({"product": vec![ramp; 200_000]}))]), "at most 1000"),
        (json!([load(json!({"sum": tens}))]), "at most 4000"),
    ] {
        let mut case = beam();
        case["loads"] = loads;
        let begin = Instant::now();
        let answer = check(&put(dir.path(), &case), &["--json"]);
        assert!(begin.elapsed() < PATIENCE, "{bound}: {:?}", begin.elapsed());
        assert_eq!(answer.status.code(), Some(3), "{bound}");
        let told: Value = serde_json::from_slice(&answer.stdout).expect("JSON");
        assert_eq!(told["faults"][0]["code"], "E007");
        assert!(
            told["faults"][0]["allowed"]
                .as_str()
                .is_some_and(|a| a.starts_with(bound)),
            "{told}"
        );
    }
}

/// Goal: a hundred thousand unknown keys in one line are told soon, the first thousand by place and how many there are besides.
#[test]
fn very_many_unknown_keys_are_told_soon() {
    let dir = folder();
    let mut case = beam();
    for k in 0..100_000 {
        case[format!("key{k}")] = json!(1);
    }
    let path = put(dir.path(), &case);
    for more in [&[][..], &["--json"]] {
        let begin = Instant::now();
        let answer = check(&path, more);
        assert!(begin.elapsed() < PATIENCE / 2, "{more:?}: {:?}", begin.elapsed());
        assert_eq!(answer.status.code(), Some(3));
    }
    let told: Value = serde_json::from_slice(&check(&path, &["--json"]).stdout).expect("JSON");
    let faults = told["faults"].as_array().expect("faults");
    assert_eq!(faults.len(), 1001);
    assert_eq!(faults[1000]["what"], "and 99000 more faults");
    let text = case.to_string();
    let column = text.find("\"key7\"").expect("the key") + 1;
    assert_eq!(faults[7]["column"], column);
}

/// Goal: brackets inside brackets do not overflow the stack, wherever they stand.
#[test]
fn deep_brackets_are_refused() {
    let dir = folder();
    let path = dir.path().join("deep.json");
    for open in ["[", "{\"sum\":[", "{\"a\":"] {
        fs::write(&path, open.repeat(200_000)).expect("the case");
        let answer = check(&path, &[]);
        assert_eq!(answer.status.code(), Some(3), "{open}");
        assert!(stderr(&answer).contains("brackets nested more than 100 deep"), "{open}");
    }
    let good = put(dir.path(), &beam());
    let deep = format!("/loads={}", "[".repeat(60_000));
    assert_eq!(check(&good, &["--set", &deep]).status.code(), Some(2));
    let pointer = format!("/loads{}=1", "/a".repeat(60_000));
    let answer = check(&good, &["--set", &pointer]);
    assert!(matches!(answer.status.code(), Some(2 | 3)), "{:?}", answer.status);
}

/// Goal: sizes that no machine has are refused at once by every command, with the numbers, and nothing is allocated for them.
#[test]
fn sizes_beyond_the_machine_are_refused_at_once() {
    let dir = folder();
    let mut case = beam();
    case["mesh"] = json!({"segments": 100_000, "cells_per_segment": 1000});
    let path = put(dir.path(), &case);
    for command in [
        "check",
        "run",
        "modes",
        "equilibrium",
        "floquet",
        "periodic",
        "study",
        "effects",
    ] {
        let mut asked = bounded(2_000_000);
        asked.arg(command).arg(&path).arg("--json").current_dir(dir.path());
        let answer = answer(&mut asked, PATIENCE).expect("an answer");
        assert_eq!(answer.status.code(), Some(3), "{command}: {}", stderr(&answer));
        let told: Value = serde_json::from_slice(&answer.stdout).expect("JSON");
        let fault = &told["faults"][0];
        assert_eq!(
            (&fault["code"], &fault["pointer"]),
            (&json!("E006"), &json!("/mesh")),
            "{command}"
        );
        let what = fault["what"].as_str().unwrap_or_default();
        assert!(what.contains("4.000e8 unknowns") && what.contains("GB"), "{what}");
        assert!(!dir.path().join("out").exists(), "{command} has made its folder");
    }
}

/// Goal: what a run takes is told before it is begun, and holds to a factor of five, many columns being zero.
#[test]
fn what_a_run_needs_is_told() {
    let dir = folder();
    let path = put(dir.path(), &beam());
    let told: Value = serde_json::from_slice(&check(&path, &["--json"]).stdout).expect("JSON");
    let needs = &told["needs"];
    for key in [
        "memory_bytes",
        "disk_bytes",
        "set_up_s",
        "memory_available_bytes",
        "disk_free_bytes",
    ] {
        assert!(needs[key].as_f64().is_some_and(|x| x > 0.0), "{key}: {needs}");
    }
    assert!(stdout(&check(&path, &[])).contains("a run needs about"));

    for (name, history) in [
        ("all", r#""all""#),
        ("window", r#""window""#),
        ("every", r#"{"every": 7}"#),
    ] {
        let thinned = format!("/time/history={history}");
        let fine = ["--set", "/time/output_interval_s=0.000005", "--set", thinned.as_str()];
        let told: Value =
            serde_json::from_slice(&check(&path, &[&fine[..], &["--json"]].concat()).stdout).expect("JSON");
        let out = dir.path().join(name);
        let ran = slcbeam()
            .arg("run")
            .arg(&path)
            .args(fine)
            .args(["--quiet", "--out"])
            .arg(&out)
            .output();
        assert!(ran.expect("it starts").status.success());
        let size = |name: &str| fs::metadata(out.join(name)).map_or(0.0, |file| file.len() as f64);
        // raw arrays lie beside the archive while that is made
        let written = size("history.csv") + size("envelope.csv") + 2.0 * size("fields.npz");
        let estimate = told["needs"]["disk_bytes"].as_f64().expect("a number") - 2e6;
        assert!(
            (written..5.0 * written).contains(&estimate),
            "{name}: {estimate} for {written}"
        );
    }

    let many = ["--set", "/mesh/segments=100", "--set", "/time/end_s=1e4"];
    let often = [
        "--set",
        "/mesh/cells_per_segment=1000",
        "--set",
        "/time/output_interval_s=1e-2",
    ];
    let full = slcbeam()
        .arg("run")
        .arg(&path)
        .args(many)
        .args(often)
        .arg("--out")
        .arg(dir.path().join("full"))
        .output()
        .expect("it starts");
    assert_eq!(full.status.code(), Some(3), "{}", stderr(&full));
    assert!(
        stderr(&full).contains("are free on the disk of the result folder"),
        "{}",
        stderr(&full)
    );
}

/// Goal: rows that are not written are not counted: 1e8 outputs of which the window has a thousand are allowed, 1e8 rows are not.
#[test]
fn rows_that_are_left_out_are_not_counted() {
    let dir = folder();
    let path = put(dir.path(), &beam());
    let many = ["--set", "/time/end_s=1e6", "--set", "/time/output_interval_s=1e-2"];
    let window = ["--set", "/time/window_s=10", "--set", r#"/time/history="window""#];
    let refused = check(&path, &many);
    assert_eq!(refused.status.code(), Some(3));
    assert!(stderr(&refused).contains("1.0e8 rows"), "{}", stderr(&refused));
    let allowed = check(&path, &[many, window].concat());
    assert_eq!(allowed.status.code(), Some(0), "{}", stderr(&allowed));
}

/// Goal: a long table stays a file: the result's case runs again, gives the same, and a table with another point is refused.
#[test]
fn long_tables_stay_files() {
    let dir = folder();
    let rows = 300_000;
    let value = |k: usize| 1e-3 * (k as f64 * 0.01).sin();
    let text: String = (0..rows)
        .map(|k| format!("{},{}\n", k as f64 * 1e-7, value(k)))
        .collect();
    fs::write(dir.path().join("my.csv"), format!("time,force\n{text}")).expect("the table");
    let mut case = beam();
    case["loads"] = json!([
        {"force_x_n_m": {"signal": {"table": {"csv": "my.csv", "interpolation": "linear"}}}},
        {"force_z_n_m": {"signal": {"table": {"times_s": [0, 1], "values": [0, 1e-6]}}}}
    ]);
    case["solver"] = json!({"rtol": 1e-2});
    let path = put(dir.path(), &case);
    let stop = ["--set", "/solver/max_steps=200", "--quiet"];
    let (first, second) = (dir.path().join("first"), dir.path().join("second"));
    let run = |case: &Path, out: &Path| slcbeam().arg("run").arg(case).args(stop).arg("--out").arg(out).output();
    run(&path, &first).expect("it starts");
    let resolved = fs::read_to_string(first.join("case.json")).expect("the case");
    assert!(resolved.len() < 10_000, "{} bytes", resolved.len());
    let resolved: Value = serde_json::from_str(&resolved).expect("JSON");
    let table = &resolved["loads"][0]["force_x_n_m"]["signal"]["table"];
    let name = table["csv"].as_str().expect("a file").to_owned();
    assert_eq!(
        name,
        format!("table-{}.csv", table["checksum"].as_str().expect("a checksum"))
    );
    assert!(resolved["loads"][1]["force_z_n_m"]["signal"]["table"]["times_s"].is_array());

    let again = run(&first.join("case.json"), &second).expect("it starts");
    assert!(matches!(again.status.code(), Some(0 | 4)), "{}", stderr(&again));
    for file in ["case.json", name.as_str(), "history.csv"] {
        let read = |dir: &Path| fs::read(dir.join(file)).expect("a file");
        assert!(read(&first) == read(&second), "{file} differs");
    }
    // another case takes the folder: the table of the one before goes
    let plain = put(dir.path(), &beam());
    assert!(run(&plain, &second).expect("it starts").status.success());
    assert!(!second.join(&name).exists(), "a table of no case is left");

    let points = fs::read_to_string(first.join(&name)).expect("the table");
    fs::write(first.join(&name), points.replacen("0.0,0.0", "0.0,1e-9", 1)).expect("the table");
    let refused = check(&first.join("case.json"), &["--json"]);
    let told: Value = serde_json::from_slice(&refused.stdout).expect("JSON");
    assert_eq!(
        (refused.status.code(), &told["faults"][0]["code"]),
        (Some(3), &json!("E008"))
    );
    assert!(
        told["faults"][0]["what"]
            .as_str()
            .is_some_and(|w| w.contains("checksum")),
        "{told}"
    );
}

/// Goal: nothing is told of a window to which the run has not come.
#[test]
fn a_window_that_is_not_reached_has_no_figures() {
    let dir = folder();
    let summary = |end: &str| -> Value {
        let out = dir.path().join("out");
        let mut command = slcbeam();
        command.args([
            "run",
            "cases/shake-wet.json",
            "--quiet",
            "--json",
            "--set",
            "/time/end_s=0.1",
        ]);
        command.args([
            "--set",
            "/time/window_s=0.02",
            "--set",
            "/time/output_interval_s=0.001",
            "--set",
            end,
        ]);
        let answer = command.arg("--out").arg(&out).output().expect("it starts");
        serde_json::from_slice(&answer.stdout).expect("a summary")
    };
    let figures = |summary: &Value| -> Vec<String> {
        let all = summary["quantities"].as_object().expect("quantities").values();
        let keys = all.filter_map(Value::as_object).flat_map(|q| q.keys().cloned());
        keys.filter(|key| key.starts_with("window")).collect()
    };
    let stopped = summary("/solver/max_steps=3");
    assert_eq!(figures(&stopped), Vec::<String>::new(), "{stopped:#}");
    let finished = summary("/solver/max_steps=1000000");
    assert_eq!(finished["status"], "finished");
    assert!(figures(&finished).iter().any(|key| key == "window_max_abs"));
}

/// Goal: a command suggests only what it has.
#[test]
fn periodic_suggests_what_there_is() {
    let dir = folder();
    let path = put(dir.path(), &beam());
    let answer = slcbeam()
        .arg("periodic")
        .arg(&path)
        .arg("--out")
        .arg(dir.path().join("out"))
        .output()
        .expect("it starts");
    assert_eq!(answer.status.code(), Some(2));
    assert!(stderr(&answer).contains("slcbeam modes"), "{}", stderr(&answer));
}

/// Goal: the benchmark's committed lock names what the program depends on, so that running it changes no file.
#[test]
fn the_benchmark_is_locked() {
    let lock = fs::read_to_string("benches/peers/Cargo.lock").expect("the lock");
    let own = lock
        .split("[[package]]")
        .find(|p| p.contains("name = \"slcbeam\""))
        .expect("the program");
    let mut locked: Vec<&str> = own
        .lines()
        .filter_map(|line| line.trim().strip_prefix('"')?.split(['"', ' ']).next())
        .collect();
    let manifest = fs::read_to_string("Cargo.toml").expect("the manifest");
    let mut wanted: Vec<&str> = vec![];
    for section in ["[dependencies]", "[build-dependencies]"] {
        let lines = manifest
            .split(section)
            .nth(1)
            .into_iter()
            .flat_map(|rest| rest.lines().skip(1));
        let names = lines
            .take_while(|line| !line.starts_with('['))
            .filter_map(|line| line.split_once(" = "));
        wanted.extend(names.map(|(name, _)| name));
    }
    locked.sort_unstable();
    wanted.sort_unstable();
    assert_eq!(locked, wanted);
    let script = fs::read_to_string("scripts/bench").expect("the script");
    assert!(script.contains("--locked"));
}

/// Goal: a file of the system that claims a size of 0 is read within a limit, as a table of a case and as data.
#[cfg(target_os = "linux")]
#[test]
fn files_that_claim_to_be_empty_are_read_within_a_limit() {
    const ENDLESS: &str = "/proc/self/pagemap";
    let dir = folder();
    let mut case = beam();
    case["loads"] = json!([{"force_x_n_m": {"signal": {"table": {"csv": ENDLESS}}}}]);
    let path = put(dir.path(), &case);
    let output = check(&path, &[]);
    let told = stderr(&output);
    assert!(output.status.code() == Some(3) && told.contains(ENDLESS), "{told}");
    let result = dir.path().join("result");
    fs::create_dir(&result).expect("a folder");
    std::os::unix::fs::symlink(ENDLESS, result.join("summary.json")).expect("a link");
    let output = slcbeam().arg("report").arg(&result).output().expect("it starts");
    assert!(
        !output.status.success() && stderr(&output).contains("summary.json"),
        "{}",
        stderr(&output)
    );
}
