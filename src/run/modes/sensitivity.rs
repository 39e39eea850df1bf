//! Derivatives of eigenvalues with respect to numbers of the case.

use nalgebra::Complex;

use super::linearise::{Linearised, at_equilibrium, linearise};
use super::{Mode, failed};
use crate::case::Case;
use crate::case::parameter::{Parameter, STEPS, change};
use crate::dae::Dae as _;
use crate::error::{Error, Result};
use crate::spectral::{self, EigenPair, EigenvalueOptions};

/// Derivatives by one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeSensitivity {
    /// The parameter.
    pub parameter: Parameter,
    /// Derivative of s of each mode [1/s over the parameter's unit].
    pub s: Vec<Complex<f64>>,
}

/// `[E44]` Derivatives of eigenvalues by a parameter p, from the left and right eigenvectors,
///
/// ```text
/// ds/dp = -yᴴ (dA/dp + s dB/dp) x / yᴴ B x
/// ```
///
/// where A and B include the change of the state about which they are computed: they are differenced to fourth order, each at its
/// own equilibrium. The derivatives are meaningless where two eigenvalues meet.
///
/// # Errors
/// A changed case is not valid, has other unknowns or no such state.
pub fn differentiate(
    case: &Case,
    at_rest_under: Option<f64>,
    about: &Linearised,
    modes: &[Mode],
    parameters: &[Parameter],
) -> Result<Vec<ModeSensitivity>> {
    let pairs: Vec<EigenPair> = modes
        .iter()
        .map(|mode| {
            let found = spectral::nearest(&about.pencil(), mode.s, 1, &EigenvalueOptions::default())
                .map_err(|f| failed(about, &f))?;
            found
                .pairs
                .into_iter()
                .next()
                .ok_or_else(|| Error::Usage("a mode was not found again".into()))
        })
        .collect::<Result<_>>()?;
    let of = |parameter: &Parameter| -> Result<ModeSensitivity> {
        let mut a = vec![0.0; about.a.len()];
        let mut b = a.clone();
        let step = change(case);
        for (steps, weight) in STEPS {
            let case = parameter.changed(case, parameter.value * (1.0 + steps * step))?;
            let changed = match at_rest_under {
                Some(at) => at_equilibrium(&case, at)?,
                None => linearise(&case, about.at, None)?,
            };
            let weight = weight / (step * parameter.value);
            add([&mut a, &mut b], weight, about, &changed, parameter)?;
        }
        let s = pairs
            .iter()
            .map(|pair| -spectral::quotient(about.dae.pattern(), &a, &b, &about.b, pair))
            .collect();
        Ok(ModeSensitivity {
            parameter: parameter.clone(),
            s,
        })
    };
    parameters.iter().map(of).collect()
}

/// Adds the entries of a changed pencil, in the scales of the unchanged one, to those of A and B.
///
/// # Errors
/// The changed pencil has other unknowns or another pattern.
pub fn add(
    sums: [&mut [f64]; 2],
    weight: f64,
    about: &Linearised,
    changed: &Linearised,
    parameter: &Parameter,
) -> Result<()> {
    let pattern = about.dae.pattern();
    if changed.dae.pattern() != pattern {
        let what = "a small change of it changes the unknowns or the sparsity pattern";
        return Err(Error::Usage(format!("--sensitivity {}: {what}", parameter.pointer)));
    }
    let (here, there) = (&about.system().layout, &changed.system().layout);
    for (sum, entries) in sums.into_iter().zip([&changed.a, &changed.b]) {
        for column in 0..pattern.columns() {
            let of_column = here.scales[column] / there.scales[column];
            for entry in pattern.column(column) {
                let row = pattern.rows[entry] as usize;
                sum[entry] += weight * entries[entry] * of_column * there.row_scales[row] / here.row_scales[row];
            }
        }
    }
    Ok(())
}
