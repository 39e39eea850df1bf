//! slcbeam's integrators.

use std::time::Instant;

use serde_json::{Value, json};
use slcbeam::integrate::AbsoluteTolerances;
use slcbeam::onestep::{OneStepOptions, TableauMethod};
use slcbeam::run::method::{Integrator, IntegratorOptions};
use slcbeam::sundials::IdaOptions;

use crate::scene::{Bare, Ran, Scene};

/// Options of a run as in the program, by the name of the method.
pub fn options(scene: &Scene, name: &str, rtol: f64) -> Option<IntegratorOptions> {
    let one_step = |method| {
        IntegratorOptions::OneStep(OneStepOptions {
            method,
            relative: rtol,
            absolute: AbsoluteTolerances::Same(rtol),
            max_step: Some(scene.largest_step),
            ..OneStepOptions::default()
        })
    };
    Some(match name {
        "ida2" => IntegratorOptions::Ida(IdaOptions {
            relative: rtol,
            absolute: AbsoluteTolerances::Same(rtol),
            max_order: 2,
            max_step: Some(scene.largest_step),
            nonlinear_coefficient: 0.033,
            ..IdaOptions::default()
        }),
        "trbdf2" => one_step(TableauMethod::TrBdf2),
        "esdirk34" => one_step(TableauMethod::Esdirk34),
        "esdirk46" => one_step(TableauMethod::Esdirk46),
        "esdirk57" => one_step(TableauMethod::Esdirk57),
        _ => return None,
    })
}

/// An integrator of a scene's equations at its start.
pub fn integrator(scene: &Scene, dae: Bare, options: &IntegratorOptions) -> Result<Integrator<Bare>, String> {
    Integrator::new(dae, 0.0, &scene.y, &scene.yp, options).map_err(|e| e.to_string())
}

/// Integrates to the end of a scene; returns readings at the output times.
fn through(scene: &Scene, solver: &mut Integrator<Bare>) -> Result<Vec<[f64; 2]>, String> {
    let mut y = scene.y.clone();
    let mut readings = vec![];
    while readings.len() < scene.times.len() {
        let at = solver.step(scene.end()).map_err(|e| e.to_string())?.time;
        while let Some(&t) = scene.times.get(readings.len()).filter(|t| **t <= at) {
            solver.interpolate(t, 0, &mut y).map_err(|e| e.to_string())?;
            readings.push(scene.readings.read(&y));
        }
    }
    Ok(readings)
}

/// Time of a run by operation, with work counters.
pub fn profile(scene: &Scene, name: &str, rtol: f64) -> Option<Value> {
    let options = options(scene, name, rtol)?;
    let mut solver = integrator(scene, scene.dae(), &options).ok()?;
    let begin = Instant::now();
    through(scene, &mut solver).ok()?;
    let seconds = begin.elapsed().as_secs_f64();
    let (counters, wall) = (solver.counters(), solver.wall());
    let [residual, jacobian, linear] =
        [wall.residual, wall.jacobian, wall.linear_solver].map(|part| part.as_secs_f64() / seconds);
    Some(json!({
        "seconds": seconds, "steps": counters.steps, "rejected": counters.error_test_failures,
        "not_converged": counters.newton_failures, "iterations": counters.newton_iterations,
        "residuals": counters.residual_evaluations, "jacobians": counters.jacobian_evaluations,
        "factorizations": counters.factorizations, "solutions": counters.linear_solves,
        "residual": residual, "jacobian": jacobian, "linear": linear,
    }))
}

/// Runs a scene; readings at the output times.
pub fn follow(scene: &Scene, options: &IntegratorOptions) -> Result<Ran, String> {
    let dae = scene.dae();
    let begin = Instant::now();
    let mut solver = integrator(scene, dae, options)?;
    let readings = through(scene, &mut solver)?;
    Ok(Ran {
        seconds: begin.elapsed().as_secs_f64(),
        readings,
        steps: solver.steps() as usize,
    })
}
