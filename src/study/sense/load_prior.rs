//! Prior of a distributed load, a mixture of Gaussian processes, and its posterior after measurements.
//!
//! A load q is given at the places of a mesh that is finer than sensors resolve. Its covariance is
//!
//! ```text
//! σ² d(s) d(s') exp(-|s - s'|/ℓ)        d = 1, or e + exp(-(s - c)²/(2 w²)) of a load around a place c
//! ```
//!
//! Scale σ, length ℓ and envelope d are unknown. The posterior is a mixture over all combinations, weighted with their marginal
//! likelihoods:
//!
//! ```text
//! b = J q + L o + e        S = I + β² L Lᵀ + σ² J K Jᵀ        log weight = -(log|S| + bᵀ S⁻¹ b)/2
//! mean of g·q: gᵀ C S⁻¹ b        variance: gᵀ (P - C S⁻¹ Cᵀ) g        C = P (J L)ᵀ, P = diag(σ² K, β² I)
//! ```
//!
//! o are amplitudes of other loads, with the wide prior deviation β. Hyperparameters are integrated over because a handful of pressures
//! does not determine them (Rasmussen & Williams, Gaussian Processes for Machine Learning, 2006, 5.2).

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

use crate::numerics::normal;

/// Correlation lengths ℓ of stationary kernels over the length of the beam: smallest, largest, number.
const LENGTHS: (f64, f64, usize) = (0.03, 2.0, 8);
/// Kernels with an envelope around a place: number of places, width w, background e, correlation length ℓ.
const ENVELOPES: [(usize, f64, f64, f64); 2] = [(40, 0.02, 0.005, 0.03), (40, 0.1, 0.005, 0.03)];
/// Prior deviation β of other loads, in sizes that bend the beam by about its length.
const OTHERS: f64 = 30.0;
/// Scales σ, by the ratio of load pressures to noise: smallest ratio; largest ratio over that of the measured pressures; number of scales.
const SCALES: (f64, f64, usize) = (0.5, 30.0, 32);
/// Ratio of posterior to prior deviation above which the measurements do not determine a quantity.
const DETERMINED: f64 = 0.5;
/// Weights below this part of the largest are dropped.
const LIGHT: f64 = 1e-7;
/// Probability of a confidence band.
const PROBABILITY: f64 = 0.95;

/// Prior mixture.
#[derive(Clone, Debug)]
pub struct LoadPrior {
    /// Indices of the amplitudes that are values of the distributed load, from root to tip.
    block: Range<usize>,
    kernels: Vec<Kernel>,
}

/// Covariance of one component of the mixture, over σ².
#[derive(Clone, Debug)]
struct Kernel {
    covariance: DMatrix<f64>,
    log_weight: f64,
    /// True for a stationary kernel, without an envelope.
    stationary: bool,
}

/// Posterior of a quantity that is linear in the amplitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PosteriorInterval {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// Half-width of the symmetric 95 % interval.
    pub half: f64,
    /// True if the measurements determine the quantity, not the prior.
    pub determined: bool,
}

/// Posterior of all amplitudes.
#[derive(Clone, Debug)]
pub struct MixturePosterior {
    /// Mean of all amplitudes.
    pub mean: DVector<f64>,
    /// Intervals of the requested quantities.
    pub intervals: Vec<PosteriorInterval>,
    /// `bᵀ S⁻¹ b` of the component with the largest weight; expected to be about the number of measurements.
    pub chi_square: f64,
    /// Scale σ of that component, in the unit of the amplitudes: largest deviation of the load.
    pub scale: f64,
}

/// One combination of scale and kernel, after the data.
struct Member {
    kernel: usize,
    log_weight: f64,
    chi_square: f64,
    scale: f64,
    means: DVector<f64>,
    variances: DVector<f64>,
    before: DVector<f64>,
    /// `S⁻¹ b`.
    dual: DVector<f64>,
}

impl LoadPrior {
    /// Prior of a load whose values are the amplitudes `block`, at equally spaced places from root to tip.
    pub fn new(block: Range<usize>) -> Self {
        let count = block.len();
        let at = |k: usize| k as f64 / (count.max(2) - 1) as f64;
        let (least, most, lengths) = LENGTHS;
        let step = (most / least).powf(1.0 / (lengths - 1) as f64);
        let mut kernels: Vec<Kernel> = (0..lengths)
            .map(|k| {
                let length = least * step.powi(k as i32);
                Kernel {
                    covariance: DMatrix::from_fn(count, count, |i, j| (-(at(i) - at(j)).abs() / length).exp()),
                    log_weight: -(lengths as f64).ln(),
                    stationary: true,
                }
            })
            .collect();
        for (places, width, background, length) in ENVELOPES {
            for place in 0..places {
                let middle = (place as f64 + 0.5) / places as f64;
                let envelope = |k: usize| background + (-0.5 * ((at(k) - middle) / width).powi(2)).exp();
                let covariance = |i, j| envelope(i) * envelope(j) * (-(at(i) - at(j)).abs() / length).exp();
                kernels.push(Kernel {
                    covariance: DMatrix::from_fn(count, count, covariance),
                    log_weight: -((places * ENVELOPES.len()) as f64).ln(),
                    stationary: false,
                });
            }
        }
        Self { block, kernels }
    }

    /// Posterior of the given data. `jacobian` has a row per measurement and a column per amplitude; it and `data` are divided by the
    /// deviation of the noise. `quantities` has a row per quantity. None if the measurements depend on no amplitude.
    pub fn posterior(
        &self,
        jacobian: &DMatrix<f64>,
        data: &DVector<f64>,
        quantities: &DMatrix<f64>,
    ) -> Option<MixturePosterior> {
        let whitened = Whitened::new(self, jacobian, data, quantities)?;
        let mut members: Vec<Member> = vec![];
        for (k, kernel) in self.kernels.iter().enumerate() {
            whitened.members(k, kernel, &mut members);
        }
        let best = members.iter().max_by(|a, b| a.log_weight.total_cmp(&b.log_weight))?;
        let (largest, chi_square, scale) = (best.log_weight, best.chi_square, best.scale);
        // envelopes assume no load outside them, so only stationary kernels can show that the data determine a quantity
        let determined = {
            let alike: Vec<&Member> = members
                .iter()
                .filter(|one| self.kernels[one.kernel].stationary)
                .collect();
            let largest = alike.iter().map(|one| one.log_weight).fold(f64::NEG_INFINITY, f64::max);
            let sum = |row: usize, of: fn(&Member) -> &DVector<f64>| -> f64 {
                let weighted = alike.iter().map(|one| (one.log_weight - largest).exp() * of(one)[row]);
                weighted.sum()
            };
            let rows = 0..quantities.nrows();
            let share = |row| sum(row, |one| &one.variances) / sum(row, |one| &one.before).max(f64::MIN_POSITIVE);
            rows.map(|row| share(row) < DETERMINED * DETERMINED).collect::<Vec<_>>()
        };
        members.retain(|one| one.log_weight > largest + LIGHT.ln());
        let mut weights: Vec<f64> = members.iter().map(|one| (one.log_weight - largest).exp()).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        let intervals = determined
            .into_iter()
            .enumerate()
            .map(|(row, determined)| interval(row, determined, &members, &weights));
        Some(MixturePosterior {
            intervals: intervals.collect(),
            mean: self.mean(jacobian, &members, &weights),
            chi_square,
            scale,
        })
    }

    /// Mean of all amplitudes over the mixture.
    fn mean(&self, jacobian: &DMatrix<f64>, members: &[Member], weights: &[f64]) -> DVector<f64> {
        let mut mean = DVector::zeros(jacobian.ncols());
        let mut duals = vec![DVector::<f64>::zeros(jacobian.nrows()); self.kernels.len()];
        let mut whole = DVector::<f64>::zeros(jacobian.nrows());
        for (member, weight) in members.iter().zip(weights) {
            duals[member.kernel] += &member.dual * (weight * member.scale * member.scale);
            whole += &member.dual * *weight;
        }
        for k in (0..mean.len()).filter(|k| !self.block.contains(k)) {
            mean[k] = OTHERS * OTHERS * jacobian.column(k).dot(&whole);
        }
        let own = jacobian.columns(self.block.start, self.block.len());
        let mut block = mean.rows_mut(self.block.start, self.block.len());
        for (kernel, dual) in self.kernels.iter().zip(&duals).filter(|(_, dual)| dual.amax() > 0.0) {
            block += &kernel.covariance * (own.transpose() * dual);
        }
        mean
    }
}

/// Mean, deviation and 95 % interval of one quantity.
fn interval(row: usize, determined: bool, members: &[Member], weights: &[f64]) -> PosteriorInterval {
    let all = || members.iter().zip(weights);
    let mean: f64 = all().map(|(one, w)| w * one.means[row]).sum();
    let variance = |one: &Member| one.variances[row] + (one.means[row] - mean).powi(2);
    let deviation = all().map(|(one, w)| w * variance(one)).sum::<f64>().sqrt();
    let inside = |half: f64| {
        let one = |(one, w): (&Member, &f64)| {
            let (off, deviation) = (one.means[row] - mean, one.variances[row].sqrt().max(f64::MIN_POSITIVE));
            w * (normal::probability((half - off) / deviation) - normal::probability((-half - off) / deviation))
        };
        all().map(one).sum::<f64>()
    };
    let (mut low, mut high) = (0.0, deviation);
    while inside(high) < PROBABILITY && high < 1e3 * deviation {
        (low, high) = (high, 2.0 * high);
    }
    while high - low > 1e-4 * high {
        let middle = 0.5 * (low + high);
        match inside(middle) < PROBABILITY {
            true => low = middle,
            false => high = middle,
        }
    }
    PosteriorInterval {
        mean,
        deviation,
        half: high,
        determined,
    }
}

/// Measurements, whitened by noise and other loads together.
struct Whitened {
    /// Derivatives with respect to the distributed load.
    own: DMatrix<f64>,
    data: DVector<f64>,
    /// `W⁻¹`, which whitens measurements.
    inverse: DMatrix<f64>,
    /// Columns of the quantities that belong to the distributed load.
    over_own: DMatrix<f64>,
    /// Contribution of other loads to the covariance of quantities with whitened measurements, and to their variance.
    with_others: DMatrix<f64>,
    of_others: DVector<f64>,
    /// Root mean square of the whitened measurements.
    size: f64,
}

impl Whitened {
    fn new(prior: &LoadPrior, jacobian: &DMatrix<f64>, data: &DVector<f64>, quantities: &DMatrix<f64>) -> Option<Self> {
        let (rows, block) = (jacobian.nrows(), &prior.block);
        let others: Vec<usize> = (0..jacobian.ncols()).filter(|k| !block.contains(k)).collect();
        let aside = jacobian.select_columns(&others) * OTHERS;
        let noise = DMatrix::identity(rows, rows) + &aside * aside.transpose();
        let lower = Cholesky::new(noise)?.l();
        let inverse = lower.solve_lower_triangular(&DMatrix::identity(rows, rows))?;
        let own = &inverse * jacobian.columns(block.start, block.len());
        let data = &inverse * data;
        let over_others = quantities.select_columns(&others) * OTHERS;
        Some(Self {
            size: (data.norm_squared() / rows.max(1) as f64).sqrt(),
            with_others: &over_others * (&inverse * aside).transpose(),
            of_others: DVector::from_iterator(quantities.nrows(), over_others.row_iter().map(|r| r.norm_squared())),
            over_own: quantities.columns(block.start, block.len()).into_owned(),
            own,
            data,
            inverse,
        })
    }

    /// Adds the members of all scales of one kernel.
    fn members(&self, number: usize, kernel: &Kernel, members: &mut Vec<Member>) {
        let rows = self.own.nrows();
        let spread = &self.own * &kernel.covariance;
        let signal = &spread * self.own.transpose();
        let unit = signal.trace() / rows as f64;
        if !(unit > 0.0 && unit.is_finite()) {
            return;
        }
        let SymmetricEigen {
            eigenvalues,
            eigenvectors,
        } = SymmetricEigen::new(signal / unit);
        let data = eigenvectors.transpose() * &self.data;
        let with_own = &self.over_own * spread.transpose() * &eigenvectors;
        let with_others = &self.with_others * &eigenvectors;
        let across = &self.over_own * &kernel.covariance;
        let of_own = DVector::from_fn(across.nrows(), |i, _| across.row(i).dot(&self.over_own.row(i)));
        let (low, high, count) = SCALES;
        let step = (high * self.size.max(1.0) / low).ln() / (count - 1) as f64;
        for k in 0..count {
            let shown = low * (step * k as f64).exp();
            let square = shown * shown / unit;
            let total = eigenvalues.map(|value| 1.0 + shown * shown * value.max(0.0));
            let over = data.component_div(&total);
            let chi_square = data.dot(&over);
            let with = &with_own * square + &with_others;
            let before = &of_own * square + &self.of_others;
            let explained = DVector::from_fn(with.nrows(), |i, _| {
                let row = (0..total.len()).map(|j| with[(i, j)].powi(2) / total[j]);
                row.sum::<f64>()
            });
            let variances = (&before - explained).zip_map(&before, |after, before| after.max(1e-12 * before));
            members.push(Member {
                kernel: number,
                log_weight: kernel.log_weight - 0.5 * (total.iter().map(|t| t.ln()).sum::<f64>() + chi_square),
                chi_square,
                scale: square.sqrt(),
                means: &with * &over,
                variances,
                before,
                dual: self.inverse.transpose() * (&eigenvectors * over),
            });
        }
    }
}
