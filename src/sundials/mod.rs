//! The numerical libraries in C behind safe types: SUNDIALS' integrator IDA and SuiteSparse's sparse factors KLU.
//!
//! The only room with `unsafe`; it knows of a problem no more than [`crate::dae::Dae`] tells.
//!
//! | file | what stands there |
//! |---|---|
//! | [`ida`] | the integrator: one accepted step at a time |
//! | [`kinsol`] | solutions of `F(t, y, 0) = 0` |
//! | `integrals` | integrals carried along: the ledgers |
//! | [`sensitivities`], [`sensitivity_start`] | derivatives by parameters carried along, and their initial values |
//! | [`options`] | what can be asked of it |
//! | [`failure`], `diagnosis` | why it could not go on, in words |
//! | [`counters`] | what it did, and where the time went |
//! | [`start`] | consistent initial values |
//! | [`klu`] | sparse LU factors with a guard against stale pivots |
//! | `linear_solver` | KLU as SUNDIALS' linear solver, with a matrix that SUNDIALS cannot touch |
//! | `callbacks` | from C to [`crate::dae::Dae`] and back |
//! | `vector`, `operations`, [`kernels`] | SUNDIALS' vectors with operations of our own |
//! | `context`, `shared` | what everything else hangs on |
//!
//! Rules of the boundary: whatever C keeps a pointer to lives in a `Shared` and outlives the C object; no
//! Rust reference into it is held while C runs; panics and fatal faults are kept and raised again after C has returned.

#![allow(unsafe_code)]

mod callbacks;
mod context;
pub mod counters;
mod diagnosis;
pub mod failure;
pub mod ida;
mod integrals;
pub mod kernels;
pub mod kinsol;
pub mod klu;
mod linear_solver;
mod operations;
pub mod options;
pub(crate) mod request;
pub mod sensitivities;
pub mod sensitivity_start;
mod shared;
pub mod start;
mod vector;

pub(crate) use callbacks::not_finite;
pub use counters::{Counters, Wall};
pub use failure::{IdaFailure, Worst};
pub use ida::{Ida, Step};
pub use kinsol::{Kinsol, KinsolFailure, KinsolOptions, Solution};
pub use klu::{Klu, KluFault, RowScaling};
pub use options::{Absolute, IdaOptions};
pub use sensitivity_start::consistent_sensitivities;
pub use start::{Start, StartFailure, StartOptions, consistent_start};

/// Version of SUNDIALS as it is loaded.
pub fn sundials_version() -> String {
    context::loaded().map(|number| number.to_string()).join(".")
}

/// Version of SuiteSparse, whose KLU it is, as its headers say.
pub fn suitesparse_version() -> String {
    let all = [
        c::SUITESPARSE_MAIN_VERSION,
        c::SUITESPARSE_SUB_VERSION,
        c::SUITESPARSE_SUBSUB_VERSION,
    ];
    all.map(|number| number.to_string()).join(".")
}

/// Declarations written by `build.rs`.
mod c {
    #![allow(
        missing_docs,
        dead_code,
        non_camel_case_types,
        non_snake_case,
        non_upper_case_globals,
        clippy::all
    )]
    include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
}

const _: () = assert!(
    sundials_sys::SUNDIALS_VERSION_MAJOR == 6,
    "sundials-sys has found another SUNDIALS than 6"
);
const _: () = assert!(size_of::<sundials_sys::sunindextype>() == 8 && size_of::<sundials_sys::realtype>() == 8);
const _: () = assert!(
    size_of::<std::ffi::c_long>() == 8,
    "KLU's long integers must have 64 bits"
);
