//! What is chosen from a set.

use std::collections::BTreeSet;

use serde_json::Value;
use slcbeam::case;
use slcbeam::study::optimize::wiring::{choices, combinations, crossings};

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
        let all = crossings(&case, most).expect("wirings");
        let sets: BTreeSet<_> = all.iter().map(|one| one.sets.clone()).collect();
        assert_eq!((all.len(), sets.len()), (count, count));
    }
    let all = crossings(&case, 1).expect("wirings");
    assert_eq!(all[0].name, "parallel");
    assert_eq!(all[3].name, "crossover after 3");
    assert_eq!(
        all[3].sets[0],
        "/network/chains/0/bladders=[1, 2, 3, -4, -5, -6, -7, -8, -9, -10]"
    );
    let other = case::load("cases/tour-actuator.json".as_ref(), &[]).expect("a case");
    assert!(crossings(&other, 1).is_ok());
    let none = case::load("cases/two-bladders.json".as_ref(), &[]).expect("a case");
    let error = crossings(&none, 1).expect_err("no chains").to_string();
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
