//! Files of a band structure: `bands.csv`, `bands.json`, `bands.svg`, and its text.

use std::f64::consts::PI;
use std::fmt::Write as _;

use super::columns::{table, warnings};
use super::folder::ResultFolder;
use super::numbers::{shortest, significant};
use super::plot::colour::{Colour, PALETTE};
use super::plot::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries};
use super::records;
use crate::error::Result;
use crate::error::numbers::error_percent;
use crate::results;
use crate::results::bands::{BandsRecord, EnergyRecord, GapRecord, LatticeModeRecord, WaveMotion, WaveRecord};

/// One row per wave and frequency.
pub const CSV: &str = "bands.csv";
/// Complete result.
pub const JSON: &str = "bands.json";
/// Wave numbers and attenuations over the frequency.
pub const PICTURE: &str = "bands.svg";

const COLUMNS: [&str; 9] = [
    "frequency [Hz]",
    "wave number [rad/cell]",
    "attenuation [Np/cell]",
    "attenuation [dB/cell]",
    "bending [1]",
    "stretch [1]",
    "fluid [1]",
    "motion",
    "error [1]",
];

/// The text of `bands.csv`.
fn csv(found: &BandsRecord) -> String {
    let row = |wave: &WaveRecord| {
        let EnergyRecord { motion, shares } = wave.energy;
        let numbers = [
            wave.frequency_hz,
            wave.real,
            wave.imag,
            wave.attenuation_db,
            shares.bending,
            shares.stretch,
            shares.fluid,
        ];
        let error = wave.error.map_or_else(String::new, shortest);
        numbers
            .map(shortest)
            .into_iter()
            .chain([motion.name().into(), error])
            .collect::<Vec<String>>()
    };
    records::text(COLUMNS, found.waves.iter().map(row))
}

/// Tables of gaps and of standing waves.
pub fn describe(found: &BandsRecord) -> String {
    let [from, to] = found.band_hz.map(|hz| significant(hz, 4));
    let cell = match found.segments_per_cell {
        1 => "a segment".into(),
        segments => format!("{segments} segments"),
    };
    let mut text = format!(
        "{}: waves from {from} to {to} Hz, cell of {cell}, {} m\n\n",
        found.case,
        significant(found.cell_length_m, 4)
    );
    text += &table(
        " | >gap | from [Hz] | to [Hz] | width | deepest [Hz] | [dB per cell]",
        found.gaps.iter().map(|gap| gap_row(found, gap)).collect::<Vec<_>>(),
    );
    if found.gaps.is_empty() {
        text += "  none\n";
    }
    text.push('\n');
    text += &table(
        " | >standing wave | phase per cell | [Hz] | damping ratio | error",
        found.standing.iter().map(mode_row).collect::<Vec<_>>(),
    );
    text.push('\n');
    for strongest in &found.strongest {
        let _ = writeln!(
            text,
            "{}: the least attenuated wave loses at most {} dB per cell, at {} Hz",
            strongest.motion.name(),
            significant(strongest.attenuation_db, 3),
            significant(strongest.frequency_hz, 5)
        );
    }
    if let Some(coupling) = found.coupling_number {
        let _ = writeln!(
            text,
            "coupling number {}: sealed bladders raise bending frequencies by {}",
            significant(coupling, 4),
            error_percent((1.0 - coupling).powf(-0.5) - 1.0)
        );
    }
    if !found.reciprocal {
        text += "waves toward the tip and toward the root differ: both are listed, those toward the root with negative attenuation\n";
    }
    text + &warnings(&found.warnings)
}

fn gap_row(found: &BandsRecord, gap: &GapRecord) -> [String; 7] {
    let edge = |hz: f64, error: Option<f64>, band: f64| match error {
        None if hz == band => format!("{} (band)", significant(hz, 6)),
        None => format!("{} ± ?", significant(hz, 6)),
        Some(error) => format!("{} ± {}", significant(hz, 7), significant(error, 1)),
    };
    [
        String::new(),
        gap.motion.name().into(),
        edge(gap.from_hz, gap.from_error_hz, found.band_hz[0]),
        edge(gap.to_hz, gap.to_error_hz, found.band_hz[1]),
        error_percent(gap.relative_width()),
        significant(gap.deepest_hz, 5),
        significant(gap.attenuation_db, 3),
    ]
}

fn mode_row(mode: &LatticeModeRecord) -> [String; 6] {
    [
        String::new(),
        mode.energy.motion.name().into(),
        if mode.wave_number == 0.0 {
            "0".into()
        } else {
            "π".into()
        },
        significant(mode.frequency_hz, 7),
        significant(mode.damping_ratio, 3),
        mode.error_hz
            .map_or_else(String::new, |error| error_percent(error / mode.frequency_hz)),
    ]
}

/// Writes the files into a folder.
///
/// # Errors
/// A file cannot be written.
pub fn write(folder: &mut ResultFolder, found: &BandsRecord) -> Result<()> {
    let files = [(CSV, csv(found)), (JSON, results::text(found))];
    folder.fill(files, [(PICTURE, picture(found).svg())])
}

/// Largest attenuation that is drawn [dB per cell].
pub const DRAWN: f64 = 30.0;

fn colour(motion: WaveMotion) -> Colour {
    PALETTE[match motion {
        WaveMotion::Bending => 0,
        WaveMotion::Fluid => 1,
        WaveMotion::Stretch => 2,
    }]
}

/// Picture of wave number and attenuation over frequency, with gaps of bending shaded.
fn picture(found: &BandsRecord) -> Picture {
    let [from, to] = found.band_hz;
    let x = || PictureAxis::new("frequency", "Hz", 8).between(from, to);
    let gaps = |top: f64| {
        let bending = found.gaps.iter().filter(|gap| gap.motion == WaveMotion::Bending);
        let shade = move |gap: &GapRecord| {
            PictureSeries::shade(
                &[(gap.from_hz, 0.0, top), (gap.to_hz, 0.0, top)],
                colour(WaveMotion::Bending),
            )
        };
        bending.map(shade).collect::<Vec<_>>()
    };
    let marks = |of: &dyn Fn(&WaveRecord) -> Option<f64>, named: bool| {
        let series = WaveMotion::ALL.into_iter().filter_map(|motion| {
            let waves = found.waves.iter().filter(|wave| wave.energy.motion == motion);
            let points: Vec<(f64, f64)> = waves.filter_map(|wave| Some((wave.frequency_hz, of(wave)?))).collect();
            let any = !points.is_empty();
            let marks = PictureSeries::marks(points, Glyph::Square(1.1), colour(motion));
            any.then(|| if named { marks.named(motion.name()) } else { marks })
        });
        series.collect::<Vec<_>>()
    };
    let drawn = found
        .waves
        .iter()
        .map(|wave| wave.attenuation_db.abs())
        .filter(|decibel| *decibel <= DRAWN);
    let top = (1.1 * drawn.fold(1.0, f64::max)).min(DRAWN);
    // strongly attenuated waves have no visible wave number
    let lag = |wave: &WaveRecord| (wave.attenuation_db.abs() < DRAWN).then(|| wave.real.abs() / PI);
    let decay = |wave: &WaveRecord| Some(wave.attenuation_db.abs()).filter(|decibel| *decibel <= DRAWN);
    let fractions = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| (share, format!("{share}")));
    let y = PictureAxis {
        labels: Some(fractions.to_vec()),
        ..PictureAxis::new("phase per cell over π", "", 5).between(0.0, 1.0)
    };
    let panels = [
        Panel::new(
            (620.0, 230.0),
            x(),
            y,
            gaps(1.0).into_iter().chain(marks(&lag, true)).collect(),
        ),
        Panel::new(
            (620.0, 170.0),
            x(),
            PictureAxis::new("attenuation per cell", "dB", 6).between(0.0, top),
            gaps(top).into_iter().chain(marks(&decay, false)).collect(),
        ),
    ];
    Picture::stacked(
        format!("{} · bands", found.case),
        "waves by their largest energy; gaps of bending shaded",
        panels,
    )
}
