//! Files of a frequency response: `response.csv`, `response.json`, `response.svg`, and its text.

mod picture;

use std::fmt::Write as _;

pub use self::picture::overlay;
use self::picture::{nyquist, picture};
use super::columns::{table, warnings};
use super::folder::ResultFolder;
use super::numbers::{counted, shortest, significant};
use super::records;
use crate::error::Result;
use crate::error::numbers::error_percent;
use crate::results;
use crate::results::response::{
    ComparedResponses, NamedResponse, PowerCurve, ResponseCurve, ResponseDerivatives, ResponsePeak, ResponseRecord,
    ResponseSideband, ResponseValue,
};

/// One row per frequency.
pub const CSV: &str = "response.csv";
/// Complete result.
pub const JSON: &str = "response.json";
/// Amplitude and phase.
pub const PICTURE: &str = "response.svg";
/// Responses in the complex plane.
pub const NYQUIST: &str = "nyquist.svg";

/// A transfer function with its name, unit and values: real part, imaginary part, errors.
pub struct Transfer<'a> {
    /// Key of the output, with the harmonic of a sideband.
    pub name: String,
    /// Frequencies [Hz].
    pub hz: &'a [f64],
    /// Unit of the output.
    pub unit: &'a str,
    /// Real part, imaginary part and error at each frequency; no errors if they are unknown.
    pub parts: [&'a [f64]; 3],
}

/// Transfer functions of all outputs; the direct one of each precedes its sidebands.
pub fn transfers(found: &ResponseRecord) -> Vec<Transfer<'_>> {
    let mut all = vec![];
    let hz = &found.frequency_hz[..];
    for curve in found.curves() {
        let unit = curve.unit.as_str();
        all.push(Transfer {
            name: curve.output.clone(),
            hz,
            unit,
            parts: [&curve.real, &curve.imag, &curve.error],
        });
        all.extend(curve.sidebands.iter().map(|sideband| Transfer {
            name: format!("{} {:+}", curve.output, sideband.harmonic),
            hz,
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
        let Transfer { name, unit, parts, .. } = transfer;
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
        .chain(
            found
                .powers
                .iter()
                .map(|curve| format!("mean power {} [W/input²]", curve.power)),
        )
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
    let headings = " | <output | peak [Hz] | amplitude | [dB] | phase [°] | damping ratio";
    text += &table(headings, found.curves().flat_map(|curve| peak_rows(curve, "")));
    text.push('\n');
    let at = found
        .curves()
        .flat_map(|curve| curve.at.iter().map(move |value| at_row(curve, value)));
    let at: Vec<_> = at.collect();
    if !at.is_empty() {
        text += &table(" | <output | frequency [Hz] | amplitude | [dB] | phase [°]", at);
        text.push('\n');
    }
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
    text += &powers(found);
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

/// An amplitude in decibel; nothing for 0.
fn decibel(amplitude: f64) -> String {
    match amplitude > 0.0 {
        true => format!("{:.2}", 20.0 * amplitude.log10()),
        false => String::new(),
    }
}

fn at_row(curve: &ResponseCurve, value: &ResponseValue) -> [String; 6] {
    [
        String::new(),
        curve.output.clone(),
        significant(value.frequency_hz, 7),
        significant(value.amplitude, 5),
        decibel(value.amplitude),
        format!("{:.1}", value.phase_deg),
    ]
}

/// A row for each peak of a curve, behind a first cell.
fn peak_rows(curve: &ResponseCurve, first: &str) -> Vec<[String; 7]> {
    match curve.peaks.is_empty() {
        true => vec![[first, &curve.output, "none", "", "", "", ""].map(String::from)],
        false => curve.peaks.iter().map(|peak| row(curve, peak, first)).collect(),
    }
}

fn row(curve: &ResponseCurve, peak: &ResponsePeak, first: &str) -> [String; 7] {
    // the amplitude found at an undamped pole is a rounding error
    let unbounded = peak.damping_ratio == Some(0.0);
    [
        first.into(),
        curve.output.clone(),
        significant(peak.frequency_hz, 7),
        if unbounded {
            "unbounded".into()
        } else {
            significant(peak.amplitude, 5)
        },
        if unbounded {
            String::new()
        } else {
            decibel(peak.amplitude)
        },
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
            decibel(size),
        ])
    };
    let rows = found
        .curves()
        .flat_map(|curve| curve.sidebands.iter().filter_map(move |sideband| row(curve, sideband)));
    let rows: Vec<[String; 7]> = rows.collect();
    if rows.is_empty() {
        return String::new();
    }
    table(
        " | <sideband | harmonic | input [Hz] | output [Hz] | amplitude | [dB]",
        rows,
    ) + "\n"
}

/// Writes the files into a folder.
///
/// # Errors
/// A file cannot be written.
pub fn write(folder: &mut ResultFolder, found: &ResponseRecord) -> Result<()> {
    let files = [(CSV, csv(found)), (JSON, results::text(found))];
    let pictures = [(PICTURE, picture(found)), (NYQUIST, nyquist(found))];
    folder.fill(
        files,
        pictures.map(|(name, picture)| (name, picture.and_then(|picture| picture.svg()))),
    )
}

/// Table of the peaks of several results.
pub fn peaks(all: &ComparedResponses) -> String {
    let of = |one: &NamedResponse| {
        let rows = one.response.curves().flat_map(|curve| peak_rows(curve, &one.folder));
        rows.collect::<Vec<_>>()
    };
    let headings = "<result | <output | peak [Hz] | amplitude | [dB] | phase [°] | damping ratio";
    let mut text = table(headings, all.results.iter().flat_map(of));
    let mut inputs: Vec<String> = all.results.iter().map(|one| one.response.input.clone()).collect();
    inputs.dedup();
    if inputs.len() > 1 {
        let _ = writeln!(
            text,
            "\nthe inputs differ, so that amplitudes may have different units: {}",
            inputs.join(", ")
        );
    }
    text
}
