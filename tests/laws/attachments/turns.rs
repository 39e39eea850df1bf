//! Full turns: of what is read, and of rotational springs, [E50].

use serde_json::{Value, json};
use slcbeam::discrete::System;
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::Status;

use super::parse;

/// A rod of silicone, 20 cells.
fn rod(ends: Value, attachments: Value, time: Value, sheared: bool) -> Value {
    let mut case = json!({
        "name": "turns",
        "beam": {"length_m": 0.2, "height_m": 0.01, "width_m": 0.03, "young_modulus_pa": 2e7, "density_kg_m3": 1100},
        "ends": ends, "attachments": attachments, "mesh": {"segments": 20, "cells_per_segment": 1}, "time": time,
        "probes": [{"name": "begin", "at": 0}, {"name": "middle", "at": 0.5}]
    });
    if sheared {
        case["beam"]["shear_stiffness_n"] = 3000.into();
        case["effects"] = json!({"shear": "on"});
    }
    case
}

fn last(kept: &Memory, name: &str) -> f64 {
    *kept.column(name).unwrap().last().unwrap()
}

/// Goal: a root that is driven through 10 rad takes tip and probes with it, and what was furthest is told of them; a pinned one that spins is followed as sections
/// are that shear, whose angles are unknowns. Before, angles jumped back at π: the tip ended at -2.6.
#[test]
fn full_turns_of_the_root_are_counted() {
    let driven =
        json!({"root": {"clamped": {"slope_rad": {"polynomial": {"coefficients": [0, 0, 10]}}}}, "tip": "free"});
    let time = json!({"end_s": 1, "output_interval_s": 0.05});
    let mut kept = Memory::default();
    let outcome = dynamics::run(&parse(&rod(driven, json!([]), time.clone(), false)), &mut kept).unwrap();
    for name in ["tip_angle", "begin_angle", "middle_angle"] {
        assert!((last(&kept, name) - 10.0).abs() < 0.2, "{name}: {}", last(&kept, name));
    }
    let most = outcome.summary.quantities["tip_angle_rad"].max_abs.unwrap();
    assert!((most - 10.0).abs() < 0.2, "{most}");

    let spun = |sheared: bool| {
        let mut case = rod(
            json!({"root": "pinned", "tip": "free"}),
            json!([]),
            time.clone(),
            sheared,
        );
        case["start"] = json!({"u1_rate_m_s": {"polynomial": {"coefficients": [0, 12]}}});
        let mut kept = Memory::default();
        dynamics::run(&parse(&case), &mut kept).unwrap();
        ["tip_angle", "begin_angle", "middle_angle", "turned_root"].map(|name| last(&kept, name))
    };
    let (own, sheared) = (spun(false), spun(true));
    for (own, sheared) in own.iter().zip(sheared) {
        assert!(own.abs() > 9.0 && (own - sheared).abs() < 0.05, "{own} for {sheared}");
    }
}

/// Goal: a rotational spring winds up over full turns. A rod that spins about a spring at its root comes to rest where the spring has all of its energy, `kφ²/2`,
/// as one does whose sections shear; a run that goes on from a checkpoint repeats it. Before, the spring gave back at π what it had taken, and the rod spun on.
#[test]
fn a_rotational_spring_winds_up() {
    let wound = |sheared: bool| {
        let spring = json!([{"at": 0, "stiffness_rotation_n_m_rad": 5e-4}]);
        let time = json!({"end_s": 2, "output_interval_s": 0.1, "checkpoint_interval_s": 1});
        let mut case = rod(json!({"root": "pinned", "tip": "free"}), spring, time, sheared);
        case["start"] = json!({"u1_rate_m_s": {"polynomial": {"coefficients": [0, 2]}}});
        case["solver"] = json!({"rtol": 1e-7});
        parse(&case)
    };
    let mut kept = Memory::default();
    let outcome = dynamics::run(&wound(false), &mut kept).unwrap();
    let (angle, taken) = (last(&kept, "tip_angle"), kept.column("kinetic_energy").unwrap()[0]);
    assert!((0.5 * 5e-4 * angle * angle / taken - 1.0).abs() < 0.02, "{angle}");
    assert!(outcome.summary.balances.energy_residual_relative < 1e-4);
    let mut rest = Memory::default();
    let checkpoint = &kept.checkpoints[0];
    dynamics::resume(
        &wound(false),
        System::new(&wound(false)).unwrap(),
        checkpoint,
        &mut rest,
    )
    .unwrap();
    assert_eq!(rest.rows[..], kept.rows[checkpoint.next_output as usize..]);
    let mut sheared = Memory::default();
    dynamics::run(&wound(true), &mut sheared).unwrap();
    let other = last(&sheared, "tip_angle");
    assert!((angle - other).abs() < 1e-3, "{angle} for {other}");
}

/// Goal: so at rest: a couple at the tip bends the beam beyond π against a spring there, `φ (EI/L + k) = M`, to the first order in h/L of such a spring, in a run and along
/// the path of equilibria. Before, that ended at 3.3 rad with words of paths that meet, and the run jumped to 7.3.
#[test]
fn a_spring_at_the_tip_is_bent_beyond_half_a_turn() {
    let ends = json!({"root": "clamped", "tip": {"free": {"moment_n_m": -0.016}}});
    let spring = json!([{"at": 1, "stiffness_rotation_n_m_rad": 0.002}]);
    let mut case = rod(ends, spring, json!({"end_s": 1}), false);
    case["beam"]["height_m"] = 0.002.into();
    let case = parse(&case);
    let path = follow(&case, &EquilibriumOptions::at(0.0), &mut |_| Control::Continue).unwrap();
    let found = path.last();
    assert!((found.load_factor() - 1.0).abs() < 1e-12, "{}", found.load_factor());
    let place = columns(&system(&case, 0.0).unwrap())
        .iter()
        .position(|column| column.name == "tip_angle")
        .unwrap();
    assert!((found.row[place] - 4.0).abs() < 0.25, "{}", found.row[place]);

    let mut moving = case;
    moving.start.equilibrium = Some(slcbeam::case::schema::EquilibriumStart::default());
    moving.time.end_s = 0.01;
    let mut kept = Memory::default();
    let outcome = dynamics::run(&moving, &mut kept).unwrap();
    assert_eq!(outcome.summary.status, Status::Finished);
    assert!((last(&kept, "tip_angle") - found.row[place]).abs() < 1e-6);
}
