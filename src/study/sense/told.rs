//! What an estimate tells: loads with their bands, noise, and whether the loads explain what was measured.

use nalgebra::DVector;

use super::basis::Amplitude;
use super::estimate::{Estimate, Found, Problem};
use super::find::Asked;
use super::pressures::Measured;
use super::sensed::{Banded, Noise, NoiseFrom, Sensed};
use crate::case::wiring::bladder_label;
use crate::error::Code;

/// Part of the pressures, root mean square, that no answer leaves.
const NO_ANSWER: f64 = 0.25;
/// The same above which noise that is estimated may be no noise.
const MUCH: f64 = 0.1;
/// Times a size that bends the beam by about its length: no such load is meant.
const NO_LOAD: f64 = 30.0;

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

pub(super) fn noise(asked: &Asked, measured: &Measured, estimate: &Estimate) -> Noise {
    let (from, sd_pa) = match (&measured.deviations, asked.noise_pa) {
        (Some(_), _) => (NoiseFrom::Table, None),
        (None, Some(given)) => (NoiseFrom::Given, Some(given)),
        (None, None) => (NoiseFrom::Estimated, Some(estimate.noise)),
    };
    let misfit = &estimate.misfit;
    // pressures that all are what the loads make of them have no noise at all
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

/// What is left of one measured pressure, over its deviation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left {
    /// The bladder, by its place among all.
    pub bladder: usize,
    pub over_noise: f64,
    /// What was measured, likewise.
    pub measured: f64,
}

/// What is left of the values of a problem, whose places are those of `bladders`, again and again.
pub(super) fn left<'a>(
    problem: &'a Problem,
    found: &'a Found,
    bladders: &'a [usize],
) -> impl Iterator<Item = Left> + 'a {
    let data = problem.data.iter().zip(&problem.deviation).enumerate();
    data.filter_map(move |(k, (value, deviation))| {
        let value = (*value)?;
        Some(Left {
            bladder: bladders[k % bladders.len()],
            over_noise: (value - found.predicted[k]) / deviation,
            measured: value / deviation,
        })
    })
}

/// What is said where loads explain too little.
const NO_NUMBERS: &str =
    "; the numbers are no answer: other loads act, the units or signs of the pressures are others, or the case is";

/// What is to be known before any number: pressures that are further from the model than their noise, which is known, explains, with the bladder
/// that is worst, or that leave so much that it may be no noise, and loads that no beam bears.
pub(super) fn doubts(found: &Sensed, left: &[Left], bladders: usize, estimate: &Estimate) -> Vec<String> {
    let mut all = vec![];
    let sizes = estimate.found.iter().map(|one| one.mean.amax());
    let times = sizes.fold(0.0, f64::max);
    let from = found.noise.as_ref().map_or(NoiseFrom::Estimated, |noise| noise.from);
    let square = |of: &dyn Fn(&Left) -> f64| left.iter().map(|one| of(one).powi(2)).sum::<f64>();
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
            "the pressures do not fit {}: what is left of them is {} times their noise, root mean square over {:.0} {}, {} % of what was measured; \
             furthest off is bladder {}, by {} times its noise; bands are widened by as much{}",
            names(found),
            three(factor),
            estimate.misfit.judged()[1],
            if estimate.misfit.by_discrepancy { "pressures" } else { "degrees of freedom" },
            three(100.0 * share),
            bladder_label(worst.0, bladders / 2),
            three(worst.1),
            if share > NO_ANSWER { NO_NUMBERS } else { "" }
        ));
    }
    if from == NoiseFrom::Estimated && share > MUCH {
        all.push(format!(
            "{} % of the pressures are not explained by {}, and taken for noise since --noise is not given: bands hold only if so much of them is noise{}",
            three(100.0 * share),
            names(found),
            if share > NO_ANSWER { NO_NUMBERS } else { "" }
        ));
    }
    if let (NoiseFrom::Given | NoiseFrom::Table, Some(share)) = (from, estimate.misfit.below_chance()) {
        all.push(format!(
            "the pressures lie {} times as close to {} as the noise that was given: bands are as wide as that noise makes them; look at its unit, which is \
             the pascal for --noise and that of its heading for a column, or leave it out",
            three(1.0 / share),
            names(found)
        ));
    }
    if times > NO_LOAD {
        all.push(format!(
            "the loads are {} times what bends the beam by about its length: look at the units of the pressures, and at the case",
            three(times)
        ));
    }
    all.into_iter()
        .map(|one| Code::UnexplainedPressures.warning(one))
        .collect()
}

/// Three digits of a number.
fn three(number: f64) -> String {
    match number {
        x if x >= 100.0 => format!("{x:.0}"),
        x if x >= 10.0 => format!("{x:.1}"),
        x => format!("{x:.2}"),
    }
}

/// The loads that are looked for.
pub(super) fn names(found: &Sensed) -> String {
    let loads: Vec<String> = found.loads.iter().map(ToString::to_string).collect();
    loads.join(" + ")
}
