//! Paths of dry beams: large loads, limit points, branches.

use std::f64::consts::PI;

use serde_json::{Value, json};
use slcbeam::error::StopPoint;
use slcbeam::run::equilibrium::{self, EquilibriumOptions, EventKind};

use crate::common::{parse, path_of, shipped, solved, unit};

/// Goal: roll-up to a closed ring and to two turns converges from rest and closes to 1e-6 (here 1e-9: the chords of the mesh close exactly,
/// Newton's error is 1e-10), for stretchable and almost inextensible beams.
#[test]
fn beam_rolls_up_to_two_turns() {
    for factor in [1.0, 1000.0] {
        for turns in [1.0, 2.0] {
            let moment = -2.0 * PI * turns;
            let (path, last) = solved(&parse(&unit(64, factor, json!({"moment_n_m": moment}))));
            assert!(last("tip_u1").abs() < 1e-9 && (last("tip_u3") + 1.0).abs() < 1e-9);
            assert!((last("tip_angle") - 2.0 * PI * turns).abs() < 1e-8);
            assert!(path.events.is_empty());
            assert!(path.states.iter().all(|s| s.stability.is_some_and(|s| s.unstable == 0)));
            // 22 to 37 Newton steps measured: angles are proportional to the moment, so predictions are accurate.
            assert!(path.work.iterations < 80, "{:?}", path.work);
        }
    }
}

/// Goal: follower loads to `F L²/EI = 16` and dead ones to 10 converge from rest; the dead one to Bisshopp & Drucker's
/// rows within 3e-4 at 64 cells (second order: the constant is near 1, h² 2.4e-4).
#[test]
fn large_loads_converge_from_rest() {
    for factor in [1.0, 1000.0] {
        let (_, last) = solved(&parse(&unit(64, factor, json!({"follower_shear_n": -16.0}))));
        assert!(last("tip_angle") > 3.0, "the tip has turned by {}", last("tip_angle"));
    }
    let exact = [0.554995597754, 0.810609024880, 1.43028553880];
    let (_, last) = solved(&parse(&unit(64, 1000.0, json!({"force_x_n": 10.0}))));
    for (value, exact) in [-last("tip_u3"), last("tip_u1"), last("tip_angle")]
        .into_iter()
        .zip(exact)
    {
        assert!((value / exact - 1.0).abs() < 3e-4, "{value} {exact}");
    }
}

/// Goal: a perfect column leaves the straight path at Euler's load of its mesh, is stable on the branch, and bends to 160 degrees; on the
/// straight path it is unstable.
#[test]
fn column_buckles_onto_the_stable_branch() {
    let euler = PI * PI / 4.0;
    let column = parse(&unit(64, 1000.0, json!({"force_z_n": -5.0 * euler})));
    let (path, last) = solved(&column);
    let [event] = path.events.as_slice() else {
        panic!("{:?}", path.events)
    };
    assert_eq!(event.kind, EventKind::Bifurcation);
    // (pi h/2)²/12 of the mesh: 5e-5
    assert!((5.0 * event.share - 1.0).abs() < 1e-4, "{event:?}");
    assert!(last("tip_angle").to_degrees() > 160.0 && last("tip_u1") > 0.0);
    assert!(path.states.iter().all(|s| s.stability.is_some_and(|s| s.unstable == 0)));
    let straight = path_of(
        &column,
        &EquilibriumOptions {
            branches: false,
            ..EquilibriumOptions::at(1.0)
        },
    );
    assert!(straight.last().u1.iter().all(|u| u.abs() < 1e-12));
    // Euler's second load is nine times the first.
    assert_eq!(straight.last().stability.expect("eigenvalues").unstable, 1);
}

/// Goal: a path is followed through limit points (Magnusson, Ristinmaa & Ljung 2001, the extensible elastica). A column so stubby that it
/// is compressed by a quarter before it buckles, at `P (1 - P/EA) = π² EI/4 L²`, loses load as it bends, and bears more again at large
/// bending.
#[test]
fn stubby_column_loses_load_as_it_buckles() {
    let column = parse(&unit(64, 1.05e-4, json!({"force_z_n": -8.0})));
    let (path, last) = solved(&column);
    let kinds: Vec<EventKind> = path.events.iter().map(|e| e.kind).collect();
    assert_eq!(kinds, [EventKind::Bifurcation, EventKind::LimitPoint]);
    let stiffness = 12.6;
    let exact = 0.5 * stiffness * (1.0 - (1.0 - PI * PI / stiffness).sqrt());
    // The chain of links, (pi h/2)²/12 = 5e-5, amplified where load and compression almost balance.
    assert!(
        (8.0 * path.events[0].share / exact - 1.0).abs() < 2e-4,
        "{:?} {exact}",
        path.events
    );
    let unstable = |s: &&equilibrium::EquilibriumState| s.stability.is_some_and(|s| s.unstable == 1);
    assert!(path.states.iter().any(|s| unstable(&s)), "it falls back");
    assert!(last("tip_u1") > 0.6 && path.last().stability.is_some_and(|s| s.unstable == 0));
}

/// Goal: impossible cases are reported: a beam free at both ends has no support.
#[test]
fn beam_that_nothing_holds_is_refused() {
    let mut free = unit(8, 1.0, json!({"force_x_n": 1.0}));
    free["ends"]["root"] = json!("free");
    let path = path_of(&parse(&free), &EquilibriumOptions::at(1.0));
    let fault = path.fault.expect("no equilibrium");
    assert!(fault.what.contains("no equilibrium"), "{}", fault.what);
    // an equilibrium has no time, so the error reports none
    assert_eq!((fault.at, fault.at.time_s()), (StopPoint::LoadFactor(0.0), None));
    assert!(fault.cause.is_some_and(|c| c.contains("nothing holds")));
}

/// Goal: a path ends at the requested share, even if a step passes it that was predicted to remain below: an arch starts in its rest shape,
/// and larger loads would make it snap through.
#[test]
fn a_path_stops_where_a_step_passes_its_end() {
    let path = path_of(&shipped("snap-arch", &[]), &EquilibriumOptions::at(0.0));
    assert!(path.fault.is_none(), "{:?}", path.fault);
    assert!(path.states.iter().all(|state| state.share <= 1.0) && path.last().share == 1.0);
}

/// Goal: a neo-Hookean section with 60 kPa in both rows leaves the range of its energy at 0.3 to 0.5 of the load, with a turning point at
/// 0.86: the path ends there and reports the position. Before, it continued through 1435 states, to -1.7 times the load.
#[test]
fn a_path_that_turns_back_beyond_the_range_ends() {
    let row = |sign: i32| {
        let bladders: Vec<i32> = (1..=10).map(|k| sign * k).collect();
        json!({"bladders": bladders, "ends": [{"pressure_pa": 60000}, "sealed"]})
    };
    let case = parse(&json!({
        "name": "section",
        "section": {
            "height_m": 0.0216, "width_m": 0.05, "pitch_m": 0.01, "three_d": false,
            "material": {"young_modulus_pa": 5e5, "poisson_ratio": 0.49, "density_kg_m3": 950, "law": "neo_hookean"},
            "bladders": {"length_m": 0.046, "lower": "mirrored", "upper": {"center_m": 0.0049,
                "shape": {"rounded_rectangle": {"along_m": 0.0078, "high_m": 0.0078, "fillet_m": 0.0025}}}}
        },
        "beam": {"length_m": 0.1}, "fluid": {"density_kg_m3": 950, "viscosity_pa_s": 0.1}, "tubes": {"length_m": 0.02, "radius_m": 0.001},
        "network": {"chains": [row(1), row(-1)]}, "ends": {"root": "clamped", "tip": "free"},
        "effects": {"nonlinear_section": "on"}, "mesh": {"cells_per_segment": 2}, "time": {"end_s": 4}
    }));
    let path = path_of(&case, &EquilibriumOptions::at(4.0));
    let fault = path.fault.as_ref().expect("a fault");
    assert!(
        fault.what.contains("turns back at 0.8")
            && fault
                .what
                .contains("section has left the range of its strain energy at"),
        "{}",
        fault.what
    );
    assert!(path.states.len() < 200, "{}", path.states.len());
    assert_eq!(path.events.last().expect("an event").kind, EventKind::LimitPoint);
    let shares = path.states.iter().map(|state| state.share);
    assert!(shares.clone().all(|share| share >= 0.0) && path.last().share < shares.fold(0.0, f64::max));
}

/// Source: a beam without loads, with its root at 1 mm, has its tip at 1 mm. Goal: forces that oppose a velocity do not act on a state at
/// rest: dashpots, quadratic drag, a surrounding fluid, wall damping.
#[test]
fn what_opposes_a_velocity_loads_nothing_at_rest() {
    let held = |at: f64, key: &str, opposes: Value| {
        let root = json!({"clamped": {"u1_m": {"ramp": {"to": at, "start_s": 0.1, "duration_s": 0.2}}}});
        let mut case = json!({
            "name": "held", "beam": {"length_m": 0.1, "height_m": 0.005, "width_m": 0.02, "young_modulus_pa": 1e6, "density_kg_m3": 1000},
            "ends": {"root": root, "tip": "free"}, "mesh": {"segments": 10}, "time": {"end_s": 6.0}
        });
        match key {
            "damping" => case["beam"][key] = opposes,
            _ => case[key] = opposes,
        }
        let (_, of) = solved(&parse(&case));
        of("tip_u1")
    };
    for (key, opposes) in [
        ("attachments", json!([{"at": 0.65, "damping_x_n_s_m": 1.0}])),
        ("damping", json!({"quadratic_drag_n_s2_m3": 1e4})),
        ("surroundings", json!({"density_kg_m3": 998, "drag_coefficient": 2.0})),
    ] {
        let tip = held(1e-3, key, opposes);
        assert!((tip - 1e-3).abs() < 1e-9, "{key}: {tip}");
    }
    let wall = |damping: f64| {
        let wall = json!([{"name": "wall", "point_m": [-0.003, 0], "normal": [1, 0], "stiffness_pa": 1e4, "smoothing_m": 5e-4, "damping_s_m": damping}]);
        held(-4e-3, "contacts", wall)
    };
    let (damped, plain) = (wall(100.0), wall(0.0));
    assert!(plain > -3.9e-3 && (damped - plain).abs() < 1e-9, "{damped} for {plain}");
}
