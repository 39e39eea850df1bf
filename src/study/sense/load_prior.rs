//! A distributed load before any measurement: a mixture of Gaussian processes, and what measurements leave of it.
//!
//! A load q has values at the places of a mesh that is finer than sensors resolve. Its covariance is
//!
//! ```text
//! σ² d(s) d(s') exp(-|s - s'|/ℓ)        d = 1, or e + exp(-(s - c)²/(2 w²)) of a load around a place c
//! ```
//!
//! Scale σ, length ℓ, envelope d are not known. Each combination has its marginal likelihood, and the answer is the mixture:
//!
//! ```text
//! b = J q + L o + e        S = I + β² L Lᵀ + σ² J K Jᵀ        log weight = -(log|S| + bᵀ S⁻¹ b)/2
//! mean of g·q: gᵀ C S⁻¹ b        variance: gᵀ (P - C S⁻¹ Cᵀ) g        C = P (J L)ᵀ, P = diag(σ² K, β² I)
//! ```
//!
//! o are amplitudes of other loads, of a wide deviation β. Hyperparameters are integrated over because a handful of pressures does not
//! determine them (Rasmussen & Williams, Gaussian Processes for Machine Learning, 2006, 5.2).

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

use crate::numerics::normal;

/// Lengths ℓ over that of the beam, of loads without a place: the least, the largest, their number.
const LENGTHS: (f64, f64, usize) = (0.03, 2.0, 8);
/// Envelopes of loads around a place: how many places, width w, background e, length ℓ.
const ENVELOPES: [(usize, f64, f64, f64); 2] = [(40, 0.02, 0.005, 0.03), (40, 0.1, 0.005, 0.03)];
/// Deviation β of other loads, in sizes that bend the beam by about its length.
const OTHERS: f64 = 30.0;
/// Scales σ: the pressures of a load over their noise, from the first number to as many times the measured pressures as the second says.
const SCALES: (f64, f64, usize) = (0.5, 30.0, 32);
/// Deviation after the measurements over that before, above which they do not determine a quantity.
const DETERMINED: f64 = 0.5;
/// Weights below this share of the largest count as zero.
const LIGHT: f64 = 1e-7;
/// Probability of a band.
const PROBABILITY: f64 = 0.95;

/// The mixture before the data.
#[derive(Clone, Debug)]
pub struct LoadPrior {
    /// Amplitudes that are values of the distributed load, from root to tip.
    block: Range<usize>,
    kernels: Vec<Kernel>,
}

/// The covariance of one load of the mixture, over σ².
#[derive(Clone, Debug)]
struct Kernel {
    covariance: DMatrix<f64>,
    log_weight: f64,
    /// True if it is alike everywhere.
    stationary: bool,
}

/// What measurements leave of a quantity that is linear in the amplitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// Half of the symmetric interval of 95 %.
    pub half: f64,
    /// True if the measurements determine it, rather than what is assumed before.
    pub determined: bool,
}

/// What measurements leave of a load.
#[derive(Clone, Debug)]
pub struct MixturePosterior {
    /// The mean of all amplitudes.
    pub mean: DVector<f64>,
    /// The quantities that were asked for.
    pub intervals: Vec<Interval>,
    /// `bᵀ S⁻¹ b` of the combination with the largest weight: about as many as there are measurements.
    pub chi_square: f64,
    /// Scale σ of that combination, in the unit of the amplitudes: deviation of the load at its largest.
    pub scale: f64,
}

/// One combination of scale and covariance, after the data.
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
    /// Of a load with values at the amplitudes `block`, at equally spaced places from root to tip.
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

    /// What measurements leave: `jacobian` a row a measurement and a column an amplitude, both over the deviation of the noise, as `data` is;
    /// `quantities` a row a quantity. None where the measurements depend on nothing.
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
        // envelopes assume that there is nothing beside them, which the measurements may not show
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

    /// The mean of all amplitudes.
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

/// The interval of a quantity.
fn interval(row: usize, determined: bool, members: &[Member], weights: &[f64]) -> Interval {
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
    Interval {
        mean,
        deviation,
        half: high,
        determined,
    }
}

/// Measurements over noise and other loads together, which then have deviation 1.
struct Whitened {
    /// Derivatives by the distributed load.
    own: DMatrix<f64>,
    data: DVector<f64>,
    /// `W⁻¹`, from measurements to whitened ones.
    inverse: DMatrix<f64>,
    /// Quantities over the distributed load.
    over_own: DMatrix<f64>,
    /// Covariance of quantities with the whitened measurements, and their variance, by other loads.
    with_others: DMatrix<f64>,
    of_others: DVector<f64>,
    /// Whitened measurements, root mean square.
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

    /// All scales of one covariance.
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
