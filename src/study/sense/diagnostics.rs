//! Reports of an estimate: loads with confidence bands, noise, and doubts about the fit.

use nalgebra::DVector;

use super::basis::Amplitude;
use super::estimate::{Amplitudes, LoadEstimates, SenseProblem};
use super::estimate_at_rest::SenseOptions;
use super::pressures::PressureTable;
use super::sensed::{Banded, Noise, NoiseFrom, Sensed};
use crate::case::wiring::bladder_label;
use crate::error::Code;

/// Unexplained part of the pressures (root mean square) above which the loads are no answer.
const NO_ANSWER: f64 = 0.25;
/// Unexplained part of the pressures (root mean square) above which estimated noise may be a misfit of the model.
const MUCH: f64 = 0.1;
/// Largest plausible load, in sizes that bend the beam by about its length.
const NO_LOAD: f64 = 30.0;

/// Factors of the sum that is one amplitude, over amplitudes in their sizes.
pub(super) fn alone(amplitudes: &[Amplitude], which: usize) -> Vec<f64> {
    let mut factors = vec![0.0; amplitudes.len()];
    factors[which] = amplitudes[which].size;
    factors
}

/// Value and band of a sum of amplitudes over their sizes; none if the data do not determine it.
pub(super) fn banded(estimate: &LoadEstimates, found: &Amplitudes, factors: &[f64]) -> Option<Banded> {
    found.seen.observes(factors).then(|| {
        let factors = DVector::from_column_slice(factors);
        let value = factors.dot(&found.mean);
        let sd = estimate.widened * factors.dot(&(&found.covariance * &factors)).max(0.0).sqrt();
        let half = estimate.quantile * sd;
        Banded {
            value,
            sd,
            low: value - half,
            high: value + half,
        }
    })
}

pub(super) fn noise(asked: &SenseOptions, measured: &PressureTable, estimate: &LoadEstimates) -> Noise {
    let (from, sd_pa) = match (&measured.deviations, asked.noise_pa) {
        (Some(_), _) => (NoiseFrom::Table, None),
        (None, Some(given)) => (NoiseFrom::Given, Some(given)),
        (None, None) => (NoiseFrom::Estimated, Some(estimate.noise)),
    };
    let misfit = &estimate.misfit;
    // a fit without any residual has no noise to divide by
    let over_noise = |sum: f64| match estimate.noise > 0.0 {
        true => sum / (estimate.noise * estimate.noise),
        false => 0.0,
    };
    Noise {
        from,
        sd_pa,
        freedom: misfit.freedom,
        chi_square: over_noise(misfit.sum()),
        misfit: over_noise(misfit.data),
        roughness: over_noise(misfit.rough),
        widened: estimate.widened,
        quantile: estimate.quantile,
    }
}

/// Residual of one measured pressure over its deviation.
#[derive(Clone, Copy, Debug)]
pub(super) struct PressureResidual {
    /// Index of the bladder among all.
    pub bladder: usize,
    pub over_noise: f64,
    /// Measured pressure over its deviation.
    pub measured: f64,
}

/// Residuals of the measured values of a problem; value `k` belongs to bladder `bladders[k % bladders.len()]`.
pub(super) fn left<'a>(
    problem: &'a SenseProblem,
    found: &'a Amplitudes,
    bladders: &'a [usize],
) -> impl Iterator<Item = PressureResidual> + 'a {
    let data = problem.data.iter().zip(&problem.deviation).enumerate();
    data.filter_map(move |(k, (value, deviation))| {
        let value = (*value)?;
        Some(PressureResidual {
            bladder: bladders[k % bladders.len()],
            over_noise: (value - found.predicted[k]) / deviation,
            measured: value / deviation,
        })
    })
}

/// Ending of a warning if the loads explain too little of the pressures.
const NO_NUMBERS: &str =
    ". Do not use these loads: other loads act, or the units or signs of the pressures, or the case, are wrong";

/// Warnings that put the result in doubt: a misfit beyond known noise, with the worst bladder; a misfit so far below it that the given
/// noise seems wrong; unexplained pressures taken for noise; implausibly large loads.
pub(super) fn doubts(
    found: &Sensed,
    left: &[PressureResidual],
    bladders: usize,
    estimate: &LoadEstimates,
) -> Vec<String> {
    let mut all = vec![];
    let sizes = estimate.found.iter().map(|one| one.mean.amax());
    let times = sizes.fold(0.0, f64::max);
    let from = found.noise.as_ref().map_or(NoiseFrom::Estimated, |noise| noise.from);
    let square = |of: &dyn Fn(&PressureResidual) -> f64| left.iter().map(|one| of(one).powi(2)).sum::<f64>();
    let measured = square(&|one| one.measured).max(f64::MIN_POSITIVE);
    let share = (square(&|one| one.over_noise) / measured).sqrt();
    if let (NoiseFrom::Given | NoiseFrom::Table, Some(factor)) = (from, estimate.misfit.beyond_chance()) {
        let mut sums = vec![(0, 0.0); bladders];
        for one in left {
            let (count, sum) = &mut sums[one.bladder];
            *count += 1;
            *sum += one.over_noise.powi(2);
        }
        let means = sums
            .iter()
            .map(|(count, sum)| (sum / f64::from((*count).max(1))).sqrt());
        let worst = means.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
        all.push(format!(
            "the pressures do not fit {}: the residual is {} times their noise (root mean square over {:.0} {}), or \
             {} % of the measured pressures. The largest residual is at bladder {}, with {} times its noise. Bands \
             are widened {} times{}",
            names(found),
            three(factor),
            estimate.misfit.judged()[1],
            if estimate.misfit.by_discrepancy {
                "pressures"
            } else {
                "degrees of freedom"
            },
            three(100.0 * share),
            bladder_label(worst.0, bladders / 2),
            three(worst.1),
            three(factor),
            if share > NO_ANSWER { NO_NUMBERS } else { "" }
        ));
    }
    if from == NoiseFrom::Estimated && share > MUCH {
        all.push(format!(
            "{} % of the pressures are not explained by {}, and count as noise because --noise is not given. Bands \
             are valid only if the noise is that large{}",
            three(100.0 * share),
            names(found),
            if share > NO_ANSWER { NO_NUMBERS } else { "" }
        ));
    }
    if let (NoiseFrom::Given | NoiseFrom::Table, Some(share)) = (from, estimate.misfit.below_chance()) {
        all.push(format!(
            "the residual of the pressures is {} times smaller than the given noise, with {}. Bands follow the given \
             noise. Check its unit (pascal for --noise, the unit of the heading for a column), or omit it",
            three(1.0 / share),
            names(found)
        ));
    }
    if times > NO_LOAD {
        all.push(format!(
            "the loads are {} times those that bend the beam by about its length. Check the units of the pressures \
             and the case",
            three(times)
        ));
    }
    all.into_iter()
        .map(|one| Code::UnexplainedPressures.warning(one))
        .collect()
}

/// Formats a number with three digits.
fn three(number: f64) -> String {
    match number {
        x if x >= 100.0 => format!("{x:.0}"),
        x if x >= 10.0 => format!("{x:.1}"),
        x => format!("{x:.2}"),
    }
}

/// Names of the estimated loads, joined by " + ".
pub(super) fn names(found: &Sensed) -> String {
    let loads: Vec<String> = found.loads.iter().map(ToString::to_string).collect();
    loads.join(" + ")
}
