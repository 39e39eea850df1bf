//! Consistent initial values of sensitivities: one linear system, with the matrix of a consistent start.

use crate::dae::{Dae, EvaluationError, Seeds};
use crate::sparse::{Klu, KluError};

/// Solves `F_y s + F_y' s' + ∂F/∂σₖ = 0` ([E41]) for the sensitivities of algebraic unknowns and the rates of
/// those of differential ones, for every parameter k of the equations; `(y, yp)` is consistent.
///
/// Differential entries of `s[k]` are kept; rates of algebraic ones are set to 0. One correction reduces the rounding error of the
/// factors. Panics if a slice and the unknowns differ in length.
///
/// # Errors
/// Error message: an error of the equations, or a singular matrix.
pub fn consistent_sensitivities<D: Dae>(
    dae: &mut D,
    t: f64,
    [y, yp]: [&[f64]; 2],
    s: &mut [Vec<f64>],
    sp: &mut [Vec<f64>],
) -> Result<(), String> {
    if s.is_empty() {
        return Ok(());
    }
    let differential = dae.differential().to_vec();
    let seed = |kind: bool| -> Vec<f64> { differential.iter().map(|&d| f64::from(u8::from(d == kind))).collect() };
    let (y_seeds, yp_seeds) = (seed(false), seed(true));
    let mut klu = Klu::new(dae.pattern()).map_err(|fault| no_factors(dae, fault))?;
    let mut values = vec![0.0; klu.entries()];
    let seeds = Seeds::Columns {
        y: &y_seeds,
        yp: &yp_seeds,
    };
    dae.jacobian(t, y, yp, seeds, &mut values)
        .map_err(EvaluationError::reason)?;
    klu.factor(&values).map_err(|fault| no_factors(dae, fault))?;
    let (mut slope, mut residual) = (vec![0.0; y.len()], vec![0.0; y.len()]);
    for (k, (s, sp)) in s.iter_mut().zip(sp).enumerate() {
        for (i, &differential) in differential.iter().enumerate() {
            if !differential {
                s[i] = 0.0;
            }
            sp[i] = 0.0;
        }
        dae.parameter_derivative(k, t, y, yp, &mut slope)
            .map_err(EvaluationError::reason)?;
        for _ in 0..2 {
            let out = &mut [residual.as_mut_slice()];
            dae.tangent(t, y, yp, [&[s.as_slice()], &[sp.as_slice()]], out)
                .map_err(EvaluationError::reason)?;
            residual.iter_mut().zip(&slope).for_each(|(r, slope)| *r += slope);
            klu.solve(&mut residual);
            for (i, correction) in residual.iter().enumerate() {
                let z = if differential[i] { &mut sp[i] } else { &mut s[i] };
                *z -= correction;
            }
        }
        if let Some(i) = (0..y.len()).find(|&i| !(s[i].is_finite() && sp[i].is_finite())) {
            return Err(format!("the sensitivity of {} is not finite", dae.name(i)));
        }
    }
    Ok(())
}

fn no_factors<D: Dae>(dae: &D, fault: KluError) -> String {
    match fault {
        KluError::Singular { column } => format!("no remaining equation determines {}", dae.name(column)),
        KluError::Package { status } => format!("KLU failed (status {status})"),
    }
}
