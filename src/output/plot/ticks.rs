//! Round numbers along an axis.

use crate::output::numbers::{pretty_unit, scaled_unit, significant};

/// A linear axis with its ticks.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// Least value shown.
    pub lo: f64,
    /// Largest value shown.
    pub hi: f64,
    /// Value and label of each tick.
    pub ticks: Vec<(f64, String)>,
    /// Unit of the labels, SI prefix included; empty when dimensionless.
    pub unit: String,
}

impl Scale {
    /// Exactly from `lo` to `hi`, with at most `count` ticks.
    pub fn exact(lo: f64, hi: f64, unit: &str, count: usize) -> Self {
        let (lo, hi) = if hi > lo { (lo, hi) } else { (lo - 0.5, lo + 0.5) };
        let (factor, shown_unit) = scaled_unit(lo.abs().max(hi.abs()), unit);
        let step = round_step((hi - lo) / factor, count);
        let decimals = decimals(step);
        let first = (lo / factor / step - 1e-9).ceil() as i64;
        let last = (hi / factor / step + 1e-9).floor() as i64;
        let ticks = (first..=last).map(|k| {
            let shown = k as f64 * step;
            (shown * factor, label(shown, decimals))
        });
        Self {
            lo,
            hi,
            ticks: ticks.collect(),
            unit: shown_unit,
        }
    }

    /// Of logarithms from `lo` to `hi`, with a margin, and ticks at these multiples of powers of ten.
    pub fn logarithmic((lo, hi): (f64, f64), margin: f64, multiples: &[f64], count: usize) -> Self {
        let mut scale = Self::exact(lo - margin, hi + margin, "1", count);
        let decades = lo.floor() as i32..=hi.ceil() as i32;
        let marks = decades.flat_map(|n| multiples.iter().map(move |m| m * 10_f64.powi(n)));
        let seen = marks.filter(|v| (scale.lo..=scale.hi).contains(&v.log10()));
        scale.ticks = seen.map(|v| (v.log10(), significant(v, 1))).collect();
        scale
    }

    /// Around the values, with a margin; at least `floor` wide to either side of their middle, so that round-off of a
    /// quantity that is zero shows as a flat line.
    pub fn around(extent: Option<(f64, f64)>, floor: f64, unit: &str, count: usize) -> Self {
        let (lo, hi) = extent.unwrap_or((0.0, 0.0));
        let half = (0.53 * (hi - lo)).max(floor).max(1e-12 * lo.abs().max(hi.abs()));
        let half = if half > 0.0 { half } else { 1.0 };
        let middle = 0.5 * (lo + hi);
        let mut scale = Self::exact(middle - half, middle + half, unit, count);
        if scale.unit.is_empty() {
            scale.unit = pretty_unit(unit);
        }
        scale
    }

    /// Where a value lies, 0 at `lo`, 1 at `hi`.
    pub fn share(&self, value: f64) -> f64 {
        (value - self.lo) / (self.hi - self.lo)
    }

    /// A name with the unit behind it: `u₁ [mm]`.
    pub fn named(&self, name: &str) -> String {
        if self.unit.is_empty() {
            name.to_string()
        } else {
            format!("{name} [{}]", self.unit)
        }
    }
}

/// The smallest of 1, 2, 2.5, 5 times a power of ten that makes at most `count` intervals.
fn round_step(range: f64, count: usize) -> f64 {
    let least = range / count.max(1) as f64;
    let power = 10f64.powf(least.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0]
        .into_iter()
        .find(|s| s * power >= least * (1.0 - 1e-9));
    step.unwrap_or(10.0) * power
}

/// Decimals that tell multiples of a step apart.
fn decimals(step: f64) -> usize {
    (0..9)
        .find(|&d| {
            let scaled = step * 10f64.powi(d);
            (scaled - scaled.round()).abs() < 1e-6 * scaled
        })
        .map_or(9, |d| d as usize)
}

fn label(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    // No minus before a zero, a true minus otherwise.
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_string(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: &Scale) -> Vec<&str> {
        scale.ticks.iter().map(|t| t.1.as_str()).collect()
    }

    #[test]
    fn ticks_are_round_and_carry_prefixes() {
        let scale = Scale::exact(-0.0021, 0.0023, "m", 5);
        assert_eq!(labels(&scale), ["−2", "−1", "0", "1", "2"]);
        assert_eq!(scale.named("u₁"), "u₁ [mm]");
        let scale = Scale::exact(0.45, 0.5, "s", 5);
        assert_eq!(labels(&scale), ["450", "460", "470", "480", "490", "500"]);
        assert_eq!(scale.unit, "ms");
    }

    #[test]
    fn nothing_to_show_still_makes_an_axis() {
        assert!(!Scale::around(None, 0.0, "Pa", 4).ticks.is_empty());
        let flat = Scale::around(Some((1e-18, 2e-18)), 1e-7, "m", 4);
        assert_eq!(flat.unit, "nm");
        assert!(labels(&flat).contains(&"0"));
    }
}
