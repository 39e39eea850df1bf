//! Page of `bands`: waves over the frequency, and the gaps.

use serde_json::json;

use super::{FolderKind, Page, Place};
use crate::error::Result;
use crate::output::band_structure::{CSV, PICTURE};
use crate::output::folder::CASE;
use crate::output::numbers::{counted, significant};
use crate::results::bands::BandsRecord;

/// Data of the page.
pub fn data(place: &Place) -> Result<Page> {
    let (found, mut page) = place.begun::<BandsRecord>(FolderKind::Bands, |found| (&found.case, &found.warnings))?;
    page.put("label", "Waves of the repeating cell");
    let tone = if found.warnings.is_empty() { "good" } else { "fair" };
    page.put("status", json!({"word": "finished", "tone": tone, "reason": null}));
    let [from, to] = found.band_hz.map(|hz| significant(hz, 4));
    page.put(
        "answer",
        format!(
            "Waves from {from} to {to} Hz: {}.",
            counted(found.gaps.len() as u64, "gap")
        ),
    );
    page.put(
        "figures",
        json!([{
            "title": "Wave number and attenuation",
            "picture": place.picture(PICTURE),
            "about": "From cell to cell a wave lags by the phase and is attenuated. In a shaded gap every bending wave is attenuated.",
        }]),
    );
    let row = |gap: &crate::results::bands::GapRecord| {
        json!([
            gap.motion.name(),
            gap.from_hz,
            gap.to_hz,
            gap.relative_width(),
            gap.deepest_hz,
            gap.attenuation_db
        ])
    };
    page.put(
        "table",
        json!({
            "title": "Gaps",
            "headings": ["motion", "from [Hz]", "to [Hz]", "width [1]", "deepest [Hz]", "attenuation [dB/cell]"],
            "rows": found.gaps.iter().map(row).collect::<Vec<_>>(), "file": CSV,
        }),
    );
    let [from, to] = found.band_hz;
    page.put("command", format!("slcbeam bands {CASE} --from {from} --to {to}"));
    Ok(page)
}
