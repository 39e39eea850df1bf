//! Page of `response`: amplitude and phase, and the peaks.

use serde_json::json;

use super::{FolderKind, Page, Place, StoredResult};
use crate::error::Result;
use crate::output::folder::CASE;
use crate::output::numbers::{counted, significant};
use crate::output::response::{JSON, NYQUIST, PICTURE};
use crate::results::response::{LinearisedState, ResponseRecord};

/// Data of the page.
pub fn data(place: &Place) -> Result<Page> {
    let StoredResult { result: found, head } = place.result::<ResponseRecord>(JSON)?;
    let mut page = place.page(FolderKind::Response, &found.case, Some(&head));
    page.put("label", "Frequency response of small motions");
    page.warnings.clone_from(&found.warnings);
    let (word, tone) = match found.warnings.is_empty() {
        true => ("finished", "good"),
        false => ("finished", "fair"),
    };
    page.put("status", json!({"word": word, "tone": tone, "reason": null}));
    let outputs: Vec<&str> = found.curves().map(|curve| curve.output.as_str()).collect();
    let peaks: usize = found.curves().map(|curve| curve.peaks.len()).sum();
    let (first, last) = (found.frequency_hz.first(), found.frequency_hz.last());
    page.put(
        "answer",
        format!(
            "Response of {} to {} from {} to {} Hz: {}, {}.",
            outputs.join(", "),
            found.input,
            significant(first.copied().unwrap_or(0.0), 4),
            significant(last.copied().unwrap_or(0.0), 4),
            counted(peaks as u64, "peak"),
            counted(found.poles.len() as u64, "pole")
        ),
    );
    page.put(
        "figures",
        json!([{
            "title": "Amplitude and phase",
            "picture": place.picture(PICTURE),
            "about": "Amplitude in decibel: 20 log10 of the output over the input, in SI units. The phase is that of the output before the input.",
        }, {
            "title": "In the complex plane",
            "picture": place.picture(NYQUIST),
            "about": "Real and imaginary part of each response, over its largest amplitude (Nyquist). A lightly damped mode is a circle.",
        }]),
    );
    let rows = found.curves().flat_map(|curve| {
        let row = |peak: &crate::results::response::ResponsePeak| {
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
    page.put(
        "table",
        json!({
            "title": "Peaks",
            "headings": ["output", "frequency [Hz]", "amplitude", "phase [deg]", "damping ratio [1]"],
            "rows": rows.collect::<Vec<_>>(), "file": "response.csv",
        }),
    );
    let at = match found.state {
        LinearisedState::Start => String::new(),
        LinearisedState::Equilibrium => format!(" --at {}", found.at_s),
        LinearisedState::Cycle => {
            let all = found.curves().flat_map(|curve| &curve.sidebands);
            let most = all.map(|sideband| sideband.harmonic).max().unwrap_or(1);
            format!(" --about-cycle --harmonics {most}")
        }
    };
    page.put(
        "command",
        format!(
            "slcbeam response {CASE} --input {} --output {}{at}",
            found.input,
            outputs.join(",")
        ),
    );
    Ok(page)
}
