//! Table of measurements: one line of headings, then one line per row; commas, semicolons or tabs separate cells. Blank
//! lines and lines that begin with # are ignored. An empty cell was not measured.

use std::collections::HashSet;
use std::ops::Range;
use std::path::Path;

use crate::case::heading::Heading;
use crate::case::{self, CaseSource, nearest};
use crate::error::numbers::counted;
use crate::error::{Code, Error, Result, Violation, listed, shown};
use crate::study::measure::table::{MOST, cells, fault, lines};

/// Largest number accepted as measured, in the unit of its column and in SI units; its square stays finite in any sum.
const LARGEST: f64 = 1e30;

/// Cell and its position in the text.
type Cell = (String, Range<usize>);

/// Row of cells with its line number, counted from 1.
#[derive(Clone, Debug)]
struct Row {
    line: usize,
    cells: Vec<Cell>,
}

/// Table of measurements, as read.
#[derive(Clone, Debug)]
pub struct DataTable {
    source: CaseSource,
    /// Check sum of the text.
    pub crc32: u32,
    /// Headings of the columns.
    pub columns: Vec<Heading>,
    rows: Vec<Row>,
}

impl DataTable {
    /// Reads a file.
    ///
    /// # Errors
    /// The file cannot be read; otherwise as [`Table::parse`].
    pub fn read(path: &Path) -> Result<Self> {
        Self::parse(path, &case::text(path)?)
    }

    /// Reads a text.
    ///
    /// # Errors
    /// [`Error::Case`] with the position of every fault: no headings, duplicate headings, no rows, rows of another
    /// length.
    pub fn parse(path: &Path, text: &str) -> Result<Self> {
        let source = CaseSource::new(path, text);
        let mut lines = lines(text);
        let Some(header) = lines.next() else {
            let what = "no headings. The first line must name the columns, such as t_s, angle_deg";
            return Err(source.error(vec![Violation::new(Code::Table, "", what)]));
        };
        let separator = header.separator();
        let headings = cells(&header, separator);
        let mut faults = vec![];
        let mut named = HashSet::new();
        for (k, (heading, span)) in headings.iter().enumerate() {
            if faults.len() >= MOST {
                break;
            }
            if heading.is_empty() {
                faults.push(fault(span.clone(), format!("column {} has no heading", k + 1)));
            } else if !named.insert(heading) {
                let what = format!("a second column named {}", shown(heading));
                faults.push(fault(span.clone(), what));
            }
        }
        if Heading::are_numbers(headings.iter().map(|(heading, _)| *heading)) {
            let span = header.start..header.start + header.text.len();
            let what = "numbers instead of headings. The first line must name the columns, such as t_s, angle_deg";
            faults.push(fault(span, what.into()));
        }
        let columns = headings.iter().map(|(heading, _)| Heading::parse(heading)).collect();
        let mut rows = vec![];
        for line in lines {
            let all = cells(&line, separator);
            if all.len() != headings.len() {
                let span = line.start..line.start + line.text.len();
                let what = format!(
                    "line {}: {}, but the table has {}",
                    line.number,
                    counted(all.len() as u64, "cell"),
                    counted(headings.len() as u64, "heading")
                );
                faults.push(fault(span, what));
            }
            let cells = all.into_iter().map(|(cell, span)| (cell.to_owned(), span)).collect();
            let line = line.number;
            rows.push(Row { line, cells });
        }
        if faults.is_empty() && rows.is_empty() {
            faults.push(Violation::new(
                Code::Table,
                "",
                "no rows below the headings: the table contains no measurements",
            ));
        }
        if !faults.is_empty() {
            faults.truncate(MOST);
            return Err(source.error(faults));
        }
        let crc32 = crc32fast::hash(text.as_bytes());
        Ok(Self {
            source,
            crc32,
            columns,
            rows,
        })
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// True if there are no rows, which never applies to a table that was read.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Line number of a row in the file, from 1.
    pub fn line(&self, row: usize) -> usize {
        self.rows[row].line
    }

    /// Index of the column of a name: a whole heading, or one without its unit.
    pub fn find(&self, name: &str) -> Option<usize> {
        let whole = self.columns.iter().position(|column| column.heading == name);
        whole.or_else(|| {
            let mut alike = (0..self.columns.len()).filter(|k| self.columns[*k].name == name);
            alike.next().filter(|_| alike.next().is_none())
        })
    }

    /// Index of the column with the standard deviations of another: the heading or name of that column with the suffix
    /// `_sd`.
    pub fn deviation(&self, column: usize) -> Option<usize> {
        let own = &self.columns[column];
        let mut names = [&own.heading, &own.name].into_iter();
        names.find_map(|name| self.find(&format!("{name}_sd")))
    }

    /// Index of a column requested by an option.
    ///
    /// # Errors
    /// [`Error::Usage`] with the nearest heading.
    pub fn wanted(&self, name: &str, option: &str) -> Result<usize> {
        self.find(name).ok_or_else(|| {
            let headings = || self.columns.iter().map(|column| column.heading.as_str());
            let meant = match nearest(name, headings()) {
                Some(meant) => format!("; nearest is {}", shown(&meant)),
                None => format!("; there are {}", listed(headings())),
            };
            let path = self.source.path.display();
            Error::Usage(format!("{option}: {path} has no column {}{meant}", shown(name)))
        })
    }

    /// Index of the column of time: the requested one, or the one named `t` or `time`.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none.
    pub fn time(&self, asked: Option<&str>) -> Result<usize> {
        if let Some(name) = asked {
            return self.wanted(name, "--time");
        }
        let called = |column: &Heading| ["t", "time"].contains(&column.name.to_lowercase().as_str());
        self.columns.iter().position(called).ok_or_else(|| {
            let headings = self.columns.iter().map(|column| column.heading.as_str());
            Error::Usage(format!(
                "{} has no column t_s or time_s. Name the column of time with --time, one of {}",
                self.source.path.display(),
                listed(headings)
            ))
        })
    }

    /// Index of the column of frequency, which is named `frequency` or `f`.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none.
    pub fn frequency(&self) -> Result<usize> {
        let called = |column: &Heading| ["f", "frequency"].contains(&column.name.to_lowercase().as_str());
        self.columns.iter().position(called).ok_or_else(|| {
            let headings = self.columns.iter().map(|column| column.heading.as_str());
            Error::Usage(format!(
                "{} has no column frequency_hz or f_hz, but only {}",
                self.source.path.display(),
                listed(headings)
            ))
        })
    }

    /// Frequencies [Hz] of its column, all above 0.
    ///
    /// # Errors
    /// As [`Table::all_numbers`], with the positions of others; a unit that is not one of frequency.
    pub fn frequencies(&self) -> Result<Vec<f64>> {
        let column = self.frequency()?;
        let all = self.all_numbers(column, self.scale(column, "Hz", "frequency")?)?;
        let faults = (0..all.len()).filter(|row| all[*row] <= 0.0).take(MOST);
        let faults = faults.map(|row| self.fault(row, column, "expected a frequency above 0"));
        self.sound(faults.collect()).map(|()| all)
    }

    /// Numbers of a column times a scale; `None` for empty cells.
    ///
    /// # Errors
    /// [`Error::Case`] with the position of every cell that is not a finite number or is too large.
    pub fn numbers(&self, column: usize, scale: f64) -> Result<Vec<Option<f64>>> {
        let mut faults = vec![];
        let numbers = self.rows.iter().map(|row| {
            let (cell, span) = &row.cells[column];
            if cell.is_empty() {
                return None;
            }
            let number = cell.parse::<f64>().ok().filter(|x| x.is_finite());
            if let Some(number) = number.filter(|x| (x * scale).abs() > LARGEST || x.abs() > LARGEST)
                && faults.len() < MOST
            {
                let heading = shown(&self.columns[column].heading);
                let what = format!(
                    "line {}, column {heading}: {number:e} is too large for a measured value (limit {LARGEST:e})",
                    row.line
                );
                faults.push(fault(span.clone(), what).hint("correct it, or leave the cell empty"));
            }
            if number.is_none() && faults.len() < MOST {
                let (cell, heading) = (shown(cell), shown(&self.columns[column].heading));
                let what = format!("line {}, column {heading}: \"{cell}\" is not a finite number", row.line);
                let hint = match cell.contains(',') {
                    true => "use a decimal point",
                    false => "leave the cell empty if nothing was measured",
                };
                faults.push(fault(span.clone(), what).hint(hint));
            }
            number.map(|x| x * scale)
        });
        let numbers = numbers.collect();
        self.sound(faults).map(|()| numbers)
    }

    /// Numbers of a column that has no empty cells, times a scale.
    ///
    /// # Errors
    /// As [`Table::numbers`], and for empty cells.
    pub fn all_numbers(&self, column: usize, scale: f64) -> Result<Vec<f64>> {
        let numbers = self.numbers(column, scale)?;
        let empty = (0..self.len()).filter(|row| numbers[*row].is_none()).take(MOST);
        let faults = empty.map(|row| self.fault(row, column, "an empty cell. Every row needs a value in this column"));
        let faults = faults.collect();
        self.sound(faults).map(|()| numbers.into_iter().flatten().collect())
    }

    /// Instants [s] of a column of time: ascending, none below 0.
    ///
    /// # Errors
    /// As [`Table::all_numbers`], with the positions of times out of order; a unit that is not one of time.
    pub fn instants(&self, column: usize) -> Result<Vec<f64>> {
        let scale = self.scale(column, "s", "time")?;
        let times = self.all_numbers(column, scale)?;
        let mut faults = vec![];
        for (row, t) in times.iter().enumerate() {
            let what = match row.checked_sub(1).map(|before| times[before]) {
                _ if *t < 0.0 => "a time before the start of the run (0 s)".to_owned(),
                Some(before) if *t <= before => format!("{} s is not later than {} s of the previous row", t, before),
                _ => continue,
            };
            if faults.len() < MOST {
                faults.push(self.fault(row, column, &what));
            }
        }
        self.sound(faults).map(|()| times)
    }

    /// Factor from the unit of a column to the SI unit of a dimension; numbers without a unit count as SI.
    ///
    /// # Errors
    /// [`Error::Usage`] if the heading has a unit of another dimension, or an unknown unit.
    pub fn scale(&self, column: usize, si: &str, what: &str) -> Result<f64> {
        self.columns[column].scale(si, what).map_err(Error::Usage)
    }

    /// Describes a fault at a cell.
    pub fn fault(&self, row: usize, column: usize, what: &str) -> Violation {
        let Row { line, cells } = &self.rows[row];
        let heading = shown(&self.columns[column].heading);
        fault(
            cells[column].1.clone(),
            format!("line {line}, column {heading}: {what}"),
        )
    }

    /// Returns an error that contains the faults, if there are any.
    ///
    /// # Errors
    /// [`Error::Case`] if there are any.
    pub fn sound(&self, faults: Vec<Violation>) -> Result<()> {
        match faults.is_empty() {
            true => Ok(()),
            false => Err(self.source.error(faults)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::DataTable;

    fn read(text: &str) -> crate::error::Result<DataTable> {
        DataTable::parse("data.csv".as_ref(), text)
    }

    fn faults(text: &str, then: impl Fn(&DataTable) -> crate::error::Result<()>) -> String {
        match read(text).and_then(|table| then(&table)) {
            Err(crate::error::Error::Case(fault)) => fault.violations.iter().map(|v| v.what.clone() + ";").collect(),
            Err(error) => error.to_string(),
            Ok(()) => "none".into(),
        }
    }

    #[test]
    fn tables_are_read_however_a_laboratory_writes_them() {
        for text in [
            "\u{feff}# of a pump\nt_s,angle_deg\n0,1\n0.5,\n",
            "t_s;angle_deg\r\n0;1\r\n0.5;\r\n",
            "\"t_s\"\t\"angle_deg\"\n\n0\t1\n# a pause\n0.5\t\n",
        ] {
            let table = read(text).expect(text);
            assert_eq!(
                table.instants(table.time(None).expect("time")).expect("times"),
                [0.0, 0.5]
            );
            let angle = table.find("angle").expect("without its unit");
            assert_eq!(table.numbers(angle, 2.0).expect("numbers"), [Some(2.0), None]);
            let scale = table.scale(angle, "rad", "an angle").expect("a unit");
            assert!((scale - std::f64::consts::PI / 180.0).abs() < 1e-16);
        }
    }

    #[test]
    fn faults_name_line_and_column() {
        let none = |_: &DataTable| Ok(());
        let times = |table: &DataTable| table.instants(0).map(|_| ());
        for (text, what) in [
            ("", "no headings"),
            ("t_s,a\n", "no rows"),
            ("t_s,t_s\n1,2\n", "a second column named t_s"),
            ("0,1\n1,2\n", "numbers instead of headings"),
            ("t_s,a\n1,2,3\n", "line 2: 3 cells, but the table has 2 headings"),
            ("t_s,\n1,2\n", "column 2 has no heading"),
        ] {
            let said = faults(text, none);
            assert!(said.contains(what), "{said}");
        }
        for (text, what) in [
            ("t_s,a\n1,2\n1,3\n", "line 3, column t_s: 1 s is not later than 1 s"),
            ("t_s,a\n-1,2\n", "line 2, column t_s: a time before the start"),
            ("t_s,a\n1,2\n,3\n", "line 3, column t_s: an empty cell"),
            ("t_s,a\nsoon,2\n", "line 2, column t_s: \"soon\" is not a finite number"),
            (
                "t [furlong],a\n1,2\n",
                "unit [furlong] of the column t [furlong] is not known",
            ),
            ("t_mm,a\n1,2\n", "the column t_mm is in mm, but time is in s, ms"),
        ] {
            let said = faults(text, times);
            assert!(said.contains(what), "{said}");
        }
        let said = faults("t_s,angle_deg\n1,2\n", |table| {
            table.wanted("angel", "--match").map(|_| ())
        });
        assert!(said.contains("nearest is angle_deg"), "{said}");
    }
}
