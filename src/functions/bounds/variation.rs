//! Total variation of a function: integrals of the magnitudes of its derivatives.

use std::collections::BinaryHeap;

use super::interval::{Bounded, Interval};
use super::search::{IntervalSearch, ROUND_OFF, sizes, span_with_jets};
use crate::functions::jet::Jet;

/// Largest number of additional pieces.
const MOST_PIECES: usize = 400;

/// Accepted relative excess of an integral.
const SLACK: f64 = 0.1;

/// Upper bounds over `[0, end]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variation {
    /// Largest magnitudes of value and derivatives.
    pub size: [f64; 4],
    /// Magnitudes at the start.
    pub start: [f64; 4],
    /// Sums of the jumps of value and derivatives inside.
    pub jumps: [f64; 4],
    /// `∫ |s^(k)| dt`, k = 0 to 3, without jumps.
    pub integral: [f64; 4],
}

impl Variation {
    /// Variation of a function.
    pub fn up_to<F: Bounded + ?Sized>(function: &F, end: f64) -> Self {
        Self {
            size: sizes(&IntervalSearch::new(function, 0.0, end)).0,
            ..Self::summed(function, end, 4)
        }
    }

    /// Upper bound of `∫ |s| dt` only.
    pub fn amount<F: Bounded + ?Sized>(function: &F, end: f64) -> f64 {
        Self::summed(function, end, 1).integral[0]
    }

    /// Integrals; the first `orders` of them to their accuracy.
    fn summed<F: Bounded + ?Sized>(function: &F, end: f64, orders: usize) -> Self {
        let search = IntervalSearch::joined(function, 0.0, end);
        let mut v = Self::default();
        let parts = |jet: &Jet| [jet.value, jet.rate, jet.acceleration, jet.jerk];
        let mut heap = BinaryHeap::new();
        let (mut gaps, mut settled) = ([0.0; 4], [0.0; 4]);
        let mut before: Option<[f64; 4]> = None;
        for (from, to) in search.smooth() {
            let piece = Part::between(function, from, to);
            let [first, last] = piece.ends.map(|jet| parts(&jet));
            match before {
                None => v.start = first.map(f64::abs),
                Some(before) => (0..4).for_each(|k| v.jumps[k] += (first[k] - before[k]).abs()),
            }
            before = Some(last);
            add(&mut v.integral, 1.0, &piece.integral);
            add(&mut gaps, 1.0, &piece.gap);
            if piece.gap.iter().any(|gap| *gap > 0.0) {
                heap.push(piece.weighed(&v.integral, orders));
            } else {
                add(&mut settled, 1.0, &piece.integral);
            }
        }
        for _ in 0..MOST_PIECES {
            if (0..orders).all(|k| gaps[k] <= SLACK * v.integral[k]) {
                break;
            }
            let Some(Weighed { part, .. }) = heap.pop() else { break };
            let middle = 0.5 * (part.from + part.to);
            if middle <= part.from || middle >= part.to {
                add(&mut settled, 1.0, &part.integral);
                continue;
            }
            let halves = [(part.from, middle), (middle, part.to)].map(|(a, b)| Part::between(function, a, b));
            add(&mut v.integral, -1.0, &part.integral);
            add(&mut gaps, -1.0, &part.gap);
            for half in halves {
                add(&mut v.integral, 1.0, &half.integral);
                add(&mut gaps, 1.0, &half.gap);
                heap.push(half.weighed(&v.integral, orders));
            }
        }
        // sum again: repeated subtraction may leave rounding errors larger than the result
        heap.iter().for_each(|open| add(&mut settled, 1.0, &open.part.integral));
        v.integral = settled.map(|x| x * (1.0 + ROUND_OFF));
        v
    }
}

fn add(sum: &mut [f64; 4], factor: f64, parts: &[f64; 4]) {
    for (sum, part) in sum.iter_mut().zip(parts) {
        *sum += factor * part;
    }
}

/// A piece without breaks.
struct Part {
    from: f64,
    to: f64,
    ends: [Jet; 2],
    integral: [f64; 4],
    /// Upper bounds of the excess of the integrals.
    gap: [f64; 4],
}

impl Part {
    /// A derivative of constant sign integrates to a difference.
    fn between<F: Bounded + ?Sized>(function: &F, from: f64, to: f64) -> Self {
        let (span, [first, _, last]) = span_with_jets(function, from, to);
        let length = to - from;
        let (mut integral, mut gap) = ([0.0; 4], [0.0; 4]);
        let differences = [
            None,
            Some(last.value - first.value),
            Some(last.rate - first.rate),
            Some(last.acceleration - first.acceleration),
        ];
        for k in 0..4 {
            let i: Interval = span.0[k];
            match differences[k] {
                Some(difference) if i.low >= 0.0 || i.high <= 0.0 => integral[k] = difference.abs(),
                _ => {
                    integral[k] = length * i.size();
                    gap[k] = length * (i.size() - i.least());
                }
            }
        }
        Self {
            from,
            to,
            ends: [first, last],
            integral,
            gap,
        }
    }

    fn weighed(self, integral: &[f64; 4], orders: usize) -> Weighed {
        let weight = (0..orders)
            .map(|k| {
                if self.gap[k] > 0.0 {
                    self.gap[k] / integral[k]
                } else {
                    0.0
                }
            })
            .fold(0.0, f64::max);
        Weighed { weight, part: self }
    }
}

struct Weighed {
    weight: f64,
    part: Part,
}

impl PartialEq for Weighed {
    fn eq(&self, other: &Self) -> bool {
        self.weight.total_cmp(&other.weight).is_eq()
    }
}
impl Eq for Weighed {}
impl PartialOrd for Weighed {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Weighed {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.weight.total_cmp(&other.weight)
    }
}
