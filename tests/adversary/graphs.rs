//! Graphs of beams: chains, forks, portals and beams side by side, with rigid joints, hinges and elastic ones, on the network of a scene.

use std::f64::consts::FRAC_PI_2;

use serde_json::{Value, json};

use crate::chance::Random;
use crate::digits::short;
use crate::scene::Beam;

/// Turns a scene of one beam into one of several. Its network is that of the first beam; what only a single beam has is left out.
pub fn add(r: &mut Random, b: &Beam, case: &mut Value, wet: bool) {
    let scene = case.as_object_mut().expect("a scene");
    for key in [
        "attachments",
        "foundation",
        "surroundings",
        "rotating_frame",
        "probes",
        "step_response",
        "formulation",
        "ends",
    ] {
        scene.remove(key);
    }
    if let Some(start) = scene.get_mut("start").and_then(Value::as_object_mut) {
        start.retain(|key, _| key == "pressures" || key == "equilibrium");
    }
    let angle = |r: &mut Random| r.between(-1.5, 1.5);
    let named = |k: usize, angle: f64| json!({"name": format!("b{k}"), "angle_rad": short(angle)});
    let clamped = |mut beam: Value| {
        beam["ends"] = json!({"root": "clamped"});
        beam
    };
    let first = clamped(named(0, angle(r)));
    let (beams, joints) = match r.below(4) {
        0 => {
            let count = 2 + r.below(3);
            let joints = (1..count).map(|k| {
                let at = json!([format!("b{}.tip", k - 1), format!("b{k}.root")]);
                joint(r, b, at)
            });
            let joints: Vec<Value> = joints.collect();
            let rest = (1..count).map(|k| named(k, angle(r)));
            (std::iter::once(first).chain(rest).collect(), joints)
        }
        1 => {
            let arms = [named(1, angle(r)), named(2, angle(r))];
            let body = r.one_in(2).then(|| b.mass * b.length * r.log(1e-2, 1.0));
            let mut branch = json!({"at": ["b0.tip", "b1.root", "b2.root"], "kind": {"rigid": {}}});
            if let Some(mass) = body {
                branch["mass_kg"] = short(mass);
                branch["rotary_inertia_kg_m2"] = short(mass * b.height * b.height);
            }
            let [left, right] = arms;
            (vec![first, left, right], vec![branch])
        }
        2 => {
            let [mut left, mut right] = [0, 2].map(|k| clamped(named(k, 0.0)));
            left["origin_m"] = json!([0.0, 0.0]);
            right["origin_m"] = json!([short(b.length), 0.0]);
            let girder = named(1, FRAC_PI_2);
            let corners = [["b0.tip", "b1.root"], ["b2.tip", "b1.tip"]];
            let mut girder = girder;
            girder["angle_rad"] = json!(FRAC_PI_2);
            let joints = corners.map(|at| json!({"at": at, "kind": {"rigid": {}}}));
            (vec![left, girder, right], joints.to_vec())
        }
        _ => {
            let mut second = clamped(named(1, angle(r)));
            second["origin_m"] = json!([short(b.length), 0.0]);
            (vec![first, second], vec![])
        }
    };
    if wet && beams.len() > 2 {
        let end = |beam: &str, end: &str| json!({"bladder": format!("{beam}:1"), "end": end});
        let tube = json!({"from": end("b1", "outlet"), "to": end("b2", "inlet")});
        match case.pointer_mut("/network/tubes").and_then(Value::as_array_mut) {
            Some(tubes) => tubes.push(tube),
            None => case["network"]["tubes"] = json!([tube]),
        }
    }
    case["beams"] = Value::Array(beams);
    case["joints"] = Value::Array(joints);
}

/// A joint of two beams; not free to turn, so that loads at rest have an equilibrium.
fn joint(r: &mut Random, b: &Beam, at: Value) -> Value {
    let stiff = b.ei / b.length;
    let kind = match r.below(3) {
        0 => json!({"hinge": {"stiffness_n_m_rad": short(stiff * r.log(0.1, 10.0)),
            "damping_n_m_s_rad": short(stiff * b.times.period * r.log(1e-3, 1e-1))}}),
        1 => {
            let across = stiff / (b.length * b.length) * r.log(1.0, 1e3);
            let turn = stiff * r.log(0.1, 10.0);
            json!({"elastic": {"stiffness": [[short(across), 0.0, 0.0], [0.0, short(across), 0.0], [0.0, 0.0, short(turn)]]}})
        }
        _ => json!({"rigid": {}}),
    };
    json!({"at": at, "kind": kind})
}
