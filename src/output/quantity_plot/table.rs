//! Columns of a result: the table of each kind, with its usual abscissa and quantities.

use std::path::Path;

use super::QuantityPanel;
use super::names::for_readers;
use crate::case::nearest;
use crate::discrete::quantities::probes::key;
use crate::error::{Error, Result};
use crate::output::envelope::{Envelope, HistorySource, RowOrigin, each_row};
use crate::output::error_band;
use crate::output::folder::{HISTORY, SUMMARY, fault, open};
use crate::output::kind::FolderKind;
use crate::output::summary;
use crate::output::sweep::pictures;
use crate::study::companion::band::width_at;

/// Number of stretches of a curve whose extremes are drawn: more than the dots of a printer across a page.
const STRETCHES: usize = 4000;
/// Number of rows that determine if a column is text.
const LOOKED_AT: usize = 100;

/// The table of a kind of result.
struct TableKind {
    file: &'static str,
    /// Usual abscissa; empty: the first column of numbers.
    over: &'static str,
    /// Usual quantities; empty: the first column behind the abscissa.
    shown: &'static [&'static str],
    /// Text column whose values are curves of their own.
    split: Option<&'static str>,
    /// True if rows are points instead of a curve.
    marks: bool,
    logarithmic: [bool; 2],
}

fn table_of(kind: FolderKind) -> TableKind {
    let curve = |file, over, shown| TableKind {
        file,
        over,
        shown,
        split: None,
        marks: false,
        logarithmic: [false; 2],
    };
    let points = |file, over, shown, split| TableKind {
        split,
        marks: true,
        ..curve(file, over, shown)
    };
    match kind {
        FolderKind::Run | FolderKind::Cycle => curve(HISTORY, "t", &["tip_u1"]),
        FolderKind::Equilibrium => curve("path.csv", "load_factor", &["tip_u1"]),
        FolderKind::Modes => points("modes.csv", "frequency", &["damping ratio"], Some("kind")),
        FolderKind::Response => TableKind {
            logarithmic: [true, false],
            ..curve("response.csv", "frequency", &["amplitude", "phase"])
        },
        FolderKind::Bands => points("bands.csv", "wave number", &["frequency"], Some("motion")),
        FolderKind::Floquet => points("floquet.csv", "real part", &["imaginary part"], Some("part")),
        FolderKind::Map => points("map.csv", "frequency", &["amplitude"], Some("verdict")),
        FolderKind::Sweep => curve("sweep.csv", "", &[]),
        FolderKind::Designs => points("sweep.csv", "", &[], Some("case")),
        FolderKind::Study => TableKind {
            logarithmic: [true; 2],
            ..points("study.csv", "wall_median", &["total_l2"], Some("measure"))
        },
        FolderKind::Effects => points("effects.csv", "steps", &[], Some("left_out")),
        FolderKind::Fit => curve("fit.csv", "", &[]),
        FolderKind::Sense => curve("sense.csv", "t", &[]),
        FolderKind::Optimum => points("designs.csv", "design", &[], Some("search")),
    }
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct TableColumn {
    /// Name without unit.
    pub name: String,
    /// Unit; `1` if dimensionless.
    pub unit: String,
    /// True for text.
    pub text: bool,
}

impl TableColumn {
    /// Heading: `tip_u1 [m]`.
    pub fn heading(&self) -> String {
        format!("{} [{}]", self.name, self.unit)
    }

    /// True if a name means this column: its name, its heading, or its key with unit; blanks and underscores are equal.
    fn is_named(&self, name: &str) -> bool {
        let plain = |text: &str| text.trim().to_lowercase().replace(' ', "_");
        let wanted = plain(name);
        [self.name.clone(), self.heading(), key(&self.name, &self.unit)]
            .iter()
            .any(|own| plain(own) == wanted)
    }
}

/// The table of a result folder.
pub struct ResultTable<'a> {
    dir: &'a Path,
    kind: FolderKind,
    known: TableKind,
    /// All columns.
    pub columns: Vec<TableColumn>,
}

impl<'a> ResultTable<'a> {
    /// Reads the headings.
    ///
    /// # Errors
    /// The folder has no result or no table, or the table cannot be read.
    pub fn open(dir: &'a Path) -> Result<Self> {
        let kind = FolderKind::find(dir)?;
        let known = table_of(kind);
        let path = dir.join(known.file);
        if !path.is_file() {
            return Err(Error::Usage(format!(
                "{}: the result of `slcbeam {}` has no {}, whose columns could be drawn",
                dir.display(),
                kind.command(),
                known.file
            )));
        }
        if known.file == HISTORY && dir.join(SUMMARY).is_file() {
            summary::verify_table(dir, HISTORY, &summary::read(dir)?)?;
        }
        let failed = |e: csv::Error| fault("read", &path, e.into());
        let mut reader = csv::ReaderBuilder::new()
            .flexible(true)
            .from_reader(open(&path).map_err(|e| fault("read", &path, e))?);
        let headings = reader.headers().map_err(failed)?.clone();
        let mut text = vec![false; headings.len()];
        let mut numbers = vec![false; headings.len()];
        for record in reader.records().take(LOOKED_AT) {
            for (k, cell) in record.map_err(failed)?.iter().enumerate().take(headings.len()) {
                let number = cell.trim().parse::<f64>().is_ok();
                numbers[k] |= number;
                text[k] |= !number && !cell.trim().is_empty();
            }
        }
        let columns = headings.iter().zip(text).zip(numbers).map(|((heading, text), number)| {
            let (name, unit) = match heading.trim().strip_suffix(']').and_then(|h| h.rsplit_once(" [")) {
                Some((name, unit)) => (name, unit),
                None => (heading.trim(), "1"),
            };
            TableColumn {
                name: name.into(),
                unit: unit.into(),
                text: text || !number,
            }
        });
        let columns = columns.collect();
        Ok(Self {
            dir,
            kind,
            known,
            columns,
        })
    }

    /// Command whose result this is.
    pub fn command(&self) -> &'static str {
        self.kind.command()
    }

    /// True if curves of both may share a panel.
    pub fn is_like(&self, other: &Self) -> bool {
        self.known.file == other.known.file
    }

    /// Columns of numbers.
    pub fn numbers(&self) -> impl Iterator<Item = &TableColumn> {
        self.columns.iter().filter(|column| !column.text)
    }

    /// Index of a quantity.
    ///
    /// # Errors
    /// There is none of this name; the message has the nearest one.
    pub fn find(&self, name: &str) -> Result<usize> {
        if let Some(k) = self.columns.iter().position(|column| column.is_named(name)) {
            return match self.columns[k].text {
                false => Ok(k),
                true => Err(Error::Usage(format!("--quantity {name}: this column of {} has text, not numbers", self.known.file))),
            };
        }
        let dir = self.dir.display();
        let near = nearest(name, self.numbers().map(|column| column.name.as_str()));
        let near = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
        Err(Error::Usage(format!(
            "--quantity {name}: {dir}, a result of `slcbeam {}`, has no such column{near}; `slcbeam plot {dir} --list` prints all names",
            self.kind.command()
        )))
    }

    /// Usual abscissa.
    fn abscissa(&self) -> Option<usize> {
        let named = || self.columns.iter().position(|column| column.name == self.known.over && !column.text);
        let varied = || self.columns.iter().position(|column| column.name.starts_with('/') && !column.text);
        named().or_else(varied).or_else(|| self.columns.iter().position(|column| !column.text))
    }

    /// Usual quantities.
    pub fn usual(&self) -> Vec<usize> {
        let shown = self.known.shown.iter().filter_map(|name| {
            let begins = |column: &TableColumn| column.name == *name || column.name.starts_with(&format!("{name} "));
            self.columns.iter().position(|column| begins(column) && !column.text)
        });
        let shown: Vec<usize> = shown.collect();
        if !shown.is_empty() {
            return shown;
        }
        let preferred = pictures::FIRST.iter().find_map(|name| self.columns.iter().position(|column| column.name == *name && !column.text));
        if let Some(k) = preferred {
            return vec![k];
        }
        let after = self.columns.iter().position(|column| ["status", "reason"].contains(&column.name.as_str()));
        let first = after.or_else(|| self.abscissa()).map_or(0, |k| k + 1);
        let next = (first..self.columns.len()).find(|k| !self.columns[*k].text);
        next.into_iter().collect()
    }

    /// Panels of quantities with the curves of this result, named `label`; `over` is the abscissa, `within` the range of it that is shown.
    ///
    /// # Errors
    /// A name is unknown, or the table cannot be read.
    pub fn panels(&self, quantities: &[usize], over: Option<&str>, label: &str, within: [Option<f64>; 2]) -> Result<Vec<QuantityPanel>> {
        let x = match over {
            Some(name) => self.find(name)?,
            None => self.abscissa().ok_or_else(|| Error::Usage(format!("{}: its table has no numbers", self.dir.display())))?,
        };
        let widest = |k: usize| {
            let of = |name: String| self.columns.iter().position(|column| column.name == name);
            let name = &self.columns[k].name;
            let error = name.strip_prefix("amplitude ").and_then(|rest| of(format!("error {rest}")));
            (error, of(format!("{name} low")).zip(of(format!("{name} high"))))
        };
        let mut wanted = vec![x];
        wanted.extend(quantities);
        for k in quantities {
            let (error, limits) = widest(*k);
            wanted.extend(error.into_iter().chain(limits.map(|l| l.0)).chain(limits.map(|l| l.1)));
        }
        wanted.sort_unstable();
        wanted.dedup();
        let (numbers, groups) = self.read(&wanted, within, x)?;
        let column = |k: usize| wanted.iter().position(|own| *own == k).map_or(&[][..], |at| numbers[at].as_slice());
        let band = error_band::read(self.dir).unwrap_or_default();
        let plain_x = for_readers(&self.columns[x].name, &self.columns[x].unit);
        let own = over.is_none();
        let names = distinct(&groups);
        let panels = quantities.iter().map(|&k| {
            let of = &self.columns[k];
            let (error, limits) = widest(k);
            let half_widths = match own && self.known.file == HISTORY {
                true => band.column_widths(&of.name).unwrap_or_default(),
                false => vec![],
            };
            let curves = names.iter().map(|group| {
                let rows: Vec<usize> = (0..column(x).len()).filter(|row| group.as_ref().is_none_or(|group| groups[*row] == *group)).collect();
                let all = |values: &[f64]| -> Vec<f64> { rows.iter().map(|row| values[*row]).collect() };
                let points: Vec<(f64, f64)> = all(column(x)).into_iter().zip(all(column(k))).collect();
                let spread = |low: Vec<f64>, high: Vec<f64>| -> Vec<(f64, f64, f64)> {
                    let ends = low.into_iter().zip(high);
                    points.iter().zip(ends).map(|(p, (low, high))| (p.0, low, high)).collect()
                };
                let around = match (error, limits) {
                    (Some(error), _) => {
                        let sides = [-1.0, 1.0].map(|side| points.iter().zip(all(column(error))).map(|(p, e)| p.1 + side * e).collect());
                        let [low, high] = sides;
                        spread(low, high)
                    }
                    (None, Some((low, high))) => spread(all(column(low)), all(column(high))),
                    _ => {
                        let width = |p: &(f64, f64)| width_at(&half_widths, p.0).map(|width| (p.0, p.1 - width, p.1 + width));
                        points.iter().filter_map(width).collect()
                    }
                };
                let group = group.as_ref().map(|group| group.replace('_', " "));
                let name = match group {
                    None => label.to_string(),
                    Some(group) if label.is_empty() => group,
                    Some(group) => format!("{label}: {group}"),
                };
                super::NamedCurve {
                    label: name,
                    points: if own && self.known.file == HISTORY { thinned(points) } else { points },
                    band: if own && self.known.file == HISTORY { thinned_band(around) } else { around },
                }
            });
            QuantityPanel {
                x: plain_x.clone(),
                y: for_readers(&of.name, &of.unit),
                curves: curves.collect(),
                marks: self.known.marks,
                logarithmic: match own {
                    true => self.axes(&of.name),
                    false => [false; 2],
                },
                equal: false,
            }
        });
        Ok(panels.collect())
    }

    /// Logarithmic axes of a quantity over the usual abscissa.
    fn axes(&self, quantity: &str) -> [bool; 2] {
        let [x, y] = self.known.logarithmic;
        [x, y || quantity.starts_with("amplitude ") || quantity.starts_with("mean power ")]
    }

    /// Rows of columns of numbers within a range of the abscissa, and the text that splits them.
    fn read(&self, wanted: &[usize], within: [Option<f64>; 2], x: usize) -> Result<(Vec<Vec<f64>>, Vec<String>)> {
        let mut numbers = vec![vec![]; wanted.len()];
        let mut groups = vec![];
        let [from, to] = within;
        let inside = |at: f64| from.is_none_or(|from| at >= from) && to.is_none_or(|to| at <= to);
        if self.known.file == HISTORY {
            each_row(HistorySource::Folder(self.dir), |_, origin, row| {
                if origin != RowOrigin::Covered && row.get(x).is_some_and(|at| inside(*at)) {
                    for (values, k) in numbers.iter_mut().zip(wanted) {
                        values.push(row.get(*k).copied().unwrap_or(f64::NAN));
                    }
                }
            })?;
            return Ok((numbers, groups));
        }
        let path = self.dir.join(self.known.file);
        let split = self.known.split.and_then(|name| self.columns.iter().position(|column| column.name == name));
        let file = open(&path).map_err(|e| fault("read", &path, e))?;
        for record in csv::ReaderBuilder::new().flexible(true).from_reader(file).records() {
            let record = record.map_err(|e| fault("read", &path, e.into()))?;
            let number = |k: usize| record.get(k).and_then(|cell| cell.trim().parse().ok()).unwrap_or(f64::NAN);
            if !inside(number(x)) && within != [None, None] {
                continue;
            }
            numbers.iter_mut().zip(wanted).for_each(|(values, k)| values.push(number(*k)));
            groups.extend(split.map(|k| record.get(k).unwrap_or_default().to_string()));
        }
        Ok((numbers, groups))
    }
}

/// Values that split rows, in the order of their first appearance; none if there are not two of them.
fn distinct(values: &[String]) -> Vec<Option<String>> {
    let mut all: Vec<Option<String>> = vec![];
    for value in values {
        if all.iter().all(|own| own.as_ref() != Some(value)) {
            all.push(Some(value.clone()));
        }
    }
    if all.len() < 2 { vec![None] } else { all }
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

fn thinned_band(band: Vec<(f64, f64, f64)>) -> Vec<(f64, f64, f64)> {
    let every = band.len().div_ceil(STRETCHES).max(1);
    band.into_iter().step_by(every).collect()
}

