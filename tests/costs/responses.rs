//! Cost of a frequency response: solutions of the equations, and times.
//!
//! Source: direct solutions at frequencies that the approximation does not use. Goal: few solutions, for 20 and for 2000 bladders. Times are
//! printed and judge nothing.

use std::f64::consts::TAU;
use std::path::Path;
use std::time::Instant;

use slcbeam::case::{self, Case};
use slcbeam::study::response::Request;
use slcbeam::study::response::approximation::ApproximatedResponse;

/// Permitted error of the approximation.
const ERROR: f64 = 1e-5;

fn request(output: &str, band: [f64; 2]) -> Request {
    Request {
        input: "/ends/root/clamped/u1_m".into(),
        outputs: vec![output.into()],
        at: None,
        band,
        points: 1000,
    }
}

/// Number of solutions for a response over a band [Hz], after a comparison with direct ones.
fn solutions(case: &Case, request: &Request) -> usize {
    let clock = Instant::now();
    let linear = request.compute(case).expect("a response");
    let linearised = clock.elapsed();
    let clock = Instant::now();
    let found = ApproximatedResponse::new(&linear, request.band, &[], ERROR).expect("an approximation");
    let adaptive = clock.elapsed();
    let mut direct = linear.solver().expect("factors");
    let [from, to] = request.band;
    let clock = Instant::now();
    for k in 0..20 {
        let hz = from * (to / from).powf((f64::from(k) + 0.37) / 20.0);
        let exact = direct.at(hz).expect("a solution");
        let error = (found.at(hz)[0] - exact[0]).norm() / exact[0].norm().max(found.medians[0]);
        assert!(error < 3.0 * ERROR, "{hz} Hz: {error:e}");
    }
    let one = clock.elapsed() / 20;
    println!(
        "{}: {} unknowns, linearized in {linearised:?}, {} solutions in {adaptive:?}, a direct one {one:?}",
        case.name,
        linear.about.y.len(),
        found.samples.omega.len()
    );
    assert!(found.fit.poles().iter().any(|s| s.im < TAU * to));
    found.samples.omega.len()
}

#[test]
fn a_wiring_needs_few_solutions() {
    let root = ["/ends/root/clamped={\"u1_m\":{\"sine\":{\"amplitude\":1e-5,\"frequency_hz\":20}}}".to_owned()];
    let case = case::load(Path::new("cases/wiring-3.json"), &root).expect("a case");
    let found = solutions(&case, &request("tip_u1", [1.0, 200.0]));
    assert!(found < 200, "{found} solutions");
}

/// A beam of ten metres with oil in its bladders, whose waves decay on their way.
#[test]
fn two_thousand_bladders_need_few_solutions() {
    let row = |from: i64, to: i64| (from..=to).collect::<Vec<_>>();
    let text = serde_json::json!({
        "name": "long", "preset": "matia-gat-beam",
        "beam": {"length_m": 10, "damping": {"bending_time_s": 5e-4, "axial_time_s": 5e-4}},
        "bladders": {"coupling": "reciprocal", "per_row": 1000}, "formulation": "conservative",
        "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": 0.1},
        "network": {"chains": [{"bladders": row(1, 1000)}, {"bladders": row(-1000, -1)}]},
        "ends": {"root": {"clamped": {"u1_m": {"sine": {"amplitude": 1e-5, "frequency_hz": 20}}}}, "tip": "free"},
        "mesh": {"cells_per_segment": 2, "cells_per_bladder": 1}, "time": {"end_s": 1}
    });
    let case = case::parse(&text.to_string(), Path::new("long.json"), Path::new("."), &[]).expect("a case");
    let found = solutions(&case, &request("bladder_20_pressure_pa", [50.0, 200.0]));
    assert!(found < 100, "{found} solutions");
}
