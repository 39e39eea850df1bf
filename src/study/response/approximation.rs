//! Rational approximation of a response over a band, from a few exact solutions.

use nalgebra::Complex;

use crate::error::Result;
use crate::numerics::rational::{AxisSamples, RationalFit, relative_error};
use crate::run::response::{Frequencies, LinearResponse};
use crate::study::in_halves_by;

/// Samples of a decade at first, and in all.
const PER_DECADE: f64 = 12.0;
const FIRST: f64 = 16.0;
/// Largest number of samples.
const MOST: usize = 1500;
/// Rounds of new samples without an improvement by half after which only rounding errors remain.
const STALLED: usize = 2;
/// Share of the permitted error that the samples of a fit may have.
const OF_FIT: f64 = 0.3;
/// Frequencies at which a response may have its static value, over the first frequency of the band. Enclosed volumes of fluid cause
/// rounding errors inversely proportional to the frequency.
const STATIC: [f64; 5] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
/// Damping ratio below which a pole is regarded as undamped.
const UNDAMPED: f64 = 1e-7;
/// Ratio of imaginary to real part up to which a response is static: its real part differs from the static gain by the square.
const QUASI_STATIC: f64 = 1e-4;

/// `[E96]` A rational function r that approximates all outputs over a band, with samples of the response H at s = i ω:
///
/// ```text
/// |r - H| ≤ e max(|H|, median |H|)
/// ```
///
/// with the median over logarithmically spaced frequencies.
/// Samples are added between others, and at poles of r as narrow as the samples are apart, until the new ones confirm r. e is the
/// largest error at all samples; r interpolates half of them at most.
pub struct ApproximatedResponse {
    /// Samples, at 0 too if there is a static gain.
    pub samples: AxisSamples,
    /// The approximation.
    pub fit: RationalFit,
    /// e.
    pub error: f64,
    /// Error at each sample, relative to the same reference.
    pub errors: Vec<f64>,
    /// Median amplitude of each output.
    pub medians: Vec<f64>,
}

impl ApproximatedResponse {
    /// Approximates a response over a band [Hz] with an error of `asked`, or of rounding errors. It has samples at `poles` [1/s].
    ///
    /// # Errors
    /// A frequency is a pole; the computation was interrupted.
    pub fn new(response: &LinearResponse, band: [f64; 2], poles: &[Complex<f64>], asked: f64) -> Result<Self> {
        let [from, to] = band.map(|hz| std::f64::consts::TAU * hz);
        let steps = (PER_DECADE * (to / from).log10()).max(FIRST).ceil();
        let grid = (0..=steps as usize).map(|k| (from * (to / from).powf(k as f64 / steps)).min(to));
        let mut omega: Vec<f64> = grid.collect();
        omega.dedup();
        let mut exact = Solvers::new(response)?;
        let mut samples = AxisSamples {
            values: exact.at(&omega)?,
            omega,
        };
        let medians = samples.medians();
        if let Some(gain) = static_gain(&mut exact, samples.omega[0], &medians)? {
            samples.insert(0.0, gain);
        }
        let apart = narrow(poles, &samples.omega, [from, to]);
        for (omega, values) in apart.iter().zip(exact.at(&apart)?) {
            samples.insert(*omega, values);
        }
        let mut open: Vec<f64> = samples.omega.clone();
        let mut best: Option<(f64, RationalFit)> = None;
        let mut stalled = 0;
        loop {
            let fit = RationalFit::new(&samples, &medians, OF_FIT * asked);
            let mut fresh = narrow(&fit.poles(), &samples.omega, [from, to]);
            for pair in samples.omega.windows(2).filter(|pair| pair[0] > 0.0) {
                let wide = pair[1] > pair[0] * (1.0 + 1e-9);
                if wide && (open.contains(&pair[0]) || open.contains(&pair[1])) {
                    fresh.push((pair[0] * pair[1]).sqrt());
                }
            }
            fresh.sort_by(f64::total_cmp);
            fresh.dedup();
            let values = exact.at(&fresh)?;
            let errors: Vec<f64> = (fresh.iter().zip(&values))
                .map(|(omega, values)| relative_error(&fit.at(*omega), values, &medians))
                .collect();
            let worst = errors.iter().copied().fold(fit.error, f64::max);
            let of_best = best.as_ref().map_or(f64::INFINITY, |(error, _)| *error);
            stalled = if worst > 0.5 * of_best { stalled + 1 } else { 0 };
            if worst < of_best {
                best = Some((worst, fit));
            }
            let failed = fresh.iter().zip(&errors).filter(|(_, error)| **error > asked);
            open = failed.map(|(omega, _)| *omega).collect();
            for (omega, values) in fresh.into_iter().zip(values) {
                samples.insert(omega, values);
            }
            if !(open.is_empty() || stalled > STALLED || samples.omega.len() > MOST) {
                continue;
            }
            let fit = best.map_or_else(|| RationalFit::new(&samples, &medians, OF_FIT * asked), |(_, fit)| fit);
            let all = samples.omega.iter().zip(&samples.values);
            let errors: Vec<f64> = all
                .map(|(omega, values)| relative_error(&fit.at(*omega), values, &medians))
                .collect();
            return Ok(Self {
                error: errors.iter().copied().fold(0.0, f64::max),
                errors,
                samples,
                fit,
                medians,
            });
        }
    }

    /// Transfer functions of all outputs at a frequency [Hz].
    pub fn at(&self, hz: f64) -> Vec<Complex<f64>> {
        self.fit.at(std::f64::consts::TAU * hz)
    }

    /// Error at a frequency [Hz]: the larger one of the samples on either side. Rounding errors at sharp peaks remain there.
    pub fn error_at(&self, hz: f64) -> f64 {
        let next = self
            .samples
            .omega
            .partition_point(|omega| *omega < std::f64::consts::TAU * hz);
        let beside = &self.errors[next.saturating_sub(1)..self.errors.len().min(next + 1)];
        beside.iter().copied().fold(0.0, f64::max)
    }
}

/// Solvers in two threads.
struct Solvers<'a>([Frequencies<'a>; 2]);

impl<'a> Solvers<'a> {
    fn new(response: &'a LinearResponse) -> Result<Self> {
        Ok(Self([response.solver()?, response.solver()?]))
    }

    /// Exact responses at angular frequencies.
    fn at(&mut self, omega: &[f64]) -> Result<Vec<Vec<Complex<f64>>>> {
        in_halves_by(&mut self.0, omega, |solver, half| {
            let hz = half.iter().map(|omega| omega / std::f64::consts::TAU);
            hz.map(|hz| solver.at(hz)).collect()
        })
    }
}

/// Limit of all outputs at s = 0, if there is one: equations at s = 0 are singular if a volume of fluid is enclosed.
fn static_gain(exact: &mut Solvers, first: f64, medians: &[f64]) -> Result<Option<Vec<Complex<f64>>>> {
    for slow in STATIC {
        let slow = exact.at(&[slow * first])?.swap_remove(0);
        let real = |(value, median): (&Complex<f64>, &f64)| {
            value.im.abs() <= QUASI_STATIC * value.re.abs().max(QUASI_STATIC * median)
        };
        if slow.iter().zip(medians).all(real) {
            return Ok(Some(slow.iter().map(|value| Complex::from(value.re)).collect()));
        }
    }
    Ok(None)
}

/// Frequencies at and beside poles that are narrower than the distance of the samples; those beside a pole without damping.
fn narrow(poles: &[Complex<f64>], omega: &[f64], [from, to]: [f64; 2]) -> Vec<f64> {
    let mut all = vec![];
    for pole in poles.iter().filter(|pole| (from..to).contains(&pole.im)) {
        let width = pole.re.abs().max(UNDAMPED * pole.im);
        let sides = [-width, width].map(|by| (pole.im + by).clamp(from, to));
        let middle = (pole.re.abs() >= width).then_some(pole.im);
        all.extend(sides.into_iter().chain(middle).filter(|at| {
            let next = omega.partition_point(|other| other < at);
            let near = [next.checked_sub(1), Some(next)].into_iter().flatten();
            let apart = near.filter_map(|k| omega.get(k)).map(|other| (other - at).abs());
            apart.fold(f64::INFINITY, f64::min) > 0.7 * width
        }));
    }
    all.sort_by(f64::total_cmp);
    all
}
