//! The section at finite strain, [E48]: effect `nonlinear_section`. The polynomial itself is tested against the cell in
//! `crates/section/tests/energy.rs`.

use std::path::Path;

use crate::differences::worst_difference;
use serde_json::Value;
use slcbeam::case::schema::Effect;
use slcbeam::case::{self, Case};
use slcbeam::dae::BeamDae;
use slcbeam::discrete::System;
use slcbeam::error::Error;
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{self, EquilibriumOptions};
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};
use slcbeam_section::cell::Cell;
use slcbeam_section::coefficients::Options as Meshes;
use slcbeam_section::finite::{Drive, FiniteCell};
use slcbeam_section::input::{Row, Section};

const CASE: &str = include_str!("../../cases/section-finite.json");
const PRESSURE: &str = "/network/chains/1/ends/0/pressure_pa/ramp/to";
const OFF: &str = r#"/effects={"nonlinear_section":"off"}"#;

fn parse(sets: &[&str]) -> slcbeam::error::Result<Case> {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    case::parse(CASE, Path::new("mine.json"), Path::new(""), &sets)
}

fn read(sets: &[&str]) -> Case {
    parse(sets).unwrap()
}

fn run(sets: &[&str]) -> Summary {
    dynamics::run(&read(sets), &mut Memory::default()).unwrap().summary
}

/// A quantity of the last state of rest under the loads at 1 s, and what the path is warned of.
fn at_rest(sets: &[&str], name: &str) -> (f64, Option<String>) {
    let case = read(sets);
    let path = equilibrium::follow(&case, &EquilibriumOptions::at(1.0), &mut |_| {
        slcbeam::run::record::Control::Continue
    })
    .unwrap();
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let columns = equilibrium::columns(&equilibrium::system(&case, 1.0).unwrap());
    let place = columns.iter().position(|column| column.name == name).unwrap();
    (path.last().row[place], path.warnings().pop())
}

/// Source: [E48]. Goal: a beam on which nothing acts but pressure has everywhere the curvature of its cell at rest under that pressure,
/// whose finite elements the program does not see: within 1 %, the error of the fit, where a linear section is off by more than 10 %.
#[test]
fn a_beam_under_pressure_bends_as_its_cell() {
    let section: Value = serde_json::from_str(CASE).unwrap();
    let section: Section = serde_json::from_value(section["section"].clone()).unwrap();
    let section = Section {
        three_d: false,
        ..section
    };
    let meshes = section
        .meshes(&Meshes {
            meshes: 2,
            ..Meshes::default()
        })
        .unwrap();
    let law = section.material.law.unwrap();
    let cell = FiniteCell::new(&section, Cell::new(&section, &meshes[1]), law).unwrap();
    for (pressure, linear_is_off) in [(10e3, 0.05), (20e3, 0.10), (30e3, 0.15)] {
        let bent = cell.equilibrium(Drive::Load([0.0; 2]), [0.0, pressure]).unwrap();
        let exact = -bent.strain[1] * 0.08;
        let to = format!("{PRESSURE}={pressure}");
        let plane = "/section/three_d=false";
        let (angle, warning) = at_rest(&[plane, &to], "tip_angle");
        let (linear, _) = at_rest(&[plane, &to, OFF], "tip_angle");
        println!("{pressure} Pa: cell {exact:.5} rad, beam {angle:.5}, linear {linear:.5}");
        assert_eq!(warning, None);
        assert!((angle / exact - 1.0).abs() < 0.01, "{pressure}: {angle} {exact}");
        assert!(
            (linear / exact - 1.0).abs() > linear_is_off,
            "{pressure}: {linear} {exact}"
        );
    }
}

/// Source: [E48]. Goal: as above with one row of bladders, whose polynomial has terms of its own, for bending and stretch of the neutral
/// axis; energy closes, and the Jacobian belongs to the residual.
#[test]
fn a_beam_with_one_row_bends_as_its_cell() {
    let section: Value = serde_json::from_str(CASE).unwrap();
    let mut section: Section = serde_json::from_value(section["section"].clone()).unwrap();
    (section.three_d, section.bladders.lower) = (false, Row::None);
    let meshes = Meshes {
        meshes: 2,
        ..Meshes::default()
    };
    let law = section.material.law.unwrap();
    let cell = FiniteCell::new(&section, Cell::new(&section, &section.meshes(&meshes).unwrap()[1]), law).unwrap();
    let rest = cell.equilibrium(Drive::Load([0.0; 2]), [0.0; 2]).unwrap().tangent;
    let axis = rest[0][1] / rest[0][0];
    let pressure = 15e3;
    let network = format!(
        r#"/network={{"chains":[{{"bladders":[1,2,3,4,5,6,7,8,9,10],"ends":[{{"pressure_pa":{{"ramp":{{"to":{pressure},"duration_s":1}}}}}},"sealed"]}}]}}"#
    );
    let sets = ["/section/three_d=false", r#"/section/bladders/lower="none""#, &network];
    let bent = cell.equilibrium(Drive::Load([0.0; 2]), [pressure, 0.0]).unwrap().strain;
    let (angle, warning) = at_rest(&sets, "tip_angle");
    let linear = at_rest(&[&sets[..], &[OFF]].concat(), "tip_angle").0;
    let exact = -bent[1] * 0.08;
    assert_eq!(warning, None);
    assert!((angle / exact - 1.0).abs() < 0.01, "{angle} {exact}");
    assert!((linear / exact - 1.0).abs() > 0.05, "{linear} {exact}");
    // on an arc of the stretched line
    let chord = |curvature: f64, stretch: f64| 0.08 * stretch * (curvature * 0.08).sin() / (curvature * 0.08) - 0.08;
    let exact = chord(bent[1], 1.0 + bent[0] + axis * bent[1]);
    let along = at_rest(&sets, "tip_u3").0;
    assert!((along - exact).abs() < 0.02 * exact.abs(), "{along} {exact}");
    let energy = run(&sets).balances.energy_residual_relative;
    assert!(energy.abs() < 1e-4, "{energy:.1e}");
    let mut dae = BeamDae::new(System::new(&read(&sets)).unwrap());
    for (seed, size) in [(1, 0.1), (2, 0.03)] {
        assert!(worst_difference(&mut dae, seed, size) < 1e-6);
    }
}

/// Goal: what the effect does is of the order of the pressure, so it vanishes with it; at small loads the program leaves it out.
#[test]
fn the_effect_vanishes_with_the_loads() {
    let change = |pressure: f64| {
        let to = format!("{PRESSURE}={pressure}");
        let on = at_rest(&[&to, r#"/effects={"nonlinear_section":"on"}"#], "tip_angle").0;
        on / at_rest(&[&to, OFF], "tip_angle").0 - 1.0
    };
    let changes = [4000.0, 1000.0, 250.0].map(change);
    println!("{changes:?}");
    for pair in changes.windows(2) {
        assert!((pair[0] / pair[1] / 4.0 - 1.0).abs() < 0.15, "{changes:?}");
    }
    let has = |sets: &[&str]| {
        System::new(&read(sets))
            .unwrap()
            .model
            .effects
            .has(Effect::NonlinearSection)
    };
    assert!(has(&[]) && !has(&[&format!("{PRESSURE}=1")]) && !has(&[OFF]));
}

/// Goal: left out, the effect is no unknown and no term: all figures are those of a material without a law, to the last bit.
#[test]
fn left_out_it_is_a_linear_material() {
    let figures = |sets: &[&str]| {
        let mut memory = Memory::default();
        let unknowns = System::new(&read(sets)).unwrap().layout.len;
        dynamics::run(&read(sets), &mut memory).unwrap();
        (unknowns, memory.rows)
    };
    let without = figures(&[OFF, r#"/section/material/law="linear""#]);
    assert_eq!(figures(&[OFF]), without);
    assert_eq!(figures(&[]).0, without.0 + 20, "an area a bladder");
}

/// Goal: the Jacobian belongs to the residual, at ends that hold the slope and at ends with a moment, at states in which P is known.
#[test]
fn the_jacobian_is_that_of_differences() {
    let turned = r#"/ends/tip={"free":{"moment_n_m":{"sine":{"amplitude":0.02,"frequency_hz":10}}}}"#;
    for sets in [
        vec![],
        vec![turned],
        vec![r#"/effects={"finite_rotation":"off","nonlinear_section":"on"}"#],
    ] {
        let case = read(&sets);
        let mut dae = BeamDae::new(System::new(&case).unwrap());
        for (seed, size) in [(1, 0.1), (2, 0.03), (3, 0.003)] {
            let worst = worst_difference(&mut dae, seed, size);
            println!("{sets:?} {size}: {worst:.1e}");
            assert!(worst < 1e-6, "{sets:?} {size}: {worst:.2e}");
        }
    }
}

/// Goal: forces, moments and areas follow from one potential: energy closes as far as tolerances say, with driven ends, end
/// moments that do work, kept and shared bladders, and nothing is added by reciprocity.
#[test]
fn its_energy_closes() {
    let turned = r#"/ends/tip={"free":{"moment_n_m":{"sine":{"amplitude":0.01,"frequency_hz":6,"ramp_cycles":1}}}}"#;
    let shaken = r#"/ends/root={"clamped":{"u1_m":{"sine":{"amplitude":0.002,"frequency_hz":12,"ramp_cycles":1}}}}"#;
    let kept = r#"/effects={"flow":"off","nonlinear_section":"on"}"#;
    let small = r#"/effects={"finite_rotation":"off","nonlinear_section":"on"}"#;
    let sealed = r#"/network/chains/1/ends=["sealed","sealed"]"#;
    for sets in [
        vec![],
        vec![turned],
        vec![shaken],
        vec![small, turned],
        vec![shaken, sealed, kept],
    ] {
        let mut open = vec![];
        for rtol in ["/solver/rtol=1e-5", "/solver/rtol=1e-7"] {
            let mut all = sets.clone();
            all.extend([rtol, "/time/end_s=0.4"]);
            let summary = run(&all);
            assert_eq!(summary.status, Status::Finished, "{sets:?} {:?}", summary.reason);
            open.push(summary.balances.energy_residual_relative);
        }
        println!("{sets:?}: {open:?}");
        assert!(open[1] < 1e-6 && open[1] < 0.2 * open[0], "{sets:?}: {open:?}");
    }
}

/// Goal: where the energy of the section is not known a run ends and a path of equilibria warns; a contradiction is refused.
#[test]
fn what_is_not_known_is_said() {
    let high = format!("{PRESSURE}=60000");
    let summary = run(&[&high]);
    assert_eq!(summary.status, Status::OutOfRange);
    assert!(summary.reason.unwrap().contains("strain_energy"));
    let warning = at_rest(&[&high], "tip_angle").1.unwrap_or_default();
    assert!(
        warning.contains("W023") && warning.contains("load factor 0."),
        "{warning}"
    );
    let refused = |sets: &[&str]| match parse(sets) {
        Err(Error::Case(fault)) => fault.violations.into_iter().map(|v| v.pointer).collect::<Vec<_>>(),
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(&[r#"/formulation="published""#]), ["/formulation"]);
    assert_eq!(
        refused(&[r#"/bladders/coupling="reciprocal_kinked""#]),
        ["/bladders/coupling"]
    );
    assert_eq!(refused(&["/section/material/law=\"hooke\""]), ["/section/material/law"]);
    // a degree that is none is told, not counted through
    let degree = "/bladders/strain_energy/degree";
    assert_eq!(refused(&[&format!("{degree}=1000000000")]), [degree]);
    let linear = "/bladders/strain_energy=null";
    assert!(parse(&[r#"/formulation="published""#, linear]).is_ok());
    let short = r#"/bladders/strain_energy={"stretch":[-0.1,0.1],"curvature_1_m":[-9,9],"upper_pressure_pa":[0,0],"lower_pressure_pa":[-1e4,1e4],"degree":3,"coefficients_n":[1]}"#;
    assert_eq!(
        refused(&[short]),
        [
            "/bladders/strain_energy/upper_pressure_pa",
            "/bladders/strain_energy/coefficients_n"
        ]
    );
}

/// Goal: the case of a result has the energy as numbers, and runs without a cell as it ran with it.
#[test]
fn its_numbers_are_read_back() {
    let case = read(&["/time/end_s=0.1"]);
    let text = serde_json::to_string(&case).unwrap();
    let again = case::parse(&text, Path::new("case.json"), Path::new(""), &[]).unwrap();
    assert_eq!(again.bladders, case.bladders);
    let other = case::parse(
        &text,
        Path::new("case.json"),
        Path::new(""),
        &["/section/material/law=\"linear\"".to_owned()],
    )
    .unwrap();
    assert_eq!(
        other.bladders.unwrap().strain_energy,
        None,
        "another law brings its own"
    );
}

/// Sets of the beam of 0.08 m behind a root block of 0.016 m without bladders, of some modulus [Pa].
fn behind_root(modulus: f64) -> Vec<String> {
    let row = |sign: i64| (3..=12).map(|k| sign * k).collect::<Vec<i64>>();
    let ends = r#"[{"pressure_pa":{"ramp":{"to":25000,"duration_s":0.1}}},"sealed"]"#;
    vec![
        "/beam/length_m=0.096".into(),
        format!(
            r#"/network={{"chains":[{{"bladders":{:?},"ends":[{{"pressure_pa":0}},"sealed"]}},{{"bladders":{:?},"ends":{ends}}}]}}"#,
            row(1),
            row(-1)
        ),
        format!(r#"/spans=[{{"length_m":0.016,"rows":"none","beam":{{"young_modulus_pa":{modulus:e}}}}},{{}}]"#),
    ]
}

/// Goal: behind a root block without bladders, the beam with its energy at finite strain becomes the beam that is clamped at the border as
/// the block becomes stiff, with a difference that goes with the compliance of the block.
#[test]
fn a_stiff_root_block_is_a_clamp() {
    let pressed = "/network/chains/1/ends/0/pressure_pa={\"ramp\":{\"to\":25000,\"duration_s\":0.1}}";
    let pulled = r#"/ends/tip={"free":{"force_x_n":0.1}}"#;
    let clamped = at_rest(&[pressed, pulled], "tip_u1").0;
    let off = [5e5, 5e7, 5e9].map(|modulus| {
        let sets = behind_root(modulus);
        let sets: Vec<&str> = sets.iter().map(String::as_str).chain([pulled]).collect();
        at_rest(&sets, "tip_u1").0 / clamped - 1.0
    });
    println!("{off:?}");
    let goes_with_compliance = |pair: &[f64]| (pair[0] / pair[1] / 100.0 - 1.0).abs() < 0.1;
    assert!(off[0] > 0.01 && off.windows(2).all(goes_with_compliance), "{off:?}");
}

/// Goal: energy closes with the border between sections of different stiffness, of which one has no energy; the Jacobian belongs to the
/// residual; an end with a moment may be in either section.
#[test]
fn its_energy_closes_at_a_border() {
    let turned = r#"/ends/tip={"free":{"moment_n_m":{"sine":{"amplitude":0.01,"frequency_hz":6,"ramp_cycles":1}}}}"#;
    let pinned =
        r#"/ends/root={"pinned":{"moment_n_m":{"sine":{"amplitude":0.005,"frequency_hz":5,"ramp_cycles":1}}}}"#;
    let shaken = r#"/ends/root={"clamped":{"u1_m":{"sine":{"amplitude":0.002,"frequency_hz":12,"ramp_cycles":1}}}}"#;
    for (modulus, sets) in [(1e5, vec![turned]), (5e5, vec![shaken]), (2e6, vec![pinned, turned])] {
        let root = behind_root(modulus);
        let mut all: Vec<&str> = root.iter().map(String::as_str).collect();
        all.extend(sets);
        let mut dae = BeamDae::new(System::new(&read(&all)).unwrap());
        for (seed, size) in [(1, 0.1), (2, 0.03)] {
            let worst = worst_difference(&mut dae, seed, size);
            assert!(worst < 1e-6, "{all:?}: {worst:.1e}");
        }
        let mut open = vec![];
        for rtol in ["/solver/rtol=1e-5", "/solver/rtol=1e-7"] {
            let summary = run(&[&all[..], &[rtol, "/time/end_s=0.3"]].concat());
            assert_eq!(summary.status, Status::Finished, "{modulus} {:?}", summary.reason);
            open.push(summary.balances.energy_residual_relative);
        }
        println!("{modulus}: {open:?}");
        assert!(open[1] < 1e-6 && open[1] < 0.2 * open[0], "{modulus}: {open:?}");
    }
}

/// Goal: spans with the section of the case are the uniform beam to the last bit; a span with bladders in another section, or with one row
/// less, is refused by its place.
#[test]
fn spans_share_the_section_of_the_energy() {
    let figures = |sets: &[&str]| {
        let mut memory = Memory::default();
        let sets = [sets, &["/time/end_s=0.1"]].concat();
        dynamics::run(&read(&sets), &mut memory).unwrap();
        memory.rows
    };
    let same = r#"/spans=[{"length_m":0.032},{"beam":{"height_m":0.02}}]"#;
    assert_eq!(figures(&[]), figures(&[same]));
    for span in [
        r#"{"beam":{"young_modulus_pa":6e5}}"#,
        r#"{"rows":"lower"}"#,
        r#"{"bladders":{"area_per_pressure_m2_per_pa":2e-10}}"#,
    ] {
        let spans = format!(r#"/spans=[{{"length_m":0.04}},{span}]"#);
        let network = r#"/network={"chains":[]}"#;
        let Err(Error::Case(fault)) = parse(&[&spans, network]) else {
            panic!("{span} is accepted");
        };
        let text = case::render(&fault, false, 200);
        assert!(text.contains("/spans/1") && text.contains("strain_energy"), "{text}");
    }
    let heavy = r#"/spans=[{"length_m":0.04},{"beam":{"density_kg_m3":1200}}]"#;
    assert!(parse(&[heavy]).is_ok());
}

/// Goal: with one row the neutral axis is beside that of a root block without bladders; energy closes, the Jacobian belongs to the residual,
/// and behind a stiff block the beam is clamped.
#[test]
fn one_row_behind_a_root_block() {
    let one_row = ["/section/three_d=false", r#"/section/bladders/lower="none""#];
    let chain = |first: i64, last: i64| {
        let row: Vec<i64> = (first..=last).collect();
        format!(
            r#"/network={{"chains":[{{"bladders":{row:?},"ends":[{{"pressure_pa":{{"ramp":{{"to":12000,"duration_s":0.1}}}}}},"sealed"]}}]}}"#
        )
    };
    let alone = chain(1, 10);
    let clamped = at_rest(&[&one_row[..], &[&alone]].concat(), "tip_u1").0;
    let behind = |modulus: f64| {
        let mut sets = behind_root(modulus);
        sets[1] = chain(3, 12);
        sets.extend(one_row.map(str::to_owned));
        sets
    };
    let stiff = behind(5e9);
    let stiff: Vec<&str> = stiff.iter().map(String::as_str).collect();
    let off = at_rest(&stiff, "tip_u1").0 / clamped - 1.0;
    assert!(off.abs() < 1e-6, "{off:.1e}");
    let turned = r#"/ends/tip={"free":{"moment_n_m":{"sine":{"amplitude":0.005,"frequency_hz":6,"ramp_cycles":1}}}}"#;
    let soft = behind(4e5);
    let mut soft: Vec<&str> = soft.iter().map(String::as_str).collect();
    soft.extend([turned, "/solver/rtol=1e-7", "/time/end_s=0.3"]);
    let mut dae = BeamDae::new(System::new(&read(&soft)).unwrap());
    assert!(worst_difference(&mut dae, 1, 0.1) < 1e-6);
    let energy = run(&soft).balances.energy_residual_relative;
    println!("{off:.1e}, energy {energy:.1e}");
    assert!(energy.abs() < 1e-6, "{energy:.1e}");
}
