//! Probes: columns of the history at places that a case names.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::error::Error;
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{Options, columns, follow, system};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::Status;

fn parse(value: &Value) -> Result<Case, Error> {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), &[])
}

/// A cantilever with EI = 1 and l = 1, probes at places, a force or a moment at its tip, `cells` cells.
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
    let path = follow(case, &Options::at(1.0), &mut |_| Control::Continue).unwrap();
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
/// of second order in the mesh: a ninth of the error on three times as many cells.
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

/// Source: a moment M at the tip, a pull F. Goal: strains of the surfaces are `F/EA ± M h/2EI`, and the tip's own columns are those of a
/// probe there, through full turns.
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

/// Goal: in a run with bladders the columns are those of the fields at the place, and a run is the same with probes as without.
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
    assert_eq!(probed.rows[0].len(), plain.rows[0].len() + 2 * 11);
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

/// Goal: a name that is there twice, one that makes no column, and the tip's are refused, all at once.
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
