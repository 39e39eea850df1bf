//! Branch-and-bound search for the largest value of a quantity over a span.
//!
//! Each piece has an upper bound ([`Bounded::span`], narrowed by its ends and middle); sampled places have exact
//! values. The piece with the highest bound is halved, at a break if it has one, until that bound is close to the
//! largest value found. The bound is returned, so values between samples are covered. If the search reaches its limit
//! of pieces, it returns the current bound.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::interval::{Bounded, Interval, JetSpan};
use crate::functions::jet::Jet;

/// Largest number of pieces.
const MOST_PIECES: usize = 1500;

/// Result of a search.
#[derive(Clone, Copy, Debug)]
pub struct ExtremumFound {
    /// Upper bound of the quantity.
    pub bound: f64,
    /// Largest value found.
    pub reached: f64,
    /// Place of the largest value found.
    pub place: f64,
    /// True if the search reached its limit.
    pub limited: bool,
}

/// A function over `[from, to]` with its interior breaks.
pub struct IntervalSearch<'f, F: Bounded + ?Sized> {
    function: &'f F,
    from: f64,
    to: f64,
    breaks: Vec<f64>,
}

/// Accepted gap between bound and largest value found, relative, by the number of pieces.
pub fn slack(pieces: usize) -> f64 {
    match pieces {
        0..100 => 1e-3,
        100..300 => 1e-2,
        _ => 0.1,
    }
}

struct Piece {
    bound: f64,
    from: f64,
    to: f64,
    /// Index range of the breaks inside.
    inside: (usize, usize),
}

impl PartialEq for Piece {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Piece {}
impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Piece {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

impl<'f, F: Bounded + ?Sized> IntervalSearch<'f, F> {
    /// Search over `[from, to]`, which is not empty.
    pub fn new(function: &'f F, from: f64, to: f64) -> Self {
        let mut breaks = vec![];
        function.parted(to, &mut breaks);
        Self::at(function, from, to, breaks)
    }

    /// Search over `[from, to]` with pieces that also end at jumps of the third derivative.
    pub fn joined(function: &'f F, from: f64, to: f64) -> Self {
        let mut breaks = vec![];
        function.joined(to, &mut breaks);
        Self::at(function, from, to, breaks)
    }

    fn at(function: &'f F, from: f64, to: f64, mut breaks: Vec<f64>) -> Self {
        breaks.retain(|t| from < *t && *t < to);
        if breaks.windows(2).any(|w| w[0] >= w[1]) {
            breaks.sort_by(f64::total_cmp);
            breaks.dedup();
        }
        Self {
            function,
            from,
            to,
            breaks,
        }
    }

    /// Pieces between breaks.
    pub fn smooth(&self) -> impl Iterator<Item = (f64, f64)> {
        let stops = self.breaks.iter().copied().chain([self.to]);
        let starts = [self.from].into_iter().chain(self.breaks.iter().copied());
        starts.zip(stops)
    }

    /// Largest value of a quantity, given as bound `most` over a span and as `value` at an instant. Ends when
    /// `enough(found, bound, pieces)` is true.
    pub fn largest(
        &self,
        most: impl Fn(&JetSpan) -> f64,
        value: impl Fn(&Jet) -> f64,
        enough: impl Fn(f64, f64, usize) -> bool,
    ) -> ExtremumFound {
        let mut found = ExtremumFound {
            bound: f64::INFINITY,
            reached: f64::NEG_INFINITY,
            place: self.from,
            limited: false,
        };
        let mut heap = BinaryHeap::new();
        let mut pieces = 0;
        let all = (0, self.breaks.len());
        heap.push(self.piece(self.from, self.to, all, &most, &value, &mut found));
        while let Some(top) = heap.peek() {
            found.bound = top.bound.max(found.reached);
            pieces += 1;
            if enough(found.reached, found.bound, pieces) {
                break;
            }
            let (from, to, (first, last)) = (top.from, top.to, top.inside);
            let at = if first < last {
                first + (last - first) / 2
            } else {
                first
            };
            let (middle, next) = if first < last {
                (self.breaks[at], at + 1)
            } else {
                (0.5 * (from + to), at)
            };
            if pieces >= MOST_PIECES || middle <= from || middle >= to {
                found.limited = true;
                break;
            }
            heap.pop();
            heap.push(self.piece(from, middle, (first, at), &most, &value, &mut found));
            heap.push(self.piece(middle, to, (next, last), &most, &value, &mut found));
        }
        found
    }

    /// Largest magnitude of value (0), rate (1), acceleration (2) or jerk (3).
    pub fn size(&self, k: usize) -> ExtremumFound {
        self.largest(
            |span| span.0[k].size(),
            |jet| [jet.value, jet.rate, jet.acceleration, jet.jerk][k].abs(),
            |reached, bound, n| bound - reached <= slack(n) * reached,
        )
    }

    fn piece(
        &self,
        from: f64,
        to: f64,
        inside: (usize, usize),
        most: &impl Fn(&JetSpan) -> f64,
        value: &impl Fn(&Jet) -> f64,
        found: &mut ExtremumFound,
    ) -> Piece {
        let f = self.function;
        let mut seen = |t: f64, jet: &Jet| {
            let size = value(jet);
            if size > found.reached || size.is_nan() {
                (found.reached, found.place) = (if size.is_nan() { f64::INFINITY } else { size }, t);
            }
        };
        let smooth = inside.0 >= inside.1;
        let span = if smooth {
            let (span, jets) = span_with_jets(f, from, to);
            for (t, jet) in [from, 0.5 * (from + to), to].iter().zip(&jets) {
                seen(*t, jet);
            }
            span
        } else {
            let middle = 0.5 * (from + to);
            seen(middle, &f.exactly(middle, middle));
            f.span(from, to)
        };
        f.crests(from, to, &mut |t| {
            let within = if smooth { 0.5 * (from + to) } else { t };
            seen(t, &f.exactly(t, within));
        });
        Piece {
            bound: most(&span),
            from,
            to,
            inside,
        }
    }
}

/// Span of a piece without breaks, with the function at its ends and middle.
pub fn span_with_jets<F: Bounded + ?Sized>(f: &F, from: f64, to: f64) -> (JetSpan, [Jet; 3]) {
    let middle = 0.5 * (from + to);
    let jets = [from, middle, to].map(|t| f.exactly(t, middle));
    let span = f.span(from, to);
    if f.is_elementary() {
        return (span, jets);
    }
    (span.narrowed_by(jets, 0.5 * (to - from)), jets)
}

/// Range of the value and a flag for a limited search. Each end is at most [`slack`] of the size beyond the true one.
pub fn range<F: Bounded + ?Sized>(search: &IntervalSearch<F>) -> (Interval, bool) {
    let rough = search.function.span(search.from, search.to).0[0];
    if search.function.is_elementary() || rough.low == rough.high {
        return (rough, false);
    }
    let size = search.size(0).reached;
    let enough = |reached: f64, bound: f64, n: usize| bound - reached <= slack(n) * size;
    let high = search.largest(|span| span.0[0].high, |jet| jet.value, enough);
    let low = search.largest(|span| -span.0[0].low, |jet| -jet.value, enough);
    let range = Interval {
        low: -low.bound,
        high: high.bound,
    };
    (range.widened(ROUND_OFF), low.limited || high.limited)
}

/// Upper bounds of the largest magnitudes of value, rate, acceleration and jerk, and a flag for a limited search.
pub fn sizes<F: Bounded + ?Sized>(search: &IntervalSearch<F>) -> ([f64; 4], bool) {
    if search.function.is_elementary() {
        let span = search.function.span(search.from, search.to);
        return (span.0.map(Interval::size), false);
    }
    let found: [ExtremumFound; 4] = std::array::from_fn(|k| search.size(k));
    let limited = found.iter().any(|found| found.limited);
    (found.map(|found| found.bound * (1.0 + ROUND_OFF)), limited)
}

/// Magnitudes of value, rate, acceleration and jerk that are reached: lower bounds of the largest.
pub fn reached<F: Bounded + ?Sized>(search: &IntervalSearch<F>) -> [f64; 4] {
    if search.function.is_elementary() {
        return search.function.span(search.from, search.to).0.map(Interval::size);
    }
    std::array::from_fn(|k| search.size(k).reached)
}

/// A place at which value, first or second derivative is or may be infinite or NaN.
pub fn overflows<F: Bounded + ?Sized>(search: &IntervalSearch<F>) -> Option<f64> {
    let found = search.largest(
        |span| span.0[..3].iter().map(|i| i.size()).fold(0.0, f64::max),
        |jet| {
            let parts = [jet.value, jet.rate, jet.acceleration];
            if parts.iter().all(|x| x.is_finite()) {
                0.0
            } else {
                f64::INFINITY
            }
        },
        |reached, bound, _| reached > 0.0 || bound.is_finite(),
    );
    (!found.bound.is_finite()).then_some(found.place)
}

/// Relative rounding error of sums of many terms.
pub const ROUND_OFF: f64 = 1e-12;
