//! Derivatives of a cycle by numbers of its case.

use super::balanced_cycle::Settled;
use super::record::one_period;
use super::scene::{PeriodicScene, fault};
use crate::case::Case;
use crate::case::parameter::{Parameter, STEPS, change};
use crate::dae::{BeamDae, Dae, EvaluationError, PerturbedSystems};
use crate::error::{Error, Result};
use crate::numerics::krylov;
use crate::onestep::step_map::StepError;
use crate::run::drive::drive;
use crate::run::dynamics::{self, ContinuedDerivatives, Outcome};
use crate::run::record::Recorder;

/// Relative residual of the linear equations.
const LINEAR: f64 = 1e-9;
/// Largest number of disturbances propagated for one number of the case.
const MOST_DISTURBANCES: usize = 300;
/// Relative change of the period, over that of a number, that counts as zero.
const SAME_PERIOD: f64 = 1e-9;

/// `[E76]` Derivatives of the figures of one period of a cycle by numbers of its case:
///
/// ```text
/// s = M s + ∂P/∂σ     w · s = d(w · y₀)/dσ for every conserved w · y
/// ```
///
/// s is the derivative of the state at which the period begins, and M s + ∂P/∂σ that of the state at its end by [E75]. From s,
/// sensitivities are integrated over the period as in any run, [E41]. The outcome is that of [`super::record::record`] with
/// derivatives in its summary.
///
/// # Errors
/// [`Error::Usage`] for a number that changes the period or the unknowns; a period that cannot be integrated.
pub fn differentiate(settled: &mut Settled, parameters: &[Parameter], recorder: &mut dyn Recorder) -> Result<Outcome> {
    let Settled { case, scene, cycle, .. } = settled;
    let mut dae = perturbed(case, scene, parameters)?;
    let most = scene.dimension().min(MOST_DISTURBANCES);
    let mut all = vec![];
    for (k, parameter) in parameters.iter().enumerate() {
        let mut s = kept(case, scene, &cycle.y, parameter, &mut dae.perturbed_mut()[k])?;
        let mut end = s.clone();
        let mut source = |[t, cj]: [f64; 2], [y, yp]: [&[f64]; 2], out: &mut [f64]| {
            dae.approach(cj);
            dae.parameter_derivative(k, t, y, yp, out)
                .map_err(EvaluationError::reason)
        };
        cycle
            .march
            .respond_along([&cycle.y, &cycle.yp], &mut end, &mut source)
            .map_err(fault)?;
        let mut open: Vec<f64> = end.iter().zip(&s).map(|(end, s)| end - s).collect();
        scene.admit(&mut open);
        let (step, left) = krylov::solve(
            |v| {
                cycle.march.propagate(v);
                scene.admit(v);
            },
            &open,
            LINEAR,
            most,
        );
        if !step.iter().all(|x| x.is_finite()) || left > LINEAR.sqrt() {
            let what = format!("the derivative of the cycle by {} was not found", parameter.pointer);
            return Err(fault(StepError::new(0.0, what)));
        }
        s.iter_mut().zip(&step).for_each(|(s, step)| *s += step);
        all.push(s);
    }
    let case = one_period(case, scene.drive.period);
    let along = ContinuedDerivatives {
        by: parameters,
        alike: &|case| scene.like(case),
        s: &all,
    };
    let from = [cycle.y.as_slice(), cycle.yp.as_slice()];
    let mut outcome = dynamics::go_on(&case, scene.system.clone(), from, Some(&along), recorder)?;
    outcome.summary.warnings.extend(scene.trapped.clone());
    Ok(outcome)
}

/// Checks, before the search for a cycle, that it has derivatives by numbers of its case.
///
/// # Errors
/// [`Error::Usage`] for a number that changes the period or the unknowns.
pub fn allowed(case: &Case, scene: &PeriodicScene, parameters: &[Parameter]) -> Result<()> {
    perturbed(case, scene, parameters).map(|_| ())
}

/// Equations of a scene, including those for the changed numbers.
fn perturbed(case: &Case, scene: &PeriodicScene, parameters: &[Parameter]) -> Result<BeamDae> {
    let dae = scene.dae();
    let mut all = vec![];
    for parameter in parameters {
        let refuse = |what: &str| {
            Error::Usage(format!(
                "--sensitivity {}: a small change of it {what}",
                parameter.pointer
            ))
        };
        let of = |(step, _): (f64, f64)| {
            let case = parameter.changed(case, parameter.value * (1.0 + step * change(case)))?;
            let system = scene.like(&case)?;
            let system = system.ok_or_else(|| refuse("changes the set of unknowns"))?;
            let own = scene.drive.period / scene.periods as f64;
            let asked = (!scene.drive.driven).then_some(own);
            match drive(&case, &system.model, asked) {
                Ok(drive) if (drive.period / own - 1.0).abs() <= SAME_PERIOD * change(&case) => Ok(system),
                _ => Err(refuse("changes the period; use the difference of two cycles")),
            }
        };
        let [a, b, c, d] = STEPS.map(of);
        let mut changed = PerturbedSystems::new(&dae, [a?, b?, c?, d?], change(case));
        for beam in changed.beams_mut() {
            beam.enter_smooth_interval(0.5 * scene.drive.period);
        }
        all.push(changed);
    }
    Ok(dae.with_perturbed(all))
}

/// Part of the derivative of a cycle's state along the conserved quantities, which the amount of fluid in the case determines.
fn kept(
    case: &Case,
    scene: &PeriodicScene,
    y: &[f64],
    parameter: &Parameter,
    changed: &mut PerturbedSystems,
) -> Result<Vec<f64>> {
    let mut part = vec![0.0; scene.conserved.len()];
    let cases = STEPS.map(|(step, _)| parameter.changed(case, parameter.value * (1.0 + step * change(case))));
    let [a, b, c, d] = cases;
    let cases = [a?, b?, c?, d?];
    changed.derivative(&mut part, |j, beam, out| {
        out.copy_from_slice(&PeriodicScene::kept(beam.system(), &cases[j], scene.drive.period, y)?);
        Ok::<(), Error>(())
    })?;
    let mut s = vec![0.0; y.len()];
    for (w, part) in scene.conserved.iter().zip(&part) {
        s.iter_mut().zip(w).for_each(|(s, w)| *s += part * w);
    }
    Ok(s)
}
