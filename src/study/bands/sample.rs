//! Waves at a frequency, extrapolated from several meshes.

use nalgebra::Complex;

use super::{BandWave, SAME, extrapolated, is_lossless};
use crate::run::bands::waves::{BlochWave, MOST, WaveEnergy};

/// Waves at a frequency on the mesh, with energies, and on others.
pub struct Sample {
    /// Frequency [Hz].
    pub hz: f64,
    /// True if rounding errors hide waves.
    pub lost: bool,
    /// Waves of the case's mesh.
    pub own: Vec<(WaveEnergy, BlochWave)>,
    /// Waves of other meshes, with the factors of the differences.
    pub others: Vec<(Vec<BlochWave>, f64)>,
}

impl Sample {
    /// Largest relative difference of `sin²(μ/2)` of a wave and the nearest other one, 0 if each has a reverse.
    pub fn asymmetry(&self) -> f64 {
        let all: Vec<Complex<f64>> = self.own.iter().map(|(_, wave)| smooth(wave)).collect();
        let listed = (0..all.len()).filter(|k| self.own[*k].1.wave_number().im.abs() < 0.9 * MOST);
        let nearest = |k: usize| {
            let others = (0..all.len()).filter(|j| *j != k);
            others
                .map(|j| (all[j] - all[k]).norm() / all[k].norm())
                .fold(1.0, f64::min)
        };
        listed.map(nearest).fold(0.0, f64::max)
    }

    /// Waves with extrapolated wave numbers, the least attenuated first; of each wave and its reverse only that toward the tip.
    pub fn extrapolated(&self, reciprocal: bool) -> Vec<BandWave> {
        let toward_tip = |number: Complex<f64>, rounding: f64| match is_lossless(number, rounding) {
            true => number.re >= 0.0,
            false => number.im > 0.0,
        };
        let own = self.own.iter();
        let own = own.filter(|(_, wave)| !reciprocal || toward_tip(wave.wave_number(), wave.rounding));
        let mut all: Vec<BandWave> = own.map(|(energy, wave)| self.wave(wave, *energy, reciprocal)).collect();
        // strongly attenuated waves that only one mesh has are those of its difference formulas
        all.retain(|wave| self.others.is_empty() || wave.error.is_some() || wave.on_mesh.im.abs() < 1.0);
        all.sort_by(|a, b| a.wave_number.im.abs().total_cmp(&b.wave_number.im.abs()));
        all
    }

    /// Extrapolates `sin²(μ/2)`, which is smooth at the edges of gaps and has one value for a wave and its reverse; without reciprocity λ.
    fn wave(&self, wave: &BlochWave, energy: WaveEnergy, reciprocal: bool) -> BandWave {
        let smooth = |wave: &BlochWave| if reciprocal { smooth(wave) } else { wave.factor };
        let own = smooth(wave);
        let near = |(waves, by): &(Vec<BlochWave>, f64)| {
            let all = waves.iter().map(smooth);
            let near = all.min_by(|a, b| (a - own).norm().total_cmp(&(b - own).norm()));
            (
                near.filter(|near| (near - own).norm() < SAME * own.norm().max(near.norm())),
                *by,
            )
        };
        let whole = extrapolated(own, self.others.iter().map(near));
        let number = |smooth: Complex<f64>| match reciprocal {
            true => (smooth.sqrt().asin() * 2.0).conj(),
            false => Complex::new(-smooth.arg(), -smooth.norm().ln()),
        };
        let number_on_mesh = wave.wave_number();
        let sign = if is_lossless(number_on_mesh, wave.rounding) {
            1.0
        } else {
            number_on_mesh.re.signum()
        };
        let folded = |number: Complex<f64>| match reciprocal {
            true => Complex::new(number.re.abs() * sign, number.im.abs()),
            false => number,
        };
        let on_mesh = folded(number_on_mesh);
        let whole = whole.map(|(whole, _)| folded(number(whole)));
        BandWave {
            frequency_hz: self.hz,
            wave_number: whole.unwrap_or(on_mesh),
            on_mesh,
            rounding: wave.rounding,
            error: whole.map(|whole| (whole - on_mesh).norm() + wave.rounding),
            energy,
        }
    }
}

/// `sin²(μ/2)` of a wave.
fn smooth(wave: &BlochWave) -> Complex<f64> {
    (wave.wave_number().conj() * 0.5).sin().powi(2)
}
