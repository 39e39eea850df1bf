//! What accuracy costs: time against error over tolerance, mesh, order and method, for everything a case is asked for.
//!
//! ```text
//! plan       settings asked for, the case of each, what may be spent
//! signals    what is compared: histories, fields, quantities; vectors that are equally long for every setting
//! norms      how far apart two vectors are
//! trial      one setting: run, repeated, counted
//! price      what the next run will cost
//! scheme     how a setting integrates in time
//! tolerances runs of one mesh and scheme over tolerances: what their sequence says of the error of the last
//! sweep      all runs within the budget: points, then references
//! reference  the best run on each mesh; the limit to which the meshes point
//! errors     temporal, spatial and total error of every point
//! front      the cheapest points, answers, balance of the two errors, the foot
//! study      everything in order
//! ```
//!
//! **Errors.** With `x(K, τ)` the result on mesh `K` at tolerance `τ`, `r(K)` the best run on mesh `K` and `X` the limit
//! to which the finest meshes point: temporal `x(K, τ) - r(K)`, spatial `r(K) - X`, total `x(K, τ) - X`, all relative to
//! the size of `X`. The error of `r(K)` is estimated by its own sequence of tolerances and, independently, by a run of
//! another order; that of `X` by Richardson extrapolation from coarser meshes. What is not ten times larger than these
//! is marked as not judged.

pub mod errors;
pub mod front;
pub mod norms;
pub mod plan;
pub mod price;
pub mod reference;
pub mod scheme;
pub mod signals;
pub mod study;
mod sweep;
pub mod tolerances;
pub mod trial;

pub use norms::Norms;
pub use plan::{Budget, Plan, Setting};
pub use scheme::Scheme;
pub use study::{Study, study};
pub use sweep::Event;
