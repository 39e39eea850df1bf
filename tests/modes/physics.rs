//! Modes of beams with bladders.
//!
//! Sources: runs in time of the same equations; models with effects left out; mirror symmetry; Rayleigh's theorem for the undrained and
//! drained limits; rigid motions. Goal: the linearization is that of the model, including limits and kinds of modes.

use nalgebra::Complex;
use serde_json::{Value, json};
use slcbeam::case::{self, parameter::Parameter};
use slcbeam::model::{Model, passivity};
use slcbeam::run::dynamics;
use slcbeam::run::modes::{self, Mode, ModeShape, Modes, TimeBehavior, likeness};
use slcbeam::run::record::Memory;

use crate::common::{across, chains, checked, plan, slowest, wet};

fn swinging(found: &Modes) -> Vec<&Mode> {
    found.modes.iter().filter(|m| m.kind.swings()).collect()
}

/// Growth rate and angular frequency of samples of one decaying oscillation (Prony's method, least squares).
fn oscillation(x: &[f64], interval: f64) -> (f64, f64) {
    let sum = |f: &dyn Fn(&[f64]) -> f64| x.windows(3).map(f).sum::<f64>();
    let (uu, uv, vv) = (sum(&|w| w[1] * w[1]), sum(&|w| w[1] * w[0]), sum(&|w| w[0] * w[0]));
    let (ux, vx) = (sum(&|w| w[1] * w[2]), sum(&|w| w[0] * w[2]));
    let determinant = uu * vv - uv * uv;
    let (a, b) = ((ux * vv - vx * uv) / determinant, (vx * uu - ux * uv) / determinant);
    let radius = (-b).sqrt();
    (radius.ln() / interval, (0.5 * a / radius).acos() / interval)
}

#[test]
fn a_run_swings_and_decays_as_its_mode() {
    // resistance such that pressure lags by about an eighth of a period: 2 to 10 % of damping
    let mut case = across(2, 0.01, 1e-5);
    let found = slowest(&case, 4);
    let mode = swinging(&found)[0];
    let (ratio, s) = (mode.damping_ratio().unwrap(), mode.s);
    assert!(
        mode.shape.transverse() > 0.999 && (0.01..0.3).contains(&ratio),
        "{ratio}"
    );
    // starts in the mode with 1e-5 of the length: nonlinear terms are 1e-10 of it
    let size = 1e-6 / mode.shape.displacement();
    let nodes = mode.shape.u1.len();
    let table = |f: &dyn Fn(&Complex<f64>) -> f64| {
        let places: Vec<f64> = (0..nodes).map(|i| i as f64 / (nodes - 1) as f64).collect();
        let values: Vec<f64> = mode.shape.u1.iter().map(|u| size * f(u)).collect();
        json!({"table": {"positions": places, "values": values, "interpolation": "linear"}})
    };
    let pressures: Value = (0..4)
        .map(|b: usize| {
            let signed = if b < 2 { b as i64 + 1 } else { 1 - b as i64 };
            json!({"bladders": [signed], "pressure_pa": size * mode.shape.pressure[b].re})
        })
        .collect();
    case["start"] = json!({"u1_m": table(&|u| u.re), "u1_rate_m_s": table(&|u| (u * s).re), "pressures": pressures});
    let interval = std::f64::consts::TAU / s.im / 24.0;
    case["time"] = json!({"end_s": 48.0 * interval, "output_interval_s": interval});
    for effect in [
        "finite_rotation",
        "axial_force_on_bending",
        "axial_stretch",
        "axial_inertia",
        "rotary_inertia",
    ] {
        case["effects"][effect] = json!("on");
    }
    case["solver"] = json!({"rtol": 1e-7, "transverse_scale_m": 1e-6});
    let mut memory = Memory::default();
    let outcome = dynamics::run(&checked(&case), &mut memory).unwrap();
    assert!(outcome.fault.is_none());
    let (growth, w) = oscillation(&memory.column("tip_u1").unwrap(), interval);
    // the integrator's phase at rtol 1e-7 and its amplitude, over two periods
    assert!((w / s.im - 1.0).abs() < 1e-5, "{w} {}", s.im);
    assert!((growth / s.re - 1.0).abs() < 2e-4, "{growth} {}", s.re);
}

#[test]
fn limits_bracket_and_are_those_of_the_reduced_models() {
    let case = across(2, 0.01, 1e-5);
    let found = slowest(&case, 4);
    let with = |effect: &str| {
        let mut reduced = case.clone();
        reduced["effects"][effect] = json!("off");
        let found = slowest(&reduced, 4);
        let across = |m: &&&Mode| m.shape.transverse() > 0.5;
        swinging(&found).iter().find(across).unwrap().frequency_hz().unwrap()
    };
    let (sealed, uniform) = (with("flow"), with("network_pressure_differences"));
    let mode = swinging(&found)[0];
    let (undrained, drained) = (mode.undrained.unwrap(), mode.drained.unwrap());
    // sealed: the same equations; freed: remaining pressure differences of 1e-9
    assert!(
        (undrained.frequency_hz / sealed - 1.0).abs() < 1e-9,
        "{sealed} {undrained:?}"
    );
    assert!(
        (drained.frequency_hz / uniform - 1.0).abs() < 1e-8,
        "{uniform} {drained:?}"
    );
    assert!(undrained.likeness > 0.99 && drained.likeness > 0.99);
    // |s| of the coupled mode is between both limits, which differ by a tenth, and near neither
    let between = mode.s.norm() / std::f64::consts::TAU;
    let gap = undrained.frequency_hz - drained.frequency_hz;
    assert!(gap > 0.03 * drained.frequency_hz);
    assert!(between > drained.frequency_hz + 0.05 * gap && between < undrained.frequency_hz - 0.05 * gap);
}

#[test]
fn a_mirrored_case_moves_across_or_along() {
    let mut case = chains(4, 8.68e-4, 5e-6);
    case["bladders"]["area_per_force_m2_per_n"] = json!({"tension": 5e-8, "compression": 5e-8});
    let found = slowest(&case, 16);
    let (mut across, mut along) = (0, 0);
    for mode in swinging(&found) {
        let share = mode.shape.transverse();
        // rounding error of an eigenvector over the distance to the next eigenvalue, squared
        assert!(!(1e-12..=1.0 - 1e-12).contains(&share), "{share:e}");
        if share > 0.5 {
            across += 1
        } else {
            along += 1
        }
        let (upper, lower) = mode.shape.pressure.split_at(4);
        let sign = if share > 0.5 { -1.0 } else { 1.0 };
        let largest = mode.shape.largest_pressure();
        assert!(
            upper
                .iter()
                .zip(lower)
                .all(|(u, l)| (u - l * sign).norm() < 1e-6 * largest)
        );
    }
    assert!(across > 2 && along > 1);
    // two closed chains conserve two volumes
    assert_eq!(found.modes.iter().filter(|m| m.kind == TimeBehavior::Volume).count(), 2);
}

#[test]
fn a_free_beam_has_rigid_motions() {
    let mut case = wet(2, 8.68e-4, 5e-6);
    case["ends"] = json!({"root": "free", "tip": "free"});
    case["mesh"] = json!({"segments": 20, "cells_per_segment": 4});
    case["effects"]["rotary_inertia"] = json!("off");
    for name in ["fluid", "bladders", "tubes", "network"] {
        case.as_object_mut().unwrap().remove(name);
    }
    let found = slowest(&case, 2);
    assert!(found.about.system().mesh.cells == 80);
    // two translations and a rotation, each a position and a velocity
    assert_eq!(found.modes.iter().filter(|m| m.kind == TimeBehavior::Rigid).count(), 6);
    // free-free: beta L = 4.7300, and 80 cells err by (beta h)^2/12 and beta h^2/4 for each end
    let w = 4.730_040_744_862_7_f64.powi(2) * found.about.frequency();
    let first = swinging(&found)[0].s;
    assert!(first.re == 0.0 && (first.im / w - 1.0).abs() < 7e-4, "{first} {w}");
}

#[test]
fn a_column_beyond_its_load_diverges() {
    // P/Pcr = 1.2, dead load, straight: x'' grows with sqrt(0.2) of its own; exact only in the sign
    let mut case = wet(2, 8.68e-4, 5e-6);
    for name in ["fluid", "bladders", "tubes", "network"] {
        case.as_object_mut().unwrap().remove(name);
    }
    let load = 1.2 * std::f64::consts::PI.powi(2) * 0.0503885 / 0.04;
    case["ends"]["tip"] = json!({"free": {"force_z_n": -load}});
    case["start"] = json!({"u3_m": {"polynomial": {"coefficients": [0.0, -0.1 * load / 1144.8]}}});
    let found = slowest(&case, 3);
    let growing: Vec<_> = found.modes.iter().filter(|m| m.kind.grows()).collect();
    assert_eq!(growing.len(), 1);
    assert_eq!(growing[0].kind, TimeBehavior::Divergence);
    assert!(growing[0].s.re > 10.0 && growing[0].damping_ratio().is_none());
}

/// Source: Euler's column, `f/f0` of the straight one and `P = Pcr` as its zero; the buckled branch is stable (Born 1906). Goal: modes
/// about the equilibrium under the loads at an instant, straight below the load and bent above it.
#[test]
fn the_buckled_column_swings() {
    let case = case::load(
        "cases/elastica.json".as_ref(),
        // A load that grows to 5 Pcr in 1 s, from a straight start.
        &[
            "/ends/tip={\"free\":{\"force_z_n\":{\"polynomial\":{\"coefficients\":[0,-12.337]}}}}".into(),
            "/start={}".into(),
        ],
    )
    .unwrap();
    let first = |share: f64| {
        let found = modes::compute(modes::at_equilibrium(&case, share / 5.0).unwrap(), &plan(3)).unwrap();
        assert!(!found.about.moving(), "{:e}", found.about.rate);
        assert!(
            found.modes.iter().all(|m| m.kind == TimeBehavior::Oscillation),
            "stable at {share} Pcr"
        );
        swinging(&found)[0].s.im
    };
    let (free, near, beyond) = (first(1e-6), first(0.99), first(1.2));
    // f² falls nearly in proportion to 1 - P/Pcr: the shape is that of buckling within a percent
    assert!(
        (near / free).powi(2) < 0.011 && (near / free).powi(2) > 0.009,
        "{near} {free}"
    );
    assert!(beyond > 2.0 * near, "{beyond}");
}

#[test]
fn shapes_are_alike_or_orthogonal() {
    let shape = |f: &dyn Fn(f64) -> f64| ModeShape {
        u1: (0..=40).map(|i| Complex::new(f(i as f64 / 40.0), 0.0)).collect(),
        u3: vec![Complex::default(); 41],
        pressure: vec![],
    };
    let sine = |k: f64| shape(&|x| (k * std::f64::consts::PI * x).sin());
    // the trapezoid integrates products of sines exactly
    assert!(likeness(&sine(1.0), &sine(2.0)) < 1e-28);
    assert!((likeness(&sine(1.0), &shape(&|x| -3.0 * (std::f64::consts::PI * x).sin())) - 1.0).abs() < 1e-14);
    // half of each: 1/2
    let half = shape(&|x| (std::f64::consts::PI * x).sin() + (2.0 * std::f64::consts::PI * x).sin());
    assert!((likeness(&sine(1.0), &half) - 0.5).abs() < 1e-14);
}

/// Source: derivation at [E35]. Goal: with mean slopes the smallest eigenvalue is `1 - √(2 EI φ_b l_b am²/a_p)` or that of the force, which
/// [E21] requires to be positive; a published coupling has the defect of its two sides.
#[test]
fn passive_as_the_audit_has_it() {
    let mut case = wet(10, 8.68e-4, 5e-6);
    let of = |case: &Value| passivity::assess(&Model::whole(&checked(case), true).unwrap()).unwrap();
    let section = Model::whole(&checked(&case), true).unwrap().section;
    let r = 100.0 * 0.046;
    let least = |am: f64| 1.0 - (2.0 * section.bending_stiffness * r * am * am / 1.75e-10).sqrt();
    let found = of(&case);
    assert!((found.least - least(5e-6)).abs() < 1e-12 && found.defect == 0.0 && found.passive());
    assert!(
        (found.direction[2] + found.direction[3]).abs() < 1e-9,
        "bending: opposite pressures"
    );
    // beyond the limit of [E21]
    let am = 1.01 * (1.75e-10 / (2.0 * section.bending_stiffness * r)).sqrt();
    case["bladders"]["area_per_moment_m2_per_n_m"] = json!({"opening": am, "closing": am});
    let found = of(&case);
    assert!((found.least - (1.0 - 1.01)).abs() < 1e-12 && !found.passive());
    // A published slope of half what reciprocity asks for: the sides are 1 and 1/2, their half difference over their mean 1/3.
    let mut case = wet(10, 8.68e-4, 5e-6);
    let slope = 0.5 * 0.046 * 5e-6 * 2e6;
    case["bladders"]["coupling"] = json!({"published": {"slope_per_pressure_rad": slope, "length_per_pressure_m": 0}});
    let found = of(&case);
    assert!((found.defect - 1.0 / 3.0).abs() < 1e-12, "{}", found.defect);
    assert!(!found.passive() && found.least > 0.0);
}

/// Goal: derivatives of eigenvalues agree with differences of complete solutions, about the start and about an equilibrium, [E44]: growth
/// and frequency of the slowest modes of a damped wet beam. Fourth-order differences over steps of 1e-3 and 2e-3 leave 1e-11 of s, divided
/// by 1e-3 of it.
#[test]
fn eigenvalues_move_as_differences_say() {
    let mut case = across(2, 0.01, 1e-5);
    case["ends"]["tip"] = json!({"free": {"force_x_n": 2.0}});
    let case = checked(&case);
    for at in [None, Some(0.5)] {
        let find = |case: &case::Case| match at {
            None => modes::modes(case, &plan(4)),
            Some(at) => modes::at_equilibrium(case, at).and_then(|about| modes::compute(about, &plan(4))),
        };
        let base = find(&case).unwrap();
        for pointer in [
            "/fluid/viscosity_pa_s",
            "/beam/young_modulus_pa",
            "/ends/tip/free/force_x_n",
        ] {
            let parameter = Parameter::find(&case, pointer).unwrap();
            let found =
                modes::differentiate(&case, at, &base.about, &base.modes, std::slice::from_ref(&parameter)).unwrap();
            let s = |steps: f64, k: usize| {
                let value = parameter.value * (1.0 + 1e-3 * steps);
                find(&parameter.changed(&case, value).unwrap()).unwrap().modes[k].s
            };
            for (k, mode) in base.modes.iter().enumerate() {
                let by_difference =
                    ((s(1.0, k) - s(-1.0, k)) * 8.0 - (s(2.0, k) - s(-2.0, k))) / (12e-3 * parameter.value);
                let error = (found[0].s[k] - by_difference).norm();
                // error bound of the eigenvalues themselves, over the step
                let bound = 1e-6 * by_difference.norm()
                    + 10.0 * (mode.error + 1e-9 * mode.s.norm()) / (1e-3 * parameter.value.abs());
                assert!(
                    error <= bound,
                    "{pointer} {k}: {} {by_difference} {bound:e}",
                    found[0].s[k]
                );
            }
        }
    }
}

/// Goal: the first four frequencies of a cantilever to 3e-3 with 64 cells. From 32 and 64 cells they extrapolate to within 1e-4 of the
/// exact ones: (βh)⁴ for the fourth is 9e-4 over ten. The reported mesh error agrees with the true one within a tenth.
#[test]
fn half_the_cells_tell_the_error_of_the_mesh() {
    let case = checked(&json!({
        "name": "cantilever", "ends": {"root": "clamped", "tip": "free"}, "effects": {"rotary_inertia": "off"},
        "beam": {"length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4},
        "mesh": {"segments": 64, "cells_per_segment": 1}, "time": {"end_s": 1.0}
    }));
    let mut found = modes::modes(&case, &plan(4)).unwrap();
    modes::compare_meshes(&case, None, &plan(4), &mut found);
    let exact = [1.875104068712, 4.694091132974, 7.854757438238, 10.995540734875_f64];
    for (mode, beta) in swinging(&found).into_iter().zip(exact) {
        let exact = beta * beta / std::f64::consts::TAU;
        let (f, extrapolated) = (mode.frequency_hz().unwrap(), mode.extrapolated_hz().unwrap());
        assert!((extrapolated / exact - 1.0).abs() < 1e-4, "{f} {extrapolated} {exact}");
        let told = mode.mesh_error().unwrap() / (f / exact - 1.0).abs();
        assert!((told - 1.0).abs() < 0.1, "{told}");
    }
}

/// Goal: if the beam cells cannot be halved, twice the cells yield its error: every mode has errors of both meshes.
#[test]
fn odd_cells_have_an_error_too() {
    let mut case = across(2, 8.68e-4, 5e-6);
    case["mesh"] = json!({"cells_per_segment": 3, "cells_per_bladder": 2});
    let case = checked(&case);
    let mut found = modes::modes(&case, &plan(4)).unwrap();
    modes::compare_meshes(&case, None, &plan(4), &mut found);
    let moving = found.modes.iter().filter(|m| !m.kind.stays());
    for mode in moving {
        let by = mode.by_mesh;
        assert!(by.beam.is_some() && by.bladders.is_some() && by.finer, "{by:?}");
    }
}

#[test]
fn as_many_networks_as_bladders_keep_as_many_volumes() {
    // ten pairs: a tenfold eigenvalue of zero, besides the infinite ones by algebraic unknowns
    let found = slowest(&across(10, 0.1, 5e-6), 4);
    let kept = found.modes.iter().filter(|m| m.kind == TimeBehavior::Volume).count();
    assert_eq!(kept, 10);
    assert_eq!(found.modes.len(), kept + 4);
}

#[test]
fn strongly_damped_motions_are_found_too() {
    // four more cells per segment, and stiffness-proportional damping: the Krylov space alone finds four of the eight requested modes
    let mut case = wet(10, 8.68e-4, 5e-6);
    case["beam"]["damping"] = json!({"bending_time_s": 2e-3, "axial_time_s": 2e-3});
    case["mesh"] = json!({"cells_per_segment": 8});
    let first = |count: usize| swinging(&slowest(&case, count))[0].s;
    // for twelve requested modes, all eigenvalues are computed at once
    let (few, all) = (first(2), first(12));
    assert!((few - all).norm() < 1e-9 * all.norm() && few.re < 0.0, "{few} {all}");
}
