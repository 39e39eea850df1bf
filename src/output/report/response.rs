//! Page of `response`: amplitude and phase, and the peaks.

use serde_json::{Value, json};

use super::{FolderKind, Page, Place, base64, placed};
use crate::error::Result;
use crate::output::folder::CASE;
use crate::output::numbers::{counted, significant};
use crate::output::response::{NYQUIST, PICTURE, Transfer, transfers};
use crate::results::response::{LinearisedState, ResponsePeak, ResponseRecord, ResponseShape, ResponseShapes};

/// Data of the page.
pub fn data(place: &Place) -> Result<Page> {
    let (found, mut page) =
        place.begun::<ResponseRecord>(FolderKind::Response, |found| (&found.case, &found.warnings))?;
    let tone = if found.warnings.is_empty() { "good" } else { "fair" };
    let outputs: Vec<&str> = found.curves().map(|curve| curve.output.as_str()).collect();
    let peaks: usize = found.curves().map(|curve| curve.peaks.len()).sum();
    let [first, last] = [found.frequency_hz.first(), found.frequency_hz.last()].map(|hz| hz.copied().unwrap_or(0.0));
    let powers = (!found.powers.is_empty()).then(|| {
        json!({
            "title": "Amplitude, phase and mean powers",
            "picture": place.picture(PICTURE),
            "about": "Amplitude in decibel: 20 log10 of the output over the input, in SI units. Powers are means over a cycle.",
        })
    });
    let plane = json!({
        "title": "In the complex plane",
        "picture": place.picture(NYQUIST),
        "about": "Real and imaginary part of each response, over its largest amplitude (Nyquist). A lightly damped mode is a circle.",
    });
    let rows = found.curves().flat_map(|curve| {
        let row = |peak: &ResponsePeak| {
            json!([
                curve.output,
                peak.frequency_hz,
                peak.amplitude,
                peak.phase_deg,
                peak.damping_ratio
            ])
        };
        curve.peaks.iter().map(row).collect::<Vec<_>>()
    });
    let at = match found.state {
        LinearisedState::Start => String::new(),
        LinearisedState::Equilibrium => format!(" --at {}", found.at_s),
        LinearisedState::Cycle => {
            let all = found.curves().flat_map(|curve| &curve.sidebands);
            let most = all.map(|sideband| sideband.harmonic).max().unwrap_or(1);
            format!(" --about-cycle --harmonics {most}")
        }
    };
    page.fill(json!({
        "label": "Frequency response of small motions", "status": {"word": "finished", "tone": tone, "reason": null},
        "answer": format!(
            "Response of {} to {} from {} to {} Hz: {}, {}.",
            outputs.join(", "), found.input, significant(first, 4), significant(last, 4), counted(peaks as u64, "peak"),
            counted(found.poles.len() as u64, "pole")
        ),
        "curves": curves(&found), "shapes": found.shapes.as_ref().map(|found| shapes(found, place)),
        "figures": powers.into_iter().chain([plane]).collect::<Vec<_>>(),
        "table": {
            "title": "Peaks",
            "headings": ["output", "frequency [Hz]", "amplitude", "phase [deg]", "damping ratio [1]"],
            "rows": rows.collect::<Vec<_>>(), "file": "response.csv",
        },
        "command": format!("slcbeam response {CASE} --input {} --output {}{at}", found.input, outputs.join(",")),
    }));
    Ok(page)
}

/// Real part, imaginary part and error of each curve, with the sidebands.
fn curves(found: &ResponseRecord) -> Value {
    let curve = |transfer: &Transfer| {
        let [real, imag, error] = transfer.parts;
        json!({"label": transfer.name, "unit": transfer.unit, "real": base64::numbers(real.iter().copied()),
               "imag": base64::numbers(imag.iter().copied()), "error": base64::numbers(error.iter().copied())})
    };
    let all: Vec<Value> = transfers(found).iter().map(curve).collect();
    json!({"hz": base64::numbers(found.frequency_hz.iter().copied()), "all": all, "input": found.input})
}

/// Amplitudes and phases of the shapes, as those of modes.
fn shapes(found: &ResponseShapes, place: &Place) -> Value {
    type Part = fn(&ResponseShape) -> &[Vec<f64>; 2];
    let all = |of: Part, value: fn(f64, f64) -> f64| {
        let one = |shape| {
            let [re, im] = of(shape);
            re.iter().zip(im).map(move |(re, im)| value(*re, *im))
        };
        base64::numbers(found.at.iter().flat_map(one))
    };
    let mut page = json!({"theta_m": base64::numbers(found.theta_m.iter().copied()), "most": found.at.len(),
                          "hz": found.at.iter().map(|shape| shape.frequency_hz).collect::<Vec<_>>()});
    let chosen: Vec<usize> = (0..found.theta_m.len()).collect();
    placed::add(&mut page, place.placed(chosen.len()).as_ref(), &chosen);
    let parts: [(&str, &str, Part); 3] = [
        ("u1", "m", |shape| &shape.u1),
        ("u3", "m", |shape| &shape.u3),
        ("pressure", "pa", |shape| &shape.pressure),
    ];
    for (name, unit, part) in parts {
        let bladders = found.at.first().map_or(0, |shape| part(shape)[0].len());
        if bladders > 0 {
            page[format!("{name}_amplitude_{unit}")] = all(part, f64::hypot);
            page[format!("{name}_phase_rad")] = all(part, |re, im| im.atan2(re));
        }
    }
    let bladders = found.at.first().map(|shape| shape.pressure[0].len());
    page["bladders"] = json!(bladders.filter(|count| *count > 0));
    page
}
