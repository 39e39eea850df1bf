//! A run from one control instant to the next, with inputs that are held in between: for learning and control.

mod inputs;

use serde::{Deserialize, Serialize};

use inputs::Held;
pub use inputs::Input;

use super::faults::{beyond, fault, inconsistent, stalled, too_many_steps};
use super::pace::Pace;
use super::switch::switch;
use crate::case::Case;
use crate::dae::{BeamDae, Dae};
use crate::discrete::start;
use crate::error::{Error, Result, SolverError};
use crate::functions::{Ramp, RampShape, Signal};
use crate::integrate::{StartOptions, consistent_start};
use crate::onestep::OneStep;
use crate::run::equilibrium;
use crate::run::known;
use crate::run::observe::{Observed, Observer};
use crate::run::record::{Column, Control, Unrecorded};
use crate::run::schedule::{self, Stop};
use crate::run::strides::Strides;

/// Everything from which a [`Simulator`] of the same case and inputs goes on bit for bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Simulated time [s].
    pub t: f64,
    /// Values of the inputs.
    pub values: Vec<f64>,
    of: String,
    next: usize,
    y: Vec<f64>,
    yp: Vec<f64>,
    integrals: Vec<f64>,
    observed: Observed,
}

/// A case that is simulated piece by piece, by a one-step method: what came before an instant, besides the state, does not matter after it.
pub struct Simulator {
    /// What tells case and inputs from others.
    of: String,
    /// What there is to know of the case.
    known: Vec<String>,
    held: Vec<Held>,
    solver: OneStep<BeamDae>,
    observer: Observer,
    columns: Vec<Column>,
    stops: Vec<Stop>,
    next: usize,
    strides: Strides,
    end: f64,
    max_steps: u64,
    /// Size of the last step [s]; 0 before there is one.
    size: f64,
    state: Vec<f64>,
    rates: Vec<f64>,
    integrals: Vec<f64>,
    /// Integrals up to the last restart.
    carried: Vec<f64>,
}

impl Simulator {
    /// A case at its start; inputs begin with the values that the case gives them there.
    ///
    /// # Errors
    /// [`Error::Usage`] for an input that is no signal of the case, or one that must not jump; those of [`System::new`](crate::discrete::System::new); a start that cannot be
    /// found.
    pub fn new(case: &Case, inputs: &[Input]) -> Result<Self> {
        let of = inputs::mark(case, inputs);
        let (case, mut system, held) = inputs::taken(case, inputs)?;
        let known = known::lasting(&case, &system);
        for one in &held {
            system.put_signal(&one.places, &Signal::Constant(one.value));
        }
        let stops = schedule::stops(&case, &system.model);
        let strides = Strides::new(&case, &system);
        let options = inputs::options(&case, &system, strides.least())?;
        let observer = Observer::new(&case, &system, case.time.output_interval());
        let columns = Observer::header(&case, &system).columns;
        let mut dae = BeamDae::new(system);
        dae.enter_smooth_interval(0.5 * stops[0].t);
        let (system, now) = dae.instant(0.0);
        let mut state = start::state(system, &case, now);
        if let Some(start) = &case.start.equilibrium {
            let options = equilibrium::Options::of_start(start);
            state = equilibrium::at_start(&case, &options, &mut dae, &state).map_err(solver)?;
        }
        let mut rates = vec![0.0; state.len()];
        consistent_start(&mut dae, 0.0, &mut state, &mut rates, &StartOptions::default())
            .map_err(|failure| solver(inconsistent(0.0, &failure)))?;
        let zeros = vec![0.0; dae.integrals()];
        let mut this = Self {
            of,
            known,
            held,
            solver: OneStep::new(dae, 0.0, &state, &rates, &options).map_err(|failure| solver(fault(&failure)))?,
            observer,
            columns,
            stops,
            next: 0,
            strides,
            end: case.time.end_s,
            max_steps: case.solver.max_steps,
            size: 0.0,
            state,
            rates,
            integrals: zeros.clone(),
            carried: zeros,
        };
        this.enter()?;
        this.sample()?;
        Ok(this)
    }

    /// Simulated time [s].
    pub fn time(&self) -> f64 {
        self.solver.time()
    }

    /// The time at which the case ends [s].
    pub fn end(&self) -> f64 {
        self.end
    }

    /// What [`Simulator::row`] has, column by column.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The history's columns at the present time, in their units.
    pub fn row(&self) -> &[f64] {
        self.observer.row().values()
    }

    /// Values of the inputs.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.held.iter().map(|one| one.value)
    }

    /// Accepted steps so far, those since which a state was restored included.
    pub fn steps(&self) -> u64 {
        self.solver.steps()
    }

    /// What to know of the case, with inputs that go through their ranges, and of what has been simulated.
    pub fn warnings(&self) -> Vec<String> {
        let mut all = self.known.clone();
        all.extend(self.observer.warnings());
        all
    }

    /// Gives the inputs these values from now on and simulates until a time [s]. `ask` is asked after every step whether to go on; where it says
    /// no, that is where the simulation stands.
    ///
    /// # Errors
    /// [`Error::Usage`] for a time or values that cannot be; [`Error::Solver`] where the simulation cannot go on: it then stands where it
    /// last could, and [`Simulator::restore`] leads back.
    pub fn step(&mut self, until: f64, values: &[f64], ask: &mut dyn FnMut() -> Control) -> Result<()> {
        let t = self.time();
        if !(until > t && until <= self.end * (1.0 + 1e-12)) {
            return Err(Error::Usage(format!(
                "a step from t = {t} s to {until} s: it must lead on, and not beyond /time/end_s, which is {} s",
                self.end
            )));
        }
        inputs::admit(&self.held, values)?;
        if self.held.iter().zip(values).any(|(one, value)| one.value != *value) {
            self.set(values)?;
        }
        let done = self.advance(until.min(self.end), ask);
        self.sample()?;
        done
    }

    /// The present state. The simulator goes on from it as one that restores it does, bit for bit: its next step is a first one.
    ///
    /// # Errors
    /// The integrator's.
    pub fn save(&mut self) -> Result<Snapshot> {
        self.read(self.time())?;
        let snapshot = Snapshot {
            t: self.time(),
            values: self.values().collect(),
            of: self.of.clone(),
            next: self.next,
            y: self.state.clone(),
            yp: self.rates.clone(),
            integrals: self.integrals.clone(),
            observed: self.observer.seen.clone(),
        };
        self.restore(&snapshot)?;
        Ok(snapshot)
    }

    /// Goes back, or on, to a state that a simulator of the same case and inputs was in.
    ///
    /// # Errors
    /// [`Error::Usage`] for a state of another case.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<()> {
        let same = snapshot.of == self.of
            && snapshot.y.len() == self.state.len()
            && snapshot.yp.len() == self.rates.len()
            && snapshot.integrals.len() == self.carried.len()
            && snapshot.values.len() == self.held.len()
            && snapshot.observed.row.values().len() == self.columns.len()
            && snapshot.next < self.stops.len()
            && (0.0..=self.end).contains(&snapshot.t);
        if !same {
            return Err(Error::Usage("the state belongs to another case or other inputs".into()));
        }
        inputs::admit(&self.held, &snapshot.values)?;
        let t = snapshot.t;
        self.state.copy_from_slice(&snapshot.y);
        self.rates.copy_from_slice(&snapshot.yp);
        self.carried.copy_from_slice(&snapshot.integrals);
        (self.next, self.size) = (snapshot.next, 0.0);
        self.observer.seen.clone_from(&snapshot.observed);
        let ahead = 0.5 * (t + self.stops[self.next].t);
        let dae = self.solver.dae_mut();
        for (one, value) in self.held.iter_mut().zip(&snapshot.values) {
            one.value = *value;
            dae.put_signal(&one.places, &Signal::Constant(*value));
        }
        dae.enter_smooth_interval(ahead);
        self.restart(t)
    }

    /// Inputs jump to other values at the present time.
    fn set(&mut self, values: &[f64]) -> Result<()> {
        let t = self.time();
        self.leave_stretch()?;
        let dae = self.solver.dae_mut();
        for (one, value) in self.held.iter().zip(values) {
            let jump = Signal::Ramp(Ramp {
                from: one.value,
                to: *value,
                start_s: t,
                duration_s: 0.0,
                shape: RampShape::default(),
            });
            dae.put_signal(&one.places, &jump);
        }
        if t == 0.0 {
            dae.enter_smooth_interval(-1e-9 * self.end);
        }
        self.switch(t)?;
        let dae = self.solver.dae_mut();
        for (one, value) in self.held.iter_mut().zip(values) {
            one.value = *value;
            dae.put_signal(&one.places, &Signal::Constant(*value));
        }
        self.restart(t)?;
        // inputs that change often change little: a step that is too long for it is rejected
        self.solver.propose(self.size);
        Ok(())
    }

    /// Steps until a time, past whatever the case itself switches on the way.
    fn advance(&mut self, until: f64, ask: &mut dyn FnMut() -> Control) -> Result<()> {
        let (mut pace, mut steps) = (Pace::new(self.time()), 0);
        while self.time() < until {
            let stop = self.stops[self.next];
            let stride = self.strides.at(self.time());
            self.solver.limit(stride.largest);
            let target = until.min(stop.t).min(stride.to);
            let step = self.solver.step(target).map_err(|failure| solver(fault(&failure)))?;
            self.size = step.size;
            self.watch(step.time)?;
            steps += 1;
            if steps >= self.max_steps {
                return Err(solver(too_many_steps(step.time, step.size)));
            }
            if pace.stalled(steps, step.time, self.end) {
                return Err(solver(stalled(step.time, step.size)));
            }
            if step.stopped && step.time >= stop.t && self.next + 1 < self.stops.len() {
                self.leave_stretch()?;
                self.next += 1;
                if stop.switches {
                    self.switch(step.time)?;
                } else {
                    self.solver
                        .dae_mut()
                        .enter_smooth_interval(0.5 * (step.time + self.stops[self.next].t));
                }
                self.restart(step.time)?;
            }
            if let Control::Stop(_) = ask() {
                break;
            }
        }
        Ok(())
    }

    /// Looks at the end of an accepted step, and inside wherever the model may have been left.
    fn watch(&mut self, t: f64) -> Result<()> {
        self.read(t)?;
        let dae = self.solver.dae_mut();
        if let Some(what) = self.observer.arrive(dae, t, &self.state, &self.rates, &self.integrals) {
            return Err(solver(beyond(t, what)));
        }
        for k in 0..self.observer.turning().len() {
            let t = self.observer.turning()[k];
            self.read(t)?;
            let dae = self.solver.dae_mut();
            if let Some(what) = self.observer.look(dae, t, &self.state, &self.rates, &self.integrals) {
                return Err(solver(beyond(t, what)));
            }
        }
        Ok(())
    }

    /// State, rates and integrals at a time within the last step [s].
    fn read(&mut self, t: f64) -> Result<()> {
        let read = if t == self.solver.time() {
            self.state.copy_from_slice(self.solver.y());
            self.rates.copy_from_slice(self.solver.yp());
            self.solver.integrals(None, &mut self.integrals)
        } else {
            self.solver
                .interpolate(t, 0, &mut self.state)
                .and_then(|()| self.solver.interpolate(t, 1, &mut self.rates))
                .and_then(|()| self.solver.integrals(Some(t), &mut self.integrals))
        };
        let dae = self.solver.dae_mut();
        dae.keep_volumes(t, &mut self.state);
        for (total, carried) in self.integrals.iter_mut().zip(&self.carried) {
            *total += carried;
        }
        dae.settle(t, &mut self.integrals);
        read.map_err(|failure| solver(fault(&failure)))
    }

    /// Integrals up to the present time are carried over a restart.
    fn leave_stretch(&mut self) -> Result<()> {
        self.read(self.time())?;
        self.carried.copy_from_slice(&self.integrals);
        Ok(())
    }

    /// A consistent state behind a jump of signals at the present time, with what is done in no time.
    fn switch(&mut self, t: f64) -> Result<()> {
        let ahead = 0.5 * (t + self.stops[self.next].t);
        let values = [&mut self.state[..], &mut self.rates];
        switch(self.solver.dae_mut(), [t, ahead], values, &mut self.carried).map_err(solver)
    }

    fn restart(&mut self, t: f64) -> Result<()> {
        let restarted = self.solver.restart(t, &self.state, &self.rates);
        restarted.map_err(|failure| solver(fault(&failure)))?;
        self.enter()
    }

    /// Looks at the beginning of a smooth stretch.
    fn enter(&mut self) -> Result<()> {
        let t = self.time();
        self.integrals.copy_from_slice(&self.carried);
        let dae = self.solver.dae_mut();
        match self.observer.enter(dae, t, &self.state, &self.rates, &self.integrals) {
            Some(what) => Err(solver(beyond(t, what))),
            None => Ok(()),
        }
    }

    /// The history's columns at the present time.
    fn sample(&mut self) -> Result<()> {
        let t = self.time();
        self.read(t)?;
        let [y, yp, integrals] = [&self.state, &self.rates, &self.integrals];
        let nobody = &mut Unrecorded(|_: &_| Control::Continue);
        let dae = self.solver.dae_mut();
        self.observer.sample(dae, None, t, y, yp, integrals, nobody).map(|_| ())
    }
}

fn solver(fault: SolverError) -> Error {
    Error::Solver(Box::new(fault))
}
