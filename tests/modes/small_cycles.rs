//! Source: [E37], cycles with an amplitude of a millionth of the length.
//! Goal: the frequency response of the paper's three wirings is the fundamental of their steady cycles, in amplitude and phase.
//! Tolerance: 1e-4 of the amplitude.

use std::f64::consts::TAU;

use nalgebra::Complex;
use slcbeam::case::{self, Case};
use slcbeam::run::periodic::{PeriodicScene, record, shoot};
use slcbeam::run::record::Memory;
use slcbeam::run::response::LinearResponse;

const AMPLITUDE: f64 = 1e-7;
const INPUT: &str = "/ends/root/clamped/u1_m";
const OUTPUT: &str = "tip_u1";

/// A wiring of the paper on a coarse mesh, its root shaken across the beam.
fn wiring(number: usize, shaken: &str) -> Case {
    let path = format!("cases/wiring-{number}.json");
    let text = std::fs::read_to_string(&path).unwrap();
    let sets = [
        format!("/ends/root/clamped={{\"u1_m\":{shaken}}}"),
        "/mesh={\"cells_per_segment\":1,\"cells_per_bladder\":1}".into(),
        "/solver/rtol=1e-7".into(),
    ];
    case::parse(&text, path.as_ref(), "cases".as_ref(), &sets)
        .map_err(|e| format!("{e:?}"))
        .unwrap()
}

/// Fundamental of the output in the steady cycle, over that of the input `sin(2π f t)`.
fn fundamental(number: usize, hz: f64) -> Complex<f64> {
    let shaken = format!("{{\"sine\":{{\"amplitude\":{AMPLITUDE},\"frequency_hz\":{hz}}}}}");
    let case = wiring(number, &shaken);
    let scene = PeriodicScene::new(&case, None).unwrap();
    let cycle = shoot(&scene, None).unwrap();
    let mut rows = Memory::default();
    record::record(&case, &scene, &cycle, &mut rows).unwrap();
    let (t, z) = (rows.column("t").unwrap(), rows.column(OUTPUT).unwrap());
    let count = t.len() - 1;
    let sum: Complex<f64> = (0..count).map(|k| Complex::from_polar(z[k], -TAU * hz * t[k])).sum();
    sum * Complex::new(0.0, 2.0 / (count as f64 * AMPLITUDE))
}

/// Compares every `stride`-th of 20 frequencies between 2 and 200 Hz for each wiring.
fn compare(stride: usize) {
    for number in 1..=3 {
        let linear = LinearResponse::new(&wiring(number, "0.0"), INPUT, &[OUTPUT.into()], None).unwrap();
        let mut solver = linear.solver().unwrap();
        for k in (0..20).step_by(stride) {
            let hz = 2.0 * 100f64.powf(f64::from(k as u32) / 19.0);
            let (found, exact) = (fundamental(number, hz), solver.at(hz).unwrap()[0]);
            let difference = (found - exact).norm() / exact.norm();
            println!("wiring-{number} {hz:.3} Hz: {exact}, difference {difference:.1e}");
            assert!(difference < 1e-4, "wiring-{number} {hz} Hz: {found} for {exact}");
        }
    }
}

#[test]
fn small_cycles_of_the_wirings_are_their_responses() {
    compare(6);
}

#[test]
#[ignore = "takes minutes"]
fn small_cycles_are_responses_at_20_frequencies() {
    compare(1);
}
