//! Output files of `slcbeam sense`, `sense.csv`, `sensors.csv`, `sense.json` and `sense.svg`, and its text.

mod text;

use super::folder::ResultFolder;
use super::numbers::shortest;
use super::plot::canvas::LineStyle;
use super::plot::colour::{Colour, PALETTE};
use super::plot::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries};
use super::records::{self, number};
use crate::error::Result;
use crate::results;
use crate::results::sense::{BandKind, Banded, ChosenSensors, Sensed};

pub use text::{about_band, about_noise, about_sight, answer, describe, list, table};

/// One row per row of measurements.
pub const CSV: &str = "sense.csv";
/// The best sets of bladders to measure.
pub const SENSORS: &str = "sensors.csv";
/// Complete result.
pub const JSON: &str = "sense.json";
/// Loads with their bands, pressures, and errors over the number of sensors.
pub const PICTURE: &str = "sense.svg";

/// Largest number of amplitudes with a picture of their own.
const MOST: usize = 6;

/// Writes the files into a folder.
///
/// # Errors
/// A file cannot be written.
pub fn write(folder: &mut ResultFolder, found: &Sensed) -> Result<()> {
    let mut files = vec![(JSON, results::text(found))];
    files.extend((!found.rows.is_empty()).then(|| (CSV, csv(found))));
    files.extend((!found.choice.is_empty()).then(|| (SENSORS, sensors(found))));
    folder.fill(files, [(PICTURE, drawn(found))])
}

/// Text of `sense.csv`; a cell is empty if its value is not determined or was not measured.
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

/// Text of `sensors.csv`: one row per number of sensors.
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

const BAND: Colour = Colour(0xd5, 0xe3, 0xf0);

/// Picture of loads with their bands, of measured and modelled pressures, and of errors over the number of sensors.
fn drawn(found: &Sensed) -> Option<String> {
    let mut panels = vec![];
    match found.rows.as_slice() {
        [] => {}
        [row] => {
            let all = found.amplitudes.iter().zip(&row.amplitudes);
            let of_profile = all.filter(|(a, _)| a.unit == "N/m");
            let line = of_profile.filter_map(|(a, one)| Some((a.place?, one.as_ref()?)));
            let across = match found.band {
                BandKind::LocalMean => "mean force across",
                _ => "force across",
            };
            panels.extend(banded(line, ["share of the length", "1", across, "N/m"]));
        }
        rows => {
            let timed = rows.iter().all(|row| row.t_s.is_some());
            let [x, unit] = if timed { ["t", "s"] } else { ["row", "1"] };
            for (k, a) in found.amplitudes.iter().enumerate().take(MOST) {
                let line = rows.iter().enumerate().filter_map(|(j, row)| {
                    let x = row.t_s.filter(|_| timed).unwrap_or(j as f64 + 1.0);
                    Some((x, row.amplitudes[k].as_ref()?))
                });
                panels.extend(banded(line, [x, unit, &a.name, &a.unit]));
            }
        }
    }
    match found.over_time {
        Some(_) => panels.extend(pressures_over_time(found)),
        None => panels.extend(pressures(found)),
    }
    for (k, a) in found.amplitudes.iter().enumerate().take(MOST) {
        let of = |one: &ChosenSensors| Some((one.bladders.len() as f64, one.errors[k]?));
        let line: Vec<_> = found.choice.iter().filter_map(of).collect();
        if line.len() > 1 {
            let name = format!("standard error of {}", a.name);
            panels.push(plane(["sensors", "1", &name, &a.unit], beside(line.clone(), line, 0)));
        }
    }
    let about = match (found.rows.is_empty(), found.band) {
        (true, _) => "standard errors of the loads, by the number of sensors".into(),
        (false, band) => {
            let loads = match band {
                BandKind::LocalMean => "means around places",
                _ => "loads",
            };
            format!("{loads} with 95 % bands; pressures: rings measured, lines modelled, blue the upper row")
        }
    };
    let picture = Picture {
        title: format!("{} · loads from pressures", found.case),
        about,
        rows: panels.chunks(2).map(<[Panel]>::to_vec).collect(),
    };
    picture.svg()
}

/// Panel with names and units of its axes.
fn plane([x, x_unit, y, y_unit]: [&str; 4], series: Vec<PictureSeries>) -> Panel {
    let y = PictureAxis::new(y, y_unit, 6).with(&[0.0]);
    Panel::new((330.0, 220.0), PictureAxis::new(x, x_unit, 7), y, series)
}

/// Panel of values with their bands; `None` for a single place.
fn banded<'a>(line: impl Iterator<Item = (f64, &'a Banded)>, axes: [&str; 4]) -> Option<Panel> {
    let half = |one: &Banded| 0.5 * (one.high - one.low);
    let line: Vec<_> = line.map(|(x, one)| (x, one.value, half(one))).collect();
    let band: Vec<_> = line.iter().map(|(x, y, half)| (*x, y - half, y + half)).collect();
    let curve = PictureSeries::line(line.iter().map(|p| (p.0, p.1)), LineStyle::solid(PALETTE[0], 1.6));
    (line.len() > 1).then(|| plane(axes, vec![PictureSeries::band(&band, BAND), curve]))
}

/// A line and rings in one color.
fn beside(line: Vec<(f64, f64)>, points: Vec<(f64, f64)>, colour: usize) -> Vec<PictureSeries> {
    let colour = PALETTE[colour];
    vec![
        PictureSeries::line(line, LineStyle::solid(colour, 1.6)),
        PictureSeries::marks(points, Glyph::Ring(2.6, 1.1), colour),
    ]
}

/// Largest number of bladders whose pressures over time are drawn.
const DRAWN: usize = 3;

/// Pressures over time, for the bladders with the largest pressures.
fn pressures_over_time(found: &Sensed) -> Vec<Panel> {
    let size = |k: usize| {
        let all = found.rows.iter().filter_map(|row| row.measured_pa[k]);
        all.fold(0.0_f64, |most, p| most.max(p.abs()))
    };
    let mut order: Vec<usize> = (0..found.bladders.len()).collect();
    order.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
    let panel = |k: &usize| {
        let timed = || found.rows.iter().filter_map(|row| Some((row.t_s?, row)));
        let line = timed().map(|(t, row)| (t, row.modelled_pa[*k]));
        let points = timed().filter_map(|(t, row)| Some((t, row.measured_pa[*k]?)));
        let name = format!("pressure of bladder {}", found.bladders[*k]);
        plane(["t", "s", &name, "Pa"], beside(line.collect(), points.collect(), 0))
    };
    order.iter().take(DRAWN).map(panel).collect()
}

/// Pressures along the beam, for the row of measurements with the largest pressure.
fn pressures(found: &Sensed) -> Option<Panel> {
    let size = |row: &&results::sense::MeasurementRow| {
        let all = row.measured_pa.iter().flatten();
        all.fold(0.0_f64, |most, p| most.max(p.abs()))
    };
    let row = found.rows.iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
    let series = [(0, 1), (1, -1)].into_iter().flat_map(|(colour, side)| {
        let all = || found.bladders.iter().enumerate();
        let own = || all().filter(move |(_, label)| label.signum() == side);
        let line = own().map(|(k, label)| (label.abs() as f64, row.modelled_pa[k]));
        let points = own().filter_map(|(k, label)| Some((label.abs() as f64, row.measured_pa[k]?)));
        beside(line.collect(), points.collect(), colour)
    });
    Some(plane(["bladder", "1", "pressure", "Pa"], series.collect()))
}
