//! Runs that are interrupted: killed, asked to stop, out of wall time, out of disk, or stuck.
//!
//! Goal: everything computed so far is on disk, and a resumed run repeats the uninterrupted one bit for bit. Nothing
//! here has a tolerance: files are equal or they are not.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use slcbeam::case;
use slcbeam::discrete::System;
use slcbeam::run::checkpoint::Checkpoint;
use slcbeam::run::dynamics;
use slcbeam::run::record::{Control, Header, Memory, Progress, Recorder};
use slcbeam::run::summary::Status;

const CASE: &str = "cases/wiring-2.json";
const SETS: [&str; 5] = [
    "/time/checkpoint_interval_s=0.03",
    "/time/end_s=0.15",
    "/solver/rtol=1e-5",
    "/mesh/cells_per_segment=2",
    "/mesh/cells_per_bladder=1",
];

pub(super) fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_slcbeam"));
    command
        .arg("run")
        .arg(CASE)
        .arg("--quiet")
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    for set in SETS {
        command.arg("--set").arg(set);
    }
    command
}

pub(super) fn summary(dir: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(dir.join("summary.json")).unwrap()).unwrap()
}

fn without_wall(mut summary: serde_json::Value) -> serde_json::Value {
    summary.as_object_mut().unwrap().remove("wall_s");
    let companion = summary.get_mut("companion").and_then(|of| of.as_object_mut());
    companion.map(|of| of.remove("wall_s"));
    summary
}

#[test]
fn resumed_run_repeats_the_uninterrupted_one_in_memory() {
    let sets: Vec<String> = SETS.iter().map(|s| s.to_string()).collect();
    let case = case::load(Path::new(CASE), &sets).unwrap();
    let mut whole = Memory::default();
    let whole_outcome = dynamics::run(&case, &mut whole).unwrap();
    assert_eq!(whole.checkpoints.len(), 4);
    for checkpoint in &whole.checkpoints {
        let mut rest = Memory::default();
        let outcome = dynamics::resume(&case, System::new(&case).unwrap(), checkpoint, &mut rest).unwrap();
        let from = checkpoint.next_output as usize;
        assert_eq!(whole.rows[from..], rest.rows[..], "from t = {}", checkpoint.t);
        assert_eq!(whole_outcome.summary.balances, outcome.summary.balances);
        assert_eq!(whole_outcome.summary.solver, outcome.summary.solver);
    }
}

/// Keeps everything, and asks to stop behind a time [s].
struct Until(f64, Memory);

impl Recorder for Until {
    fn begin(&mut self, header: &Header) -> slcbeam::error::Result<()> {
        self.1.begin(header)
    }
    fn history(&mut self, row: &[f64]) -> slcbeam::error::Result<()> {
        self.1.history(row)
    }
    fn fields(&mut self, t: f64, arrays: &[&[f64]]) -> slcbeam::error::Result<()> {
        self.1.fields(t, arrays)
    }
    fn progress(&mut self, progress: &Progress) -> slcbeam::error::Result<Control> {
        Ok(match progress.t > self.0 {
            true => Control::Stop("enough".into()),
            false => Control::Continue,
        })
    }
    fn checkpoint(&mut self, checkpoint: &Checkpoint) -> slcbeam::error::Result<()> {
        self.1.checkpoint(checkpoint)
    }
}

/// Goal: a run that is stopped between two outputs records the state there, so that what is told of its end is that of the stop and not of the start;
/// one that goes on from its checkpoint repeats the whole. Before, the only row was that of t = 0: nothing had moved, no energy was put in.
#[test]
fn a_run_that_is_stopped_records_where_it_stands() {
    let more = ["/time/output_interval_s=0.15", "/time/fields_interval_s=0.15"];
    let sets: Vec<String> = SETS.iter().chain(&more).map(|s| s.to_string()).collect();
    let case = case::load(Path::new(CASE), &sets).unwrap();
    let system = || System::new(&case).unwrap();
    let mut whole = Memory::default();
    let all = dynamics::run(&case, &mut whole).unwrap().summary;
    assert_eq!(whole.rows.len(), 2);
    let mut stopped = Until(0.07, Memory::default());
    let told = dynamics::run(&case, &mut stopped).unwrap().summary;
    let Until(_, stopped) = stopped;
    assert_eq!((told.status, stopped.rows.len()), (Status::Stopped, 2));
    assert_eq!(stopped.rows[0], whole.rows[0]);
    assert_eq!((stopped.rows[1][0], stopped.field_times[1]), (told.time_s, told.time_s));
    assert!(told.time_s > 0.07 && told.time_s < 0.15);
    assert!(told.quantities["tip_u1_m"].last.unwrap().abs() > 0.0);
    let checkpoint = stopped.checkpoints.last().unwrap();
    let mut rest = Memory::default();
    let resumed = dynamics::resume(&case, system(), checkpoint, &mut rest)
        .unwrap()
        .summary;
    assert_eq!(rest.rows[..], whole.rows[1..]);
    assert_eq!((resumed.quantities, resumed.balances), (all.quantities, all.balances));
}

/// A window that begins between two outputs, before one checkpoint and after another, and steps that a steep step in time makes short.
#[test]
fn resumed_run_knows_where_its_window_begins() {
    let steep = r#"/loads=[{"force_x_n_m": {"signal": {"sigmoid": {"amplitude": 1, "steepness_per_s": 1e5, "midpoint_s": 0.1}}}}]"#;
    let more = [
        "/time/window_s=0.0437",
        "/time/output_interval_s=0.01",
        "/time/fields_interval_s=0.01",
        steep,
    ];
    let sets: Vec<String> = SETS.iter().chain(&more).map(|s| s.to_string()).collect();
    let case = case::load(Path::new(CASE), &sets).unwrap();
    let mut whole = Memory::default();
    let quantities = dynamics::run(&case, &mut whole).unwrap().summary.quantities;
    assert!(whole.checkpoints.iter().any(|c| c.t > 0.15 - 0.0437));
    for checkpoint in &whole.checkpoints {
        let outcome = dynamics::resume(&case, System::new(&case).unwrap(), checkpoint, &mut Memory::default()).unwrap();
        assert_eq!(quantities, outcome.summary.quantities, "from t = {}", checkpoint.t);
    }
}

#[test]
fn checkpoint_of_another_case_is_refused() {
    let sets: Vec<String> = SETS.iter().map(|s| s.to_string()).collect();
    let case = case::load(Path::new(CASE), &sets).unwrap();
    let mut recorded = Memory::default();
    dynamics::run(&case, &mut recorded).unwrap();
    let mut other = case.clone();
    other.beam.young_modulus_pa *= 1.01;
    let refused = dynamics::resume(
        &other,
        System::new(&other).unwrap(),
        &recorded.checkpoints[0],
        &mut Memory::default(),
    );
    assert_eq!(refused.unwrap_err().exit_code(), 2);
}

#[test]
fn killed_run_loses_at_most_one_interval_and_resumes_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, killed) = (folder.path().join("whole"), folder.path().join("killed"));
    assert!(program().arg("--out").arg(&whole).status().unwrap().success());
    let mut child = program().arg("--out").arg(&killed).spawn().unwrap();
    let deadline = Instant::now() + Duration::from_secs(60);
    while !killed.join("checkpoint.json").exists() && child.try_wait().unwrap().is_none() {
        assert!(Instant::now() < deadline, "no checkpoint within a minute");
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    if !killed.join("checkpoint.json").exists() {
        // The machine was faster than the kill: the run is whole and there is nothing to resume.
        assert_eq!(summary(&killed)["status"], "finished");
        return;
    }
    assert!(
        program()
            .arg("--resume")
            .arg("--out")
            .arg(&killed)
            .status()
            .unwrap()
            .success()
    );
    for name in ["history.csv", "fields.npz", "case.json"] {
        assert_eq!(
            fs::read(whole.join(name)).unwrap(),
            fs::read(killed.join(name)).unwrap(),
            "{name} differs"
        );
    }
    assert_eq!(without_wall(summary(&whole)), without_wall(summary(&killed)));
    assert!(
        !killed.join("checkpoint.json").exists(),
        "a finished run leaves no checkpoint"
    );
}

#[test]
fn resume_without_checkpoint_is_a_usage_error() {
    let folder = tempfile::tempdir().unwrap();
    let status = program()
        .arg("--resume")
        .arg("--out")
        .arg(folder.path().join("none"))
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(2));
}

#[test]
fn wall_time_limit_stops_with_everything_written_and_can_be_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("limited");
    let long = [
        ["--set", "/time/end_s=200"],
        ["--set", "/time/checkpoint_interval_s=0.05"],
        ["--set", "/time/output_interval_s=0.01"],
        ["--set", "/time/fields_interval_s=0.01"],
    ]
    .concat();
    let status = program()
        .args(&long)
        .args(["--max-wall", "1"])
        .arg("--out")
        .arg(&out)
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(0));
    let first = summary(&out);
    assert_eq!(first["status"], "stopped");
    assert!(first["reason"].as_str().unwrap().contains("wall time"));
    assert!(out.join("fields.npz").exists() && out.join("checkpoint.json").exists());
    let status = program()
        .args(&long)
        .args(["--max-wall", "1", "--resume"])
        .arg("--out")
        .arg(&out)
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(0));
    assert!(
        summary(&out)["time_s"].as_f64() > first["time_s"].as_f64(),
        "the second second went on from the first"
    );
}

/// Goal: on a terminal the bar is gone when the box is drawn: nothing but what clears a line stands between the last bar and the box, and none
/// comes after. `script` (util-linux, part of every Debian) plays the terminal.
#[cfg(unix)]
#[test]
fn the_bar_is_gone_before_the_box() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("screen");
    let command = format!(
        "{} run cases/two-bladders.json --set /time/end_s=0.2 --set /solver/rtol=1e-7 --out {}",
        env!("CARGO_BIN_EXE_slcbeam"),
        folder.path().join("run").display()
    );
    let Ok(played) = Command::new("script")
        .arg("-qec")
        .arg(&command)
        .arg(&log)
        .stdout(Stdio::null())
        .status()
    else {
        println!("no program script: nothing is seen");
        return;
    };
    assert!(played.success());
    let screen = fs::read_to_string(&log).unwrap();
    let (bars, told) = screen.split_once('╭').expect("a box");
    assert!(!told.contains("steps, now"), "a bar below the box: {told:?}");
    let last = bars.rsplit(['\r', '\n']).find(|part| !part.is_empty());
    assert!(
        last.is_none_or(|last| !last.contains('%') || last.ends_with("\u{1b}[2K")),
        "the bar stands above the box: {last:?}"
    );
}

/// A full disk: `/dev/full` cannot be a folder, so a limit on the size of files plays its part [KiB].
#[cfg(unix)]
fn on_a_disk_of(size: u32, sets: &str, out: &Path) -> String {
    let script = format!(
        "trap '' XFSZ; ulimit -f {size}; exec {} run {CASE} --quiet {sets} --out {}",
        env!("CARGO_BIN_EXE_slcbeam"),
        out.display()
    );
    let output = Command::new("bash").args(["-c", &script]).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(5), "{told}");
    told
}

#[cfg(unix)]
#[test]
fn full_disk_is_an_output_error_and_what_was_written_stays() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("full");
    let sets = "--set /time/end_s=5 --set /mesh/cells_per_segment=2";
    assert!(on_a_disk_of(200, sets, &out).contains("cannot write"));
    assert!(fs::metadata(out.join("history.csv")).unwrap().len() > 1000);
}

/// Goal: one sentence, where the disk is full while fields are packed, too, and one that says what is wrong with a link to nothing.
#[cfg(unix)]
#[test]
fn a_disk_that_is_full_while_fields_are_packed_is_told_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    // no field alone is as large as this, all of them are
    let told = on_a_disk_of(900, "--set /time/fields_interval_s=5e-4", &folder.path().join("full"));
    assert!(told.contains("fields.npz") && !told.contains("ZipWriter"), "{told}");

    let link = folder.path().join("link");
    std::os::unix::fs::symlink(folder.path().join("nothing"), &link).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_slcbeam"))
        .args(["run", CASE, "--out"])
        .arg(&link)
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.code() == Some(5) && told.contains("a symbolic link whose target does not exist"),
        "{told}"
    );
}

#[test]
fn too_many_steps_end_the_run_with_a_diagnosis() {
    let sets: Vec<String> = SETS
        .iter()
        .map(|s| s.to_string())
        .chain(["/solver/max_steps=500".to_string()])
        .collect();
    let case = case::load(Path::new(CASE), &sets).unwrap();
    let mut recorded = Memory::default();
    let outcome = dynamics::run(&case, &mut recorded).unwrap();
    let fault = outcome.fault.expect("the run cannot finish in 500 steps");
    assert!(fault.at.time_s().is_some_and(|t| t > 0.0) && fault.cause.is_some() && fault.hint.is_some());
    assert!(!recorded.rows.is_empty());
}
