//! `bands.json`: waves of a repeating cell.

use serde::{Deserialize, Serialize};

use super::ResultFile;
use crate::run::bands::waves::WaveEnergy;
pub use crate::run::bands::waves::WaveMotion;

/// Waves of the repeating cell of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BandsRecord {
    /// Name of the case.
    pub case: String,
    /// Segments of a cell.
    pub segments_per_cell: usize,
    /// Length of a cell [m].
    pub cell_length_m: f64,
    /// Unknowns of a cell.
    pub unknowns: usize,
    /// Share of bending stiffness that the fluid of sealed bladders adds; null without bladders.
    pub coupling_number: Option<f64>,
    /// True if waves in both directions have the same wave numbers; then only those toward the tip are listed.
    pub reciprocal: bool,
    /// First and last frequency [Hz].
    pub band_hz: [f64; 2],
    /// Largest attenuation of the wave that is attenuated least, of bending and of stretch.
    pub strongest: Vec<AttenuationRecord>,
    /// Gaps in ascending order of frequency.
    pub gaps: Vec<GapRecord>,
    /// Oscillations of wave numbers 0 and π.
    pub standing: Vec<LatticeModeRecord>,
    /// Waves in ascending order of frequency and attenuation.
    pub waves: Vec<WaveRecord>,
    /// Oscillations over the wave number.
    pub spectrum: Vec<LatticeModeRecord>,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl ResultFile for BandsRecord {}

/// Shares of bending, stretch and fluid in the energy of a wave.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergyRecord {
    /// Motion with the largest energy.
    pub motion: WaveMotion,
    /// The shares.
    #[serde(flatten)]
    pub shares: WaveEnergy,
}

impl From<WaveEnergy> for EnergyRecord {
    fn from(shares: WaveEnergy) -> Self {
        Self {
            motion: shares.motion(),
            shares,
        }
    }
}

/// A wave at a frequency; from cell to cell it is multiplied by `exp(-i real - imag)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WaveRecord {
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Phase lag per cell [rad].
    pub real: f64,
    /// Attenuation per cell [neper].
    pub imag: f64,
    /// Attenuation per cell [dB].
    pub attenuation_db: f64,
    /// Estimated mesh error of the wave number; null if unknown.
    pub error: Option<f64>,
    /// Its energy.
    #[serde(flatten)]
    pub energy: EnergyRecord,
}

/// Largest attenuation in the band of the least attenuated wave of a motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AttenuationRecord {
    /// Motion: bending (with the fluid that it moves) or stretch.
    pub motion: WaveMotion,
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Attenuation per cell [dB].
    pub attenuation_db: f64,
}

/// A band of frequencies in which no wave of one motion passes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GapRecord {
    /// Motion: bending (with the fluid that it moves) or stretch.
    pub motion: WaveMotion,
    /// Lower edge [Hz].
    pub from_hz: f64,
    /// Upper edge [Hz].
    pub to_hz: f64,
    /// Estimated mesh error of the lower edge [Hz]; null if the gap begins below the band, or if unknown.
    pub from_error_hz: Option<f64>,
    /// Estimated mesh error of the upper edge [Hz]; null if the gap ends above the band, or if unknown.
    pub to_error_hz: Option<f64>,
    /// Largest attenuation per cell of the least attenuated wave [dB].
    pub attenuation_db: f64,
    /// Its frequency [Hz].
    pub deepest_hz: f64,
}

impl GapRecord {
    /// Width over the middle frequency.
    pub fn relative_width(&self) -> f64 {
        2.0 * (self.to_hz - self.from_hz) / (self.to_hz + self.from_hz)
    }
}

/// An oscillation with a real wave number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LatticeModeRecord {
    /// Wave number per cell [rad].
    pub wave_number: f64,
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Damping ratio; below 0: grows.
    pub damping_ratio: f64,
    /// Estimated mesh error of the frequency [Hz]; null if it was not computed.
    pub error_hz: Option<f64>,
    /// Its energy.
    #[serde(flatten)]
    pub energy: EnergyRecord,
}
