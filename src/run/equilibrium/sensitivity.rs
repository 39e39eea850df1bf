//! Derivatives of an equilibrium with respect to numbers of its case.

use super::state::State;
use super::{Options, rest, system};
use crate::case::parameter::{CHANGE, Parameter, STEPS};
use crate::case::schema::Case;
use crate::dae::{Dae as _, Seeds, StaticBeam};
use crate::error::{Error, Result};
use crate::sparse::Klu;

/// Derivatives by one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The parameter.
    pub parameter: Parameter,
    /// Derivative of the scaled unknowns.
    pub y: Vec<f64>,
    /// Derivative of each column of a state; of the load factor it is 0.
    pub row: Vec<f64>,
}

/// `[E43]` Derivatives of a state of a case by parameters p, exact but for round-off: the tangent is that of the equations,
/// its factors are made once,
///
/// ```text
/// ∂F/∂y dy/dp = -∂F/∂p        dq/dp = ∂q/∂y dy/dp + ∂q/∂p
/// ```
///
/// and what depends on p alone, without anything to solve, is differenced to fourth order: an error of 1e-12.
///
/// # Errors
/// A changed case that is not valid or has other unknowns, a tangent that is singular.
pub fn differentiate(
    case: &Case,
    options: &Options,
    state: &State,
    parameters: &[Parameter],
) -> Result<Vec<Sensitivity>> {
    let (mut statics, _) = rest(case, system(case, options.at_s)?);
    let mut values = vec![0.0; statics.pattern().entries()];
    let singular = || Error::Usage("the equilibrium has no derivatives: its tangent is singular".into());
    statics
        .jacobian(state.share, &state.y, &[], Seeds::Step { cj: 0.0 }, &mut values)
        .map_err(|_| singular())?;
    let mut factors = Klu::new(statics.pattern()).map_err(|_| singular())?;
    factors.factor(&values).map_err(|_| singular())?;
    let of = |parameter: &Parameter| -> Result<Sensitivity> {
        let mut changed = vec![];
        for (steps, weight) in STEPS {
            let value = parameter.value * (1.0 + steps * CHANGE);
            let case = parameter.changed(case, value)?;
            let (other, _) = rest(&case, system(&case, options.at_s)?);
            if other.len() != statics.len() {
                let what = "the number of unknowns depends on it";
                return Err(Error::Usage(format!("--sensitivity {}: {what}", parameter.pointer)));
            }
            changed.push((
                steps * CHANGE * parameter.value,
                weight / (CHANGE * parameter.value),
                other,
            ));
        }
        let mut y = by_parameter(&statics, &mut changed, state)?;
        y.iter_mut().for_each(|y| *y = -*y);
        factors.solve(&mut y);
        let mut row = vec![0.0; state.row.len()];
        for (step, weight, other) in &mut changed {
            let moved = restated(&statics, other, state, |k| state.y[k] + *step * y[k]);
            let there = State::read(other, &moved);
            row.iter_mut().zip(&there.row).for_each(|(d, q)| *d += *weight * q);
        }
        Ok(Sensitivity {
            parameter: parameter.clone(),
            y,
            row,
        })
    };
    parameters.iter().map(of).collect()
}

/// `∂F/∂p` in the scales of the unchanged system: each of `changed` is a step of p, its weight, and the system with it.
fn by_parameter(statics: &StaticBeam, changed: &mut [(f64, f64, StaticBeam)], state: &State) -> Result<Vec<f64>> {
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

/// Scaled unknowns in the scales of another system, with the load factor behind them.
fn restated(from: &StaticBeam, to: &StaticBeam, state: &State, y: impl Fn(usize) -> f64) -> Vec<f64> {
    let (old, new) = (&from.system().layout.scales, &to.system().layout.scales);
    let scaled = (0..old.len()).map(|k| y(k) * old[k] / new[k]);
    scaled.chain([state.share]).collect()
}
