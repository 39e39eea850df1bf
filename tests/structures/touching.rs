//! Contact of beams with each other and of a beam with itself, [E107].
//!
//! Source: the law of contact, [E61]; momentum and energy of free beams; the thickness of a rolled strip.

use serde_json::{Value, json};

use crate::balances::close;
use crate::plans::{at_rest, beam, held, structure};
use crate::scene::finished;

/// Section of 0.02 m height with `EA` = 4e3 N and `EI` = 0.133 N m^2, 0.4 kg/m.
fn strip() -> Value {
    json!({"height_m": 0.02, "width_m": 0.02, "young_modulus_pa": 1e7, "density_kg_m3": 1000,
        "damping": {"bending_time_s": 2e-3, "axial_time_s": 2e-3}})
}

fn touching(between: Value) -> Value {
    json!({"name": "both", "between": between, "stiffness_pa": 1e5, "smoothing_m": 1e-3})
}

/// Two beams side by side along z, 0.021 m apart.
fn side_by_side(how: &Value) -> [Value; 2] {
    [("left", 0.0), ("right", 0.021)].map(|(name, x)| {
        let mut own = held(held(beam(name, 0.2, 0.0, 10), "root", how.clone()), "tip", how.clone());
        own["origin_m"] = json!([x, 0.0]);
        own
    })
}

/// Goal: two stiff beams, of which one is moved against the other, press on each other along their length as the law of contact says of their
/// overlap.
#[test]
fn beams_pressed_together_overlap_by_the_law() {
    for (overlap, load) in [(4e-4, 1e5 * 4e-4 * 4e-4 / 2e-3), (2.5e-3, 1e5 * (2.5e-3 - 0.5e-3))] {
        let moved = 1e-3 + overlap;
        let [left, right] = side_by_side(&json!("clamped"));
        let driven = json!({"clamped": {"u1_m": moved}});
        let left = held(held(left, "root", driven.clone()), "tip", driven);
        let mut case = structure(strip(), vec![left, right], vec![]);
        case["beam"]["young_modulus_pa"] = json!(1e13);
        case["beam_contacts"] = json!([touching(json!(["left", "right"]))]);
        let last = at_rest(&case);
        println!("{load} N/m: {}", last("beam_contact_both_normal_force"));
        assert!((last("beam_contact_both_depth") - overlap).abs() < 1e-6 * overlap);
        for (name, sign) in [("left", -1.0), ("right", 1.0)] {
            let both = last(&format!("{name}.reaction_root_x")) + last(&format!("{name}.reaction_tip_x"));
            assert!((both + sign * 0.2 * load).abs() < 1e-5 * 0.2 * load, "{name} {both}");
        }
        assert!((last("beam_contact_both_normal_force") - 0.2 * load).abs() < 1e-5 * 0.2 * load);
    }
}

/// Goal: a free beam that strikes another one hands over its momentum; all balances close, and the distance never falls below the overlap that
/// its energy allows.
#[test]
fn a_free_beam_strikes_another_one() {
    let [mut left, right] = side_by_side(&json!("free"));
    let push = json!({"product": [3.0, {"ramp": {"from": 0, "to": 1, "start_s": 0, "duration_s": 0.01, "shape": "smooth"}},
        {"ramp": {"from": 1, "to": 0, "start_s": 0.02, "duration_s": 0.01, "shape": "smooth"}}]});
    left["loads"] = json!([{"force_x_n_m": {"signal": push}}]);
    let mut case = structure(strip(), vec![left, right], vec![]);
    let mut contact = touching(json!(["left", "right"]));
    contact["damping_s_m"] = json!(0.5);
    case["beam_contacts"] = json!([contact]);
    case["solver"] = json!({"rtol": 1e-8});
    case["time"] = json!({"end_s": 0.2, "output_interval_s": 1e-3});
    let (memory, summary) = finished(&case);
    close("strike", &summary, 1e-5);
    let column = |name: &str| memory.column(name).unwrap();
    let (force, depth) = (
        column("beam_contact_both_normal_force"),
        column("beam_contact_both_depth"),
    );
    let most = |of: &[f64]| of.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    println!("largest force {}, depth {}", most(&force), most(&depth));
    assert!(most(&force) > 1.0 && most(&depth) < 2e-3);
    // afterwards the struck beam is faster
    let travelled = |name: &str| {
        let all = column(name);
        all[all.len() - 1] - all[all.len() - 21]
    };
    let (left, right) = (travelled("left.tip_u1"), travelled("right.tip_u1"));
    assert!(right > left && right > 1e-4, "{left} {right}");
    assert!(*force.last().unwrap() < 1e-12, "they separate");
}

/// Goal: a strip that its tip moment rolls up by more than a turn lies on itself instead of crossing.
#[test]
fn a_rolled_strip_lies_on_itself() {
    let turn = |turns: f64| 1e7 * 0.02 * f64::powi(0.02, 3) / 12.0 * std::f64::consts::TAU * turns;
    let mut case = json!({
        "name": "rolled", "beam": strip(), "ends": {"root": "clamped", "tip": {"free": {"moment_n_m":
            {"ramp": {"from": 0, "to": turn(1.15), "start_s": 0, "duration_s": 1.0, "shape": "smooth"}}}}},
        "loads": [{"force_x_n_m": {"signal": 0.05}}],
        "mesh": {"segments": 40, "cells_per_segment": 1}, "companion": "off", "time": {"end_s": 2.5},
        "solver": {"rtol": 1e-6}
    });
    case["beam"]["length_m"] = json!(1.0);
    case["beam"]["damping"]["drag_n_s_m2"] = json!(4.0);
    let mut touching = |stiffness: f64| {
        case["beam_contacts"] = json!([{"name": "self", "stiffness_pa": stiffness, "smoothing_m": 1e-3,
            "damping_s_m": 0.5, "friction_coefficient": 0.1, "friction_velocity_m_s": 0.01}]);
        let (memory, summary) = finished(&case);
        close("rolled", &summary, 1e-4);
        let column = |what: &str| memory.column(&format!("beam_contact_self_{what}")).unwrap();
        let [force, depth] = [column("normal_force"), column("depth")];
        let deepest = depth.iter().copied().fold(0.0, f64::max);
        println!("stiffness {stiffness}: force {:?}, deepest {deepest}", force.last());
        (*force.last().unwrap(), deepest)
    };
    // almost without contact it passes through itself
    let (_, through) = touching(1e-6);
    let (force, deepest) = touching(1e5);
    assert!(through > 0.01, "{through}");
    assert!(force > 0.1 && deepest > 0.0 && deepest < 4e-3, "{force} {deepest}");
}

/// Goal: fingers of one palm, closer to each other than half a turn, touch away from it.
#[test]
fn fingers_of_one_palm_touch() {
    let mut palm = held(beam("palm", 0.05, 0.0, 2), "root", json!("clamped"));
    palm["origin_m"] = json!([0.0125, -0.05]);
    palm["beam"] = json!({"young_modulus_pa": 1e9});
    let fingers = [("left", 0.0, 40.0), ("right", 0.025, -40.0)].map(|(name, x, load)| {
        let mut own = beam(name, 0.4, 0.0, 16);
        own["origin_m"] = json!([x, 0.0]);
        own["loads"] = json!([{"force_x_n_m": {"signal": load}}]);
        own
    });
    let [left, right] = fingers;
    let joints = vec![crate::plans::joint("rigid", &["palm.tip", "left.root", "right.root"])];
    let mut case = structure(strip(), vec![palm, left, right], joints);
    case["beam_contacts"] = json!([touching(json!(["left", "right"]))]);
    let last = at_rest(&case);
    let apart = last("right.tip_x") - last("left.tip_x");
    println!("{apart} m apart, {} N", last("beam_contact_both_normal_force"));
    assert!((0.0175..0.02).contains(&apart), "{apart}");
    assert!(last("beam_contact_both_normal_force") > 1.0);
}
