//! Columns of a table as curves with their error bands.

use super::names::for_readers;
use super::table::{ResultTable, SWEEP};
use super::{NamedCurve, QuantityPanel};
use crate::error::{Error, Result};
use crate::output::envelope::{Envelope, HistorySource, RowOrigin, each_row};
use crate::output::error_band;
use crate::output::folder::{HISTORY, fault, open};
use crate::study::companion::band::width_at;

/// Number of stretches of a curve whose extremes are drawn: more than the dots of a printer across a page.
const STRETCHES: usize = 4000;

/// Columns of numbers, and the text that splits their rows.
struct ReadColumns {
    wanted: Vec<usize>,
    numbers: Vec<Vec<f64>>,
    groups: Vec<String>,
}

impl ReadColumns {
    fn column(&self, k: usize) -> &[f64] {
        let at = self.wanted.iter().position(|own| *own == k);
        at.map_or(&[], |at| &self.numbers[at])
    }

    /// Values of a column in rows with this text; all rows without one.
    fn within(&self, k: usize, group: Option<&str>) -> Vec<f64> {
        let own = |row: &usize| group.is_none_or(|group| self.groups[*row] == group);
        let column = self.column(k);
        (0..column.len()).filter(own).map(|row| column[row]).collect()
    }

    /// Texts that split the rows, in the order of their first appearance; none if there are not two of them.
    fn parts(&self) -> Vec<Option<&str>> {
        let mut all: Vec<Option<&str>> = vec![];
        for group in &self.groups {
            if !all.contains(&Some(group.as_str())) {
                all.push(Some(group));
            }
        }
        if all.len() < 2 { vec![None] } else { all }
    }
}

/// Origin of the error band of a column.
enum BandSource {
    /// Column of half widths.
    Error(usize),
    /// Columns of the lower and the upper limit.
    Limits(usize, usize),
    /// Times and half widths of `errors.csv`; none if there is no band.
    Widths(Vec<(f64, f64)>),
}

impl ResultTable<'_> {
    /// Panels of quantities with the curves of this result, named `label`; `over` is the abscissa, `within` the range of it that is shown.
    ///
    /// # Errors
    /// A name is unknown, or the table cannot be read.
    pub fn panels(
        &self,
        quantities: &[usize],
        over: Option<&str>,
        label: &str,
        within: [Option<f64>; 2],
    ) -> Result<Vec<QuantityPanel>> {
        let x = match over {
            Some(name) => self.find(name)?,
            None => {
                let none = || Error::Usage(format!("{}: its table has no numbers", self.dir.display()));
                self.abscissa().ok_or_else(none)?
            }
        };
        let in_time = over.is_none() && self.known.file == HISTORY;
        let bands = quantities
            .iter()
            .map(|k| self.band(*k, in_time))
            .collect::<Result<Vec<_>>>()?;
        let mut wanted: Vec<usize> = [x].into_iter().chain(quantities.iter().copied()).collect();
        for band in &bands {
            match band {
                BandSource::Error(k) => wanted.push(*k),
                BandSource::Limits(low, high) => wanted.extend([low, high]),
                BandSource::Widths(_) => {}
            }
        }
        let read = self.read(wanted, within, x)?;
        let panels = quantities.iter().zip(&bands).map(|(&k, band)| {
            let of = &self.columns[k];
            let curves = read.parts().into_iter().map(|part| {
                let points: Vec<_> = read.within(x, part).into_iter().zip(read.within(k, part)).collect();
                let name = match part.map(|part| part.replace('_', " ")) {
                    None => label.to_string(),
                    Some(part) if label.is_empty() => part,
                    Some(part) => format!("{label}: {part}"),
                };
                let band = around(&points, band, |k| read.within(k, part));
                match in_time {
                    true => NamedCurve {
                        label: name,
                        points: thinned(points),
                        band: thinned_band(&band),
                    },
                    false => NamedCurve {
                        label: name,
                        points,
                        band,
                    },
                }
            });
            QuantityPanel {
                x: for_readers(&self.columns[x].name, &self.columns[x].unit),
                y: for_readers(&of.name, &of.unit),
                curves: curves.collect(),
                marks: self.known.marks,
                logarithmic: match over {
                    None => {
                        let [along, up] = self.axes(&of.name);
                        let by_factors = self.known.file == SWEEP && is_geometric(read.column(x));
                        [along || by_factors, up]
                    }
                    Some(_) => [false; 2],
                },
                equal: false,
            }
        });
        Ok(panels.collect())
    }

    /// Origin of the error band of a quantity.
    fn band(&self, k: usize, in_time: bool) -> Result<BandSource> {
        let of = |name: String| self.columns.iter().position(|column| column.name == name);
        let name = &self.columns[k].name;
        let error = name
            .strip_prefix("amplitude ")
            .and_then(|rest| of(format!("error {rest}")));
        let limits = of(format!("{name} low")).zip(of(format!("{name} high")));
        Ok(match (error, limits) {
            (Some(error), _) => BandSource::Error(error),
            (None, Some((low, high))) => BandSource::Limits(low, high),
            (None, None) if in_time => {
                BandSource::Widths(error_band::read(self.dir)?.column_widths(name).unwrap_or_default())
            }
            (None, None) => BandSource::Widths(vec![]),
        })
    }

    /// Logarithmic axes of a quantity over the usual abscissa.
    fn axes(&self, quantity: &str) -> [bool; 2] {
        let [x, y] = self.known.logarithmic;
        [
            x,
            y || quantity.starts_with("amplitude ") || quantity.starts_with("mean power "),
        ]
    }

    /// Reads columns of numbers within a range of the abscissa.
    fn read(&self, wanted: Vec<usize>, [from, to]: [Option<f64>; 2], x: usize) -> Result<ReadColumns> {
        let mut read = ReadColumns {
            numbers: vec![vec![]; wanted.len()],
            wanted,
            groups: vec![],
        };
        let inside = |at: f64| from.is_none_or(|from| at >= from) && to.is_none_or(|to| at <= to);
        if self.known.file == HISTORY {
            each_row(HistorySource::Folder(self.dir), |_, origin, row| {
                if origin != RowOrigin::Covered && row.get(x).is_some_and(|at| inside(*at)) {
                    for (values, k) in read.numbers.iter_mut().zip(&read.wanted) {
                        values.push(row.get(*k).copied().unwrap_or(f64::NAN));
                    }
                }
            })?;
            return Ok(read);
        }
        let path = self.dir.join(self.known.file);
        let split = self.known.split;
        let split = split.and_then(|name| self.columns.iter().position(|column| column.name == name));
        let file = open(&path).map_err(|e| fault("read", &path, e))?;
        for record in csv::ReaderBuilder::new().flexible(true).from_reader(file).records() {
            let record = record.map_err(|e| fault("read", &path, e.into()))?;
            let number = |k: usize| {
                record
                    .get(k)
                    .and_then(|cell| cell.trim().parse().ok())
                    .unwrap_or(f64::NAN)
            };
            if inside(number(x)) {
                let columns = read.numbers.iter_mut().zip(&read.wanted);
                columns.for_each(|(values, k)| values.push(number(*k)));
                read.groups
                    .extend(split.map(|k| record.get(k).unwrap_or_default().to_string()));
            }
        }
        Ok(read)
    }
}

/// True if at least three different values have a constant ratio.
fn is_geometric(values: &[f64]) -> bool {
    let mut all: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    let (Some(first), [low, next, _, ..]) = (all.first(), all.as_slice()) else {
        return false;
    };
    let ratio = next / low;
    // a constant ratio near one is a constant difference too
    *first > 0.0
        && ratio > 1.01
        && all
            .windows(2)
            .all(|pair| (pair[1] / pair[0] / ratio - 1.0).abs() < 1e-6)
}

/// Band around points: abscissa, lower and upper limit.
fn around(points: &[(f64, f64)], source: &BandSource, column: impl Fn(usize) -> Vec<f64>) -> Vec<(f64, f64, f64)> {
    match source {
        BandSource::Error(k) => {
            let widths = points.iter().zip(column(*k));
            widths.map(|(p, width)| (p.0, p.1 - width, p.1 + width)).collect()
        }
        BandSource::Limits(low, high) => {
            let limits = column(*low).into_iter().zip(column(*high));
            points
                .iter()
                .zip(limits)
                .map(|(p, (low, high))| (p.0, low, high))
                .collect()
        }
        BandSource::Widths(widths) => {
            let width = |p: &(f64, f64)| {
                let width = width_at(widths, p.0).unwrap_or(f64::NAN);
                (p.0, p.1 - width, p.1 + width)
            };
            points.iter().map(width).collect()
        }
    }
}

/// The first limits of each stretch of a band; a stretch with missing ones is missing.
fn thinned_band(band: &[(f64, f64, f64)]) -> Vec<(f64, f64, f64)> {
    let stretches = band.chunks(band.len().div_ceil(STRETCHES).max(1));
    let of = |stretch: &[(f64, f64, f64)]| {
        let missing = stretch.iter().find(|p| !(p.1.is_finite() && p.2.is_finite()));
        missing.or(stretch.first()).copied()
    };
    stretches.filter_map(of).collect()
}

/// Extremes of stretches of a curve in time; all points of a short one.
fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let mut envelope = Envelope::new(STRETCHES);
    let names = ["x", "y"].map(|name| (name.to_string(), "1".to_string()));
    for (x, y) in points {
        envelope.add(&names, RowOrigin::History, &[x, y]);
    }
    envelope.points(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constant_ratios_are_geometric() {
        assert!(is_geometric(&[1.0, 10.0, 1.0, 100.0]) && is_geometric(&[1e-10, 3.16227766e-10, 1e-9]));
        for values in [
            &[1.0, 2.0, 3.0][..],
            &[1.0, 10.0],
            &[0.0, 1.0, 10.0],
            &[-4.0, -2.0, -1.0],
            &[1.0, 1.0, 1.0],
        ] {
            assert!(!is_geometric(values), "{values:?}");
        }
    }

    /// Goal: a stretch with a missing limit leaves a gap.
    #[test]
    fn thinned_bands_keep_gaps() {
        let mut band: Vec<_> = (0..10 * STRETCHES).map(|k| (k as f64, 0.0, 1.0)).collect();
        band[57].1 = f64::NAN;
        let thinned = thinned_band(&band);
        assert_eq!(thinned.len(), STRETCHES);
        assert_eq!(thinned.iter().filter(|p| p.1.is_nan()).count(), 1);
    }
}
