//! Sparse matrices: their pattern, and SuiteSparse's factors KLU behind a safe type.
//!
//! | file | what stands there |
//! |---|---|
//! | [`pattern`] | positions of stored entries |
//! | [`colour`] | columns that may be differentiated together |
//! | [`lu`] | the cheaper of the next two |
//! | [`tridiagonal`] | LU factors of small dense blocks along a line |
//! | `groups` | things put together by the group that they belong to |
//! | [`klu`] | sparse LU factors, real and complex, with a guard against stale pivots |

#![allow(unsafe_code)]

pub mod colour;
mod groups;
pub mod klu;
pub mod lu;
pub mod pattern;
pub mod tridiagonal;

pub use klu::{Klu, KluError};
pub use lu::Lu;
pub use pattern::Pattern;
pub use tridiagonal::BlockTridiagonal;

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
pub(crate) mod c {
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
    size_of::<std::ffi::c_long>() == 8,
    "KLU's long integers must have 64 bits"
);
