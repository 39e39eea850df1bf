//! Commands that are asked to stop: Ctrl-C, requests to terminate, once and twice.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::interruption::{program, summary};

fn signal(process: u32, name: &str) {
    let sent = Command::new("kill").args([name, &process.to_string()]).status();
    assert!(sent.unwrap().success());
}

/// Waits until a run has begun to write its history.
fn wait_for_history(out: &Path) {
    let deadline = Instant::now() + Duration::from_secs(60);
    while !out.join("history.csv").exists() {
        assert!(Instant::now() < deadline);
        std::thread::sleep(Duration::from_millis(5));
    }
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
    wait_for_history(&out);
    signal(child.id(), "-INT");
    assert_eq!(child.wait().unwrap().code(), Some(130), "as shells say it");
    let summary = summary(&out);
    assert_eq!(summary["status"], "stopped");
    assert!(summary["reason"].as_str().unwrap().contains("interrupted"));
    assert!(out.join("fields.npz").exists());
}

/// Goal: a closed terminal ends a run as Ctrl-C does, with exit code 129, also where two hangups arrive; a run under `nohup` goes on until it is
/// asked to terminate. Before, a hangup ended a run without summary.
#[cfg(target_os = "linux")]
#[test]
fn a_hangup_stops_with_everything_written_except_under_nohup() {
    for (disposition, signals, code) in [
        ("--default-signal=HUP", ["-HUP", "-HUP"], 129),
        ("--ignore-signal=HUP", ["-HUP", "-TERM"], 143),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("closed");
        let mut child = Command::new("env")
            .args([disposition, "--default-signal=TERM", env!("CARGO_BIN_EXE_slcbeam")])
            .args(["run", "cases/bend-wet.json", "--quiet"])
            .args(["--set", "/time/end_s=1000", "--set", "/time/output_interval_s=0.1"])
            .arg("--out")
            .arg(&out)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        wait_for_history(&out);
        for name in signals {
            // one that has ended is not waited for yet, so that its number stays its own
            signal(child.id(), name);
            std::thread::sleep(Duration::from_millis(400));
        }
        assert_eq!(child.wait().unwrap().code(), Some(code), "{disposition}");
        let summary = summary(&out);
        assert_eq!(summary["status"], "stopped", "{disposition}");
        assert!(summary["reason"].as_str().unwrap().contains("interrupted"));
    }
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
        .args(["--set", "/time/end_s=100"])
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

/// State and CPU time [s] of a process that has not been waited for.
#[cfg(target_os = "linux")]
fn spent(process: u32) -> (String, f64) {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap();
    let parts: Vec<&str> = stat.rsplit_once(')').unwrap().1.split_whitespace().collect();
    let ticks: f64 = [11, 12].map(|k: usize| parts[k].parse::<f64>().unwrap()).iter().sum();
    (parts[0].into(), ticks / 100.0)
}

/// Commands that compute for minutes; what all of them have in common is left out.
#[cfg(target_os = "linux")]
const LONG: [&str; 27] = [
    "run cases/bend-wet.json --set /time/end_s=100 --out",
    "run cases/dry-cantilever.json --set /mesh/segments=80 --set /mesh/cells_per_segment=400 --out",
    "run cases/bend-wet.json --accuracy 1e-6 --set /time/end_s=100 --out",
    "run cases/bend-wet.json --uncertain /beam/young_modulus_pa=normal:2e6:1e5 --samples 4000 --out",
    "equilibrium cases/curl.json --points 1000000 --out",
    "equilibrium cases/curl.json --set /mesh/cells_per_segment=200 --points 10000 --out",
    "equilibrium cases/curl.json --accuracy 1e-6 --set /mesh/cells_per_segment=200 --out",
    "modes cases/bend-wet.json --set /mesh/cells_per_segment=200 --count 200 --out",
    "modes cases/bend-wet.json --uncertain /beam/young_modulus_pa=normal:2e6:1e5 --samples 4000 --out",
    "modes cases/valves-half.json --map frequency,amplitude --points 100,100 --out",
    "response cases/shake-wet.json --set /mesh/cells_per_segment=60 --points 100000 --input /ends/root/clamped/u1_m --output tip_u1 --out",
    "bands cases/metamaterial.json --set /mesh/cells_per_segment=16 --points 100000 --out",
    "periodic cases/tour-harvester.json --set /mesh/cells_per_segment=200 --out",
    "periodic cases/tour-harvester.json --sweep /beam/young_modulus_pa=1e6:2e6:100 --out",
    "floquet cases/tour-harvester.json --set /mesh/cells_per_segment=200 --out",
    "floquet cases/valves-half.json --map frequency,amplitude --points 100,100 --out",
    "study cases/bend-wet.json --budget 300s --out",
    "effects cases/bend-wet.json --budget 300s --repeats 100 --out",
    "sweep cases/bend-wet.json --vary /beam/length_m=0.1,0.11,0.12 --set /time/end_s=100 --out",
    "sweep cases/bend-wet.json --command modes --vary /beam/length_m=0.1,0.11 --set /mesh/cells_per_segment=200 --jobs 1 --out",
    "sweep cases/curl.json --command equilibrium --vary /beam/young_modulus_pa=1e6,1.1e6 --set /mesh/cells_per_segment=200 --out",
    "sweep cases/tour-harvester.json --command periodic --vary /beam/young_modulus_pa=1e6,1.1e6 --set /mesh/cells_per_segment=200 --out",
    "optimize cases/bend-wet.json --vary /beam/length_m=0.09:0.12 --maximize tip_u1_m.max_abs --command run --set /time/end_s=100 --out",
    "optimize cases/bend-wet.json --vary /beam/length_m=0.09:0.12 --maximize tip_u1_m --command equilibrium --set /mesh/cells_per_segment=200 --out",
    "optimize cases/bend-dry.json --vary /beam/length_m=0.09:0.12 --maximize mode_1.frequency_hz --command modes --set /mesh/cells_per_segment=200 --out",
    "verify",
    "coefficients src/cli/sections/pneunet.json --three-d",
];

/// Goal: wherever it is, a command ends within 2 s of CPU time after one request.
#[cfg(target_os = "linux")]
#[test]
fn every_long_command_ends_within_two_seconds_of_cpu() {
    const SECONDS: f64 = 2.0;
    let dir = tempfile::tempdir().unwrap();
    let mut late = vec![];
    for (number, words) in LONG.iter().enumerate() {
        // a shell that starts the tests beside others lets their programs ignore interrupts
        let mut command = Command::new("env");
        command
            .args(["--default-signal=INT", env!("CARGO_BIN_EXE_slcbeam")])
            .args(words.split(' '))
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        if words.ends_with("--out") {
            command.arg(dir.path().join(number.to_string())).arg("--quiet");
        }
        let mut child = command.spawn().unwrap();
        let mut before = spent(child.id());
        while before.0 != "Z" && before.1 < 0.4 {
            std::thread::sleep(Duration::from_millis(10));
            before = spent(child.id());
        }
        assert_ne!(before.0, "Z", "{words} is not long");
        signal(child.id(), "-INT");
        let mut after = spent(child.id());
        while after.0 != "Z" && after.1 - before.1 < 2.0 * SECONDS {
            std::thread::sleep(Duration::from_millis(10));
            after = spent(child.id());
        }
        let _ = child.kill();
        let status = child.wait().unwrap();
        // what listens to no signal is ended by it
        let told = std::os::unix::process::ExitStatusExt::signal(&status) == Some(2) || status.code() == Some(130);
        if after.1 - before.1 > SECONDS || !told {
            late.push(format!("{words}: {:.2} s, {status}", after.1 - before.1));
        }
    }
    assert!(late.is_empty(), "{}", late.join("\n"));
}

/// Goal: a command that ends before it has anything says that it was interrupted, by a number of its own, and not that its command line makes no sense.
#[test]
fn an_interrupted_command_has_a_number_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    for (command, case) in [("periodic", "cases/wiring-2.json"), ("equilibrium", "cases/curl.json")] {
        let said = Command::new(env!("CARGO_BIN_EXE_slcbeam"))
            .args([command, case, "--quiet", "--json", "--max-wall", "0", "--out"])
            .arg(folder.path().join(command))
            .output()
            .unwrap();
        let err = String::from_utf8_lossy(&said.stderr);
        assert!(
            err.contains("explain E049") && !err.contains("E030"),
            "{command}: {err}"
        );
    }
}
