//! Gaps: frequencies at which no wave of a motion passes.

use std::convert::Infallible;
use std::f64::consts::TAU;

use nalgebra::Complex;

use super::{
    BandGap, BandMode, BandWave, Meshes, StrongestAttenuation, extrapolated, is_lossless, modes_at, stretches, waves_at,
};
use crate::integrate::halt;
use crate::numerics::golden_section;
use crate::run::bands::waves::{Lattice, WaveEnergy};

/// Attenuation of a gap with losses: 1 dB per cell, in neper.
const GAP: f64 = std::f64::consts::LN_10 / 20.0;
/// Attenuation [neper per cell] in a band without losses below which a wave passes: attenuation grows as a root beyond an edge.
const FAINT: f64 = 1e-3;
/// Share of a motion in the energy of a wave below which the wave does not count.
const SHARE: f64 = 1e-3;
/// Bisections of an edge, and the largest number of steps, in which its bracket doubles, from it to that on another mesh.
const BISECTIONS: usize = 50;
const DOUBLINGS: usize = 14;
const NEAR: f64 = 1e-5;
/// Largest relative distance of an edge without losses from the oscillation that it is.
const AT_EDGE: f64 = 1e-4;
/// Relative width below which a gap is a rounding error of one sample.
const NARROWEST: f64 = 1e-6;
/// Golden-section steps of the search for the strongest attenuation.
const STEPS: usize = 40;

/// Waves that count for the gaps of one motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapMotion {
    /// True for waves that mainly stretch the beam, false for those that bend it.
    pub stretch: bool,
    /// True if waves of this motion that pass have no losses.
    pub lossless: bool,
}

/// Waves of one motion over a band.
pub struct BandMotion<'a> {
    meshes: &'a Meshes<'a>,
    motion: GapMotion,
    /// Oscillations of this motion with wave numbers 0 and π.
    standing: Vec<BandMode>,
    frequencies: &'a [f64],
    /// Least attenuated wave at each frequency.
    least: Vec<Least>,
}

/// Wave of one motion that is attenuated least.
#[derive(Clone, Copy)]
struct Least {
    /// Attenuation [neper per cell]; infinite without waves.
    attenuation: f64,
    /// True if it passes without loss.
    passes: bool,
}

/// Edge of a gap [Hz] with its error [Hz].
#[derive(Clone, Copy)]
struct GapEdge {
    hz: f64,
    error: Option<f64>,
    /// Wave number of the oscillation that it is.
    standing: Option<f64>,
    /// True if it is not an edge of the band.
    inside: bool,
}

impl GapMotion {
    /// Least attenuated wave at a frequency.
    fn at(self, lattice: &Lattice, hz: f64) -> Least {
        let mut waves = waves_at(lattice, hz);
        waves.sort_by(|a, b| a.wave_number().im.abs().total_cmp(&b.wave_number().im.abs()));
        let own = waves.iter().find(|wave| belongs(lattice.energy(wave), self.stretch));
        Least::new(own.map(|wave| (wave.wave_number(), wave.rounding)), self.lossless)
    }

    fn passes(self, lattice: &Lattice, hz: f64) -> bool {
        self.at(lattice, hz).passes
    }

    /// Edge between a frequency in a gap and one outside [Hz].
    fn edge_between(self, lattice: &Lattice, mut inside: f64, mut outside: f64) -> f64 {
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (inside + outside);
            if halt::asked() || middle == inside || middle == outside {
                break;
            }
            let end = if self.passes(lattice, middle) {
                &mut outside
            } else {
                &mut inside
            };
            *end = middle;
        }
        0.5 * (inside + outside)
    }

    /// Edge near a frequency [Hz] of a gap that is toward higher ones (1) or lower ones (-1).
    fn edge_near(self, lattice: &Lattice, hz: f64, toward: f64) -> Option<f64> {
        let bracket = (0..DOUBLINGS).find_map(|k| {
            let by = toward * NEAR * hz * f64::from(1 << k);
            let found = !self.passes(lattice, hz + by) && self.passes(lattice, hz - by);
            found.then_some([hz + by, hz - by])
        });
        bracket.map(|[inside, outside]| self.edge_between(lattice, inside, outside))
    }

    /// Oscillation of a wave number near a frequency [Hz].
    fn standing_near(self, lattice: &Lattice, hz: f64, wave_number: f64) -> Option<f64> {
        let all = modes_at(lattice, wave_number, [0.9 * hz, 1.1 * hz]).into_iter();
        let own = all.filter(|mode| belongs(mode.energy, self.stretch));
        let found = own.map(|mode| mode.s.im / TAU);
        found.min_by(|a, b| (a - hz).abs().total_cmp(&(b - hz).abs()))
    }
}

impl BandGap {
    /// Its edges on the mesh [Hz], or those of the band.
    pub fn edges_on_mesh(&self) -> [f64; 2] {
        [0, 1].map(|k| self.on_mesh[k].unwrap_or(self.edges[k]))
    }

    /// Its edges [Hz] in a lattice that hardly differs from its own, on the mesh.
    pub fn edges_in(&self, lattice: &Lattice) -> [Option<f64>; 2] {
        let edge = |k: usize, hz: f64| match self.standing[k] {
            Some(wave_number) => self.motion.standing_near(lattice, hz, wave_number),
            None => self.motion.edge_near(lattice, hz, [1.0, -1.0][k]),
        };
        [0, 1].map(|k| self.on_mesh[k].and_then(|hz| edge(k, hz)))
    }
}

impl<'a> BandMotion<'a> {
    /// Waves of a motion among those of samples.
    pub fn new(
        meshes: &'a Meshes<'a>,
        stretch: bool,
        standing: &[BandMode],
        frequencies: &'a [f64],
        waves: &[&Vec<BandWave>],
    ) -> Self {
        let number = |waves: &&Vec<BandWave>| -> Option<(Complex<f64>, f64)> {
            let own = waves.iter().filter(|wave| belongs(wave.energy, stretch));
            least(own.map(|wave| (wave.on_mesh, wave.rounding)))
        };
        let numbers: Vec<Option<(Complex<f64>, f64)>> = waves.iter().map(number).collect();
        let passing = || numbers.iter().flatten().filter(|(number, _)| number.im.abs() <= GAP);
        // a motion has losses if most waves that pass have
        let lossless = 2 * passing()
            .filter(|(number, rounding)| is_lossless(*number, *rounding))
            .count()
            > passing().count();
        let motion = GapMotion { stretch, lossless };
        Self {
            meshes,
            motion,
            standing: standing
                .iter()
                .copied()
                .filter(|mode| belongs(mode.energy, stretch))
                .collect(),
            frequencies,
            least: numbers.into_iter().map(|number| Least::new(number, lossless)).collect(),
        }
    }

    /// Largest attenuation near a sample of a local maximum.
    fn refined(&self, sample: usize) -> StrongestAttenuation {
        let last = self.frequencies.len() - 1;
        let at = |hz: f64| self.motion.at(self.meshes.own, hz).attenuation;
        let around = [sample.saturating_sub(1), (sample + 1).min(last)].map(|k| self.frequencies[k]);
        let Ok(middle) = golden_section::maximum(around, STEPS, |hz| Ok::<_, Infallible>(at(hz)));
        let all = [
            (middle, at(middle)),
            (self.frequencies[sample], self.least[sample].attenuation),
        ];
        let [found, sampled] = all.map(|(frequency_hz, attenuation)| StrongestAttenuation {
            frequency_hz,
            attenuation,
        });
        let better = found.attenuation.is_finite() && found.attenuation > sampled.attenuation;
        if better { found } else { sampled }
    }

    fn strongest_of(&self, samples: impl Iterator<Item = usize>) -> Option<StrongestAttenuation> {
        let size = |k: &usize| self.least[*k].attenuation;
        let known = samples.filter(|k| size(k).is_finite());
        known
            .max_by(|a, b| size(a).total_cmp(&size(b)))
            .map(|k| self.refined(k))
    }

    /// Largest attenuation of the least attenuated wave; none without waves.
    pub fn strongest(&self) -> Option<StrongestAttenuation> {
        self.strongest_of(0..self.least.len())
    }

    /// Gaps in the band. An edge is where attenuation begins; with losses where it passes 1 dB.
    pub fn gaps(&self) -> Vec<BandGap> {
        let closed = |k: usize| self.least.get(k).is_some_and(|least| !least.passes);
        let begins = |k: &usize| closed(*k) && (*k == 0 || !closed(k - 1));
        let gap = |first: usize| {
            let behind = (first..).find(|k| !closed(*k)).unwrap_or(first);
            let edge = |inside: usize, outside: Option<usize>| match outside {
                None => [GapEdge::of_band(self.frequencies[inside]); 2],
                Some(outside) => self.edge(self.frequencies[inside], self.frequencies[outside]),
            };
            let both = [
                edge(first, first.checked_sub(1)),
                edge(behind - 1, Some(behind).filter(|k| *k < self.least.len())),
            ];
            // errors of a coarse mesh exceed the width of a narrow gap
            let ordered = both[0][1].hz < both[1][1].hz;
            let edges = both.map(|[own, extrapolated]| if ordered { extrapolated } else { own });
            let strongest = self.strongest_of(first..behind)?;
            Some(BandGap {
                motion: self.motion,
                on_mesh: both.map(|[own, _]| own.inside.then_some(own.hz)),
                standing: both.map(|[own, _]| own.standing),
                edges: edges.map(|edge| edge.hz),
                errors: edges.map(|edge| edge.error),
                deepest_hz: strongest.frequency_hz,
                attenuation: strongest.attenuation,
            })
        };
        let wide = |gap: &BandGap| gap.edges[1] - gap.edges[0] > NARROWEST * gap.edges[1];
        (0..self.least.len())
            .filter(begins)
            .filter_map(gap)
            .filter(wide)
            .collect()
    }

    /// Edge between a frequency in a gap and one outside [Hz], on the mesh and extrapolated. Without losses it is an oscillation of wave
    /// number 0 or π.
    fn edge(&self, inside: f64, outside: f64) -> [GapEdge; 2] {
        let own = self.motion.edge_between(self.meshes.own, inside, outside);
        let at = |mode: &&BandMode| (mode.on_mesh.im / TAU - own).abs() < AT_EDGE * own;
        if let Some(mode) = self.standing.iter().find(at).filter(|_| self.motion.lossless) {
            let error = mode.error.map(|error| error / TAU);
            return [mode.on_mesh, mode.s].map(|s| GapEdge {
                hz: s.im / TAU,
                error,
                standing: Some(mode.wave_number),
                inside: true,
            });
        }
        let toward = (inside - outside).signum();
        let there = |(other, factor): &(Lattice, f64)| {
            let edge = self.motion.edge_near(other, own, toward);
            (edge.map(Complex::from), *factor)
        };
        let known = extrapolated(own.into(), self.meshes.others.iter().map(there));
        let error = known.map(|(_, error)| error);
        [own, known.map_or(own, |(edge, _)| edge.re)].map(|hz| GapEdge {
            hz,
            error,
            standing: None,
            inside: true,
        })
    }
}

impl GapEdge {
    /// The edge of the band.
    fn of_band(hz: f64) -> Self {
        Self {
            hz,
            error: None,
            standing: None,
            inside: false,
        }
    }
}

impl Least {
    /// Of a wave number with its rounding error. Without a wave nothing is known of a gap.
    fn new(number: Option<(Complex<f64>, f64)>, lossless: bool) -> Self {
        let passes = |(number, rounding): (Complex<f64>, f64)| match lossless {
            true => number.im.abs() <= FAINT.max(rounding),
            false => number.im.abs() <= GAP,
        };
        Self {
            attenuation: number.map_or(f64::INFINITY, |(number, _)| number.im.abs()),
            passes: number.is_none_or(passes),
        }
    }
}

/// Least attenuated of wave numbers with rounding errors.
fn least(numbers: impl Iterator<Item = (Complex<f64>, f64)>) -> Option<(Complex<f64>, f64)> {
    numbers.min_by(|a, b| a.0.im.abs().total_cmp(&b.0.im.abs()))
}

/// True for a wave that mainly stretches the beam, or mainly bends it, and does not only move fluid.
fn belongs(energy: WaveEnergy, stretch: bool) -> bool {
    stretches(energy) == stretch && energy.bending.max(energy.stretch) > SHARE
}
