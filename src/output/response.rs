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
use crate::results::response::{ResponseCurve, ResponseDerivatives, ResponsePeak, ResponseRecord, ResponseValue};

/// One row per frequency.
pub const CSV: &str = "response.csv";
/// Complete result.
pub const JSON: &str = "response.json";
/// Amplitude and phase.
pub const PICTURE: &str = "response.svg";

/// The text of `response.csv`.
fn csv(found: &ResponseRecord) -> String {
    let columns = |curve: &ResponseCurve| {
        let (name, unit) = (&curve.output, &curve.unit);
        let parts = ["real", "imaginary", "amplitude"].map(|part| format!("{part} {name} [{unit}/input]"));
        let error = (!curve.error.is_empty()).then(|| format!("error {name} [{unit}/input]"));
        parts
            .into_iter()
            .chain([format!("phase {name} [deg]")])
            .chain(error)
            .collect::<Vec<_>>()
    };
    let headings: Vec<String> = std::iter::once("frequency [Hz]".into())
        .chain(found.curves().flat_map(columns))
        .collect();
    let row = |(k, f): (usize, &f64)| {
        let mut row = vec![shortest(*f)];
        for curve in found.curves() {
            let (re, im) = (curve.real[k], curve.imag[k]);
            row.extend([re, im, re.hypot(im), im.atan2(re).to_degrees()].map(shortest));
            row.extend(curve.error.get(k).map(|error| shortest(*error)));
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
    let at = found
        .curves()
        .flat_map(|curve| curve.at.iter().map(move |value| at_row(curve, value)));
    let at: Vec<_> = at.collect();
    if !at.is_empty() {
        text += &table(" | <output | frequency [Hz] | amplitude | [dB] | phase [°]", at);
        text.push('\n');
    }
    for curve in found.curves() {
        if let Some([median, largest]) = curve.errors(&found.frequency_hz) {
            let [median, largest] = [median, largest].map(error_percent);
            let _ = writeln!(
                text,
                "error of {} by the mesh: {median} in the median over frequencies; at most {largest} of the largest amplitude",
                curve.output
            );
        }
    }
    let _ = writeln!(text, "{} found in the band", counted(found.poles.len() as u64, "pole"));
    for (pointer, slopes) in &found.sensitivities.0 {
        text += &derivatives(found, pointer, slopes);
    }
    text + &warnings(&found.warnings)
}

/// Changes of peaks and values for 1 % of a number.
fn derivatives(found: &ResponseRecord, pointer: &str, slopes: &ResponseDerivatives) -> String {
    let mut text = format!("for 1 % of {pointer} = {}:\n", significant(slopes.value, 6));
    let part = 0.01 * slopes.value;
    let relative = |slope: Option<f64>, of: f64| {
        slope.map_or_else(
            || "unknown".into(),
            |slope| format!("{} %", significant(100.0 * part * slope / of, 3)),
        )
    };
    for (curve, (name, own)) in found.curves().zip(&slopes.outputs.0) {
        for (peak, slope) in curve.peaks.iter().zip(&own.peaks) {
            let damping = peak.damping_ratio.filter(|ratio| *ratio != 0.0);
            let damping = damping.map_or(String::new(), |ratio| {
                format!(", damping ratio {}", relative(slope.damping_ratio, ratio))
            });
            let _ = writeln!(
                text,
                "  {name} at the peak of {} Hz: frequency {}, amplitude {}{damping}",
                significant(peak.frequency_hz, 5),
                relative(slope.frequency_hz, peak.frequency_hz),
                relative(slope.amplitude, peak.amplitude)
            );
        }
        for (value, slope) in curve.at.iter().zip(&own.at) {
            let phase = slope.phase_deg.map_or_else(
                || "unknown".into(),
                |slope| format!("{}°", significant(part * slope, 3)),
            );
            let _ = writeln!(
                text,
                "  {name} at {} Hz: amplitude {}, phase {phase}",
                significant(value.frequency_hz, 5),
                relative(slope.amplitude, value.amplitude)
            );
        }
    }
    text
}

fn at_row(curve: &ResponseCurve, value: &ResponseValue) -> [String; 6] {
    [
        String::new(),
        curve.output.clone(),
        significant(value.frequency_hz, 7),
        significant(value.amplitude, 5),
        format!("{:.2}", 20.0 * value.amplitude.log10()),
        format!("{:.1}", value.phase_deg),
    ]
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
    let decibel = |curve: &ResponseCurve| -> Vec<f64> {
        let parts = curve.real.iter().zip(&curve.imag);
        parts.map(|(re, im)| 20.0 * re.hypot(*im).log10()).collect()
    };
    let (mut amplitudes, mut phases) = (vec![], vec![]);
    extent(found.curves().flat_map(decibel))?;
    for (curve, colour) in found.curves().zip(PALETTE.iter().cycle()) {
        let stroke = LineStyle::solid(*colour, 1.6);
        let all = decibel(curve);
        let mut sorted: Vec<f64> = all.iter().copied().filter(|amplitude| amplitude.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let Some(&middle) = sorted.get(sorted.len() / 2) else {
            continue;
        };
        let drawn = all
            .into_iter()
            .map(|amplitude| amplitude.clamp(middle - AROUND, middle + AROUND));
        let points = found.frequency_hz.iter().copied().zip(drawn);
        amplitudes.push(PictureSeries::line(points, stroke).named(&curve.output));
        let mut phase: Vec<(f64, f64)> = vec![];
        for (f, (re, im)) in found.frequency_hz.iter().zip(curve.real.iter().zip(&curve.imag)) {
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
