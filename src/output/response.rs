//! Files of a frequency response: `response.csv`, `response.json`, `response.svg`, and its text.

use std::fmt::Write as _;
use std::path::PathBuf;

use super::columns::{table, warnings};
use super::folder::ResultFolder;
use super::numbers::{counted, shortest, significant};
use super::plot::canvas::LineStyle;
use super::plot::colour::PALETTE;
use super::plot::extent;
use super::plot::picture::{Panel, Picture, PictureAxis, PictureSeries};
use super::records;
use crate::error::Result;
use crate::error::numbers::error_percent;
use crate::results;
use crate::results::response::{ResponseCurve, ResponsePeak, ResponseRecord, ResponseSideband};

/// One row per frequency.
pub const CSV: &str = "response.csv";
/// Complete result.
pub const JSON: &str = "response.json";
/// Amplitude and phase.
pub const PICTURE: &str = "response.svg";

/// A transfer function with its name, unit and values: real part, imaginary part, errors.
struct Transfer<'a> {
    name: String,
    unit: &'a str,
    parts: [&'a [f64]; 3],
}

/// Transfer functions of all outputs; the direct one of each precedes its sidebands.
fn transfers(found: &ResponseRecord) -> Vec<Transfer<'_>> {
    let mut all = vec![];
    for curve in found.curves() {
        let unit = curve.unit.as_str();
        all.push(Transfer {
            name: curve.output.clone(),
            unit,
            parts: [&curve.real, &curve.imag, &curve.error],
        });
        all.extend(curve.sidebands.iter().map(|sideband| Transfer {
            name: format!("{} {:+}", curve.output, sideband.harmonic),
            unit,
            parts: [&sideband.real, &sideband.imag, &sideband.error],
        }));
    }
    all
}

/// The text of `response.csv`.
fn csv(found: &ResponseRecord) -> String {
    let all = transfers(found);
    let columns = |transfer: &Transfer| {
        let Transfer { name, unit, parts } = transfer;
        let values = ["real", "imaginary", "amplitude"].map(|part| format!("{part} {name} [{unit}/input]"));
        let error = (!parts[2].is_empty()).then(|| format!("error {name} [{unit}/input]"));
        values
            .into_iter()
            .chain([format!("phase {name} [deg]")])
            .chain(error)
            .collect::<Vec<_>>()
    };
    let headings: Vec<String> = std::iter::once("frequency [Hz]".into())
        .chain(all.iter().flat_map(columns))
        .collect();
    let row = |(k, f): (usize, &f64)| {
        let mut row = vec![shortest(*f)];
        for Transfer {
            parts: [real, imag, error],
            ..
        } in &all
        {
            let (re, im) = (real[k], imag[k]);
            row.extend([re, im, re.hypot(im), im.atan2(re).to_degrees()].map(shortest));
            row.extend(error.get(k).map(|error| shortest(*error)));
        }
        row
    };
    records::text(
        headings.iter().map(String::as_str),
        found.frequency_hz.iter().enumerate().map(row),
    )
}

/// Table of the peaks, errors by the mesh, and number of poles.
pub fn describe(found: &ResponseRecord) -> String {
    let mut text = format!(
        "{}: response to {}, {} to {} Hz, {}\n\n",
        found.case,
        found.input,
        significant(found.frequency_hz[0], 4),
        significant(*found.frequency_hz.last().unwrap_or(&0.0), 4),
        counted(found.frequency_hz.len() as u64, "sample")
    );
    let mut rows = vec![];
    for curve in found.curves() {
        rows.extend(curve.peaks.iter().map(|peak| row(curve, peak)));
        if curve.peaks.is_empty() {
            let cells = ["", &curve.output, "none", "", "", "", ""];
            rows.push(cells.map(String::from));
        }
    }
    text += &table(
        " | <output | peak [Hz] | amplitude | [dB] | phase [°] | damping ratio",
        rows,
    );
    text.push('\n');
    text += &sidebands(found);
    let cause = if found.cycle.is_some() {
        "mesh and steps"
    } else {
        "the mesh"
    };
    for curve in found.curves() {
        if let Some([median, largest]) = curve.errors(&found.frequency_hz) {
            let [median, largest] = [median, largest].map(error_percent);
            let _ = writeln!(
                text,
                "error of {} by {cause}: {median} in the median over frequencies; at most {largest} of the largest amplitude",
                curve.output
            );
        }
    }
    if let Some(cycle) = &found.cycle {
        let _ = writeln!(
            text,
            "cycle of {} Hz: {}, residual {:.0e}",
            significant(1.0 / cycle.period_s, 4),
            counted(cycle.steps as u64, "step"),
            cycle.residual
        );
    } else {
        let _ = writeln!(text, "{} found in the band", counted(found.poles.len() as u64, "pole"));
    }
    text + &warnings(&found.warnings)
}

fn row(curve: &ResponseCurve, peak: &ResponsePeak) -> [String; 7] {
    [
        String::new(),
        curve.output.clone(),
        significant(peak.frequency_hz, 7),
        significant(peak.amplitude, 5),
        format!("{:.2}", 20.0 * peak.amplitude.log10()),
        format!("{:.1}", peak.phase_deg),
        peak.damping_ratio.map_or(String::new(), |ratio| significant(ratio, 4)),
    ]
}

/// Table of the largest values of sidebands, if there are any.
fn sidebands(found: &ResponseRecord) -> String {
    let Some(cycle) = &found.cycle else {
        return String::new();
    };
    let row = |curve: &ResponseCurve, sideband: &ResponseSideband| {
        let [hz, size] = sideband.largest(&found.frequency_hz)?;
        let out = hz + f64::from(sideband.harmonic) / cycle.period_s;
        Some([
            String::new(),
            curve.output.clone(),
            format!("{:+}", sideband.harmonic),
            significant(hz, 7),
            significant(out.abs(), 7),
            significant(size, 5),
            format!("{:.2}", 20.0 * size.log10()),
        ])
    };
    let rows = found
        .curves()
        .flat_map(|curve| curve.sidebands.iter().filter_map(move |sideband| row(curve, sideband)));
    let rows: Vec<[String; 7]> = rows.collect();
    table(
        " | <sideband | harmonic | input [Hz] | output [Hz] | amplitude | [dB]",
        rows,
    ) + "\n"
}

/// Writes the files into a folder.
///
/// # Errors
/// A file cannot be written.
pub fn write(folder: &mut ResultFolder, found: &ResponseRecord) -> Result<Vec<PathBuf>> {
    let picture = picture(found).and_then(|picture| picture.svg());
    let mut files = vec![(CSV, csv(found)), (JSON, results::text(found))];
    files.extend(picture.map(|text| (PICTURE, text)));
    folder.fill(files)
}

/// Largest distance of a drawn amplitude from the median [dB]: undamped poles and zeros are unbounded.
const AROUND: f64 = 100.0;

/// Picture of amplitude and phase over frequency.
fn picture(found: &ResponseRecord) -> Option<Picture> {
    let band = (*found.frequency_hz.first()?, *found.frequency_hz.last()?);
    let x = || {
        PictureAxis::new("frequency", "Hz", 8)
            .between(band.0, band.1)
            .logarithmic(true)
    };
    let decibel = |transfer: &Transfer| -> Vec<f64> {
        let [real, imag, _] = transfer.parts;
        let parts = real.iter().zip(imag);
        parts.map(|(re, im)| 20.0 * re.hypot(*im).log10()).collect()
    };
    let (mut amplitudes, mut phases) = (vec![], vec![]);
    let transfers = transfers(found);
    extent(transfers.iter().flat_map(decibel))?;
    for (transfer, colour) in transfers.iter().zip(PALETTE.iter().cycle()) {
        let stroke = LineStyle::solid(*colour, 1.6);
        let all = decibel(transfer);
        let mut sorted: Vec<f64> = all.iter().copied().filter(|amplitude| amplitude.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let Some(&middle) = sorted.get(sorted.len() / 2) else {
            continue;
        };
        let drawn = all
            .into_iter()
            .map(|amplitude| amplitude.clamp(middle - AROUND, middle + AROUND));
        let points = found.frequency_hz.iter().copied().zip(drawn);
        amplitudes.push(PictureSeries::line(points, stroke).named(&transfer.name));
        let mut phase: Vec<(f64, f64)> = vec![];
        let [real, imag, _] = transfer.parts;
        for (f, (re, im)) in found.frequency_hz.iter().zip(real.iter().zip(imag)) {
            let angle = im.atan2(*re).to_degrees();
            // a jump by a full turn is not part of the curve
            if phase.last().is_some_and(|(_, before)| (angle - before).abs() > 270.0) {
                phase.push((*f, f64::NAN));
            }
            phase.push((*f, angle));
        }
        phases.push(PictureSeries::line(phase, stroke));
    }
    let quarters = [-180.0, -90.0, 0.0, 90.0, 180.0].map(|angle| (angle, format!("{angle}").replace('-', "−")));
    let phase_axis = PictureAxis {
        labels: Some(quarters.to_vec()),
        ..PictureAxis::new("phase [°]", "", 5).between(-180.0, 180.0)
    };
    let panels = [
        Panel::new((620.0, 250.0), x(), PictureAxis::new("amplitude", "dB", 6), amplitudes),
        Panel::new((620.0, 150.0), x(), phase_axis, phases),
    ];
    Some(Picture::stacked(
        format!("{} · frequency response", found.case),
        format!("to {}", found.input),
        panels,
    ))
}
