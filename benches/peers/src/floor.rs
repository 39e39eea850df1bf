//! Cost of large systems, compared with the minimum: one residual and one linear solution per iteration.

use std::time::Instant;

use serde_json::{Value, json};
use slcbeam::case::Case;

use crate::own;
use crate::prices::Bench;
use crate::scene::Scene;

/// Number of timed steps.
const STEPS: usize = 60;
/// Untimed steps before them, in which the step size settles.
const SETTLING: usize = 10;

/// Peak resident memory of this process [bytes]; none if the system does not report it.
fn memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024 * line.split_whitespace().next()?.parse::<u64>().ok()?)
}

/// Vectors of all unknowns that an iteration accesses at least, besides the factors: 5 to set values and rates, 5 to correct them, 2 for
/// the norm, 1 to check that all is finite, 5 to convert units, 3 to scale the residual, and those of the predictor of a stage.
const VECTORS: usize = 24;

/// Time per byte [s] to read an array of `bytes` bytes repeatedly.
fn reading(bytes: usize) -> f64 {
    let numbers = vec![1.0_f64; (bytes / 8).max(1024)];
    let passes = (200_000_000 / bytes.max(1)).clamp(2, 20_000);
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let begin = Instant::now();
        for _ in 0..passes {
            let sums = numbers.chunks_exact(16).fold([0.0; 16], |mut sums, chunk| {
                sums.iter_mut().zip(chunk).for_each(|(sum, x)| *sum += x);
                sums
            });
            std::hint::black_box(sums);
        }
        best = best.min(begin.elapsed().as_secs_f64() / (passes * 8 * numbers.len()) as f64);
    }
    best
}

/// Runs `esdirk46` for `STEPS` steps at rtol 1e-4.
pub fn measure(case: Case) -> Value {
    let begin = Instant::now();
    let scene = Scene::from_case(case);
    let start = begin.elapsed().as_secs_f64();
    let options = own::options(&scene, "esdirk46", 1e-4).expect("a method");
    let begin = Instant::now();
    let mut solver = own::integrator(&scene, scene.dae(), &options).expect("an integrator");
    let set_up = begin.elapsed().as_secs_f64();
    let mut advance = |steps: usize| {
        (0..steps).for_each(|_| {
            solver.step(scene.end()).expect("a step");
        });
        solver.counters()
    };
    let before = advance(SETTLING);
    let begin = Instant::now();
    let after = advance(STEPS);
    let seconds = begin.elapsed().as_secs_f64();
    let memory = memory();
    let mut bench = Bench::new(&scene);
    let [residual, jacobian, factor, solve] = bench.prices();
    let iterations = after.newton_iterations - before.newton_iterations;
    let jacobians = after.jacobian_evaluations - before.jacobian_evaluations;
    let factors = after.factorizations - before.factorizations;
    let bytes = bench.factor_bytes() + 8 * VECTORS * scene.y.len();
    let reading = reading(bytes);
    let floor = iterations as f64 * (residual + solve);
    json!({
        "case": scene.case.name, "unknowns": scene.y.len(), "start": start, "set_up": set_up, "steps": STEPS,
        "seconds": seconds, "iterations": iterations, "jacobians": jacobians, "factorizations": factors,
        "floor": floor, "accounted": floor + jacobians as f64 * jacobian + factors as f64 * factor, "memory": memory,
        "residual": residual, "jacobian": jacobian, "factor": factor, "solve": solve,
        "bytes": bytes, "reading": reading,
    })
}
