//! `summary.json`: a run in time.

use super::{Integrator, Kept};
pub use crate::run::band::{Band, Bands};
pub use crate::run::summary::{Accuracy, Balances, Chosen, Quantity, Status, Summary};

impl Kept for Summary {
    /// 3: `errors` and `companion` replace `estimate`. 2: `wall_s` covers all time from the start of the program, in more parts.
    const FORMAT: u32 = 3;

    fn integrator(&self) -> Option<Integrator> {
        Integrator::of(&self.solver)
    }
}
