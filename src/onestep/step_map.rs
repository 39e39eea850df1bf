//! March over a fixed time grid and its exact derivative, for period maps.
//!
//! The steps are those of a one-step method over a fixed grid. Each stage is solved to rounding error, so that the end is a smooth
//! function of the beginning. The differentiated equations of the stages propagate disturbances. With the stored factors of every stage,
//! this requires one solve per stage and disturbance.

use std::ops::AddAssign;

use serde::{Deserialize, Serialize};

use super::equations::{Equations, StageError};
use super::stages::{add, values};
use super::tableau::{Tableau, TableauMethod};
use crate::dae::{Dae, Seeds};
use crate::integrate::{StartOptions, consistent_start, halt};
use crate::sparse::Klu;

/// Correction, relative to 1 + |unknown|, below which a stage counts as solved.
const SOLVED: f64 = 1e-12;
/// Correction below which a stage counts as solved if corrections no longer decrease: rounding error of the residual.
const ROUND_OFF: f64 = 1e-8;
/// Maximum number of Newton steps in a stage.
const ITERATIONS: usize = 25;
/// Contraction rate above which old factors are replaced.
const SLOW: f64 = 0.2;

/// Receives the equations, the time [s] and the state at the end of every step.
pub type StepWatcher<'a, D> = &'a mut dyn FnMut(&mut D, f64, &[f64]);

/// Bytes stored per entry of the Jacobian: its value, and, with fill-in, about four entries of the factors with their indices.
const BYTES: f64 = 80.0;
/// Maximum memory for the factors of all stages [bytes].
const MOST_ROOM: f64 = 2e9;

/// Error of a march.
#[derive(Clone, Debug, PartialEq)]
pub struct StepError {
    /// Time [s].
    pub time: f64,
    /// Description of the failure.
    pub what: String,
}

impl StepError {
    /// Creates an error at a time [s].
    pub fn new(time: f64, what: impl Into<String>) -> Self {
        let what = what.into();
        Self { time, what }
    }
}

/// Work of one or several marches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StepMapWork {
    /// Steps.
    pub steps: u64,
    /// Residual evaluations.
    pub residual_evaluations: u64,
    /// Jacobian evaluations, including `∂F/∂y` for disturbances.
    pub jacobian_evaluations: u64,
    /// Factorisations.
    pub factorizations: u64,
    /// Linear solves of stages.
    pub linear_solves: u64,
    /// Disturbances propagated over the whole march.
    pub disturbances: u64,
}

impl AddAssign for StepMapWork {
    fn add_assign(&mut self, other: Self) {
        self.steps += other.steps;
        self.residual_evaluations += other.residual_evaluations;
        self.jacobian_evaluations += other.jacobian_evaluations;
        self.factorizations += other.factorizations;
        self.linear_solves += other.linear_solves;
        self.disturbances += other.disturbances;
    }
}

/// The matrix of one stage.
pub(super) struct StageMatrix {
    pub(super) klu: Klu,
    /// True if it contains factors.
    factored: bool,
    /// `∂F/∂y` at the solution, in the order of the pattern.
    pub(super) of_y: Vec<f64>,
    /// Rates of differential, values of algebraic unknowns.
    pub(super) x: Vec<f64>,
}

/// A march over a fixed grid.
pub struct StepMap<D: Dae> {
    pub(super) equations: Equations<D>,
    pub(super) tableau: Tableau,
    pub(super) times: Vec<f64>,
    pub(super) mask: Vec<f64>,
    /// Matrix of the start, then of every implicit stage in order of time.
    pub(super) slots: Vec<StageMatrix>,
    values: Vec<f64>,
    pub(super) work: StepMapWork,
}

impl<D: Dae> StepMap<D> {
    /// Creates a march from the first to the last of `times` [s], ascending, at least two.
    ///
    /// # Errors
    /// If the equations' matrix cannot be analyzed, or the factors would need too much memory.
    pub fn new(dae: D, method: TableauMethod, times: Vec<f64>) -> Result<Self, StepError> {
        let tableau = method.tableau();
        let n = dae.len();
        let count = 1 + (times.len() - 1) * (tableau.stages - 1);
        let room = count as f64 * (BYTES * dae.pattern().entries() as f64);
        if room > MOST_ROOM {
            let size = 1e-9 * room;
            let what = format!("the factors of all {count} stages need {size:.0} GB (limit 2 GB); use a coarser mesh");
            return Err(StepError::new(times[0], what));
        }
        let slots = (0..count).map(|_| {
            let klu = Klu::new(dae.pattern())
                .map_err(|fault| StepError::new(times[0], format!("KLU cannot analyse the matrix: {fault:?}")))?;
            Ok(StageMatrix {
                of_y: vec![0.0; klu.entries()],
                klu,
                factored: false,
                x: vec![0.0; n],
            })
        });
        Ok(Self {
            slots: slots.collect::<Result<_, _>>()?,
            values: vec![0.0; dae.pattern().entries()],
            mask: dae.differential().iter().map(|&d| f64::from(u8::from(d))).collect(),
            equations: Equations::new(dae),
            tableau,
            times,
            work: StepMapWork::default(),
        })
    }

    /// Times of the grid [s].
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Replaces the equations by others of the same pattern, and multiplies all times by a factor. The last march remains as a guess.
    pub fn replace(&mut self, dae: D, factor: f64) {
        self.equations.dae = dae;
        self.times.iter_mut().for_each(|t| *t *= factor);
    }

    /// Returns the equations.
    pub fn into_dae(self) -> D {
        self.equations.dae
    }

    /// Work done.
    pub fn work(&self) -> StepMapWork {
        StepMapWork {
            residual_evaluations: self.equations.residuals,
            jacobian_evaluations: self.equations.jacobians,
            ..self.work
        }
    }

    /// Marches from the differential unknowns in `y` at the first time to all unknowns and their rates at the last. Consistent values are
    /// computed on the way; the entries of algebraic unknowns are initial guesses. [`StepMap::propagate`] may be called afterwards.
    ///
    /// # Errors
    /// If no consistent start is found or a stage has no solution; `y` and `yp` are then meaningless.
    pub fn go(&mut self, y: &mut [f64], yp: &mut [f64], look: StepWatcher<D>) -> Result<(), StepError> {
        let t0 = self.times[0];
        consistent_start(&mut self.equations.dae, t0, y, yp, &StartOptions::default())
            .map_err(|failure| StepError::new(t0, failure.to_string()))?;
        self.linearise_start(t0, y, yp)?;
        let s = self.tableau.stages;
        let mut x: Vec<Vec<f64>> = vec![vec![0.0; y.len()]; s];
        for (i, x) in x[0].iter_mut().enumerate() {
            *x = if self.mask[i] > 0.0 { yp[i] } else { y[i] };
        }
        for step in 0..self.times.len() - 1 {
            let (t, h) = (self.times[step], self.times[step + 1] - self.times[step]);
            if halt::asked() {
                return Err(StepError::new(t, "interrupted"));
            }
            let begin = y.to_vec();
            for i in 1..s {
                let mut base = begin.clone();
                for (j, x) in x.iter().enumerate().take(i) {
                    add(&mut base, h * self.tableau.a[i][j], x);
                }
                let slot = 1 + step * (s - 1) + i - 1;
                let guess = if self.slots[slot].factored {
                    self.slots[slot].x.clone()
                } else {
                    x[i - 1].clone()
                };
                x[i].copy_from_slice(&guess);
                let time = t + self.tableau.c[i] * h;
                self.stage(slot, time, h, &base, &mut x[i], y, yp)?;
                self.slots[slot].x.copy_from_slice(&x[i]);
            }
            x.swap(0, s - 1);
            self.work.steps += 1;
            look(&mut self.equations.dae, self.times[step + 1], y);
        }
        // rates of algebraic unknowns do not appear anywhere
        for ((yp, x), mask) in yp.iter_mut().zip(&x[0]).zip(&self.mask) {
            *yp = mask * x;
        }
        Ok(())
    }

    /// Solves one stage from the guess `x` and stores its matrix for disturbances.
    #[allow(clippy::too_many_arguments)]
    fn stage(
        &mut self,
        slot: usize,
        t: f64,
        h: f64,
        base: &[f64],
        x: &mut [f64],
        y: &mut [f64],
        yp: &mut [f64],
    ) -> Result<(), StepError> {
        let scale = h * self.tableau.gamma();
        let mut r = vec![0.0; y.len()];
        let mut before = f64::INFINITY;
        self.equations.dae.approach(1.0 / scale);
        values(x, base, &self.mask, scale, [y, yp]);
        if !self.slots[slot].factored {
            self.factor(slot, t, y, yp, scale)?;
        }
        for iteration in 0.. {
            self.equations.residual(t, y, yp, &mut r).map_err(|o| error(t, o))?;
            self.slots[slot].klu.solve(&mut r);
            self.work.linear_solves += 1;
            for ((x, r), mask) in x.iter_mut().zip(&r).zip(&self.mask) {
                *x -= if *mask > 0.0 { r / scale } else { *r };
            }
            let size = r
                .iter()
                .zip(&*y)
                .map(|(r, y)| r.abs() / (1.0 + y.abs()))
                .fold(0.0, f64::max);
            values(x, base, &self.mask, scale, [y, yp]);
            if size <= SOLVED || size <= ROUND_OFF && size > 0.5 * before {
                break;
            }
            if !size.is_finite() || iteration == ITERATIONS {
                let what = format!("Newton's iteration does not converge in a step of {h:.2e} s");
                return Err(StepError { time: t, what });
            }
            if size > SLOW * before {
                self.factor(slot, t, y, yp, scale)?;
            }
            before = size;
        }
        self.factor(slot, t, y, yp, scale)?;
        let of_y = std::mem::take(&mut self.slots[slot].of_y);
        self.slots[slot].of_y = self.of_y(t, y, yp, of_y)?;
        Ok(())
    }

    /// Factors `∂F/∂y + 1/(h γ) ∂F/∂y'`.
    fn factor(&mut self, slot: usize, t: f64, y: &[f64], yp: &[f64], scale: f64) -> Result<(), StepError> {
        let mut values = std::mem::take(&mut self.values);
        let done = self.equations.jacobian(t, y, yp, 1.0 / scale, &mut values);
        self.values = values;
        done.map_err(|o| error(t, o))?;
        self.take_factors(slot, t)
    }

    fn take_factors(&mut self, slot: usize, t: f64) -> Result<(), StepError> {
        self.work.factorizations += 1;
        let slot = &mut self.slots[slot];
        slot.klu
            .factor(&self.values)
            .map_err(|fault| StepError::new(t, format!("the matrix of a stage cannot be factored: {fault:?}")))?;
        slot.factored = true;
        Ok(())
    }

    fn of_y(&mut self, t: f64, y: &[f64], yp: &[f64], mut out: Vec<f64>) -> Result<Vec<f64>, StepError> {
        self.equations
            .jacobian(t, y, yp, 0.0, &mut out)
            .map_err(|o| error(t, o))?;
        Ok(out)
    }

    /// Computes the matrix that gives rates and algebraic unknowns of the start from its differential ones.
    pub(super) fn linearise_start(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), StepError> {
        let free: Vec<f64> = self.mask.iter().map(|m| 1.0 - m).collect();
        let seeds = Seeds::Columns {
            y: &free,
            yp: &self.mask,
        };
        let done = self.equations.dae.jacobian(t, y, yp, seeds, &mut self.values);
        done.map_err(|fault| error(t, fault.into()))?;
        self.take_factors(0, t)?;
        let of_y = std::mem::take(&mut self.slots[0].of_y);
        self.slots[0].of_y = self.of_y(t, y, yp, of_y)?;
        Ok(())
    }
}

fn error(time: f64, obstacle: StageError) -> StepError {
    let what = match obstacle {
        StageError::Newton => "Newton's iteration does not converge".into(),
        StageError::Singular(column) => format!("the matrix has no pivot in column {column}"),
        StageError::Recoverable(what) | StageError::Fatal(what) => what,
    };
    StepError { time, what }
}
