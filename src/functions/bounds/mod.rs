//! Rigorous bounds of functions of time, also between samples: interval arithmetic on the composition of a signal
//! encloses it and its derivatives.
//!
//! All bounds are upper bounds. They are exact for a single sine, ramp, step or table. For sums, products and
//! polynomials a bound is at most 0.1 % above a value that the signal reaches, or 10 % after hundreds of pieces. It is
//! wider only if the search reaches its limit: for many cycles of sines without common period, which nearly reach the
//! sum of their amplitudes anyway, and for terms that cancel to rounding error. Variations are at most 10 % too large
//! under the same conditions.

mod enclose;
mod excites;
mod interval;
mod memo;
mod period;
mod profile;
mod search;
mod stretches;
mod tones;
mod variation;

use std::f64::consts::TAU;

use super::signals::Signal;
pub use excites::{Excitation, NEAR};
use interval::Bounded;
pub use interval::{Interval, JetSpan};
use memo::Memo;
use search::{IntervalSearch, overflows, reached, sizes};
pub use stretches::{TimeStretch, merged};
pub use variation::Variation;

/// Sample points per cycle, or in a signal without cycles, for the duration of a signal.
const PLACES: f64 = 32.0;
/// Largest number of sample points.
const MOST_PLACES: f64 = 65_536.0;
/// Golden ratio: multiples of it modulo 1 are evenly distributed and never repeat.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

thread_local! {
    static LARGEST: Memo<SignalSizes> = const { Memo::new() };
    static REACHED: Memo<SignalSizes> = const { Memo::new() };
    static IMPULSE: Memo<f64> = const { Memo::new() };
    static EXCITATION: Memo<Excitation> = const { Memo::new() };
}

/// Largest magnitudes of a signal over the run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SignalSizes {
    /// Largest value.
    pub value: f64,
    /// Largest rate [1/s].
    pub rate: f64,
    /// Largest acceleration [1/s^2].
    pub acceleration: f64,
    /// Largest third derivative [1/s^3].
    pub jerk: f64,
    /// True if the search reached its limit: the bounds are valid but may be wide.
    pub limited: bool,
}

/// A possible violation of given limits by a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitExcess {
    /// Time [s].
    pub t: f64,
    /// Value.
    pub value: f64,
}

impl Signal {
    /// Range of the values between two instants [s].
    pub fn range(&self, from: f64, to: f64) -> Interval {
        let this = &*self.spanned(to);
        let to = this.repeats_within(from, to);
        let (range, limited) = search::range(&IntervalSearch::new(this, from, to));
        if !limited {
            return range;
        }
        let (offset, [swing, ..]) = tones::together(this, from, to);
        let around = Interval {
            low: offset - swing,
            high: offset + swing,
        };
        range.narrowed(around.widened(search::ROUND_OFF))
    }

    /// Largest magnitudes until `end` [s].
    pub fn largest(&self, end: f64) -> SignalSizes {
        let this = &*self.spanned(end);
        memo::found(&LARGEST, this, [end, 0.0], || this.search_largest(end))
    }

    fn search_largest(&self, end: f64) -> SignalSizes {
        let to = self.repeats_within(0.0, end);
        let (mut all, limited) = sizes(&IntervalSearch::new(self, 0.0, to));
        if limited {
            let mut most = [0.0_f64; 4];
            for (from, to) in IntervalSearch::joined(self, 0.0, to).smooth() {
                let (offset, mut here) = tones::together(self, from, to);
                here[0] += offset.abs();
                most = std::array::from_fn(|k| most[k].max(here[k]));
            }
            all = std::array::from_fn(|k| all[k].min(most[k]));
        }
        let [value, rate, acceleration, jerk] = all;
        SignalSizes {
            value,
            rate,
            acceleration,
            jerk,
            limited,
        }
    }

    /// Magnitudes that the signal reaches until `end` [s]: lower bounds of those of [`Self::largest`].
    pub fn reaches(&self, end: f64) -> SignalSizes {
        let this = &*self.spanned(end);
        memo::found(&REACHED, this, [end, 0.0], || {
            let to = this.repeats_within(0.0, end);
            let [value, rate, acceleration, jerk] = reached(&IntervalSearch::new(this, 0.0, to));
            SignalSizes {
                value,
                rate,
                acceleration,
                jerk,
                limited: false,
            }
        })
    }

    /// Largest jumps of value, rate, acceleration and jerk until `end` [s]: at the start from rest at the value `held`,
    /// and between smooth branches.
    pub fn jumps(&self, end: f64, held: f64) -> [f64; 4] {
        let mut jumps = [0.0_f64; 4];
        let mut before = [held, 0.0, 0.0, 0.0];
        let this = &*self.spanned(end);
        for (from, to) in this.smooth_intervals(end) {
            let within = 0.5 * (from + to);
            let [a, b] = [from, to].map(|t| {
                let jet = this.exactly(t, within);
                [jet.value, jet.rate, jet.acceleration, jet.jerk]
            });
            for k in 0..4 {
                jumps[k] = jumps[k].max((a[k] - before[k]).abs());
            }
            before = b;
        }
        jumps
    }

    /// Excitation of oscillators until `end` [s], from rest at the value `held`.
    pub fn excitation(&self, end: f64, held: f64) -> Excitation {
        let this = &*self.spanned(end);
        memo::found(&EXCITATION, this, [end, held], || {
            Excitation::from_signal(this, end, held)
        })
    }

    /// Highest frequency of its sines [Hz]; frequencies of factors add.
    pub fn highest_tone_hz(&self) -> Option<f64> {
        let tones = tones::Tone::all(self).into_iter();
        let heard = tones.filter(|tone| tone.gain != 0.0 && tone.omega > 0.0);
        heard.map(|tone| tone.omega / TAU).reduce(f64::max)
    }

    /// `∫ |s| dt` until `end` [s], an upper bound; sines count with their amplitude.
    pub fn impulse(&self, end: f64) -> f64 {
        let of = |tone: tones::Tone| match tone.envelope.0.as_slice() {
            [] => tone.gain.abs() * end,
            _ => tone.gain.abs() * Variation::amount(&tone.envelope, end),
        };
        let this = &*self.spanned(end);
        memo::found(&IMPULSE, this, [end, 0.0], || {
            tones::Tone::all(this).into_iter().map(of).sum()
        })
    }

    /// Upper bound of `|∫ s dt|` from 0 to any instant until `end` [s]: for each tone `(2 |E| + ∫ |E'| dt)/W`, or its
    /// part of [`Self::impulse`].
    pub fn largest_integral(&self, end: f64) -> f64 {
        let of = |tone: &tones::Tone| {
            let (size, moved, amount) = match tone.envelope.0.as_slice() {
                [] => (1.0, 0.0, end),
                _ => {
                    let v = Variation::up_to(&tone.envelope, end);
                    (v.size[0], v.integral[1] + v.jumps[0], v.integral[0])
                }
            };
            let swings = match tone.omega {
                0.0 => f64::INFINITY,
                omega => (2.0 * size + moved) / omega,
            };
            tone.gain.abs() * amount.min(swings)
        };
        tones::Tone::all(&self.spanned(end)).iter().map(of).sum()
    }

    /// Largest magnitude until `end` [s], and the smaller of it and `∫ |s| dt` over `time` [s], which is smaller for
    /// short pulses. The integral is an estimate from samples that resolve the highest tone; [`Self::impulse`] is a
    /// bound, but ignores cancellation of terms.
    pub fn lasting(&self, end: f64, time: f64) -> [f64; 2] {
        let this = &*self.spanned(end);
        let size = this.largest(end).value;
        let tone = this.highest_tone_hz().unwrap_or(0.0);
        let over = |(from, to): (f64, f64)| {
            let places = (PLACES * ((to - from) * tone + 1.0)).min(MOST_PLACES).ceil();
            let within = |k: f64| match places < MOST_PLACES {
                true => 0.5,
                // with more cycles than samples, a regular spacing would sample a single phase
                false => (k * GOLDEN).fract(),
            };
            let at = |k: f64| from + (to - from) * (k + within(k)) / places;
            let sum: f64 = (0..places as u32).map(|k| this.value(at(f64::from(k))).abs()).sum();
            sum * (to - from) / places
        };
        let amount: f64 = this.smooth_intervals(end).into_iter().map(over).sum();
        [size, size.min(amount / time)]
    }

    /// First found violation of the limits until `end` [s]; none if the value certainly, or after a long search
    /// probably, stays within.
    pub fn leaves(&self, low: f64, high: f64, end: f64) -> Option<LimitExcess> {
        let this = &*self.spanned(end);
        let to = this.repeats_within(0.0, end);
        let search = IntervalSearch::new(this, 0.0, to);
        let beyond = |x: f64| (x - high).max(low - x);
        let found = search.largest(
            |span| beyond(span.0[0].high).max(beyond(span.0[0].low)),
            |jet| beyond(jet.value),
            |reached, bound, _| reached > 0.0 || bound <= 0.0,
        );
        (found.reached > 0.0).then(|| LimitExcess {
            t: found.place,
            value: this.value(found.place),
        })
    }

    /// An instant until `end` [s] at which value, rate or acceleration is or may be infinite or NaN.
    pub fn overflows(&self, end: f64) -> Option<f64> {
        let this = &*self.spanned(end);
        let to = this.repeats_within(0.0, end);
        overflows(&IntervalSearch::new(this, 0.0, to))
    }

    /// An instant until `end` [s] at which the magnitude is nearly the largest.
    pub fn peak(&self, end: f64) -> f64 {
        let this = &*self.spanned(end);
        let to = this.repeats_within(0.0, end);
        IntervalSearch::new(this, 0.0, to).size(0).place
    }
}
