//! The integrator: one accepted step at a time.

use super::control::StepControl;
use super::dense::StepIntegrals;
use super::equations::{Equations, StageError};
use super::matrix::Matrix;
use super::options::OneStepOptions;
use super::stages::{Stages, Work};
use super::tableau::{LEFTOVER, Tableau};
use crate::dae::{Corotation, Dae};
use crate::integrate::{Counters, IntegrationError, SolverWallTimes, WorstUnknown, request};
use crate::numerics::kernels;
use crate::sparse::Lu;
use crate::sundials::AcceptedStep;

/// Failures of a first step after which the step size is limited according to the present rates.
const BOLD: u16 = 3;

/// Integrator of a system `F(t, y, y') = 0` of index one, with the interface of [`crate::sundials::Ida`].
pub struct OneStep<D: Dae> {
    pub(super) equations: Equations<D>,
    pub(super) matrix: Matrix,
    pub(super) options: OneStepOptions,
    pub(super) tableau: Tableau,
    absolute: Vec<f64>,
    /// Remaining error of Newton's iteration as a fraction of the tolerance: the stop criterion, and the largest accepted error if the
    /// contraction is too slow for it.
    pub(super) newton_tolerance: [f64; 2],
    /// 1 for differential, 0 for algebraic unknowns.
    pub(super) mask: Vec<f64>,
    /// Indices of algebraic unknowns.
    pub(super) algebraic: Vec<usize>,
    /// The attempted step; its first stage is the present state.
    pub(super) now: Stages,
    /// The last accepted step.
    pub(super) last: Stages,
    pub(super) work: Work,
    pub(super) integrals: StepIntegrals,
    pub(super) time: f64,
    yp: Vec<f64>,
    control: StepControl,
    counters: Counters,
    pub(super) newton_iterations: u64,
    recoverable: Option<String>,
}

impl<D: Dae> OneStep<D> {
    /// Creates an integrator at time `t0` [s] with consistent values `y0` and derivatives `yp0`, both of length
    /// `dae.len()`.
    pub fn new(
        dae: D,
        t0: f64,
        y0: &[f64],
        yp0: &[f64],
        options: &OneStepOptions,
    ) -> Result<Self, Box<IntegrationError>> {
        let n = dae.len();
        let lu = request::admit(&dae, [y0, yp0], options.check(n), Lu::new)
            .map_err(|message| IntegrationError::request(message, t0))?;
        let tableau = options.method.tableau();
        let order = options.method.order();
        let differential = dae.differential();
        let mut this = Self {
            mask: differential.iter().map(|&d| f64::from(u8::from(d))).collect(),
            algebraic: (0..n).filter(|&i| !differential[i]).collect(),
            absolute: options.absolute.each(n),
            newton_tolerance: options.newton_tolerance.map_or_else(
                || [tableau.newton_tolerance(options.relative), LEFTOVER],
                |one| [one; 2],
            ),
            matrix: Matrix::new(lu, Corotation::new(&dae)),
            now: Stages::new(tableau.stages, n),
            last: Stages::new(tableau.stages, n),
            work: Work::new(n),
            integrals: StepIntegrals::new(dae.integrals()),
            time: t0,
            yp: vec![0.0; n],
            control: StepControl::new(options.max_step, tableau.power),
            counters: Counters {
                steps_by_order: vec![0; order.into()],
                max_order: order,
                method: Some(options.method.into()),
                ..Counters::default()
            },
            newton_iterations: 0,
            recoverable: None,
            equations: Equations::new(dae),
            options: options.clone(),
            tableau,
        };
        this.begin(t0, y0, yp0)?;
        Ok(this)
    }

    /// Sets the state, without a history.
    fn begin(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Box<IntegrationError>> {
        self.integrals.restart();
        self.time = t;
        self.last.h = 0.0;
        self.control.begin(0.0);
        self.yp.copy_from_slice(yp);
        self.now.y[0].copy_from_slice(y);
        for (i, x) in self.now.x[0].iter_mut().enumerate() {
            *x = if self.mask[i] > 0.0 { yp[i] } else { y[i] };
        }
        self.weigh()
    }

    /// Computes the weights of the error norm at the present state.
    fn weigh(&mut self) -> Result<(), Box<IntegrationError>> {
        let (y, relative) = (&self.now.y[0], self.options.relative);
        if kernels::error_weights(y, relative, &self.absolute, &mut self.work.weights) {
            return Ok(());
        }
        let message = "an error weight is not positive and finite".to_owned();
        Err(IntegrationError::request(message, self.time))
    }

    /// Sets the largest step size [s] from now on.
    pub fn limit(&mut self, largest: f64) {
        self.control.limit(largest);
    }

    /// Proposes the size of the next step [s]; 0 leaves the choice to the integrator.
    pub fn propose(&mut self, size: f64) {
        self.control.begin(size);
    }

    /// Performs one accepted step that does not pass `stop` [s]. A stop within the rounding error counts as reached.
    pub fn step(&mut self, stop: f64) -> Result<AcceptedStep, Box<IntegrationError>> {
        let order = self.options.method.order();
        if request::reached(self.time, stop)? {
            self.time = stop;
            return Ok(AcceptedStep {
                time: stop,
                size: 0.0,
                order,
                stopped: true,
            });
        }
        if self.control.size == 0.0 {
            self.control.begin(self.first_step(stop));
        }
        self.recoverable = None;
        for failures in 0..self.options.max_failures {
            if failures == BOLD && self.last.h == 0.0 {
                // the filtered error estimate of a fast transient falls only if the step is as short as the transient
                self.control.shorten(self.first_step(stop));
            }
            let (h, t1) = self.control.attempt(self.time, stop);
            if h <= 4.0 * f64::EPSILON * self.time.abs() {
                return Err(self.failure("the step became too small", h, None));
            }
            let error = match self.attempt(h, t1) {
                Ok(error) if error <= 1.0 => match self.integrate(t1) {
                    Ok(()) => Ok(error),
                    Err(obstacle) => Err(obstacle),
                },
                other => other,
            };
            match error {
                Ok(error) if error <= 1.0 => {
                    self.accept(h, t1, error)?;
                    return Ok(AcceptedStep {
                        time: t1,
                        size: h,
                        order,
                        stopped: t1 == stop,
                    });
                }
                Ok(error) => {
                    self.counters.error_test_failures += 1;
                    self.control.rejected(h, error);
                }
                Err(StageError::Fatal(what)) => {
                    return Err(self.failure("the equations could not be evaluated", h, Some(what)));
                }
                Err(obstacle) => {
                    if let StageError::Recoverable(what) = obstacle {
                        self.recoverable = Some(what);
                    }
                    self.counters.newton_failures += 1;
                    self.control.failed(h);
                }
            }
        }
        let h = self.control.size;
        Err(self.failure(
            "the error test or Newton's iteration failed too often, however short the step",
            h,
            None,
        ))
    }

    /// Makes the attempted step the last one, and its end the present state.
    fn accept(&mut self, h: f64, t1: f64, error: f64) -> Result<(), Box<IntegrationError>> {
        let mut yp = std::mem::take(&mut self.yp);
        let end = self.tableau.stages - 1;
        self.rates(end, &mut yp);
        self.yp = yp;
        std::mem::swap(&mut self.now, &mut self.last);
        self.now.x[0].copy_from_slice(&self.last.x[end]);
        self.now.y[0].copy_from_slice(&self.last.y[end]);
        self.time = t1;
        self.control.accepted(h, error);
        self.counters.steps += 1;
        if let Some(count) = self.counters.steps_by_order.last_mut() {
            *count += 1;
        }
        self.weigh()
    }

    /// Size of a first step [s]: a small fraction of the distance to the stop, and short enough that the present rates change the
    /// unknowns by at most half their tolerance (IDA's choice). It is never below the resolution of time, because rates after a switch
    /// may relax faster.
    fn first_step(&self, stop: f64) -> f64 {
        if let Some(step) = self.options.initial_step {
            return step;
        }
        let least = 1e-3 * (stop - self.time);
        let shortest = (1e3 * f64::EPSILON * self.time.abs()).min(least);
        let (n, weights) = (self.mask.len() as f64, &self.work.weights);
        let speed = (kernels::weighted_square_masked(&self.yp, weights, &self.mask) / n).sqrt();
        if speed * least > 0.5 {
            (0.5 / speed).max(shortest)
        } else {
            least
        }
    }

    /// Collects all information about a failure.
    fn failure(&self, meaning: &'static str, step: f64, fatal: Option<String>) -> Box<IntegrationError> {
        let ratios = self.work.r.iter().zip(&self.work.weights).map(|(r, w)| (r * w).abs());
        let worst = ratios.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        Box::new(IntegrationError {
            code: 0,
            meaning,
            fatal,
            message: String::new(),
            time: self.time,
            step,
            order: self.options.method.order(),
            worst: worst
                .filter(|(_, ratio)| *ratio > 0.0)
                .map(|(unknown, ratio)| WorstUnknown {
                    unknown,
                    name: self.dae().name(unknown),
                    ratio,
                }),
            recoverable: self.recoverable.clone(),
            singular: self.matrix.singular.map(|column| self.dae().name(column)),
        })
    }

    /// Present time [s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Unknowns at the present time.
    pub fn y(&self) -> &[f64] {
        &self.now.y[0]
    }

    /// Derivatives of the unknowns at the present time [1/s].
    pub fn yp(&self) -> &[f64] {
        &self.yp
    }

    /// Restarts from consistent values at time `t` [s]. History, factors, pivots and step size are discarded: a new integrator from the
    /// same values would give bitwise identical results. Integrals start at zero.
    ///
    /// Panics if a slice and the unknowns differ in length.
    pub fn restart(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Box<IntegrationError>> {
        self.matrix.forget();
        self.go_on(t, y, yp)
    }

    /// Like [`OneStep::restart`], but keeps the factors and pivots, for a jump that changes forces more than stiffness. Factors are
    /// renewed if Newton's iteration does not converge with them.
    ///
    /// Panics if a slice and the unknowns differ in length.
    pub fn go_on(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Box<IntegrationError>> {
        self.counters.restarts += 1;
        self.matrix.doubt();
        self.begin(t, y, yp)
    }

    /// Size of the next step [s] if no stop is near; 0 if the integrator will choose it.
    pub fn size(&self) -> f64 {
        self.control.size
    }

    /// Accepted steps since the integrator was created.
    pub fn steps(&self) -> u64 {
        self.counters.steps
    }

    /// Work done since the integrator was created.
    pub fn counters(&self) -> Counters {
        Counters {
            residual_evaluations: self.equations.residuals,
            jacobian_evaluations: self.equations.jacobians,
            factorizations: self.matrix.lu.factorizations(),
            pivot_refreshes: self.matrix.lu.pivot_refreshes(),
            newton_iterations: self.newton_iterations,
            linear_solves: self.matrix.solves,
            ..self.counters.clone()
        }
    }

    /// Wall time spent in the equations and the linear solver.
    pub fn wall(&self) -> SolverWallTimes {
        SolverWallTimes {
            residual: self.equations.residual_wall,
            jacobian: self.equations.jacobian_wall,
            linear_solver: self.matrix.wall,
            integrands: self.equations.integrand_wall,
        }
    }

    /// The equations.
    pub fn dae(&self) -> &D {
        &self.equations.dae
    }

    /// Mutable access to the equations; call [`OneStep::restart`] after a change of their meaning.
    pub fn dae_mut(&mut self) -> &mut D {
        &mut self.equations.dae
    }

    /// Returns the equations.
    pub fn into_dae(self) -> D {
        self.equations.dae
    }
}
