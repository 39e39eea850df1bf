//! What an estimate tells: loads with their bands, noise, and whether the loads explain what was measured.

use nalgebra::DVector;

use super::basis::Amplitude;
use super::estimate::{Estimate, Found, Problem};
use super::find::Asked;
use super::pressures::Measured;
use super::sensed::{Banded, Noise, NoiseFrom, Sensed};
use crate::case::wiring::bladder_label;
use crate::error::Code;
use crate::numerics::normal;

/// Chance of a sum of squares above which the model does not explain the data.
const UNLIKELY: f64 = 1e-3;

/// One amplitude as a sum of them over their sizes.
pub(super) fn alone(amplitudes: &[Amplitude], which: usize) -> Vec<f64> {
    let mut factors = vec![0.0; amplitudes.len()];
    factors[which] = amplitudes[which].size;
    factors
}

/// A sum of amplitudes over their sizes, if it is told.
pub(super) fn banded(estimate: &Estimate, found: &Found, factors: &[f64]) -> Option<Banded> {
    found.seen.tells(factors).then(|| {
        let factors = DVector::from_column_slice(factors);
        let value = factors.dot(&found.mean);
        let sd = factors.dot(&(&found.covariance * &factors)).max(0.0).sqrt();
        let half = estimate.quantile * sd;
        Banded {
            value,
            sd,
            low: value - half,
            high: value + half,
        }
    })
}

pub(super) fn noise(asked: &Asked, measured: &Measured, estimate: &Estimate) -> Noise {
    let (from, sd_pa) = match (&measured.deviations, asked.noise_pa) {
        (Some(_), _) => (NoiseFrom::Table, None),
        (None, Some(given)) => (NoiseFrom::Given, Some(given)),
        (None, None) => (NoiseFrom::Estimated, Some(estimate.noise)),
    };
    Noise {
        from,
        sd_pa,
        freedom: estimate.freedom,
        // pressures that all are what the loads make of them have no noise at all
        chi_square: match estimate.noise > 0.0 {
            true => estimate.left / (estimate.noise * estimate.noise),
            false => 0.0,
        },
        quantile: estimate.quantile,
    }
}

/// What is left of one measured pressure, over its deviation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left {
    /// The bladder, by its place among all.
    pub bladder: usize,
    pub over_noise: f64,
}

/// What is left of the values of a problem, whose places are those of `bladders`, again and again.
pub(super) fn left<'a>(
    problem: &'a Problem,
    found: &'a Found,
    bladders: &'a [usize],
) -> impl Iterator<Item = Left> + 'a {
    let data = problem.data.iter().zip(&problem.deviation).enumerate();
    data.filter_map(move |(k, (value, deviation))| {
        Some(Left {
            bladder: bladders[k % bladders.len()],
            over_noise: ((*value)? - found.predicted[k]) / deviation,
        })
    })
}

/// What is said where pressures are further from the model than their noise, which is known, explains, with the bladder that is worst.
pub(super) fn unexplained(found: &Sensed, left: &[Left], bladders: usize, estimate: &Estimate) -> Option<String> {
    // Wilson and Hilferty's quantile of the sum of squares
    let f = estimate.freedom;
    if f < 0.5 {
        return None;
    }
    let share = 2.0 / (9.0 * f);
    let limit = f * (1.0 - share - normal::quantile(UNLIKELY) * share.sqrt()).powi(3);
    if estimate.left <= limit {
        return None;
    }
    let mut sums = vec![(0, 0.0); bladders];
    for one in left {
        let (count, sum) = &mut sums[one.bladder];
        *count += 1;
        *sum += one.over_noise.powi(2);
    }
    let means = sums
        .iter()
        .map(|(count, sum)| (sum / f64::from((*count).max(1))).sqrt());
    let worst = means.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let label = bladder_label(worst.0, bladders / 2);
    Some(Code::UnexplainedPressures.warning(format!(
        "{} leaves {:.1} times the noise of the pressures, mean square over {f:.0} degrees of freedom; furthest off is bladder {label}, by {:.1} times its noise: bands are too narrow",
        names(found),
        (estimate.left / f).sqrt(),
        worst.1
    )))
}

/// The loads that are looked for.
pub(super) fn names(found: &Sensed) -> String {
    let loads: Vec<String> = found.loads.iter().map(ToString::to_string).collect();
    loads.join(" + ")
}
