//! Circles that the beam touches, [E85]: statics of discs, wrapped cantilevers, the limit of a wall, strikes.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::Case;
use slcbeam::case::parameter::Parameter;
use slcbeam::discrete::{System, resolution};
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, differentiate, follow, system};
use slcbeam::run::record::Control;

use super::{beam, parse, run};

/// Equilibrium under all loads: values of columns by name, and displacements of the nodes.
struct AtRest {
    columns: Vec<(String, f64)>,
    nodes: Vec<[f64; 2]>,
}

impl AtRest {
    fn new(case: &Case) -> Self {
        let path = follow(case, &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
        assert!(path.fault.is_none(), "{:?}", path.fault);
        let names = columns(&system(case, 1.0).unwrap()).into_iter().map(|c| c.name);
        let last = path.last();
        let nodes = last.u1.iter().zip(&last.u3).map(|(u1, u3)| [*u1, *u3]).collect();
        Self {
            columns: names.zip(last.row.iter().copied()).collect(),
            nodes,
        }
    }

    fn read(&self, name: &str) -> f64 {
        let found = self.columns.iter().find(|(one, _)| one == name);
        found.unwrap_or_else(|| panic!("no column {name}")).1
    }
}

fn disc(center: [f64; 2], radius: f64, more: Value) -> Value {
    let mut one =
        json!({"name": "disc", "circle": {"center_m": center, "radius_m": radius}, "reach_m": 0, "smoothing_m": 1e-5});
    for (key, value) in more.as_object().unwrap() {
        one[key] = value.clone();
    }
    one
}

/// Source: the penalty law, `k (g - d/2)` along the line from the center to the tip, with g from the tip's position. Goal: rounding errors; the
/// forces on the beam are in balance. Derivative of the linear deflection by the radius: `-k/(k + 3 EI/l³)`.
#[test]
fn a_disc_presses_the_tip_by_its_penalty_law() {
    let (center, radius, reach) = ([0.2, 0.95], 0.08, 0.01);
    let one = disc(center, radius, json!({"at": 1, "stiffness_n_m": 500, "reach_m": reach}));
    let case = parse(&beam(json!("clamped"), json!({"free": {"force_x_n": 3}}), json!([one])));
    let rest = AtRest::new(&case);
    let [u1, u3] = *rest.nodes.last().unwrap();
    let off = [u1 - center[0], 1.0 + u3 - center[1]];
    let distance = off[0].hypot(off[1]);
    let force = 500.0 * (radius + reach - distance - 5e-6);
    let [x, z] = ["x", "z"].map(|axis| rest.read(&format!("contact_disc_force_{axis}")));
    assert!(force > 1.0, "{force}");
    assert!((rest.read("contact_disc_normal_force") / force - 1.0).abs() < 1e-9);
    assert!(
        (x / (force * off[0] / distance) - 1.0).abs() < 1e-9 && (z / (force * off[1] / distance) - 1.0).abs() < 1e-9
    );
    assert!((rest.read("reaction_root_x") + x + 3.0).abs() < 1e-6 && (rest.read("reaction_root_z") + z).abs() < 1e-6);

    let mut case = beam(
        json!("clamped"),
        json!({"free": {"force_x_n": 0.1}}),
        json!([disc([0.051, 1.0], 0.05, json!({"at": 1, "stiffness_n_m": 500}))]),
    );
    case["effects"] = json!({"finite_rotation": "off", "axial_force_on_bending": "off"});
    let case = parse(&case);
    let pointer = "/contacts/0/circle/radius_m";
    let parameter = Parameter::find(&case, pointer).unwrap();
    let [less, more] =
        [0.0499, 0.0501].map(|radius| AtRest::new(&parameter.changed(&case, radius).unwrap()).read("tip_u1"));
    assert!(((more - less) / 2e-4 + 500.0 / 503.0).abs() < 1e-3, "{less} {more}");
}

/// Goal: derivatives of forces and tip by radius and center of a disc, which several nodes touch within the smoothing, are those of
/// differences of whole equilibria.
#[test]
fn derivatives_by_a_disc_are_those_of_differences() {
    let case = |radius: f64, center: f64| {
        let one = disc(
            [center, 0.6],
            radius,
            json!({"stiffness_pa": 1e5, "reach_m": 0.025, "smoothing_m": 1e-3}),
        );
        parse(&beam(
            json!("clamped"),
            json!({"free": {"force_x_n": -3}}),
            json!([one]),
        ))
    };
    let own = case(0.2, -0.3);
    let options = EquilibriumOptions::at(1.0);
    let path = follow(&own, &options, &mut |_| Control::Continue).unwrap();
    for (pointer, step) in [
        ("/contacts/0/circle/radius_m", [2e-6, 0.0]),
        ("/contacts/0/circle/center_m/0", [0.0, 2e-6]),
    ] {
        let by = Parameter::find(&own, pointer).unwrap();
        let found = differentiate(&own, &options, &path, std::slice::from_ref(&by)).unwrap();
        let [more, less] = [1.0, -1.0].map(|sign| AtRest::new(&case(0.2 + sign * step[0], -0.3 + sign * step[1])));
        for name in [
            "tip_u1",
            "contact_disc_force_x",
            "contact_disc_force_z",
            "reaction_root_couple",
        ] {
            let place = more.columns.iter().position(|(one, _)| one == name).unwrap();
            let difference = (more.read(name) - less.read(name)) / 4e-6;
            let derivative = found[0].row[place];
            assert!(
                (derivative / difference - 1.0).abs() < 1e-3,
                "{pointer} {name}: {derivative:e} {difference:e}"
            );
        }
    }
}

/// A cantilever of n cells, tangent at its root to a disc below, of which the tip is pulled down.
fn wrapped(cells: usize, bend_radius: f64, stiffness: f64, side: f64, tip: Value) -> Value {
    let one = disc(
        [-side * bend_radius, 0.0],
        0.9 * bend_radius,
        json!({"stiffness_pa": stiffness, "reach_m": 0.1 * bend_radius, "smoothing_m": 1e-9}),
    );
    let mut case = beam(json!("clamped"), tip, json!([one]));
    case["mesh"] = json!({"segments": cells, "cells_per_segment": 1});
    case
}

/// Source: a cantilever that a tip force F presses on a former of radius ρ (small slopes) lies on it up to s with `F (l - s) = EI/ρ`. There the former
/// presses it with F alone: up to s no force, curvature 1/ρ and moment EI/ρ. Its tip is at `s²/2ρ + s (l - s)/ρ + (l - s)²/3ρ`. Goal: the error of the
/// tip falls with the root of the stiffness, to 1e-4.
#[test]
fn a_cantilever_lies_on_a_former() {
    let (rho, force) = (100.0, 0.02);
    let free = 1.0 / (rho * force);
    let s = 1.0 - free;
    let exact = (0.5 * s * s + s * free + free * free / 3.0) / rho;
    let mut errors = vec![];
    for stiffness in [1e5, 1e7] {
        let mut case = wrapped(256, rho, stiffness, 1.0, json!({"free": {"force_x_n": -force}}));
        case["effects"] = json!({"finite_rotation": "off", "axial_force_on_bending": "off"});
        let rest = AtRest::new(&parse(&case));
        let error = rest.read("tip_u1") / -exact - 1.0;
        let [couple, normal] = ["reaction_root_couple", "contact_disc_normal_force"].map(|name| rest.read(name));
        println!("{stiffness:e}: {error:e} {couple} {normal}");
        errors.push([error, couple.abs() * rho - 1.0, normal / force - 1.0].map(f64::abs));
    }
    let order = (errors[0][0] / errors[1][0]).log(100.0);
    assert!(
        errors[1][0] < 1e-4 && errors[1][1] < 1e-3 && errors[1][2] < 1e-2,
        "{errors:?}"
    );
    assert!((order - 0.5).abs() < 0.15, "{errors:?} {order}");
}

/// Goal: at large rotations the beam on a disc has the curvature 1/ρ by less than 1e-3, away from its root and the place where it leaves; the same scene seen in a
/// mirror has the same numbers.
#[test]
fn a_beam_bends_around_a_disc() {
    let rho = 0.4;
    let all = [1.0, -1.0].map(|side| {
        let tip = json!({"free": {"follower_normal_n": 20.0, "follower_shear_n": side * 8.0}});
        let rest = AtRest::new(&parse(&wrapped(128, rho, 1e6, side, tip)));
        let place = |k: usize| [rest.nodes[k][0], k as f64 / 128.0 + rest.nodes[k][1]];
        let chord = |k: usize| [0, 1].map(|axis| place(k + 1)[axis] - place(k)[axis]);
        for k in (32..64).step_by(8) {
            let (a, b) = (chord(k), chord(k + 1));
            let turn = b[0].atan2(b[1]) - a[0].atan2(a[1]);
            let curvature = -side * turn / (0.5 * (a[0].hypot(a[1]) + b[0].hypot(b[1])));
            assert!((curvature * rho - 1.0).abs() < 1e-3, "{side} {k}: {curvature}");
        }
        [
            side * rest.read("tip_u1"),
            rest.read("tip_u3"),
            side * rest.read("contact_disc_force_x"),
        ]
    });
    println!("{all:?}");
    assert!(
        all[0].iter().zip(&all[1]).all(|(a, b)| (a / b - 1.0).abs() < 1e-9),
        "{all:?}"
    );
}

/// Goal: a disc and a room tend to the wall that is tangent to them, with the first order of 1/R, in a swing that strikes.
#[test]
fn large_circles_are_walls() {
    let tip = |contact: Value| {
        let mut case = beam(json!("clamped"), json!("free"), json!([contact]));
        case["start"] = json!({"u1_rate_m_s": {"polynomial": {"coefficients": [0, 0, 0.6]}}});
        case["effects"] = json!("full");
        case["solver"] = json!({"rtol": 1e-10, "method": "esdirk46"});
        case["time"] = json!({"end_s": 0.5, "output_interval_s": 5e-3});
        let (memory, _) = run(&case);
        let force = memory.column("contact_disc_normal_force").unwrap();
        assert!(force.iter().any(|f| *f > 0.1), "not struck");
        memory.column("tip_u1").unwrap()
    };
    let law = json!({"at": 1, "stiffness_n_m": 100, "reach_m": 0, "smoothing_m": 1e-2, "damping_s_m": 0.5, "friction_coefficient": 0.3,
                     "friction_velocity_m_s": 0.1, "name": "disc"});
    let with = |more: Value| {
        let mut one = law.clone();
        one.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        tip(one)
    };
    let wall = with(json!({"point_m": [0.05, 1], "normal": [-1, 0]}));
    for (inside, side) in [(false, 1.0), (true, -1.0)] {
        let off = [1e2, 1e4].map(|radius| {
            let circle =
                with(json!({"circle": {"center_m": [0.05 + side * radius, 1], "radius_m": radius, "inside": inside}}));
            circle.iter().zip(&wall).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        });
        println!("{inside}: {off:?}");
        assert!(off[1] < 1e-6 && (off[0] / off[1]).log(100.0) > 0.9, "{inside}: {off:?}");
    }
}

/// A free beam that flies across towards a disc below its middle.
fn flying(velocity: f64, radius: f64, more: Value) -> Value {
    let mut one = disc(
        [-0.3123, 0.5],
        radius,
        json!({"stiffness_pa": 1e5, "smoothing_m": 1e-4}),
    );
    for (key, value) in more.as_object().unwrap() {
        one[key] = value.clone();
    }
    let mut case = beam(json!("free"), json!("free"), json!([one]));
    case["start"] = json!({"u1_rate_m_s": -velocity});
    case["effects"] = json!("full");
    case["time"] = json!({"end_s": 0.6 / velocity, "output_interval_s": 0.01 / velocity});
    case
}

/// Goal: the energy balance closes with a disc, with the tolerance; without damping and friction the sum of energies is constant.
#[test]
fn striking_a_disc_keeps_energy() {
    for lossy in [
        json!({}),
        json!({"damping_s_m": 0.3, "friction_coefficient": 0.3, "friction_velocity_m_s": 1e-2, "circle": {"center_m": [-0.31, 0.4], "radius_m": 0.2}}),
    ] {
        let residuals = [1e-5, 1e-7].map(|rtol| {
            let mut case = flying(2.0, 0.2, lossy.clone());
            case["solver"] = json!({"rtol": rtol});
            let (memory, summary) = run(&case);
            let lost = memory.column("dissipated_damping").unwrap();
            assert_eq!(lossy.get("damping_s_m").is_some(), *lost.last().unwrap() > 0.0);
            assert!(memory.column("contact_energy").unwrap().iter().any(|e| *e > 0.0));
            summary.balances.energy_residual_relative.abs()
        });
        println!("{residuals:?}");
        assert!(
            residuals[1] < 1e-4 && residuals[1] < residuals[0],
            "{lossy} {residuals:?}"
        );
    }
}

/// Goal: a beam that flies freely, of which steps may be long, does not pass a pin between two of them, whatever its velocity.
#[test]
fn no_step_passes_over_a_pin() {
    for velocity in [0.5, 5.0, 50.0] {
        let mut case = flying(velocity, 0.01, json!({"reach_m": 1e-3}));
        case["solver"] = json!({"rtol": 1e-4});
        let (memory, _) = run(&case);
        let force = memory.column("contact_disc_normal_force").unwrap();
        assert!(force.iter().any(|f| *f > 0.0), "{velocity}: never struck");
    }
}

/// Goal: a circle that is small against the cells is reported with the number of cells that resolves it; a start inside a disc is W023.
#[test]
fn coarse_meshes_and_starts_inside_are_reported() {
    let findings = |radius: f64, cells: usize| {
        let mut case = flying(1.0, radius, json!({}));
        case["mesh"] = json!({"segments": 8, "cells_per_segment": cells});
        let case = parse(&case);
        resolution::unresolved(&case, &System::new(&case).unwrap())
    };
    assert!(findings(0.1, 2).is_empty());
    let coarse = findings(0.05, 1);
    assert_eq!(
        (coarse[0].pointer.as_str(), coarse[0].wanted),
        ("/contacts/0/circle", Some(4))
    );
    let wanted = coarse[0].wanted.unwrap();
    assert!(findings(0.05, wanted).is_empty() && !findings(0.05, wanted / 2).is_empty());

    let warned = |x: f64| {
        let mut case = beam(
            json!("clamped"),
            json!("free"),
            json!([disc([x, 0.5], 0.2, json!({"stiffness_pa": 10}))]),
        );
        case["time"] = json!({"end_s": 0.01});
        run(&case)
            .1
            .warnings
            .iter()
            .any(|w| w.starts_with("W023") && w.contains("begins"))
    };
    assert!(warned(0.0) && warned(0.199) && !warned(0.201));
}

/// Goal: the finger of `cases` lies on its disc along more than a third of its length; the force of its root balances that of the disc.
#[test]
fn a_finger_closes_around_a_disc() {
    let case = slcbeam::case::load(Path::new("cases/finger-disc.json"), &[]).unwrap();
    let rest = AtRest::new(&case);
    let touching = rest.nodes.iter().enumerate().filter(|(k, [u1, u3])| {
        let z = *k as f64 * 0.3 / (rest.nodes.len() - 1) as f64 + u3;
        (u1 + 0.095).hypot(z - 0.1) < 0.08 + 0.0108
    });
    let touching = touching.count();
    println!("{touching} of {}", rest.nodes.len());
    assert!(3 * touching > rest.nodes.len());
    for axis in ["x", "z"] {
        let [root, disc] = ["reaction_root", "contact_disc_force"].map(|name| rest.read(&format!("{name}_{axis}")));
        assert!(
            disc.abs() > 1.0 && (root / disc + 1.0).abs() < 1e-4,
            "{axis}: {root} {disc}"
        );
    }
}
