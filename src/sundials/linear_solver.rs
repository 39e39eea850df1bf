//! LU factors as a linear solver for SUNDIALS, with a matrix handle that SUNDIALS only passes on.
//!
//! SUNDIALS would zero its own sparse matrix, including the indices, before each Jacobian, and its KLU interface does
//! not detect stale pivots. Here the matrix is a handle to values owned by Rust; nothing in the library accesses them.

use std::any::Any;
use std::ffi::{c_int, c_long};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use sundials_sys as s;
use sundials_sys::{N_Vector, SUNContext, SUNLinearSolver, SUNMatrix};

use super::shared::Shared;
use super::vector::{entries, entries_mut};
use crate::numerics::kernels;
use crate::sparse::{KluError, Lu};

/// Matrix values, factors and their status.
pub(super) struct LinearSystem {
    /// Values of the matrix, in the order of the pattern.
    pub values: Vec<f64>,
    /// Factors.
    pub lu: Lu,
    /// Column in which the last matrix was singular; cleared by the next regular matrix.
    pub singular: Option<usize>,
    /// Number of linear solves.
    pub solves: u64,
    /// Wall time of factorizations and solves.
    pub wall: Duration,
    /// A panic, to be resumed after C has returned.
    pub panic: Option<Box<dyn Any + Send>>,
}

/// Owner of the C objects and of the system they point to.
pub(super) struct LinearSolver {
    solver: SUNLinearSolver,
    matrix: SUNMatrix,
    system: Shared<LinearSystem>,
}

impl LinearSolver {
    /// Creates a solver of systems with the pattern of `lu`.
    pub fn new(lu: Lu, context: SUNContext) -> Result<Self, String> {
        let system = Shared::new(LinearSystem {
            values: vec![0.0; lu.entries()],
            lu,
            singular: None,
            solves: 0,
            wall: Duration::ZERO,
            panic: None,
        });
        // SAFETY: the context is alive; null is checked.
        let (solver, matrix) = unsafe { (s::SUNLinSolNewEmpty(context), s::SUNMatNewEmpty(context)) };
        let this = Self { solver, matrix, system };
        if solver.is_null() || matrix.is_null() {
            return Err("no memory for a linear solver".to_owned());
        }
        // SAFETY: both were created empty, each with its own table of operations.
        unsafe {
            (*solver).content = this.system.pointer().cast();
            let ops = &mut *(*solver).ops;
            ops.gettype = Some(solver_type);
            ops.getid = Some(solver_id);
            ops.initialize = Some(initialize);
            ops.setup = Some(setup);
            ops.solve = Some(solve);
            ops.space = Some(solver_space);
            (*matrix).content = this.system.pointer().cast();
            let ops = &mut *(*matrix).ops;
            ops.getid = Some(matrix_id);
            ops.zero = Some(zero);
            ops.space = Some(matrix_space);
        }
        Ok(this)
    }

    /// Solver handle for C.
    pub fn solver(&self) -> SUNLinearSolver {
        self.solver
    }

    /// Matrix handle for C.
    pub fn matrix(&self) -> SUNMatrix {
        self.matrix
    }

    /// Access to the linear system.
    pub fn system(&self) -> &LinearSystem {
        self.system.get()
    }

    /// Mutable access to the linear system.
    pub fn system_mut(&mut self) -> &mut LinearSystem {
        self.system.get_mut()
    }
}

impl Drop for LinearSolver {
    fn drop(&mut self) {
        // SAFETY: created empty by SUNDIALS, freed once; both functions accept null. The content is ours and is freed
        // afterwards.
        unsafe {
            s::SUNLinSolFreeEmpty(self.solver);
            s::SUNMatFreeEmpty(self.matrix);
        }
    }
}

/// Linear system of a matrix handle.
///
/// # Safety
/// The matrix is a valid one of this file, and the system is not borrowed elsewhere.
pub(super) unsafe fn system_of<'m>(matrix: SUNMatrix) -> &'m mut LinearSystem {
    // SAFETY: by contract; the content was set in `LinearSolver::new`.
    unsafe { &mut *(*matrix).content.cast::<LinearSystem>() }
}

/// Runs `act` on the linear system of a solver and measures the time. A panic is stored and returned as an
/// unrecoverable failure.
///
/// # Safety
/// The solver is a valid one of this file, and the system is not borrowed elsewhere.
unsafe fn with_system(solver: SUNLinearSolver, act: impl FnOnce(&mut LinearSystem) -> c_int) -> c_int {
    // SAFETY: by contract; the content was set in `LinearSolver::new`.
    let system = unsafe { &mut *(*solver).content.cast::<LinearSystem>() };
    let begin = Instant::now();
    let code = catch_unwind(AssertUnwindSafe(|| act(system))).unwrap_or_else(|panic| {
        system.panic.get_or_insert(panic);
        s::SUNLS_PACKAGE_FAIL_UNREC
    });
    system.wall += begin.elapsed();
    code
}

/// Factors the matrix. A singular matrix, even the first one, is a recoverable failure: a shorter step may help.
unsafe extern "C" fn setup(solver: SUNLinearSolver, _: SUNMatrix) -> c_int {
    let factor = |system: &mut LinearSystem| match system.lu.factor(&system.values) {
        Ok(()) => {
            system.singular = None;
            0
        }
        Err(KluError::Singular { column }) => {
            system.singular = Some(column);
            s::SUNLS_LUFACT_FAIL as c_int
        }
        Err(KluError::Package { .. }) => s::SUNLS_PACKAGE_FAIL_UNREC,
    };
    // SAFETY: SUNDIALS passes the solver of `LinearSolver::new`.
    unsafe { with_system(solver, factor) }
}

/// Solves `A x = b`.
unsafe extern "C" fn solve(solver: SUNLinearSolver, _: SUNMatrix, x: N_Vector, b: N_Vector, _: f64) -> c_int {
    // SAFETY: SUNDIALS passes two valid serial vectors of equal length; x and b are different.
    let (x, b) = unsafe { (entries_mut(x), entries(b)) };
    let solve = |system: &mut LinearSystem| {
        system.solves += 1;
        x.copy_from_slice(b);
        let done = system.lu.solve(x) && kernels::all_finite(x);
        if done { 0 } else { s::SUNLS_PACKAGE_FAIL_REC as c_int }
    };
    // SAFETY: SUNDIALS passes the solver of `LinearSolver::new`.
    unsafe { with_system(solver, solve) }
}

unsafe extern "C" fn initialize(_: SUNLinearSolver) -> c_int {
    0
}

unsafe extern "C" fn solver_type(_: SUNLinearSolver) -> s::SUNLinearSolver_Type {
    s::SUNLinearSolver_Type_SUNLINEARSOLVER_DIRECT
}

unsafe extern "C" fn solver_id(_: SUNLinearSolver) -> s::SUNLinearSolver_ID {
    s::SUNLinearSolver_ID_SUNLINEARSOLVER_CUSTOM
}

/// Memory is not counted.
unsafe extern "C" fn solver_space(_: SUNLinearSolver, reals: *mut c_long, integers: *mut c_long) -> c_int {
    // SAFETY: SUNDIALS passes two valid destinations.
    unsafe {
        *reals = 0;
        *integers = 0;
    }
    0
}

unsafe extern "C" fn matrix_id(_: SUNMatrix) -> s::SUNMatrix_ID {
    s::SUNMatrix_ID_SUNMATRIX_CUSTOM
}

/// No operation: a Jacobian writes all its entries.
unsafe extern "C" fn zero(_: SUNMatrix) -> c_int {
    0
}

/// Memory is not counted.
unsafe extern "C" fn matrix_space(_: SUNMatrix, reals: *mut c_long, integers: *mut c_long) -> c_int {
    // SAFETY: SUNDIALS passes two valid destinations.
    unsafe {
        *reals = 0;
        *integers = 0;
    }
    0
}
