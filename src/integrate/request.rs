//! Checks of every integrator before it starts, and before a step.

use super::failure::IntegrationError;
use crate::dae::Dae;
use crate::sparse::{KluError, Lu, Pattern};

/// Analyzes the matrix of a system with `analyse`. Returns an error if the values `[y, y']` do not fit the system or the `options` are
/// invalid.
pub(crate) fn admit<D: Dae>(
    dae: &D,
    values: [&[f64]; 2],
    options: Result<(), String>,
    analyse: fn(&Pattern) -> Result<Lu, KluError>,
) -> Result<Lu, String> {
    let n = dae.len();
    if n == 0 || dae.pattern().columns() != n || dae.differential().len() != n {
        return Err(format!(
            "the pattern or the kinds of unknowns do not match the {n} unknowns"
        ));
    }
    let [y, yp] = values.map(<[f64]>::len);
    if y != n || yp != n {
        return Err(format!("{y} values and {yp} derivatives were given for {n} unknowns"));
    }
    options?;
    analyse(dae.pattern()).map_err(|fault| match fault {
        KluError::Singular { column } => format!("no equation determines {}", dae.name(column)),
        KluError::Package { status } => format!("KLU cannot analyse the pattern (status {status})"),
    })
}

/// True if a stop time [s] is reached to rounding error; a stop time in the past is an error.
pub(crate) fn reached(time: f64, stop: f64) -> Result<bool, Box<IntegrationError>> {
    let round_off = 100.0 * f64::EPSILON * (time.abs() + stop.abs());
    if stop.is_nan() || stop < time - round_off {
        let message = format!("the stop time {stop:e} s lies behind the current time {time:e} s");
        return Err(IntegrationError::request(message, time));
    }
    Ok(stop - time <= round_off)
}
