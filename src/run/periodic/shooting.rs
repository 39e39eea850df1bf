//! The steady cycle by shooting: Newton's iteration on the period map.

use serde::{Deserialize, Serialize};

use super::scene::PeriodicScene;
use crate::case::schema::Case;
use crate::dae::BeamDae;
use crate::integrate::{StartOptions, consistent_start};
use crate::numerics::kernels::dot;
use crate::numerics::krylov;
use crate::onestep::StepMap;
use crate::onestep::step_map::{StepError, StepMapWork};
use crate::run::state_range::StateRange;
use crate::run::stop::INTERRUPTED;

/// Newton correction, over the tolerance, at which a cycle counts as found.
const FOUND: f64 = 0.05;
/// Newton correction, over the tolerance, at which the steps are chosen anew.
const NEAR: f64 = 10.0;
/// Relative residual of the linear equations.
const LINEAR: f64 = 1e-3;
/// Largest number of disturbances propagated in one Newton step.
pub(super) const MOST_DISTURBANCES: usize = 300;
/// Largest number of Newton steps.
const ITERATIONS: usize = 30;
/// Smallest fraction of a Newton step.
const SHORTEST: f64 = 1.0 / 64.0;
/// Number of periods simulated before a second attempt, doubled before each further one, and number of further attempts.
const PATIENCE: usize = 12;
const ATTEMPTS: u32 = 4;

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
        Err(first) => {
            let (mut later, mut last) = (scene.guess.clone(), first);
            for k in 0..ATTEMPTS {
                later = scene.go_on(&later, PATIENCE << k, &mut search)?;
                match attempt(scene, later.clone(), &mut search) {
                    Err(error) if !scene.stop.raised() => last = error,
                    found => return found,
                }
            }
            Err(last)
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
            return finish(scene, march, y, search, [correction, size]);
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

/// Iteration with a further unknown, by full Newton steps.
pub(super) struct FullSteps {
    /// True once the steps of the period map are chosen anew near the cycle.
    fresh: bool,
    /// Last correction over the tolerance.
    before: f64,
}

/// State of such an iteration after a correction.
pub(super) enum Convergence {
    /// The cycle is found.
    Found,
    /// The iteration diverges.
    Lost,
    /// The steps are to be chosen anew.
    Near,
    /// It goes on.
    Far,
}

impl FullSteps {
    pub(super) fn new() -> Self {
        Self {
            fresh: false,
            before: f64::INFINITY,
        }
    }

    /// Judges a correction over the tolerance. It ends at one that is small, or that rounding errors keep from becoming smaller.
    pub(super) fn judge(&mut self, correction: f64) -> Convergence {
        let stagnates = correction <= 1.0 && correction > 0.5 * self.before;
        if self.fresh && (correction <= FOUND || stagnates) {
            return Convergence::Found;
        }
        if !correction.is_finite() || correction > 4.0 * self.before {
            return Convergence::Lost;
        }
        self.before = correction;
        if self.fresh || correction > NEAR {
            return Convergence::Far;
        }
        (self.fresh, self.before) = (true, f64::INFINITY);
        Convergence::Near
    }
}

pub(super) fn lost(how: String) -> StepError {
    StepError::new(0.0, format!("no cycle was found: {how}"))
}

fn move_by(y: &mut [f64], step: &[f64], part: f64) {
    y.iter_mut().zip(step).for_each(|(y, step)| *y += part * step);
}

/// Simulates one period of a search. Returns the final state minus the initial one.
fn depart(
    scene: &PeriodicScene,
    march: &mut StepMap<BeamDae>,
    y: &[f64],
    search: &mut ShootingRecord,
) -> Result<Vec<f64>, StepError> {
    search.periods += 1;
    Ok(pass(scene, march, y)?.open)
}

/// The cycle that a search ends with; completes its record by the last correction and residual over the tolerance.
pub(super) fn finish(
    scene: &PeriodicScene,
    march: StepMap<BeamDae>,
    mut y: Vec<f64>,
    search: &mut ShootingRecord,
    [correction, residual]: [f64; 2],
) -> Result<Cycle, StepError> {
    (search.correction, search.residual) = (correction, residual);
    search.steps_per_period = march.times().len() - 1;
    search.work += march.work();
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

/// Norm of a motion of the size of the tolerance.
pub(super) fn smallest(scene: &PeriodicScene) -> f64 {
    scene.rtol * (scene.guess.len() as f64).sqrt()
}

/// Ranges of all unknowns along a motion.
pub(super) struct Ranges([Vec<f64>; 2]);

impl Ranges {
    pub(super) fn new(y: &[f64]) -> Self {
        Self([y.to_vec(), y.to_vec()])
    }

    pub(super) fn add(&mut self, y: &[f64]) {
        let [low, high] = &mut self.0;
        for ((low, high), y) in low.iter_mut().zip(high).zip(y) {
            (*low, *high) = (low.min(*y), high.max(*y));
        }
    }

    /// Half ranges.
    pub(super) fn half(&self) -> Vec<f64> {
        let [low, high] = &self.0;
        high.iter().zip(low).map(|(high, low)| 0.5 * (high - low)).collect()
    }
}

/// One period from a state.
pub(super) struct PeriodPass {
    /// Final state minus the initial one.
    pub(super) open: Vec<f64>,
    /// Norm of half the range of every unknown.
    pub(super) size: f64,
    /// Rates at the end [1/s].
    pub(super) rates: Vec<f64>,
}

/// Simulates one period.
pub(super) fn pass(scene: &PeriodicScene, march: &mut StepMap<BeamDae>, y: &[f64]) -> Result<PeriodPass, StepError> {
    let (mut end, mut yp) = (y.to_vec(), vec![0.0; y.len()]);
    let mut ranges = Ranges::new(y);
    march.go(&mut end, &mut yp, &mut |_, _, y| ranges.add(y))?;
    let mut open: Vec<f64> = end.iter().zip(y).map(|(end, y)| end - y).collect();
    scene.admit(&mut open);
    let mut half = ranges.half();
    scene.admit(&mut half);
    scene.admit(&mut yp);
    Ok(PeriodPass {
        open,
        size: dot(&half, &half).sqrt().max(smallest(scene)),
        rates: yp,
    })
}
