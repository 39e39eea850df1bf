//! Equilibria along the load path: KINSOL, arc length, limit points, branches, steady networks, starts of runs.

use std::f64::consts::PI;
use std::path::Path;

use assert_cmd::Command;
use serde_json::{Value, json};
use slcbeam::case::parameter::Parameter;
use slcbeam::case::{self, Case};
use slcbeam::dae::{Dae as _, Seeds, StaticBeam};
use slcbeam::discrete::start;
use slcbeam::run::equilibrium::{self, Kind, Options, columns, differentiate, follow, system};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::{dynamics, summary::Status};

fn parse(value: &Value) -> Case {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), &[])
        .expect("a valid case")
        .case
}

fn shipped(name: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let path = format!("{}/cases/{name}.json", env!("CARGO_MANIFEST_DIR"));
    case::load(path.as_ref(), &sets).expect("a valid case").case
}

/// Unit beam of `EA L²/EI = 1.2e5 factor` with conditions at its tip.
fn unit(cells: usize, factor: f64, tip: Value) -> Value {
    json!({
        "name": "unit", "ends": {"root": "clamped", "tip": {"free": tip}},
        "beam": {"length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4,
                 "axial_stiffness_factor": factor},
        "mesh": {"segments": cells, "cells_per_segment": 1}, "time": {"end_s": 1.0}
    })
}

fn path_of(case: &Case, options: &Options) -> equilibrium::Path {
    follow(case, options, &mut |_| Control::Continue)
}

/// A path that arrives, and a reader of its last state.
fn solved(case: &Case) -> (equilibrium::Path, impl Fn(&str) -> f64 + use<>) {
    let at = case.time.end_s;
    let path = path_of(case, &Options::at(at));
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let (names, row) = (columns(&system(case, at)), path.last().row.clone());
    (path, move |name: &str| {
        row[names.iter().position(|c| c.name == name).expect("a column")]
    })
}

/// Goal: roll-up to a closed ring and to two turns converges from rest and closes to 1e-6 (here 1e-9: the mesh's chords
/// close exactly, Newton leaves 1e-10), whether the beam stretches easily or hardly.
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
            // 22 to 37 Newton steps measured: angles are proportional to the moment, which predictions know.
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

/// Goal: a perfect column leaves the straight path at Euler's load on its mesh, is stable on the branch, and bends to
/// 160 degrees; kept on the straight path it is unstable.
#[test]
fn column_buckles_onto_the_stable_branch() {
    let euler = PI * PI / 4.0;
    let column = parse(&unit(64, 1000.0, json!({"force_z_n": -5.0 * euler})));
    let (path, last) = solved(&column);
    let [event] = path.events.as_slice() else {
        panic!("{:?}", path.events)
    };
    assert_eq!(event.kind, Kind::Bifurcation);
    // (pi h/2)²/12 of the mesh: 5e-5
    assert!((5.0 * event.share - 1.0).abs() < 1e-4, "{event:?}");
    assert!(last("tip_angle").to_degrees() > 160.0 && last("tip_u1") > 0.0);
    assert!(path.states.iter().all(|s| s.stability.is_some_and(|s| s.unstable == 0)));
    let straight = path_of(
        &column,
        &Options {
            branches: false,
            ..Options::at(1.0)
        },
    );
    assert!(straight.last().u1.iter().all(|u| u.abs() < 1e-12));
    // Euler's second load is nine times the first.
    assert_eq!(straight.last().stability.expect("eigenvalues").unstable, 1);
}

/// Goal: a path is followed over limit points (Magnusson, Ristinmaa & Ljung 2001, the extensible elastica): a column so stubby
/// that it is squeezed by a quarter before it buckles, at `P (1 - P/EA) = π² EI/4 L²`, loses load as it bends, and carries
/// more again when it is bent far.
#[test]
fn stubby_column_loses_load_as_it_buckles() {
    let column = parse(&unit(64, 1.05e-4, json!({"force_z_n": -8.0})));
    let (path, last) = solved(&column);
    let kinds: Vec<Kind> = path.events.iter().map(|e| e.kind).collect();
    assert_eq!(kinds, [Kind::Bifurcation, Kind::LimitPoint]);
    let stiffness = 12.6;
    let exact = 0.5 * stiffness * (1.0 - (1.0 - PI * PI / stiffness).sqrt());
    // The chain of links, (pi h/2)²/12 = 5e-5, enlarged where load and squeeze nearly balance.
    assert!(
        (8.0 * path.events[0].share / exact - 1.0).abs() < 2e-4,
        "{:?} {exact}",
        path.events
    );
    let unstable = |s: &&equilibrium::State| s.stability.is_some_and(|s| s.unstable == 1);
    assert!(path.states.iter().any(|s| unstable(&s)), "it falls back");
    assert!(last("tip_u1") > 0.6 && path.last().stability.is_some_and(|s| s.unstable == 0));
}

/// Goal: the exact tangent. The static Jacobian, volumes of closed networks included, against central differences.
#[test]
fn static_jacobian_is_that_of_differences() {
    for name in [
        "wiring-3",
        "network-tour",
        "harvester-crossover-wave",
        "curl",
        "ring-network",
    ] {
        let case = shipped(name, &[]);
        let of = system(&case, case.time.end_s);
        let mut beam = slcbeam::dae::BeamDae::new(of.clone());
        let (inside, now) = beam.instant(0.0);
        let rest = start::state(inside, &case, now);
        let mut statics = StaticBeam::new(of, &rest);
        let n = statics.len();
        let y: Vec<f64> = (0..n).map(|k| 0.03 * (1.7 * k as f64).sin()).collect();
        let mut values = vec![0.0; statics.pattern().entries()];
        statics
            .jacobian(0.7, &y, &[], Seeds::Step { cj: 0.0 }, &mut values)
            .expect("a Jacobian");
        let pattern = statics.pattern().clone();
        let (mut above, mut below) = (vec![0.0; n], vec![0.0; n]);
        for column in (0..n).step_by(7) {
            let step = 1e-6;
            let mut moved = y.clone();
            moved[column] += step;
            statics.residual(0.7, &moved, &[], &mut above).expect("a residual");
            moved[column] -= 2.0 * step;
            statics.residual(0.7, &moved, &[], &mut below).expect("a residual");
            let mut exact = vec![0.0; n];
            for entry in pattern.column(column) {
                exact[pattern.rows[entry] as usize] = values[entry];
            }
            let size = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for row in 0..n {
                let difference = (above[row] - below[row]) / (2.0 * step);
                // Round-off of the residuals, 1e-16 of their size, over 1e-6; and the third derivative.
                assert!(
                    (difference - exact[row]).abs() < 1e-6 * size.max(1.0),
                    "{name}: {row}, {column}"
                );
            }
        }
    }
}

/// Goal: a steady flow is an equilibrium too. Ports of different pressures drive fluid through the chain; the pressures
/// are those of Kirchhoff's equations, linear along equal resistances.
#[test]
fn steady_streaming_is_an_equilibrium() {
    let case = shipped(
        "wiring-2",
        &[
            "/network/chains/1/ends=[{\"pressure_pa\":1000},{\"pressure_pa\":0}]",
            "/bladders/coupling=\"reciprocal\"",
            "/ends/root=\"clamped\"",
        ],
    );
    let (path, last) = solved(&case);
    // The first cell lies half of half a bladder's resistance behind the port: 1/4 of 19 resistances.
    let resistances = 10.0 + 9.0 * (0.020 / 6.72e-13) / (0.046 / 1.55e-12);
    let first = 1000.0 * (1.0 - 0.25 / resistances);
    assert!(
        (last("max_pressure") / first - 1.0).abs() < 1e-6,
        "{} {first}",
        last("max_pressure")
    );
    assert!(path.last().stability.is_some_and(|s| s.unstable == 0));
}

/// Goal: 400 bladders within a second: 23 Newton steps measured, some milliseconds each.
#[test]
fn four_hundred_bladders_take_few_newton_steps() {
    let upper: Vec<i64> = (1..=200).collect();
    let lower: Vec<i64> = upper.iter().map(|b| -b).collect();
    let case = shipped(
        "curl",
        &[
            "/beam/length_m=2.0",
            "/bladders/per_row=200",
            &format!(
                "/network/chains={}",
                json!([
                    {"bladders": upper, "ends": [{"pressure_pa": 50000}, "sealed"]},
                    {"bladders": lower, "ends": ["sealed", "sealed"]},
                ])
            ),
        ],
    );
    let (path, last) = solved(&case);
    assert!(last("tip_angle").abs() > 1.0, "{}", last("tip_angle"));
    assert!(path.work.factorizations < 60, "{:?}", path.work);
}

/// Goal: an actuator curls up by more than half a turn from rest under pressure.
#[test]
fn actuator_curls_beyond_half_a_turn() {
    let (path, last) = solved(&shipped("curl", &[]));
    assert!(last("tip_angle").abs() > PI, "{}", last("tip_angle"));
    assert!(path.events.is_empty());
}

/// Goal: a run that starts in equilibrium stays there, whatever it leaves out: velocities at round-off of the solution,
/// 1e-10 of the deflection times the first frequencies.
#[test]
fn run_stays_in_its_equilibrium() {
    for effects in [
        "\"full\"",
        "\"auto\"",
        "{\"finite_rotation\":\"off\"}",
        "{\"network_pressure_differences\":\"off\"}",
    ] {
        let case = shipped(
            "pluck",
            &[
                "/ends/tip={\"free\":{\"force_x_n\":0.5}}",
                "/start={\"equilibrium\":{},\"pressures\":[{\"bladders\":[1,2,3,4,5,6,7,8,9,10],\"pressure_pa\":2000}]}",
                "/time/end_s=0.05",
                &format!("/effects={effects}"),
            ],
        );
        let mut record = Memory::default();
        let outcome = dynamics::run(&case, &mut record).expect("memory");
        assert_eq!(outcome.summary.status, Status::Finished, "{:?}", outcome.summary.reason);
        let tip = record.column("tip_u1").expect("a column");
        let pressure = record.column("max_pressure").expect("a column");
        assert!(tip[0].abs() > 1e-3 && pressure[0] > 1000.0);
        for (now, first) in [(&tip, tip[0]), (&pressure, pressure[0])] {
            let moved = now.iter().fold(0.0_f64, |m, x| m.max((x / first - 1.0).abs()));
            assert!(moved < 1e-6, "{effects}: {moved:e}");
        }
    }
}

/// Goal: what was held is let go. The run begins bent as the force before t = 0 has it and with the energy of that state.
#[test]
fn plucked_beam_is_let_go() {
    let case = shipped("pluck", &["/time/end_s=0.1"]);
    let mut record = Memory::default();
    let outcome = dynamics::run(&case, &mut record).expect("memory");
    assert_eq!(outcome.summary.status, Status::Finished);
    let held = path_of(&case, &Options::at(-1.0));
    let tip = record.column("tip_u1").expect("a column");
    let last = held.last().u1.last().copied().expect("a node");
    assert!((tip[0] / last - 1.0).abs() < 1e-9, "{} {last}", tip[0]);
    assert!(outcome.summary.balances.energy_residual_relative < 1e-3);
    assert!(tip.iter().any(|u| u * last < 0.0), "it swings through");
}

/// Goal: what cannot be is said. Nothing holds a beam that is free at both ends.
#[test]
fn beam_that_nothing_holds_is_refused() {
    let mut free = unit(8, 1.0, json!({"force_x_n": 1.0}));
    free["ends"]["root"] = json!("free");
    let path = path_of(&parse(&free), &Options::at(1.0));
    let fault = path.fault.expect("no equilibrium");
    assert!(fault.what.contains("no equilibrium"), "{}", fault.what);
    assert!(fault.cause.is_some_and(|c| c.contains("nothing holds")));
}

/// Goal: derivatives by numbers of the case are those of complete solutions. Fourth-order differences of solutions whose
/// corrections are below 1e-10, over steps of 1e-3 and 2e-3: 1e-6 of the derivative.
#[test]
fn sensitivities_are_those_of_differences() {
    let columns_and_case = [
        (
            shipped("curl", &[]),
            vec![
                "/bladders/area_per_moment_m2_per_n_m/opening",
                "/beam/young_modulus_pa",
                "/network/chains/0/ends/0/pressure_pa/ramp/to",
                "/beam/length_m",
            ],
        ),
        (
            shipped(
                "pluck",
                &[
                    "/start/equilibrium/loads_at_s=0",
                    "/ends/tip={\"free\":{\"force_x_n\":1}}",
                ],
            ),
            vec![
                "/ends/tip/free/force_x_n",
                "/tubes/permeability_m4",
                "/bladders/area_per_pressure_m2_per_pa",
            ],
        ),
    ];
    for (case, pointers) in columns_and_case {
        let options = Options::at(case.time.end_s);
        let base = path_of(&case, &options);
        let names = columns(&system(&case, options.at_s));
        let parameters: Vec<Parameter> = pointers
            .iter()
            .map(|p| Parameter::find(&case, p).expect("a number"))
            .collect();
        let found = differentiate(&case, &options, base.last(), &parameters).expect("derivatives");
        for s in found {
            let at = |steps: f64| {
                let value = s.parameter.value * (1.0 + 1e-3 * steps);
                let changed = s.parameter.changed(&case, value).expect("a valid case");
                path_of(&changed, &options).last().row.clone()
            };
            let rows = [at(1.0), at(-1.0), at(2.0), at(-2.0)];
            for k in 0..base.last().row.len() {
                let difference =
                    (8.0 * (rows[0][k] - rows[1][k]) - (rows[2][k] - rows[3][k])) / (12e-3 * s.parameter.value);
                // Round-off is that of the largest of its unit: of a vented bladder's pressure the pressures of the others.
                let alike = |j: &usize| names[*j].unit == names[k].unit && names[*j].name != "load_factor";
                let largest = (0..names.len())
                    .filter(alike)
                    .map(|j| base.last().row[j].abs())
                    .fold(0.0, f64::max);
                let size = largest / s.parameter.value.abs();
                let error = (s.row[k] - difference).abs();
                assert!(
                    error <= 1e-6 * difference.abs() + 1e-7 * size,
                    "{} {k}: {} {difference}",
                    s.parameter.pointer,
                    s.row[k]
                );
            }
        }
    }
}

/// Goal: what cannot be differentiated by is refused in one sentence.
#[test]
fn parameters_that_are_none_are_refused() {
    let case = shipped("curl", &[]);
    for (pointer, words) in [
        ("/bladders/per_row", "count"),
        ("/solver/rtol", "not a part of the model"),
        ("/fluid/viscosity", "/fluid/viscosity_pa_s"),
        ("/ends/tip", "no number"),
        ("/network/chains/1/ends/0/pressure_pa", "it is 0"),
    ] {
        let error = Parameter::find(&case, pointer).expect_err("refused").to_string();
        assert!(error.contains(words), "{pointer}: {error}");
    }
}

fn slcbeam(arguments: &[&str], out: &Path) -> std::process::Output {
    let mut command = Command::cargo_bin("slcbeam").expect("the program");
    command
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments)
        .arg("--out")
        .arg(out)
        .arg("--quiet");
    command.output().expect("it runs")
}

/// Goal: the command leaves table, shapes, numbers and picture, and says on standard output what happened.
#[test]
fn command_fills_its_folder() {
    let out = tempfile::tempdir().expect("a folder");
    let run = slcbeam(
        &[
            "equilibrium",
            "cases/elastica.json",
            "--sensitivity",
            "/beam/young_modulus_pa",
        ],
        out.path(),
    );
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = String::from_utf8_lossy(&run.stdout);
    for word in [
        "bifurcation",
        "stable",
        "derivatives by /beam/young_modulus_pa",
        "files in",
    ] {
        assert!(text.contains(word), "{word}: {text}");
    }
    for file in ["path.csv", "shapes.csv", "equilibrium.json", "path.svg", "case.json"] {
        assert!(out.path().join(file).exists(), "{file}");
    }
    let json = std::fs::read_to_string(out.path().join("equilibrium.json")).expect("a file");
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["status"], "finished");
    assert!(json["stability"]["stable"].as_bool().expect("a verdict"));
    assert!(json["quantities"]["tip_u1_m"].as_f64().expect("a number") > 0.5);
    let table = std::fs::read_to_string(out.path().join("path.csv")).expect("a file");
    let head = "load_factor [1],tip_u1 [m],tip_u3 [m],tip_angle [rad],axial_energy [J],bending_energy [J],bladder_energy [J],unstable_modes [1]";
    assert_eq!(table.lines().next(), Some(head));
}

/// Goal: mistakes get one message and the house's exit codes; a path that ends early keeps its states.
#[test]
fn command_says_what_cannot_be() {
    let out = tempfile::tempdir().expect("a folder");
    for (arguments, code, words) in [
        (
            vec![
                "equilibrium",
                "cases/elastica.json",
                "--sensitivity",
                "/beam/young_modulus",
            ],
            2,
            "young_modulus_pa",
        ),
        (
            vec!["equilibrium", "cases/elastica.json", "--load-factor", "0"],
            2,
            "--load-factor",
        ),
        (
            vec!["equilibrium", "cases/elastica.json", "--set", "/ends/root=\"free\""],
            4,
            "nothing holds",
        ),
        (
            vec!["equilibrium", "cases/elastica.json", "--set", "/beam/length=1"],
            3,
            "length_m",
        ),
        (
            vec!["equilibrium", "cases/pluck.json", "--set", "/start/u1_m=0.001"],
            3,
            "/start/equilibrium finds",
        ),
    ] {
        let run = slcbeam(&arguments, out.path());
        let text = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(code), "{arguments:?}: {text}");
        assert!(text.contains(words), "{arguments:?}: {text}");
    }
}
