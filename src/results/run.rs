//! `summary.json`: a run in time.

use super::{IntegratorRecord, ResultFile};
pub use crate::run::band::{Band, Bands};
pub use crate::run::summary::{Accuracy, Balances, ProgramChoice, Quantity, Status, Summary};

impl ResultFile for Summary {
    /// 3: `errors` and `companion` replace `estimate`. 2: `wall_s` covers all time from the start of the program, in more parts.
    const FORMAT: u32 = 3;

    fn integrator(&self) -> Option<IntegratorRecord> {
        IntegratorRecord::of(&self.solver)
    }
}
