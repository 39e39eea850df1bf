//! One period of a cycle as a run of its own, recorded like any other.

use super::scene::PeriodicScene;
use super::shooting::Cycle;
use crate::case::schema::Case;
use crate::error::Result;
use crate::run::dynamics::{self, Outcome};
use crate::run::record::Recorder;

/// Number of output times in a period.
const OUTPUTS: f64 = 200.0;

/// Runs a cycle over one period from its beginning, with the case's own integrator and tolerance. The window and the run are this
/// period. Time counts from the beginning of the period, a whole number of periods after all smooth starts.
///
/// # Errors
/// The recorder fails. A failing solver is part of the [`Outcome`].
pub fn record(case: &Case, scene: &PeriodicScene, cycle: &Cycle, recorder: &mut dyn Recorder) -> Result<Outcome> {
    let case = one_period(case, scene.drive.period);
    let mut outcome = dynamics::go_on(&case, scene.system.clone(), [&cycle.y, &cycle.yp], None, recorder)?;
    outcome.summary.warnings.extend(scene.trapped.clone());
    Ok(outcome)
}

/// The case with times that fit one period [s].
pub fn one_period(case: &Case, period: f64) -> Case {
    let mut case = case.clone();
    case.time.end_s = period;
    case.time.output_interval_s = Some(period / OUTPUTS);
    case.time.fields_interval_s = Some(period / OUTPUTS);
    case.time.window_s = Some(period);
    case.time.checkpoint_interval_s = None;
    case.time.history = Default::default();
    case
}
