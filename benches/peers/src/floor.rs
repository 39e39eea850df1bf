//! What large systems cost, beside the floor: one residual and one solution an iteration.

use std::time::Instant;

use serde_json::{Value, json};
use slcbeam::case::Case;

use crate::own;
use crate::prices::Bench;
use crate::scene::Scene;

/// Steps that are timed.
const STEPS: usize = 60;
/// Steps before them, while sizes settle.
const SETTLING: usize = 10;

/// Largest resident memory of this process so far [bytes]; nothing where the system does not tell.
fn memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024 * line.split_whitespace().next()?.parse::<u64>().ok()?)
}

/// Runs `esdirk46` for a while at rtol 1e-4.
pub fn measure(case: Case) -> Value {
    let begin = Instant::now();
    let scene = Scene::of(case);
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
    let floor = iterations as f64 * (residual + solve);
    json!({
        "case": scene.case.name, "unknowns": scene.y.len(), "start": start, "set_up": set_up, "steps": STEPS,
        "seconds": seconds, "iterations": iterations, "jacobians": jacobians, "factorizations": factors,
        "floor": floor, "accounted": floor + jacobians as f64 * jacobian + factors as f64 * factor, "memory": memory,
        "residual": residual, "jacobian": jacobian, "factor": factor, "solve": solve,
    })
}
