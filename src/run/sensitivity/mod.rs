//! Derivatives of a run with respect to numbers of its case.

pub mod figures;
pub mod forward;
pub mod kept;
mod read;
