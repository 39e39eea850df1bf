//! Rotating axes, [E86]: identities with axes at rest, published frequencies, closed forms, balances and differences.

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case;
use slcbeam::case::parameter::Parameter;
use slcbeam::discrete::System;
use slcbeam::error::Error;
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, differentiate, follow, system};
use slcbeam::run::modes::{ModeOptions, at_equilibrium, compute};
use slcbeam::run::periodic::{PeriodicScene, record, shoot};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::Status;

use crate::balances::close;
use crate::foundation::{at_rest, order, parse, unit};
use crate::jacobian::agrees;

/// Clamped root, free tip.
fn cantilever() -> Value {
    json!({"root": "clamped", "tip": "free"})
}

/// A beam of unit stiffness, length and mass that is a tenth of its length high, EA 12 000 N.
fn thick(cells: usize, ends: &Value, more: &Value) -> Value {
    let mut case = unit(cells, ends, more);
    case["beam"] = json!({"length_m": 1.0, "height_m": 0.1, "width_m": 0.1, "young_modulus_pa": 1.2e5, "density_kg_m3": 100,
                          "axial_stiffness_factor": 10});
    case["effects"] = json!("full");
    case["solver"]["rtol"] = json!(1e-8);
    for (key, value) in more["beam"].as_object().into_iter().flatten() {
        case["beam"][key] = value.clone();
    }
    case
}

fn run(case: &Value, most: f64) -> Memory {
    let mut memory = Memory::default();
    let summary = dynamics::run(&parse(case), &mut memory).unwrap().summary;
    assert_eq!(summary.status, Status::Finished, "{:?}", summary.reason);
    close("run", &summary, most);
    memory
}

/// Position of the tip over time.
fn tips(memory: &Memory) -> Vec<[f64; 2]> {
    let [x, z] = ["tip_u1", "tip_u3"].map(|name| memory.column(name).unwrap());
    x.iter().zip(z).map(|(x, z)| [*x, 1.0 + z]).collect()
}

/// The vector from `center` to a point, turned by an angle in the sense of growing φ.
fn turned([x, z]: [f64; 2], center: [f64; 2], angle: f64) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    let [x, z] = [x - center[0], z - center[1]];
    [center[0] + x * cosine + z * sine, center[1] + z * cosine - x * sine]
}

fn largest_distance(one: &[[f64; 2]], other: &[[f64; 2]]) -> f64 {
    let apart = one.iter().zip(other).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
    apart.fold(0.0, f64::max)
}

/// A mass with rotary inertia beside the tip and a mass between two nodes.
fn bodies() -> Value {
    json!([{"at": 1.0, "mass_kg": 0.2, "rotary_inertia_kg_m2": 2e-3, "offset_across_m": 0.05, "offset_along_m": 0.03},
           {"at": 0.4, "mass_kg": 0.1}])
}

/// Goal: a beam on a hub in rotating axes moves as one whose root is driven around in axes at rest: the semi-discrete equations are the
/// same. Both are loaded by forces that turn with the beam. Tolerance: that of the integration, 1e-8 in each step.
#[test]
fn a_beam_on_a_hub_moves_as_in_axes_at_rest() {
    let (speed, hub, rise) = (2.0, 0.3, 3.0);
    let loads = json!([{"force_normal_n_m": {"signal": {"ramp": {"to": 2, "duration_s": 0.5}}}}]);
    let sine = |phase: f64| json!({"sine": {"amplitude": hub, "frequency_hz": speed / (2.0 * PI), "phase_rad": phase}});
    let turned_by = |steady: bool, t: f64| if steady { speed * t } else { rise / 3.0 * t.powi(3) };
    let drive = |steady: bool| match steady {
        true => json!({"u1_m": sine(0.0), "u3_m": {"sum": [sine(FRAC_PI_2), -hub]},
                       "slope_rad": {"polynomial": {"coefficients": [0, speed]}}}),
        false => json!({"slope_rad": {"polynomial": {"coefficients": [0, 0, 0, rise / 3.0]}}}),
    };
    for (steady, mut more) in [
        (true, json!({})),
        (false, json!({"attachments": bodies()})),
        (false, json!({"beam": {"shear_stiffness_n": 500}})),
        (
            false,
            json!({"beam": {"shear_stiffness_n": 500}, "attachments": bodies()}),
        ),
    ] {
        more["loads"] = loads.clone();
        let mut driven = thick(6, &json!({"root": {"clamped": drive(steady)}, "tip": "free"}), &more);
        let mut case = thick(6, &cantilever(), &more);
        let center = if steady { [0.0, -hub] } else { [0.0; 2] };
        if steady {
            driven["start"] = json!({"u1_rate_m_s": {"polynomial": {"coefficients": [speed * hub, speed]}}});
            case["rotating_frame"] = json!({"center_m": center, "angular_velocity_rad_s": speed});
        } else {
            case["rotating_frame"] = json!({"angular_velocity_rad_s": {"polynomial": {"coefficients": [0, 0, rise]}}});
        }
        let [driven, own] = [driven, case].map(|case| run(&case, 1e-6));
        let times = own.column("t").unwrap();
        let seen: Vec<_> = tips(&own)
            .into_iter()
            .zip(times)
            .map(|(tip, t)| turned(tip, center, turned_by(steady, t)))
            .collect();
        let bent = tips(&own).iter().fold(0.0_f64, |most, tip| most.max(tip[0].abs()));
        let apart = largest_distance(&tips(&driven), &seen);
        println!("{more}: bent by {bent:.3}, apart {apart:.1e}");
        assert!(bent > 0.1 && apart < 1e-6, "{more}: {bent} {apart:.1e}");
    }
}

/// Goal: a free beam that rests in inertial axes moves around in rotating ones, whatever their speed, without any strain.
#[test]
fn a_free_beam_at_rest_stays_at_rest() {
    let center = [0.4, -0.2];
    let (mean, swing, rate) = (3.0, 2.0, 4.0);
    let frame = json!({"center_m": center, "angular_velocity_rad_s":
        {"sum": [mean, {"sine": {"amplitude": swing, "frequency_hz": rate / (2.0 * PI)}}]}});
    let start = json!({"u1_rate_m_s": {"polynomial": {"coefficients": [mean * center[1], -mean]}}, "u3_rate_m_s": -mean * center[0]});
    let more = json!({"rotating_frame": frame, "start": start, "attachments": bodies()});
    let memory = run(&thick(6, &json!({"root": "free", "tip": "free"}), &more), 1e-6);
    let angle = |t: f64| mean * t + swing / rate * (1.0 - (rate * t).cos());
    let exact: Vec<_> = memory
        .column("t")
        .unwrap()
        .iter()
        .map(|t| turned([0.0, 1.0], center, -angle(*t)))
        .collect();
    let apart = largest_distance(&tips(&memory), &exact);
    assert!(apart < 1e-6, "{apart:.1e}");
    let strained = ["bending_energy", "axial_energy"].map(|name| *memory.column(name).unwrap().last().unwrap());
    let kinetic = memory.column("kinetic_energy").unwrap()[0];
    assert!(
        strained.iter().all(|energy| *energy < 1e-9 * kinetic),
        "{strained:?} {kinetic}"
    );
}

/// Source: Wright, Smith, Thresher & Wang 1982; Hodges & Rutkowski 1981: frequencies of a rotating cantilever across its plane of rotation,
/// times l²√(m/EI). In the plane `ω² = ω_across² - W²`. Goal: their digits.
#[test]
fn a_rotating_cantilever_has_its_published_frequencies() {
    let first = [3.5160, 3.6817, 4.1373, 4.7973, 5.5850, 6.4495, 7.3604];
    let second = [22.0345, 22.1810, 22.6149, 23.3203, 24.2734, 25.4461, 26.8091];
    let plan = ModeOptions {
        count: 4,
        near_hz: 0.5,
        limits: false,
    };
    for (speed, (first, second)) in (0..7).map(f64::from).zip(first.into_iter().zip(second)) {
        let more = json!({"rotating_frame": {"angular_velocity_rad_s": speed}, "effects": {"rotary_inertia": "off"},
                          "mesh": {"segments": 24, "cells_per_segment": 1, "order": 4}});
        let about = at_equilibrium(&parse(&unit(24, &cantilever(), &more)), 1.0).unwrap();
        let mut found: Vec<f64> = compute(about, &plan)
            .unwrap()
            .modes
            .iter()
            .filter_map(|mode| mode.frequency_hz())
            .collect();
        found.sort_by(f64::total_cmp);
        for (across, found) in [first, second].into_iter().zip(found) {
            let exact = f64::sqrt(across * across - speed * speed);
            let error = 2.0 * PI * found / exact - 1.0;
            assert!(error.abs() < 1e-4, "{speed}: {exact} {error:.1e}");
        }
    }
}

/// Goal: a bar that turns about its end stretches by `u = l (tan x/x - 1)`, x = W l √(m/EA), with the order of the mesh; its derivative
/// by W is that of this formula.
#[test]
fn a_rotating_bar_stretches_as_its_closed_form() {
    let x: f64 = 0.5;
    let speed = x * 1.2e5_f64.sqrt();
    let exact = x.tan() / x - 1.0;
    let case = |order_of_mesh: u32, cells: usize| {
        let mut case = unit(
            cells,
            &cantilever(),
            &json!({"rotating_frame": {"angular_velocity_rad_s": speed}}),
        );
        case["beam"]["axial_stiffness_factor"] = json!(1);
        case["mesh"]["order"] = json!(order_of_mesh);
        case
    };
    for (order_of_mesh, cells, least) in [(2, [10, 20], 1.9), (4, [10, 20], 3.7)] {
        let errors = cells.map(|cells| at_rest(&case(order_of_mesh, cells), "tip_u3") / exact - 1.0);
        assert!(
            errors[1].abs() < 2e-3 && order(errors) > least,
            "order {order_of_mesh}: {errors:?}"
        );
    }
    let (case, options) = (parse(&case(4, 20)), EquilibriumOptions::at(1.0));
    let path = follow(&case, &options, &mut |_| Control::Continue).unwrap();
    let speeds = [Parameter::find(&case, "/rotating_frame/angular_velocity_rad_s").unwrap()];
    let found = &differentiate(&case, &options, &path, &speeds).unwrap()[0];
    let all = columns(&system(&case, 1.0).unwrap());
    let at = all.iter().position(|column| column.name == "tip_u3").unwrap();
    let slope = (x.cos().powi(-2) - x.tan() / x) / speed;
    assert!((found.row[at] / slope - 1.0).abs() < 1e-4, "{} {slope}", found.row[at]);
}

/// Source: Simo & Vu-Quoc 1986, an arm brought to 6 rad/s in 15 s. Goal: its greatest lag of about 0.574 m (unshearable), then its steady
/// stretch of 5.143e-4 m.
#[test]
fn an_arm_lags_and_stretches_as_it_is_spun_up() {
    let switch = |from: f64, to: f64| json!({"ramp": {"from": from, "to": to, "start_s": 15, "duration_s": 0}});
    let rise = json!({"sum": [{"polynomial": {"coefficients": [0, 0.4]}},
                              {"sine": {"amplitude": -0.4 * 15.0 / (2.0 * PI), "frequency_hz": 1.0 / 15.0}}]});
    let speed = json!({"sum": [{"product": [switch(1.0, 0.0), rise]}, switch(0.0, 6.0)]});
    let side = (12.0_f64 * 1.4e4 / 2.8e7).sqrt();
    let mut case = json!({
        "name": "arm", "ends": cantilever(), "rotating_frame": {"angular_velocity_rad_s": speed},
        "beam": {"length_m": 10, "height_m": side, "width_m": side, "young_modulus_pa": 2.8e7 / (side * side),
                 "density_kg_m3": 1.2 / (side * side), "damping": {"bending_time_s": 1e-5}},
        "effects": {"rotary_inertia": "off"}, "companion": "off",
        "mesh": {"segments": 12, "cells_per_segment": 1, "order": 4},
        "time": {"end_s": 16, "output_interval_s": 0.02}, "solver": {"rtol": 1e-6}
    });
    let lag = run(&case, 1e-4)
        .column("tip_u1")
        .unwrap()
        .iter()
        .copied()
        .fold(0.0, f64::min);
    assert!((lag + 0.57379).abs() < 1e-3, "{lag}");
    case["rotating_frame"] = json!({"angular_velocity_rad_s": 6});
    let stretch = at_rest(&case, "tip_u3");
    assert!((stretch / 5.143_174_55e-4 - 1.0).abs() < 1e-5, "{stretch}");
}

/// Goal: balances close in all kinematics, and the Jacobian belongs to the residual.
#[test]
fn balances_close_and_the_jacobian_is_that_of_the_residual() {
    let frame = json!({"center_m": [0.1, -0.3], "angular_velocity_rad_s":
        {"sum": [1.5, {"sine": {"amplitude": 1, "frequency_hz": 1}}]}});
    let scenes = [
        ("finite", json!({"attachments": bodies()})),
        (
            "small",
            json!({"attachments": bodies(), "effects": {"finite_rotation": "off"}}),
        ),
        (
            "sheared",
            json!({"attachments": bodies(), "beam": {"shear_stiffness_n": 500}}),
        ),
        (
            "small, sheared",
            json!({"beam": {"shear_stiffness_n": 500}, "effects": {"finite_rotation": "off"}}),
        ),
        (
            "without inertia",
            json!({"attachments": bodies(), "effects": {"solid_inertia": "off"}}),
        ),
        (
            "fourth order",
            json!({"mesh": {"segments": 8, "cells_per_segment": 1, "order": 4}}),
        ),
    ];
    for (name, mut more) in scenes {
        more["rotating_frame"] = frame.clone();
        let mut case = thick(8, &cantilever(), &more);
        if let Some(effects) = more.get("effects") {
            case["effects"] = effects.clone();
        }
        // without inertia the balance closes more slowly with the tolerance
        case["solver"]["rtol"] = json!(if name == "without inertia" { 1e-9 } else { 1e-8 });
        println!("{name}");
        run(&case, 3e-6);
        agrees(&parse(&case), name);
    }
}

/// Goal: the cycle at a speed that varies periodically is the tail of a long run.
#[test]
fn a_cycle_at_varying_speed_is_the_tail_of_a_run() {
    let period = 2.0;
    let speed = json!({"sum": [2.0, {"sine": {"amplitude": 0.5, "frequency_hz": 1.0 / period}}]});
    let more = json!({"rotating_frame": {"angular_velocity_rad_s": speed}, "beam": {"damping": {"bending_time_s": 0.2, "axial_time_s": 1e-3}},
                      "time": {"end_s": 8.0 * period, "output_interval_s": period / 8.0}});
    let mut case = thick(4, &cantilever(), &more);
    case["solver"]["rtol"] = json!(1e-6);
    let tail = run(&case, 1e-4).column("tip_u1").unwrap();
    let case = parse(&case);
    let scene = PeriodicScene::new(&case, None).unwrap();
    let cycle = shoot(&scene, None).unwrap();
    let mut found = Memory::default();
    record::record(&case, &scene, &cycle, &mut found).unwrap();
    let found = found.column("tip_u1").unwrap();
    let size = found.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    let apart = (found.last().unwrap() - tail.last().unwrap()).abs();
    assert!(size > 1e-2 && apart < 1e-4 * size, "{size} {apart:.1e}");
}

/// Goal: what would not turn with the frame, jumps, and speeds and places that no beam has are refused where they stand.
#[test]
fn what_does_not_turn_with_the_frame_is_refused() {
    let turns = json!({"angular_velocity_rad_s": 1});
    let ramp =
        |duration: f64| json!({"angular_velocity_rad_s": {"ramp": {"to": 1, "start_s": 0.5, "duration_s": duration}}});
    let at = "/rotating_frame/angular_velocity_rad_s";
    let beside = [
        (json!({"loads": [{"gravity": {"z_m_s2": -9.81}}]}), "/loads/0/gravity"),
        (json!({"surroundings": {"density_kg_m3": 1}}), "/surroundings"),
        (
            json!({"beam": {"damping": {"drag_n_s_m2": 1}}}),
            "/beam/damping/drag_n_s_m2",
        ),
        (
            json!({"beam": {"damping": {"quadratic_drag_n_s2_m3": 1}}}),
            "/beam/damping/quadratic_drag_n_s2_m3",
        ),
        (json!({"formulation": "published"}), "/rotating_frame"),
    ];
    let within = [
        (json!({"center_m": [0, 0]}), "/rotating_frame"),
        (
            json!({"angular_velocity_rpm": 60}),
            "/rotating_frame/angular_velocity_rpm",
        ),
        (
            json!({"angular_velocity_rad_s": 1, "center_m": [0]}),
            "/rotating_frame/center_m",
        ),
        (json!({"angular_velocity_rad_s": 1, "center_m": [1e300, -1e300]}), at),
        (json!({"angular_velocity_rad_s": 1e300}), at),
        (ramp(0.0), at),
        (ramp(1e-9), at),
    ];
    let beside = beside.map(|(more, pointer)| (more, turns.clone(), pointer));
    let within = within.map(|(frame, pointer)| (json!({}), frame, pointer));
    let scenes = beside.into_iter().chain(within);
    for (more, frame, pointer) in scenes {
        let mut case = thick(4, &cantilever(), &more);
        case["rotating_frame"] = frame;
        let error = case::parse(&case.to_string(), Path::new("test.json"), Path::new(""), &[]).unwrap_err();
        let Error::Case(fault) = &error else {
            panic!("{error:?}")
        };
        let places: Vec<&str> = fault.violations.iter().map(|one| one.pointer.as_str()).collect();
        assert_eq!(places, [pointer], "{more} {error:?}");
    }
}

/// Goal: effects through which a rotating frame acts cannot be left out.
#[test]
fn effects_that_a_rotating_frame_needs_stay() {
    for effect in [
        "transverse_motion",
        "axial_force_on_bending",
        "axial_inertia",
        "axial_stretch",
    ] {
        let mut case = thick(
            4,
            &cantilever(),
            &json!({"rotating_frame": {"angular_velocity_rad_s": 1}}),
        );
        case["effects"] = json!({"finite_rotation": "off", effect: "off"});
        let error = System::new(&parse(&case)).unwrap_err();
        let Error::Case(fault) = &error else {
            panic!("{error:?}")
        };
        let pointer = format!("/effects/{effect}");
        assert!(
            fault.violations.iter().any(|one| one.pointer == pointer),
            "{effect}: {error:?}"
        );
    }
}
