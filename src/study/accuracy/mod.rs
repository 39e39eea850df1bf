//! Cost of accuracy: wall time and error of a case over tolerance, mesh, order and method.
//!
//! ```text
//! plan             requested settings, their cases, the budget
//! signals          compared data: histories, fields, quantities; vectors of the same length for every setting
//! norms            norms of vectors and of their differences
//! trial            runs of one setting, with work and times
//! cost_prediction  expected cost of the next run
//! scheme           time integration of a setting: method and order
//! tolerances       runs of one mesh and scheme over tolerances, and the error of the tightest run
//! sweep            all runs within the budget: points, then references
//! reference        best run on each mesh; limit of vanishing mesh size
//! errors           temporal, spatial and total error of every point
//! pareto_front     Pareto front, cheapest points, balance of temporal and spatial error, cost minimum
//! study            the complete study
//! ```
//!
//! **Errors.** Let `x(K, τ)` be the result on mesh `K` at tolerance `τ`, `r(K)` the best run on mesh `K`, and `X` the
//! limit of vanishing mesh size. The temporal error is `x(K, τ) - r(K)`, the spatial error `r(K) - X`, the total error
//! `x(K, τ) - X`, all relative to the size of `X`. The error of `r(K)` is estimated from its own sequence of tolerances
//! and, independently, from a run of another order. The error of `X` is estimated by Richardson extrapolation from
//! coarser meshes. A point whose error is less than ten times these estimates is marked as not judged.

pub mod cost_prediction;
pub mod errors;
pub mod norms;
pub mod pareto_front;
pub mod plan;
pub mod reference;
pub mod scheme;
pub mod signals;
pub mod study;
mod sweep;
pub mod tolerances;
pub mod trial;

pub use norms::Norms;
pub use plan::{Budget, StudyPlan, StudySetting};
pub use scheme::Scheme;
pub use study::{Study, study};
pub use sweep::StudyEvent;
