//! KINSOL: Newton's iteration with line search for `F(t, y, 0) = 0` at a fixed t.

use std::ffi::{c_int, c_long, c_void};
use std::fmt;

use sundials_sys as s;
use sundials_sys::{N_Vector, SUNMatrix};

use super::callbacks::{CallbackData, Stop};
use super::context::{Context, Messages, keep};
use super::linear_solver::{LinearSolver, system_of};
use super::shared::Shared;
use super::vector::{Vector, entries, entries_mut};
use crate::dae::{Dae, EvaluationError, Seeds};
use crate::integrate::halt::{self, INTERRUPTED};
use crate::integrate::not_finite;
use crate::integrate::request;
use crate::numerics::kernels;
use crate::sparse::Lu;

/// Settings of [`Kinsol::solve`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KinsolOptions {
    /// Largest accepted last correction of a solution, relative to 1 + |unknown|.
    pub tolerance: f64,
    /// Maximum number of Newton steps.
    pub max_iterations: u32,
    /// Norm of the largest Newton step, in scaled unknowns; none: KINSOL's default, 1000 times the norm of the guess.
    pub max_step: Option<f64>,
}

impl Default for KinsolOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            max_iterations: 60,
            max_step: None,
        }
    }
}

/// Work and accuracy of a solution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solution {
    /// Number of Newton steps, including the last correction.
    pub iterations: u64,
    /// Number of residual evaluations.
    pub residual_evaluations: u64,
    /// Number of factorizations.
    pub factorizations: u64,
    /// Last correction, largest relative to 1 + |unknown|: an upper estimate of the remaining error.
    pub correction: f64,
}

impl Solution {
    /// Adds the work of another solution; keeps the larger correction.
    pub fn add(&mut self, other: &Self) {
        self.iterations += other.iterations;
        self.residual_evaluations += other.residual_evaluations;
        self.factorizations += other.factorizations;
        self.correction = self.correction.max(other.correction);
    }
}

/// Error of a solution.
#[derive(Clone, Debug, PartialEq)]
pub struct KinsolError {
    /// KINSOL's error code, negative; 0 if the error is not from KINSOL.
    pub code: i32,
    /// Description of the failure.
    pub what: String,
    /// Unknown with the largest error, or without an equation.
    pub worst: Option<String>,
}

impl KinsolError {
    /// Error that is not from KINSOL and concerns no particular unknown.
    pub fn own(what: impl Into<String>) -> Self {
        let (code, what, worst) = (0, what.into(), None);
        Self { code, what, worst }
    }
}

impl fmt::Display for KinsolError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)?;
        match &self.worst {
            Some(name) => write!(f, "; worst unknown: {name}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for KinsolError {}

/// KINSOL's memory, freed before everything it points to.
struct KinsolMemory(*mut c_void);

impl Drop for KinsolMemory {
    fn drop(&mut self) {
        // SAFETY: created by `KINCreate` (or null, which is accepted), freed once.
        unsafe { s::KINFree(&mut self.0) };
    }
}

/// User data: the equations and the time at which they are solved.
struct Fixed<D> {
    bridge: CallbackData<D>,
    t: f64,
    zeros: Vec<f64>,
}

/// Solver of `F(t, y, 0) = 0` for all of y.
///
/// Fields are in the order in which they must be dropped.
pub struct Kinsol<D: Dae> {
    memory: KinsolMemory,
    solver: LinearSolver,
    y: Vector,
    ones: Vector,
    messages: Shared<Messages>,
    fixed: Shared<Fixed<D>>,
    _context: Context,
}

/// Residual, in units of each equation's scale, at which KINSOL's own iteration ends. Rounding errors are usually larger, and the
/// subsequent correction decides.
const RESIDUAL: f64 = 1e-13;

impl<D: Dae> Kinsol<D> {
    /// Creates a solver of these equations.
    pub fn new(dae: D) -> Result<Self, KinsolError> {
        let n = dae.len();
        let refuse = KinsolError::own;
        let zeros = vec![0.0; n];
        let lu = request::admit(&dae, [&zeros, &zeros], Ok(()), Lu::sparse).map_err(refuse)?;
        let context = Context::new().map_err(refuse)?;
        let y = Vector::new(&zeros, context.raw()).map_err(refuse)?;
        let ones = Vector::new(&vec![1.0; n], context.raw()).map_err(refuse)?;
        let solver = LinearSolver::new(lu, context.raw()).map_err(refuse)?;
        let fixed = Shared::new(Fixed {
            bridge: CallbackData::new(dae, 0.0, vec![]),
            t: 0.0,
            zeros,
        });
        let messages = Shared::new(Messages::default());
        // SAFETY: the context is alive; null is checked.
        let raw = unsafe { s::KINCreate(context.raw()) };
        let memory = KinsolMemory(raw);
        if raw.is_null() {
            return Err(refuse("no memory for the solver".to_owned()));
        }
        // SAFETY: all pointers are alive and stay so until `memory` is dropped.
        let flags = unsafe {
            [
                s::KINSetErrHandlerFn(raw, Some(keep), messages.pointer().cast()),
                s::KINSetUserData(raw, fixed.pointer().cast()),
                s::KINInit(raw, Some(residual::<D>), y.raw()),
                s::KINSetLinearSolver(raw, solver.solver(), solver.matrix()),
                s::KINSetJacFn(raw, Some(jacobian::<D>)),
                s::KINSetMaxSetupCalls(raw, 1),
                s::KINSetFuncNormTol(raw, RESIDUAL),
                s::KINSetMaxNewtonStep(raw, 0.0),
            ]
        };
        if let Some(&code) = flags.iter().find(|&&flag| flag != s::KIN_SUCCESS) {
            let what = messages.get().take();
            return Err(KinsolError {
                code,
                what,
                worst: None,
            });
        }
        Ok(Self {
            memory,
            solver,
            y,
            ones,
            messages,
            fixed,
            _context: context,
        })
    }

    /// The equations.
    pub fn dae(&self) -> &D {
        &self.fixed.get().bridge.dae
    }

    /// Mutable access to the equations.
    pub fn dae_mut(&mut self) -> &mut D {
        &mut self.fixed.get_mut().bridge.dae
    }

    /// Solves the equations at `t` from the guess in `y`, which is replaced by the solution, or by the last iterate after an error.
    /// Panics if the length of `y` is wrong.
    ///
    /// KINSOL stops if the residual is at rounding error, or if its line search finds no decrease, which may also be due to rounding
    /// errors. One more correction is therefore applied and must be below the tolerance.
    pub fn solve(&mut self, t: f64, y: &mut [f64], options: &KinsolOptions) -> Result<Solution, KinsolError> {
        let fixed = self.fixed.get_mut();
        fixed.t = t;
        (fixed.bridge.residuals, fixed.bridge.jacobians) = (0, 0);
        self.y.entries_mut().copy_from_slice(y);
        let factored = self.solver.system().lu.factorizations();
        let raw = self.memory.0;
        // SAFETY: memory and vectors are alive; the callbacks access user data only, which nobody borrows.
        let code = unsafe {
            s::KINSetNumMaxIters(raw, c_long::from(options.max_iterations));
            s::KINSetMaxNewtonStep(raw, options.max_step.unwrap_or(0.0));
            s::KINSetScaledStepTol(raw, 0.01 * options.tolerance);
            s::KINSol(
                raw,
                self.y.raw(),
                s::KIN_LINESEARCH as c_int,
                self.ones.raw(),
                self.ones.raw(),
            )
        };
        let mut iterations: c_long = 0;
        // SAFETY: memory is alive and the destination is valid for writing.
        unsafe { s::KINGetNumNonlinSolvIters(raw, &mut iterations) };
        y.copy_from_slice(self.y.entries());
        self.raise()?;
        let round_off = matches!(
            code,
            s::KIN_LINESEARCH_NONCONV | s::KIN_STEP_LT_STPTOL | s::KIN_MXNEWT_5X_EXCEEDED
        );
        if code < 0 && !round_off {
            return Err(self.failure(code));
        }
        let correction = self.correct(t, y)?;
        if correction.0 > options.tolerance {
            let name = self.dae().name(correction.1);
            return Err(KinsolError {
                code,
                what: format!(
                    "the last correction is {:.1e} (limit {:.1e}): {}",
                    correction.0,
                    options.tolerance,
                    meaning(code)
                ),
                worst: Some(name),
            });
        }
        let bridge = &self.fixed.get().bridge;
        Ok(Solution {
            iterations: iterations as u64 + 1,
            residual_evaluations: bridge.residuals,
            factorizations: self.solver.system().lu.factorizations() - factored,
            correction: correction.0,
        })
    }

    /// Solves `∂F/∂y x = b` with the last factored matrix: that of the solution. Panics if `b` has a wrong length.
    pub fn apply_inverse(&mut self, b: &mut [f64]) -> bool {
        self.solver.system_mut().lu.solve(b)
    }

    /// Sign of the determinant of the last factored matrix.
    pub fn determinant_sign(&self) -> i8 {
        self.solver.system().lu.determinant_sign()
    }

    /// Applies one Newton step to `y`; returns the largest correction relative to 1 + |unknown|, and its unknown.
    fn correct(&mut self, t: f64, y: &mut [f64]) -> Result<(f64, usize), KinsolError> {
        let fixed = self.fixed.get_mut();
        let (bridge, zeros) = (&mut fixed.bridge, &fixed.zeros);
        let system = self.solver.system_mut();
        let mut step = vec![0.0; y.len()];
        bridge.residuals += 1;
        bridge.jacobians += 1;
        let evaluated = bridge.dae.residual(t, y, zeros, &mut step).and_then(|()| {
            bridge
                .dae
                .jacobian(t, y, zeros, Seeds::Step { cj: 0.0 }, &mut system.values)
        });
        let refuse = |what: String, worst: Option<String>| KinsolError { code: 0, what, worst };
        if let Err(EvaluationError::Recoverable(what) | EvaluationError::Fatal(what)) = evaluated {
            return Err(refuse(what, None));
        }
        if system.lu.factor(&system.values).is_err() || !system.lu.solve(&mut step) || !kernels::all_finite(&step) {
            let worst = system.singular.map(|column| bridge.dae.name(column));
            return Err(refuse("the matrix is singular".into(), worst));
        }
        let mut largest = (0.0, 0);
        for (k, (y, step)) in y.iter_mut().zip(&step).enumerate() {
            let size = step.abs() / (1.0 + y.abs());
            if size > largest.0 {
                largest = (size, k);
            }
            *y -= step;
        }
        Ok(largest)
    }

    /// Resumes a panic, or returns a fatal error, of a callback.
    fn raise(&mut self) -> Result<(), KinsolError> {
        if let Some(panic) = self.solver.system_mut().panic.take() {
            std::panic::resume_unwind(panic);
        }
        match self.fixed.get_mut().bridge.stop.take() {
            Some(Stop::Panic(panic)) => std::panic::resume_unwind(panic),
            Some(Stop::Fatal(what)) => Err(KinsolError::own(what)),
            None => Ok(()),
        }
    }

    fn failure(&mut self, code: c_int) -> KinsolError {
        self.messages.get().take();
        let singular = self.solver.system().singular;
        let recoverable = self.fixed.get_mut().bridge.recoverable.take();
        KinsolError {
            code,
            what: match (singular, recoverable) {
                (Some(_), _) => "the matrix is singular: no remaining equation determines an unknown".into(),
                (None, Some(what)) => format!("{}: {what}", meaning(code)),
                (None, None) => meaning(code).into(),
            },
            worst: singular.map(|column| self.dae().name(column)),
        }
    }
}

/// Meaning of KINSOL's codes.
fn meaning(code: i32) -> &'static str {
    match code {
        s::KIN_SUCCESS | s::KIN_INITIAL_GUESS_OK | s::KIN_STEP_LT_STPTOL => "Newton's iteration has stopped",
        s::KIN_LINESEARCH_NONCONV => "no step along Newton's direction reduces the residual",
        s::KIN_LINESEARCH_BCFAIL => "the line search found no acceptable step",
        s::KIN_MAXITER_REACHED => "the maximum number of Newton steps is reached",
        s::KIN_MXNEWT_5X_EXCEEDED => "five consecutive steps had the maximum length",
        s::KIN_LSETUP_FAIL => "the matrix could not be evaluated or factored",
        s::KIN_LSOLVE_FAIL | s::KIN_LINSOLV_NO_RECOVERY => "the linear system could not be solved",
        s::KIN_SYSFUNC_FAIL | s::KIN_FIRST_SYSFUNC_ERR | s::KIN_REPTD_SYSFUNC_ERR => {
            "the equations could not be evaluated"
        }
        s::KIN_MEM_NULL | s::KIN_NO_MALLOC => "the solver is not initialised",
        s::KIN_MEM_FAIL => "there is no memory left",
        s::KIN_ILL_INPUT => "an input of the solver is not allowed",
        _ => "the solver failed",
    }
}

/// `KINSysFn` with a [`Fixed`] as user data.
unsafe extern "C" fn residual<D: Dae>(y: N_Vector, out: N_Vector, data: *mut c_void) -> c_int {
    // SAFETY: user data is a `Fixed`, which nobody else borrows while C runs; the vectors are different serial ones.
    let (fixed, y, out) = unsafe { (&mut *data.cast::<Fixed<D>>(), entries(y), entries_mut(out)) };
    let (bridge, zeros, t) = (&mut fixed.bridge, &fixed.zeros, fixed.t);
    bridge.residuals += 1;
    bridge.call(|dae| {
        if halt::asked() {
            return Err(EvaluationError::Fatal(INTERRUPTED.into()));
        }
        dae.residual(t, y, zeros, out)?;
        match kernels::first_not_finite(out) {
            None => Ok(()),
            Some(i) => Err(EvaluationError::Recoverable(format!(
                "the equation of {} gives {}",
                dae.name(i),
                out[i]
            ))),
        }
    })
}

/// `KINLsJacFn` with a [`Fixed`] as user data; writes into the system behind the matrix.
unsafe extern "C" fn jacobian<D: Dae>(
    y: N_Vector,
    _: N_Vector,
    matrix: SUNMatrix,
    data: *mut c_void,
    _: N_Vector,
    _: N_Vector,
) -> c_int {
    // SAFETY: user data is a `Fixed` and the matrix contains the linear system; nobody else borrows them while C runs.
    let (fixed, y, system) = unsafe { (&mut *data.cast::<Fixed<D>>(), entries(y), system_of(matrix)) };
    let (bridge, zeros, t) = (&mut fixed.bridge, &fixed.zeros, fixed.t);
    bridge.jacobians += 1;
    bridge.call(|dae| {
        dae.jacobian(t, y, zeros, Seeds::Step { cj: 0.0 }, &mut system.values)?;
        match kernels::first_not_finite(&system.values) {
            None => Ok(()),
            Some(entry) => Err(EvaluationError::Recoverable(not_finite(dae, entry, t))),
        }
    })
}
