//! Steady cycle of a periodically driven case, or a self-oscillation, computed directly.
//!
//! ```text
//! scene           a case in the long run: its periodic signals, its conserved volumes, its period map
//! fluid           amount of fluid in the conserved volumes
//! parameter_scale values of a number of the case over a coordinate
//! family          cycles over one number of the case, through folds
//! shooting        Newton's iteration on the period map
//! resonance       the cycle at which drive and motion are a quarter period apart
//! subharmonic     cycles that return after several periods
//! self_oscillation  a cycle without a drive; its period is an unknown
//! record          one period of the cycle as a run
//! balanced_cycle  the cycle at a tolerance at which its energy balance closes
//! sensitivity     derivatives of the cycle by numbers of the case
//! ```

pub mod balanced_cycle;
pub mod family;
mod fluid;
pub mod parameter_scale;
pub mod record;
pub mod resonance;
pub mod scene;
pub mod self_oscillation;
pub mod sensitivity;
pub mod shooting;
pub mod subharmonic;

pub use balanced_cycle::{Settled, settle};
pub use scene::PeriodicScene;
pub use shooting::{Cycle, ShootingRecord, shoot};
