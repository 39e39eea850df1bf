//! Observability: combinations of loads that pressures determine, from the derivatives of the pressures.

use nalgebra::{DMatrix, DVector};

use super::basis::Amplitude;
use super::sensed::{Combination, ObservableAmplitudes, Sensed, Unknown};
use crate::numerics::bayesian_least_squares::{Observability, Posterior, ReducedProblem};

/// Stores amplitudes and observability in `found`.
pub(super) fn sight(found: &mut Sensed, amplitudes: &[Amplitude], jacobian: &DMatrix<f64>) {
    let seen = Observability::from_matrix(jacobian);
    found.amplitudes = unknowns(amplitudes, &seen, jacobian);
    let most = seen.values.first().copied().unwrap_or(1.0);
    found.seen = ObservableAmplitudes {
        condition: seen.values.last().map_or(1.0, |least| most / least),
        blind: seen.blind.iter().map(|change| changed(change, amplitudes)).collect(),
        together: combinations(&seen, amplitudes),
    };
}

/// Converts factors of amplitudes to factors of amplitudes over their sizes.
pub(super) fn over_sizes(sum: &Combination, amplitudes: &[Amplitude]) -> Vec<f64> {
    sum.factors
        .iter()
        .zip(amplitudes)
        .map(|(factor, a)| factor * a.size)
        .collect()
}

fn unknowns(amplitudes: &[Amplitude], seen: &Observability, jacobian: &DMatrix<f64>) -> Vec<Unknown> {
    let spread = linear(jacobian).spread;
    let of = |(k, a): (usize, &Amplitude)| Unknown {
        name: a.name.clone(),
        unit: a.unit.into(),
        place: a.place,
        error_per_pa: seen.alone[k].then(|| spread[(k, k)].max(0.0).sqrt() * a.size),
    };
    amplitudes.iter().enumerate().map(of).collect()
}

fn linear(jacobian: &DMatrix<f64>) -> Posterior {
    let none = DMatrix::zeros(0, jacobian.ncols());
    ReducedProblem::new(jacobian.clone(), DVector::zeros(jacobian.nrows())).posterior(&none)
}

/// Change of each amplitude in its unit, for a change of the leading amplitude by 1.
fn changed(change: &[f64], amplitudes: &[Amplitude]) -> Vec<f64> {
    let lead = amplitudes[leading(change)].size;
    change.iter().zip(amplitudes).map(|(c, a)| c * a.size / lead).collect()
}

/// Index of the leading 1 of a reduced row.
fn leading(row: &[f64]) -> usize {
    row.iter().position(|c| (c - 1.0).abs() < 1e-9).unwrap_or(0)
}

/// Determined combinations of more than one amplitude.
fn combinations(seen: &Observability, amplitudes: &[Amplitude]) -> Vec<Combination> {
    let several = |one: &&Vec<f64>| one.iter().filter(|c| **c != 0.0).count() > 1;
    let of = |one: &Vec<f64>| {
        let first = leading(one);
        let size = amplitudes[first].size;
        let factors: Vec<f64> = one.iter().zip(amplitudes).map(|(c, a)| c * size / a.size).collect();
        let mut name = String::new();
        for (factor, a) in factors.iter().zip(amplitudes).filter(|(factor, _)| **factor != 0.0) {
            let sign = match (name.is_empty(), *factor < 0.0) {
                (true, _) => "",
                (_, true) => " - ",
                (_, false) => " + ",
            };
            let times = match (factor.abs() - 1.0).abs() < 1e-9 {
                true => String::new(),
                false => short(factor.abs()) + " ",
            };
            name += &format!("{sign}{times}{}", a.name);
        }
        Combination {
            name,
            unit: amplitudes[first].unit.into(),
            factors,
        }
    };
    seen.observable.iter().filter(several).map(of).collect()
}

/// Formats a number with about four digits.
fn short(x: f64) -> String {
    match (1e-3..1e4).contains(&x) {
        true => format!("{x:.4}"),
        false => format!("{x:.3e}"),
    }
}
