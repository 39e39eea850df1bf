//! Files of a frequency response: `response.csv`, `response.json`, `response.svg`, and its text.

use std::fmt::Write as _;
use std::path::PathBuf;

use super::columns::{table, warnings};
use super::folder::ResultFolder;
use super::numbers::{counted, shortest, significant};
use super::plot::canvas::LineStyle;
use super::plot::colour::{Colour, PALETTE};
use super::plot::extent;
use super::plot::picture::{Panel, Picture, PictureAxis, PictureSeries};
use super::records;
use crate::error::Result;
use crate::error::numbers::error_percent;
use crate::results;
use crate::results::response::{
    ComparedResponses, NamedResponse, PowerCurve, ResponseCurve, ResponseDerivatives, ResponsePeak, ResponseRecord,
    ResponseValue,
};

/// One row per frequency.
pub const CSV: &str = "response.csv";
/// Complete result.
pub const JSON: &str = "response.json";
/// Amplitude and phase.
pub const PICTURE: &str = "response.svg";
/// Responses in the complex plane.
pub const NYQUIST: &str = "nyquist.svg";

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
        .chain(
            found
                .powers
                .iter()
                .map(|curve| format!("mean power {} [W/input²]", curve.power)),
        )
        .collect();
    let row = |(k, f): (usize, &f64)| {
        let mut row = vec![shortest(*f)];
        for curve in found.curves() {
            let (re, im) = (curve.real[k], curve.imag[k]);
            row.extend([re, im, re.hypot(im), im.atan2(re).to_degrees()].map(shortest));
            row.extend(curve.error.get(k).map(|error| shortest(*error)));
        }
        row.extend(found.powers.iter().map(|curve| shortest(curve.mean_w[k])));
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
    text += &powers(found);
    let _ = writeln!(text, "{} found in the band", counted(found.poles.len() as u64, "pole"));
    for (pointer, slopes) in &found.sensitivities.0 {
        text += &derivatives(found, pointer, slopes);
    }
    text + &warnings(&found.warnings)
}

/// Table of the largest mean powers.
fn powers(found: &ResponseRecord) -> String {
    let Some(input) = found.powers.first() else {
        return String::new();
    };
    let row = |curve: &PowerCurve| {
        let k = curve.largest()?;
        let (hz, power) = (found.frequency_hz[k], curve.mean_w[k]);
        let share = significant(100.0 * power / input.mean_w[k], 3);
        let numbers = [significant(hz, 7), significant(power, 5), format!("{share} %")];
        let named = [String::new(), curve.power.clone()].into_iter();
        Some(named.chain(numbers).collect::<Vec<_>>())
    };
    let heading = " | <mean power | largest at [Hz] | [W/input²] | of the input there";
    table(heading, found.powers.iter().filter_map(row)) + "\n"
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
    let mut files = vec![(CSV, csv(found)), (JSON, results::text(found))];
    for (name, picture) in [(PICTURE, picture(found)), (NYQUIST, nyquist(found))] {
        files.extend(picture.and_then(|picture| picture.svg()).map(|text| (name, text)));
    }
    folder.fill(files)
}

/// Largest distance of a drawn amplitude from the median [dB]: undamped poles and zeros are unbounded.
const AROUND: f64 = 100.0;

/// Picture of amplitude, phase and mean powers over frequency.
fn picture(found: &ResponseRecord) -> Option<Picture> {
    let curves: Vec<_> = found
        .curves()
        .map(|curve| (curve.output.clone(), &found.frequency_hz[..], curve))
        .collect();
    let mut panels = bode(&curves)?;
    let power = |(curve, colour): (&PowerCurve, &Colour)| {
        let points = found.frequency_hz.iter().copied().zip(curve.mean_w.iter().copied());
        let points: Vec<_> = points.filter(|(_, power)| *power > 0.0).collect();
        PictureSeries::line(points, LineStyle::solid(*colour, 1.6)).named(curve.power.replace('_', " "))
    };
    let powers: Vec<_> = found.powers.iter().zip(PALETTE.iter().cycle()).map(power).collect();
    if !powers.is_empty() {
        let axis = PictureAxis::new("mean power", "W/input²", 5).logarithmic(true);
        panels.push(Panel::new((620.0, 200.0), panels[0].x.clone(), axis, powers));
    }
    let title = format!("{} · frequency response", found.case);
    Some(Picture::stacked(title, format!("to {}", found.input), panels))
}

/// Picture of the responses of several results.
pub fn overlay(all: &ComparedResponses) -> Option<Picture> {
    let of = |one: &NamedResponse| {
        let several = !one.response.further.is_empty();
        let named = |curve: &ResponseCurve| match several {
            true => format!("{}: {}", one.folder, curve.output),
            false => one.folder.clone(),
        };
        one.response.curves().map(named).collect::<Vec<_>>()
    };
    let names = all.results.iter().flat_map(of);
    let curves = all.results.iter().flat_map(|one| {
        let hz = &one.response.frequency_hz[..];
        one.response.curves().map(move |curve| (hz, curve))
    });
    let curves: Vec<_> = names.zip(curves).map(|(name, (hz, curve))| (name, hz, curve)).collect();
    let mut inputs: Vec<&str> = all.results.iter().map(|one| one.response.input.as_str()).collect();
    inputs.dedup();
    let title = "frequency responses".to_owned();
    Some(Picture::stacked(
        title,
        format!("to {}", inputs.join(", ")),
        bode(&curves)?,
    ))
}

/// Panels of amplitude and phase of curves with names and frequencies.
fn bode(curves: &[(String, &[f64], &ResponseCurve)]) -> Option<Vec<Panel>> {
    let band = extent(curves.iter().flat_map(|(_, hz, _)| hz.iter().copied()))?;
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
    extent(curves.iter().flat_map(|(.., curve)| decibel(curve)))?;
    for ((name, hz, curve), colour) in curves.iter().zip(PALETTE.iter().cycle()) {
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
        let points = hz.iter().copied().zip(drawn);
        amplitudes.push(PictureSeries::line(points, stroke).named(name));
        let mut phase: Vec<(f64, f64)> = vec![];
        for (f, (re, im)) in hz.iter().zip(curve.real.iter().zip(&curve.imag)) {
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
    Some(vec![
        Panel::new((620.0, 250.0), x(), PictureAxis::new("amplitude", "dB", 6), amplitudes),
        Panel::new((620.0, 150.0), x(), phase_axis, phases),
    ])
}

/// Table of the peaks of several results.
pub fn peaks(all: &ComparedResponses) -> String {
    let of = |one: &NamedResponse| {
        let rows = |curve: &ResponseCurve| {
            let peaks = curve.peaks.iter().map(|peak| row(curve, peak));
            peaks
                .map(|row| [&[one.folder.clone()], &row[1..]].concat())
                .collect::<Vec<_>>()
        };
        one.response.curves().flat_map(rows).collect::<Vec<_>>()
    };
    let headings = "<result | <output | peak [Hz] | amplitude | [dB] | phase [°] | damping ratio";
    table(headings, all.results.iter().flat_map(of))
}

/// Picture of each response in the complex plane, over its largest amplitude (Nyquist).
fn nyquist(found: &ResponseRecord) -> Option<Picture> {
    let series = |(curve, colour): (&ResponseCurve, &Colour)| {
        let parts = || curve.real.iter().copied().zip(curve.imag.iter().copied());
        let largest = parts().map(|(re, im)| re.hypot(im)).fold(0.0, f64::max);
        let points = parts().map(|(re, im)| (re / largest, im / largest));
        let points: Vec<_> = points.filter(|(re, im)| re.is_finite() && im.is_finite()).collect();
        PictureSeries::line(points, LineStyle::solid(*colour, 1.6)).named(&curve.output)
    };
    let all: Vec<_> = found.curves().zip(PALETTE.iter().cycle()).map(series).collect();
    found.frequency_hz.get(1)?;
    let axis = |name: &str| PictureAxis::new(name, "", 5).between(-1.0, 1.0).with(&[0.0]);
    let panel = Panel::new((420.0, 420.0), axis("real part"), axis("imaginary part"), all);
    Some(Picture::stacked(
        format!("{} · responses in the complex plane", found.case),
        format!(
            "to {}, each over its largest amplitude; clockwise as the frequency increases",
            found.input
        ),
        [panel],
    ))
}
