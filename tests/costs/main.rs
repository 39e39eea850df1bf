//! What a run costs beside its steps.
//!
//! Source: the program from outside, clocks around it. Goal: every moment of a run is told of once, and what is not asked for costs nothing.

mod allocations;
#[path = "../common/chance.rs"]
mod chance;
mod responses;

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use serde_json::Value;
use slcbeam::case::{self, Case};
use slcbeam::discrete::System;
use slcbeam::output::kind::FolderKind;
use slcbeam::output::{FolderRecorder, Labels, ResultFolder, checkpoint, summary};
use slcbeam::run::dynamics;
use slcbeam::run::observe::Observer;
use slcbeam::run::record::{Control, Memory, Progress};
use tempfile::TempDir;

const CASE: &str = "cases/two-bladders.json";

/// Runs the program; wall time from outside [s].
fn run(folder: &Path, more: &[&str]) -> f64 {
    let began = Instant::now();
    let output = Command::new(env!("CARGO_BIN_EXE_slcbeam"))
        .args(["run", CASE, "--quiet", "--out"])
        .arg(folder)
        .args(more)
        .output()
        .expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    began.elapsed().as_secs_f64()
}

fn wall(folder: &Path) -> Vec<(String, f64)> {
    let text = fs::read_to_string(folder.join("summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&text).expect("JSON");
    let wall = summary["wall_s"].as_object().expect("wall times");
    let times = wall.iter().map(|(key, s)| (key.clone(), s.as_f64().expect("a number")));
    times.collect()
}

/// Goal: parts add up to the total, none is below zero, and the total is no more than what a clock outside tells; with and without
/// earlier runs, checkpoints and what goes on from them.
#[test]
fn parts_of_the_wall_time_add_up_to_all_of_it() {
    let short = ["--set", "/time/end_s=0.001"];
    let checkpoints = [
        "--set",
        "/time/end_s=0.001",
        "--set",
        "/time/checkpoint_interval_s=0.0004",
    ];
    let chosen = ["--set", "/time/end_s=0.0003", "--accuracy", "0.2"];
    for (more, pilots) in [(&short[..], false), (&checkpoints, false), (&chosen, true)] {
        let dir = TempDir::new().expect("a folder");
        let folder = dir.path().join("result");
        let outside = run(&folder, more);
        let all = wall(&folder);
        let of = |key: &str| all.iter().find(|(name, _)| name == key).expect("a part").1;
        let parts: f64 = all.iter().filter(|(name, _)| name != "total").map(|(_, s)| s).sum();
        // fifteen numbers are added in another order
        assert!((parts / of("total") - 1.0).abs() < 1e-12, "{all:?}");
        // what is left is a difference of sums
        assert!(all.iter().all(|(_, s)| *s >= -1e-9), "{all:?}");
        assert!(of("total") <= outside, "{all:?}, {outside} s outside");
        for key in [
            "start_up",
            "set_up",
            "consistent_start",
            "residual",
            "jacobian",
            "linear_solver",
            "steps",
        ] {
            assert!(of(key) > 0.0, "{key} of {all:?}");
        }
        for key in ["watching", "output", "pictures", "report", "files"] {
            assert!(of(key) > 0.0, "{key} of {all:?}");
        }
        assert_eq!(of("pilots") > 0.0, pilots, "{all:?}");
    }
}

/// Goal: the page does not change when it is made again, though the summary has been written once more since.
#[test]
fn the_page_of_a_run_is_that_of_its_folder() {
    let dir = TempDir::new().expect("a folder");
    let folder = dir.path().join("result");
    run(&folder, &["--set", "/time/end_s=0.001"]);
    let page = fs::read(folder.join("report.html")).expect("a page");
    let again = Command::new(env!("CARGO_BIN_EXE_slcbeam"))
        .arg("report")
        .arg(&folder)
        .output()
        .expect("it runs");
    assert!(again.status.success());
    assert!(page == fs::read(folder.join("report.html")).expect("a page"));
}

/// Goal: of a summary of format 1, whose parts did not add up, the rest is that of the steps.
#[test]
fn the_rest_of_an_older_total_is_that_of_the_steps() {
    let dir = TempDir::new().expect("a folder");
    run(dir.path(), &["--set", "/time/end_s=0.0002"]);
    let path = dir.path().join("summary.json");
    let mut older: Value = serde_json::from_str(&fs::read_to_string(&path).expect("a summary")).expect("JSON");
    older["format"] = 1.into();
    older["wall_s"] =
        serde_json::json!({"total": 8.0, "residual": 2.0, "jacobian": 1.0, "linear_solver": 3.0, "output": 0.5});
    fs::write(&path, older.to_string()).expect("written");
    let wall = summary::read(dir.path()).expect("read").wall_s;
    assert_eq!(
        (wall.total, wall.steps, wall.known(), wall.set_up),
        (8.0, 1.5, 8.0, 0.0)
    );
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut all: Vec<String> = entries
        .map(|entry| entry.expect("a file").file_name().into_string().expect("a name"))
        .collect();
    all.sort();
    all
}

const LEAN: [&str; 4] = [".slcbeam.case", "case.json", "fields.npz", "summary.json"];

/// What the summary tells but wall times.
fn told(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("summary.json")).expect("a summary");
    let mut summary: Value = serde_json::from_str(&text).expect("JSON");
    // wall times differ, what is not written has no checksum, and lean runs have no error bars
    for key in ["wall_s", "tables_crc32", "errors", "companion"] {
        summary.as_object_mut().expect("an object").remove(key);
    }
    let warnings = summary["warnings"].as_array_mut().expect("warnings");
    warnings.retain(|warning| !warning.as_str().is_some_and(|text| text.starts_with("W021")));
    summary
}

/// Goal: a lean run leaves summary, case and arrays alone, those of a full run, in an empty folder and in one with a full result, and
/// takes no time for what it leaves out; the page can be made afterwards.
#[test]
fn a_lean_run_leaves_summary_and_arrays_alone() {
    let dir = TempDir::new().expect("a folder");
    let [full, lean] = ["full", "lean"].map(|name| dir.path().join(name));
    let short = ["--set", "/time/end_s=0.001"];
    run(&full, &short);
    run(&lean, &[&short[..], &["--lean"]].concat());
    assert_eq!(names(&lean), LEAN);
    assert!(names(&full).contains(&"history.csv".into()) && names(&full).contains(&"report.html".into()));
    for name in ["fields.npz", "case.json"] {
        let [a, b] = [&full, &lean].map(|folder| fs::read(folder.join(name)).expect("a file"));
        assert!(a == b, "{name}");
    }
    assert_eq!(told(&full), told(&lean));
    let taken = wall(&lean)
        .into_iter()
        .filter(|(key, _)| key == "pictures" || key == "report");
    // reading the clock takes what it takes
    assert!(taken.into_iter().all(|(_, s)| s < 1e-3));
    run(&full, &[&short[..], &["--lean"]].concat());
    assert_eq!(names(&full), LEAN);
    run(&full, &[&short[..], &["--lean", "--accuracy", "0.2"]].concat());
    assert_eq!(names(&full), LEAN);
    let page = Command::new(env!("CARGO_BIN_EXE_slcbeam"))
        .arg("report")
        .arg(&lean)
        .status();
    assert!(page.expect("it runs").success());
}

/// Records a case into a folder until a time [s], from its checkpoint where there is one.
fn record(folder: &Path, case: &Case, lean: bool, until: f64) {
    let labels = Labels {
        case_name: case.name.clone(),
        case: case.written(),
        frequency_hz: None,
        bladders: Default::default(),
    };
    let hook = Box::new(move |progress: &Progress| match progress.t > until {
        true => Control::Stop("enough".into()),
        false => Control::Continue,
    });
    let system = System::new(case).expect("a system");
    let outcome = if folder.join("checkpoint.json").exists() {
        let (saved, _) = checkpoint::read(folder).expect("read").expect("a checkpoint");
        let header = Observer::header(case, &system);
        let folder = ResultFolder::again(folder).expect("a run");
        let recorder = FolderRecorder::resume(folder, labels, hook, &saved, &header).expect("whole");
        let mut recorder = recorder.lean(lean);
        let outcome = dynamics::resume(case, system, &saved.run, &mut recorder).expect("a run");
        (recorder, outcome)
    } else {
        let folder = ResultFolder::claim(folder, FolderKind::Run, false).expect("claimed");
        let mut recorder = FolderRecorder::new(folder, labels, hook).lean(lean);
        let outcome = dynamics::run_with(case, system, &[], &mut recorder).expect("a run");
        (recorder, outcome)
    };
    let (recorder, outcome) = outcome;
    let finished = recorder.finish(&outcome.summary).expect("finished");
    finished.close().expect("closed");
}

/// Goal: a lean run that is stopped keeps what it goes on from; gone on with, lean or not, it gives the files of the run that was not
/// stopped, and a full one gone on with as a lean one leaves none of its pictures.
#[test]
fn a_lean_run_goes_on() {
    let sets = ["/time/end_s=0.004", "/time/checkpoint_interval_s=0.001"].map(String::from);
    let case = case::load(CASE.as_ref(), &sets).expect("a case");
    let dir = TempDir::new().expect("a folder");
    let whole = dir.path().join("whole");
    record(&whole, &case, false, f64::INFINITY);
    for (first, then) in [(true, true), (true, false), (false, true)] {
        let folder = dir.path().join(format!("{first}-{then}"));
        record(&folder, &case, first, 0.0025);
        let there = names(&folder);
        for name in ["checkpoint.json", "fields.part", "history.csv", "summary.json"] {
            assert!(there.contains(&name.into()), "{there:?}");
        }
        assert_eq!(there.contains(&"history.svg".into()), !first);
        record(&folder, &case, then, f64::INFINITY);
        let names = if then {
            // what writes them here is no program, which alone says of which file a result is
            LEAN[1..].iter().map(|name| (*name).to_owned()).collect()
        } else {
            names(&whole)
        };
        assert_eq!(self::names(&folder), names);
        for name in names.iter().filter(|name| *name != "summary.json") {
            let [a, b] = [&whole, &folder].map(|folder| fs::read(folder.join(name)).expect("a file"));
            assert!(a == b, "{name}");
        }
        assert_eq!(told(&whole), told(&folder));
    }
}

/// A beam of many bladders like those of the paper with these chains.
fn many(per_row: usize, chains: &Value, mesh: [usize; 2]) -> Case {
    let text = serde_json::json!({
        "name": "many", "preset": "matia-gat-beam", "plausibility": "off",
        "beam": {"length_m": 0.008 * per_row as f64}, "bladders": {"per_row": per_row}, "network": {"chains": chains},
        "effects": {"tube_inertia": "off", "tube_losses": "off"},
        "mesh": {"cells_per_segment": mesh[0], "cells_per_bladder": mesh[1]}, "time": {"end_s": 2e-5, "output_interval_s": 1e-5},
        "ends": {"root": {"clamped": {"u3_m": {"sine": {"amplitude": 1e-4, "frequency_hz": 20, "ramp_cycles": 1}}}}, "tip": "free"}
    });
    case::parse(&text.to_string(), Path::new("many.json"), Path::new("."), &[]).expect("a case")
}

/// Each upper bladder with a port of its own, each lower one sealed by itself.
fn apart(per_row: usize) -> Value {
    let chain = |k: usize| serde_json::json!({"bladders": [k], "ends": ["sealed", {"pressure_pa": 0}]});
    (1..=per_row).map(chain).collect()
}

/// Goal: what a short run sets up grows with the beam alone, not with its square. Memory asked for counts, as times would not be the same twice.
#[test]
fn set_up_grows_with_the_beam_alone() {
    let asked = |per_row: usize| {
        let case = many(per_row, &apart(per_row), [1, 2]);
        let measured = allocation_counter::measure(|| {
            dynamics::run(&case, &mut Memory::default()).expect("a run");
        });
        measured.bytes_total as f64
    };
    // tables that are made once
    asked(10);
    let ratio = asked(1000) / asked(500);
    assert!((1.8..2.2).contains(&ratio), "{ratio}");
}

/// Goal: a beam of 200 000 bladders, 4 million unknowns, runs within 20 GiB. Its times are printed, and judge nothing.
#[test]
#[ignore = "takes minutes and 10 GiB"]
fn two_hundred_thousand_bladders_run() {
    const ROW: i64 = 100_000;
    let rows = [(1..=ROW).collect::<Vec<_>>(), (-ROW..=-1).rev().collect()];
    let chains = rows.map(|row| serde_json::json!({"bladders": row, "ends": ["sealed", {"pressure_pa": 0}]}));
    let case = many(ROW as usize, &chains.into_iter().collect(), [8, 3]);
    let outcome = dynamics::run(&case, &mut Memory::default()).expect("a run");
    let summary = &outcome.summary;
    println!("{} unknowns, {:?}", summary.unknowns, summary.wall_s);
    assert!(summary.unknowns >= 4_000_000, "{}", summary.unknowns);
    let status = fs::read_to_string("/proc/self/status").expect("of this process");
    let most = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .expect("its memory");
    let kib: u64 = most.trim().trim_end_matches(" kB").parse().expect("a number");
    println!("{kib} KiB at most");
    assert!(kib < 20 << 20, "{kib} KiB");
}
