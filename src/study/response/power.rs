//! Mean powers of a forced small motion over a band.

use crate::error::{Error, Result};
use crate::run::response::LinearResponse;
use crate::run::response::power::{MeanPowers, PowerMeter};
use crate::study::in_halves;

/// Mean powers [E101] at frequencies [Hz], each from a solution there.
///
/// # Errors
/// [`Error::Usage`] if energy flows about the state already; a frequency that is a pole.
pub fn powers(response: &LinearResponse, frequencies: &[f64]) -> Result<Vec<MeanPowers>> {
    let moving = || {
        Error::Usage(
            "--power: energy flows at the state without the input, so that the power of small motions about it is not quadratic. Use \
             `slcbeam periodic`"
                .into(),
        )
    };
    in_halves(frequencies, |part| {
        let mut solver = response.solver()?;
        let mut meter = PowerMeter::new(response).ok_or_else(moving)?;
        let mean = |hz: &f64| {
            let (s, x) = solver.state(*hz)?;
            meter.mean(&x, s).ok_or_else(moving)
        };
        part.iter().map(mean).collect()
    })
}
