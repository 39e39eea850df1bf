//! Shape of an eigenvector: displacements and pressures.

use nalgebra::Complex;

use super::linearise::Linearised;
use crate::discrete::{TimeData, Workspace, residual};
use crate::numerics::dual::Dual;

/// Amplitudes of a mode: real parts cos, imaginary parts minus sin of the phase at t = 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModeShape {
    /// Transverse displacement of each node [m].
    pub u1: Vec<Complex<f64>>,
    /// Axial displacement of each node [m].
    pub u3: Vec<Complex<f64>>,
    /// Mean pressure of each bladder, upper row first [Pa]; empty for a dry beam.
    pub pressure: Vec<Complex<f64>>,
}

/// Largest displacement of a normalized mode, over the length of the beam.
const DISPLACEMENT: f64 = 0.01;
/// Largest pressure of a normalized mode [Pa].
const PRESSURE: f64 = 1000.0;

/// Computes shapes from eigenvectors, by the derivative of the model along them.
pub struct Shapes<'a> {
    of: &'a Linearised,
    now: TimeData,
    workspace: Workspace<Dual<2>>,
}

impl<'a> Shapes<'a> {
    /// For the eigenvectors of a linearization.
    pub fn new(of: &'a Linearised) -> Self {
        let mut now = TimeData::new(of.system());
        now.update(of.system(), of.clock());
        Self {
            of,
            now,
            workspace: Workspace::new(of.system()),
        }
    }

    /// Shape of a vector, normalized to a hundredth of the length or 1 kPa, whichever is reached first. Its phase is zero where
    /// displacements (of pure flow: pressures) are largest.
    pub fn shape(&mut self, x: &[Complex<f64>]) -> ModeShape {
        let length = self.of.system().model.length;
        self.along(x).normalised(length)
    }

    /// Displacements and pressures along a vector of scaled unknowns.
    pub fn along(&mut self, x: &[Complex<f64>]) -> ModeShape {
        let system = self.of.system();
        let scales = &system.layout.scales;
        let along = |k: usize| Dual {
            value: self.of.y[k] * scales[k],
            derivative: [x[k].re * scales[k], x[k].im * scales[k]],
        };
        let y: Vec<Dual<2>> = (0..x.len()).map(along).collect();
        let at_rest = Dual {
            value: 0.0,
            derivative: [0.0; 2],
        };
        let yp = vec![at_rest; x.len()];
        residual::evaluate(system, &self.now, &y, &yp, &mut self.workspace);
        let complex = |values: &mut dyn Iterator<Item = Dual<2>>| -> Vec<Complex<f64>> {
            values.map(|v| Complex::new(v.derivative[0], v.derivative[1])).collect()
        };
        let w = &self.workspace;
        ModeShape {
            u1: complex(&mut w.motion.u.iter().map(|u| u.x)),
            u3: complex(&mut w.motion.u.iter().map(|u| u.z)),
            pressure: complex(&mut system.pressures_of_fluid(w)),
        }
    }
}

impl ModeShape {
    /// Normalizes size and phase, see [`Shapes::shape`].
    fn normalised(mut self, length: f64) -> Self {
        let moved = largest(self.u1.iter().chain(&self.u3)) / (DISPLACEMENT * length);
        let pressed = largest(self.pressure.iter()) / PRESSURE;
        let (by, size) = if moved.norm() > NOTHING * pressed.norm() {
            (moved, moved.norm().max(pressed.norm()))
        } else {
            self.u1.fill(Complex::default());
            self.u3.fill(Complex::default());
            (pressed, pressed.norm())
        };
        if size > 0.0 && by.norm() > 0.0 {
            let factor = by.conj() / (by.norm() * size);
            for value in self.u1.iter_mut().chain(&mut self.u3).chain(&mut self.pressure) {
                *value *= factor;
            }
        }
        self
    }

    /// The shape on a mesh of half the cells.
    pub fn on_every_other_node(&self) -> Self {
        let every_other = |u: &[Complex<f64>]| u.iter().step_by(2).copied().collect();
        Self {
            u1: every_other(&self.u1),
            u3: every_other(&self.u3),
            pressure: self.pressure.clone(),
        }
    }

    /// Largest displacement [m].
    pub fn displacement(&self) -> f64 {
        largest(self.u1.iter().chain(&self.u3)).norm()
    }

    /// Largest pressure [Pa].
    pub fn largest_pressure(&self) -> f64 {
        largest(self.pressure.iter()).norm()
    }

    /// Fraction of u1 in the squared displacements.
    pub fn transverse(&self) -> f64 {
        let square = |u: &[Complex<f64>]| u.iter().map(|u| u.norm_sqr()).sum::<f64>();
        let (across, along) = (square(&self.u1), square(&self.u3));
        across / (across + along).max(f64::MIN_POSITIVE)
    }

    /// True if pressures are round-off relative to the displacements.
    pub fn without_pressure(&self, length: f64) -> bool {
        self.largest_pressure() / PRESSURE <= NOTHING * self.displacement() / (DISPLACEMENT * length)
    }
}

/// Ratio below which displacements, or pressures, are round-off relative to the others.
const NOTHING: f64 = 1e-6;

/// `[E33]` Modal assurance criterion (Allemang & Brown) of displacements, weighted by the length `h_i` of each node: 1 for
/// the same shape, 0 for orthogonal ones:
///
/// ```text
/// MAC = |Σ h_i (ū1 w1 + ū3 w3)|² / (Σ h_i |u|² Σ h_i |w|²)
/// ```
///
/// Compares pressures if neither shape moves the beam.
pub fn likeness(a: &ModeShape, b: &ModeShape) -> f64 {
    if a.displacement() == 0.0 && b.displacement() == 0.0 {
        return alike(a, b, 1.0);
    }
    let last = a.u1.len().saturating_sub(1);
    let inner = |a: &ModeShape, b: &ModeShape| -> Complex<f64> {
        let part = |u: &[Complex<f64>], w: &[Complex<f64>]| -> Complex<f64> {
            let terms = u.iter().zip(w).enumerate();
            terms
                .map(|(i, (u, w))| u.conj() * w * if i == 0 || i == last { 0.5 } else { 1.0 })
                .sum()
        };
        part(&a.u1, &b.u1) + part(&a.u3, &b.u3)
    };
    alignment(a, b, inner)
}

/// Likeness of displacements and pressures together, each over its normalization, for motions that are mostly flow; `length` [m].
pub fn alike(a: &ModeShape, b: &ModeShape, length: f64) -> f64 {
    let inner = |a: &ModeShape, b: &ModeShape| -> Complex<f64> {
        let part = |u: &[Complex<f64>], w: &[Complex<f64>], size: f64| -> Complex<f64> {
            let sum: Complex<f64> = u.iter().zip(w).map(|(u, w)| u.conj() * w).sum();
            sum / (size * size * u.len().max(1) as f64)
        };
        let moved = DISPLACEMENT * length;
        part(&a.u1, &b.u1, moved) + part(&a.u3, &b.u3, moved) + part(&a.pressure, &b.pressure, PRESSURE)
    };
    alignment(a, b, inner)
}

/// Squared cosine of the angle between two shapes by an inner product; 0 if one of them is zero.
fn alignment(a: &ModeShape, b: &ModeShape, inner: impl Fn(&ModeShape, &ModeShape) -> Complex<f64>) -> f64 {
    let whole = inner(a, a).re * inner(b, b).re;
    if whole > 0.0 {
        inner(a, b).norm_sqr() / whole
    } else {
        0.0
    }
}

fn largest<'a>(values: impl Iterator<Item = &'a Complex<f64>>) -> Complex<f64> {
    values.fold(
        Complex::default(),
        |m, x| if x.norm_sqr() > m.norm_sqr() { *x } else { m },
    )
}
