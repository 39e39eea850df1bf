//! Loads in sequence: preload, then push.

use std::f64::consts::PI;

use serde_json::{Value, json};
use slcbeam::case::Case;
use slcbeam::case::parameter::Parameter;
use slcbeam::run::equilibrium::{
    EquilibriumOptions, EquilibriumState, EventKind, Path, columns, differentiate, system,
};
use slcbeam::run::record::Memory;
use slcbeam::run::{dynamics, summary::Status};

use crate::common::{parse, path_of, shipped};

/// Axial stiffness, bending stiffness and length of the strip.
const EA: f64 = 1e4;
const EI: f64 = 1e4 * 1e-6 / 12.0;
const LENGTH: f64 = 0.1;
/// Displacement of its ends towards each other.
const CLOSER: f64 = 1e-4;

/// A pinned strip whose ends approach and whose middle is pushed transversely by a force, both signals; the rest curvature is up to
/// `curved` [1/m], with opposite signs of the halves.
fn strip(cells: usize, curved: f64, closer: &Value, push: &Value) -> Case {
    parse(&strip_json(cells, curved, closer, push))
}

fn strip_json(cells: usize, curved: f64, closer: &Value, push: &Value) -> Value {
    json!({
        "name": "strip",
        "beam": {"length_m": LENGTH, "height_m": 0.001, "width_m": 0.01, "young_modulus_pa": 1e9, "density_kg_m3": 1000},
        "ends": {"root": "pinned", "tip": {"pinned": {"u3_m": closer}}},
        "attachments": [{"at": 0.5, "force_x_n": push}],
        "loads": [{"rest_curvature_1_m": {"signal": curved, "profile": {"polynomial": {"coefficients": [1, -2]}}}}],
        "mesh": {"segments": cells, "cells_per_segment": 1}, "probes": [{"name": "middle", "at": 0.5}],
        "time": {"end_s": 3}
    })
}

/// A table of values at whole seconds from `first` on.
fn at_seconds(first: i32, values: &[f64]) -> Value {
    let times: Vec<i32> = (0..values.len() as i32).map(|k| first + k).collect();
    json!({"table": {"times_s": times, "values": values, "interpolation": "linear"}})
}

/// Path through the loads at t = 1, 2, .. in sequence.
fn by_seconds(case: &Case, count: usize) -> Path {
    let via_s = (1..count).map(|k| k as f64).collect();
    let options = EquilibriumOptions {
        via_s,
        points: Some(16),
        ..EquilibriumOptions::at(count as f64)
    };
    let path = path_of(case, &options);
    assert!(path.fault.is_none(), "{:?}", path.fault);
    path
}

/// Deflection of the middle in the last state.
fn middle(path: &Path) -> f64 {
    let u1 = &path.last().u1;
    u1[u1.len() / 2]
}

fn stable(path: &Path) -> bool {
    path.last().stability.is_some_and(|s| s.unstable == 0)
}

/// Source: derived for small rotations. A pinned column of length l whose ends approached by Δ bears the thrust `P = EI k²` and, pushed by
/// F in the middle, has the shape `w' = (F/2P) (1 - cos kx/cos κ)` up to there, `κ = kl/2`. Bending shortens it by `Δ - P l/EA`:
///
/// ```text
/// ∫ w'² dx/2 over the length = (F/2P)² (l/2) (1 - 2 tan κ/κ + (1 + sin 2κ/2κ)/(2 cos² κ)) = Δ - P l/EA
/// ```
///
/// From F = 0 at κ = π/2 on the thrust grows with the push, until at κ = π it is Euler's second load and the column buckles sideways: there
/// the bracket is 3/2, and `F = 16 π²/√3 EI/l² √(Δ/l - 4 π² EI/(EA l²))`.
///
/// Goal: both bifurcations, that of the first stage at Euler's load, within 0.2 % at 80 cells. The mesh error of the thrust is (π h/2)²/12
/// for the first and four times that, 5e-4, for the second; rotations of up to 0.06 rad differ by 1e-3 from small ones.
#[test]
fn pushed_column_gives_way_at_its_exact_load() {
    let full = 0.5;
    let case = strip(80, 0.0, &at_seconds(0, &[0.0, -CLOSER]), &at_seconds(1, &[0.0, -full]));
    let options = EquilibriumOptions {
        via_s: vec![1.0],
        points: Some(16),
        ..EquilibriumOptions::at(2.0)
    };
    let path = path_of(&case, &options);
    let crossings = path.events.iter().filter(|e| e.kind == EventKind::Bifurcation);
    let crossings: Vec<(usize, f64)> = crossings.map(|e| (e.stage, e.share)).collect();
    let euler = PI * PI * EI / (LENGTH * LENGTH * EA) * LENGTH / CLOSER;
    let bent = CLOSER / LENGTH - 4.0 * PI * PI * EI / (EA * LENGTH * LENGTH);
    let push = 16.0 * PI * PI / 3.0_f64.sqrt() * EI / (LENGTH * LENGTH) * bent.sqrt();
    println!("{crossings:?} {euler} {}", push / full);
    assert_eq!((crossings[0].0, crossings[1].0), (0, 1));
    assert!((crossings[0].1 / euler - 1.0).abs() < 2e-3, "{crossings:?} {euler}");
    assert!(
        (crossings[1].1 * full / push - 1.0).abs() < 2e-3,
        "{crossings:?} {push}"
    );
    assert!(
        path.states.iter().any(|s| s.stage == 1 && s.u1[40] < 0.0),
        "it goes through sideways"
    );
}

/// Goal: a strip that is not quite straight at rest snaps through below the bifurcation load of a perfect one, and is then on the other
/// side. Both stages end at their loads, and load factors continue.
#[test]
fn strip_snaps_through_in_its_second_stage() {
    let case = strip(40, 0.05, &at_seconds(0, &[0.0, -CLOSER]), &at_seconds(1, &[0.0, -0.5]));
    let path = by_seconds(&case, 2);
    let bent = path.states.iter().rfind(|s| s.stage == 0).expect("a first stage");
    assert_eq!((bent.share, bent.load_factor()), (1.0, 1.0));
    assert!(bent.u1[20] > 0.0015 && bent.stability.is_some_and(|s| s.unstable == 0));
    let turns: Vec<_> = path.events.iter().filter(|e| e.kind == EventKind::LimitPoint).collect();
    assert!(
        turns.len() >= 2 && turns.iter().all(|e| e.stage == 1),
        "{:?}",
        path.events
    );
    assert!((0.5..1.0).contains(&(turns[0].share * 0.5 / 0.1968)), "{turns:?}");
    assert_eq!(
        (path.last().share, path.last().load_factor(), path.last().row[0]),
        (1.0, 2.0, 2.0)
    );
    assert!(middle(&path) < -0.0015 && stable(&path));
}

/// Goal: `snap-strip` is followed through its snap on any mesh and at any maximum step. The strip is almost symmetric, so its path turns
/// sharply at the bifurcation of a perfect strip, close to another path onto which too long a step leads. Its load is below that of a
/// perfect one, by at most a tenth for this rest curvature, and equal on all meshes to 4e-3, the error of 40 cells. On the way back it
/// turns at the opposite push, by symmetry, to the error of states in between.
#[test]
fn strip_snaps_through_on_any_mesh() {
    let (ei, ea) = (2.4e9 * 1e-9 * 0.01 / 12.0, 2.4e9 * 1e-5);
    let bent = CLOSER / LENGTH - 4.0 * PI * PI * ei / (ea * LENGTH * LENGTH);
    let push = 16.0 * PI * PI / 3.0_f64.sqrt() * ei / (LENGTH * LENGTH) * bent.sqrt();
    for (cells, points) in [(40, 1), (80, 16), (160, 16), (320, 1)] {
        let case = shipped("snap-strip", &[&format!("/mesh/segments={cells}")]);
        let options = EquilibriumOptions {
            via_s: vec![-2.0, -1.0],
            points: Some(points),
            ..EquilibriumOptions::at(1.0)
        };
        let path = path_of(&case, &options);
        assert!(path.fault.is_none(), "{cells} {points}: {:?}", path.fault);
        let turns: Vec<f64> = path.events.iter().filter(|e| e.stage == 2).map(|e| e.share).collect();
        println!("{cells} {points}: {turns:?} {push} {} states", path.states.len());
        assert_eq!(turns.len(), 2, "{cells} {points}: {turns:?}");
        let forces = [turns[0], turns[1]].map(|share| 0.05 - 1.05 * share);
        assert!((-1.0..-0.9).contains(&(forces[0] / push)), "{forces:?} {push}");
        assert!((forces[0] / -0.44022 - 1.0).abs() < 4e-3, "{forces:?}");
        assert!((forces[1] / forces[0] + 1.0).abs() < 1e-3, "{forces:?}");
        assert!(middle(&path) < -0.0015 && stable(&path));
    }
}

/// Goal: if the state is unique, the order of the loads does not matter: a push that no strip on the near side bears. Two Newton
/// iterations, each to 1e-10 of a length.
#[test]
fn order_does_not_matter_where_the_state_is_unique() {
    let closer = |values: &[f64]| at_seconds(0, values);
    let late = by_seconds(
        &strip(
            40,
            0.05,
            &closer(&[0.0, -CLOSER, -CLOSER]),
            &at_seconds(1, &[0.0, -0.5]),
        ),
        2,
    );
    let early = by_seconds(
        &strip(40, 0.05, &closer(&[0.0, 0.0, -CLOSER]), &at_seconds(1, &[-0.5, -0.5])),
        2,
    );
    let far = late.last().u1.iter().zip(&early.last().u1).map(|(a, b)| (a - b).abs());
    let far = far.fold(0.0, f64::max);
    assert!(far < 1e-9 * LENGTH, "{far:e}");
    assert!(early.events.is_empty(), "{:?}", early.events);
}

/// Goal: if two states bear the same loads, their order decides. A push too small to snap the bent strip bends the straight one to its own
/// side.
#[test]
fn order_decides_between_branches() {
    let push = -0.03;
    let of = |closer: [f64; 3], push: [f64; 3]| strip(40, 0.05, &at_seconds(0, &closer), &at_seconds(0, &push));
    let bent_first = of([0.0, -CLOSER, -CLOSER], [0.0, 0.0, push]);
    let pushed_first = of([0.0, 0.0, -CLOSER], [0.0, push, push]);
    let (near, far) = (by_seconds(&bent_first, 2), by_seconds(&pushed_first, 2));
    assert!(stable(&near) && stable(&far));
    assert!(
        middle(&near) > 0.0015 && middle(&far) < -0.0015,
        "{} {}",
        middle(&near),
        middle(&far)
    );
}

/// Goal: a nudge that has ended before the run selects the branch; the run begins on it and remains there.
#[test]
fn run_starts_on_the_side_of_the_nudge() {
    for nudge in [0.02, -0.02] {
        let closer = json!({"ramp": {"to": -CLOSER, "start_s": -2, "duration_s": 1}});
        let mut case = strip_json(20, 0.05, &closer, &at_seconds(-2, &[nudge, nudge, 0.0]));
        case["start"] = json!({"equilibrium": {"loads_at_s": 0, "via_s": [-2, -1]}});
        case["time"]["end_s"] = json!(0.01);
        let case = parse(&case);
        let mut record = Memory::default();
        let outcome = dynamics::run(&case, &mut record).expect("memory");
        assert_eq!(outcome.summary.status, Status::Finished, "{:?}", outcome.summary.reason);
        let u1 = record.column("middle_u1").expect("a column");
        assert!(u1[0] * nudge > 0.0 && u1[0].abs() > 0.0015, "{nudge} {}", u1[0]);
        assert!(u1.iter().all(|u| (u / u1[0] - 1.0).abs() < 1e-6));
    }
}

/// The wet beam of `pluck`: both rows are filled through a tube with a valve, which closes between t = 1 s and 2 s; then the lower row is
/// vented and a force bends the tip.
fn trapped() -> Case {
    let chains = json!([
        {"bladders": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], "ends": ["connected", "sealed"]},
        {"bladders": [-1, -2, -3, -4, -5, -6, -7, -8, -9, -10],
         "ends": [{"pressure_pa": at_seconds(1, &[5000.0, 0.0])}, "connected"]},
    ]);
    let opening = json!({"ramp": {"from": 1, "to": 0, "start_s": 1.2, "duration_s": 0.3}});
    let tubes = json!([{"from": {"bladder": -10, "end": "outlet"}, "to": {"bladder": 1, "end": "inlet"}, "length_m": 0.02,
                        "cross_section": {"circle": {"radius_m": 1e-3}}, "opening": opening}]);
    let sets: Vec<String> = vec![
        format!("/network/chains={chains}"),
        format!(
            "/ends/tip={}",
            json!({"free": {"force_x_n": at_seconds(1, &[0.0, 1.0])}})
        ),
        "/start={}".into(),
        format!("/network/tubes={tubes}"),
        "/time/end_s=2".into(),
    ];
    shipped("pluck", &sets.iter().map(String::as_str).collect::<Vec<_>>())
}

/// Goal: a valve that closes between two stages traps the fluid behind it, to the error of Newton's iteration, while pressures there rise
/// and the other row is vented. Without the first stage the valve is closed before any flow.
#[test]
fn a_valve_that_shuts_traps_its_volume() {
    let case = trapped();
    let path = by_seconds(&case, 2);
    let system = system(&case, 2.0).unwrap();
    let names = columns(&system);
    let pressure = names.iter().position(|c| c.name == "max_pressure").expect("a column");
    let areas = system.layout.network.area.clone();
    let upper = areas.start..areas.start + areas.len() / 2;
    let filled = path.states.iter().rfind(|s| s.stage == 0).expect("a first stage");
    // scales are those of the beam and the same in both stages
    let [before, after] = [filled, path.last()].map(|s| s.y[upper.clone()].iter().sum::<f64>());
    assert!((after / before - 1.0).abs() < 1e-9, "{before} {after}");
    let lower = |s: &EquilibriumState| s.y[upper.end..areas.end].iter().sum::<f64>();
    assert!((lower(path.last()) / lower(filled) - 1.0).abs() > 0.1);
    assert!((path.last().row[pressure] / 5000.0 - 1.0).abs() > 1e-3);
    let empty = path_of(&case, &EquilibriumOptions::at(2.0));
    assert!(empty.last().row[pressure] < 0.9 * path.last().row[pressure]);
}

/// Goal: a valve that opens equalizes pressures under constant loads, and the path continues from there: the final state is that of a valve
/// that was always open.
#[test]
fn a_valve_that_opens_lets_pressures_even_out() {
    let mut shut = trapped();
    let opening = json!({"ramp": {"from": 0, "to": 1, "start_s": 1.2, "duration_s": 0.3}});
    shut.network.as_mut().expect("a network").tubes[0].opening = serde_json::from_value(opening).expect("a signal");
    let mut open = shut.clone();
    open.network.as_mut().expect("a network").tubes[0].opening = slcbeam::functions::Signal::Constant(1.0);
    let [path, other] = [&shut, &open].map(|case| by_seconds(case, 2));
    let begins = path.states.iter().find(|s| s.stage == 1).expect("a second stage");
    assert_eq!(
        begins.load_factor(),
        1.0,
        "where the valve has opened the stage begins anew"
    );
    let at_one = other.states.iter().rfind(|s| s.stage == 0).expect("a first stage");
    for (one, two) in [(begins, at_one), (path.last(), other.last())] {
        let size = two.row.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let far = one
            .row
            .iter()
            .zip(&two.row)
            .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(far < 1e-8 * size, "{far:e} {size}");
    }
}

/// Goal: the volume pumped by a flow port into a closed network remains after the flow has stopped, as with a port that prescribes the
/// volume, 2e-7 m^3 here.
#[test]
fn what_was_pumped_counts() {
    let with = |port: Value| {
        let chains = format!("/network/chains/0/ends/0={port}");
        let case = shipped("pluck", &[&chains, "/start={}", "/time/end_s=2"]);
        let path = path_of(&case, &EquilibriumOptions::at(2.0));
        assert!(path.fault.is_none(), "{:?}", path.fault);
        path.last().row.clone()
    };
    let pumped = with(
        json!({"flow_m3_s": {"table": {"times_s": [0, 0.5, 1], "values": [0, 4e-7, 0], "interpolation": "linear"}}}),
    );
    let let_in = with(json!({"volume_m3": {"ramp": {"to": 2e-7, "duration_s": 1}}}));
    let sealed = with(json!("sealed"));
    for k in 1..4 {
        assert!(
            (pumped[k] / let_in[k] - 1.0).abs() < 1e-9,
            "{k}: {} {}",
            pumped[k],
            let_in[k]
        );
        assert!((pumped[k] - sealed[k]).abs() > 1e-3 * pumped[k].abs());
    }
}

/// Goal: pressures of all bladders are figures and have derivatives. All ten of the pumped row have one pressure, which is proportional to
/// the pumped volume for linear couplings, to 1e-6 for the fourth-order effect of strains on areas; the others have zero.
#[test]
fn bladders_have_pressures_and_derivatives() {
    let port =
        json!({"flow_m3_s": {"table": {"times_s": [0, 0.5, 1], "values": [0, 4e-7, 0], "interpolation": "linear"}}});
    let case = shipped(
        "pluck",
        &[
            &format!("/network/chains/0/ends/0={port}"),
            "/start={}",
            "/time/end_s=2",
        ],
    );
    let options = EquilibriumOptions::at(2.0);
    let path = path_of(&case, &options);
    let names = columns(&system(&case, 2.0).unwrap());
    let place = |name: &str| names.iter().position(|c| c.name == name).expect("a column");
    let row = &path.last().row;
    let pointer = "/network/chains/0/ends/0/flow_m3_s/table/values/1";
    let parameters = [Parameter::find(&case, pointer).expect("a number")];
    let found = differentiate(&case, &options, &path, &parameters).expect("derivatives");
    let full = row[place("max_pressure")];
    for number in 1..=10 {
        let upper = place(&format!("bladder_{number}_pressure"));
        assert!((row[upper] / full - 1.0).abs() < 1e-9, "{number}: {}", row[upper]);
        assert!(
            (found[0].row[upper] * 4e-7 / full - 1.0).abs() < 1e-6,
            "{number}: {} {full}",
            found[0].row[upper] * 4e-7
        );
        assert!(row[place(&format!("bladder__{number}_pressure"))].abs() < 1e-12 * full);
    }
}

/// Goal: derivatives of a state reached in stages, including trapped fluid, agree with differences of complete solutions: fourth order over
/// 1e-3 of the parameter, of states to 1e-10.
#[test]
fn derivatives_go_through_the_stages() {
    let case = trapped();
    let base = by_seconds(&case, 2);
    let options = EquilibriumOptions {
        via_s: vec![1.0],
        ..EquilibriumOptions::at(2.0)
    };
    let pointers = [
        "/bladders/area_per_pressure_m2_per_pa",
        "/beam/young_modulus_pa",
        "/network/chains/1/ends/0/pressure_pa/table/values/0",
    ];
    let parameters: Vec<Parameter> = pointers
        .iter()
        .map(|p| Parameter::find(&case, p).expect("a number"))
        .collect();
    for s in differentiate(&case, &options, &base, &parameters).expect("derivatives") {
        let at = |steps: f64| {
            let changed = s
                .parameter
                .changed(&case, s.parameter.value * (1.0 + 1e-3 * steps))
                .expect("a case");
            by_seconds(&changed, 2).last().row.clone()
        };
        let rows = [at(1.0), at(-1.0), at(2.0), at(-2.0)];
        for (k, found) in s.row.iter().enumerate().take(4).skip(1) {
            let d = (8.0 * (rows[0][k] - rows[1][k]) - (rows[2][k] - rows[3][k])) / (12e-3 * s.parameter.value);
            assert!(
                (found / d - 1.0).abs() < 1e-6,
                "{} {k}: {} {d}",
                s.parameter.pointer,
                found
            );
        }
    }
}
