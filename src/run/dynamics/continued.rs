//! Run from a given state, with given derivatives.

use super::{End, Outcome, Run};
use crate::case::parameter::Parameter;
use crate::case::schema::Case;
use crate::discrete::System;
use crate::error::Result;
use crate::run::record::Recorder;
use crate::run::sensitivity::forward::{Alike, DerivativeParameters};

/// Derivatives that are integrated from given initial values.
pub struct ContinuedDerivatives<'a> {
    /// Numbers of the case by which to differentiate.
    pub by: &'a [Parameter],
    /// Systems of changed cases.
    pub alike: &'a Alike<'a>,
    /// Derivatives of the scaled differential unknowns at t = 0 by the relative change of each number.
    pub s: &'a [Vec<f64>],
}

/// Runs a system of the case from consistent values and rates of its scaled unknowns at t = 0.
pub fn go_on(
    case: &Case,
    system: System,
    [y, yp]: [&[f64]; 2],
    along: Option<&ContinuedDerivatives<'_>>,
    recorder: &mut dyn Recorder,
) -> Result<Outcome> {
    let by = along.map_or(DerivativeParameters::default(), |along| DerivativeParameters {
        alike: Some(along.alike),
        ..DerivativeParameters::pointers(along.by)
    });
    let (mut run, mut dae) = Run::new(case, system, by)?;
    dae.enter_smooth_interval(0.5 * run.stops[0].t);
    run.prepare(&dae);
    run.state.copy_from_slice(y);
    run.rates.copy_from_slice(yp);
    dae.find_turns(0.0, y, yp);
    if let (Some(forward), Some(along)) = (&mut run.forward, along) {
        forward.begin_from(&mut dae, along.s);
        if let Err(fault) = forward.complete(&mut dae, 0.0, [y, yp]) {
            return Ok(run.finish(End::Failed(fault)));
        }
    }
    let header = run.header(dae.system());
    let end = run.solve(dae, 0.0, 0, Some(header), recorder)?;
    Ok(run.finish(end))
}
