//! Integral of a function of time.

use super::signals::{Signal, SmoothTime};
use crate::numerics::gauss::Gauss;

/// Gauss points per piece.
const POINTS: usize = 8;
/// Pieces per shortest time scale: eight points integrate an eighth of a period to machine precision.
const PIECES: f64 = 8.0;
/// Largest number of pieces in a smooth interval.
const MOST: f64 = 1e5;

impl Signal {
    /// `∫ f dt` from 0 to `end` [s], by piecewise Gauss quadrature between switching times; 0 for negative `end`.
    pub fn integral(&self, end: f64) -> f64 {
        if end <= 0.0 {
            return 0.0;
        }
        let rule = Gauss::new(POINTS);
        let scale = self.fastest_period_s().filter(|scale| *scale > 0.0);
        let piece = |(from, to): (f64, f64)| -> f64 {
            let count = scale.map_or(1.0, |scale| (PIECES * (to - from) / scale).ceil().clamp(1.0, MOST));
            let width = (to - from) / count;
            let within = 0.5 * (from + to);
            let begins = (0..count as usize).map(|k| from + width * k as f64);
            let values = begins.flat_map(|begin| {
                let points = rule.on(begin, begin + width);
                points.map(|(t, weight)| weight * self.jet(SmoothTime { t, within }).value)
            });
            values.sum()
        };
        self.smooth_intervals(end).into_iter().map(piece).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::Signal;

    #[test]
    fn integrals_are_exact() {
        let signal = |text: &str| serde_json::from_str::<Signal>(text).unwrap();
        for (text, end, exact) in [
            ("2.5", 2.0, 5.0),
            (r#"{"ramp": {"to": 3, "start_s": 1, "duration_s": 2}}"#, 4.0, 6.0),
            (r#"{"sine": {"amplitude": 2, "frequency_hz": 7}}"#, 10.0, 0.0),
            (r#"{"polynomial": {"coefficients": [1, 0, 3]}}"#, 2.0, 10.0),
            (r#"{"polynomial": {"coefficients": [1, 0, 3]}}"#, -2.0, 0.0),
        ] {
            assert!((signal(text).integral(end) - exact).abs() < 1e-12, "{text}");
        }
    }
}
