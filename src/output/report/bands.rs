//! Page of `bands`: waves over the frequency, and the gaps.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::{FolderKind, Page, Place};
use crate::error::Result;
use crate::output::band_structure::{CSV, DRAWN};
use crate::output::folder::CASE;
use crate::output::numbers::{counted, error_percent, significant};
use crate::results::bands::{BandsRecord, GapRecord, WaveMotion, WaveRecord};

/// Data of the page.
pub fn data(place: &Place) -> Result<Page> {
    let (found, mut page) = place.begun::<BandsRecord>(FolderKind::Bands, |found| (&found.case, &found.warnings))?;
    let tone = if found.warnings.is_empty() { "good" } else { "fair" };
    let [from, to] = found.band_hz.map(|hz| significant(hz, 4));
    let gaps = counted(found.gaps.len() as u64, "gap");
    let phase = |wave: &WaveRecord| (wave.attenuation_db.abs() < DRAWN).then(|| wave.real.abs() / PI);
    let loss = |wave: &WaveRecord| Some(wave.attenuation_db.abs()).filter(|decibel| *decibel <= DRAWN);
    let row = |gap: &GapRecord| {
        let width = gap.relative_width();
        json!([
            gap.motion.name(),
            gap.from_hz,
            gap.to_hz,
            width,
            gap.deepest_hz,
            gap.attenuation_db
        ])
    };
    let [first, last] = found.band_hz;
    page.fill(json!({
        "label": "Waves of the repeating cell", "status": {"word": "finished", "tone": tone, "reason": null},
        "answer": format!("Waves from {from} to {to} Hz: {gaps}."),
        "charts": [
            chart(&found, "Phase per cell", json!({"name": "phase per cell over π", "unit": "1"}), phase),
            chart(&found, "Attenuation per cell", json!({"name": "attenuation per cell [dB]", "unit": "1"}), loss),
        ],
        "table": {
            "title": "Gaps",
            "headings": ["motion", "from [Hz]", "to [Hz]", "width [1]", "deepest [Hz]", "attenuation [dB/cell]"],
            "rows": found.gaps.iter().map(row).collect::<Vec<_>>(), "file": CSV,
        },
        "command": format!("slcbeam bands {CASE} --from {first} --to {last}"),
    }));
    Ok(page)
}

/// Chart of a value of each wave over the frequency; marks state the whole wave.
fn chart(found: &BandsRecord, title: &str, y: Value, of: impl Fn(&WaveRecord) -> Option<f64>) -> Value {
    let words = |wave: &WaveRecord| {
        let error = wave
            .error
            .map(|error| error_percent(error / wave.real.hypot(wave.imag).max(f64::MIN_POSITIVE)));
        format!(
            "{} at {} Hz: phase {} π per cell, {} dB per cell{}",
            wave.energy.motion.name(),
            significant(wave.frequency_hz, 5),
            significant(wave.real / PI, 4),
            significant(wave.attenuation_db, 4),
            error.map_or_else(String::new, |error| format!("; mesh error {error}"))
        )
    };
    let series = WaveMotion::ALL.into_iter().enumerate().filter_map(|(k, motion)| {
        let waves = found.waves.iter().filter(|wave| wave.energy.motion == motion);
        let points: Vec<Value> = waves
            .filter_map(|wave| Some(json!([wave.frequency_hz, of(wave)?, words(wave)])))
            .collect();
        (!points.is_empty()).then(|| json!({"name": motion.name(), "points": points, "colour": k}))
    });
    let bending = found.gaps.iter().filter(|gap| gap.motion == WaveMotion::Bending);
    json!({
        "title": title, "kind": "marks", "linear": true, "dots": true,
        "about": "Waves by their largest energy. In a shaded gap every bending wave is attenuated.",
        "x": {"name": "frequency", "unit": "Hz"}, "y": y, "series": series.collect::<Vec<_>>(),
        "shades": bending.map(|gap| [gap.from_hz, gap.to_hz]).collect::<Vec<_>>(),
    })
}
