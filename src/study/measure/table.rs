//! Laboratory table: two columns with units in their headers, `pressure [kPa], volume [ml]`. Blank lines and lines that
//! begin with # are ignored.

use std::ops::Range;
use std::path::Path;

use crate::case::heading::Heading;
use crate::case::{CaseSource, nearest, units};
use crate::error::{Code, Result, Violation};

/// Quantity of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredQuantity {
    /// Pressure above the atmosphere, or a difference [Pa].
    Pressure,
    /// Volume that flowed into the bladders [m^3].
    Volume,
    /// Normal force, tension positive [N].
    Force,
    /// Change of length [m].
    Extension,
    /// Bending moment [N m].
    Moment,
    /// Curvature [1/m].
    Curvature,
    /// Volume flow [m^3/s].
    Flow,
}

impl MeasuredQuantity {
    /// Name of its column.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pressure => "pressure",
            Self::Volume => "volume",
            Self::Force => "force",
            Self::Extension => "extension",
            Self::Moment => "moment",
            Self::Curvature => "curvature",
            Self::Flow => "flow",
        }
    }

    /// Its SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Pressure => "Pa",
            Self::Volume => "m^3",
            Self::Force => "N",
            Self::Extension => "m",
            Self::Moment => "N m",
            Self::Curvature => "1/m",
            Self::Flow => "m^3/s",
        }
    }
}

/// Points of a table, in SI units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points {
    /// Values that were set.
    pub x: Vec<f64>,
    /// Values that were measured.
    pub y: Vec<f64>,
}

/// Largest number of reported faults.
pub(in crate::study) const MOST: usize = 20;

/// Reads the columns of two quantities.
///
/// # Errors
/// [`crate::error::Error::Case`] with the position of every header and row that cannot be read.
pub fn read(path: &Path, text: &str, x: MeasuredQuantity, y: MeasuredQuantity) -> Result<Points> {
    let source = CaseSource::new(path, text);
    let mut lines = lines(text);
    let Some(header) = lines.next() else {
        let what = format!(
            "no header. The first line must name the columns: {} [{}], {} [{}]",
            x.name(),
            x.unit(),
            y.name(),
            y.unit()
        );
        return Err(source.error(vec![Violation::new(Code::Table, "", what)]));
    };
    let separator = header.separator();
    let names = cells(&header, separator);
    let columns = [x, y].map(|quantity| column(&names, &header, quantity));
    let [(x_at, x_scale), (y_at, y_scale)] = match columns {
        [Ok(x), Ok(y)] => [x, y],
        faulty => {
            let faults = faulty.into_iter().filter_map(std::result::Result::err);
            return Err(source.error(faults.map(|fault| *fault).collect()));
        }
    };
    let (mut points, mut faults) = (Points::default(), vec![]);
    for line in lines {
        match row(&line, separator, names.len(), [x_at, y_at]) {
            Ok([x, y]) => {
                points.x.push(x * x_scale);
                points.y.push(y * y_scale);
            }
            Err(fault) if faults.len() < MOST => faults.push(*fault),
            Err(_) => {}
        }
    }
    if faults.is_empty() {
        Ok(points)
    } else {
        Err(source.error(faults))
    }
}

/// Line with its number, counted from 1, and its start in the text.
pub(in crate::study) struct Line<'t> {
    pub text: &'t str,
    pub number: usize,
    pub start: usize,
}

impl Line<'_> {
    /// Separator of cells if this is the first line: a semicolon or a tab if there is one, else a comma.
    pub fn separator(&self) -> char {
        [';', '\t'].into_iter().find(|s| self.text.contains(*s)).unwrap_or(',')
    }
}

/// Lines that are neither blank nor comments.
pub(in crate::study) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let mut next = 0;
    let all = text.split_inclusive('\n').enumerate().map(move |(k, whole)| {
        let start = next;
        next += whole.len();
        Line {
            text: whole.trim_end_matches(['\n', '\r']),
            number: k + 1,
            start,
        }
    });
    all.filter(|line| {
        let text = line.text.trim_start_matches('\u{feff}').trim();
        !text.is_empty() && !text.starts_with('#')
    })
}

/// Cells without surrounding blanks and quotes, with their positions in the text.
pub(in crate::study) fn cells<'t>(line: &Line<'t>, separator: char) -> Vec<(&'t str, Range<usize>)> {
    let mut at = line.start;
    let cells = line.text.split(separator).map(|whole| {
        let start = at;
        at += whole.len() + separator.len_utf8();
        let cell = whole.trim_matches(|c: char| c.is_whitespace() || c == '\u{feff}');
        let inner = cell.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
        (inner.map_or(cell, str::trim), start..start + whole.len())
    });
    cells.collect()
}

type Read<T> = std::result::Result<T, Box<Violation>>;

/// Fault at its position.
pub(in crate::study) fn fault(span: Range<usize>, what: String) -> Violation {
    Violation {
        span: Some(span),
        ..Violation::new(Code::Table, "", what)
    }
}

/// Index and scale of the column of a quantity.
fn column(names: &[(&str, Range<usize>)], header: &Line, quantity: MeasuredQuantity) -> Read<(usize, f64)> {
    let (name, unit) = (quantity.name(), quantity.unit());
    let headings: Vec<Heading> = names.iter().map(|(cell, _)| Heading::parse(cell)).collect();
    let mut of_name = (0..headings.len()).filter(|k| headings[*k].name.to_lowercase() == name);
    let Some(at) = of_name.next() else {
        let there: Vec<String> = headings.iter().map(|heading| heading.name.to_lowercase()).collect();
        let span = header.start..header.start + header.text.len();
        let what = format!("no column is named {name}");
        let fault = fault(span, what).allowed(format!("{name} [{unit}]"));
        return Err(Box::new(Violation {
            nearest: nearest(name, there.iter().map(String::as_str)).map(|_| format!("{name} [{unit}]")),
            ..fault
        }));
    };
    if let Some(again) = of_name.next() {
        let what = format!("a second column named {name}");
        return Err(Box::new(
            fault(names[again].1.clone(), what).allowed("one column of this name"),
        ));
    }
    let heading = &headings[at];
    let scale = match (&heading.unit, &heading.unknown) {
        (None, None) => Err(format!("the column {name} has no unit")),
        _ => heading.scale(unit, name),
    };
    scale.map(|scale| (at, scale)).map_err(|what| {
        let all: Vec<&str> = units::of_dimension(unit).map(|unit| unit.name).collect();
        Box::new(fault(names[at].1.clone(), what).allowed(format!("{name} [{}]", all.join(" | "))))
    })
}

fn row(line: &Line, separator: char, columns: usize, wanted: [usize; 2]) -> Read<[f64; 2]> {
    let cells = cells(line, separator);
    if cells.len() != columns {
        let what = format!(
            "line {}: {}, but the header has {columns} columns",
            line.number,
            match cells.len() {
                1 => "one cell".to_owned(),
                count => format!("{count} cells"),
            }
        );
        return Err(Box::new(fault(line.start..line.start + line.text.len(), what)));
    }
    let number = |at: usize| {
        let (cell, span) = &cells[at];
        let number = cell.parse::<f64>().ok().filter(|x| x.is_finite());
        number.ok_or_else(|| {
            let what = format!(
                "line {}: \"{}\" is not a finite number",
                line.number,
                crate::error::visible(cell)
            );
            let hint = cell.contains(',').then(|| "use a decimal point".to_owned());
            Box::new(Violation {
                hint,
                ..fault(span.clone(), what)
            })
        })
    };
    Ok([number(wanted[0])?, number(wanted[1])?])
}
