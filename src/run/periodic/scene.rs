//! What repeats itself: a case in the long run, as one map of its state over a period.

use super::fluid;
use super::shoot::Search;
use crate::case::Translation;
use crate::case::schema::{Case, Choice, Effects};
use crate::dae::BeamDae;
use crate::discrete::{System, start};
use crate::error::{At, Code, Error, Result, SolverError};
use crate::integrate::{Absolute, IntegrationError, StartOptions, consistent_start};
use crate::model::Model;
use crate::onestep::step_map::StepError;
use crate::onestep::{Method, OneStep, OneStepOptions, StepMap};
use crate::run::drive::{Drive, drive, settled, settled_opening};
use crate::run::stop::{INTERRUPTED, Stop};

/// Steps of a period at least: signals are smooth, but a mode that is at rest has no say in the error test.
const LEAST_STEPS: f64 = 32.0;
/// Steps of a period at most: what asks for more is no cycle, but a motion that breaks up.
const MOST_STEPS: usize = 5000;

/// Method of the steps.
pub const METHOD: Method = Method::Esdirk46;

/// A case in the long run: everything that it describes, signals without their starts, a period.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The system.
    pub system: System,
    /// What repeats itself.
    pub drive: Drive,
    /// Tolerance of a step.
    pub rtol: f64,
    /// Method of the steps.
    pub method: Method,
    /// Periods of what drives the case that make up the one of the cycle.
    pub periods: usize,
    /// State from which the search sets out, scaled: the start of the case, at rest beside its ends, with the fluid that it has in the long run.
    pub guess: Vec<f64>,
    /// What is to be said of fluid behind valves that have shut, where there is some.
    pub trapped: Option<String>,
    /// Who may ask the search to end.
    pub stop: Stop,
    /// What is conserved: `w · y` of the scaled unknowns does not change. Of norm one, across each other.
    pub conserved: Vec<Vec<f64>>,
}

impl Scene {
    /// The case in the long run; `period` [s] where nothing in it is periodic.
    ///
    /// Everything that the case describes and does not leave out by name is there, whatever `auto` would leave out: what a
    /// motion can do without, a disturbance may grow from.
    ///
    /// # Errors
    /// A case without a period, see [`drive`]; fluid that gathers from period to period, or of which nobody knows how much there is; those
    /// of [`System::new`].
    pub fn new(case: &Case, period: Option<f64>) -> Result<Self> {
        let mut model = whole(case)?;
        let drive = drive(case, &model, period)?;
        model.replace_signals(settled, settled_opening);
        Self::of(case, model, drive)
    }

    /// Another model of the case, its signals settled; refused as by [`System::new`].
    pub fn of(case: &Case, model: Model, drive: Drive) -> Result<Self> {
        let system = System::with(case, model)?.accepted(case)?;
        let (guess, trapped) = guess(&system, case, drive.period)?;
        Ok(Self {
            guess,
            trapped,
            conserved: fluid::conserved(&system),
            system,
            drive,
            stop: Stop::default(),
            periods: 1,
            rtol: case.solver.rtol,
            method: METHOD,
        })
    }

    /// With somebody who may ask the search to end.
    pub fn heeding(mut self, stop: &Stop) -> Self {
        self.stop = stop.clone();
        self
    }

    /// That somebody has asked for the end.
    fn asked_to_end(&self) -> std::result::Result<(), StepError> {
        match self.stop.raised() {
            true => Err(StepError::new(0.0, INTERRUPTED)),
            false => Ok(()),
        }
    }

    /// A disturbance after a period; nothing of it once somebody has asked for the end, whereupon what is sought from it comes to its own.
    pub(super) fn carry(&self, march: &mut StepMap<BeamDae>, v: &mut [f64]) {
        if self.stop.raised() {
            return v.fill(0.0);
        }
        march.propagate(v);
        self.admit(v);
    }

    /// The system of a changed case in the long run, with the unknowns and scales of this one; none when the unknowns are then others.
    ///
    /// # Errors
    /// The case is not valid.
    pub fn like(&self, case: &Case) -> Result<Option<System>> {
        self.system
            .like_with(case, |model| model.replace_signals(settled, settled_opening))
    }

    /// What is conserved of a system of the same unknowns, and its amount in the long run of its case less that in a state: `w · (y₀ - y)`.
    ///
    /// # Errors
    /// Where that amount is not known.
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

    /// The equations, looking at signals as they are in the long run.
    pub fn dae(&self) -> BeamDae {
        let mut dae = BeamDae::new(self.system.clone());
        dae.enter_smooth_interval(0.5 * self.drive.period);
        dae
    }

    /// The period map around a state: the steps that the error test asks for from there.
    ///
    /// # Errors
    /// When the integrator cannot follow the motion for a period.
    pub fn map(&self, dae: BeamDae, y: &[f64]) -> std::result::Result<StepMap<BeamDae>, StepError> {
        let end = self.drive.period;
        let (mut dae, mut y, mut yp) = (dae, y.to_vec(), vec![0.0; y.len()]);
        consistent_start(&mut dae, 0.0, &mut y, &mut yp, &StartOptions::default())
            .map_err(|failure| StepError::new(0.0, failure.to_string()))?;
        let mut solver = OneStep::new(dae, 0.0, &y, &yp, &self.options()).map_err(error)?;
        let mut times = vec![0.0];
        while solver.time() < end {
            times.push(solver.step(end).map_err(error)?.time);
            self.asked_to_end()?;
            if times.len() > self.periods * MOST_STEPS {
                let what = format!("the motion asks for more than {MOST_STEPS} steps a period");
                return Err(StepError::new(solver.time(), what));
            }
        }
        StepMap::new(solver.into_dae(), self.method, times)
    }

    /// The steps that the error test asks for.
    fn options(&self) -> OneStepOptions {
        OneStepOptions {
            method: self.method,
            relative: self.rtol,
            absolute: Absolute::Same(self.rtol),
            max_step: Some(self.drive.period / (LEAST_STEPS * self.periods as f64)),
            ..OneStepOptions::default()
        }
    }

    /// The same over several periods, as one.
    pub fn over(&self, periods: usize) -> Self {
        let mut scene = self.clone();
        scene.drive.period *= periods as f64;
        scene.periods *= periods;
        scene
    }

    /// The state after some periods.
    ///
    /// # Errors
    /// When the integrator cannot follow the motion.
    pub fn go_on(&self, y: &[f64], periods: usize, search: &mut Search) -> std::result::Result<Vec<f64>, StepError> {
        let (mut dae, mut y, mut yp) = (self.dae(), y.to_vec(), vec![0.0; y.len()]);
        consistent_start(&mut dae, 0.0, &mut y, &mut yp, &StartOptions::default())
            .map_err(|failure| StepError::new(0.0, failure.to_string()))?;
        let mut solver = OneStep::new(dae, 0.0, &y, &yp, &self.options()).map_err(error)?;
        for period in 1..=periods {
            let (end, before) = (self.drive.period * period as f64, solver.steps());
            while solver.time() < end {
                solver.step(end).map_err(error)?;
                self.asked_to_end()?;
                if solver.steps() - before > (self.periods * MOST_STEPS) as u64 {
                    let what = format!("the motion asks for more than {MOST_STEPS} steps a period");
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

    /// Takes what is conserved out of a disturbance, and what is no disturbance of a state: algebraic unknowns.
    pub fn admit(&self, v: &mut [f64]) {
        for (v, differential) in v.iter_mut().zip(&self.system.layout.differential) {
            *v *= f64::from(u8::from(*differential));
        }
        for w in &self.conserved {
            let part: f64 = w.iter().zip(&*v).map(|(w, v)| w * v).sum();
            v.iter_mut().zip(w).for_each(|(v, w)| *v -= part * w);
        }
    }

    /// A state of another scene as a first guess here, in this one's scales and with the volumes of this one's start; none
    /// when the unknowns differ.
    pub fn take_over(&self, other: &Self, y: &[f64]) -> Option<Vec<f64>> {
        let (new, old) = (&self.system.layout, &other.system.layout);
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

    /// Says why there is no isolated cycle, when a beam may drift.
    ///
    /// # Errors
    /// [`Error::Usage`] for a beam that nothing holds along or across.
    pub fn held(&self, name: &str) -> Result<()> {
        let [root, tip] = &self.system.model.ends;
        let driven = |m: &Translation| matches!(m, Translation::Displacement(_));
        for (what, held) in [
            ("along", driven(&root.axial) || driven(&tip.axial)),
            ("across", driven(&root.transverse) || driven(&tip.transverse)),
        ] {
            if !held {
                return Err(Error::Usage(format!(
                    "{name}: nothing holds the beam {what}, so that every displaced cycle is a cycle too; hold one end"
                )));
            }
        }
        Ok(())
    }
}

/// The system of everything that a case describes.
///
/// # Errors
/// Those of [`System::new`].
pub fn system(case: &Case) -> Result<System> {
    System::with(case, whole(case)?)?.accepted(case)
}

/// Everything that a case describes; with inertia unless that is left out by name.
pub fn whole(case: &Case) -> Result<Model> {
    let off = matches!(&case.effects, Effects::Chosen(chosen) if chosen.solid_inertia == Choice::Off);
    Model::whole(case, !off)
}

fn error(failure: Box<IntegrationError>) -> StepError {
    StepError::new(failure.time, failure.to_string())
}

/// What happened, as the house says it.
pub fn fault(error: StepError) -> Error {
    Error::Solver(Box::new(SolverError {
        code: Code::NoCycle,
        at: At::Time(error.time),
        what: error.what,
        unknown: None,
        cause: Some("the motion could not be followed over a period".into()),
        hint: Some(
            "a smaller amplitude, a tighter /solver/rtol, or damping may help; `slcbeam run` shows the motion".into(),
        ),
    }))
}

/// The start of the case, as if its ends were at rest where they are, with the fluid that there is in the long run; and what is to be said of that.
fn guess(system: &System, case: &Case, period: f64) -> Result<(Vec<f64>, Option<String>)> {
    let mut dae = BeamDae::new(system.clone());
    dae.enter_smooth_interval(1.0);
    let (system, now) = dae.instant(0.0);
    let mut y = start::state(system, case, now);
    let l = &system.layout;
    let last = (system.mesh.nodes - 1) as f64;
    for (axis, line) in l.lines.iter().enumerate() {
        for (node, u, v) in line.unknowns() {
            y[u] += now.carried(axis, node as f64 / last).value / l.scales[u];
            if let Some(v) = v {
                y[v] = 0.0;
            }
        }
    }
    let told = fluid::fill(&mut dae, case, period, &mut y)?;
    Ok((y, told))
}
