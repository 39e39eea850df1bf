//! Runs: what drives the solver over a model. Emits what happens, prints nothing.

pub mod checkpoint;
pub mod cubic;
pub mod drive;
pub mod dynamics;
pub mod energies;
pub mod equilibrium;
pub mod estimate;
pub mod figures;
pub mod fit;
pub mod floors;
pub mod floquet;
pub mod growth;
pub mod known;
pub mod krylov;
pub mod method;
pub mod modes;
pub mod observe;
pub mod order;
pub mod periodic;
pub mod range;
pub mod record;
pub mod residuals;
pub mod schedule;
pub mod sensitivity;
pub mod strides;
pub mod summary;
