//! Rigorous bounds of functions of place.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::enclose::{crests, wave};
use super::interval::{Bounded, Interval, JetSpan};
use super::search::{self, IntervalSearch, ROUND_OFF, overflows, sizes};
use super::variation::Variation;
use crate::functions::jet::Jet;
use crate::functions::profile::{Profile, line};

impl Profile {
    /// Range of the values between two places in [0, 1].
    pub fn range(&self, from: f64, to: f64) -> Interval {
        search::range(&IntervalSearch::new(self, from, to)).0
    }

    /// Largest magnitude over the whole length.
    pub fn size(&self) -> f64 {
        self.range(0.0, 1.0).size()
    }

    /// Largest magnitude of the slope with respect to `x`.
    pub fn steepness(&self) -> f64 {
        sizes(&IntervalSearch::new(self, 0.0, 1.0)).0[1]
    }

    /// A place at which value, slope or curvature is or may be infinite or NaN.
    pub fn overflows(&self) -> Option<f64> {
        overflows(&IntervalSearch::new(self, 0.0, 1.0))
    }

    /// A place at which the profile is 0 or negative but for rounding, or not finite; none if it is positive.
    pub fn vanishes(&self) -> Option<f64> {
        let least = (ROUND_OFF * self.size()).max(f64::MIN_POSITIVE);
        let found = IntervalSearch::new(self, 0.0, 1.0).largest(
            |span| -span.0[0].low,
            |jet| -jet.value,
            |reached, bound, _| reached >= -least || bound < -least,
        );
        (found.reached >= -least).then_some(found.place)
    }

    /// Upper bounds of `∫ max(profile, 0) dx` and `∫ max(-profile, 0) dx`.
    pub fn amounts(&self) -> [f64; 2] {
        let range = self.range(0.0, 1.0);
        let amount = self.amount();
        [range.high, -range.low].map(|most| most.max(0.0).min(amount))
    }

    /// Upper bound of `∫ |profile| dx`.
    pub fn amount(&self) -> f64 {
        match self {
            Self::Constant(value) => value.abs(),
            _ => Variation::amount(self, 1.0),
        }
    }
}

impl Bounded for Profile {
    fn exactly(&self, x: f64, within: f64) -> Jet {
        match self {
            Self::Table(table) => table.curve.jet(x, within, table.interpolation),
            Self::Sum(terms) => terms
                .iter()
                .fold(Jet::default(), |sum, term| sum + term.exactly(x, within)),
            Self::Product(factors) => factors
                .iter()
                .fold(Jet::constant(1.0), |product, f| product * f.exactly(x, within)),
            other => other.jet(x),
        }
    }

    fn span(&self, from: f64, to: f64) -> JetSpan {
        match self {
            Self::Constant(value) => JetSpan::at(Jet::constant(*value)),
            Self::Cosine(w) => wave(w.amplitude, TAU * w.waves, w.phase_rad + FRAC_PI_2, from, to),
            Self::Sine(w) => wave(w.amplitude, TAU * w.waves, w.phase_rad, from, to),
            Self::Linear(ends) => line(ends).span(from, to),
            Self::Polynomial(polynomial) => polynomial.span(from, to),
            Self::Table(table) => table.curve.span(from, to),
            Self::Sum(terms) => JetSpan::sum(terms.iter().map(|term| term.span(from, to))),
            Self::Product(factors) => JetSpan::product(factors.iter().map(|factor| factor.span(from, to))),
        }
    }

    fn is_elementary(&self) -> bool {
        match self {
            Self::Constant(_) | Self::Cosine(_) | Self::Sine(_) | Self::Linear(_) | Self::Table(_) => true,
            Self::Polynomial(polynomial) => polynomial.coefficients.len() < 3,
            Self::Sum(parts) | Self::Product(parts) => matches!(parts.as_slice(), [one] if one.is_elementary()),
        }
    }

    fn parted(&self, to: f64, out: &mut Vec<f64>) {
        match self {
            Self::Table(table) => out.extend(table.positions.iter().filter(|at| **at <= to)),
            Self::Sum(parts) | Self::Product(parts) => parts.iter().for_each(|part| part.parted(to, out)),
            _ => {}
        }
    }

    fn crests(&self, from: f64, to: f64, visit: &mut dyn FnMut(f64)) {
        match self {
            Self::Cosine(w) if w.waves > 0.0 => crests(TAU * w.waves, w.phase_rad + FRAC_PI_2, from, to, visit),
            Self::Sine(w) if w.waves > 0.0 => crests(TAU * w.waves, w.phase_rad, from, to, visit),
            Self::Sum(parts) | Self::Product(parts) => parts.iter().for_each(|part| part.crests(from, to, visit)),
            _ => {}
        }
    }
}
