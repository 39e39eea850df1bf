//! Check valves [E7], pumps [E6], accumulators [E60] and ports that prescribe volumes, against laws integrated by themselves.

#[path = "../common/chance.rs"]
mod chance;
mod controllers;
#[path = "../differences/mod.rs"]
mod differences;
mod hammer;
mod hard;
mod released;
mod stores;
mod valves;
mod volumes;
mod whole;

use std::path::Path;

use slcbeam::case::{self, Case};
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};

/// A rig beside the paper's beam, whose bladders take no part: junctions "a" and "b", a tube between them.
pub const RIG: &str = r#"{
    "name": "rig", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"},
    "network": {
        "junctions": ["a", "b"],
        "tubes": [{"from": {"junction": "a"}, "to": {"junction": "b"}, "length_m": 0.1,
                   "cross_section": {"circle": {"radius_m": 1e-3}}, "loss_coefficient": 0}]
    },
    "ends": {"root": "clamped", "tip": "free"},
    "effects": {"tube_inertia": "off", "tube_losses": "off"},
    "time": {"end_s": 1.0, "output_interval_s": 0.01}, "solver": {"rtol": 1e-9}
}"#;

/// A case of a text, changed.
pub fn read(text: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    case::parse(text, Path::new("mine.json"), Path::new(""), &sets).unwrap()
}

/// Runs it to its end.
pub fn run(text: &str, sets: &[&str]) -> (Memory, Summary) {
    let mut memory = Memory::default();
    let summary = dynamics::run(&read(text, sets), &mut memory).unwrap().summary;
    assert_eq!(summary.status, Status::Finished, "{sets:?}: {:?}", summary.reason);
    (memory, summary)
}

/// Largest difference of two lists, over the largest of the second.
pub fn apart(ours: &[f64], exact: &[f64]) -> f64 {
    assert_eq!(ours.len(), exact.len());
    let size = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let off = ours.iter().zip(exact).map(|(a, b)| (a - b).abs());
    off.fold(0.0, f64::max) / size
}

/// `y' = f(t, y)` from 0, by Runge and Kutta's classical method, at each of some times with so many steps between.
pub fn integrated<const N: usize>(times: &[f64], steps: usize, f: impl Fn(f64, [f64; N]) -> [f64; N]) -> Vec<[f64; N]> {
    let along = |y: [f64; N], h: f64, k: [f64; N]| std::array::from_fn(|i| y[i] + h * k[i]);
    let mut y = [0.0; N];
    let mut all = vec![y];
    for pair in times.windows(2) {
        let h = (pair[1] - pair[0]) / steps as f64;
        for n in 0..steps {
            let t = pair[0] + n as f64 * h;
            let k1 = f(t, y);
            let k2 = f(t + 0.5 * h, along(y, 0.5 * h, k1));
            let k3 = f(t + 0.5 * h, along(y, 0.5 * h, k2));
            let k4 = f(t + h, along(y, h, k3));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        }
        all.push(y);
    }
    all
}
