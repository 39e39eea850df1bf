//! Time scales of a signal by stretches of time: a step of one millisecond does not require short time steps in the ten
//! seconds around it.
//!
//! Outside its stretches a signal is constant to machine precision, so no change is missed:
//!
//! - Logistic step: constant beyond 45 reciprocal slopes on either side (`e^-45 = 3e-20`). Within 12 of them, where all
//!   but `6e-6` of it happens, the time scale is `4/k`. In the exponential tails between, which error tests resolve, it
//!   is 16 times that.
//! - Polynomial: constant where its variation is below the rounding error of its largest value.
//! - Spline: constant beyond its ends. In each piece, a cubic, the time scale is the distance of the points.
//! - Product: constant where a factor keeps it constant.
//! - Sine: never constant; a smooth start shorter than a period is a stretch of its own.

use super::interval::Bounded;
use super::period::AT_REST;
use crate::functions::curve::Interpolation;
use crate::functions::signals::{Polynomial, Sigmoid, Signal, Sine};

/// Half width of the main part of a logistic step, in reciprocal slopes.
const HAPPENS: f64 = 12.0;
/// Time scale of the tails over that of the main part.
const TAIL: f64 = 16.0;
/// Largest number of halvings in the search for constant parts of a polynomial.
const HALVINGS: u32 = 12;

/// A stretch of time that begins at the end of the previous one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeStretch {
    /// End [s].
    pub to: f64,
    /// Shortest time scale [s]; infinite if constant.
    pub scale: f64,
}

impl Signal {
    /// Shortest time scales without changes that switching times mark, as in [`Self::shortest_unmarked_time_s`], for
    /// stretches from 0 to `end` [s].
    pub fn stretches(&self, end: f64) -> Vec<TimeStretch> {
        let whole = |scale: Option<f64>| up_to(end, [(end, scale.unwrap_or(f64::INFINITY))]);
        match self {
            _ if self.is_constant() => whole(None),
            Self::Sine(sine) => up_to(end, sine.scales()),
            Self::Sigmoid(sigmoid) => up_to(end, sigmoid.scales()),
            Self::Polynomial(polynomial) => polynomial.stretches(end),
            Self::Table(table) if table.interpolation == Interpolation::Cubic && !table.repeat => {
                let knots = table.curve.knots();
                let first = knots.first().map(|first| (*first, f64::INFINITY));
                up_to(
                    end,
                    first.into_iter().chain(knots.windows(2).map(|w| (w[1], w[1] - w[0]))),
                )
            }
            Self::Sum(terms) => together(end, terms, f64::min),
            Self::Product(factors) => {
                self.without_rests(end, &together(end, factors, |a, b| (a.recip() + b.recip()).recip()))
            }
            _ => whole(self.shortest_unmarked_time_s(end)),
        }
    }
}

impl Signal {
    /// Time scales of a product, infinite where a factor keeps it constant, such as before and after a burst.
    fn without_rests(&self, end: f64, all: &[TimeStretch]) -> Vec<TimeStretch> {
        let mut ends: Vec<f64> = all.iter().map(|stretch| stretch.to).collect();
        self.breaks(end, &mut ends);
        ends.retain(|to| *to > 0.0 && *to <= end);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let largest = if ends.len() > 1 { self.largest(end).value } else { 0.0 };
        let (mut rested, mut from) = (vec![], 0.0);
        for to in ends {
            let scale = all
                .get(all.partition_point(|stretch| stretch.to < to))
                .map_or(f64::INFINITY, |stretch| stretch.scale);
            let value = Bounded::span(self, from, to).0[0];
            let rests = value.high - value.low <= f64::EPSILON * largest;
            push(&mut rested, to, if rests { f64::INFINITY } else { scale });
            from = to;
        }
        rested
    }
}

/// Merges the stretches of two signals; `both` combines their time scales.
pub fn merged(a: &[TimeStretch], b: &[TimeStretch], both: impl Fn(f64, f64) -> f64) -> Vec<TimeStretch> {
    let mut all: Vec<TimeStretch> = Vec::with_capacity(a.len() + b.len());
    let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
    while let (Some(&&p), Some(&&q)) = (a.peek(), b.peek()) {
        push(&mut all, p.to.min(q.to), both(p.scale, q.scale));
        if p.to <= q.to {
            a.next();
        }
        if q.to <= p.to {
            b.next();
        }
    }
    all
}

fn together(end: f64, parts: &[Signal], both: impl Fn(f64, f64) -> f64) -> Vec<TimeStretch> {
    let rest = up_to(end, []);
    parts
        .iter()
        .fold(rest, |all, part| merged(&all, &part.stretches(end), &both))
}

/// Stretches from ends and time scales within the run; constant after the last.
fn up_to(end: f64, ends: impl IntoIterator<Item = (f64, f64)>) -> Vec<TimeStretch> {
    let mut all = vec![];
    for (to, scale) in ends {
        push(&mut all, to.min(end), if scale > 0.0 { scale } else { f64::INFINITY });
    }
    push(&mut all, end, f64::INFINITY);
    all
}

fn push(all: &mut Vec<TimeStretch>, to: f64, scale: f64) {
    if to <= all.last().map_or(0.0, |last| last.to) {
        return;
    }
    match all.last_mut() {
        Some(last) if last.scale == scale => last.to = to,
        _ => all.push(TimeStretch { to, scale }),
    }
}

impl Sine {
    fn scales(&self) -> [(f64, f64); 2] {
        let period = 1.0 / self.frequency_hz;
        let start = if self.ramp_cycles < 1.0 {
            self.ramp_cycles * period
        } else {
            0.0
        };
        [(start, start), (f64::INFINITY, period)]
    }
}

impl Sigmoid {
    fn scales(&self) -> [(f64, f64); 4] {
        let slope = 1.0 / self.steepness_per_s.abs();
        let at = |slopes: f64| self.midpoint_s + slopes * slope;
        let happens = 4.0 * slope;
        [
            (at(-AT_REST), f64::INFINITY),
            (at(-HAPPENS), TAIL * happens),
            (at(HAPPENS), happens),
            (at(AT_REST), TAIL * happens),
        ]
    }
}

impl Polynomial {
    fn stretches(&self, end: f64) -> Vec<TimeStretch> {
        let Some(scale) = self.scale(end) else {
            return up_to(end, []);
        };
        let largest = Signal::Polynomial(self.clone()).largest(end).value;
        let mut all = vec![];
        self.part(&mut all, [0.0, end], [scale, largest], HALVINGS);
        all
    }

    /// Halves intervals that are not constant, down to the time scale.
    fn part(&self, all: &mut Vec<TimeStretch>, [from, to]: [f64; 2], [scale, largest]: [f64; 2], halvings: u32) {
        let value = Bounded::span(&Signal::Polynomial(self.clone()), from, to).0[0];
        if value.high - value.low <= f64::EPSILON * largest {
            push(all, to, f64::INFINITY);
        } else if halvings == 0 || to - from <= scale {
            push(all, to, scale);
        } else {
            let middle = 0.5 * (from + to);
            self.part(all, [from, middle], [scale, largest], halvings - 1);
            self.part(all, [middle, to], [scale, largest], halvings - 1);
        }
    }
}
