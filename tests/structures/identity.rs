//! Beams that are cut and joined again, and structures that are turned or mirrored.
//!
//! Source: the single beam; symmetry. Goal: a rigid joint in one line adds nothing to the equations, so that results agree to rounding.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::record::{Control, Memory};

use crate::plans::{beam, held, joint, section, structure};
use crate::scene::{finished, parse};

/// A shipped case in the form that structures have: all effects, conservative, second order.
fn shipped(name: &str) -> Value {
    let text = std::fs::read_to_string(format!("cases/{name}.json")).unwrap();
    let mut case: Value = serde_json::from_str(&text).unwrap();
    let members = case.as_object_mut().unwrap();
    for key in ["$schema", "effects_tolerance", "step_response"] {
        members.remove(key);
    }
    case["effects"] = json!("full");
    case["formulation"] = json!("conservative");
    case["companion"] = json!("off");
    case["solver"] = json!({"rtol": 1e-9});
    if name == "tank-finger" {
        case["time"]["end_s"] = json!(0.5); // while its valve is open
    }
    case
}

fn read(case: &Value) -> Case {
    case::parse(&case.to_string(), Path::new("test.json"), Path::new("cases"), &[])
        .map_err(|e| format!("{e:?}"))
        .unwrap()
}

/// The case cut behind segment `behind`, as beams a and b.
fn cut(case: &Value, behind: usize) -> Value {
    let whole = read(case);
    let segments = match &whole.bladders {
        Some(bladders) => bladders.per_row,
        None => whole.mesh.segments.unwrap_or(10),
    };
    let mut case = case.clone();
    let members = case.as_object_mut().unwrap();
    let ends = members.remove("ends").unwrap();
    let share = behind as f64 / segments as f64;
    let length = whole.beam.length_m;
    let mut a = json!({"name": "a", "segments": behind, "length_m": length * share, "ends": {"root": ends["root"]}});
    let mut b = json!({"name": "b", "segments": segments - behind, "length_m": length * (1.0 - share), "ends": {"tip": ends["tip"]}});
    for key in ["attachments", "probes"] {
        let Some(Value::Array(parts)) = members.remove(key) else {
            continue;
        };
        for mut part in parts {
            let at = part["at"].as_f64().unwrap();
            let (own, at) = match at <= share {
                true => (&mut a, (at / share).min(1.0)),
                false => (&mut b, (at - share) / (1.0 - share)),
            };
            part["at"] = json!(at);
            match own.get_mut(key).and_then(Value::as_array_mut) {
                Some(all) => all.push(part),
                None => own[key] = json!([part]),
            }
        }
    }
    members.insert("beams".into(), json!([a, b]));
    members.insert("joints".into(), json!([joint("rigid", &["a.tip", "b.root"])]));
    case
}

/// Names, units and values in the equilibrium at the end.
fn at_rest(case: &Value) -> Vec<(String, &'static str, f64)> {
    let case = read(case);
    let at = case.time.end_s;
    let path = follow(&case, &EquilibriumOptions::at(at), &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none(), "{}: {:?}", case.name, path.fault);
    let columns = columns(&system(&case, at).unwrap()).into_iter();
    let values = path.last().row.clone().into_iter();
    columns.zip(values).map(|(c, value)| (c.name, c.unit, value)).collect()
}

/// The column of the cut case that has the quantity of a column of the whole one.
fn names_in_parts(name: &str) -> [String; 3] {
    match name.starts_with("tip_") {
        true => [format!("b.{name}"), String::new(), String::new()],
        false => [name.to_owned(), format!("a.{name}"), format!("b.{name}")],
    }
}

/// Goal: equilibria of shipped cases, cut at three places, are those of the single beam.
/// Tolerance: 1e-10 of the largest value of the same unit. Newton's iteration stops within that.
#[test]
fn cut_beams_rest_as_whole_ones() {
    for (name, places) in [
        ("bend-wet", [1, 4, 9]),
        ("bend-sheared", [1, 5, 9]),
        ("syringe-finger", [1, 6, 9]),
        ("tank-finger", [1, 5, 9]),
        ("finger-wall", [1, 4, 7]),
        ("finger-disc", [2, 12, 28]),
        ("curl", [1, 15, 29]),
        ("roll-up", [1, 8, 19]),
        ("ecoflex-actuator", [1, 3, 6]),
        ("tip-mass", [1, 4, 8]),
    ] {
        let whole = at_rest(&shipped(name));
        for behind in places {
            let parts = at_rest(&cut(&shipped(name), behind));
            let (mut worst, mut compared) = ((0.0, String::new()), 0);
            let largest = |unit: &str| {
                let same = whole.iter().filter(|(_, own, _)| *own == unit);
                same.fold(0.0_f64, |most, (_, _, value)| most.max(value.abs()))
            };
            for (column, unit, value) in &whole {
                let known = names_in_parts(column);
                let Some((_, _, found)) = known.iter().find_map(|name| parts.iter().find(|(own, ..)| own == name))
                else {
                    continue;
                };
                compared += 1;
                // forces and couples that do work over 0.1 m or a radian
                let size = match *unit {
                    "N" => largest("N").max(10.0 * largest("J")),
                    "N m" => largest("N m").max(largest("J")),
                    "W" => 1e-12,
                    unit => largest(unit),
                };
                let off = (found - value).abs() / value.abs().max(1e-3 * size).max(f64::MIN_POSITIVE);
                if off > worst.0 {
                    worst = (off, format!("{column} {value:e} {found:e}"));
                }
            }
            println!(
                "{name} behind {behind}: {compared} compared, worst {:.1e} {}",
                worst.0, worst.1
            );
            assert!(compared > 4 && worst.0 < 1e-10, "{name} behind {behind}: {worst:?}");
        }
    }
}

/// Largest difference of columns between a run of a shipped case and one that is cut, relative to the largest value of each.
fn moved_apart(name: &str, damping: Value, behind: usize, cells: usize, end: f64, columns: &[&str]) -> f64 {
    let mut case = shipped(name);
    case["time"] = json!({"end_s": end});
    case["beam"]["damping"] = damping;
    case["mesh"]["cells_per_segment"] = json!(cells);
    let [whole, parts] = [case.clone(), cut(&case, behind)].map(|case| {
        let mut memory = Memory::default();
        let outcome = dynamics::run(&read(&case), &mut memory).unwrap();
        assert!(outcome.fault.is_none(), "{name}: {:?}", outcome.fault);
        memory
    });
    let apart = columns.iter().map(|column| {
        let other = names_in_parts(column).iter().find_map(|name| parts.column(name));
        let off = largest_difference(&whole.column(column).unwrap(), &other.unwrap(), 1.0);
        println!("{name}, {cells} cells per segment, {column}: {off:.1e}");
        off
    });
    apart.fold(0.0, f64::max)
}

/// Largest difference of two columns, the second with a sign, relative to the largest value of the first.
fn largest_difference(ours: &[f64], theirs: &[f64], sign: f64) -> f64 {
    let size = ours.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(size > 1e-7, "nothing moves");
    let off = ours.iter().zip(theirs).map(|(a, b)| (a - sign * b).abs() / size);
    off.fold(0.0, f64::max)
}

/// Goal: damped motion of a wet and of a dry beam, cut, is that of the whole beam. Errors in time, rtol 1e-9: 1e-7 of the largest value.
#[test]
fn cut_beams_move_as_whole_ones() {
    let columns = ["tip_u1", "tip_u3", "tip_angle", "kinetic_energy", "bending_energy"];
    let viscous = json!({"bending_time_s": 5e-3, "axial_time_s": 5e-3});
    assert!(moved_apart("roll-up", viscous, 7, 4, 0.2, &columns) < 1e-7);
    let drag = json!({"drag_n_s_m2": 20, "axial_time_s": 5e-3});
    let wet = [&columns[..], &["bladder_energy", "dissipated_bladders"]].concat();
    assert!(moved_apart("bend-sheared", drag, 4, 2, 0.06, &wet) < 1e-7);
}

/// Goal: a viscous wet beam is one with its parts in the limit of fine meshes. A joint has the elastic moments of both sides of a node between
/// unlike pressures, a whole beam their mean: half the difference with twice the cells.
#[test]
fn viscous_wet_beams_are_whole_ones_in_the_limit() {
    let apart = [1, 2, 4].map(|cells| {
        let viscous = json!({"bending_time_s": 5e-3, "axial_time_s": 5e-3});
        moved_apart("bend-sheared", viscous, 4, cells, 0.06, &["bladder_energy"])
    });
    let halved = |pair: &[f64]| (0.4..0.6).contains(&(pair[1] / pair[0]));
    assert!(apart[0] < 1e-4 && apart.windows(2).all(halved), "{apart:?}");
}

/// A clamped L with gravity, a hinge with a spring, a third beam, bladders in the first; turned, and mirrored for `side` -1.
fn arms(turn: f64, side: f64) -> Value {
    let row = side as i64;
    let chain: Vec<String> = (1..=4).map(|k| format!("a:{}", row * k)).collect();
    let place = |name: &str, degrees: f64| beam(name, 0.04, side * degrees + turn, 4);
    let gravity = 9.81;
    let (x, z) = (
        -gravity * turn.to_radians().cos() * side,
        gravity * turn.to_radians().sin() * side,
    );
    // first moments turn as vectors; their mirrored couples have the other sign
    let (sin, cos) = turn.to_radians().sin_cos();
    let b = (0.05 * cos + 0.03 * side * sin, 0.03 * side * cos - 0.05 * sin);
    let moment = |key: &str, value: f64| json!({key: {"signal": value}});
    let hinge =
        json!({"at": ["b.tip", "c.root"], "kind": {"hinge": {"stiffness_n_m_rad": 0.05, "damping_n_m_s_rad": 1e-3}}});
    json!({
        "name": "arms", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"},
        "beam": {"damping": {"bending_time_s": 5e-3, "axial_time_s": 5e-3}},
        "beams": [held(place("a", 20.0), "root", json!("clamped")), place("b", -50.0), place("c", 10.0)],
        "joints": [joint("rigid", &["a.tip", "b.root"]), hinge],
        "network": {"chains": [{"bladders": chain, "ends": [{"pressure_pa": {"ramp": {"to": 5000, "duration_s": 0.02}}}, "sealed"]}]},
        "loads": [{"gravity": {"x_m_s2": x, "z_m_s2": z}}, moment("moment_x_n", b.0), moment("moment_z_n", b.1)],
        "effects": "full", "companion": "off",
        "mesh": {"cells_per_segment": 2}, "time": {"end_s": 0.03}, "solver": {"rtol": 1e-9}
    })
}

/// Goal: motion in the axes of the beams does not depend on the direction in which the structure is placed, and mirrors with it. Steps of the
/// integrator follow rounding errors; the rest are those in time at rtol 1e-9.
#[test]
fn turned_and_mirrored_structures_move_alike() {
    let plain = finished(&arms(0.0, 1.0)).0;
    for (what, turn, side) in [("turned", 73.0, 1.0), ("mirrored", 0.0, -1.0), ("both", -130.0, -1.0)] {
        let other = finished(&arms(turn, side)).0;
        for name in ["a", "b", "c"] {
            for (column, sign) in [("tip_u1", side), ("tip_u3", 1.0), ("tip_angle", side)] {
                let column = format!("{name}.{column}");
                let [ours, theirs] = [&plain, &other].map(|memory| memory.column(&column).unwrap());
                let off = largest_difference(&ours, &theirs, sign);
                println!("{what} {column}: {off:.1e}");
                assert!(off < 1e-8, "{what} {column}: {off:.1e}");
            }
        }
    }
}

/// Goal: equilibria of turned and mirrored structures agree to rounding.
#[test]
fn turned_and_mirrored_structures_rest_alike() {
    let plain = at_rest(&arms(0.0, 1.0));
    for (what, turn, side) in [("turned", 73.0, 1.0), ("mirrored", 0.0, -1.0), ("both", -130.0, -1.0)] {
        let other = at_rest(&arms(turn, side));
        for (name, _, value) in &plain {
            let sign = match name.rsplit_once('_').map(|(_, last)| last) {
                _ if name.ends_with("reaction_root_x") => side,
                Some("u1" | "angle" | "couple") => side,
                Some("u3" | "energy") => 1.0,
                _ => continue,
            };
            let found = other.iter().find(|(own, ..)| own == name).unwrap().2 * sign;
            assert!(
                (found - value).abs() <= 1e-10 * value.abs().max(1e-6),
                "{what} {name}: {found:e} for {value:e}"
            );
        }
    }
}

/// A finger or three of them behind a feed tube of this length.
fn fingers(count: usize, feed_m: f64, tube_inertia: &str) -> Value {
    let bladders = |name: &str| (1..=4).map(|k| format!("{name}:{k}")).collect::<Vec<_>>();
    let names = ["a", "b", "c"];
    let ramp = json!({"ramp": {"to": 8000, "duration_s": 0.05}});
    let names = &names[..count];
    let tubes = names
        .iter()
        .map(|name| json!({"from": {"junction": "manifold"}, "to": {"bladder": format!("{name}:1"), "end": "inlet"}}));
    let feed = json!({"from": {"junction": "in"}, "to": {"junction": "manifold"}, "length_m": feed_m});
    let beams = names.iter().enumerate().map(|(k, name)| {
        let mut finger = held(beam(name, 0.04, 0.0, 4), "root", json!("clamped"));
        finger["origin_m"] = json!([0.1 * k as f64, 0.0]);
        finger
    });
    let beams: Vec<Value> = beams.collect();
    json!({
        "name": "fingers", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"},
        "beam": {"damping": {"bending_time_s": 5e-3, "axial_time_s": 5e-3}},
        "beams": beams,
        "network": {
            "chains": names.iter().map(|name| json!({"bladders": bladders(name), "ends": ["connected", "sealed"]})).collect::<Vec<_>>(),
            "junctions": ["in", "manifold"], "ports": [{"name": "in", "at": {"junction": "in"}, "pressure_pa": ramp}],
            "tubes": tubes.chain([feed]).collect::<Vec<_>>()
        },
        "effects": {"tube_losses": "off", "tube_inertia": tube_inertia}, "companion": "off",
        "mesh": {"cells_per_segment": 1}, "time": {"end_s": 0.1}, "solver": {"rtol": 1e-9}
    })
}

/// Goal: three equal fingers behind a junction move as one whose feed has three times the resistance and inertance. Errors in time, rtol 1e-9.
#[test]
fn three_fingers_on_a_manifold_move_as_one() {
    for inertia in ["off", "on"] {
        let [one, three] = [(1, 0.15), (3, 0.05)].map(|(count, feed)| finished(&fingers(count, feed, inertia)).0);
        let alone = one.column("a.tip_u1").unwrap();
        for name in ["a", "b", "c"] {
            let own = three.column(&format!("{name}.tip_u1")).unwrap();
            let off = largest_difference(&alone, &own, 1.0);
            println!("tube inertia {inertia}, {name}: {off:.1e}");
            assert!(off < 1e-7, "{inertia} {name}: {off:.1e}");
        }
        // a shorter feed is another system
        let other = finished(&fingers(1, 0.05, inertia)).0.column("a.tip_u1").unwrap();
        let off = largest_difference(&alone, &other, 1.0);
        assert!(off > 1e-4, "the feed matters: {off:.1e}");
    }
}

/// Goal: straight beams in one line are one beam at any number of joints; a rigid arm between two places carries forces as a rigid body.
#[test]
fn places_apart_are_joined_by_a_rigid_body() {
    // a clamped beam, a rigid arm of 0.3 across, a beam that continues: the moment of the force at the tip is F (L - z), as without the arm,
    // plus F_z times the arm
    let arm = 0.3;
    let of = |segments: usize| {
        let a = held(beam("a", 1.0, 0.0, segments), "root", json!("clamped"));
        let mut b = held(
            beam("b", 1.0, 0.0, segments),
            "tip",
            json!({"free": {"force_z_n": 1e-6}}),
        );
        b["origin_m"] = json!([arm, 1.0]);
        structure(
            section([1e6, 1.0, 1.0]),
            vec![a, b],
            vec![joint("rigid", &["a.tip", "b.root"])],
        )
    };
    let last = crate::plans::at_rest(&of(16));
    // M = F a along beam a: the joint turns by F a L/EI to the side of -x, beam b keeps straight and turns with it
    let angle = -1e-6 * arm;
    for (name, exact) in [
        ("a.tip_angle", angle),
        ("a.tip_u1", 0.5 * angle),
        ("b.tip_angle", angle),
        ("b.tip_u1", 1.5 * angle),
    ] {
        // second order in the angles, of the load and of the chords: 1e-6
        assert!(
            (last(name) / exact - 1.0).abs() < 3e-6,
            "{name}: {} for {exact}",
            last(name)
        );
    }
    let along = 1e-6 / 1e6 - angle * arm;
    assert!(
        (last("b.tip_u3") - along - 1e-6 / 1e6).abs() < 1e-5 * along,
        "{}",
        last("b.tip_u3")
    );
    parse(&of(4));
}
