//! Ablation: what each effect does to a case, by running the full model without it.
//!
//! ```text
//! choices      which effects can be left out, and which others that takes
//! full         the case with all effects that it leaves to the program
//! trial        one run: work, time, figures; every set of effects is run once
//! change       how far the figures of two runs are apart, beside the integrator's own error
//! ablation     everything in order
//! recommend    what the case should leave out, checked by a run
//! ```
//!
//! **Change.** Largest difference of a quantity's figures to those of the full model, relative to the quantity's largest
//! figure; 1 where the quantity is gone. **Own error.** The same between the full model and itself at a tenth of the
//! tolerance: what is below it says nothing. **Work.** Residual evaluations times unknowns.

pub mod ablation;
pub mod change;
pub mod choices;
pub mod full;
mod recommend;
pub mod trial;

pub use ablation::{Ablation, Row, Verdict, ablate};
pub use recommend::Recommendation;
pub use trial::{Event, Plan};
