//! The library refuses what the program refuses, in the same words and at the same place.

use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::discrete::System;
use slcbeam::error::{CaseError, Error};
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium;
use slcbeam::run::periodic::scene;
use slcbeam::run::record::Memory;

const WIRING: &str = "cases/wiring-2.json";

/// Cases whose text is good and whose model is not: the command, the file, what is set.
const REFUSED: [(&str, &str, &[&str]); 5] = [
    (
        "check",
        WIRING,
        &["/formulation=\"published\"", "/effects={\"finite_rotation\":\"off\"}"],
    ),
    ("check", WIRING, &["/solver/max_order=3"]),
    (
        "check",
        WIRING,
        &[
            "/bladders/coupling=\"reciprocal_kinked\"",
            "/bladders/kink_width=1e-9",
            "/effects=\"full\"",
        ],
    ),
    (
        "modes",
        WIRING,
        &[
            "/solver/max_order=4",
            "/effects={\"axial_force_on_bending\":\"off\",\"finite_rotation\":\"on\"}",
        ],
    ),
    ("periodic", "cases/wiring-3.json", &["/solver/max_order=3"]),
];

fn load(file: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    case::load(Path::new(file), &sets).expect("a valid text")
}

fn fault<T>(result: Result<T, Error>) -> Box<CaseError> {
    match result {
        Err(Error::Case(fault)) => fault,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("not refused"),
    }
}

/// What the program says of each fault, from the library's.
fn told(fault: &CaseError) -> Value {
    let told = fault.violations.iter().map(|v| {
        json!({"code": v.code.id(), "what": v.what, "pointer": v.pointer, "set": v.set, "allowed": v.allowed, "hint": v.hint})
    });
    told.collect()
}

/// Goal: one refusal for both. The faults of the library are those that the program prints, each placed in the same argument.
#[test]
fn the_library_refuses_what_the_program_refuses() {
    for (command, file, sets) in REFUSED {
        let mut program = Command::new(env!("CARGO_BIN_EXE_slcbeam"));
        program.args([command, file, "--json", "--out"]);
        program.arg(std::env::temp_dir().join("slcbeam-library"));
        if command == "check" {
            program = Command::new(env!("CARGO_BIN_EXE_slcbeam"));
            program.args([command, file, "--json"]);
        }
        sets.iter().for_each(|set| {
            program.args(["--set", set]);
        });
        let answer = program.output().expect("the program");
        assert_eq!(answer.status.code(), Some(3), "{sets:?}");
        let answer: Value = serde_json::from_slice(&answer.stdout).expect("JSON");
        let mut faults = answer["faults"].clone();
        for fault in faults.as_array_mut().expect("faults") {
            for key in ["line", "column", "nearest"] {
                fault.as_object_mut().expect("an object").remove(key);
            }
        }
        let case = load(file, sets);
        let own = match command {
            "periodic" => fault(scene::system(&case)),
            _ => fault(System::new(&case)),
        };
        assert_eq!(told(&own), faults, "{sets:?}");
        assert!(own.path.ends_with(file) && own.text == case.source.text);
    }
}

/// Goal: nothing begins that is refused.
#[test]
fn what_is_refused_records_nothing() {
    for (_, file, sets) in REFUSED.iter().filter(|(command, ..)| *command == "check") {
        let mut memory = Memory::default();
        fault(dynamics::run(&load(file, sets), &mut memory));
        assert!(memory.rows.is_empty(), "{sets:?}");
    }
    let case = load(WIRING, REFUSED[2].2);
    fault(equilibrium::system(&case, 0.0));
}

/// Goal: a network that was changed after its check is looked at again. What leads nowhere is told as the check tells it, and
/// never led somewhere else.
#[test]
fn a_network_that_leads_nowhere_has_no_system() {
    let tour = || load("cases/network-tour.json", &[]);
    let changed = |change: fn(&mut slcbeam::case::schema::Network)| {
        let mut case = tour();
        change(case.network.as_mut().expect("a network"));
        fault(System::new(&case)).violations.remove(0).what
    };
    assert!(System::new(&tour()).is_ok());
    let what = changed(|network| network.tubes[0].from.junction = Some("nowhere".into()));
    assert!(what.contains("junction"), "{what}");
    let what = changed(|network| network.chains[0].bladders[0] = 99);
    assert_eq!(what, "there is no bladder 99");
    let what = changed(|network| network.ports[0].pressure_pa = None);
    assert!(what.contains("a port with"), "{what}");
    let mut case = tour();
    case.tubes = None;
    assert!(fault(System::new(&case)).violations[0].what.contains("tubes"));
}
