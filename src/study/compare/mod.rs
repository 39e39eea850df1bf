//! Two results of the same case, or nearly: how far apart they are, where and when, and what each cost.
//!
//! ```text
//! recording    a result folder as plain data
//! interpolate  cubics in time and along the beam
//! align        one recording at the times and places of the other
//! changes      what differs between the two cases
//! difference   norms of every field, history and quantity
//! many         several results beside one of them
//! ```
//!
//! The recording with fewer instants is never interpolated in time, that with fewer positions never along the beam: the
//! other one, which knows more, is brought to it. Displacements are interpolated by cubics through values and
//! velocities, everything else through four neighbours; both are of the fourth order in the interval, as is the
//! integrator's own polynomial of order 2 to 5 between its steps, which are shorter.

mod align;
pub mod changes;
pub mod difference;
pub mod interpolate;
pub mod many;
pub mod recording;

pub use difference::{Comparison, compare};
pub use many::Beside;
pub use recording::{Array, Recording, Series};
