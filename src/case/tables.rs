//! Tables from CSV files, which are read together with the case.

use std::path::Path;

use serde_json::{Map, Value};

use super::faults::Violations;
use super::heading::Heading;
use super::load::nearest_file;
use super::locate::child;
use super::wording::{nearest, short};
use super::written::checksum;
use super::{reading, units};
use crate::error::numbers::counted;
use crate::error::{Code, Violation, listed, shown};

/// Largest file of a table [bytes].
const LARGEST: u64 = 64 << 20;

/// Largest file of a table that the program wrote [bytes]: the same numbers may be longer there.
const LARGEST_WRITTEN: u64 = 4 * LARGEST;

/// Replaces `csv` and its columns by `times_s` and `values` in every table below `value`.
pub fn resolve(value: &mut Value, base: &Path, pointer: &str, faults: &mut Violations) {
    match value {
        Value::Array(items) => {
            for (i, item) in items.iter_mut().enumerate() {
                resolve(item, base, &child(pointer, i), faults);
            }
        }
        Value::Object(members) => {
            for (key, inner) in members.iter_mut() {
                let pointer = child(pointer, key);
                match inner {
                    Value::Object(table) if key == "table" && has_csv_keys(table) => {
                        if let Err(fault) = read(table, base, &pointer) {
                            faults.push(*fault);
                        }
                    }
                    _ => resolve(inner, base, &pointer, faults),
                }
            }
        }
        _ => {}
    }
}

fn has_csv_keys(table: &Map<String, Value>) -> bool {
    ["csv", "time_column", "value_column", "checksum"]
        .iter()
        .any(|key| table.contains_key(*key))
}

/// Boxed, because a fault is large compared with an empty success.
type Read<T> = Result<T, Box<Violation>>;

fn read(table: &mut Map<String, Value>, base: &Path, pointer: &str) -> Read<()> {
    let at = |key: &str, what: String| Box::new(Violation::new(Code::Table, child(pointer, key), what));
    let text = |key: &str| table.get(key).and_then(Value::as_str).map(str::to_owned);
    let Some(name) = text("csv") else {
        return Err(Box::new(
            Violation::new(Code::Table, pointer, "a column or checksum is given but no file").hint("add \"csv\""),
        ));
    };
    if table.contains_key("times_s") || table.contains_key("values") {
        let fault = Violation::new(
            Code::Table,
            child(pointer, "csv"),
            "points are given both here and in a file",
        );
        return Err(Box::new(fault.hint("keep \"times_s\" and \"values\", or \"csv\"")));
    }
    let wanted = text("checksum");
    let largest = if wanted.is_some() { LARGEST_WRITTEN } else { LARGEST };
    let path = base.join(&name);
    let text_of = reading::bytes(&path, largest).map_err(|e| {
        let fault = at("csv", format!("cannot read {}: {e}", path.display()));
        let ending = path
            .extension()
            .map_or(String::new(), |x| format!(".{}", x.to_string_lossy()));
        let meant = nearest_file(&path, &ending)
            .map(|meant| Path::new(&name).with_file_name(meant.file_name().unwrap_or_default()));
        Box::new(Violation {
            nearest: meant.map(|meant| meant.display().to_string()),
            ..*fault
        })
    })?;
    let Some(text_of) = text_of else {
        let what = format!("{} is larger than {} MB", path.display(), largest >> 20);
        return Err(at("csv", what));
    };
    if let Some(line) = unclosed_quote(&text_of) {
        let what = format!("{name}, line {line}: a quotation mark is not closed");
        return Err(at("csv", what));
    }
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .delimiter(separator(&text_of))
        .from_reader(text_of.as_slice());
    let headings = reader
        .headers()
        .map_err(|e| at("csv", format!("cannot read {name}: {e}")))?
        .clone();
    if Heading::are_numbers(headings.iter()) {
        let line = headings.iter().collect::<Vec<_>>().join(",");
        let what = format!("{name}: numbers in place of headings: {}", short(&line));
        let hint = "name the columns in the first line, such as t_s,pressure_kpa; otherwise the first point is lost";
        return Err(Box::new(at("csv", what).hint(hint)));
    }
    let column = |key: &str, default: usize| -> Read<usize> {
        let Some(wanted) = text(key) else {
            return match headings.len() > default {
                true => Ok(default),
                false => Err(at(
                    "csv",
                    format!("{name} has {}, not two", counted(headings.len() as u64, "column")),
                )),
            };
        };
        headings.iter().position(|heading| heading == wanted).ok_or_else(|| {
            let fault = Violation::new(
                Code::Table,
                child(pointer, key),
                format!("{name} has no column \"{wanted}\""),
            );
            let fault = fault.allowed(listed(&headings));
            Box::new(Violation {
                nearest: nearest(&wanted, headings.iter()),
                ..fault
            })
        })
    };
    let columns = [column("time_column", 0)?, column("value_column", 1)?];
    let scale = |column: usize, key: &str, dimensions: &[&str], what: &str| -> Read<f64> {
        let key = if table.contains_key(key) { key } else { "csv" };
        let heading = Heading::parse(headings.get(column).unwrap_or_default());
        let read = dimensions.iter().map(|si| heading.scale(si, what));
        let (known, faults): (Vec<_>, Vec<_>) = read.partition(Result::is_ok);
        let first = known.into_iter().chain(faults).next().unwrap_or(Ok(1.0));
        first.map_err(|fault| at(key, format!("{name}: {fault}")))
    };
    let value = Of::pointer(pointer);
    let scales = [
        scale(columns[0], "time_column", &["s"], "time")?,
        scale(columns[1], "value_column", &value.dimensions, &value.key)?,
    ];
    let (mut times, mut values): (Vec<f64>, Vec<f64>) = (vec![], vec![]);
    for record in reader.records() {
        let record = record.map_err(|e| at("csv", format!("cannot read {name}: {e}")))?;
        let line = record.position().map_or(0, csv::Position::line);
        for ((column, scale), out) in columns.iter().zip(scales).zip([&mut times, &mut values]) {
            let cell = record.get(*column).unwrap_or("");
            let number = cell.parse::<f64>().ok().filter(|n| n.is_finite());
            let number = number.ok_or_else(|| {
                let fault = at(
                    "csv",
                    format!("{name}, line {line}: \"{}\" is not a number", shown(cell)),
                );
                match cell.contains(',') {
                    true => Box::new(fault.hint("write decimals with a point")),
                    false => fault,
                }
            })?;
            out.push(number * scale);
        }
    }
    if let Some(wanted) = wanted {
        let found = checksum(&times, &values);
        if found != wanted {
            let what = format!("{name} contains other points: their checksum is {found}, not {wanted}");
            let fault = Violation::new(Code::Table, child(pointer, "checksum"), what);
            return Err(Box::new(
                fault.hint("if the points are correct, leave \"checksum\" out"),
            ));
        }
    }
    for key in ["csv", "time_column", "value_column", "checksum"] {
        table.shift_remove(key);
    }
    table.insert("times_s".to_owned(), times.into());
    table.insert("values".to_owned(), values.into());
    Ok(())
}

/// Quantity of a table: its key, and the possible dimensions of its values, as SI units; none if the key has no unit.
struct Of {
    key: String,
    dimensions: Vec<&'static str>,
}

impl Of {
    fn pointer(pointer: &str) -> Self {
        let is_form =
            |key: &str| ["table", "sum", "product", "signal", "profile"].contains(&key) || key.parse::<usize>().is_ok();
        let keys = || pointer.rsplit('/').filter(|key| !key.is_empty());
        let key = keys().find(|key| !is_form(key)).unwrap_or_default().to_owned();
        let own = match key.as_str() {
            "opening" => Some("1"),
            _ => units::of_pointer(pointer).map(|unit| unit.si),
        };
        // factors, such as the profile of a load, are fractions of another quantity
        let factor = keys().any(|key| ["product", "signal"].contains(&key));
        let share = own.and(factor.then_some("1")).filter(|share| own != Some(share));
        Self {
            key,
            dimensions: own.into_iter().chain(share).collect(),
        }
    }
}

/// Last line with a quotation mark, if a text has an odd number of them outside comments. A CSV reader accepts such a text and reads the
/// rest as one cell.
pub fn unclosed_quote(text: &[u8]) -> Option<usize> {
    let lines = text.split(|b| *b == b'\n').enumerate();
    let written = lines.filter(|(_, line)| !line.trim_ascii_start().starts_with(b"#"));
    let counts = written.map(|(k, line)| (k + 1, line.iter().filter(|b| **b == b'"').count()));
    let quoted: Vec<(usize, usize)> = counts.filter(|(_, count)| *count > 0).collect();
    let all: usize = quoted.iter().map(|(_, count)| count).sum();
    quoted.last().filter(|_| all % 2 == 1).map(|(line, _)| *line)
}

/// Separator of cells: a semicolon or tab if the first relevant line has one, otherwise a comma.
fn separator(text: &[u8]) -> u8 {
    let line = text.split(|b| *b == b'\n').find(|line| {
        let line = line.trim_ascii_start();
        !line.is_empty() && !line.starts_with(b"#")
    });
    let of = |line: &[u8]| [b';', b'\t'].into_iter().find(|b| line.contains(b));
    line.and_then(of).unwrap_or(b',')
}
