//! Equilibria by continuation.

use std::path::Path;
use std::time::Instant;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::equilibrium::{self, Options};
use slcbeam::run::record::Control;

fn case(value: &Value) -> Case {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), &[])
        .unwrap()
        .case
}

fn unit(cells: usize, factor: f64, tip: Value) -> Value {
    json!({
        "name": "x", "beam": {"length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4,
        "axial_stiffness_factor": factor},
        "ends": {"root": "clamped", "tip": {"free": tip}},
        "mesh": {"segments": cells, "cells_per_segment": 1}, "time": {"end_s": 1.0}
    })
}

fn show(name: &str, value: &Value) {
    let case = case(value);
    let begin = Instant::now();
    let path = equilibrium::follow(&case, &Options::at(1.0), &mut |_| Control::Continue);
    println!(
        "{name}: {} states {} rejected {:?} {:.3} s {:?} fault {:?}",
        path.states.len(),
        path.rejected,
        path.work,
        begin.elapsed().as_secs_f64(),
        &path.last().row[..4.min(path.last().row.len())],
        path.fault.as_ref().map(|f| &f.what)
    );
    println!("  {:?}", path.events);
    if path.states.len() < 60 {
        println!(
            "  {:?}",
            path.states
                .iter()
                .map(|s| (s.share * 1e3).round() / 1e3)
                .collect::<Vec<_>>()
        );
    }
}

#[test]
fn look() {
    for f in [1.0, 1000.0] {
        show(
            "elastica 2.2",
            &unit(64, f, json!({"force_x_n": 0.001, "force_z_n": -2.2*2.467})),
        );
        show("elastica 2.2 perfect", &unit(64, f, json!({"force_z_n": -2.2*2.467})));
        show(
            "elastica 20 degrees",
            &unit(64, f, json!({"force_z_n": -1.015396866*2.4674011})),
        );
        show(
            "elastica 160 degrees",
            &unit(64, f, json!({"force_z_n": -5.0*2.4674011})),
        );
    }
    for name in [
        "wiring-1",
        "wiring-2",
        "wiring-3",
        "bend-wet",
        "stretch-wet",
        "network-tour",
        "ring-network",
        "roll-up",
        "valves-half",
        "harvester-crossover-wave",
        "two-bladders",
        "spin-up",
    ] {
        let case = case::load(format!("cases/{name}.json").as_ref(), &[]).unwrap().case;
        for t in [0.0, case.time.end_s] {
            let begin = Instant::now();
            let path = equilibrium::follow(&case, &Options::at(t), &mut |_| Control::Continue);
            println!(
                "{name} {t}: {} states {} rejected {:?} {:.3} s {:?} {:?} fault {:?}",
                path.states.len(),
                path.rejected,
                path.work,
                begin.elapsed().as_secs_f64(),
                path.events,
                &path.states.last().map(|s| s.row.clone()),
                path.fault
            );
        }
    }
}
