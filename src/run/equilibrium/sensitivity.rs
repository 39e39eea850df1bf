//! Derivatives of an equilibrium with respect to numbers of its case.

use super::stages::{StageEquilibrium, begin, grow};
use super::state::EquilibriumState;
use super::{EquilibriumOptions, Path};
use crate::case::parameter::{Parameter, STEPS, change};
use crate::case::schema::Case;
use crate::dae::{Dae as _, Seeds, StaticBeam};
use crate::error::{Error, Result};
use crate::sparse::Klu;

/// Derivatives by one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct EquilibriumSensitivity {
    /// The parameter.
    pub parameter: Parameter,
    /// Derivative of the scaled unknowns.
    pub y: Vec<f64>,
    /// Derivative of each column of a state; 0 for the load factor.
    pub row: Vec<f64>,
}

/// A change of the case by one number p.
pub struct ParameterDirection<'a> {
    /// Description of p for messages.
    pub name: String,
    /// A small change of p.
    pub step: f64,
    /// Returns the case with p changed by a number of these steps.
    pub moved: Box<dyn Fn(f64) -> Result<Case> + 'a>,
}

/// Derivatives of a state along a direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivative {
    /// Derivative of the scaled unknowns.
    pub y: Vec<f64>,
    /// Derivative of each column of a state.
    pub row: Vec<f64>,
}

/// Derivatives of the last state of a path by parameters.
///
/// # Errors
/// As [`along`].
pub fn differentiate(
    case: &Case,
    options: &EquilibriumOptions,
    path: &Path,
    parameters: &[Parameter],
) -> Result<Vec<EquilibriumSensitivity>> {
    let change = change(case);
    let direction = |parameter: &Parameter| {
        let own = parameter.clone();
        ParameterDirection {
            name: format!("--sensitivity {}", parameter.pointer),
            step: change * parameter.value,
            moved: Box::new(move |steps| own.changed(case, own.value * (1.0 + steps * change))),
        }
    };
    let directions: Vec<ParameterDirection> = parameters.iter().map(direction).collect();
    let found = along(case, options, path, &directions)?;
    let named = parameters
        .iter()
        .zip(found)
        .map(|(parameter, found)| EquilibriumSensitivity {
            parameter: parameter.clone(),
            y: found.y,
            row: found.row,
        });
    Ok(named.collect())
}

/// `[E43]` Derivatives of the last state of a path by numbers p, exact except for round-off. The tangent is that of the equations and
/// is factored once for each stage:
///
/// ```text
/// ∂F/∂y dy/dp = -∂F/∂p        dq/dp = ∂q/∂y dy/dp + ∂q/∂p
/// ```
/// Terms that depend on p alone need no solution; they are differenced to fourth order with an error of 1e-12. The volume of a closed
/// network in a later stage depends on p through the state in which that stage began. This derivative is carried from stage to
/// stage.
///
/// # Errors
/// A changed case is not valid or has other unknowns, or the tangent is singular.
pub fn along(
    case: &Case,
    options: &EquilibriumOptions,
    path: &Path,
    directions: &[ParameterDirection],
) -> Result<Vec<Derivative>> {
    let mut found: Vec<Derivative> = vec![];
    let mut before: Option<StageEquilibrium> = None;
    let stages = options.resolved(case)?.stages();
    for (number, stage) in stages.iter().enumerate() {
        let Some(state) = path.states.iter().rfind(|state| state.stage == number) else {
            return Err(singular());
        };
        let (mut statics, _) = begin(case, grow(case, stage)?, before.as_ref());
        let mut values = vec![0.0; statics.pattern().entries()];
        statics
            .jacobian(state.share, &state.y, &[], Seeds::Step { cj: 0.0 }, &mut values)
            .map_err(|_| singular())?;
        let mut factors = Klu::new(statics.pattern()).map_err(|_| singular())?;
        factors.factor(&values).map_err(|_| singular())?;
        let mut now = vec![];
        for (k, direction) in directions.iter().enumerate() {
            let earlier = before.as_ref().zip(found.get(k)).map(|(held, one)| (held, &*one.y));
            let mut changed = changed((options, number, stages.len()), direction, &statics, earlier)?;
            let mut y = by_parameter(&statics, &mut changed, state)?;
            y.iter_mut().for_each(|y| *y = -*y);
            factors.solve(&mut y);
            let mut row = vec![0.0; state.row.len()];
            for (step, weight, other) in &mut changed {
                let moved = restated(&statics, other, state, |k| state.y[k] + *step * y[k]);
                let there = EquilibriumState::read(other, &moved, number);
                row.iter_mut().zip(&there.row).for_each(|(d, q)| *d += *weight * q);
            }
            now.push(Derivative { y, row });
        }
        found = now;
        before = Some(StageEquilibrium {
            y: state.y.clone(),
            layout: statics.system().layout.clone(),
        });
    }
    Ok(found)
}

fn singular() -> Error {
    Error::Usage("the equilibrium has no derivatives: its tangent is singular".into())
}

/// Steps of a number, their weights, and the equations of the stage with each step. The equations begin in the last state of the stage
/// before, which is given with its derivative.
fn changed(
    (options, number, count): (&EquilibriumOptions, usize, usize),
    direction: &ParameterDirection,
    statics: &StaticBeam,
    before: Option<(&StageEquilibrium, &[f64])>,
) -> Result<Vec<(f64, f64, StaticBeam)>> {
    let one = |(steps, weight): (f64, f64)| {
        let step = steps * direction.step;
        let case = (direction.moved)(steps)?;
        // a valve may close slightly earlier
        let stages = options.resolved(&case)?.stages();
        let Some(stage) = stages.get(number).filter(|_| stages.len() == count) else {
            let what = "a small change of it changes the number of valve closures";
            return Err(Error::Usage(format!("{}: {what}", direction.name)));
        };
        let held = before.map(|(held, derivative)| StageEquilibrium {
            y: held.y.iter().zip(derivative).map(|(y, d)| y + step * d).collect(),
            layout: held.layout.clone(),
        });
        let grown = grow(&case, stage)?;
        if grown.system.layout.len != statics.len() {
            let what = "the number of unknowns depends on it";
            return Err(Error::Usage(format!("{}: {what}", direction.name)));
        }
        let (other, _) = begin(&case, grown, held.as_ref());
        Ok((step, weight / direction.step, other))
    };
    STEPS.into_iter().map(one).collect()
}

/// `∂F/∂p` in the scales of the unchanged system. Each of `changed` is a step of p, its weight, and the system with this step.
fn by_parameter(
    statics: &StaticBeam,
    changed: &mut [(f64, f64, StaticBeam)],
    state: &EquilibriumState,
) -> Result<Vec<f64>> {
    let n = statics.len();
    let mut sum = vec![0.0; n];
    let mut residual = vec![0.0; n];
    let scales = statics.equation_scales();
    for (_, weight, other) in changed {
        let x = restated(statics, other, state, |k| state.y[k]);
        let fault = |_| Error::Usage("the equations of the changed case cannot be evaluated".into());
        other
            .residual(state.share, &x[..n], &[], &mut residual)
            .map_err(fault)?;
        let others = other.equation_scales();
        for k in 0..n {
            sum[k] += *weight * residual[k] * others[k] / scales[k];
        }
    }
    Ok(sum)
}

/// Scaled unknowns in the scales of another system, followed by the load factor.
fn restated(from: &StaticBeam, to: &StaticBeam, state: &EquilibriumState, y: impl Fn(usize) -> f64) -> Vec<f64> {
    let (old, new) = (&from.system().layout.scales, &to.system().layout.scales);
    let scaled = (0..old.len()).map(|k| y(k) * old[k] / new[k]);
    scaled.chain([state.share]).collect()
}
