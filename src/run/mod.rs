//! Runs: what drives the solver over a model. Emits what happens, prints nothing.

pub mod checkpoint;
pub mod drive;
pub mod dynamics;
pub mod energies;
pub mod equilibrium;
pub mod estimate;
pub mod figures;
pub mod floquet;
pub mod growth;
pub mod krylov;
pub mod method;
pub mod modes;
pub mod observe;
pub mod order;
pub mod periodic;
pub mod record;
pub mod schedule;
pub mod sensitivity;
pub mod summary;
