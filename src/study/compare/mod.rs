//! Comparison of two results of the same case, or of similar cases: differences, their positions and times, and costs.
//!
//! ```text
//! recording    a result folder as plain data
//! interpolate  cubics in time and along the beam
//! align        interpolation of one recording to the times and positions of the other
//! changes      differences between the two cases
//! difference   norms of every field, history and quantity
//! many         several results compared with one of them
//! ```
//!
//! The recording with fewer instants is never interpolated in time, and that with fewer positions never along the beam:
//! the finer recording is interpolated. Displacements are interpolated by cubics through values and velocities,
//! everything else through four neighbors. Both are of fourth order in the interval. The integrator's own polynomial is
//! of order 2 to 5 between its steps, which are shorter.

mod align;
pub mod changes;
pub mod difference;
pub mod interpolate;
pub mod many;
pub mod recording;

pub use difference::{Comparison, compare};
pub use many::ManyComparison;
pub use recording::{Array, Recording, Series};
