//! Consistent initial values by Newton's iteration.

mod options;
mod simplified_newton;

pub use options::{ConsistentStart, StartError, StartOptions};

use super::not_finite;
use crate::dae::{Dae, EvaluationError, Seeds};
use crate::numerics::kernels;
use crate::sparse::{Klu, KluError};

/// Solves `F(t, y, y') = 0` for the algebraic unknowns and the derivatives of the differential ones.
///
/// Differential unknowns in `y` are kept, the other entries are initial guesses. Derivatives of algebraic unknowns are set to 0. Newton's
/// iteration is damped by the natural monotonicity test (Deuflhard). It accepts a step if the next correction with the same matrix is
/// smaller; this test is independent of the scaling of equations. The iteration ends if corrections are below the tolerance, or if they
/// no longer decrease and are within the rounding error of the residual.
///
/// After an error `y` and `yp` contain the last iterate. Panics if their length differs from `dae.len()`.
pub fn consistent_start<D: Dae>(
    dae: &mut D,
    t: f64,
    y: &mut [f64],
    yp: &mut [f64],
    options: &StartOptions,
) -> Result<ConsistentStart, StartError> {
    Starter::new(dae)?.start(dae, t, y, yp, options)
}

/// Corrections below this size that no longer decrease count as rounding error, whatever its estimate.
const ROUND_OFF: f64 = 1e-8;

/// Rounding error of one term of a residual, in units of the last place.
const ROUNDINGS: f64 = 16.0;

/// Data shared by consistent starts of one system: analysis of its pattern, work space, factors of the last start.
pub struct Starter {
    differential: Vec<bool>,
    y_seeds: Vec<f64>,
    yp_seeds: Vec<f64>,
    values: Vec<f64>,
    klu: Klu,
    /// True if the factors belong to a successful start.
    factored: bool,
    residual: Vec<f64>,
    correction: Vec<f64>,
    guess: Vec<f64>,
}

impl Starter {
    /// Allocates work space for starts of a system, and of all systems with the same pattern.
    ///
    /// # Errors
    /// If the pattern is structurally singular.
    pub fn new<D: Dae>(dae: &D) -> Result<Self, StartError> {
        let n = dae.len();
        let differential = dae.differential().to_vec();
        let seed = |kind: bool| differential.iter().map(|&d| f64::from(u8::from(d == kind))).collect();
        let (y_seeds, yp_seeds) = (seed(false), seed(true));
        let klu = Klu::new(dae.pattern()).map_err(|fault| singular(dae, fault, 0))?;
        let zeros = || vec![0.0; n];
        Ok(Self {
            differential,
            y_seeds,
            yp_seeds,
            values: vec![0.0; klu.entries()],
            klu,
            factored: false,
            residual: zeros(),
            correction: zeros(),
            guess: zeros(),
        })
    }

    /// Discards the factors: the next start is bitwise identical to that of a new `Starter`.
    pub fn forget(&mut self) {
        self.klu.forget();
        self.factored = false;
    }

    /// Like [`consistent_start`], but tries the factors of an earlier start first, if there are any. Corrections with them end if the
    /// remaining error is below the tolerance. They are discarded if they do not contract well.
    ///
    /// # Errors
    /// If there is no start near the guess, or none is found.
    pub fn start<D: Dae>(
        &mut self,
        dae: &mut D,
        t: f64,
        y: &mut [f64],
        yp: &mut [f64],
        options: &StartOptions,
    ) -> Result<ConsistentStart, StartError> {
        let n = dae.len();
        assert!(y.len() == n && yp.len() == n, "values of another system");
        for (yp, _) in yp.iter_mut().zip(&self.differential).filter(|(_, d)| !**d) {
            *yp = 0.0;
        }
        let mut newton = Newton {
            dae,
            t,
            y,
            yp,
            room: self,
            residuals: 0,
            iterations: 0,
        };
        if let Some(start) = newton.with_old_factors(options) {
            return Ok(start);
        }
        newton.room.forget();
        let start = newton.solve(options)?;
        self.factored = true;
        Ok(start)
    }
}

/// Newton's iteration. The unknowns z are y (algebraic) or y' (differential).
struct Newton<'a, D: Dae> {
    dae: &'a mut D,
    t: f64,
    y: &'a mut [f64],
    yp: &'a mut [f64],
    room: &'a mut Starter,
    residuals: u64,
    iterations: u16,
}

impl<D: Dae> Newton<'_, D> {
    fn unknown(&self, i: usize) -> f64 {
        if self.room.differential[i] {
            self.yp[i]
        } else {
            self.y[i]
        }
    }

    fn unknown_mut(&mut self, i: usize) -> &mut f64 {
        if self.room.differential[i] {
            &mut self.yp[i]
        } else {
            &mut self.y[i]
        }
    }

    fn solve(mut self, options: &StartOptions) -> Result<ConsistentStart, StartError> {
        self.evaluate().map_err(|fault| self.give_up(fault.reason(), None))?;
        let mut damping: f64 = 1.0;
        let mut last = f64::INFINITY;
        loop {
            let correction = self.correction()?;
            let size = self.size(&correction);
            let worst = largest(&self.relative(&correction));
            if size <= options.tolerance || (size > 0.5 * last && size <= self.round_off()?) {
                return self.finish(&correction, size);
            }
            if self.iterations == options.max_iterations {
                return Err(self.give_up(
                    format!("the last correction is {size:.1e} (limit {:.1e})", options.tolerance),
                    worst,
                ));
            }
            last = size;
            self.iterations += 1;
            damping = self.damped_step(&correction, size, (4.0 * damping).min(1.0), options)?;
        }
    }

    /// Applies the largest fraction of the correction that passes the monotonicity test; returns the fraction.
    fn damped_step(
        &mut self,
        correction: &[f64],
        size: f64,
        first: f64,
        options: &StartOptions,
    ) -> Result<f64, StartError> {
        let from = self.unknowns();
        let mut damping = first;
        let mut fault = None;
        loop {
            self.go(&from, correction, damping);
            match self.evaluate() {
                Ok(()) => {
                    let mut next = self.room.residual.clone();
                    let small = self.room.klu.solve(&mut next)
                        && self.norm(&next, &from) <= (1.0 - 0.25 * damping) * self.norm(correction, &from);
                    // near convergence rounding errors decide the test, not the direction
                    if small || size <= ROUND_OFF {
                        return Ok(damping);
                    }
                }
                Err(EvaluationError::Fatal(what)) => return Err(self.give_up(what, None)),
                Err(EvaluationError::Recoverable(what)) => fault = Some(what),
            }
            damping *= 0.5;
            if damping < options.smallest_damping {
                let worst = largest(&self.relative(correction));
                self.go(&from, correction, 0.0);
                let what =
                    fault.unwrap_or_else(|| "no step along Newton's direction reduces the correction".to_owned());
                return Err(self.give_up(what, worst));
            }
        }
    }

    /// Applies the last correction as well, unless it increases the residual, and returns the start.
    fn finish(mut self, correction: &[f64], size: f64) -> Result<ConsistentStart, StartError> {
        let from = self.unknowns();
        let before = kernels::max_abs(&self.room.residual);
        self.go(&from, correction, 1.0);
        self.evaluate().map_err(|fault| self.give_up(fault.reason(), None))?;
        let mut after = kernels::max_abs(&self.room.residual);
        if after > before {
            self.go(&from, correction, 0.0);
            after = before;
        }
        Ok(ConsistentStart {
            iterations: self.iterations,
            residual_evaluations: self.residuals,
            correction: size,
            residual: after,
        })
    }

    fn evaluate(&mut self) -> Result<(), EvaluationError> {
        self.residuals += 1;
        self.dae.residual(self.t, self.y, self.yp, &mut self.room.residual)?;
        match kernels::first_not_finite(&self.room.residual) {
            None => Ok(()),
            Some(i) => Err(EvaluationError::Recoverable(format!(
                "the equation of {} gives {}",
                self.dae.name(i),
                self.room.residual[i]
            ))),
        }
    }

    /// Computes Newton's correction, to be subtracted: `J dz = F`.
    fn correction(&mut self) -> Result<Vec<f64>, StartError> {
        let seeds = Seeds::Columns {
            y: &self.room.y_seeds,
            yp: &self.room.yp_seeds,
        };
        if let Err(fault) = self.dae.jacobian(self.t, self.y, self.yp, seeds, &mut self.room.values) {
            return Err(self.give_up(fault.reason(), None));
        }
        if let Some(entry) = kernels::first_not_finite(&self.room.values) {
            return Err(self.give_up(not_finite(self.dae, entry, self.t), None));
        }
        self.room
            .klu
            .factor(&self.room.values)
            .map_err(|fault| singular(self.dae, fault, self.iterations))?;
        let mut correction = self.room.residual.clone();
        self.room.klu.solve(&mut correction);
        match kernels::first_not_finite(&correction) {
            None => Ok(correction),
            Some(i) => Err(self.give_up("the matrix is singular to working precision".to_owned(), Some(i))),
        }
    }

    /// Size of the correction caused by rounding errors of the residual. It is far above the rounding error of z if z contains rates of
    /// areas and a network equalizes in nanoseconds.
    ///
    /// ```text
    /// J dz = 16 ε |∂F/∂y| |y|
    /// ```
    fn round_off(&mut self) -> Result<f64, StartError> {
        let n = self.y.len();
        let (one, zero) = (vec![1.0; n], vec![0.0; n]);
        let seeds = Seeds::Columns { y: &one, yp: &zero };
        if let Err(fault) = self.dae.jacobian(self.t, self.y, self.yp, seeds, &mut self.room.values) {
            return Err(self.give_up(fault.reason(), None));
        }
        let mut noise = vec![0.0; n];
        let pattern = self.dae.pattern();
        for (column, y) in self.y.iter().enumerate() {
            for entry in pattern.column(column) {
                noise[pattern.rows[entry] as usize] += ROUNDINGS * f64::EPSILON * (self.room.values[entry] * y).abs();
            }
        }
        self.room.klu.solve(&mut noise);
        Ok(self.size(&noise).max(ROUND_OFF))
    }

    /// Returns the present z.
    fn unknowns(&self) -> Vec<f64> {
        (0..self.y.len()).map(|i| self.unknown(i)).collect()
    }

    /// Sets z to `from - damping * correction`.
    fn go(&mut self, from: &[f64], correction: &[f64], damping: f64) {
        for i in 0..from.len() {
            *self.unknown_mut(i) = from[i] - damping * correction[i];
        }
    }

    /// Returns a correction relative to 1 + |z|.
    fn relative(&self, correction: &[f64]) -> Vec<f64> {
        self.unknowns()
            .iter()
            .zip(correction)
            .map(|(z, c)| c / (1.0 + z.abs()))
            .collect()
    }

    /// Largest relative correction.
    fn size(&self, correction: &[f64]) -> f64 {
        kernels::max_abs(&self.relative(correction))
    }

    /// Root mean square of a correction, relative to 1 + |z| at `from`.
    fn norm(&self, correction: &[f64], from: &[f64]) -> f64 {
        let weights: Vec<f64> = from.iter().map(|z| 1.0 / (1.0 + z.abs())).collect();
        (kernels::weighted_square(correction, &weights) / from.len() as f64).sqrt()
    }

    fn give_up(&self, what: String, worst: Option<usize>) -> StartError {
        let worst = worst.map(|i| (i, self.name(i)));
        StartError {
            what,
            worst,
            iterations: self.iterations,
        }
    }

    fn name(&self, i: usize) -> String {
        let name = self.dae.name(i);
        if self.room.differential[i] {
            format!("the rate of {name}")
        } else {
            name
        }
    }
}

/// Index of the entry with the largest absolute value.
fn largest(x: &[f64]) -> Option<usize> {
    x.iter()
        .enumerate()
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        .map(|(i, _)| i)
}

fn singular<D: Dae>(dae: &D, fault: KluError, iterations: u16) -> StartError {
    match fault {
        KluError::Singular { column } => StartError {
            what: "no remaining equation determines an unknown".to_owned(),
            worst: Some((column, dae.name(column))),
            iterations,
        },
        KluError::Package { status } => StartError {
            what: format!("KLU failed (status {status})"),
            worst: None,
            iterations,
        },
    }
}
