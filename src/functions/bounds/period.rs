//! Time scales of signals: common periods, and rates of change.

use std::f64::consts::TAU;

use crate::functions::signals::{Polynomial, Signal};

/// Largest number of cycles of the slowest sine in a common period.
const MOST_CYCLES: f64 = 64.0;
/// Largest phase drift between sines over the span, in cycles.
const DRIFT: f64 = 1e-7;
/// Multiple of the reciprocal steepness beyond which a logistic step is constant to machine precision.
pub(super) const AT_REST: f64 = 45.0;

impl Signal {
    /// End of a shorter span in which the signal takes all values that it takes until `to`.
    pub(super) fn repeats_within(&self, from: f64, to: f64) -> f64 {
        let mut frequencies = vec![];
        let mut rest = from;
        self.settles(to, &mut rest, &mut frequencies);
        let Some(&slowest) = frequencies.iter().min_by(|a, b| a.total_cmp(b)) else {
            return to;
        };
        let span = to - rest;
        let common = (1..=MOST_CYCLES as u32).find(|n| {
            let cycles = f64::from(*n);
            frequencies.iter().all(|f| {
                let ratio = f * cycles / slowest;
                (ratio - ratio.round()).abs() * slowest * span <= DRIFT * cycles
            })
        });
        common.map_or(to, |n| (rest + f64::from(n) / slowest * (1.0 + 1e-9)).min(to))
    }

    /// Time after which only sines and repeated tables change, and their frequencies [Hz].
    fn settles(&self, end: f64, rest: &mut f64, frequencies: &mut Vec<f64>) {
        match self {
            _ if self.is_constant() => {}
            Self::Constant(_) | Self::Controller(_) => {}
            Self::Sine(sine) => {
                *rest = rest.max(sine.ramp_cycles.max(0.0) / sine.frequency_hz);
                frequencies.push(sine.frequency_hz);
            }
            Self::Sigmoid(step) => *rest = rest.max(step.midpoint_s + AT_REST / step.steepness_per_s.abs()),
            Self::Ramp(ramp) => *rest = rest.max(ramp.start_s + ramp.duration_s),
            Self::Table(table) if table.repeat => frequencies.extend(table.period_s().map(f64::recip)),
            Self::Table(table) => *rest = rest.max(table.times_s.last().copied().unwrap_or(0.0)),
            Self::Polynomial(_) => *rest = end,
            Self::Sum(parts) | Self::Product(parts) => {
                parts.iter().for_each(|part| part.settles(end, rest, frequencies));
            }
        }
    }

    /// Shortest time scale until `end` [s]: [`Self::fastest_period_s`], extended to polynomials.
    pub fn shortest_time_s(&self, end: f64) -> Option<f64> {
        self.scale(end, false)
    }

    /// [`Self::shortest_time_s`] without changes that switching times mark, as in [`Self::fastest_unmarked_period_s`].
    pub fn shortest_unmarked_time_s(&self, end: f64) -> Option<f64> {
        self.scale(end, true)
    }

    fn scale(&self, end: f64, unmarked: bool) -> Option<f64> {
        let scale = match self {
            _ if self.is_constant() => None,
            Self::Polynomial(polynomial) => polynomial.scale(end),
            Self::Sum(terms) => terms
                .iter()
                .filter_map(|term| term.scale(end, unmarked))
                .reduce(f64::min),
            Self::Product(factors) => {
                let scales = factors.iter().filter_map(|factor| factor.scale(end, unmarked));
                Some(scales.map(f64::recip).sum::<f64>().recip())
            }
            other if unmarked => other.fastest_unmarked_period_s(),
            other => other.fastest_period_s(),
        };
        scale.filter(|s| s.is_finite() && *s > 0.0)
    }
}

impl Polynomial {
    /// `2 π` times the smallest ratio of largest rate to largest acceleration, or of acceleration to jerk. Each ratio
    /// gives the period of a sine.
    pub(super) fn scale(&self, end: f64) -> Option<f64> {
        if self.coefficients.len() < 3 {
            return None;
        }
        let sizes = Signal::Polynomial(self.clone()).largest(end);
        let pairs = [(sizes.rate, sizes.acceleration), (sizes.acceleration, sizes.jerk)];
        let quotients = pairs
            .into_iter()
            .filter(|(_, next)| *next > 0.0)
            .map(|(of, next)| of / next);
        quotients.reduce(f64::min).map(|least| TAU * least)
    }
}
