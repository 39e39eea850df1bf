//! Band structure of a beam whose cells repeat: waves over a band of frequencies, gaps, standing waves, and errors by the meshes.
//!
//! ```text
//! sample    waves at a frequency, extrapolated
//! gaps      frequencies at which no wave of a motion passes
//! ```

mod gaps;
mod sample;

use std::f64::consts::{PI, TAU};

use nalgebra::Complex;

use self::gaps::BandMotion;
pub use self::gaps::GapMotion;
use self::sample::Sample;
use super::in_halves;
use super::refine::finer_along_bladders;
use crate::case::Case;
use crate::error::{Error, Result};
use crate::integrate::halt;
use crate::run::bands::waves::{BlochWave, Lattice, WaveEnergy};

/// Attenuation [neper per cell] below which a wave passes without loss: relative to its phase lag, and at least.
const LOSSLESS: (f64, f64) = (1e-7, 1e-9);
/// Rounding error of a wave number, relative to it, above which a wave is left out.
const ROUNDING: f64 = 0.01;
/// Largest relative difference of a wave on two meshes.
const SAME: f64 = 0.25;
/// Median over the samples of the relative difference of waves in both directions below which a cell is reciprocal.
const RECIPROCAL: f64 = 1e-6;
/// Oscillations in the lowest band, its last frequency over the highest of them, and the damping ratio below which they count.
const LOWEST: usize = 4;
const BEYOND: f64 = 1.3;
const STRONG: f64 = 0.5;
/// Frequency of rigid motion, rounding errors, over the lowest of wave number π.
const RIGID: f64 = 1e-3;
/// Wave numbers from 0 to π of the spectrum.
const SPECTRUM: usize = 33;
/// Difference from a mesh of half the cells over the error: of the beam by its order, of bladders.
const OF_BEAM: [f64; 2] = [4.0 / 3.0, 16.0 / 15.0];
const OF_BLADDERS: f64 = 4.0 / 3.0;

/// A wave at a frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandWave {
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Phase lag per cell [rad] and attenuation per cell [neper], extrapolated.
    pub wave_number: Complex<f64>,
    /// The same on the mesh.
    pub on_mesh: Complex<f64>,
    /// Bound of its rounding error.
    pub rounding: f64,
    /// Estimated error of the wave number on the mesh; unknown if another mesh has no such wave.
    pub error: Option<f64>,
    /// Shares of its energy.
    pub energy: WaveEnergy,
}

/// A frequency of a real wave number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandMode {
    /// Wave number per cell [rad].
    pub wave_number: f64,
    /// Eigenvalue s [1/s], extrapolated if its error is known.
    pub s: Complex<f64>,
    /// The same on the mesh.
    pub on_mesh: Complex<f64>,
    /// Estimated error of s on the mesh [1/s]; none if it was not computed.
    pub error: Option<f64>,
    /// Shares of its energy.
    pub energy: WaveEnergy,
}

/// A band of frequencies in which no wave of one motion passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandGap {
    /// Waves that do not pass.
    pub motion: GapMotion,
    /// Edges on the mesh [Hz]; none for an edge of the band.
    pub on_mesh: [Option<f64>; 2],
    /// Wave numbers of the oscillations that its edges are, without losses.
    pub standing: [Option<f64>; 2],
    /// Edges [Hz], extrapolated; those of the band that was computed if the gap extends beyond it.
    pub edges: [f64; 2],
    /// Estimated errors of the edges on the mesh [Hz]; unknown for an edge of the band and if another mesh has no such edge.
    pub errors: [Option<f64>; 2],
    /// Frequency of the largest attenuation among the samples [Hz].
    pub deepest_hz: f64,
    /// Attenuation there of the wave that is attenuated least [neper per cell].
    pub attenuation: f64,
}

/// Largest attenuation of the wave of a motion that is attenuated least.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrongestAttenuation {
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Attenuation [neper per cell].
    pub attenuation: f64,
}

/// Waves of a cell over a band of frequencies.
pub struct BandStructure {
    /// The beam and its cell.
    pub lattice: Lattice,
    /// True if every wave has a reverse with the same attenuation; only one of both is listed.
    pub reciprocal: bool,
    /// Of bending and of stretch, if there are such waves, the largest attenuation among the samples of the wave that is attenuated least.
    pub strongest: [Option<StrongestAttenuation>; 2],
    /// Waves in ascending order of frequency and attenuation.
    pub waves: Vec<BandWave>,
    /// Gaps in ascending order of frequency.
    pub gaps: Vec<BandGap>,
    /// Oscillations of wave numbers 0 and π, in ascending order of frequency.
    pub standing: Vec<BandMode>,
    /// Reasons why errors are unknown.
    pub unknown: Vec<String>,
}

/// Share of bending in a beam of one uniform section that the fluid of sealed bladders adds, `κ = Σ EI φ_b l_b A_M'²/a_p` over the rows
/// (with a_x by the inverse of both compliances); none without bladders.
pub fn coupling_number(lattice: &Lattice) -> Option<f64> {
    let system = lattice.about.system();
    let (wet, segment) = (system.model.wet.as_ref()?, lattice.cell.first);
    let ratio = wet.length_ratio_of(segment, system.model.length);
    let node = segment * system.mesh.cells_per_segment;
    let stiffness = system.sections.bending[node];
    let rows = wet.pair(segment).into_iter().filter(|bladder| wet.has(*bladder));
    // the rows bend to opposite sides
    let sides = [1.0, -1.0].into_iter();
    let rows = rows.map(|bladder| wet.area_of(bladder)).zip(sides);
    let rows: Vec<(f64, f64)> = rows
        .map(|(law, side)| (side * law.moment_mean, law.per_pressure))
        .collect();
    let own = by_sealing(&rows, wet.per_other_pressure_of(segment))?;
    Some(stiffness * ratio * own)
}

/// `aᵀ P⁻¹ a` of one row of bladders, or two, with the areas a by a moment and P by pressures, each row with its entries; `other` is the
/// area by the pressure in the other row. None without rows.
pub fn by_sealing(rows: &[(f64, f64)], other: f64) -> Option<f64> {
    match *rows {
        [(a, p)] => Some(a * a / p),
        [(a, p), (b, q)] => Some((a * a * q - 2.0 * other * a * b + b * b * p) / (p * q - other * other)),
        _ => None,
    }
}

/// Band from 1e-3 of its last frequency [Hz], which is above the lowest oscillations of wave numbers 0 and π: their first gaps are in it.
/// None if nothing oscillates.
pub fn lowest_band(lattice: &Lattice) -> Option<[f64; 2]> {
    let wide = [1e-6, 1e6].map(|part| part * lattice.about.frequency() / TAU);
    let swinging = |wave_number: f64| {
        let all = modes_at(lattice, wave_number, wide).into_iter();
        let swinging = all.filter(|mode| mode.s.re.abs() < STRONG * mode.s.norm());
        swinging.map(|mode| mode.s.im / TAU).collect::<Vec<f64>>()
    };
    let mut at = swinging(PI);
    let least = RIGID * at.iter().copied().fold(f64::INFINITY, f64::min);
    // cells that move alike may move as a rigid beam
    at.extend(swinging(0.0).into_iter().filter(|hz| *hz > least));
    at.sort_by(f64::total_cmp);
    let last = at.get(LOWEST - 1).or(at.last())?;
    Some([1e-3, 1.0].map(|part| part * BEYOND * last))
}

/// Computes the waves of a case between two frequencies [Hz], at equally spaced samples and at those that separate gaps; `compared` with
/// those of other meshes.
///
/// # Errors
/// The case has no repeating cell, [`Lattice::new`]; or an interruption.
pub fn bands(case: &Case, lattice: Lattice, band: [f64; 2], points: usize, compared: bool) -> Result<BandStructure> {
    let mut unknown = vec![];
    let mut others = vec![];
    let meshes = if compared {
        meshes(case, lattice.about.system().mesh.fourth)?
    } else {
        vec![]
    };
    for (other, factor) in meshes {
        match Lattice::new(&other) {
            Ok(lattice) => others.push((lattice, factor)),
            Err(interrupted @ Error::Interrupted(_)) => return Err(interrupted),
            Err(fault) => unknown.push(fault.to_string()),
        }
    }
    let all = Meshes { own: &lattice, others };
    let standing = all.standing(band);
    let frequencies = samples(band, points, &standing);
    let at = |hz: &f64| match halt::asked() {
        true => Err(Error::Interrupted(
            "interrupted before the waves were computed; nothing is written".into(),
        )),
        false => Ok(all.at(*hz)),
    };
    let samples = in_halves(&frequencies, |part| part.iter().map(at).collect())?;
    let lost = samples.iter().filter(|sample| sample.lost).count();
    if lost > 0 {
        unknown.push(format!(
            "waves at {lost} of {} frequencies: rounding errors hide them in so short cells. Use fewer /mesh/cells_per_segment, or a higher --from",
            samples.len()
        ));
    }
    let mut asymmetries: Vec<f64> = samples.iter().map(Sample::asymmetry).collect();
    asymmetries.sort_by(f64::total_cmp);
    // single samples beside a resonance may have large rounding errors
    let reciprocal = asymmetries[asymmetries.len() / 2] < RECIPROCAL;
    let waves: Vec<Vec<BandWave>> = samples.iter().map(|sample| sample.extrapolated(reciprocal)).collect();
    // where waves are hidden, no gap is known
    let whole = samples.iter().zip(&waves).filter(|(sample, _)| !sample.lost);
    let (at, seen): (Vec<f64>, Vec<&Vec<BandWave>>) = whole.map(|(sample, waves)| (sample.hz, waves)).unzip();
    let mut gaps = vec![];
    let strongest = [false, true].map(|stretch| {
        let motion = BandMotion::new(&all, stretch, &standing, &at, &seen);
        gaps.extend(motion.gaps());
        motion.strongest()
    });
    gaps.sort_by(|a, b| a.edges[0].total_cmp(&b.edges[0]));
    Ok(BandStructure {
        reciprocal,
        strongest,
        waves: waves.into_iter().flatten().collect(),
        gaps,
        standing,
        unknown,
        lattice,
    })
}

/// Oscillations in a band [Hz] over the wave number, from 0 to π.
pub fn spectrum(lattice: &Lattice, band: [f64; 2]) -> Vec<BandMode> {
    let wave_numbers = (0..SPECTRUM).map(|k| PI * k as f64 / (SPECTRUM - 1) as f64);
    wave_numbers
        .flat_map(|wave_number| modes_at(lattice, wave_number, band))
        .collect()
}

/// Cases of the meshes that a result is compared with, and the factors of the differences: twice the cells of the beam, and of bladders.
fn meshes(case: &Case, fourth: bool) -> Result<Vec<(Case, f64)>> {
    let mut finer = case.clone();
    finer.mesh.cells_per_segment *= 2;
    let mut all = vec![(finer, OF_BEAM[usize::from(fourth)])];
    all.extend(finer_along_bladders(case)?.map(|finer| (finer, OF_BLADDERS)));
    Ok(all)
}

/// Equally spaced frequencies, and those at and between oscillations of wave numbers 0 and π, since edges of gaps are there.
fn samples(band: [f64; 2], points: usize, standing: &[BandMode]) -> Vec<f64> {
    let step = (band[1] - band[0]) / (points.max(2) - 1) as f64;
    let mut all: Vec<f64> = (0..points).map(|k| band[0] + k as f64 * step).collect();
    let mut at: Vec<f64> = standing.iter().map(|mode| mode.on_mesh.im / TAU).collect();
    at.sort_by(f64::total_cmp);
    all.extend(at.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])));
    all.retain(|hz| (band[0]..=band[1]).contains(hz));
    all.push(band[1]);
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| *a <= *b * (1.0 + 1e-9));
    all
}

/// A beam on several meshes, with the factors of the differences from its own one.
struct Meshes<'a> {
    own: &'a Lattice,
    others: Vec<(Lattice, f64)>,
}

impl Meshes<'_> {
    /// Waves at a frequency.
    fn at(&self, hz: f64) -> Sample {
        let all = self.own.waves(Complex::new(0.0, TAU * hz)).into_iter();
        let (rounded, own): (Vec<_>, Vec<_>) = all.partition(is_rounded);
        Sample {
            hz,
            lost: !rounded.is_empty(),
            own: own.into_iter().map(|wave| (self.own.energy(&wave), wave)).collect(),
            others: self
                .others
                .iter()
                .map(|(other, by)| (waves_at(other, hz), *by))
                .collect(),
        }
    }

    /// Oscillations of wave numbers 0 and π with errors, in ascending order of frequency.
    fn standing(&self, band: [f64; 2]) -> Vec<BandMode> {
        let wide = [0.5 * band[0], 1.5 * band[1]];
        let mut all = vec![];
        for wave_number in [0.0, PI] {
            let own = modes_at(self.own, wave_number, band);
            let others = self.others.iter();
            let others: Vec<(Vec<Option<BandMode>>, f64)> = others
                .map(|(other, by)| (partners(&own, &modes_at(other, wave_number, wide)), *by))
                .collect();
            let whole = |(k, mode): (usize, &BandMode)| {
                let partners = others
                    .iter()
                    .map(|(partners, by)| (partners[k].map(|partner| partner.s), *by));
                let known = extrapolated(mode.s, partners);
                let known = known.filter(|(s, error)| *error < SAME * mode.s.norm() && s.im > 0.0);
                BandMode {
                    s: known.map_or(mode.s, |(s, _)| s),
                    error: known.map(|(_, error)| error),
                    ..*mode
                }
            };
            all.extend(own.iter().enumerate().map(whole));
        }
        all.sort_by(|a, b| a.s.im.total_cmp(&b.s.im));
        all
    }
}

/// A value with those of other meshes and the factors of the differences: extrapolated, and the sum of the corrections. None without
/// other meshes, or if one of them has no such value.
fn extrapolated(
    own: Complex<f64>,
    others: impl Iterator<Item = (Option<Complex<f64>>, f64)>,
) -> Option<(Complex<f64>, f64)> {
    let corrections: Option<Vec<Complex<f64>>> = others.map(|(other, by)| Some((other? - own) * by)).collect();
    let corrections = corrections.filter(|all| !all.is_empty())?;
    let error = corrections.iter().map(|correction| correction.norm()).sum();
    Some((own + corrections.iter().sum::<Complex<f64>>(), error))
}

/// Oscillations of another mesh that belong to those of a mesh, each to at most one: the nearest of the same motion.
fn partners(own: &[BandMode], others: &[BandMode]) -> Vec<Option<BandMode>> {
    let mut left: Vec<&BandMode> = others.iter().collect();
    let partner = |mode: &BandMode| {
        let alike = |other: &BandMode| stretches(other.energy) == stretches(mode.energy);
        let near = left.iter().enumerate().filter(|(_, other)| alike(other));
        let (place, _) = near.min_by(|a, b| (a.1.s - mode.s).norm().total_cmp(&(b.1.s - mode.s).norm()))?;
        Some(*left.remove(place))
    };
    own.iter().map(partner).collect()
}

fn stretches(energy: WaveEnergy) -> bool {
    energy.stretch > energy.bending
}

/// Waves at a frequency, without those of which rounding errors leave no two digits.
fn waves_at(lattice: &Lattice, hz: f64) -> Vec<BlochWave> {
    let mut waves = lattice.waves(Complex::new(0.0, TAU * hz));
    waves.retain(|wave| !is_rounded(wave));
    waves
}

/// True if rounding errors leave no two digits of a wave number.
fn is_rounded(wave: &BlochWave) -> bool {
    wave.rounding > ROUNDING * wave.wave_number().norm()
}

/// True if a wave with this phase lag and attenuation, with a rounding error, passes without loss.
fn is_lossless(number: Complex<f64>, rounding: f64) -> bool {
    number.im.abs() <= (LOSSLESS.0 * number.re.abs()).max(LOSSLESS.1).max(rounding)
}

/// Attenuation in decibel of one in neper.
pub fn decibel(neper: f64) -> f64 {
    20.0 * neper / std::f64::consts::LN_10
}

/// Oscillations of a wave number in a band [Hz].
fn modes_at(lattice: &Lattice, wave_number: f64, band: [f64; 2]) -> Vec<BandMode> {
    let mode = |wave: BlochWave| BandMode {
        wave_number,
        s: wave.s,
        on_mesh: wave.s,
        error: None,
        energy: lattice.energy(&wave),
    };
    let found = lattice.frequencies(wave_number, band.map(|hz| TAU * hz));
    let mut all: Vec<BandMode> = found.into_iter().map(mode).collect();
    all.sort_by(|a, b| a.s.im.total_cmp(&b.s.im));
    all
}
