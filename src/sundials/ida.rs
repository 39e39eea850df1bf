//! IDA (of SUNDIALS' IDAS): variable-order backward differentiation formulas, step by step.

use std::ffi::{c_int, c_long, c_void};

use sundials_sys as s;

use super::callbacks::{self, CallbackData};
use super::context::{Context, Messages, keep};
use super::diagnosis::meaning;
use super::integrals::{self, Correction};
use super::linear_solver::LinearSolver;
use super::options::IdaOptions;
use super::sensitivities::SensitivityVectors;
use super::shared::Shared;
use super::vector::Vector;
use crate::case::schema::Method;
use crate::dae::Dae;
use crate::integrate::IntegrationError;
use crate::integrate::request;
use crate::integrate::{Counters, SolverWallTimes};
use crate::sparse::Lu;

/// An accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcceptedStep {
    /// Time at the end of the step [s].
    pub time: f64,
    /// Size of the step [s].
    pub size: f64,
    /// Order of the step.
    pub order: u8,
    /// True if the stop time is reached; `time` then equals it.
    pub stopped: bool,
}

/// IDA's memory, freed before everything it points to.
pub(super) struct IdaMemory(pub *mut c_void);

impl Drop for IdaMemory {
    fn drop(&mut self) {
        // SAFETY: created by `IDACreate` (or null, which is accepted), freed once.
        unsafe { s::IDAFree(&mut self.0) };
    }
}

/// Integrator of a system `F(t, y, y') = 0`.
///
/// Fields are in the order in which they must be dropped.
pub struct Ida<D: Dae> {
    pub(super) memory: IdaMemory,
    pub(super) solver: LinearSolver,
    pub(super) y: Vector,
    yp: Vector,
    pub(super) scratch: Vector,
    pub(super) quadratures: Option<Vector>,
    pub(super) correction: Correction,
    pub(super) sensitivities: Option<SensitivityVectors>,
    pub(super) messages: Shared<Messages>,
    pub(super) bridge: Shared<CallbackData<D>>,
    pub(super) context: Context,
    pub(super) time: f64,
    pub(super) stepped: bool,
    /// Largest step [s]; zero if unlimited.
    largest: f64,
    base: Counters,
}

impl<D: Dae> Ida<D> {
    /// Creates an integrator at time `t0` [s] with consistent values `y0` and derivatives `yp0`, both of length
    /// `dae.len()`.
    pub fn new(dae: D, t0: f64, y0: &[f64], yp0: &[f64], options: &IdaOptions) -> Result<Self, Box<IntegrationError>> {
        let n = dae.len();
        let refuse = |message: String| IntegrationError::request(message, t0);
        let lu = request::admit(&dae, [y0, yp0], options.check(n), Lu::new).map_err(refuse)?;
        let context = Context::new().map_err(refuse)?;
        let vector = |entries: &[f64]| Vector::new(entries, context.raw()).map_err(refuse);
        let id: Vec<f64> = dae
            .differential()
            .iter()
            .map(|&differential| f64::from(u8::from(differential)))
            .collect();
        let (y, yp, mut scratch) = (vector(y0)?, vector(yp0)?, vector(&id)?);
        let (integrals, correction) = (dae.integrals(), Correction::new(dae.integrals_of_powers()));
        let quadratures = if integrals == 0 {
            None
        } else {
            Some(vector(&vec![0.0; integrals])?)
        };
        let solver = LinearSolver::new(lu, context.raw()).map_err(refuse)?;
        let mut bridge = Shared::new(CallbackData::new(dae, options.relative, options.absolute.each(n)));
        let messages = Shared::new(Messages::default());
        // SAFETY: the context is alive; null is checked.
        let raw = unsafe { s::IDACreate(context.raw()) };
        let memory = IdaMemory(raw);
        bridge.get_mut().ida = raw;
        if raw.is_null() {
            return Err(refuse("no memory for the integrator".to_owned()));
        }
        // SAFETY: all pointers are alive and stay so until `memory` is dropped; IDA copies the vectors y, yp and id.
        let flags = unsafe {
            [
                s::IDASetErrHandlerFn(raw, Some(keep), messages.pointer().cast()),
                s::IDASetMaxOrd(raw, options.max_order.into()),
                s::IDASetUserData(raw, bridge.pointer().cast()),
                s::IDAInit(raw, Some(callbacks::residual::<D>), t0, y.raw(), yp.raw()),
                s::IDAWFtolerances(raw, Some(callbacks::weights::<D>)),
                s::IDASetLinearSolver(raw, solver.solver(), solver.matrix()),
                s::IDASetJacFn(raw, Some(callbacks::jacobian::<D>)),
                s::IDASetId(raw, scratch.raw()),
                s::IDASetSuppressAlg(raw, options.suppress_algebraic.into()),
                s::IDASetNonlinConvCoef(raw, options.nonlinear_coefficient),
                s::IDASetDeltaCjLSetup(raw, options.delta_cj_setup),
                s::IDASetInitStep(raw, options.initial_step.unwrap_or(0.0)),
                s::IDASetMaxStep(raw, options.max_step.unwrap_or(0.0)),
                s::IDASetMaxConvFails(raw, options.max_newton_failures.into()),
                s::IDASetMaxNonlinIters(raw, options.max_newton_iterations.into()),
                s::IDASetMaxErrTestFails(raw, options.max_error_test_failures.into()),
                s::IDASetMaxNumSteps(raw, -1),
                integrals::begin::<D>(raw, quadratures.as_ref()),
            ]
        };
        if let Some(&code) = flags.iter().find(|&&flag| flag != s::IDA_SUCCESS) {
            let mut failure = refuse(messages.get().take());
            (failure.code, failure.meaning) = (code, meaning(code));
            return Err(failure);
        }
        scratch.entries_mut().fill(0.0);
        let base = Counters {
            steps_by_order: vec![0; options.max_order.into()],
            max_order: options.max_order,
            method: Some(Method::Ida),
            ..Counters::default()
        };
        Ok(Self {
            memory,
            solver,
            y,
            yp,
            scratch,
            quadratures,
            correction,
            sensitivities: None,
            messages,
            bridge,
            context,
            time: t0,
            stepped: false,
            largest: options.max_step.unwrap_or(0.0),
            base,
        })
    }

    /// Performs one accepted step that does not pass `stop` [s]. A stop within the rounding error counts as reached.
    ///
    /// Panics of the equations are resumed here.
    pub fn step(&mut self, stop: f64) -> Result<AcceptedStep, Box<IntegrationError>> {
        if request::reached(self.time, stop)? {
            self.time = stop;
            return Ok(AcceptedStep {
                time: stop,
                size: 0.0,
                order: self.last_order(),
                stopped: true,
            });
        }
        let memory = self.memory.0;
        // IDA has already chosen the next step, possibly before the largest step was reduced
        let limited = self.largest > 0.0 && self.next_step() > self.largest * (1.0 + 1e-9);
        let until = if limited {
            stop.min(self.time + self.largest)
        } else {
            stop
        };
        let before = self.number(s::IDAGetNumSteps);
        self.bridge.get_mut().recoverable = None;
        let mut time = self.time;
        // SAFETY: everything IDA points to is alive, and no reference into it is held during the call.
        let flag = unsafe {
            match s::IDASetStopTime(memory, until) {
                s::IDA_SUCCESS => s::IDASolve(memory, until, &mut time, self.y.raw(), self.yp.raw(), s::IDA_ONE_STEP),
                refused => refused,
            }
        };
        self.raise_panic();
        if flag < 0 {
            return Err(self.failure(flag));
        }
        self.time = time;
        self.stepped = true;
        let order = self.last_order();
        let taken = self.number(s::IDAGetNumSteps) - before;
        if let Some(count) = self.base.steps_by_order.get_mut(usize::from(order).wrapping_sub(1)) {
            *count += taken;
        }
        let size = if taken == 0 { 0.0 } else { self.last_step() };
        if taken > 0 {
            let flag = self.correct_integrals(size, order);
            if flag < 0 {
                return Err(self.failure(flag));
            }
        }
        Ok(AcceptedStep {
            time,
            size,
            order,
            stopped: flag == s::IDA_TSTOP_RETURN && until == stop,
        })
    }

    /// Present time [s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Unknowns at the present time.
    pub fn y(&self) -> &[f64] {
        self.y.entries()
    }

    /// Derivatives of the unknowns at the present time [1/s].
    pub fn yp(&self) -> &[f64] {
        self.yp.entries()
    }

    /// Derivative of order `k` of the unknowns at a time [s] within the last step, from IDA's own polynomial.
    ///
    /// `k` is at most the order of the last step; panics if `out` and the unknowns differ in length.
    pub fn interpolate(&mut self, time: f64, k: u8, out: &mut [f64]) -> Result<(), Box<IntegrationError>> {
        if !self.stepped {
            let message = "nothing can be interpolated before the first step".to_owned();
            return Err(IntegrationError::request(message, self.time));
        }
        // SAFETY: IDA and the vector are alive.
        let flag = unsafe { s::IDAGetDky(self.memory.0, time, k.into(), self.scratch.raw()) };
        if flag < 0 {
            return Err(self.failure(flag));
        }
        out.copy_from_slice(self.scratch.entries());
        Ok(())
    }

    /// Estimated contribution of the last step to the errors of the unknowns; empty if IDA has no estimate.
    pub fn local_errors(&mut self) -> &[f64] {
        // SAFETY: IDA and the vector, to which it copies, are alive.
        let flag = unsafe { s::IDAGetEstLocalErrors(self.memory.0, self.scratch.raw()) };
        if flag < 0 { &[] } else { self.scratch.entries() }
    }

    /// Restarts from consistent values at time `t` [s]. History, factors and pivots are discarded: a new integrator
    /// from the same values would give bitwise identical results. Integrals start at zero. Costs about a dozen short
    /// steps.
    ///
    /// Panics if a slice and the unknowns differ in length.
    pub fn restart(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Box<IntegrationError>> {
        let counters = self.counters();
        self.solver.system_mut().lu.forget();
        let reset = self.reset_integrals();
        if reset < 0 {
            return Err(self.failure(reset));
        }
        self.y.entries_mut().copy_from_slice(y);
        self.yp.entries_mut().copy_from_slice(yp);
        // SAFETY: IDA and the vectors, which it copies, are alive.
        let flag = unsafe { s::IDAReInit(self.memory.0, t, self.y.raw(), self.yp.raw()) };
        if flag < 0 {
            return Err(self.failure(flag));
        }
        // IDA resets its counters to zero, ours continue
        self.base = Counters {
            restarts: counters.restarts + 1,
            ..counters
        };
        self.time = t;
        self.stepped = false;
        Ok(())
    }

    /// Sets the largest step size [s] from now on; order and history are kept.
    pub fn limit(&mut self, largest: f64) -> Result<(), Box<IntegrationError>> {
        if largest == self.largest {
            return Ok(());
        }
        // SAFETY: IDA is alive.
        let flag = unsafe { s::IDASetMaxStep(self.memory.0, largest) };
        if flag < 0 {
            return Err(self.failure(flag));
        }
        self.largest = largest;
        Ok(())
    }

    /// Sets the first step [s] after the next restart; IDA chooses it if absent.
    pub fn set_initial_step(&mut self, step: Option<f64>) -> Result<(), Box<IntegrationError>> {
        // SAFETY: IDA is alive.
        let flag = unsafe { s::IDASetInitStep(self.memory.0, step.unwrap_or(0.0)) };
        if flag < 0 { Err(self.failure(flag)) } else { Ok(()) }
    }

    /// Accepted steps since the integrator was created.
    pub fn steps(&self) -> u64 {
        self.base.steps + self.number(s::IDAGetNumSteps)
    }

    /// Work done since the integrator was created.
    pub fn counters(&self) -> Counters {
        let (bridge, system) = (self.bridge.get(), self.solver.system());
        Counters {
            steps: self.steps(),
            residual_evaluations: bridge.residuals,
            jacobian_evaluations: bridge.jacobians,
            factorizations: system.lu.factorizations(),
            pivot_refreshes: system.lu.pivot_refreshes(),
            error_test_failures: self.base.error_test_failures + self.number(s::IDAGetNumErrTestFails),
            newton_failures: self.base.newton_failures + self.number(s::IDAGetNumNonlinSolvConvFails),
            newton_iterations: self.base.newton_iterations + self.number(s::IDAGetNumNonlinSolvIters),
            linear_solves: system.solves,
            ..self.base.clone()
        }
    }

    /// Wall time spent in the equations and the linear solver.
    pub fn wall(&self) -> SolverWallTimes {
        let bridge = self.bridge.get();
        SolverWallTimes {
            residual: bridge.residual_wall,
            jacobian: bridge.jacobian_wall,
            linear_solver: self.solver.system().wall,
            integrands: bridge.integrand_wall,
        }
    }

    /// The equations.
    pub fn dae(&self) -> &D {
        &self.bridge.get().dae
    }

    /// Mutable access to the equations; call [`Ida::restart`] after a change of their meaning.
    pub fn dae_mut(&mut self) -> &mut D {
        &mut self.bridge.get_mut().dae
    }

    /// Returns the equations.
    pub fn into_dae(self) -> D {
        let Self { memory, bridge, .. } = self;
        drop(memory);
        bridge.into_inner().dae
    }

    /// Reads one of IDA's counters; zero if IDA fails to return it.
    fn number(&self, get: unsafe extern "C" fn(*mut c_void, *mut c_long) -> c_int) -> u64 {
        let mut number: c_long = 0;
        // SAFETY: IDA is alive, and all functions passed write one number.
        unsafe { get(self.memory.0, &mut number) };
        u64::try_from(number).unwrap_or(0)
    }

    pub(super) fn last_order(&self) -> u8 {
        let mut order = 0;
        // SAFETY: IDA is alive.
        unsafe { s::IDAGetLastOrder(self.memory.0, &mut order) };
        u8::try_from(order).unwrap_or(0)
    }

    /// Size of the next step [s]; zero before the first.
    fn next_step(&self) -> f64 {
        let mut step = 0.0;
        if self.stepped {
            // SAFETY: IDA is alive.
            unsafe { s::IDAGetCurrentStep(self.memory.0, &mut step) };
        }
        step
    }

    fn last_step(&self) -> f64 {
        let mut step = 0.0;
        // SAFETY: IDA is alive.
        unsafe { s::IDAGetLastStep(self.memory.0, &mut step) };
        step
    }
}
