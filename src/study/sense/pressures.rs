//! Measured pressures: a column per bladder, a row per instant or per measurement at rest.

use std::path::Path;

use crate::case::bladder_numbers;
use crate::case::schema::Case;
use crate::case::spans;
use crate::case::wiring::{bladder_index, bladder_label};
use crate::error::{Error, Result, listed, visible};
use crate::study::data::DataTable;

/// Table of measured pressures.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureTable {
    /// Instants [s], if the table has them.
    pub times: Option<Vec<f64>>,
    /// Indices of the measured bladders among all, ascending.
    pub bladders: Vec<usize>,
    /// Pressures [Pa] of each row, in the order of `bladders`; `None` for a missing value.
    pub rows: Vec<Vec<Option<f64>>>,
    /// Deviations of the noise [Pa], in the same order, if the table has them.
    pub deviations: Option<Vec<Vec<f64>>>,
    /// Line of each row in the file.
    pub lines: Vec<usize>,
    /// Headings of columns that contain no pressure.
    pub left_alone: Vec<String>,
}

/// Quantity of a column, with the label of its bladder.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Holds {
    Pressure(i64),
    Deviation(i64),
}

impl PressureTable {
    /// Reads a file.
    ///
    /// # Errors
    /// The file cannot be read; a bladder does not exist or has two columns; a unit is not one of pressure; there is no pressure.
    pub fn read(path: &Path, case: &Case) -> Result<Self> {
        Self::from_table(&DataTable::read(path)?, path, case)
    }

    /// Reads measurements from a table.
    ///
    /// # Errors
    /// As [`Measured::read`].
    pub fn from_table(table: &DataTable, path: &Path, case: &Case) -> Result<Self> {
        let per_row = case.bladders.as_ref().map_or(0, |bladders| bladders.per_row);
        let wrong = |what: String| Error::Usage(format!("{}: {what}", path.display()));
        let time = table
            .columns
            .iter()
            .position(|column| ["t", "time"].contains(&column.name.to_lowercase().as_str()));
        // columns and their bladders
        let mut pressures: Vec<(usize, usize)> = vec![];
        let mut deviations: Vec<(usize, usize)> = vec![];
        let mut left_alone = vec![];
        for (k, column) in table.columns.iter().enumerate().filter(|(k, _)| Some(*k) != time) {
            let heading = visible(&column.heading);
            let Some(holds) = holds(&column.name, case) else {
                if seems_a_bladder(&column.name) {
                    return Err(wrong(format!(
                        "column {heading}: unknown name for the pressure of a bladder. Use a name such as \
                         pressure_3_pa or pressure_-3_kpa"
                    )));
                }
                left_alone.push(column.heading.clone());
                continue;
            };
            let (label, list) = match holds {
                Holds::Pressure(label) => (label, &mut pressures),
                Holds::Deviation(label) => (label, &mut deviations),
            };
            let there = |bladder: &usize| spans::has_bladder(case, *bladder);
            let bladder = bladder_index(label, per_row)
                .filter(there)
                .ok_or_else(|| wrong(format!("column {heading}: {}", bladder_numbers::missing(case, label))))?;
            if list.iter().any(|(_, other)| *other == bladder) {
                return Err(wrong(format!("column {heading}: a second column of bladder {label}")));
            }
            list.push((k, bladder));
        }
        if pressures.is_empty() {
            let headings = table.columns.iter().map(|column| column.heading.as_str());
            return Err(wrong(format!(
                "no column contains the pressure of a bladder, such as pressure_3_pa or pressure_-3_kpa. The columns \
                 are {}",
                listed(headings)
            )));
        }
        pressures.sort_by_key(|(_, bladder)| *bladder);
        let numbers = |column: usize| table.numbers(column, table.scale(column, "Pa", "a pressure")?);
        let columns = pressures
            .iter()
            .map(|(column, _)| numbers(*column))
            .collect::<Result<Vec<_>>>()?;
        for ((column, _), values) in pressures.iter().zip(&columns) {
            if values.iter().all(Option::is_none) {
                let heading = visible(&table.columns[*column].heading);
                return Err(wrong(format!("column {heading} contains no number")));
            }
        }
        let mut of_noise = vec![];
        for (_, bladder) in pressures.iter().filter(|_| !deviations.is_empty()) {
            let label = bladder_label(*bladder, per_row);
            let own = deviations.iter().find(|(_, other)| other == bladder);
            let (column, _) = own.ok_or_else(|| {
                wrong(format!(
                    "bladder {label} has no column with its standard deviation, but others have one"
                ))
            })?;
            let all = table.all_numbers(*column, table.scale(*column, "Pa", "a deviation of pressure")?)?;
            let none = all.iter().position(|deviation| *deviation <= 0.0);
            if let Some(row) = none {
                return Err(table
                    .sound(vec![table.fault(row, *column, "a standard deviation must be above 0")])
                    .err()
                    .unwrap_or_else(|| wrong("a standard deviation must be above 0".into())));
            }
            of_noise.push(all);
        }
        let kept: Vec<usize> = (0..table.len())
            .filter(|row| columns.iter().any(|c| c[*row].is_some()))
            .collect();
        let times = time.map(|column| table.instants(column)).transpose()?;
        Ok(Self {
            times: times.map(|all| kept.iter().map(|row| all[*row]).collect()),
            bladders: pressures.iter().map(|(_, bladder)| *bladder).collect(),
            rows: kept
                .iter()
                .map(|row| columns.iter().map(|c| c[*row]).collect())
                .collect(),
            deviations: (!of_noise.is_empty()).then(|| {
                kept.iter()
                    .map(|row| of_noise.iter().map(|c| c[*row]).collect())
                    .collect()
            }),
            lines: kept.iter().map(|row| table.line(*row)).collect(),
            left_alone,
        })
    }
}

/// Parses a column name: `pressure_3`, `pressure@bladder -3`, `p3`, `bladder 3`, each with `sd` for a deviation; `NAME_pressure_upper` of a
/// probe.
fn holds(name: &str, case: &Case) -> Option<Holds> {
    if let Some(label) = of_probe(name, case) {
        return Some(Holds::Pressure(label));
    }
    let name = name.to_lowercase().replace('−', "-");
    let (mut number, mut named, mut sign, mut deviation) = (None, false, 1, false);
    for word in name.split(['_', '@', ' ', '\'', '"']).filter(|word| !word.is_empty()) {
        match word {
            "pressure" | "p" | "bladder" => named = true,
            "upper" => {}
            "lower" => sign = -1,
            "sd" => deviation = true,
            _ => {
                let digits = word.strip_prefix('p').filter(|_| !named);
                named |= digits.is_some();
                let label: i64 = digits.unwrap_or(word).parse().ok()?;
                if number.replace(label).is_some() {
                    return None;
                }
            }
        }
    }
    let label = number.filter(|_| named)? * sign;
    Some(match deviation {
        true => Holds::Deviation(label),
        false => Holds::Pressure(label),
    })
}

/// True if a name begins with `pressure` or `bladder` and a number follows.
fn seems_a_bladder(name: &str) -> bool {
    let name = name.to_lowercase();
    let words = ["pressure", "bladder"].iter().find_map(|word| name.strip_prefix(word));
    words.is_some_and(|rest| {
        rest.trim_start_matches(['_', '@', ' ', '-', '−'])
            .starts_with(|c: char| c.is_ascii_digit())
    })
}

/// Label of the bladder whose pressure a probe records in a column.
fn of_probe(name: &str, case: &Case) -> Option<i64> {
    let per_row = case.bladders.as_ref()?.per_row;
    let ends = [("_pressure_upper", 1), ("_pressure_lower", -1)];
    let (begin, row) = ends
        .into_iter()
        .find_map(|(end, row)| Some((name.strip_suffix(end)?, row)))?;
    let probe = case.probes.iter().find(|probe| probe.name == begin)?;
    let ends = spans::segment_ends(case);
    let beyond = ends.iter().filter(|end| **end <= probe.at * case.beam.length_m).count();
    let segment = beyond.clamp(1, per_row) - 1;
    Some(row * (segment as i64 + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<PressureTable> {
        let sets = ["/probes=[{\"name\": \"mid-2\", \"at\": 0.45}]".to_owned()];
        let case = crate::case::load("cases/tour-sensor.json".as_ref(), &sets)?;
        PressureTable::from_table(&DataTable::parse("p.csv".as_ref(), text)?, "p.csv".as_ref(), &case)
    }

    #[test]
    fn bladders_are_named_in_many_ways() {
        for (heading, bladder, pressure) in [
            ("pressure_3_pa", 2, 2.0),
            ("pressure_-3_kpa", 12, 2e3),
            ("pressure@bladder -3 [mbar]", 12, 200.0),
            ("p3", 2, 2.0),
            ("p_3_kPa", 2, 2e3),
            ("Bladder 10 (kPa)", 9, 2e3),
            ("pressure_lower_4_pa", 13, 2.0),
            ("mid-2_pressure_upper_pa", 4, 2.0),
        ] {
            let found = read(&format!("x,{heading}\n1,2\n")).expect(heading);
            assert_eq!(found.bladders, [bladder], "{heading}");
            assert!(
                (found.rows[0][0].expect("a number") / pressure - 1.0).abs() < 1e-12,
                "{heading}"
            );
            assert_eq!(found.left_alone, ["x"]);
        }
        let found =
            read("t_s;pressure_2_pa;pressure_1_pa;pressure_1_sd_pa;pressure_2_sd_pa\n0;1;2;3;4\n1;;;3;4\n2;;5;3;4\n")
                .expect("a table");
        assert_eq!(found.times, Some(vec![0.0, 2.0]));
        assert_eq!(found.rows, [[Some(2.0), Some(1.0)], [Some(5.0), None]]);
        assert_eq!(found.deviations, Some(vec![vec![3.0, 4.0]; 2]));
        assert_eq!(
            (found.lines.as_slice(), found.rows.iter().flatten().flatten().count()),
            (&[2, 4][..], 3)
        );
    }

    #[test]
    fn what_is_wrong_is_named() {
        let cases = [
            ("pressure_11_pa\n1\n", "there is no bladder 11"),
            ("pressure_0_pa\n1\n", "there is no bladder 0"),
            ("pressure_1_pa,p1_kpa\n1,2\n", "a second column of bladder 1"),
            ("pressure_1_mm\n1\n", "is in mm"),
            (
                "tip_u1_m,max_pressure_pa\n1,2\n",
                "no column contains the pressure of a bladder",
            ),
            ("pressure_1_pa\n\"\"\n", "contains no number"),
            (
                "pressure_1_pa,pressure_2_pa,p1_sd_pa\n1,2,3\n",
                "bladder 2 has no column with its standard deviation",
            ),
        ];
        for (text, said) in cases {
            let error = read(text).expect_err(text).to_string();
            assert!(error.contains(said), "{error}");
        }
        assert_eq!(
            read("pressure_1_pa,p1_sd_pa\n1,0\n").expect_err("a fault").exit_code(),
            3
        );
    }
}
