//! `slcbeam bands`: Bloch waves of a beam whose cells repeat.

use std::f64::consts::TAU;
use std::process::ExitCode;

use clap::Args;

use super::arguments::{CaseArguments, ResultArguments};
use super::response::check_band;
use super::{resources, terminal};
use crate::error::numbers::{counted, error_percent};
use crate::error::{Code, Result};
use crate::output::band_structure as files;
use crate::output::kind::FolderKind;
use crate::output::report;
use crate::results;
use crate::results::bands::{AttenuationRecord, BandsRecord, GapRecord, LatticeModeRecord, WaveMotion, WaveRecord};
use crate::run::bands::waves::Lattice;
use crate::run::control_loop;
use crate::study::bands::{
    BandGap, BandMode, BandStructure, BandWave, bands as compute, coupling_number, decibel, spectrum,
};

/// `bands`.
#[derive(Debug, Args)]
pub struct BandsArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// First frequency [Hz]
    #[arg(long, value_name = "HZ", default_value_t = 1.0, allow_negative_numbers = true, value_parser = crate::cli::progress_line::frequency)]
    pub from: f64,
    /// Last frequency [Hz]
    #[arg(long, value_name = "HZ", default_value_t = 200.0, allow_negative_numbers = true, value_parser = crate::cli::progress_line::frequency)]
    pub to: f64,
    /// Equally spaced frequencies; more are added between standing waves, where gaps are
    #[arg(long, value_name = "COUNT", default_value_t = 200, value_parser = crate::cli::progress_line::count)]
    pub points: usize,
    /// Folder, time limit and output.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print bands.json instead of the tables
    #[arg(long)]
    pub json: bool,
}

/// Damping ratio below which damping is a rounding error.
const ROUNDING: f64 = 1e-12;
/// Relative error of a standing wave above which a warning is issued.
const LARGE: f64 = 0.05;

/// Computes the waves, writes the folder, prints gaps and standing waves.
pub fn bands(asked: &BandsArguments) -> Result<ExitCode> {
    let band = [asked.from, asked.to];
    check_band(band, asked.points, asked.from < asked.to, "below")?;
    let case = resources::load(&asked.case)?;
    case.single("bands")?;
    // a beam without a repeating cell is reported before a folder is created
    let lattice = Lattice::new(&case)?;
    let mut folder = asked.result.place.claim(&case, FolderKind::Bands)?;
    asked.result.wall.flag();
    if !asked.result.quiet {
        terminal::print_line(&format!("waves of {}", case.name));
    }
    let found = compute(&case, lattice, band, asked.points, true)?;
    let answer = answer(&case.name, band, &found);
    let written = files::write(&mut folder, &answer).and(report::complete(&folder, &case));
    let (text, words) = (|| results::text(&answer), || files::describe(&answer));
    super::print_result(asked.json, folder.dir(), written, text, words)
}

fn answer(case: &str, band: [f64; 2], found: &BandStructure) -> BandsRecord {
    let (about, cell) = (&found.lattice.about, &found.lattice.cell);
    let modes = |all: &[BandMode]| -> Vec<LatticeModeRecord> { all.iter().map(mode).collect() };
    let (standing, spectrum) = (modes(&found.standing), modes(&spectrum(&found.lattice, band)));
    let mut warnings = control_loop::held(about.system());
    if let Some(first) = cell.others.first() {
        warnings.push(Code::OtherCells.warning(format!(
            "{} of the beam differ from those in its middle, the first at segment {}: the waves are those of the middle",
            counted(cell.others.len() as u64, "cell"),
            first + 1
        )));
    }
    if about.moving() {
        warnings.push(Code::NotAtRest.warning(
            "the start is not an equilibrium: the beam would start to move under its loads. The waves are those of the beam \
             as it starts.",
        ));
    }
    if let Some(growing) = standing.iter().chain(&spectrum).find(|mode| mode.damping_ratio < -1e-6) {
        warnings.push(Code::Growth.warning(format!(
            "waves near {:.4} Hz grow: the waves at real frequencies are not those of a steady state",
            growing.frequency_hz
        )));
    }
    warnings.extend(about.range.iter().cloned());
    let unknown = found.unknown.iter().map(|why| format!("not known: {why}"));
    let of_mode = |mode: &LatticeModeRecord| Some((mode.error_hz? / mode.frequency_hz, mode.frequency_hz));
    let worst = standing.iter().filter_map(of_mode).max_by(|a, b| a.0.total_cmp(&b.0));
    let worst = worst.map(|(error, hz)| (error, format!("the standing wave at {hz:.4} Hz")));
    let of_wave = |wave: &BandWave| Some(wave.error? / wave.wave_number.norm());
    let mut errors: Vec<f64> = found.waves.iter().filter_map(of_wave).collect();
    errors.sort_by(f64::total_cmp);
    let median = errors
        .get(errors.len() / 2)
        .map(|error| (*error, "wave numbers (median)".into()));
    let large = worst.into_iter().chain(median).filter(|(error, _)| *error > LARGE);
    let coarse = large.map(|(error, of)| {
        format!(
            "error of {of} by the mesh: {}. Use a finer mesh (/mesh/cells_per_segment, /mesh/cells_per_bladder) or a lower --to",
            error_percent(error)
        )
    });
    warnings.extend(unknown.chain(coarse).map(|what| Code::ErrorEstimate.warning(what)));
    let strongest = [WaveMotion::Bending, WaveMotion::Stretch]
        .into_iter()
        .zip(found.strongest);
    let strongest = strongest.map(|(motion, strongest)| {
        strongest.map(|one| AttenuationRecord {
            motion,
            frequency_hz: one.frequency_hz,
            attenuation_db: decibel(one.attenuation),
        })
    });
    BandsRecord {
        case: case.into(),
        segments_per_cell: cell.segments,
        cell_length_m: cell.length,
        unknowns: cell.len(),
        coupling_number: coupling_number(&found.lattice),
        reciprocal: found.reciprocal,
        band_hz: band,
        strongest: strongest.into_iter().flatten().collect(),
        gaps: found.gaps.iter().map(gap).collect(),
        standing,
        waves: found.waves.iter().map(wave).collect(),
        spectrum,
        warnings,
    }
}

fn wave(wave: &BandWave) -> WaveRecord {
    WaveRecord {
        frequency_hz: wave.frequency_hz,
        real: wave.wave_number.re,
        imag: wave.wave_number.im,
        attenuation_db: decibel(wave.wave_number.im),
        error: wave.error,
        energy: wave.energy.into(),
    }
}

fn gap(gap: &BandGap) -> GapRecord {
    GapRecord {
        motion: if gap.motion.stretch {
            WaveMotion::Stretch
        } else {
            WaveMotion::Bending
        },
        from_hz: gap.edges[0],
        to_hz: gap.edges[1],
        from_error_hz: gap.errors[0],
        to_error_hz: gap.errors[1],
        attenuation_db: decibel(gap.attenuation),
        deepest_hz: gap.deepest_hz,
    }
}

fn mode(mode: &BandMode) -> LatticeModeRecord {
    LatticeModeRecord {
        wave_number: mode.wave_number,
        frequency_hz: mode.s.im / TAU,
        damping_ratio: if mode.s.re.abs() < ROUNDING * mode.s.norm() {
            0.0
        } else {
            -mode.s.re / mode.s.norm()
        },
        error_hz: mode.error.map(|error| error / TAU),
        energy: mode.energy.into(),
    }
}
