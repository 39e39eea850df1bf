//! What is chosen from a set.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use serde_json::Value;
use slcbeam::case;
use slcbeam::numerics::chance::Chance;
use slcbeam::output::optimum;
use slcbeam::study::optimize::choice::{Choice, Part};
use slcbeam::study::optimize::explore;
use slcbeam::study::optimize::problem::{Asked, Goal, Method, Problem};
use slcbeam::study::optimize::wiring::{Alternative, Crossing, choices, combinations};
use slcbeam::study::sweep::What;

use crate::common::*;

fn harvester(load: &str, more: &[&str]) -> Value {
    let dir = tempfile::tempdir().expect("a folder");
    let case = format!("cases/harvester-parallel-{load}.json");
    let set = |text: &'static str| ["--set", text];
    let sets = [
        set("/bladders/coupling=\"reciprocal\""),
        set("/formulation=\"conservative\""),
        set("/mesh/cells_per_segment=1"),
        set("/mesh/cells_per_bladder=1"),
        set("/beam/damping={\"bending_time_s\": 2e-3, \"axial_time_s\": 2e-3}"),
    ]
    .concat();
    let asked = [&case, "--maximize", "harvested_power_w", "--command", "periodic"];
    best(&dir, &[&asked[..], &sets, more].concat())
}

fn chosen(found: &Value) -> String {
    let k = number(&found["chosen"]) as usize;
    found["alternatives"][k]["name"].as_str().expect("a name").into()
}

/// Source: Matia & Gat, Fig. 6. Goal: the wiring of most power is the parallel one under the uniform load, the crossover under the wave.
#[test]
#[ignore = "a minute"]
fn loads_choose_their_wirings() {
    let [uniform, wave] = ["uniform", "wave"].map(|load| harvester(load, &["--crossovers", "1"]));
    assert_eq!(uniform["alternatives"].as_array().map(Vec::len), Some(10));
    assert_eq!(chosen(&uniform), "parallel");
    assert_eq!(chosen(&wave), "crossover after 3");
}

/// The same between the paper's two, its wave alone.
#[test]
fn a_wave_chooses_the_crossover() {
    let wired = "/network/chains=[{\"bladders\": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], \"ends\": [\"connected\", \"sealed\"]}, \
                 {\"bladders\": [-1, -2, -3, -4, -5, -6, -7, -8, -9, -10], \"ends\": [\"connected\", \"sealed\"]}]\
                 |[{\"bladders\": [1, 2, 3, -4, -5, -6, -7, -8, -9, -10], \"ends\": [\"connected\", \"sealed\"]}, \
                 {\"bladders\": [-1, -2, -3, 4, 5, 6, 7, 8, 9, 10], \"ends\": [\"connected\", \"sealed\"]}]";
    let found = harvester("wave", &["--choose", wired]);
    assert_eq!(number(&found["chosen"]), 1.0, "{found}");
    let power = |k: usize| number(&found["alternatives"][k]["value"]);
    assert!(power(1) > power(0), "{found}");
    assert!(found["variables"].as_array().is_some_and(Vec::is_empty) && number(&found["evaluations"]) == 2.0);
}

/// Goal: numbers are sought for each of the alternatives; what is best with its own is chosen.
#[test]
fn numbers_are_sought_for_each() {
    let dir = tempfile::tempdir().expect("a folder");
    let found = best(
        &dir,
        &[
            "cases/dry-cantilever.json",
            "--choose",
            "/beam/density_kg_m3=900|1000|1100",
            "--vary",
            "/beam/height_m=0.01:0.05",
            "--minimize",
            "mode_2",
            "--command",
            "modes",
        ],
    );
    assert_eq!(chosen(&found), "density_kg_m3 1100", "{found}");
    for one in found["alternatives"].as_array().expect("alternatives") {
        assert!((number(&one["values"][0]) - 0.01).abs() < 1e-12, "{one}");
    }
}

/// Goal: every wiring with so many crossovers is there once, and each pairs the same bladders.
#[test]
fn every_wiring_is_there_once() {
    let case = case::load("cases/harvester-parallel-wave.json".as_ref(), &[]).expect("a case");
    for (most, count) in [(0, 1), (1, 10), (2, 46), (9, 512), (20, 512)] {
        let crossing = Crossing::of(&case, most).expect("chains");
        let all = crossing.all().expect("wirings");
        let sets: BTreeSet<_> = all.iter().map(|one| one.sets.clone()).collect();
        assert_eq!((all.len(), sets.len()), (count, count));
        assert_eq!(crossing.count(), count as f64);
        // digits make the same
        let choice = Choice(vec![Part::Crossovers(crossing)]);
        let digits = (0..512_usize).map(|n| (0..9).map(|k| n >> k & 1).collect::<Vec<_>>());
        let by_digits: BTreeSet<_> = digits
            .filter(|digits| choice.allows(digits))
            .map(|digits| choice.at(&digits).sets)
            .collect();
        assert_eq!(by_digits, sets);
    }
    let all = Crossing::of(&case, 1).expect("chains").all().expect("wirings");
    assert_eq!(all[0].name, "parallel");
    assert_eq!(all[3].name, "crossover after 3");
    assert_eq!(
        all[3].sets[0],
        "/network/chains/0/bladders=[1, 2, 3, -4, -5, -6, -7, -8, -9, -10]"
    );
    let other = case::load("cases/tour-actuator.json".as_ref(), &[]).expect("a case");
    assert!(Crossing::of(&other, 1).is_ok());
    let none = case::load("cases/two-bladders.json".as_ref(), &[]).expect("a case");
    let error = Crossing::of(&none, 1).expect_err("no chains").to_string();
    assert!(error.contains("opposite bladders"), "{error}");
    for wrong in ["/a", "/a=1", "/a=1|", "a=1|2"] {
        assert!(choices(wrong).is_err(), "{wrong}");
    }
    let many = (0..100).map(|k| format!("{k}")).collect::<Vec<_>>().join("|");
    let set = choices(&format!("/a={many}")).expect("alternatives");
    assert_eq!(
        combinations(vec![set.clone(), choices("/b=1|2").expect("two")])
            .expect("all")
            .len(),
        200
    );
    assert!(combinations(vec![set.clone(), set]).is_err());
}

/// Eighteen values each of a beam's density, stiffness and height, in no order: 5832 beams. The slowest is the heaviest, softest, thinnest.
fn lists() -> [String; 3] {
    let of = |pointer: &str, from: f64, step: f64| {
        let values = (0..18).map(|k| format!("{}", from + step * f64::from((7 * k + 5) % 18)));
        format!("{pointer}={}", values.collect::<Vec<_>>().join("|"))
    };
    [
        of("/beam/density_kg_m3", 500.0, 50.0),
        of("/beam/young_modulus_pa", 1e6, 1e5),
        of("/beam/height_m", 0.005, 0.001),
    ]
}

/// Goal: more than 5000 alternatives are searched among, which is said: how many of how many were computed, and that both searches, from different
/// starts, came to the best that is known here.
#[test]
fn more_than_can_be_computed_is_searched() {
    let dir = tempfile::tempdir().expect("a folder");
    let lists = lists();
    let mut asked = vec![
        "cases/dry-cantilever.json",
        "--minimize",
        "mode_1",
        "--command",
        "modes",
    ];
    lists.iter().for_each(|list| asked.extend(["--choose", list]));
    asked.extend(["--starts", "2", "--set", "/mesh/cells_per_segment=1"]);
    let found = best(&dir, &asked);
    let explored = &found["explored"];
    assert_eq!(number(&explored["of"]), 5832.0);
    assert_eq!(number(&explored["searches"]), 2.0);
    assert_eq!(
        (number(&explored["ended"]), number(&explored["came_to_best"])),
        (2.0, 2.0)
    );
    let tried = number(&explored["tried"]);
    assert!(tried > 50.0 && tried < 500.0, "{tried}");
    assert_eq!(found["alternatives"].as_array().map(Vec::len), Some(tried as usize));
    let k = number(&found["chosen"]) as usize;
    let sets = &found["alternatives"][k]["sets"];
    assert_eq!(
        *sets,
        serde_json::json!([
            "/beam/density_kg_m3=1350",
            "/beam/young_modulus_pa=1000000",
            "/beam/height_m=0.005"
        ])
    );
    let page = std::fs::read_to_string(dir.path().join("out/report.html")).expect("a page");
    assert!(
        page.contains("a search, not all of them") && page.contains(" Hz, "),
        "the page"
    );
}

/// Goal: a search that is interrupted has the best so far and says so; one that is not goes the same way whatever the number of threads.
#[test]
fn an_interrupted_search_keeps_the_best_so_far() {
    let parts = lists().map(|list| Part::Of(choices(&list).expect("alternatives")));
    let choice = Choice(parts.into());
    let asked = |jobs: usize| Asked {
        what: What::Modes,
        spans: vec![],
        goal: Goal {
            figure: "mode_1".into(),
            largest: false,
        },
        limits: vec![],
        starts: Some(2),
        method: Method::Gradient,
        jobs,
    };
    let make = |alternative: &Alternative| {
        let mut sets = alternative.sets.clone();
        sets.push("/mesh={\"segments\": 4, \"cells_per_segment\": 1}".into());
        Problem::new(&case::load("cases/dry-cantilever.json".as_ref(), &sets)?, &asked(1))
    };
    let count = AtomicUsize::new(0);
    let after = |most: usize, jobs: usize| {
        count.store(0, Relaxed);
        let stop = || count.load(Relaxed) >= most;
        let tell = |_: usize, _: Option<f64>| {
            count.fetch_add(1, Relaxed);
        };
        explore(&choice, &make, &asked(jobs), &stop, &tell)
    };
    let early = after(10, 1).expect("a best").optimum;
    let first = early.alternatives.iter().filter(|one| one.value.is_some()).count();
    assert!(first >= 9 && early.warnings[0].contains("interrupted"), "{early:?}");
    assert!(early.explored.is_some_and(|one| one.ended == 0 && one.tried < 12));
    assert!(
        after(0, 1)
            .expect_err("nothing")
            .to_string()
            .contains("nothing is written")
    );
    let [one, two] = [1, 2].map(|jobs| after(usize::MAX, jobs).expect("a best").optimum);
    assert_eq!(
        (one.value, one.explored, one.chosen),
        (two.value, two.explored, two.chosen)
    );
    assert!(early.value > one.value);
    let single = slcbeam::study::optimize::found::Optimum {
        evaluations: 1,
        ..early
    };
    assert!(
        optimum::words(&single).contains("\n1 design, "),
        "{}",
        optimum::words(&single)
    );
}

/// Goal: combinations by chance are within what is allowed, and not all the same.
#[test]
fn combinations_by_chance_are_allowed() {
    let case = case::load("cases/harvester-parallel-wave.json".as_ref(), &[]).expect("a case");
    let crossing = Crossing::of(&case, 3).expect("chains");
    let choice = Choice(vec![
        Part::Of(choices("/a=1|2|3").expect("three")),
        Part::Crossovers(crossing),
    ]);
    assert_eq!((choice.sizes().len(), choice.count()), (10, 3.0 * 130.0));
    let mut chance = Chance::new(1, 1);
    let all: BTreeSet<Vec<usize>> = (0..200).map(|_| choice.drawn(&mut chance)).collect();
    assert!(all.len() > 50 && all.iter().all(|digits| choice.allows(digits)));
    assert_eq!(choice.singles().len(), 1 + 2 + 9);
    assert_eq!(choice.all().expect("all").len(), 390);
}
