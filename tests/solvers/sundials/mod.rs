//! The solver interface alone: problems with published answers, the protocol of faults, the guard of the factors.

#[path = "../../common/chance.rs"]
pub mod chance;
mod faults;
mod klu;
mod published;
mod start;
mod stepping;
