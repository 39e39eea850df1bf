//! Ablation: the influence of each effect on a case, from runs of the full model without it.
//!
//! ```text
//! choices        effects that can be left out, and others that are left out with them
//! full_model     the case with all effects that it leaves to the program
//! trial          one run: work, time, figures; every set of effects is run once
//! figure_change  changes of figures between two runs, and the integrator's own error
//! ablation       all runs, and the verdict on each effect
//! recommend      effects that the case should leave out, checked by a run
//! ```
//!
//! **Change.** Largest difference of a quantity's figures from those of the full model, relative to the quantity's
//! largest figure; 1 if the quantity is missing. **Own error.** Change between the full model and the full model at a
//! tenth of the tolerance. Changes below it are not significant. **Work.** Residual evaluations times unknowns.

pub mod ablation;
pub mod choices;
pub mod figure_change;
pub mod full_model;
mod recommend;
pub mod trial;

pub use ablation::{Ablation, AblationRow, EffectVerdict, ablate};
pub use recommend::Recommendation;
pub use trial::{TrialEvent, TrialPlan};
