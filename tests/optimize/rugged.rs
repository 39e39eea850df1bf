//! Figures with many hollows, and modes that change places on the way to the best.

use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use serde_json::Value;
use slcbeam::case;
use slcbeam::study::analysis::AnalysisKind;
use slcbeam::study::optimize::problem::{Goal, OptimizationProblem, OptimizationRequest};
use slcbeam::study::optimize::wiring::Alternative;
use slcbeam::study::optimize::{Candidate, optimise};
use slcbeam::study::search_bounds::ParameterBounds;

use crate::common::*;

const CANTILEVER: &str = "cases/dry-cantilever.json";
const AT: &str = "/attachments/0/at";

/// The fourth frequency of a cantilever with a mass, by where this is: a hollow at each place that swings far, and a kink at each node of the mesh.
fn lowered(from: &str, more: &[&str]) -> (Value, String) {
    let dir = tempfile::tempdir().expect("a folder");
    let mass = format!("/attachments=[{{\"at\": {from}, \"mass_kg\": 0.02}}]");
    let vary = format!("{AT}=0.1:1");
    let asked = [
        CANTILEVER,
        "--command",
        "modes",
        "--minimize",
        "mode_4",
        "--vary",
        &vary,
        "--set",
        &mass,
    ];
    let coarse = ["--set", "/mesh/cells_per_segment=1"];
    let found = best(&dir, &[&asked[..], &coarse, more].concat());
    let designs = fs::read_to_string(path(&dir, "out/designs.csv")).expect("a table");
    // all but the wall time
    let rows = designs.lines().map(|line| line.rsplit_once(',').expect("columns").0);
    (found, rows.collect::<Vec<_>>().join("\n"))
}

/// Source: the frequencies of 91 places from 0.1 to 1 (`slcbeam sweep`), least at 0.3. Goal: from 0.7, a hollow of its own, slopes lead to a
/// worse place, and four starts to the best, the same on one thread and on two.
#[test]
fn hollows_are_passed_over() {
    let (slopes, _) = lowered("0.7", &[]);
    let (found, designs) = lowered("0.7", &["--starts", "4", "--jobs", "2"]);
    let [worse, value] = [&slopes, &found].map(|one| number(&one["value"]));
    assert!(value < 0.97 * worse, "{value} and {worse}");
    assert!((number(&found["variables"][0]["value"]) - 0.3).abs() < 2e-3, "{found}");
    assert_eq!(designs.lines().count() as f64, 1.0 + number(&found["evaluations"]));
    let (again, alone) = lowered("0.7", &["--starts", "4", "--jobs", "1"]);
    assert_eq!(found["value"], again["value"]);
    assert_eq!(designs.lines().count(), alone.lines().count());
    // where slopes and figure contradict each other, other starts are offered
    let (kink, _) = lowered("0.4", &[]);
    assert!(kink["warnings"].to_string().contains("--starts"), "{kink}");
}

/// Goal: a search that is interrupted has the best so far.
#[test]
fn an_interrupted_search_has_the_best_so_far() {
    let asked = OptimizationRequest {
        what: AnalysisKind::Modes,
        spans: vec![ParameterBounds {
            pointer: AT.into(),
            low: 0.1,
            high: 1.0,
        }],
        goal: Goal {
            figure: "mode_4".into(),
            largest: false,
        },
        limits: vec![],
        starts: 1,
        jobs: 1,
    };
    let sets = [
        "/attachments=[{\"at\": 0.7, \"mass_kg\": 0.02}]",
        "/mesh/cells_per_segment=1",
    ];
    let case = case::load(CANTILEVER.as_ref(), &sets.map(String::from)).expect("a case");
    let candidate = Candidate {
        alternative: Alternative::default(),
        problem: OptimizationProblem::new(&case, &asked).expect("a problem"),
    };
    let count = AtomicUsize::new(0);
    let early = optimise(&[candidate], &asked, &|| count.load(Relaxed) >= 3, &|_, _| {
        count.fetch_add(1, Relaxed);
    });
    let early = early.expect("a best");
    let begin = early.history[0].figures.as_ref().expect("figures")[0];
    assert!(early.optimum.value <= begin && early.optimum.begin == Some(begin));
    assert!(early.optimum.warnings[0].contains("interrupted") && !early.optimum.found);
    assert_eq!(early.optimum.ended.as_deref(), Some("it was interrupted"));
}

/// Source: a higher beam bends faster and stretches as fast as before, so that its second bending mode passes the first of stretch. Goal: that
/// `mode_2` is that of stretch at the best is told by the shapes, and not where it stays the same one.
#[test]
fn a_mode_that_is_another_at_the_best_is_told() {
    let dir = tempfile::tempdir().expect("a folder");
    let told = |high: &str| {
        let vary = format!("/beam/height_m=0.015:{high}");
        let asked = [
            CANTILEVER,
            "--command",
            "modes",
            "--maximize",
            "mode_2",
            "--vary",
            &vary,
        ];
        let sets = ["--set", "/beam/height_m=0.016", "--set", "/mesh/cells_per_segment=1"];
        best(&dir, &[&asked[..], &sets].concat())["warnings"].to_string()
    };
    let crossed = told("0.06");
    assert!(
        crossed.contains("W034 mode_2 at the optimum is another mode") && crossed.contains("is mode_3 there"),
        "{crossed}"
    );
    assert!(!told("0.02").contains("W034"));
}
