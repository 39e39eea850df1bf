//! Curves that are extended piece by piece, for signals that are set from outside and must not jump.
//!
//! From value `y0` with rate `r` to value `y1` after a time h, with `d = y1 - y0 - h r` and `s = (t - t0)/h`:
//!
//! ```text
//! y'' = (4 - 6 s) d/h^2        y'(h) = (y1 - y0)/h
//! ```
//!
//! The rate is continuous if a piece is at most as long as the piece before. A longer one starts with the change of the piece before over
//! its own length: otherwise the curve would overshoot in proportion to its length. The overshoot is at most 4/27 of that change.

use super::PiecewiseCurve;
use super::jet::Jet;

impl PiecewiseCurve {
    /// Constant from a place on.
    pub fn constant(at: f64, value: f64) -> Self {
        Self {
            at: vec![at],
            values: vec![value],
            ..Self::default()
        }
    }

    /// Curve that follows this one until `from`, and reaches `value` at `to` by a cubic. The rate at `to` is the mean rate of the cubic. Of the pieces before, only the last one and the first point remain. A curve that rests at `value` ends at
    /// `from`, and is constant from there.
    pub fn moved(&self, [from, to]: [f64; 2], value: f64) -> Self {
        let last = self.at.len() - 1;
        let start = match last {
            0 => Jet::constant(self.values[0]),
            _ if from > self.at[last] => Jet::constant(self.values[last]),
            _ => self.piece(last - 1, from),
        };
        let mut curve = Self::constant(self.at[0], self.values[0]);
        let mut reach = |at: f64, value: f64, second: [f64; 2]| {
            if curve.at.last().is_some_and(|before| *before < at) {
                curve.at.push(at);
                curve.values.push(value);
                curve.second.push(second);
            }
        };
        if last > 0 && from <= self.at[last] {
            // the last piece, up to `from`
            reach(self.at[last - 1], self.values[last - 1], [0.0; 2]);
            reach(from, start.value, [self.second[last - 1][0], start.acceleration]);
        } else {
            reach(self.at[last], self.values[last], [0.0; 2]);
            reach(from, start.value, [0.0; 2]);
        }
        let h = to - from;
        let before = if last > 0 { from - self.at[last - 1] } else { h };
        let rate = start.rate * (before / h).min(1.0);
        let bend = (value - start.value - h * rate) / (h * h);
        if value != start.value || rate != 0.0 {
            reach(to, value, [4.0 * bend, -2.0 * bend]);
        }
        curve
    }

    /// True if the parts fit together, as those of a curve that was stored.
    pub fn is_whole(&self) -> bool {
        !self.at.is_empty() && self.at.len() == self.values.len() && self.at.len() == self.second.len() + 1
    }
}

#[cfg(test)]
mod tests {
    use super::PiecewiseCurve;
    use crate::functions::Interpolation;

    /// Goal: values, and rates on both sides of a point, by the formula of the module: continuous unless the piece is longer than the one
    /// before. Tolerance: rounding errors.
    #[test]
    fn a_moved_curve_reaches_its_values_by_cubics() {
        let mut curve = PiecewiseCurve::constant(0.0, 2.0);
        let (mut t, mut value, mut rate, mut length) = (0.0, 2.0, 0.0, 1.0);
        for (h, next) in [(0.1, 3.0), (0.3, 2.5), (0.2, 2.5), (0.1, 2.5), (0.2, 4.0)] {
            curve = curve.moved([t, t + h], next);
            assert!(curve.is_whole());
            let at = |t, within| curve.jet(t, within, Interpolation::Monotone);
            let start = at(t, t + 0.5 * h);
            assert!(
                (start.value - value).abs() < 1e-14 && (start.rate - rate * f64::min(1.0, length / h)).abs() < 1e-12,
                "{start:?}"
            );
            if t > 0.0 {
                let before = at(t, t - 1e-3);
                assert!(
                    (before.value - value).abs() < 1e-14 && (before.rate - rate).abs() < 1e-12,
                    "{before:?}"
                );
            }
            (rate, value, length) = ((next - value) / h, next, h);
            t += h;
            assert_eq!(at(t, t - 0.5 * h).value, next);
            assert_eq!(at(0.0, 0.0).value, 2.0);
        }
    }

    /// Goal: a long piece after a short one overshoots by at most 4/27 of the last change; with a continuous rate it is 148 times the change.
    #[test]
    fn long_pieces_hardly_overshoot() {
        let short = PiecewiseCurve::constant(0.0, 0.0).moved([0.0, 1e-3], 1.0);
        let long = short.moved([1e-3, 1.001], 1.0);
        let values = (0..1000).map(|k| 1e-3 + 1e-3 * f64::from(k));
        let largest = values.map(|t| long.jet(t, 0.5, Interpolation::Monotone).value);
        let largest = largest.fold(0.0, f64::max);
        assert!((largest - 1.0 - 4.0 / 27.0).abs() < 1e-4, "{largest}");
    }

    /// Goal: a motion that is interrupted continues from the value and the rate that it has.
    #[test]
    fn an_interrupted_curve_continues_from_where_it_is() {
        let first = PiecewiseCurve::constant(0.0, 0.0).moved([0.0, 1.0], 1.0);
        let half = first.jet(0.5, 0.25, Interpolation::Monotone);
        let second = first.moved([0.5, 1.0], 3.0);
        let [before, after] = [0.4, 0.6].map(|within| second.jet(0.5, within, Interpolation::Monotone));
        assert!((before.value - half.value).abs() < 1e-15 && (after.value - half.value).abs() < 1e-15);
        assert!((before.rate - half.rate).abs() < 1e-14 && (after.rate - half.rate).abs() < 1e-14);
        let early = [&first, &second].map(|curve| curve.jet(0.3, 0.25, Interpolation::Monotone).value);
        assert!((early[0] - early[1]).abs() < 1e-15);
    }
}
