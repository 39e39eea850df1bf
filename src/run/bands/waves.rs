//! Waves of a cell at a frequency, frequencies at a wave number, and energies of both.

use nalgebra::{Complex, DMatrix, DVector};
use serde::{Deserialize, Serialize};
use slcbeam_dense::eigen;

use super::cell::RepeatingCell;
pub use super::condensed::MOST;
use super::condensed::{BlochFactor, Condensed};
use crate::case::Case;
use crate::error::Result;
use crate::run::modes::{Linearised, Shapes, linearise};
use crate::run::response::with_memory;

/// Size of `1/(s - σ)`, relative to the largest, below which an eigenvalue is infinite.
const FINITE: f64 = 1e-11;
/// Newton steps for an eigenvalue.
const STEPS: usize = 2;

/// A beam whose cells repeat.
pub struct Lattice {
    /// The linearized equations of the beam.
    pub about: Linearised,
    /// Its cell.
    pub cell: RepeatingCell,
}

/// A wave: unknowns of a cell in proportion to `exp(s t)`, those of the next cell λ times as large.
#[derive(Clone, Debug, PartialEq)]
pub struct BlochWave {
    /// s [1/s].
    pub s: Complex<f64>,
    /// λ.
    pub factor: Complex<f64>,
    /// Bound of the rounding error of λ, relative to it; 0 for a given λ.
    pub rounding: f64,
    /// Scaled unknowns of the cell.
    x: Vec<Complex<f64>>,
}

/// Shares of transverse motion, of axial motion and of pressures in the energy of a wave, which add up to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WaveEnergy {
    /// Transverse motion.
    pub bending: f64,
    /// Axial motion.
    pub stretch: f64,
    /// Fluid.
    pub fluid: f64,
}

/// Motion of a wave with the largest energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WaveMotion {
    /// Transverse motion of the beam.
    Bending,
    /// Axial motion of the beam.
    Stretch,
    /// Pressure in bladders and tubes.
    Fluid,
}

impl WaveMotion {
    /// All motions, in the order of tables and pictures.
    pub const ALL: [Self; 3] = [Self::Bending, Self::Fluid, Self::Stretch];

    /// Name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bending => "bending",
            Self::Stretch => "stretch",
            Self::Fluid => "fluid",
        }
    }
}

impl BlochWave {
    /// `μ`, with `λ = exp(-i Re μ - Im μ)`: phase lag in -π to π and attenuation from cell to cell toward the tip.
    pub fn wave_number(&self) -> Complex<f64> {
        Complex::new(-self.factor.arg(), -self.factor.norm().ln())
    }
}

impl WaveEnergy {
    /// Motion with the largest energy.
    pub fn motion(&self) -> WaveMotion {
        if self.fluid > self.bending + self.stretch {
            WaveMotion::Fluid
        } else if self.stretch > self.bending {
            WaveMotion::Stretch
        } else {
            WaveMotion::Bending
        }
    }
}

impl Lattice {
    /// Linearizes a case about its start; tubes have unsteady friction unless the case switches it off.
    ///
    /// # Errors
    /// Those of [`linearise`] and [`RepeatingCell::new`].
    pub fn new(case: &Case) -> Result<Self> {
        let (case, _) = with_memory(case.clone())?;
        let about = linearise(&case, 0.0, None)?;
        let cell = RepeatingCell::new(&about)?;
        Ok(Self { about, cell })
    }

    /// Waves at s [1/s] that are attenuated by at most [`MOST`]; none if the equations are singular.
    pub fn waves(&self, s: Complex<f64>) -> Vec<BlochWave> {
        let found = Condensed::new(&self.cell, s)
            .and_then(|condensed| condensed.waves())
            .unwrap_or_default();
        let wave = |found: BlochFactor| BlochWave {
            s,
            factor: found.factor,
            rounding: found.rounding,
            x: found.x,
        };
        found.into_iter().map(wave).collect()
    }

    /// Waves of a real wave number μ per cell, with the oscillations s whose frequencies Im s are within bounds [1/s].
    pub fn frequencies(&self, wave_number: f64, bounds: [f64; 2]) -> Vec<BlochWave> {
        let near = (bounds[0].max(1e-3 * bounds[1]) * bounds[1]).sqrt();
        let pencil = BlochPencil::new(&self.cell, wave_number);
        let mut all = pencil.eigenvalues(near);
        let within = |wave: &BlochWave| (bounds[0]..=bounds[1]).contains(&wave.s.im);
        all.retain(within);
        all.iter_mut().for_each(|wave| pencil.refine(wave, near));
        // of fast decays only rounding errors were within
        all.retain(within);
        all
    }

    /// `[E93]` Energies of a wave over a cell:
    ///
    /// ```text
    /// |s|² Σ m h_i |u1|²        |s|² Σ m h_i |u3|²        Σ l_b a_p |p|²        each over their sum
    /// ```
    pub fn energy(&self, wave: &BlochWave) -> WaveEnergy {
        let system = self.about.system();
        let mut whole = vec![Complex::default(); system.layout.len];
        for (power, unknowns) in [-1, 0, 1].into_iter().zip(&self.cell.unknowns) {
            let factor = wave.factor.powi(power);
            for (unknown, x) in unknowns.iter().zip(&wave.x) {
                whole[*unknown] = factor * x;
            }
        }
        let shape = Shapes::new(&self.about).shape(&whole);
        let (mesh, cell) = (&system.mesh, &self.cell);
        let segments = cell.first..cell.first + cell.segments;
        let nodes = segments.start * mesh.cells_per_segment..segments.end * mesh.cells_per_segment;
        let moving = |u: &[Complex<f64>]| -> f64 {
            let mass = |node: usize| system.sections.mass[node] * mesh.node_lengths[node];
            let energy = |node: usize| u.get(node).map_or(0.0, |u| mass(node) * u.norm_sqr());
            wave.s.norm_sqr() * nodes.clone().map(energy).sum::<f64>()
        };
        let pressed = |wet: &crate::model::Wet| -> f64 {
            let energy = |bladder: usize| {
                let pressure = shape.pressure.get(bladder).map_or(0.0, |p| p.norm_sqr());
                wet.bladder_length * wet.area_of(bladder).per_pressure * pressure
            };
            segments.clone().flat_map(|segment| wet.pair(segment)).map(energy).sum()
        };
        let parts = [
            moving(&shape.u1),
            moving(&shape.u3),
            system.model.wet.as_ref().map_or(0.0, pressed),
        ];
        let sum = parts.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let [bending, stretch, fluid] = parts.map(|part| part / sum);
        WaveEnergy {
            bending,
            stretch,
            fluid,
        }
    }
}

/// `A + s B` of a cell at a real wave number.
struct BlochPencil {
    parts: [DMatrix<Complex<f64>>; 2],
    factor: Complex<f64>,
}

impl BlochPencil {
    fn new(cell: &RepeatingCell, wave_number: f64) -> Self {
        let factor = Complex::from_polar(1.0, -wave_number);
        let mut parts = [0; 2].map(|_| DMatrix::zeros(cell.len(), cell.len()));
        for entry in &cell.entries {
            let power = factor.powi(entry.cell as i32 - 1);
            for (part, value) in parts.iter_mut().zip(entry.values) {
                part[(entry.row, entry.column)] += power * value;
            }
        }
        Self { parts, factor }
    }

    fn solve(&self, s: Complex<f64>, of: &DMatrix<Complex<f64>>) -> Option<DMatrix<Complex<f64>>> {
        let [a, b] = &self.parts;
        (a + b * s).lu().solve(of)
    }

    /// All finite eigenvalues, by `s = σ - 1/θ` with the eigenvalues θ of `(A + σ B)⁻¹ B`, σ near `i near` [1/s].
    fn eigenvalues(&self, near: f64) -> Vec<BlochWave> {
        let b = &self.parts[1];
        let differential: Vec<usize> = (0..b.ncols())
            .filter(|k| b.column(*k).iter().any(|x| x.norm() > 0.0))
            .collect();
        let shift = Complex::new(1e-3, 1.0) * near;
        let Some(operator) = self.solve(shift, &b.select_columns(&differential)) else {
            return vec![];
        };
        let entry = |row: usize, column: usize| operator[(differential[row], column)];
        let mut all = eigen(differential.len(), &entry).unwrap_or_default();
        let largest = all.first().map_or(0.0, |(theta, _)| theta.norm());
        all.retain(|(theta, _)| theta.norm() > FINITE * largest);
        let wave = |(theta, x): (Complex<f64>, Vec<Complex<f64>>)| BlochWave {
            s: shift - theta.inv(),
            factor: self.factor,
            rounding: 0.0,
            x: (&operator * DVector::from_vec(x)).iter().copied().collect(),
        };
        all.into_iter().map(wave).collect()
    }

    /// Newton steps for an eigenvalue.
    fn refine(&self, wave: &mut BlochWave, near: f64) {
        for _ in 0..STEPS {
            let x = DVector::from_column_slice(&wave.x);
            let product = &self.parts[1] * &x;
            let Some(next) = self.solve(wave.s, &DMatrix::from_columns(&[product])) else {
                return;
            };
            let next = next.column(0);
            let place = next.icamax_full().0;
            let by = x[place] / next[place];
            if by.norm().is_nan() || by.norm() > 1e-3 * (wave.s.norm() + near) {
                return;
            }
            wave.s -= by;
            wave.x = (next / Complex::from(next.norm())).iter().copied().collect();
        }
    }
}
