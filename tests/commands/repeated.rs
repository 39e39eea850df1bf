//! Runs that are repeated with effects that matter.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use tempfile::TempDir;

use crate::interruption::summary;
use crate::program::{command, say};

const CASE: &str = "cases/tour-wiring.json";
const CHECKPOINTS: &str = "/time/checkpoint_interval_s=0.01";

fn run(out: &Path, more: &[&str]) -> i32 {
    let out = out.to_str().expect("a path");
    let asked = ["run", CASE, "--quiet", "--out", out, "--set", CHECKPOINTS];
    say(&[&asked[..], more].concat()).code
}

fn names(dir: &Path) -> Vec<String> {
    let entries = fs::read_dir(dir).expect("a folder");
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Goal: the folder holds the last run alone, whose case, summary and page have the effects and say why; nothing is left of the first, and there is
/// nothing to resume.
#[test]
fn a_repeated_run_leaves_nothing_of_the_first() {
    let dir = TempDir::new().expect("a folder");
    let out = dir.path().join("result");
    assert_eq!(run(&out, &[]), 0);
    let left = |name: &str| name.starts_with(".next") || name.starts_with("fields.") || name.starts_with("checkpoint");
    let left: Vec<String> = names(&out).into_iter().filter(|name| left(name)).collect();
    assert_eq!(left, ["fields.npz"]);
    let summary = summary(&out);
    let reason = summary["effects"]["tube_losses"]["reason"].as_str().expect("a reason");
    assert!(reason.starts_with("measured: without it "), "{reason}");
    let page = fs::read_to_string(out.join("report.html")).expect("a page");
    assert!(page.contains("measured: without it "), "the page says why");
    let case = fs::read_to_string(out.join("case.json")).expect("a case");
    let case: serde_json::Value = serde_json::from_str(&case).expect("JSON");
    assert_eq!(case["effects"]["tube_losses"], "on");
    let checksums = summary["tables_crc32"].as_object().expect("checksums");
    for name in checksums.keys() {
        assert!(out.join(name).exists(), "{name}");
    }
}

/// Goal: a run that was stopped and goes on is repeated as one that was not, with the same files.
#[test]
fn a_resumed_run_is_repeated_too() {
    let dir = TempDir::new().expect("a folder");
    let (whole, broken) = (dir.path().join("whole"), dir.path().join("broken"));
    assert_eq!(run(&whole, &[]), 0);
    let path = broken.to_str().expect("a path");
    let mut killed = command(&["run", CASE, "--quiet", "--out", path, "--set", CHECKPOINTS])
        .stdout(Stdio::null())
        .spawn()
        .expect("a program");
    while !broken.join("checkpoint.json").exists() && killed.try_wait().expect("a process").is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    killed.kill().expect("a process");
    killed.wait().expect("a process");
    assert_eq!(run(&broken, &["--resume"]), 0);
    let (a, b) = (summary(&whole), summary(&broken));
    assert_eq!(a["effects"], b["effects"]);
    assert_eq!(a["errors"], b["errors"]);
    for name in ["case.json", "history.csv", "fields.npz"] {
        let read = |dir: &Path| fs::read(dir.join(name)).expect("a file");
        assert!(read(&whole) == read(&broken), "{name} differs");
    }
}

/// Goal: samples have the effects of the run whose bands they make.
#[test]
fn samples_have_the_effects_of_the_run() {
    let dir = TempDir::new().expect("a folder");
    let out = dir.path().join("result");
    let uncertain = "/ends/root/clamped/u1_m/sine/amplitude=normal:0.003:1e-5";
    assert_eq!(run(&out, &["--uncertain", uncertain, "--samples", "16"]), 0);
    let summary = summary(&out);
    let energy = &summary["bands"]["input_energy_j.window"];
    let of = |key: &str| energy[key].as_f64().unwrap_or_else(|| panic!("{key}: {energy}"));
    assert!(of("low") <= of("value") && of("value") <= of("high"), "{energy}");
}
