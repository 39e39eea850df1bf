//! SUNDIALS behind safe types: the integrator IDA and the solver of nonlinear equations KINSOL.
//!
//! Unsafe code stands here and in [`crate::sparse`] alone; this room knows of a problem no more than [`crate::dae::Dae`] tells.
//!
//! | file | what stands there |
//! |---|---|
//! | [`ida`] | the integrator: one accepted step at a time |
//! | [`kinsol`] | solutions of `F(t, y, 0) = 0` |
//! | `integrals` | integrals carried along: the ledgers |
//! | [`sensitivities`] | derivatives by parameters carried along |
//! | [`options`] | what can be asked of it |
//! | `diagnosis` | why it could not go on, in words |
//! | `linear_solver` | KLU as SUNDIALS' linear solver, with a matrix that SUNDIALS cannot touch |
//! | `callbacks` | from C to [`crate::dae::Dae`] and back |
//! | `vector`, `operations` | SUNDIALS' vectors with operations of our own |
//! | `context`, `shared` | what everything else hangs on |
//!
//! Rules of the boundary: whatever C keeps a pointer to lives in a `Shared` and outlives the C object; no
//! Rust reference into it is held while C runs; panics and fatal faults are kept and raised again after C has returned.

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

pub use ida::{Ida, Step};
pub use kinsol::{Kinsol, KinsolError, KinsolOptions, Solution};
pub use options::IdaOptions;

/// Version of SUNDIALS as it is loaded.
pub fn sundials_version() -> String {
    context::loaded().map(|number| number.to_string()).join(".")
}

const _: () = assert!(
    sundials_sys::SUNDIALS_VERSION_MAJOR == 6,
    "sundials-sys has found another SUNDIALS than 6"
);
const _: () = assert!(size_of::<sundials_sys::sunindextype>() == 8 && size_of::<sundials_sys::realtype>() == 8);
