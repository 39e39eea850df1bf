//! The steady cycle of a periodically driven case, found directly.
//!
//! ```text
//! scene   a case in the long run: what repeats itself, what is conserved, the period map
//! fluid   how much of what is conserved there is
//! shoot   Newton's iteration on the period map
//! subharmonic  cycles that come back after several periods
//! record  one period of the cycle as a run
//! settle  the cycle at a tolerance at which its energies add up
//! sensitivity  its derivatives by numbers of the case
//! ```

mod fluid;
pub mod record;
pub mod scene;
pub mod sensitivity;
pub mod settle;
pub mod shoot;
pub mod subharmonic;

pub use scene::Scene;
pub use settle::{Settled, settle};
pub use shoot::{Cycle, Search, shoot};
