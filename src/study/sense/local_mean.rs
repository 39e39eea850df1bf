//! Means of a distributed load around places, from an estimate on a finer mesh.
//!
//! ```text
//! mean around place k = ∫ φ_k q ds / ∫ φ_k ds        φ_k: 1 at place k, linear to 0 at its neighbors
//! ```
//!
//! The load q is piecewise linear on a mesh of at least [`FINE`] intervals, so that the basis also resolves steps between places.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::basis::{Amplitude, Basis};
use super::diagnostics::left;
use super::estimate::{ForwardModel, LoadEstimates, SenseProblem};
use super::estimate_at_rest::unobservable;
use super::load_prior::{LoadPrior, MixturePosterior};
use super::misfit::Misfit;
use super::pressures_at_rest::AtRest;
use super::sensed::Banded;
use crate::error::Result;
use crate::numerics::normal;

/// Smallest number of intervals of the fine mesh.
const FINE: usize = 40;
/// Largest number of linearizations about the mean.
const ROUNDS: u32 = 8;
/// Stop criterion of the linearizations: change of the pressures over their noise, root mean square.
const CLOSE: f64 = 0.02;

/// Fine mesh of a load between the places of a profile.
#[derive(Clone, Debug, PartialEq)]
pub struct FineLoad {
    /// The given loads, with the profile on the fine mesh.
    pub loads: Vec<Basis>,
    /// Indices of the fine profile among all amplitudes.
    pub block: Range<usize>,
    /// Interpolation of the coarse load to the fine mesh: a column per amplitude at the places.
    pub interpolation: DMatrix<f64>,
    /// Means around the places: a row per amplitude at the places, a column per amplitude on the fine mesh.
    pub means: DMatrix<f64>,
}

impl FineLoad {
    /// Refines the profile among the loads; none if there is no profile.
    pub fn new(loads: &[Basis]) -> Option<Self> {
        let which = loads.iter().position(|load| matches!(load, Basis::Profile(_)))?;
        let Basis::Profile(places) = loads[which] else {
            return None;
        };
        let parts = FINE.div_ceil(places - 1);
        let fine = parts * (places - 1) + 1;
        let mut refined = loads.to_vec();
        refined[which] = Basis::Profile(fine);
        // each of the other loads has one amplitude
        let others = loads.len() - 1;
        let block = which..which + fine;
        let hat = |k: usize, i: usize| (1.0 - (i as f64 / parts as f64 - k as f64).abs()).max(0.0);
        let mut interpolation = DMatrix::zeros(others + fine, others + places);
        let mut means = DMatrix::zeros(others + places, others + fine);
        for k in 0..others {
            let [coarse, refined] = [places, fine].map(|count| if k < which { k } else { k + count });
            interpolation[(refined, coarse)] = 1.0;
            means[(coarse, refined)] = 1.0;
        }
        for k in 0..places {
            let mut weights = vec![0.0; fine];
            for i in 0..fine - 1 {
                let [a, b] = [hat(k, i), hat(k, i + 1)];
                weights[i] += (2.0 * a + b) / 6.0;
                weights[i + 1] += (a + 2.0 * b) / 6.0;
            }
            let whole: f64 = weights.iter().sum();
            for i in 0..fine {
                interpolation[(which + i, which + k)] = hat(k, i);
                means[(which + k, which + i)] = weights[i] / whole;
            }
        }
        Some(Self {
            loads: refined,
            block,
            interpolation,
            means,
        })
    }
}

/// Load on the fine mesh, estimated from one set of measurements.
#[derive(Clone, Debug)]
pub struct FineFound {
    /// Amplitudes: posterior mean.
    pub amplitudes: DVector<f64>,
    /// Modelled values at these amplitudes.
    pub predicted: DVector<f64>,
    /// Derivatives of the modelled values.
    pub jacobian: DMatrix<f64>,
    /// Posterior of the amplitudes.
    pub posterior: MixturePosterior,
}

/// Estimates the load on the fine mesh from the amplitudes `start`, by repeated linearization about the posterior mean. `noise` is relative
/// to the deviation of the problem; `quantities` are the rows whose intervals are wanted. None if the measurements depend on no amplitude.
///
/// # Errors
/// Those of states that are not found.
pub fn find(
    forward: &mut dyn ForwardModel,
    problem: &SenseProblem,
    prior: &LoadPrior,
    (start, noise): (DVector<f64>, f64),
    quantities: &DMatrix<f64>,
) -> Result<Option<FineFound>> {
    let measured: Vec<(usize, f64, f64)> = problem
        .data
        .iter()
        .zip(&problem.deviation)
        .enumerate()
        .filter_map(|(k, (value, deviation))| Some((k, (*value)?, deviation * noise)))
        .collect();
    let mut at = start;
    let (mut values, mut jacobian) = forward.at(at.as_slice())?;
    let mut found = None;
    for _ in 0..ROUNDS {
        let weighted = DMatrix::from_fn(measured.len(), at.len(), |i, j| {
            jacobian[(measured[i].0, j)] / measured[i].2
        });
        let left = measured
            .iter()
            .map(|(k, value, deviation)| (value - values[*k]) / deviation);
        let data = DVector::from_iterator(measured.len(), left) + &weighted * &at;
        let Some(posterior) = prior.posterior(&weighted, &data, quantities) else {
            return Ok(None);
        };
        let change = (&weighted * (&posterior.mean - &at)).norm();
        at.clone_from(&posterior.mean);
        (values, jacobian) = forward.at(at.as_slice())?;
        found = Some(posterior);
        if change < CLOSE * (measured.len() as f64).sqrt() {
            break;
        }
    }
    Ok(found.map(|posterior| FineFound {
        amplitudes: at,
        predicted: values,
        jacobian,
        posterior,
    }))
}

/// Replaces the amplitudes of a profile at its places by local means, for each row of measurements.
pub(super) fn local_means(
    problems: &[SenseProblem],
    estimate: &mut LoadEstimates,
    (fine, model): (&FineLoad, &mut AtRest),
    noise_known: bool,
) -> Result<Vec<FineFound>> {
    let prior = LoadPrior::new(fine.block.clone());
    let noise = estimate.noise;
    let mut all = vec![];
    for (problem, one) in problems.iter().zip(&mut estimate.found) {
        let start = &fine.interpolation * &one.mean;
        let found = find(model, problem, &prior, (start, noise), &fine.means);
        let found = found.map_err(|error| problem.named(error))?.ok_or_else(unobservable)?;
        one.mean = &fine.means * &found.amplitudes;
        one.predicted.clone_from(&found.predicted);
        one.jacobian = &found.jacobian * &fine.interpolation;
        all.push(found);
    }
    if noise_known {
        let left = problems.iter().zip(&estimate.found).map(|(problem, one)| {
            let left = left(problem, one, &[0]).map(|left| left.over_noise.powi(2));
            left.sum::<f64>()
        });
        let data: f64 = left.sum();
        let whole: f64 = all.iter().map(|one| one.posterior.chi_square).sum();
        let values = problems
            .iter()
            .map(|problem| problem.data.iter().flatten().count())
            .sum();
        let others = (fine.loads.len() - 1) as f64 * problems.len() as f64;
        estimate.misfit = Misfit {
            data,
            rough: (whole - data).max(0.0),
            values,
            freedom: (values as f64 - others).max(0.0),
            by_discrepancy: false,
        };
        estimate.widened = estimate.misfit.beyond_chance().unwrap_or(1.0);
    }
    Ok(all)
}

/// Local mean around a place with its band; none if the measurements do not determine it.
pub(super) fn local_band(
    estimate: &LoadEstimates,
    found: &FineFound,
    which: usize,
    amplitude: &Amplitude,
) -> Option<Banded> {
    let one = found.posterior.intervals[which];
    // estimated noise widens bands, as in Student's distribution
    let times = estimate.widened * amplitude.size;
    let student = estimate.quantile / normal::quantile(0.975);
    let (value, half) = (one.mean * amplitude.size, one.half * times * student);
    one.determined.then_some(Banded {
        value,
        sd: one.deviation * times,
        low: value - half,
        high: value + half,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: a piecewise linear load has the same values on the fine mesh; a uniform load equals its own mean.
    #[test]
    fn the_fine_mesh_has_the_same_loads() {
        let fine = FineLoad::new(&[Basis::TipForce, Basis::Profile(6), Basis::Uniform]).expect("a profile");
        assert_eq!(fine.loads[1], Basis::Profile(41));
        assert_eq!(fine.block, 1..42);
        let ones = DVector::from_element(8, 1.0);
        assert!((&fine.interpolation * &ones).iter().all(|x| (x - 1.0).abs() < 1e-14));
        let means = &fine.means * DVector::from_element(43, 1.0);
        assert!(means.iter().all(|x| (x - 1.0).abs() < 1e-14));
        // ∫ φ² / ∫ φ of one hat function
        let whole = &fine.means * &fine.interpolation;
        assert!((whole[(3, 3)] - 2.0 / 3.0).abs() < 1e-14 && (whole[(1, 1)] - 2.0 / 3.0).abs() < 1e-14);
    }
}
