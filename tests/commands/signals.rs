//! Commands that are asked to stop: Ctrl-C, requests to terminate, once and twice.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::interruption::{program, summary};

fn signal(process: u32, name: &str) {
    let sent = Command::new("kill").args([name, &process.to_string()]).status();
    assert!(sent.unwrap().success());
}

#[cfg(unix)]
#[test]
fn interrupt_stops_with_everything_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("interrupted");
    let mut child = program()
        .args(["--set", "/time/end_s=1000", "--set", "/time/output_interval_s=0.1"])
        .args(["--set", "/time/fields_interval_s=0.1"])
        .arg("--out")
        .arg(&out)
        .spawn()
        .unwrap();
    let deadline = Instant::now() + Duration::from_secs(60);
    while !out.join("history.csv").exists() {
        assert!(Instant::now() < deadline);
        std::thread::sleep(Duration::from_millis(5));
    }
    signal(child.id(), "-INT");
    assert_eq!(child.wait().unwrap().code(), Some(130), "as shells say it");
    let summary = summary(&out);
    assert_eq!(summary["status"], "stopped");
    assert!(summary["reason"].as_str().unwrap().contains("interrupted"));
    assert!(out.join("fields.npz").exists());
}

/// Goal: a request to terminate has the exit code that shells give it, in every command that ends in order; here a path of equilibria, of which
/// nothing is left to look at.
#[cfg(unix)]
#[test]
fn a_request_to_terminate_has_its_own_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_slcbeam"))
        .args([
            "equilibrium",
            "cases/curl.json",
            "--points",
            "1000000",
            "--quiet",
            "--out",
        ])
        .arg(folder.path().join("path"))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // long before a million points are found, and after the signal is listened to
    let handled = |id: u32| {
        let status = fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        caught.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).unwrap_or(0) & (1 << 14) != 0)
    };
    let deadline = Instant::now() + Duration::from_secs(60);
    while !handled(child.id()) {
        assert!(Instant::now() < deadline && child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(2));
    }
    signal(child.id(), "-TERM");
    assert_eq!(child.wait().unwrap().code(), Some(143));
}

/// Goal: two signals at once, as `timeout` and batch systems send them, are one request: the run is completed, here one with much to complete. Before, the
/// second ended the program in the middle of that, and pictures and page were missing.
#[test]
fn two_signals_at_once_are_one_request() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let run = program()
        .arg("--out")
        .arg(&out)
        .args(["--set", "/time/end_s=1000"])
        .spawn()
        .unwrap();
    let written = || fs::metadata(out.join("history.csv")).map_or(0, |file| file.len());
    while written() < 2 << 20 {
        std::thread::sleep(Duration::from_millis(5));
    }
    for _ in 0..2 {
        signal(run.id(), "-TERM");
        std::thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(run.wait_with_output().unwrap().status.code(), Some(143));
    assert_eq!(summary(&out)["status"], "stopped");
    assert!(out.join("report.html").exists());
}

/// Goal: a second request ends a program that does not look at the first, here one that sets up a large beam.
#[test]
fn a_second_request_ends_the_program_at_once() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let mut command = Command::new(env!("CARGO_BIN_EXE_slcbeam"));
    command
        .args(["run", "cases/dry-cantilever.json", "--quiet", "--out"])
        .arg(&out);
    command.args(["--set", "/mesh/segments=80", "--set", "/mesh/cells_per_segment=1000"]);
    let run = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(100));
    signal(run.id(), "-INT");
    std::thread::sleep(Duration::from_millis(400));
    signal(run.id(), "-INT");
    assert_eq!(run.wait_with_output().unwrap().status.code(), Some(130));
    assert!(!out.join("summary.json").exists());
}
