//! Derivatives of structures, and what is done at every step.
//!
//! Source: coloured central differences at random states. Goal: the Jacobian is that of the residual, and no call allocates.

use serde_json::{Value, json};
use slcbeam::dae::{BeamDae, Dae, Seeds};
use slcbeam::discrete::{System, start};

use crate::chance::Random;
use crate::differences::worst_difference;
use crate::plans::{beam, held, joint};
use crate::scene::parse;

/// A clamped frame of four beams, wet or dry: a rigid joint of three at angles, a rigid arm, a hinge with all its moments to a beam whose tip
/// is driven, a body at a joint.
fn frame(preset: bool, more: &[(&str, Value)]) -> Value {
    let driven = json!({"pinned": {"u1_m": {"sine": {"amplitude": 1e-3, "frequency_hz": 40, "ramp_cycles": 1}}}});
    let mut apart = beam("d", 0.04, 140.0, 3);
    apart["origin_m"] = json!([0.03, 0.05]);
    apart["ends"]["tip"] = json!({"free": {"follower_shear_n": 0.3, "moment_n_m": 0.01}});
    apart["loads"] = json!([{"moment_z_n": {"signal": 0.2}}]);
    let mut b = beam("b", 0.05, 80.0, 4);
    b["attachments"] = json!([{"at": 0.4, "mass_kg": 0.01, "stiffness_x_n_m": 20.0, "offset_across_m": 0.003}]);
    let beams = [
        held(beam("a", 0.05, 15.0, 4), "root", json!("clamped")),
        b,
        held(beam("c", 0.05, -35.0, 4), "tip", driven),
        apart,
    ];
    let mut body = joint("rigid", &["a.tip", "b.root", "d.root"]);
    body["mass_kg"] = json!(0.02);
    body["rotary_inertia_kg_m2"] = json!(1e-5);
    let hinge = json!({"stiffness_n_m_rad": 0.3, "rest_rad": 0.1, "damping_n_m_s_rad": 0.01,
        "stop": {"from_rad": -0.02, "to_rad": 0.02, "stiffness_n_m_rad": 5.0, "smoothing_rad": 0.03}});
    let mut case = json!({
        "name": "frame", "beams": beams, "joints": [body, {"at": ["b.2", "c.root"], "kind": {"hinge": hinge}}],
        "beam": {"damping": {"bending_time_s": 2e-3, "axial_time_s": 1e-3, "drag_n_s_m2": 2.0}},
        "loads": [{"gravity": {"x_m_s2": -9.81, "z_m_s2": 2.0}}, {"force_x_n_m": {"signal": 20.0}}],
        "mesh": {"cells_per_segment": 1}, "companion": "off", "time": {"end_s": 0.05}
    });
    // the hinged beam begins where the divided one has its joint
    match preset {
        true => {
            case["preset"] = json!("matia-gat-beam");
            case["bladders"] = json!({"coupling": "reciprocal"});
            case["network"] = json!({
                "chains": [{"bladders": ["a:1", "a:2", "a:3", "a:4", "b:1", "b:2", "b:3", "b:4"], "ends": [{"pressure_pa": 3000}, "connected"]},
                           {"bladders": ["c:-1", "c:-2", "c:-3", "c:-4"], "ends": ["connected", "sealed"]}],
                "tubes": [{"from": {"bladder": "b:4", "end": "outlet"}, "to": {"bladder": "c:-1", "end": "inlet"}}]
            });
        }
        false => {
            for (key, value) in [
                ("height_m", 0.0216),
                ("width_m", 0.05),
                ("young_modulus_pa", 2e6),
                ("density_kg_m3", 950.0),
            ] {
                case["beam"][key] = json!(value);
            }
        }
    }
    for (pointer, value) in more {
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        let parent = if parent.is_empty() {
            &mut case
        } else {
            case.pointer_mut(parent).unwrap()
        };
        parent[key] = value.clone();
    }
    case
}

/// The wet frame with another kind of joint in place of its hinge.
fn jointed(kind: &Value) -> Value {
    let mut case = frame(true, &[]);
    case["joints"][1]["kind"] = kind.clone();
    case
}

/// The wet frame with another beam that overlaps its first one.
fn beside() -> Value {
    let touching = json!([{"name": "all", "stiffness_pa": 2e4, "smoothing_m": 1e-2, "damping_s_m": 0.5,
        "friction_coefficient": 0.3, "friction_velocity_m_s": 0.1}]);
    let mut case = frame(true, &[("/beam_contacts", touching)]);
    let mut other = held(beam("e", 0.05, 15.0, 4), "root", json!("clamped"));
    other["origin_m"] = json!([-0.018, 0.0]);
    case["beams"].as_array_mut().unwrap().push(other);
    case
}

/// Wet and dry frames with every further effect of a beam.
fn frames() -> Vec<(&'static str, Value)> {
    let relaxing = json!({"prony": [{"modulus_ratio": 0.5, "time_s": 0.02}]});
    let off = |effect: &str| ("/effects", json!({effect: "off"}));
    vec![
        ("wet", frame(true, &[])),
        ("dry", frame(false, &[])),
        ("sheared", frame(false, &[("/beam/shear_stiffness_n", json!(500.0))])),
        (
            "wet and sheared",
            frame(true, &[("/beam/shear_stiffness_n", json!(91.2))]),
        ),
        ("relaxing", frame(false, &[("/beam/viscoelasticity", relaxing.clone())])),
        (
            "relaxing, wet and sheared",
            frame(
                true,
                &[
                    ("/beam/viscoelasticity", relaxing),
                    ("/beam/shear_stiffness_n", json!(91.2)),
                ],
            ),
        ),
        (
            "with an elastic joint",
            jointed(&json!({"elastic": {
            "stiffness": [[300.0, 40.0, 2.0], [40.0, 500.0, -3.0], [2.0, -3.0, 0.4]],
            "damping": [[1.0, 0.2, 0.01], [0.2, 2.0, 0.02], [0.01, 0.02, 0.005]]}})),
        ),
        (
            "with a slider",
            jointed(&json!({"slider": {"angle_rad": 0.4, "wall_stiffness_n_m": 5e3,
            "turning_stiffness_n_m_rad": 0.3, "stiffness_n_m": 40.0, "damping_n_s_m": 0.5}})),
        ),
        ("touching each other", beside()),
        ("without rotary inertia", frame(true, &[off("rotary_inertia")])),
        ("without inertia", frame(true, &[off("solid_inertia")])),
        (
            "touching a circle",
            frame(
                true,
                &[(
                    "/contacts",
                    json!([{"name": "disc", "circle": {"center_m": [0.0, 0.02], "radius_m": 0.018},
                "stiffness_pa": 2e5, "smoothing_m": 5e-3, "damping_s_m": 1.0, "friction_coefficient": 0.4, "friction_velocity_m_s": 1e-1}]),
                )],
            ),
        ),
    ]
}

#[test]
fn jacobian_agrees_with_coloured_differences() {
    for (what, case) in frames() {
        let mut dae = BeamDae::new(System::new(&parse(&case)).unwrap());
        for (seed, size) in [(1, 1.0), (2, 0.3), (3, 0.03)] {
            let worst = worst_difference(&mut dae, seed, size);
            println!("{what}, {} unknowns, {size}: {worst:.1e}", dae.len());
            assert!(worst < 1e-6, "{what}, size {size}: {worst:.1e}");
        }
    }
}

/// Goal: the states above touch: beams and circle press at the start.
#[test]
fn beams_and_circle_press() {
    for (what, contact) in [
        ("touching each other", "beam_contacts"),
        ("touching a circle", "contacts"),
    ] {
        let pressed = [1.0, 2.0].map(|factor| {
            let (_, mut case) = frames().into_iter().find(|(name, _)| *name == what).unwrap();
            case[contact][0]["stiffness_pa"] = json!(2e4 * factor);
            let case = parse(&case);
            let mut dae = BeamDae::new(System::new(&case).unwrap());
            let (system, now) = dae.instant(0.0);
            let y = start::state(system, &case, now);
            let mut residual = vec![0.0; y.len()];
            dae.residual(0.0, &y, &vec![0.0; y.len()], &mut residual).unwrap();
            residual
        });
        let change = pressed[0].iter().zip(&pressed[1]).map(|(a, b)| (a - b).abs());
        assert!(change.fold(0.0, f64::max) > 1e-3, "{what}");
    }
}

#[test]
fn no_call_allocates() {
    const CALLS: usize = 50;
    for (what, case) in frames() {
        let case = parse(&case);
        let mut dae = BeamDae::new(System::new(&case).unwrap());
        let (system, now) = dae.instant(0.0);
        let begin = start::state(system, &case, now);
        let random = &mut Random(1);
        let mut near = |around: &[f64]| -> Vec<Vec<f64>> {
            let mut one = || around.iter().map(|x| x + random.between(-1e-3, 1e-3)).collect();
            (0..CALLS + 2).map(|_| one()).collect()
        };
        let (states, rates) = (near(&begin), near(&vec![0.0; begin.len()]));
        let mut residual = vec![0.0; begin.len()];
        let mut values = vec![0.0; dae.pattern().entries()];
        let mut integrands = vec![0.0; dae.integrals()];
        let mut all = |k: usize| {
            let t = case.time.end_s * k as f64 / CALLS as f64;
            dae.residual(t, &states[k], &rates[k], &mut residual).unwrap();
            dae.jacobian(t, &states[k], &rates[k], Seeds::Step { cj: 37.0 }, &mut values)
                .unwrap();
            dae.integrands(t, &states[k], &rates[k], &mut integrands).unwrap();
        };
        (0..2).for_each(&mut all);
        let counted = allocation_counter::measure(|| (2..CALLS + 2).for_each(&mut all));
        assert_eq!(counted.count_total, 0, "{what}");
    }
}
