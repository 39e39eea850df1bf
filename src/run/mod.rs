//! Runs: what drives the solver over a model. Emits what happens, prints nothing.

pub mod record;
pub mod summary;
