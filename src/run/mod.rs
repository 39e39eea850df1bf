//! Runs: what drives the solver over a model. Emits what happens, prints nothing.

pub mod checkpoint;
pub mod dynamics;
pub mod equilibrium;
pub mod figures;
pub mod growth;
pub mod method;
pub mod modes;
pub mod observe;
pub mod order;
pub mod record;
pub mod schedule;
pub mod sensitivity;
pub mod summary;
