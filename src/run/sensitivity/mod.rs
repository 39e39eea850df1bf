//! Derivatives of what a case gives with respect to its numbers.

pub mod figures;
pub mod forward;
pub mod parameter;

pub use parameter::Parameter;
