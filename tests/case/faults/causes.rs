//! Faults that make others: the cause is told, where it was brought.

use std::path::Path;

use slcbeam::case;
use slcbeam::error::Error;

use crate::faulty::{WIRING, fault_of};

fn places(text: &str, sets: &[&str]) -> Vec<String> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    match case::parse(text, Path::new("w.json"), Path::new("cases"), &sets) {
        Err(Error::Case(fault)) => fault.violations.iter().map(|v| v.pointer.clone()).collect(),
        other => panic!("{other:?}"),
    }
}

/// Source: the example of docs/python.md, and units that are none. Goal: a fault that makes others is told alone: what does not go with a value
/// that is faulty itself, or not what was meant, is no fault. Before, a height below zero made six, a modulus in MPa blamed pressures and gravity.
#[test]
fn a_cause_is_told_without_what_follows_from_it() {
    let case = r#"{"name": "a", "preset": "matia-gat-beam", "ends": {"root": "clamped", "tip": {"free": {"force_x_n": 1}}}, "time": {"end_s": 1},
        "loads": [{"gravity": {"x_m_s2": -9.81}}], "start": {"pressures": [{"bladders": [1], "pressure_pa": 3000}]},
        "network": {"chains": [{"bladders": [1, 2], "ends": [{"pressure_pa": 60000}, "sealed"]}, {"bladders": [9, 10]}]}}"#;
    for (sets, wanted) in [
        (
            &["/beam/lenght_m=0.1", "/beam/height_m=-0.02"][..],
            &["/beam/lenght_m", "/beam/height_m"][..],
        ),
        (&["/beam/young_modulus_pa=2"], &["/beam/young_modulus_pa"]),
        (&["/beam/width_m=-0.05"], &["/beam/width_m"]),
        (&["/beam/lenght_m=0.3", "/bladders/per_row=30"], &["/beam/lenght_m"]),
        (&["/bladders/per_row=0"], &["/bladders/per_row"]),
        (&["/bladders/per_rows=20"], &["/bladders/per_rows"]),
        (&["/time/end_s=-1", "/step_response={\"at_s\": 0.5}"], &["/time/end_s"]),
        // what is sound is compared all the same
        (
            &["/beam/height_m=-0.02", "/bladders/length_m=0.06"],
            &["/beam/height_m", "/bladders/length_m"],
        ),
    ] {
        assert_eq!(places(case, sets), wanted, "{sets:?}");
    }
}

/// Goal: what two values do not go together by is shown where one of them was changed, not where the other stands.
#[test]
fn a_relation_is_shown_where_it_was_changed() {
    let sets = ["/beam/height_m=0.01".to_owned()];
    let Err(Error::Case(fault)) = case::parse(WIRING, Path::new("w.json"), Path::new("cases"), &sets) else {
        panic!()
    };
    let [found] = fault.violations.as_slice() else {
        panic!("{}", case::render(&fault, false, 100))
    };
    assert_eq!(
        (found.pointer.as_str(), found.set.as_deref()),
        ("/bladders/height_m", Some("/beam/height_m=0.01"))
    );
    assert!(
        found
            .allowed
            .as_deref()
            .is_some_and(|told| told.contains("at most 0.005 m")),
        "{found:?}"
    );
}

/// Goal: a section in a file of its own, given as a case, is told as what it is. Before, it was seventeen faults.
#[test]
fn a_section_is_no_case() {
    let text = std::fs::read_to_string("cases/sections/ecoflex-actuator.json").unwrap();
    let fault = fault_of(&text);
    let [found] = fault.violations.as_slice() else {
        panic!("{}", case::render(&fault, false, 100))
    };
    assert!(found.what.contains("a section"), "{found:?}");
    assert!(
        found
            .hint
            .as_deref()
            .is_some_and(|hint| hint.contains("slcbeam coefficients")),
        "{found:?}"
    );
}
