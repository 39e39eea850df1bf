//! Error band of the history of a run: half widths around its columns at some of its output times.
//!
//! With `d(t)` the difference of run and companion in a column, `P` the period of the drive and `e` the errors of the figures of its
//! quantity, the half width is
//!
//! ```text
//! w(t) = s max(d in [t - P, t])                     s = (largest e)/min(largest difference of the figures, max d)
//! w(t) ≥ s SHARED max(d in [0, t], t/T max d)       T: length of the run
//! w(t) ≥ e(final) max(d in [0, t])/max d
//! ```
//!
//! Two oscillations cross twice a period: the band has the largest difference of the preceding period, or of the preceding tenth of a run
//! without a drive. As for figures, agreement by accident leaves a share of the largest difference, to which errors of phase grow in
//! proportion to time. The factor `s` is what the causes of errors add to the companion. The largest half width is at least the largest
//! error of the figures, that at the end at least the error of the last value. The band begins where the two runs do.

use std::collections::VecDeque;

use super::error::{SHARED, differences, figures};
use crate::discrete::quantities::probes::{HistoryColumn, key};
use crate::discrete::quantities::{Group, Interest, InterestSource, Observable};
use crate::run::record::ThinnedRows;
use crate::run::summary::{Figures, Summary, largest_error};

/// Part of a run without a drive whose largest difference counts, and the fewest rows.
const RECENT: f64 = 0.1;
const FEWEST: usize = 16;
/// Number of digits of a half width.
const DIGITS: i32 = 3;
/// Half widths that are no rounding errors.
const NUMBERS: std::ops::Range<f64> = 1e-280..1e280;

/// Half widths of the error bands of history columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorBand {
    /// Names and units of the columns; the first is time.
    pub names: Vec<(String, String)>,
    /// Time and half widths, in order of time.
    pub rows: Vec<Vec<f64>>,
}

impl ErrorBand {
    /// The band of a run with a drive of some period [s]. `None` if the companion was recorded at other instants.
    pub fn new(run: &ThinnedRows, companion: &ThinnedRows, summary: &Summary, period: Option<f64>) -> Option<Self> {
        let other = &summary.companion.as_ref()?.figures;
        let (own, others): (Vec<&[f64]>, Vec<&[f64]>) = (run.rows().collect(), companion.rows().collect());
        let times: Vec<f64> = own.iter().filter_map(|row| row.first().copied()).collect();
        let alike = own.len() == others.len() && own.iter().zip(&others).all(|(a, b)| a.first() == b.first());
        let end = *times.last().filter(|_| alike)?;
        let recent = period.unwrap_or(RECENT * (end - times[0]));
        let measured = differences(&figures(summary), other);
        let mut band = Self {
            names: vec![("t".into(), "s".into())],
            rows: times.iter().map(|t| vec![*t]).collect(),
        };
        for (k, column) in run.columns().iter().enumerate().skip(1) {
            let Some(there) = companion.columns().iter().position(|one| one.name == column.name) else {
                continue;
            };
            let open = Observable::named(&column.name).is_some_and(|one| one.group() == Group::Open);
            if open || others.iter().all(|row| row[there].is_nan()) {
                continue;
            }
            let apart = own.iter().zip(&others).map(|(a, b)| (a[k] - b[there]).abs());
            let apart: Vec<f64> = apart.map(|d| if d.is_finite() { d } else { 0.0 }).collect();
            let bars = ColumnBars::new(column, run, summary, &measured);
            band.names.push((column.name.clone(), column.unit.into()));
            let widths = half_widths(&times, &apart, recent, &bars);
            band.rows
                .iter_mut()
                .zip(widths)
                .for_each(|(row, width)| row.push(width));
        }
        Some(band)
    }

    /// Half widths of a column over time; `None` if it has no band.
    pub fn column_widths(&self, column: &str) -> Option<Vec<(f64, f64)>> {
        let k = self.names.iter().skip(1).position(|(name, _)| name == column)? + 1;
        let all = self.rows.iter().filter(|row| row.len() > k);
        Some(all.map(|row| (row[0], row[k])).collect())
    }
}

/// Half width at a time [s], linear between those of a column; `None` outside of them.
pub fn width_at(widths: &[(f64, f64)], t: f64) -> Option<f64> {
    let after = widths.partition_point(|(at, _)| *at < t);
    let (to, high) = *widths.get(after)?;
    if to <= t {
        return Some(high);
    }
    let (from, low) = *widths.get(after.checked_sub(1)?)?;
    Some(low + (high - low) * (t - from) / (to - from))
}

/// Errors of the figures of a column.
#[derive(Clone, Copy, Debug, Default)]
struct ColumnBars {
    /// Largest error.
    error: f64,
    /// Largest difference of run and companion.
    measured: f64,
    /// Error of the last value.
    last: f64,
}

impl ColumnBars {
    fn new(column: &HistoryColumn, run: &ThinnedRows, summary: &Summary, measured: &Figures) -> Self {
        let one = Observable::named(&column.name);
        let interest = one.and_then(|one| {
            Interest::ALL
                .iter()
                .copied()
                .find(|interest| interest.columns().contains(&one))
        });
        let energy = one.and_then(|one| {
            let of = |interest: &Interest| interest.source() == InterestSource::Energy(one.group());
            Interest::ALL.iter().copied().find(of)
        });
        let stored = (column.unit == "J").then_some(Interest::InputEnergy);
        let name = match interest.or(energy).or(stored) {
            Some(interest) => interest.name().into(),
            None => key(&column.name, column.unit),
        };
        let largest = |of: &Figures| of.get(&name).and_then(largest_error).unwrap_or(0.0);
        // the last value of several columns is that of the largest one
        let last = run.rows().last();
        let at_end = |name: &str| {
            let k = run.columns().iter().position(|one| one.name == name);
            last.zip(k).map_or(0.0, |(row, k)| row[k].abs())
        };
        let leads = match interest {
            Some(interest) => {
                let others = interest.columns().iter();
                others.fold(0.0, |most: f64, one| most.max(at_end(one.name()))) <= at_end(&column.name)
            }
            None => energy == Some(Interest::HarvestedEnergy) || one.is_none(),
        };
        Self {
            error: largest(&summary.errors),
            measured: largest(measured),
            last: summary.error(&name, "final").filter(|_| leads).unwrap_or(0.0),
        }
    }
}

/// Half widths at all times, from the differences of two runs.
fn half_widths(times: &[f64], apart: &[f64], recent: f64, bars: &ColumnBars) -> Vec<f64> {
    let all = apart.iter().copied().fold(0.0, f64::max);
    let length = times.last().map_or(0.0, |end| end - times[0]).max(f64::MIN_POSITIVE);
    let least = bars.measured.min(all);
    let factor = if least > 0.0 && bars.error > 0.0 {
        bars.error / least
    } else {
        1.0
    };
    // rows of the recent past, the largest difference first
    let mut past: VecDeque<usize> = VecDeque::new();
    let mut so_far = 0.0_f64;
    let width = |(k, d): (usize, &f64)| {
        so_far = so_far.max(*d);
        while past.back().is_some_and(|&j| apart[j] <= *d) {
            past.pop_back();
        }
        past.push_back(k);
        while past
            .front()
            .is_some_and(|&j| times[j] < times[k] - recent && j + FEWEST < k)
        {
            past.pop_front();
        }
        let largest = past.front().map_or(*d, |&j| apart[j]);
        let share = if all > 0.0 { so_far / all } else { 0.0 };
        let grown = all * (times[k] - times[0]) / length;
        rounded_up((factor * largest.max(SHARED * so_far.max(grown))).max(bars.last * share))
    };
    apart.iter().enumerate().map(width).collect()
}

/// Rounds up to a few digits.
fn rounded_up(width: f64) -> f64 {
    if !NUMBERS.contains(&width) {
        return 0.0;
    }
    let power = width.log10().floor() as i32 - DIGITS + 1;
    let scale = 10_f64.powi(power.abs());
    let digits = if power < 0 { width * scale } else { width / scale }.ceil();
    match power {
        -22..0 => digits / scale,
        0..=22 => digits * scale,
        // further powers of ten are not exact
        _ => format!("{digits}e{power}").parse().unwrap_or(width),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: the band of two oscillations that cross is open from the first period on, begins at zero, and ends no narrower than the bar
    /// of the last value.
    #[test]
    fn a_band_has_no_waist() {
        let times: Vec<f64> = (0..=1000).map(|k| 0.01 * f64::from(k)).collect();
        let apart: Vec<f64> = times.iter().map(|t| (t * (6.0 * t).sin()).abs()).collect();
        let bars = ColumnBars {
            error: 9.0,
            measured: 9.0,
            last: 8.0,
        };
        let widths = half_widths(&times, &apart, 1.05, &bars);
        assert_eq!(widths[0], 0.0);
        for (k, (width, d)) in widths.iter().zip(&apart).enumerate() {
            assert!(width >= d, "{k}: {width} below {d}");
            assert!(times[k] < 1.0 || *width > 0.7 * (times[k] - 0.6), "{k}: {width}");
        }
        assert!(widths[1000] >= 8.0 && widths.iter().all(|width| *width < 10.1));
        assert_eq!(rounded_up(1.2341e-7), 1.24e-7);
        assert_eq!(rounded_up(9.991e5), 1e6);
        assert_eq!([2.7351e-36, 8.781e-62].map(rounded_up), [2.74e-36, 8.79e-62]);
        assert_eq!([0.0, 1e-300, f64::INFINITY, f64::NAN].map(rounded_up), [0.0; 4]);
    }
}
