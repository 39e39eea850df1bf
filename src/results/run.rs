//! `summary.json`: a run in time.

use super::{Integrator, Kept};
pub use crate::run::summary::{Accuracy, Balances, Chosen, Quantity, Status, Summary};

impl Kept for Summary {
    fn integrator(&self) -> Option<Integrator> {
        Integrator::of(&self.solver)
    }
}
