//! Probes: history columns at positions given by the case.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::parameter::Parameter;
use slcbeam::case::{self, Case};
use slcbeam::discrete::System;
use slcbeam::error::Error;
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::Status;

fn parse(value: &Value) -> Result<Case, Error> {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), &[])
}

/// Cantilever with EI = 1 and l = 1, probes, a force or a moment at its tip, and `cells` cells.
fn cantilever(tip: &Value, probes: &Value, cells: usize) -> Case {
    let height = 3.5e-4_f64;
    parse(&json!({
        "name": "probed",
        "beam": {"length_m": 1.0, "height_m": height, "width_m": 1.0, "young_modulus_pa": 12.0 / height.powi(3),
                 "density_kg_m3": 1.0 / height},
        "ends": {"root": "clamped", "tip": {"free": tip}},
        "probes": probes,
        "mesh": {"segments": cells, "cells_per_segment": 1},
        "time": {"end_s": 1.0}
    }))
    .unwrap()
}

/// Values at rest, by name.
fn at_rest(case: &Case) -> impl Fn(&str) -> f64 + use<> {
    let path = follow(case, &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let names = columns(&system(case, 1.0).unwrap());
    let row = path.last().row.clone();
    move |name| {
        row[names
            .iter()
            .position(|c| c.name == name)
            .unwrap_or_else(|| panic!("{name}"))]
    }
}

/// Source: the linear cantilever, `u = P x² (3 l - x)/6EI`, `κ = -P (l - x)/EI`, `V = -M'`. Goal: probes between nodes and at the ends are
/// second order in the mesh: three times the cells give a ninth of the error.
#[test]
fn probes_of_a_cantilever_are_of_second_order() {
    let (p, places) = (1e-3, [0.0, 0.031, 0.4, 0.77, 0.985, 1.0]);
    let probes: Vec<Value> = places
        .iter()
        .enumerate()
        .map(|(k, at)| json!({"name": format!("p{k}"), "at": at}))
        .collect();
    let error = |cells: usize| -> f64 {
        let at = at_rest(&cantilever(&json!({"force_x_n": p}), &json!(probes), cells));
        let each = places.iter().enumerate().map(|(k, &x)| {
            let exact = [
                ("u1", p * x * x * (3.0 - x) / 6.0),
                ("angle", p * x * (1.0 - 0.5 * x)),
                ("curvature", -p * (1.0 - x)),
                ("moment", -p * (1.0 - x)),
                ("shear_force", -p),
            ];
            let off = exact.map(|(what, exact)| (at(&format!("p{k}_{what}")) - exact).abs() / p);
            off.into_iter().fold(0.0, f64::max)
        });
        each.fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(10), error(30));
    println!("10 cells {coarse:.1e}, 30 cells {fine:.1e}");
    assert!(
        coarse < 5e-3 && (6.0..12.0).contains(&(coarse / fine)),
        "{coarse:e} {fine:e}"
    );
}

/// Source: a moment M and a pull F at the tip. Goal: surface strains are `F/EA ± M h/2EI`, and the tip's own columns equal those of a probe
/// there, through full turns.
#[test]
fn surfaces_and_the_tip() {
    let tip = json!({"moment_n_m": 15.0, "force_z_n": 0.0});
    let case = cantilever(
        &tip,
        &json!([{"name": "middle", "at": 0.43}, {"name": "end", "at": 1.0}]),
        40,
    );
    let at = at_rest(&case);
    let height = 3.5e-4;
    let bent = at("middle_curvature") * 0.5 * height;
    assert!((at("middle_curvature").abs() - 15.0).abs() < 1e-6);
    assert!((at("middle_strain_upper") - bent).abs() < 1e-9 && (at("middle_strain_lower") + bent).abs() < 1e-9);
    assert!(at("tip_angle").abs() > std::f64::consts::TAU);
    for what in ["u1", "u3", "angle"] {
        let (own, probed) = (at(&format!("tip_{what}")), at(&format!("end_{what}")));
        assert!(
            (own - probed).abs() < 1e-12 * own.abs().max(1.0),
            "{what}: {own} {probed}"
        );
    }
    assert!((at("middle_angle") - 0.43 * at("tip_angle")).abs() < 1e-6 * at("tip_angle").abs());
}

/// Source: the linear cantilever with a force P on its tip, `σ = ∓ P (l - x) h/2I` at the surfaces, `6 P l/(b h²)` at the root. Goal:
/// meshes of second order agree to 5e-3, of fourth order to 1e-4, at the root, within and at the tip.
#[test]
fn stresses_of_a_cantilever_are_those_of_its_moment() {
    let height = 3.5e-4_f64;
    let p = 1e-4;
    let places = [0.0, 0.3, 0.73, 1.0];
    let probes: Vec<Value> = places
        .iter()
        .enumerate()
        .map(|(k, at)| json!({"name": format!("p{k}"), "at": at}))
        .collect();
    for (order, tolerance) in [(2, 5e-3), (4, 1e-4)] {
        let mut case = cantilever(&json!({"force_x_n": p}), &json!(probes), 20);
        case.mesh.order = Some(order);
        let at = at_rest(&case);
        let root = 6.0 * p / height.powi(2);
        for (k, place) in places.iter().enumerate() {
            let exact = root * (1.0 - place);
            for (surface, exact) in [("upper", -exact), ("lower", exact)] {
                let off = at(&format!("p{k}_stress_{surface}")) - exact;
                println!("order {order}, {place}, {surface}: {:.1e}", off / root);
                assert!(
                    off.abs() < tolerance * root,
                    "order {order}, {place}, {surface}: {off:e}"
                );
            }
        }
    }
    // a pull F: σ = F/A
    let pulled = cantilever(&json!({"force_z_n": 0.5}), &json!([{"name": "middle", "at": 0.5}]), 20);
    let at = at_rest(&pulled);
    for surface in ["middle_stress_upper", "middle_stress_lower"] {
        assert!((at(surface) * height / 0.5 - 1.0).abs() < 1e-6, "{}", at(surface));
    }
}

/// Source: a creeping solid carries its load by the same stress, `σ = M h/2I`, while its strain grows. Goal: stresses include those of the
/// Maxwell branches; strain times Young's modulus alone is half as large at the beginning.
#[test]
fn stresses_of_a_solid_that_relaxes_carry_its_moment() {
    let height = 0.01;
    let case = parse(&json!({
        "name": "creeping",
        "beam": {"length_m": 0.5, "height_m": height, "width_m": 0.1, "young_modulus_pa": 1e6, "density_kg_m3": 1000.0,
                 "viscoelasticity": {"prony": [{"modulus_ratio": 1.0, "time_s": 0.5}]},
                 "damping": {"drag_n_s_m2": 0.5}},
        "ends": {"root": "clamped", "tip": {"free": {"force_x_n": {"ramp": {"from": 0, "to": 1e-3, "duration_s": 0.2}}}}},
        "probes": [{"name": "inner", "at": 0.25}],
        "mesh": {"segments": 20, "cells_per_segment": 1},
        "time": {"end_s": 2.0, "output_interval_s": 0.02}
    }))
    .unwrap();
    let mut memory = Memory::default();
    let summary = dynamics::run(&case, &mut memory).unwrap().summary;
    assert_eq!(summary.status, Status::Finished);
    let column = |name: &str| memory.column(&format!("inner_{name}")).unwrap();
    let (moment, upper, lower) = (column("moment"), column("stress_upper"), column("stress_lower"));
    let strain = column("strain_upper");
    let modulus = 0.1 * height * height / 6.0;
    let size = moment.iter().fold(0.0_f64, |most, m| most.max(m.abs())) / modulus;
    for k in 0..moment.len() {
        let off = 0.5 * (upper[k] - lower[k]) - moment[k] / modulus;
        assert!(off.abs() < 1e-3 * size, "{k}: {off:e} of {size:e}");
    }
    // the branch follows the strain of the same run: ε_v' = (ε - ε_v)/τ, σ = E (ε + g (ε - ε_v))
    let mut branch = 0.0;
    for k in 1..strain.len() {
        branch += (1.0 - (-0.02_f64 / 0.5).exp()) * (0.5 * (strain[k - 1] + strain[k]) - branch);
        let exact = 1e6 * (strain[k] + (strain[k] - branch));
        assert!(
            (upper[k] - exact).abs() < 1e-2 * size,
            "{k}: {:e}, not {exact:e}",
            upper[k]
        );
    }
    let carried = |k: usize| 1e6 * strain[k] / upper[k];
    let last = carried(moment.len() - 1);
    assert!(carried(5) < 0.6 && last > 0.7, "{} {last}", carried(5));
}

/// Goal: with bladders, probe columns equal the fields at the same position, and probes do not change the run.
#[test]
fn columns_of_a_run_are_its_fields() {
    let with = |sets: &[&str]| {
        let sets: Vec<String> = [&[r#"/time={"end_s": 0.1, "output_interval_s": 5e-3}"#], sets]
            .concat()
            .iter()
            .map(|s| (*s).into())
            .collect();
        let case = case::load(Path::new("cases/tour-harvester.json"), &sets).unwrap();
        let mut memory = Memory::default();
        let summary = dynamics::run(&case, &mut memory).unwrap().summary;
        assert_eq!(summary.status, Status::Finished);
        memory
    };
    let (plain, probed) = (
        with(&[]),
        with(&[r#"/probes=[{"name": "a", "at": 0.25}, {"name": "b", "at": 0.999}]"#]),
    );
    assert_eq!(plain.column("tip_u1"), probed.column("tip_u1"));
    assert_eq!(probed.rows[0].len(), plain.rows[0].len() + 2 * 13);
    let bladder = probed.header.axes.iter().find(|axis| axis.name == "bladder").unwrap();
    let last = |name: &str| *probed.column(name).unwrap().last().unwrap();
    for (name, number) in [
        ("a_pressure_upper", 3.0),
        ("a_pressure_lower", -3.0),
        ("b_pressure_upper", 10.0),
    ] {
        let cells = || bladder.values.iter().enumerate().filter(|(_, b)| **b == number);
        let field = probed.field("pressure_pa").unwrap().last().unwrap();
        let mean = cells().map(|(k, _)| field[k]).sum::<f64>() / cells().count() as f64;
        assert!(
            (last(name) - mean).abs() < 1e-9 * mean.abs(),
            "{name}: {} {mean}",
            last(name)
        );
    }
}

/// Goal: duplicate names, names that make no column, and the tip's names are rejected in one error.
#[test]
fn names_that_are_taken_are_refused() {
    let mut case = json!({
        "name": "probed", "preset": "matia-gat-beam", "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1.0},
        "probes": [{"name": "a", "at": 0.1}, {"name": "a", "at": 0.2}, {"name": "tip", "at": 1}, {"name": "a b", "at": 0}]
    });
    let Err(Error::Case(fault)) = parse(&case) else {
        panic!()
    };
    let at: Vec<&str> = fault.violations.iter().map(|v| v.pointer.as_str()).collect();
    assert_eq!(at, ["/probes/1/name", "/probes/2/name", "/probes/3/name"]);
    case["probes"] = json!([{"name": "a", "at": 1.5}]);
    assert!(parse(&case).is_err());
}

/// A shaken wet beam with a probe.
fn shaken(sets: &[&str]) -> Case {
    let own = [
        r#"/time={"end_s": 0.06, "output_interval_s": 1e-4, "window_s": 0.02}"#,
        r#"/probes=[{"name": "a", "at": 0.37}, {"name": "end", "at": 1.0}]"#,
    ];
    let sets: Vec<String> = own.iter().chain(sets).map(|s| (*s).into()).collect();
    case::load(Path::new("cases/tour-harvester.json"), &sets).unwrap()
}

/// Goal: summary figures of a probe are those of the motion. They agree with a fine history even if only the ends of the run are written,
/// and at the tip with the tip's own figures.
#[test]
fn figures_at_probes_are_those_of_the_motion() {
    let mut memory = Memory::default();
    let fine = dynamics::run(&shaken(&[]), &mut memory).unwrap().summary;
    let coarse = dynamics::run(&shaken(&["/time/output_interval_s=0.06"]), &mut Memory::default())
        .unwrap()
        .summary;
    let times = memory.column("t").unwrap();
    assert_eq!(fine.probes.len(), 2 * 13);
    for (name, column) in [
        ("a_u1_m", "a_u1"),
        ("a_moment_n_m", "a_moment"),
        ("a_curvature_per_m", "a_curvature"),
        ("a_strain_upper", "a_strain_upper"),
        ("a_pressure_lower_pa", "a_pressure_lower"),
    ] {
        let values = memory.column(column).unwrap();
        let largest = |from: f64| {
            let sizes = times.iter().zip(&values).filter(|(t, _)| **t >= from - 1e-9);
            sizes.map(|(_, v)| v.abs()).fold(0.0, f64::max)
        };
        let in_window = || times.iter().zip(&values).filter(|(t, _)| **t >= 0.04 - 1e-9);
        let pairs = in_window().zip(in_window().skip(1));
        let squares: f64 = pairs.map(|((a, v), (b, w))| 0.5 * (b - a) * (v * v + w * w)).sum();
        for (summary, tolerance) in [(&fine, 2e-3), (&coarse, 2e-3)] {
            let told = &summary.probes[name];
            let close = |told: Option<f64>, own: f64| {
                let told = told.unwrap_or(f64::NAN);
                assert!((told - own).abs() <= tolerance * own.abs(), "{name}: {told} {own}");
            };
            close(told.last, *values.last().unwrap());
            close(told.max_abs, largest(0.0));
            close(told.window_max_abs, largest(0.04));
            close(told.window_rms, (squares / 0.02).sqrt());
            let at = told.max_abs_at_s.unwrap();
            let nearest = times.iter().position(|t| *t >= at - 0.5e-4).unwrap();
            close(told.max_abs, values[nearest].abs());
        }
    }
    for what in ["u1_m", "u3_m", "angle_rad"] {
        let (own, probed) = (
            &fine.quantities[&format!("tip_{what}")],
            &fine.probes[&format!("end_{what}")],
        );
        for ((key, a), (_, b)) in own.figures().zip(probed.figures()) {
            assert!((a - b).abs() < 2e-3 * a.abs(), "{what} {key}: {a} {b}");
        }
    }
}

/// Source: the history of the same run, a motion that creeps for seconds. Goal: on a mesh of fourth order, with forces and strains by
/// [E77], window figures also agree with the history. Tolerance: trapezoidal rule of the history, and cubics over long steps.
#[test]
fn figures_on_a_mesh_of_fourth_order_are_those_of_the_motion() {
    let sets = ["/mesh/order=4", "/time/output_interval_s=0.001"].map(String::from);
    let case = case::load(Path::new("cases/air-actuator.json"), &sets).unwrap();
    let mut memory = Memory::default();
    let summary = dynamics::run(&case, &mut memory).unwrap().summary;
    let times = memory.column("t").unwrap();
    for (figure, column) in [
        ("far_strain_upper", "far_strain_upper"),
        ("far_curvature_per_m", "far_curvature"),
        ("far_normal_force_n", "far_normal_force"),
        ("far_moment_n_m", "far_moment"),
    ] {
        let values = memory.column(column).unwrap();
        let largest = values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let window = || times.iter().zip(&values).filter(|(t, _)| **t >= 4.8 - 1e-9);
        let pairs = window().zip(window().skip(1));
        let squares: f64 = pairs.map(|((a, v), (b, w))| 0.5 * (b - a) * (v * v + w * w)).sum();
        let told = &summary.probes[figure];
        for (told, own) in [(told.max_abs, largest), (told.window_rms, (squares / 0.2).sqrt())] {
            let told = told.unwrap_or(f64::NAN);
            assert!((told - own).abs() <= 2e-3 * largest, "{figure}: {told:e} {own:e}");
        }
    }
}

/// Goal: derivatives of probe columns and figures agree with differences of runs.
#[test]
fn derivatives_at_probes_are_differences_of_runs() {
    let tight = "/solver/rtol=1e-9";
    let case = shaken(&[tight]);
    let by = Parameter::find(&case, "/beam/young_modulus_pa").unwrap();
    let (value, pointer) = (by.value, by.pointer.clone());
    let mut memory = Memory::default();
    let with = dynamics::run_with(&case, System::new(&case).unwrap(), &[by], &mut memory).unwrap();
    let derivatives = &with.summary.sensitivities[&pointer].probes;
    assert_eq!(derivatives.len(), 2 * 13);
    let step = 1e-3;
    let [less, more] = [-step, step].map(|step| {
        let set = format!("{pointer}={:e}", value * (1.0 + step));
        dynamics::run(&shaken(&[tight, &set]), &mut Memory::default())
            .unwrap()
            .summary
    });
    for name in [
        "a_u1_m",
        "a_moment_n_m",
        "a_curvature_per_m",
        "a_pressure_upper_pa",
        "end_angle_rad",
    ] {
        let all = derivatives[name]
            .figures()
            .zip(less.probes[name].figures())
            .zip(more.probes[name].figures());
        for (((key, slope), (_, less)), (_, more)) in all {
            let difference = (more - less) / (2.0 * step * value);
            let scale = with.summary.probes[name].size() / value;
            println!("{name} {key}: {:.6} {:.6}", slope / scale, difference / scale);
            // largest values of derivatives are taken at output times
            assert!(
                (slope - difference).abs() < 5e-3 * scale,
                "{name} {key}: {slope:e} {difference:e}"
            );
        }
    }
    let column = format!("d a_u1/d {pointer} [m per unit]");
    let place = memory
        .header
        .sensitivities
        .iter()
        .position(|name| *name == column)
        .unwrap();
    let last = memory.sensitivities.last().unwrap()[place];
    assert_eq!(Some(last), derivatives["a_u1_m"].last);
}
