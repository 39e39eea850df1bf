//! Ledgers of the beams of a structure, [E108], and powers of joints.
//!
//! Goal: work of loads, joints and fluid on a beam, less its losses, is the change of its energies; rigid joints take no power.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case;
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;

use crate::balances::close;
use crate::plans::{beam, held, joint, section, structure};
use crate::scene::finished;

fn shipped(name: &str) -> Value {
    let text = std::fs::read_to_string(format!("cases/{name}.json")).unwrap();
    let mut case: Value = serde_json::from_str(&text).unwrap();
    case["companion"] = json!("off");
    case["solver"]["rtol"] = json!(1e-8);
    case
}

fn run(case: &Value) -> Memory {
    let case = case::parse(&case.to_string(), Path::new("test.json"), Path::new("cases"), &[])
        .map_err(|e| format!("{e:?}"))
        .unwrap();
    let mut memory = Memory::default();
    let outcome = dynamics::run(&case, &mut memory).unwrap();
    assert!(outcome.fault.is_none(), "{:?}", outcome.fault);
    memory
}

/// Open part of the ledger of a beam, and the largest of its entries [J].
fn open(memory: &Memory, beam: &str) -> [f64; 2] {
    let of = |name: &str| memory.column(&format!("{beam}.{name}")).expect(name);
    let entries = [
        ("kinetic_energy", 1.0),
        ("elastic_energy", 1.0),
        ("work", -1.0),
        ("work_joints", -1.0),
        ("work_fluid", -1.0),
        ("dissipated", 1.0),
    ];
    let columns = entries.map(|(name, sign)| (of(name), sign));
    let rows = 0..columns[0].0.len();
    let sum = |row: usize| {
        columns
            .iter()
            .map(|(column, sign)| sign * (column[row] - column[0]))
            .sum::<f64>()
    };
    let largest = columns
        .iter()
        .flat_map(|(column, _)| column)
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    [rows.map(|row| sum(row).abs()).fold(0.0, f64::max), largest]
}

/// Largest power that a joint takes [W].
fn taken(memory: &Memory, joint: usize) -> f64 {
    let power = memory.column(&format!("joint_{joint}_power")).unwrap();
    power.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// A run of a shipped case in which the ledger of every beam closes, relative to its largest entry.
fn closed(name: &str, end: f64, change: impl Fn(&mut Value)) -> Memory {
    let mut case = shipped(name);
    case["time"]["end_s"] = json!(end);
    change(&mut case);
    let memory = run(&case);
    for beam in case["beams"].as_array().unwrap() {
        let beam = beam["name"].as_str().unwrap();
        let [open, largest] = open(&memory, beam);
        println!("{name}, {beam}: {open:.1e} of {largest:.1e} J");
        assert!(largest > 1e-9, "{name}, {beam}: nothing moves");
        assert!(open < 5e-6 * largest, "{name}, {beam}: {open:.1e} of {largest:.1e} J");
    }
    memory
}

/// Rigid joints of bodies without rotary inertia, and hinges without springs, take no power.
#[test]
fn ledgers_of_beams_close() {
    closed("gripper", 0.4, |_| ());
    closed("pinch", 0.2, |_| ());
    let walker = closed("walker", 0.5, |_| ());
    let four_bar = closed("four-bar", 0.4, |_| ());
    for joint in 1..3 {
        assert_eq!([taken(&walker, joint), taken(&four_bar, joint)], [0.0; 2]);
    }
    // as the balances of the ends tell it
    for (memory, beams) in [
        (&walker, ["body", "first", "second"]),
        (&four_bar, ["crank", "coupler", "rocker"]),
    ] {
        let given = beams.map(|beam| memory.column(&format!("{beam}.work_joints")).unwrap());
        let last = given.each_ref().map(|column| column[column.len() - 1]);
        let (sum, largest) = (
            last.iter().sum::<f64>(),
            last.iter().fold(0.0_f64, |most, x| most.max(x.abs())),
        );
        println!("{beams:?}: joints give {sum:.1e} of {largest:.1e} J");
        assert!(largest > 1e-6 && sum.abs() < 1e-6 * largest, "{sum:e} of {largest:e}");
    }
    closed("four-bar", 0.2, |case| {
        case["beams"][1]["attachments"] = json!([
            {"at": 0.4, "stiffness_rotation_n_m_rad": 0.05, "stiffness_x_n_m": 20, "damping_z_n_s_m": 0.1},
            {"at": 0.7, "mass_kg": 0.01, "offset_across_m": 0.02, "offset_along_m": 0.01, "rotary_inertia_kg_m2": 1e-6}]);
    });
    closed("branched-actuator", 0.3, |case| {
        case["beam"]["damping"] = json!({"drag_n_s_m2": 5});
        case["beam"]["viscoelasticity"] = json!({"prony": [{"modulus_ratio": 0.3, "time_s": 0.05}]});
    });
}

/// Rigid places apart, without inertia: reactions contain no accelerations.
#[test]
fn ledgers_without_inertia_close() {
    let mut case = structure(
        section([1e3, 0.02, 0.1]),
        vec![
            held(beam("a", 0.1, 0.0, 6), "root", json!("clamped")),
            beam("b", 0.1, 23.0, 6),
        ],
        vec![joint("rigid", &["a.tip", "b.root"])],
    );
    case["beam"]["damping"] = json!({"bending_time_s": 0.01, "axial_time_s": 0.01});
    case["beams"][1]["origin_m"] = json!([0.03, 0.11]);
    case["loads"] = json!([{"gravity": {"x_m_s2": -2, "z_m_s2": -1}}]);
    case["effects"]["solid_inertia"] = json!("off");
    case["solver"]["rtol"] = json!(1e-6);
    case["time"] = json!({"end_s": 0.3});
    let memory = run(&case);
    for beam in ["a", "b"] {
        let [open, largest] = open(&memory, beam);
        println!("without inertia, {beam}: {open:.1e} of {largest:.1e} J");
        assert!(
            largest > 1e-5 && open < 1e-3 * largest,
            "{beam}: {open:.1e} of {largest:.1e} J"
        );
    }
}

/// An elastic joint and a slider that damp displacements between beams without viscosity: the massless angle is neither given by its balance
/// nor by its rate. Goal: balances close to 1e-6 at rtol 1e-8, and a tiny body at the joint changes the motion by less than 1e-4.
#[test]
fn joints_that_damp_displacements_are_stable() {
    let elastic = json!({"elastic": {
        "stiffness": [[30.0, 2.0, 0.02], [2.0, 50.0, 0.0], [0.02, 0.0, 0.005]],
        "damping": [[0.3, 0, 0], [0, 0.5, 0], [0, 0, 5e-4]]}});
    let slider =
        json!({"slider": {"stiffness_n_m": 50, "damping_n_s_m": 0.5, "angle_rad": 0.4, "wall_stiffness_n_m": 5000}});
    for kind in [elastic, slider] {
        let tips = [0.0, 1e-11].map(|inertia| {
            let mut case = structure(
                section([200.0, 1.67e-3, 0.2]),
                vec![
                    held(beam("a", 0.1, 0.0, 8), "root", json!("clamped")),
                    beam("b", 0.1, 34.0, 8),
                ],
                vec![json!({"at": ["a.tip", "b.root"], "kind": kind, "rotary_inertia_kg_m2": inertia})],
            );
            case["loads"] = json!([{"gravity": {"x_m_s2": -9.81}}]);
            case["solver"]["rtol"] = json!(1e-8);
            case["time"] = json!({"end_s": 0.2});
            let (memory, summary) = finished(&case);
            close("damped displacements", &summary, 1e-6);
            memory.column("b.tip_u1").unwrap()
        });
        let off = tips[0]
            .iter()
            .zip(&tips[1])
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        println!("{kind}: moves by {off:.1e} m with a body");
        assert!(off < 1e-5, "{kind}: {off:.1e} m");
    }
}

/// Hinges between a beam that bends viscously and one that does not start, in both orders.
#[test]
fn hinges_of_unlike_beams_start() {
    for viscous in [0, 1] {
        let mut case = structure(
            section([200.0, 1.67e-3, 0.2]),
            vec![
                held(beam("a", 0.1, 0.0, 4), "root", json!("clamped")),
                beam("b", 0.1, 34.0, 4),
            ],
            vec![json!({"at": ["a.tip", "b.root"], "kind": {"hinge": {"stiffness_n_m_rad": 0.01}}})],
        );
        case["beams"][viscous]["beam"] = json!({"damping": {"bending_time_s": 1e-3}});
        case["loads"] = json!([{"gravity": {"x_m_s2": -9.81}}]);
        case["solver"]["rtol"] = json!(1e-8);
        case["time"] = json!({"end_s": 0.1});
        close("unlike beams", &finished(&case).1, 1e-6);
    }
}

/// Work that the joints take from the beams is in their springs, or lost in their dampers.
#[test]
fn ledgers_of_joints_close() {
    let memory = closed("four-bar", 0.6, |case| {
        case["solver"]["rtol"] = json!(1e-10);
        for joint in case["joints"].as_array_mut().unwrap() {
            joint["kind"] = json!({"hinge": {"stiffness_n_m_rad": 0.5, "damping_n_m_s_rad": 0.02}});
        }
    });
    let of = |name: &str| {
        let column = memory.column(name).expect(name);
        column[column.len() - 1] - column[0]
    };
    let sum = |name: &str| {
        ["crank", "coupler", "rocker"]
            .map(|beam| of(&format!("{beam}.{name}")))
            .iter()
            .sum::<f64>()
    };
    let (stored, lost) = (of("spring_energy"), of("dissipated_damping") - sum("dissipated"));
    let taken = -sum("work_joints");
    println!("taken {taken:.6e}, stored {stored:.6e}, lost {lost:.6e} J");
    assert!(stored > 1e-6 && lost > 1e-6);
    assert!((taken - stored - lost).abs() < 1e-6 * taken);
}
