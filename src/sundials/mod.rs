//! Safe interface to SUNDIALS: the integrator IDA and the nonlinear solver KINSOL.
//!
//! Unsafe code is restricted to this module and [`crate::sparse`]. This module accesses a problem only through [`crate::dae::Dae`].
//!
//! | file | content |
//! |---|---|
//! | [`ida`] | integrator, one accepted step at a time |
//! | [`kinsol`] | solver of `F(t, y, 0) = 0` |
//! | `integrals` | integrals computed along with the solution, for balances |
//! | [`sensitivities`] | derivatives by parameters, computed along with the solution |
//! | [`options`] | settings of IDA |
//! | `diagnosis` | error reports |
//! | `linear_solver` | LU factors as SUNDIALS' linear solver, with a matrix that SUNDIALS does not access |
//! | `callbacks` | callbacks from C to [`crate::dae::Dae`] |
//! | `vector`, `operations` | SUNDIALS' vectors with own operations |
//! | `context`, `shared` | context of SUNDIALS, and values shared with C |
//!
//! Rules of the interface: each value to which C has a pointer is in a `Shared` and outlives the C object. No Rust
//! reference into it exists while C runs. Panics and fatal errors are stored and resumed after C has returned.

#![allow(unsafe_code)]

mod callbacks;
mod context;
mod diagnosis;
pub mod ida;
mod integrals;
pub mod kinsol;
mod linear_solver;
mod operations;
pub mod options;
pub mod sensitivities;
mod shared;
mod vector;

pub use ida::{AcceptedStep, Ida};
pub use kinsol::{Kinsol, KinsolError, KinsolOptions, Solution};
pub use options::IdaOptions;

/// Version of the loaded SUNDIALS library.
pub fn sundials_version() -> String {
    context::loaded().map(|number| number.to_string()).join(".")
}

const _: () = assert!(
    sundials_sys::SUNDIALS_VERSION_MAJOR == 6,
    "sundials-sys found a version of SUNDIALS other than 6"
);
const _: () = assert!(size_of::<sundials_sys::sunindextype>() == 8 && size_of::<sundials_sys::realtype>() == 8);
