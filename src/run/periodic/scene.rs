//! Scene of a cycle: a case in the long run, as a map of its state over a period.

use super::fluid;
use super::shooting::ShootingRecord;
use crate::case::Translation;
use crate::case::schema::{Case, Choice, Effects};
use crate::dae::BeamDae;
use crate::discrete::{System, start};
use crate::error::{Code, Error, Result, SolverError, StopPoint};
use crate::integrate::{AbsoluteTolerances, IntegrationError, StartOptions, consistent_start};
use crate::model::Model;
use crate::onestep::step_map::StepError;
use crate::onestep::{OneStep, OneStepOptions, StepMap, TableauMethod};
use crate::run::drive::{PeriodicDrive, drive, settled, settled_opening};
use crate::run::stop::{INTERRUPTED, StopFlag};

/// Least number of steps in a period: signals are smooth, but a mode at rest does not affect the error test.
const LEAST_STEPS: f64 = 32.0;
/// Largest number of steps in a period: a motion that needs more is not a cycle, but breaks up.
const MOST_STEPS: usize = 5000;

/// Method of the steps.
pub const METHOD: TableauMethod = TableauMethod::Esdirk46;

/// Receives time [s], unknowns and rates [1/s] at the end of a step. Returns false to end the motion.
pub(super) type MotionWatcher<'a> = &'a mut dyn FnMut(f64, &[f64], &[f64]) -> bool;

/// A case in the long run: the full case, signals without their starts, and a period.
#[derive(Clone, Debug)]
pub struct PeriodicScene {
    /// The system.
    pub system: System,
    /// Periodic excitation.
    pub drive: PeriodicDrive,
    /// Tolerance of a step.
    pub rtol: f64,
    /// Method of the steps.
    pub method: TableauMethod,
    /// Number of drive periods in one period of the cycle.
    pub periods: usize,
    /// True for a self-oscillation: its period is an unknown.
    pub free_period: bool,
    /// First state of the search, scaled: the start of the case, at rest relative to its ends, with its amount of fluid in
    /// the long run.
    pub guess: Vec<f64>,
    /// Warning about fluid trapped behind closed valves, if there is any.
    pub trapped: Option<String>,
    /// Stop request for the search.
    pub stop: StopFlag,
    /// Conserved quantities: `w · y` of the scaled unknowns does not change. The vectors are orthonormal.
    pub conserved: Vec<Vec<f64>>,
}

impl PeriodicScene {
    /// The case in the long run; `period` [s] is used if no signal is periodic.
    ///
    /// Includes every effect that the case does not switch off by name, even if `auto` would neglect it. A disturbance may grow from
    /// an effect that is insignificant for the motion.
    ///
    /// # Errors
    /// The case has no period, see [`drive`]; fluid accumulates from period to period, or its amount is unknown; those of
    /// [`System::new`].
    pub fn new(case: &Case, period: Option<f64>) -> Result<Self> {
        let mut model = whole(case)?;
        let drive = drive(case, &model, period)?;
        model.replace_signals(settled, settled_opening);
        Self::with_model(case, model, drive)
    }

    /// Scene of another model of the case with settled signals; rejected as by [`System::new`].
    pub fn with_model(case: &Case, model: Model, drive: PeriodicDrive) -> Result<Self> {
        Self::with_system(case, System::with(case, model)?.accepted(case)?, drive)
    }

    /// Scene of a changed case with the unknowns and scales of this one; `None` if its unknowns differ.
    ///
    /// # Errors
    /// Those of [`PeriodicScene::new`].
    pub fn alike(&self, case: &Case) -> Result<Option<Self>> {
        let Some(system) = self.like(case)? else {
            return Ok(None);
        };
        let drive = drive(case, &system.model, None)?;
        Ok(Some(Self::with_system(case, system, drive)?.heeding(&self.stop)))
    }

    fn with_system(case: &Case, system: System, drive: PeriodicDrive) -> Result<Self> {
        let (guess, trapped) = guess(&system, case, drive.period)?;
        Ok(Self {
            guess,
            trapped,
            conserved: fluid::conserved(&system),
            system,
            drive,
            stop: StopFlag::default(),
            periods: 1,
            free_period: false,
            rtol: case.solver.rtol,
            method: METHOD,
        })
    }

    /// Sets the stop request that ends the search.
    pub fn heeding(mut self, stop: &StopFlag) -> Self {
        self.stop = stop.clone();
        self
    }

    /// Returns an error if a stop was requested.
    fn asked_to_end(&self) -> std::result::Result<(), StepError> {
        match self.stop.raised() {
            true => Err(StepError::new(0.0, INTERRUPTED)),
            false => Ok(()),
        }
    }

    /// Propagates a disturbance over a period. After a stop request the result is zero, so that a search based on it ends.
    pub(super) fn carry(&self, march: &mut StepMap<BeamDae>, v: &mut [f64]) {
        if self.stop.raised() {
            return v.fill(0.0);
        }
        march.propagate(v);
        self.admit(v);
    }

    /// System of a changed case in the long run, with the unknowns and scales of this one; `None` if its unknowns differ.
    ///
    /// # Errors
    /// The case is not valid.
    pub fn like(&self, case: &Case) -> Result<Option<System>> {
        self.system
            .like_with(case, |model| model.replace_signals(settled, settled_opening))
    }

    /// Long-run amount of each conserved quantity less the amount in a state, `w · (y₀ - y)`, for a system of the same unknowns.
    ///
    /// # Errors
    /// The long-run amount is unknown.
    pub fn kept(system: &System, case: &Case, period: f64, y: &[f64]) -> Result<Vec<f64>> {
        let (start, _) = guess(system, case, period)?;
        let lost = |w: &Vec<f64>| {
            w.iter()
                .zip(start.iter().zip(y))
                .map(|(w, (start, y))| w * (start - y))
                .sum()
        };
        Ok(fluid::conserved(system).iter().map(lost).collect())
    }

    /// The equations, with signals in their long-run form.
    pub fn dae(&self) -> BeamDae {
        let mut dae = BeamDae::new(self.system.clone());
        dae.enter_smooth_interval(0.5 * self.drive.period);
        dae
    }

    /// Period map around a state, with the steps that the error test requires from there.
    ///
    /// # Errors
    /// The integrator cannot follow the motion for a period.
    pub fn map(&self, dae: BeamDae, y: &[f64]) -> std::result::Result<StepMap<BeamDae>, StepError> {
        let end = self.drive.period;
        let mut solver = self.begin(dae, y)?;
        let mut times = vec![0.0];
        while solver.time() < end {
            times.push(solver.step(end).map_err(error)?.time);
            self.asked_to_end()?;
            if times.len() > self.periods * MOST_STEPS {
                let what = format!("the motion requires more than {MOST_STEPS} steps per period");
                return Err(StepError::new(solver.time(), what));
            }
        }
        StepMap::new(solver.into_dae(), self.method, times)
    }

    /// Integrator at a state, which is made consistent.
    fn begin(&self, mut dae: BeamDae, y: &[f64]) -> std::result::Result<OneStep<BeamDae>, StepError> {
        let (mut y, mut yp) = (y.to_vec(), vec![0.0; y.len()]);
        consistent_start(&mut dae, 0.0, &mut y, &mut yp, &StartOptions::default())
            .map_err(|failure| StepError::new(0.0, failure.to_string()))?;
        OneStep::new(dae, 0.0, &y, &yp, &self.options()).map_err(error)
    }

    /// Follows the motion from a state for at most a time [s]. Returns the last state.
    pub(super) fn follow(&self, y: &[f64], end: f64, look: MotionWatcher) -> std::result::Result<Vec<f64>, StepError> {
        let mut solver = self.begin(self.dae(), y)?;
        while solver.time() < end {
            solver.step(end).map_err(error)?;
            self.asked_to_end()?;
            if !look(solver.time(), solver.y(), solver.yp()) {
                break;
            }
        }
        Ok(solver.y().to_vec())
    }

    /// Options of the integrator whose steps are used.
    fn options(&self) -> OneStepOptions {
        OneStepOptions {
            method: self.method,
            relative: self.rtol,
            absolute: AbsoluteTolerances::Same(self.rtol),
            max_step: Some(self.drive.period / (LEAST_STEPS * self.periods as f64)),
            ..OneStepOptions::default()
        }
    }

    /// The scene with several periods as one.
    pub fn over(&self, periods: usize) -> Self {
        let mut scene = self.clone();
        scene.drive.period *= periods as f64;
        scene.periods *= periods;
        scene
    }

    /// State after a number of periods.
    ///
    /// # Errors
    /// The integrator cannot follow the motion.
    pub fn go_on(
        &self,
        y: &[f64],
        periods: usize,
        search: &mut ShootingRecord,
    ) -> std::result::Result<Vec<f64>, StepError> {
        let mut solver = self.begin(self.dae(), y)?;
        for period in 1..=periods {
            let (end, before) = (self.drive.period * period as f64, solver.steps());
            while solver.time() < end {
                solver.step(end).map_err(error)?;
                self.asked_to_end()?;
                if solver.steps() - before > (self.periods * MOST_STEPS) as u64 {
                    let what = format!("the motion requires more than {MOST_STEPS} steps per period");
                    return Err(StepError::new(solver.time(), what));
                }
            }
            search.periods += 1;
        }
        search.work.steps += solver.steps();
        Ok(solver.y().to_vec())
    }

    /// Weighted root mean square of a change of state: 1 is the tolerance.
    pub fn size(&self, change: &[f64], y: &[f64]) -> f64 {
        let square: f64 = change
            .iter()
            .zip(y)
            .map(|(d, y)| (d / (self.rtol * (1.0 + y.abs()))).powi(2))
            .sum();
        (square / y.len() as f64).sqrt()
    }

    /// Removes conserved quantities and algebraic unknowns from a disturbance.
    pub fn admit(&self, v: &mut [f64]) {
        for (v, differential) in v.iter_mut().zip(&self.system.layout.differential) {
            *v *= f64::from(u8::from(*differential));
        }
        for w in &self.conserved {
            let part: f64 = w.iter().zip(&*v).map(|(w, v)| w * v).sum();
            v.iter_mut().zip(w).for_each(|(v, w)| *v -= part * w);
        }
    }

    /// Converts a state of another scene to a first guess in this one: in its scales and with the volumes of its start. `None` if the
    /// unknowns differ.
    pub fn take_over(&self, other: &Self, y: &[f64]) -> Option<Vec<f64>> {
        self.convert(&other.system, y)
    }

    /// Converts a state of another system as [`PeriodicScene::take_over`].
    pub(super) fn convert(&self, other: &System, y: &[f64]) -> Option<Vec<f64>> {
        let (new, old) = (&self.system.layout, &other.layout);
        let same = new.len == old.len && new.differential == old.differential && new.network.area == old.network.area;
        let mut taken: Vec<f64> = same.then(|| {
            let scales = old.scales.iter().zip(&new.scales);
            y.iter().zip(scales).map(|(y, (old, new))| y * old / new).collect()
        })?;
        for w in &self.conserved {
            let lost: f64 = w
                .iter()
                .zip(self.guess.iter().zip(&taken))
                .map(|(w, (g, t))| w * (g - t))
                .sum();
            taken.iter_mut().zip(w).for_each(|(t, w)| *t += lost * w);
        }
        Some(taken)
    }

    /// Dimension of the states that a disturbance can reach.
    pub fn dimension(&self) -> usize {
        self.system.layout.differential.iter().filter(|d| **d).count() - self.conserved.len()
    }

    /// Rejects a beam that may drift, since it has no isolated cycle.
    ///
    /// # Errors
    /// [`Error::Usage`] for a beam that is not held along or across.
    pub fn held(&self, name: &str) -> Result<()> {
        if self.system.model.structure.is_some() {
            return match self.system.model.unheld()[..] {
                [] => Ok(()),
                _ => Err(Error::Usage(format!(
                    "{name}: nothing holds the structure, so every displaced cycle is also a cycle. Hold an end of a beam"
                ))),
            };
        }
        let [root, tip] = self.system.model.root_and_tip();
        let driven = |m: &Translation| matches!(m, Translation::Displacement(_));
        for (what, held) in [
            ("along", driven(&root.axial) || driven(&tip.axial)),
            ("across", driven(&root.transverse) || driven(&tip.transverse)),
        ] {
            if !held {
                return Err(Error::Usage(format!(
                    "{name}: nothing holds the beam {what}, so every displaced cycle is also a cycle. Hold one end"
                )));
            }
        }
        Ok(())
    }
}

/// System of the full case.
///
/// # Errors
/// Those of [`System::new`].
pub fn system(case: &Case) -> Result<System> {
    System::with(case, whole(case)?)?.accepted(case)
}

/// Model of the full case, with inertia unless this is switched off by name.
pub fn whole(case: &Case) -> Result<Model> {
    let off = matches!(&case.effects, Effects::Chosen(chosen) if chosen.solid_inertia == Choice::Off);
    Model::whole(case, !off)
}

fn error(failure: Box<IntegrationError>) -> StepError {
    StepError::new(failure.time, failure.to_string())
}

/// Converts an error of a step to the error of a failed search for a cycle.
pub fn fault(error: StepError) -> Error {
    Error::Solver(Box::new(SolverError {
        code: Code::NoCycle,
        at: StopPoint::Time(error.time),
        what: error.what,
        unknown: None,
        cause: (error.time > 0.0).then(|| "the motion could not be simulated over a period".into()),
        hint: Some(
            "a smaller amplitude, a tighter /solver/rtol, or damping may help, or --sweep from a value with a cycle; `slcbeam run` shows \
             the motion"
                .into(),
        ),
    }))
}

/// Start of the case with its ends at rest in their positions, and its long-run amount of fluid. Also returns a warning about trapped
/// fluid, if any.
fn guess(system: &System, case: &Case, period: f64) -> Result<(Vec<f64>, Option<String>)> {
    let mut dae = BeamDae::new(system.clone());
    dae.enter_smooth_interval(1.0);
    let (system, now) = dae.instant(0.0);
    let mut y = start::state(system, case, now);
    let l = &system.layout;
    for (axis, line) in l.lines.iter().enumerate() {
        for (node, u, v) in line.unknowns() {
            y[u] += now.carried(axis, system.mesh.share(node)).value / l.scales[u];
            if let Some(v) = v {
                y[v] = 0.0;
            }
        }
    }
    let warning = fluid::fill(&mut dae, case, period, &mut y)?;
    Ok((y, warning))
}
