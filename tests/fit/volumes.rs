//! Pressures over volumes that a syringe lets in, and fits that are ended early.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

use slcbeam::results;
use slcbeam::results::fit::Fit;
use slcbeam::study::data::DataTable;
use slcbeam::study::evaluations::JournalEvaluation;
use slcbeam::study::fit::abscissa::DrivenNumber;
use slcbeam::study::fit::fit;
use slcbeam::study::fit::problem::{FitProblem, FitRequest};

use crate::common::*;

const ACTUATOR: &str = "cases/tour-actuator.json";
const COMPLIANCE: &str = "/bladders/area_per_pressure_m2_per_pa";
const SYRINGE: [&str; 2] = [
    "/network/chains/0/ends/0={\"volume_m3\": 1e-6}",
    "/start/equilibrium={}",
];
const COARSE: [&str; 2] = ["/mesh/cells_per_segment=1", "/mesh/cells_per_bladder=1"];

/// Source: `cases/actuator-pv.csv`, whose head names the command that made it. Goal: the coefficient that the data were made with lies within its
/// interval of 95 %, which is a per cent wide; the page and the fitted case are there.
#[test]
fn a_coefficient_from_pressures_over_volumes() {
    let dir = tempfile::tempdir().expect("a folder");
    let out = path(&dir, "fitted");
    let (vary, drive) = (
        format!("{COMPLIANCE}=5e-11:1e-9"),
        "volume_ml=/network/chains/0/ends/0/volume_m3",
    );
    let mut asked = vec![
        "fit",
        ACTUATOR,
        "cases/actuator-pv.csv",
        "--vary",
        &vary,
        "--drive",
        drive,
    ];
    asked.extend([
        "--match",
        "p_kpa=pressure@bladder -1",
        "--noise",
        "p_kpa=0.1",
        "--out",
        &out,
    ]);
    SYRINGE
        .iter()
        .chain(&COARSE)
        .for_each(|set| asked.extend(["--set", set]));
    let found = json(&asked);
    let [low, high] = [0, 1].map(|k| number(&found["parameters"][0]["interval_95"][k]));
    assert!(low < 2.2e-10 && 2.2e-10 < high && high < 1.01 * low, "{found:#}");
    assert!(found["unseen"].as_array().is_some_and(Vec::is_empty) && found.get("interrupted").is_none());
}

fn syringe() -> (FitProblem, FitRequest) {
    let case = load(ACTUATOR, &[&SYRINGE[..], &COARSE].concat());
    let asked = FitRequest {
        drives: vec![DrivenNumber::parse("volume_ml=/network/chains/0/ends/0/volume_m3").expect("a drive")],
        starts: 2,
        ..by_squares(&[(COMPLIANCE, 5e-11, 1e-9)], &["p_kpa=pressure@bladder -1"])
    };
    let table = DataTable::read(Path::new("cases/actuator-pv.csv")).expect("a table");
    let problem = FitProblem::new(&case, &table, &asked).expect("a problem");
    (problem, asked)
}

/// Goal: a fit that is ended early tells the best so far, with its errors, and says that it is that; one that is ended before anything was
/// simulated has nothing to tell.
#[test]
fn a_fit_that_is_ended_keeps_the_best_so_far() {
    let (problem, asked) = syringe();
    let count = AtomicUsize::new(0);
    let after = |most: usize| {
        count.store(0, Relaxed);
        let stop = || count.load(Relaxed) >= most;
        fit(&problem, &asked, ("data.csv", 0), &stop, &|_, _| {
            count.fetch_add(1, Relaxed);
        })
    };
    let early = after(3).expect("a best").fit;
    assert!(
        early.interrupted && !early.found && early.warnings[0].contains("interrupted"),
        "{early:?}"
    );
    assert!(early.parameters[0].standard_error.is_some());
    assert_eq!(early.starts.len(), 1);
    let whole = after(usize::MAX).expect("a fit").fit;
    assert!(!whole.interrupted && whole.found && early.columns[0].left.rms >= whole.columns[0].left.rms);
    let nothing = after(0).expect_err("nothing").to_string();
    assert!(nothing.contains("No results are written"), "{nothing}");
}

/// Goal: a fit that is interrupted after its search, while the finer mesh is simulated, says so in its result and has the minimum.
#[test]
fn a_fit_that_is_ended_after_its_search_says_so() {
    let (problem, asked) = syringe();
    let finer = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&finer);
    let write = move |row: &JournalEvaluation| {
        seen.fetch_or(row.key.starts_with("finer"), Relaxed);
        Ok(())
    };
    problem.evaluations.begin([], Box::new(write));
    let found = fit(&problem, &asked, ("data.csv", 0), &|| finer.load(Relaxed), &|_, _| {}).expect("a fit");
    let fit = found.fit;
    assert!(
        fit.interrupted && fit.found && fit.parameters[0].finer_change.is_some(),
        "{fit:?}"
    );
    let told = fit.warnings.last().expect("a warning");
    assert!(told.contains("interrupted after the search"), "{told}");
}

/// Goal: Ctrl-C ends the program with 130, and what it leaves is a fit that says it was interrupted, or nothing where nothing was simulated.
#[test]
fn an_interrupted_fit_ends_in_order() {
    let dir = tempfile::tempdir().expect("a folder");
    let data = file(&dir, "data.csv", "volume_ml,p_kpa\n1,10.3\n2,20.2\n3,30.1\n");
    let out = path(&dir, "fitted");
    let vary = format!("{COMPLIANCE}=5e-11:1e-9");
    let mut asked = vec![
        "fit", ACTUATOR, &data, "--vary", &vary, "--starts", "10000", "--jobs", "1",
    ];
    asked.extend([
        "--drive",
        "volume_ml=/network/chains/0/ends/0/volume_m3",
        "--quiet",
        "--out",
        &out,
    ]);
    asked.extend(["--match", "p_kpa=pressure@bladder -1"]);
    SYRINGE
        .iter()
        .chain(&COARSE)
        .for_each(|set| asked.extend(["--set", set]));
    let mut running = crate::program::command(&asked)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("a program");
    let begin = Instant::now();
    while !dir.path().join("fitted").exists() && begin.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(300));
    let pid = running.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &pid])
            .status()
            .expect("a signal")
            .success()
    );
    let ended = running.wait().expect("an end");
    assert_eq!(ended.code(), Some(130));
    if let Ok(text) = std::fs::read_to_string(dir.path().join("fitted/fit.json")) {
        assert!(results::read::<Fit>(&text).expect("a fit").result.interrupted);
    }
}
