//! The drained beam under axial shaking as a Hill system of several modes, with contributions that a single mode and
//! first order omit.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use serde_json::json;

use super::figure::ExactFigure;
use super::fit::secant;
use super::floquet::{above_tongue, bending};
use super::problem::SolvedProblem;
use super::solve::{on_three_meshes, parse};
use crate::error::Result;
use crate::model::{Model, Section};

/// `βl` of the clamped-free modes.
const BETA: [f64; 6] = [
    1.875104068712,
    4.694091132974,
    7.854757438238,
    10.995540734875,
    14.137168391046,
    17.278759532088,
];
/// Gauss points and weights for a tenth of the beam.
const GAUSS: [(f64, f64); 4] = [
    (-0.861136311594053, 0.347854845137454),
    (-0.339981043584856, 0.652145154862546),
    (0.339981043584856, 0.652145154862546),
    (0.861136311594053, 0.347854845137454),
];
/// Steps per period: the phase of the sixth mode of the published beam advances by 0.2 in each, and by 0.1 from stage
/// to stage.
const STEPS: u32 = 2400;
/// Frequency of the shaking [Hz], as in the paper's Fig. 4.
const FREQUENCY: f64 = 18.0;

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    vec![SolvedProblem::new(
        "floquet-drained",
        [
            "Hill system of six clamped-free modes of the published beam with its bladders drained, shaken along at 18 Hz: coupling \
             integrals by quadrature, the standing axial wave of the root's motion, rotary inertia, multipliers of the period map",
            "where the principal tongue begins, over the length of the beam: 0.293; one mode of a beam that does not stretch gives 0.313",
            "second order: (beta h)^2 of 40 cells moves the frequency by 2e-4 of it, the onset by 8 times that, as it lies that far \
             from twice the frequency; the limit keeps rotary inertia in the stretched beam, 3e-4, and modes above the sixth",
        ],
        || {
            let exact = Hill::new(&section()?, BETA.len()).onset();
            let onset = on_three_meshes(10, |cells| Ok([of_program(cells)?]))?;
            let [values] = onset;
            Ok(vec![
                ExactFigure::converging("onset U3/l", values, exact, 4e-3, 1e-3),
                ExactFigure::relative("of one mode, unstretched", single()?, 0.3134, 1e-3),
            ])
        },
    )]
}

/// The published beam, drained, with the mass of the filled one.
fn case_of(amplitude: f64, cells: usize) -> serde_json::Value {
    json!({
        "name": "drained", "preset": "matia-gat-beam", "bladders": null, "fluid": null, "tubes": null,
        "beam": {"mass_factor": 1.0272},
        "ends": {"root": {"clamped": {"u3_m": {"sine": {"amplitude": amplitude, "frequency_hz": FREQUENCY}}}}, "tip": "free"},
        "effects": "full",
        "mesh": {"segments": cells, "cells_per_segment": 1},
        "time": {"end_s": 1.0},
        "solver": {"rtol": 1e-6}
    })
}

fn section() -> Result<(Section, f64)> {
    let model = Model::new(&parse(&case_of(0.03, 10))?)?;
    Ok((model.section, model.length))
}

/// Onset over the length on a mesh: the amplitude at which half the trace of the first mode's period map is -1, by the
/// secant method.
fn of_program(cells: usize) -> Result<f64> {
    let amplitude = secant([0.0286, 0.0292], |amplitude| {
        Ok(above_tongue(&bending(&case_of(amplitude, cells))?))
    })?;
    Ok(amplitude / section()?.1)
}

/// Onset over the length for one mode of an inextensible beam without rotary inertia: Mathieu's equation.
fn single() -> Result<f64> {
    let (section, length) = section()?;
    let stiff = Section {
        axial_stiffness: 1e9 * section.axial_stiffness,
        gyration_radius_squared: 0.0,
        ..section
    };
    Ok(Hill::new(&(stiff, length), 1).onset())
}

/// Slopes and curvatures of the modes at the quadrature points.
struct Hill {
    section: Section,
    length: f64,
    /// Points `x/l` and their weights.
    points: Vec<(f64, f64)>,
    /// Slopes and curvatures, one column per mode.
    slopes: DMatrix<f64>,
    curvatures: DMatrix<f64>,
    inverse_mass: DMatrix<f64>,
}

impl Hill {
    fn new((section, length): &(Section, f64), modes: usize) -> Self {
        let tenths = (0..10).map(f64::from);
        let points: Vec<(f64, f64)> = tenths
            .flat_map(|k| GAUSS.map(|(x, w)| ((k + 0.5 * (x + 1.0)) / 10.0, w / 20.0)))
            .collect();
        let at = |second: bool| {
            DMatrix::from_fn(points.len(), modes, |i, j| {
                let (beta, b) = (BETA[j], BETA[j] * points[i].0);
                let ratio = (beta.cosh() + beta.cos()) / (beta.sinh() + beta.sin());
                if second {
                    beta.powi(2) * (b.cosh() + b.cos() - ratio * (b.sinh() + b.sin()))
                } else {
                    beta * (b.sinh() + b.sin() - ratio * (b.cosh() - b.cos()))
                }
            })
        };
        let (slopes, curvatures) = (at(false), at(true));
        let weights = DVector::from_iterator(points.len(), points.iter().map(|(_, w)| *w));
        let rotary = section.gyration_radius_squared / (length * length);
        let turning = slopes.transpose() * DMatrix::from_diagonal(&weights) * &slopes * rotary;
        let mass = (DMatrix::identity(modes, modes) + turning) * (section.mass_per_length * length);
        let inverse_mass = mass.try_inverse().unwrap_or_else(|| DMatrix::zeros(modes, modes));
        Self {
            section: *section,
            length: *length,
            points,
            slopes,
            curvatures,
            inverse_mass,
        }
    }

    /// `M⁻¹ K`, the stiffness of small bending of the beam that the root's motion `U sin Ωt` stretches:
    ///
    /// ```text
    /// u = U s cos k(1-x)/cos k,  k = Ω l √(m/EA),  s = sin Ωt        λ = 1 + u'/l,  N = EA (λ - 1)
    /// K_ij = 1/l ∫ N/λ φ_i' φ_j' dx + EI/l³ ∫ (φ_i'/λ)' (φ_j'/λ)' dx
    /// ```
    fn stiffness(&self, amplitude: f64, s: f64) -> DMatrix<f64> {
        let (l, section) = (self.length, &self.section);
        let k = TAU * FREQUENCY * l * (section.mass_per_length / section.axial_stiffness).sqrt();
        let u = amplitude * s / (l * k.cos());
        let count = self.slopes.ncols();
        let mut pulled = DMatrix::zeros(self.points.len(), count);
        let mut bent = pulled.clone();
        for (i, &(x, weight)) in self.points.iter().enumerate() {
            let strain = u * k * (k * (1.0 - x)).sin();
            let change = -u * k * k * (k * (1.0 - x)).cos();
            let stretch = 1.0 + strain;
            let force = weight * section.axial_stiffness * strain / (stretch * l);
            for j in 0..count {
                let slope = self.slopes[(i, j)];
                pulled[(i, j)] = force * slope;
                bent[(i, j)] = (weight * section.bending_stiffness / l.powi(3)).sqrt()
                    * (self.curvatures[(i, j)] / stretch - slope * change / (stretch * stretch));
            }
        }
        &self.inverse_mass * (self.slopes.transpose() * pulled + bent.transpose() * &bent)
    }

    /// Largest modulus of the multipliers, by the classical Runge-Kutta method.
    fn largest(&self, amplitude: f64) -> f64 {
        let count = self.slopes.ncols();
        let period = 1.0 / FREQUENCY;
        let h = period / f64::from(STEPS);
        let at = |k: u32| {
            self.stiffness(
                amplitude,
                (TAU * f64::from(k % (2 * STEPS)) / f64::from(2 * STEPS)).sin(),
            )
        };
        let (mut q, mut v) = (
            DMatrix::<f64>::identity(count, 2 * count),
            DMatrix::<f64>::zeros(count, 2 * count),
        );
        (0..count).for_each(|i| v[(i, count + i)] = 1.0);
        let mut now = at(0);
        for step in 0..STEPS {
            let (middle, then) = (at(2 * step + 1), at(2 * step + 2));
            let (q1, v1) = (v.clone(), -(&now * &q));
            let (q2, v2) = (&v + &v1 * (0.5 * h), -(&middle * (&q + &q1 * (0.5 * h))));
            let (q3, v3) = (&v + &v2 * (0.5 * h), -(&middle * (&q + &q2 * (0.5 * h))));
            let (q4, v4) = (&v + &v3 * h, -(&then * (&q + &q3 * h)));
            q += (q1 + (q2 + q3) * 2.0 + q4) * (h / 6.0);
            v += (v1 + (v2 + v3) * 2.0 + v4) * (h / 6.0);
            now = then;
        }
        let mut whole = DMatrix::zeros(2 * count, 2 * count);
        whole.rows_mut(0, count).copy_from(&q);
        whole.rows_mut(count, count).copy_from(&v);
        whole.complex_eigenvalues().iter().map(|m| m.norm()).fold(0.0, f64::max)
    }

    /// Amplitude over the length at which the first multiplier leaves the unit circle.
    fn onset(&self) -> f64 {
        let (mut stable, mut unstable) = (0.026, 0.034);
        while unstable - stable > 1e-6 {
            let middle = 0.5 * (stable + unstable);
            if self.largest(middle) > 1.0 + 1e-3 {
                unstable = middle;
            } else {
                stable = middle;
            }
        }
        unstable / self.length
    }
}
