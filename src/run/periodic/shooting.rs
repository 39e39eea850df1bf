//! The steady cycle by shooting: Newton's iteration on the period map.

use serde::{Deserialize, Serialize};

use super::scene::PeriodicScene;
use crate::case::schema::Case;
use crate::dae::BeamDae;
use crate::integrate::{StartOptions, consistent_start};
use crate::numerics::krylov;
use crate::onestep::StepMap;
use crate::onestep::step_map::{StepError, StepMapWork};
use crate::run::state_range::StateRange;
use crate::run::stop::INTERRUPTED;

/// Newton correction, over the tolerance, at which a cycle counts as found.
pub(super) const FOUND: f64 = 0.05;
/// Newton correction, over the tolerance, at which the steps are chosen anew.
pub(super) const NEAR: f64 = 10.0;
/// Relative residual of the linear equations.
const LINEAR: f64 = 1e-3;
/// Largest number of disturbances propagated in one Newton step.
pub(super) const MOST_DISTURBANCES: usize = 300;
/// Largest number of Newton steps.
const ITERATIONS: usize = 30;
/// Smallest fraction of a Newton step.
const SHORTEST: f64 = 1.0 / 64.0;
/// Number of periods simulated before a second attempt.
const PATIENCE: usize = 12;

/// A state that recurs after a period.
pub struct Cycle {
    /// All unknowns at the beginning of the period, scaled, consistent.
    pub y: Vec<f64>,
    /// Rates of the unknowns [1/s].
    pub yp: Vec<f64>,
    /// Period map around the state, evaluated on its steps.
    pub march: StepMap<BeamDae>,
    /// Record of the search.
    pub search: ShootingRecord,
}

impl Cycle {
    /// Warnings of states of the cycle outside the range of the model.
    pub fn range(&mut self, case: &Case, scene: &PeriodicScene) -> Vec<String> {
        let mut range = StateRange::new(case, &scene.system, true);
        let (mut y, mut yp) = (self.y.clone(), self.yp.clone());
        // steps of a cycle that was found do not fail
        let _ = self.march.go(&mut y, &mut yp, &mut |dae, t, y| range.add(dae, t, y));
        range.warnings()
    }
}

/// Record of the search for a cycle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShootingRecord {
    /// Number of simulated periods: one for each Newton step, more if a step was shortened or a start was simulated.
    pub periods: u64,
    /// Newton steps.
    pub newton_steps: u64,
    /// Last Newton correction over the tolerance.
    pub correction: f64,
    /// State after a period minus the initial one, over the tolerance.
    pub residual: f64,
    /// Steps of the period map.
    pub steps_per_period: usize,
    /// Work of the whole search.
    pub work: StepMapWork,
}

/// `[E37]` Finds a cycle from a state near it, or from the start of the case if `from` is `None`.
///
/// ```text
/// P(y) = y     (1 - M) δ = P(y) - y,   M = ∂P/∂y     w · δ = 0 for every conserved w · y
/// ```
///
/// P is the period map with fixed steps, M its exact derivative, applied to vectors. GMRES computes δ within the states of equal
/// conserved volumes, where `1 - M` is regular. The steps are chosen anew once the cycle is near.
///
/// # Errors
/// No cycle was found; the error has the instant and the reason.
pub fn shoot(scene: &PeriodicScene, from: Option<&[f64]>) -> Result<Cycle, StepError> {
    let mut search = ShootingRecord::default();
    let begin = from.unwrap_or(&scene.guess);
    match attempt(scene, begin.to_vec(), &mut search) {
        Ok(cycle) => Ok(cycle),
        Err(error) if scene.stop.raised() => Err(error),
        Err(_) => {
            let later = scene.go_on(&scene.guess, PATIENCE, &mut search)?;
            attempt(scene, later, &mut search)
        }
    }
}

/// Newton's iteration from one state.
pub(super) fn attempt(scene: &PeriodicScene, mut y: Vec<f64>, search: &mut ShootingRecord) -> Result<Cycle, StepError> {
    let mut march = scene.map(scene.dae(), &y)?;
    let mut fresh = false;
    let mut back = depart(scene, &mut march, &y, search)?;
    for _ in 0..ITERATIONS {
        let size = scene.size(&back, &y);
        let most = scene.dimension().min(MOST_DISTURBANCES);
        let (step, _) = krylov::solve(|v| scene.carry(&mut march, v), &back, LINEAR, most);
        if scene.stop.raised() {
            return Err(StepError::new(0.0, INTERRUPTED));
        }
        search.newton_steps += 1;
        let correction = scene.size(&step, &y);
        if correction <= FOUND && fresh {
            (search.correction, search.residual) = (correction, size);
            search.steps_per_period = march.times().len() - 1;
            search.work += march.work();
            return finish(scene, march, y, search);
        }
        if !fresh && correction <= NEAR {
            move_by(&mut y, &step, 1.0);
            search.work += march.work();
            march = scene.map(march.into_dae(), &y)?;
            fresh = true;
            back = depart(scene, &mut march, &y, search)?;
            continue;
        }
        let mut part = 1.0;
        loop {
            let mut trial = y.clone();
            move_by(&mut trial, &step, part);
            match depart(scene, &mut march, &trial, search) {
                Ok(again) if scene.size(&again, &trial) < size * (1.0 - 0.25 * part) || correction <= 1.0 => {
                    (y, back) = (trial, again);
                    break;
                }
                Ok(_) | Err(_) if part > SHORTEST => part *= 0.5,
                Ok(_) => {
                    return Err(lost(format!(
                        "Newton's iteration stagnates at a residual of {size:.1e} times the tolerance"
                    )));
                }
                Err(error) => return Err(error),
            }
        }
    }
    Err(lost(format!(
        "Newton's iteration did not converge in {ITERATIONS} steps"
    )))
}

pub(super) fn lost(how: String) -> StepError {
    StepError::new(0.0, format!("no cycle was found: {how}"))
}

fn move_by(y: &mut [f64], step: &[f64], part: f64) {
    y.iter_mut().zip(step).for_each(|(y, step)| *y += part * step);
}

/// Simulates one period. Returns the final state minus the initial one.
fn depart(
    scene: &PeriodicScene,
    march: &mut StepMap<BeamDae>,
    y: &[f64],
    search: &mut ShootingRecord,
) -> Result<Vec<f64>, StepError> {
    let (mut end, mut yp) = (y.to_vec(), vec![0.0; y.len()]);
    search.periods += 1;
    march.go(&mut end, &mut yp, &mut |_, _, _| {})?;
    let mut back: Vec<f64> = end.iter().zip(y).map(|(end, y)| end - y).collect();
    scene.admit(&mut back);
    Ok(back)
}

pub(super) fn finish(
    scene: &PeriodicScene,
    march: StepMap<BeamDae>,
    mut y: Vec<f64>,
    search: &ShootingRecord,
) -> Result<Cycle, StepError> {
    let mut yp = vec![0.0; y.len()];
    let mut dae = scene.dae();
    consistent_start(&mut dae, 0.0, &mut y, &mut yp, &StartOptions::default())
        .map_err(|failure| StepError::new(0.0, failure.to_string()))?;
    Ok(Cycle {
        y,
        yp,
        march,
        search: search.clone(),
    })
}
