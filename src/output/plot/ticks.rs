//! Round numbers along an axis.

use crate::output::numbers::{pretty_unit, scaled_unit, significant, superscript};

/// Additional numbers of intervals that are tried until an axis has two ticks.
const MORE: usize = 8;
/// Largest number of ticks of a logarithmic axis.
const MOST_TICKS: usize = 12;
/// Narrowest range of an axis relative to its values, which labels of 12 digits resolve; a narrower one is widened.
const NARROWEST: f64 = 1e-11;
/// Range relative to its values below which a column is constant except for rounding errors.
const CONSTANT: f64 = 1e-8;
/// Half range around a constant relative to it.
const AROUND: f64 = 0.05;
/// Largest number of decimals of a label.
const MOST_DECIMALS: usize = 14;

/// A linear or logarithmic axis with its ticks.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// Least value shown, or its logarithm.
    pub lo: f64,
    /// Largest value shown, or its logarithm.
    pub hi: f64,
    /// True if `lo`, `hi` and ticks are decimal logarithms.
    pub logarithmic: bool,
    /// Value (or its logarithm) and label of each tick.
    pub ticks: Vec<(f64, String)>,
    /// Unit of the labels, SI prefix included; empty when dimensionless.
    pub unit: String,
}

impl Scale {
    /// Scale exactly from `lo` to `hi`, with about `count` ticks at most and two at least: a single tick does not show the scale.
    pub fn exact(lo: f64, hi: f64, unit: &str, count: usize) -> Self {
        let size = lo.abs().max(hi.abs());
        let half = if size > 0.0 { AROUND * size } else { 0.5 };
        let (lo, hi) = match hi > lo && hi - lo > NARROWEST * size {
            true => (lo, hi),
            false => (lo - half, lo + half),
        };
        let (factor, shown_unit) = scaled_unit(lo.abs().max(hi.abs()), unit);
        let places = |count: usize| {
            let step = round_step((hi - lo) / factor, count);
            let first = (lo / factor / step - 1e-9).ceil() as i64;
            let last = (hi / factor / step + 1e-9).floor() as i64;
            (step, first, last)
        };
        let counts = count..count + MORE;
        let (step, first, last) = counts
            .map(places)
            .find(|(_, first, last)| last > first)
            .unwrap_or_else(|| places(count));
        let decimals = decimals(step);
        let ticks = (first..=last).map(|k| {
            let shown = k as f64 * step;
            (shown * factor, label(shown, decimals))
        });
        Self {
            lo,
            hi,
            logarithmic: false,
            ticks: ticks.collect(),
            unit: shown_unit,
        }
    }

    /// Scale of logarithms of values in a unit from `lo` to `hi`, with a margin and about `count` ticks: round values at their logarithms
    /// over less than a decade, otherwise these multiples of powers of ten.
    pub fn logarithmic((lo, hi): (f64, f64), margin: f64, multiples: &[f64], (unit, count): (&str, usize)) -> Self {
        let (lo, hi) = (lo - margin, hi + margin);
        let (lo, hi) = if hi - lo > NARROWEST {
            (lo, hi)
        } else {
            (lo - 0.05, hi + 0.05)
        };
        let linear = || {
            let mut scale = Self::exact(10_f64.powf(lo), 10_f64.powf(hi), unit, count);
            scale.ticks.iter_mut().for_each(|tick| tick.0 = tick.0.log10());
            Self {
                lo,
                hi,
                logarithmic: true,
                ..scale
            }
        };
        if hi - lo < 1.0 {
            return linear();
        }
        let (factor, unit_shown) = match unit {
            "1" => (1.0, String::new()),
            _ => scaled_unit(10_f64.powf(0.5 * (lo + hi)), unit),
        };
        let decades = lo.floor() as i32..=hi.ceil() as i32;
        let marks = decades.flat_map(|n| multiples.iter().map(move |m| m * 10_f64.powi(n)));
        let seen = marks.filter(|v| (lo..=hi).contains(&v.log10()));
        let label = |v: f64| match multiples.len() == 1 && unit == "1" {
            true => format!("10{}", superscript(v.log10().round() as i32)),
            false => significant(v / factor, 1),
        };
        let ticks: Vec<_> = seen.map(|v| (v.log10(), label(v))).collect();
        let every = ticks.len().div_ceil(MOST_TICKS).max(1);
        match ticks.len() {
            0 | 1 => linear(),
            _ => Self {
                lo,
                hi,
                logarithmic: true,
                ticks: ticks.into_iter().step_by(every).collect(),
                unit: unit_shown,
            },
        }
    }

    /// Scale around the values, with a margin. It extends at least `floor` to either side of their middle, and a part of the value around a
    /// constant, so that round-off shows as a flat line.
    pub fn around(extent: Option<(f64, f64)>, floor: f64, unit: &str, count: usize) -> Self {
        let (lo, hi) = extent.unwrap_or((0.0, 0.0));
        let size = lo.abs().max(hi.abs());
        let around = if hi - lo < CONSTANT * size {
            AROUND * size
        } else {
            0.53 * (hi - lo)
        };
        let half = around.max(floor);
        let half = if half > 0.0 { half } else { 1.0 };
        let middle = 0.5 * (lo + hi);
        let mut scale = Self::exact(middle - half, middle + half, unit, count);
        if scale.unit.is_empty() {
            scale.unit = pretty_unit(unit);
        }
        scale
    }

    /// Relative position of a tick on the axis: 0 at `lo`, 1 at `hi`.
    pub fn share(&self, tick: f64) -> f64 {
        (tick - self.lo) / (self.hi - self.lo)
    }

    /// Relative position of a value on the axis.
    pub fn share_of(&self, value: f64) -> f64 {
        self.share(if self.logarithmic { value.log10() } else { value })
    }

    /// A name followed by the unit: `u₁ [mm]`.
    pub fn named(&self, name: &str) -> String {
        if self.unit.is_empty() {
            name.to_string()
        } else {
            format!("{name} [{}]", self.unit)
        }
    }
}

/// Smallest of 1, 2, 2.5, 5 times a power of ten that gives at most `count` intervals.
fn round_step(range: f64, count: usize) -> f64 {
    let least = range / count.max(1) as f64;
    let power = 10f64.powf(least.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0]
        .into_iter()
        .find(|s| s * power >= least * (1.0 - 1e-9));
    step.unwrap_or(10.0) * power
}

/// Number of decimals that distinguishes multiples of a step.
fn decimals(step: f64) -> usize {
    (0..MOST_DECIMALS)
        .find(|&d| {
            let scaled = step * 10f64.powi(d as i32);
            (scaled - scaled.round()).abs() < 1e-6 * scaled
        })
        .unwrap_or(MOST_DECIMALS)
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

    /// Goal: every axis has at least two ticks, linear or logarithmic.
    #[test]
    fn an_axis_has_two_ticks() {
        for count in [1, 2, 3, 4, 5, 10] {
            for k in 0..400 {
                let lo = -3.7 + 0.01137 * f64::from(k);
                for width in [0.3, 0.95, 1.9, 3.9, 4.9, 1234.5] {
                    let scale = Scale::exact(lo, lo + width, "m", count);
                    assert!(scale.ticks.len() >= 2, "{lo} {width} {count}: {:?}", scale.ticks);
                    let scale = Scale::logarithmic((lo, lo + 0.1 * width), 0.02, &[1.0, 2.0, 5.0], ("Pa", count));
                    assert!(scale.ticks.len() >= 2, "{lo} {width} {count}: {:?}", scale.ticks);
                }
            }
        }
    }

    /// Goal: a logarithmic axis also has a unit.
    #[test]
    fn logarithmic_axes_have_units() {
        let scale = Scale::logarithmic((-11.0, -9.0), 0.02, &[1.0], ("m^3/(s Pa)", 7));
        assert_eq!(scale.named("conductance"), "conductance [10⁻¹² m³/(s Pa)]");
        assert_eq!(labels(&scale), ["10", "100", "1000"]);
    }

    /// Goal: below a decade, ticks of a logarithmic axis are round numbers at their logarithms, and labels differ.
    #[test]
    fn narrow_logarithmic_axes_have_round_ticks() {
        let of = |lo: f64, hi: f64| Scale::logarithmic((lo.log10(), hi.log10()), 0.0, &[1.0, 2.0, 5.0], ("Hz", 5));
        let scale = of(12.493, 12.583);
        assert_eq!(labels(&scale), ["12.50", "12.52", "12.54", "12.56", "12.58"]);
        for (at, text) in &scale.ticks {
            let value: f64 = text.parse().expect("a number");
            assert!((at - value.log10()).abs() < 1e-12, "{at} {text}");
        }
        assert_eq!(labels(&of(2.1, 6.2)), ["3", "4", "5", "6"]);
        assert_eq!(labels(&of(0.9, 110.0)), ["1", "2", "5", "10", "20", "50", "100"]);
        for k in 0..400 {
            let lo = 10_f64.powf(-3.0 + 0.0173 * f64::from(k));
            for ratio in [1.0 + 1e-10, 1.0001, 1.01, 1.3, 3.0, 9.0, 30.0] {
                let all = of(lo, ratio * lo);
                let mut texts = labels(&all);
                texts.dedup();
                assert!(
                    texts.len() >= 2 && texts.len() == all.ticks.len(),
                    "{lo} {ratio}: {texts:?}"
                );
            }
        }
    }

    /// Goal: labels around a constant with rounding errors are short and differ.
    #[test]
    fn constants_have_short_labels() {
        for value in [180.0, -3.21e-7, 1.0, 12_345.678, 1e9, 0.3] {
            for (lo, hi) in [(value, value), (value, value + 1e-13 * f64::abs(value))] {
                for scale in [Scale::around(Some((lo, hi)), 0.0, "1", 5), Scale::exact(lo, hi, "1", 5)] {
                    let mut texts = labels(&scale);
                    texts.dedup();
                    assert!(
                        texts.len() >= 2 && texts.len() == scale.ticks.len(),
                        "{value}: {texts:?}"
                    );
                    assert!(texts.iter().all(|text| text.chars().count() <= 7), "{value}: {texts:?}");
                    assert!(scale.lo < value && value < scale.hi, "{value}");
                }
            }
        }
    }

    #[test]
    fn nothing_to_show_still_makes_an_axis() {
        assert!(!Scale::around(None, 0.0, "Pa", 4).ticks.is_empty());
        let flat = Scale::around(Some((1e-18, 2e-18)), 1e-7, "m", 4);
        assert_eq!(flat.unit, "nm");
        assert!(labels(&flat).contains(&"0"));
    }
}
