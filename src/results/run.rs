//! `summary.json`: a run in time.

use super::{IntegratorRecord, ResultFile};
pub use crate::run::summary::{Accuracy, Balances, ProgramChoice, Quantity, Status, Summary};
pub use crate::run::uncertainty_band::{Band, Bands};

impl ResultFile for Summary {
    /// 3: `errors` and `companion` replace `estimate`. 2: `wall_s` covers all time from the start of the program, in more parts.
    const FORMAT: u32 = 3;

    fn integrator(&self) -> Option<IntegratorRecord> {
        IntegratorRecord::from_counters(&self.solver)
    }
}
