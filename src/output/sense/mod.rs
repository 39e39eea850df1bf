//! What `slcbeam sense` leaves behind: `sense.csv`, `sensors.csv`, `sense.json`, `sense.svg`, and its words.

mod words;

use std::path::PathBuf;

use super::folder::ResultFolder;
use super::numbers::shortest;
use super::plot::sensed::{self, Drawn, Part, Series};
use super::records::{self, number};
use crate::error::Result;
use crate::results;
use crate::results::sense::{BandKind, Banded, Sensed};

pub use words::{about_band, about_noise, about_sight, answer, list, table, words};

/// One row a row of the measurements.
pub const CSV: &str = "sense.csv";
/// The best sets of bladders to measure.
pub const SENSORS: &str = "sensors.csv";
/// Everything.
pub const JSON: &str = "sense.json";
/// Loads with their bands, pressures, sensors.
pub const PICTURE: &str = "sense.svg";

/// Amplitudes of which each has a picture of its own, at most.
const MOST: usize = 6;

/// Writes the files into a folder.
///
/// # Errors
/// They cannot be written.
pub fn write(folder: &mut ResultFolder, found: &Sensed) -> Result<Vec<PathBuf>> {
    let mut files = vec![(JSON, results::text(found))];
    if !found.rows.is_empty() {
        files.push((CSV, csv(found)));
    }
    if !found.choice.is_empty() {
        files.push((SENSORS, sensors(found)));
    }
    files.extend(sensed::draw(&drawn(found)).map(|text| (PICTURE, text)));
    folder.fill(files)
}

/// The text of `sense.csv`; a cell is empty where something is not told or was not measured.
pub fn csv(found: &Sensed) -> String {
    let timed = found.rows.iter().any(|row| row.t_s.is_some());
    let mut headings = vec!["line".to_owned()];
    headings.extend(timed.then(|| "t [s]".to_owned()));
    let amplitudes = found.amplitudes.iter().map(|a| (&a.name, &a.unit));
    for (name, unit) in amplitudes.chain(found.seen.together.iter().map(|one| (&one.name, &one.unit))) {
        headings.extend(["", " standard error", " low", " high"].map(|what| format!("{name}{what} [{unit}]")));
    }
    for label in &found.bladders {
        headings.extend(["measured", "modelled"].map(|what| format!("pressure_{label} {what} [Pa]")));
    }
    let rows = found.rows.iter().map(|row| {
        let mut cells = vec![row.line.to_string()];
        cells.extend(timed.then(|| number(row.t_s)));
        for one in row.amplitudes.iter().chain(&row.together) {
            let of = |get: fn(&Banded) -> f64| number(one.as_ref().map(get));
            cells.extend([of(|b| b.value), of(|b| b.sd), of(|b| b.low), of(|b| b.high)]);
        }
        for (measured, modelled) in row.measured_pa.iter().zip(&row.modelled_pa) {
            cells.extend([number(*measured), shortest(*modelled)]);
        }
        cells
    });
    records::text(headings, rows)
}

/// The text of `sensors.csv`: one row a number of sensors.
fn sensors(found: &Sensed) -> String {
    let errors = found
        .amplitudes
        .iter()
        .map(|a| format!("{} standard error [{}]", a.name, a.unit));
    let headings = ["count".to_owned(), "bladders".to_owned()].into_iter().chain(errors);
    let rows = found.choice.iter().map(|one| {
        let mut row = vec![one.bladders.len().to_string(), list(&one.bladders)];
        row.extend(one.errors.iter().map(|error| number(*error)));
        row
    });
    records::text(headings, rows)
}

/// What the picture shows.
fn drawn(found: &Sensed) -> Drawn {
    let named = |name: &str, unit: &str| (name.to_owned(), unit.to_owned());
    let half = |one: &Banded| 0.5 * (one.high - one.low);
    let mut parts = vec![];
    match found.rows.as_slice() {
        [] => {}
        [row] => {
            let of_profile = found.amplitudes.iter().zip(&row.amplitudes);
            let line: Vec<_> = of_profile
                .filter(|(a, _)| a.unit == "N/m")
                .filter_map(|(a, one)| Some((a.place?, one.as_ref()?)))
                .map(|(place, one)| (place, one.value, half(one)))
                .collect();
            if line.len() > 1 {
                let series = Series { line, points: vec![] };
                let across = match found.band {
                    BandKind::LocalMean => "mean force across",
                    _ => "force across",
                };
                parts.push(Part {
                    axes: [named("share of the length", "1"), named(across, "N/m")],
                    series: vec![series],
                });
            }
        }
        rows => {
            let timed = rows.iter().all(|row| row.t_s.is_some());
            for (k, a) in found.amplitudes.iter().enumerate().take(MOST) {
                let told = rows.iter().enumerate().filter_map(|(j, row)| {
                    let one = row.amplitudes[k].as_ref()?;
                    let x = row.t_s.filter(|_| timed).unwrap_or(j as f64 + 1.0);
                    Some((x, one.value, half(one)))
                });
                let line: Vec<_> = told.collect();
                if line.len() > 1 {
                    parts.push(Part {
                        axes: [
                            if timed { named("t", "s") } else { named("row", "1") },
                            named(&a.name, &a.unit),
                        ],
                        series: vec![Series { line, points: vec![] }],
                    });
                }
            }
        }
    }
    match found.over_time {
        Some(_) => parts.extend(pressures_over_time(found)),
        None => parts.extend(pressures(found)),
    }
    for (k, a) in found.amplitudes.iter().enumerate().take(MOST) {
        let of = found
            .choice
            .iter()
            .filter_map(|one| Some((one.bladders.len() as f64, one.errors[k]?, 0.0)));
        let line: Vec<_> = of.collect();
        if line.len() > 1 {
            parts.push(Part {
                axes: [
                    named("sensors", "1"),
                    named(&format!("standard error of {}", a.name), &a.unit),
                ],
                series: vec![Series {
                    points: line.iter().map(|(x, y, _)| (*x, *y)).collect(),
                    line,
                }],
            });
        }
    }
    let about = match found.rows.is_empty() {
        true => "what pressures tell of loads, by the number of sensors".into(),
        false => {
            let loads = match found.band {
                BandKind::LocalMean => "means around places",
                _ => "loads",
            };
            format!("{loads} with bands of 95 %; pressures: rings measured, lines modelled, blue the upper row")
        }
    };
    Drawn {
        case: format!("{} · loads from pressures", found.case),
        about,
        parts,
    }
}

/// Bladders whose pressures over time are drawn, at most.
const DRAWN: usize = 3;

/// Pressures over time of the bladders in which they are largest.
fn pressures_over_time(found: &Sensed) -> Vec<Part> {
    let size = |k: usize| {
        let all = found.rows.iter().filter_map(|row| row.measured_pa[k]);
        all.fold(0.0_f64, |most, p| most.max(p.abs()))
    };
    let mut order: Vec<usize> = (0..found.bladders.len()).collect();
    order.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
    let part = |k: &usize| {
        let timed = || found.rows.iter().filter_map(|row| Some((row.t_s?, row)));
        let series = Series {
            line: timed().map(|(t, row)| (t, row.modelled_pa[*k], 0.0)).collect(),
            points: timed().filter_map(|(t, row)| Some((t, row.measured_pa[*k]?))).collect(),
        };
        Part {
            axes: [
                ("t".into(), "s".into()),
                (format!("pressure of bladder {}", found.bladders[*k]), "Pa".into()),
            ],
            series: vec![series],
        }
    };
    order.iter().take(DRAWN).map(part).collect()
}

/// Pressures along the beam of the row in which they are largest.
fn pressures(found: &Sensed) -> Option<Part> {
    let size = |row: &&results::sense::Row| {
        row.measured_pa
            .iter()
            .flatten()
            .fold(0.0_f64, |most, p| most.max(p.abs()))
    };
    let row = found.rows.iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
    let series = [1, -1].map(|side: i64| {
        let own = || {
            found
                .bladders
                .iter()
                .enumerate()
                .filter(move |(_, label)| label.signum() == side)
        };
        Series {
            line: own()
                .map(|(k, label)| (label.abs() as f64, row.modelled_pa[k], 0.0))
                .collect(),
            points: own()
                .filter_map(|(k, label)| Some((label.abs() as f64, row.measured_pa[k]?)))
                .collect(),
        }
    });
    Some(Part {
        axes: [("bladder".into(), "1".into()), ("pressure".into(), "Pa".into())],
        series: series.into(),
    })
}
