//! The program under attack, with a short run that writes checkpoints.

use std::fs::{self, File};
use std::io::{Read as _, Seek as _};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use slcbeam::output::folder::PICTURES;

pub const CASE: &str = "cases/wiring-2.json";

/// A run of 0.05 s with four checkpoints.
pub const SETS: [&str; 7] = [
    "/time/checkpoint_interval_s=0.01",
    "/time/end_s=0.05",
    "/time/window_s=0.02",
    "/time/output_interval_s=0.001",
    "/solver/rtol=1e-3",
    "/mesh/cells_per_segment=1",
    "/mesh/cells_per_bladder=1",
];

/// `slcbeam run CASE --quiet` with the short run's changes.
pub fn arguments() -> Vec<String> {
    let mut all = vec!["run".to_string(), CASE.into(), "--quiet".into()];
    for set in SETS {
        all.extend(["--set".into(), set.into()]);
    }
    all
}

/// The short run into a folder.
pub fn run(out: &Path, more: &[&str]) -> Output {
    slcbeam()
        .args(arguments())
        .args(more)
        .arg("--out")
        .arg(out)
        .output()
        .expect("it starts")
}

pub fn slcbeam() -> Command {
    Command::new(env!("CARGO_BIN_EXE_slcbeam"))
}

/// Address space of a program under attack [KiB].
pub const MEMORY: u64 = 4 << 20;
/// Time that it has to answer.
pub const PATIENCE: Duration = Duration::from_secs(20);

/// The program in so much address space [KiB].
pub fn bounded(memory: u64) -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", &format!("ulimit -v {memory}; exec \"$0\" \"$@\"")]);
    command.arg(env!("CARGO_BIN_EXE_slcbeam"));
    command
}

/// What a command answers within a time; `None` where it does not, and is killed.
pub fn answer(command: &mut Command, patience: Duration) -> Option<Output> {
    let [mut stdout, mut stderr] = [(); 2].map(|()| tempfile::tempfile().expect("a file"));
    let into = |file: &File| file.try_clone().expect("a file");
    let mut child = command
        .stdin(Stdio::null())
        .stdout(into(&stdout))
        .stderr(into(&stderr))
        .spawn()
        .expect("it starts");
    let begin = Instant::now();
    wait(&mut child, || begin.elapsed() > patience);
    let Some(status) = child.try_wait().expect("its state") else {
        kill(&mut child);
        return None;
    };
    let told = |file: &mut File| {
        let mut bytes = vec![];
        file.rewind()
            .and_then(|()| file.read_to_end(&mut bytes))
            .expect("what it told");
        bytes
    };
    Some(Output {
        status,
        stdout: told(&mut stdout),
        stderr: told(&mut stderr),
    })
}

/// Waits until something is there or the program has ended.
pub fn wait(child: &mut Child, there: impl Fn() -> bool) {
    while !there() && child.try_wait().expect("its state").is_none() {
        std::thread::sleep(Duration::from_micros(200));
    }
}

pub fn kill(child: &mut Child) {
    child.kill().expect("it is killed");
    child.wait().expect("it ends");
}

/// What makes the run long enough to be killed in its middle.
pub const LONG: [&str; 4] = ["--set", "/time/end_s=0.6", "--set", "/time/checkpoint_interval_s=0.05"];

/// The short run, begun and left alone, silent.
pub fn start(out: &Path, more: &[&str]) -> Child {
    slcbeam()
        .args(arguments())
        .args(more)
        .arg("--out")
        .arg(out)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("it starts")
}

/// The longer run into a folder.
pub fn run_long(out: &Path, more: &[&str]) -> Output {
    run(out, &[&LONG, more].concat())
}

/// The longer run, killed after its second checkpoint.
pub fn killed(out: &Path) {
    for _ in 0..20 {
        let _ = fs::remove_dir_all(out);
        let mut child = start(out, &LONG);
        let both = || {
            ["checkpoint-before.json", "checkpoint.json"]
                .iter()
                .all(|name| out.join(name).exists())
        };
        wait(&mut child, both);
        kill(&mut child);
        if both() {
            return;
        }
        // the run was faster than the kill, or struck while it changed checkpoints
    }
    panic!("the run is too fast to be killed");
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Whether two results are the same, but for wall time.
pub fn same(a: &Path, b: &Path) -> Result<(), String> {
    for name in ["history.csv", "fields.npz", "case.json"].into_iter().chain(PICTURES) {
        let read = |dir: &Path| fs::read(dir.join(name)).map_err(|e| format!("{name}: {e}"));
        if read(a)? != read(b)? {
            return Err(format!("{name} differs"));
        }
    }
    let summary = |dir: &Path| -> Result<Value, String> {
        let text = fs::read_to_string(dir.join("summary.json")).map_err(|e| format!("summary: {e}"))?;
        let mut value: Value = serde_json::from_str(&text).map_err(|e| format!("summary: {e}"))?;
        value.as_object_mut().map(|v| v.remove("wall_s"));
        let companion = value.get_mut("companion").and_then(|of| of.as_object_mut());
        companion.map(|of| of.remove("wall_s"));
        Ok(value)
    };
    if summary(a)? != summary(b)? {
        return Err("summary.json differs".into());
    }
    Ok(())
}

/// All files of a folder with their contents, but for the lock that a killed process leaves.
pub fn contents(dir: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all = vec![];
    for entry in fs::read_dir(dir)
        .expect("a folder")
        .map(|e| e.expect("an entry").path())
    {
        let name = entry.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if entry.is_dir() {
            all.extend(contents(&entry).into_iter().map(|(n, c)| (format!("{name}/{n}"), c)));
        } else if name != ".slcbeam.lock" {
            all.push((name, fs::read(&entry).expect("a file")));
        }
    }
    all.sort();
    all
}

/// Copies a folder in place of another.
pub fn copy(from: &Path, to: &Path) {
    let _ = fs::remove_dir_all(to);
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from)
        .expect("a folder")
        .map(|e| e.expect("an entry").path())
    {
        let target = to.join(entry.file_name().expect("a name"));
        if entry.is_dir() {
            copy(&entry, &target);
        } else {
            fs::copy(&entry, &target).expect("a copy");
        }
    }
}

/// That a folder is as it was.
#[track_caller]
pub fn unchanged(dir: &Path, before: &[(String, Vec<u8>)], what: &str) {
    let after = contents(dir);
    let names = |all: &[(String, Vec<u8>)]| all.iter().map(|f| f.0.clone()).collect::<Vec<_>>();
    assert_eq!(names(&after), names(before), "{what}");
    for (a, b) in after.iter().zip(before) {
        assert!(a.1 == b.1, "{what}: {} has changed", a.0);
    }
}
