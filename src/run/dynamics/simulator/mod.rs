//! Simulation from one control instant to the next, with constant inputs in between: for learning and control.

mod inputs;
mod observer;
mod oscillations;
mod snapshot;
mod stops;
mod wall_time;

use std::time::Instant;

use inputs::HeldInput;
pub use inputs::SimulatorInput;
pub use snapshot::Snapshot;
pub use wall_time::SimulatorWallTimes;

use super::faults::{beyond, fault, inconsistent, stalled, too_many_steps};
use super::follow::narrow;
use super::stall::StallDetector;
use super::switch::switch;
use crate::case::Case;
use crate::dae::{BeamDae, Dae};
use crate::discrete::{resolution, start};
use crate::error::{Error, Result, SolverError};
use crate::functions::Signal;
use crate::integrate::{StartOptions, Starter};
use crate::onestep::OneStep;
use crate::run::control_loop::ControlLoop;
use crate::run::early_warnings;
use crate::run::equilibrium;
use crate::run::max_step::StepLimits;
use crate::run::observe::Observer;
use crate::run::record::{Control, HistoryColumn, Unrecorded};
use crate::run::schedule::{self, ScheduledStop};

/// Tolerance of consistent values after a jump of inputs, over the relative tolerance; rates count times the length of a step.
const CONSISTENT: f64 = 0.1;

/// A case that is simulated piece by piece with a one-step method. After an instant only the state matters, not its history.
pub struct Simulator {
    /// Hash that identifies case and inputs.
    of: String,
    case: Box<Case>,
    /// Warnings of the case that are valid on any mesh.
    known: Vec<String>,
    held: Vec<HeldInput>,
    solver: OneStep<BeamDae>,
    starter: Starter,
    consistent: StartOptions,
    observer: Observer,
    control: ControlLoop,
    columns: Vec<HistoryColumn>,
    stops: Vec<ScheduledStop>,
    next: usize,
    /// Present pieces of the courses of inputs that must not jump: start, and end if one of them moves [s].
    course: (f64, Option<f64>),
    strides: StepLimits,
    end: f64,
    max_steps: u64,
    state: Vec<f64>,
    rates: Vec<f64>,
    integrals: Vec<f64>,
    /// Integrals up to the last restart.
    carried: Vec<f64>,
    spent: SimulatorWallTimes,
}

impl Simulator {
    /// Creates the simulator of a case at its start; inputs begin with the values in the case.
    ///
    /// # Errors
    /// [`Error::Usage`] for an input that is not a signal of the case; those of
    /// [`System::new`](crate::discrete::System::new); a start that cannot be found.
    pub fn new(case: &Case, inputs: &[SimulatorInput]) -> Result<Self> {
        let of = inputs::mark(case, inputs);
        let (case, mut system, held) = inputs::taken(case, inputs)?;
        let known = early_warnings::on_any_mesh(&case, &system);
        for one in &held {
            system.put_signal(&one.places, &Signal::Constant(one.value));
        }
        let stops = schedule::stops(&case, &system.model);
        let strides = StepLimits::new(&case, &system);
        let options = inputs::options(&case, &system, strides.least())?;
        let observer = Observer::new(&case, &system, case.time.output_interval());
        let columns = Observer::header(&case, &system).columns;
        let mut dae = BeamDae::new(system);
        dae.enter_smooth_interval(0.5 * stops[0].t);
        let (system, now) = dae.instant(0.0);
        let mut state = start::state(system, &case, now);
        if let Some(start) = &case.start.equilibrium {
            let options = equilibrium::EquilibriumOptions::of_start(start);
            state = equilibrium::at_start(&case, &options, &mut dae, &state).map_err(solver)?;
        }
        let mut rates = vec![0.0; state.len()];
        let mut starter = Starter::new(&dae).map_err(|failure| solver(inconsistent(0.0, &failure)))?;
        starter
            .start(&mut dae, 0.0, &mut state, &mut rates, &StartOptions::default())
            .map_err(|failure| solver(inconsistent(0.0, &failure)))?;
        let zeros = vec![0.0; dae.integrals()];
        let mut control = ControlLoop::new(dae.system(), case.time.end_s);
        if control
            .sample(&mut dae, 0.0, [&state, &rates, &zeros])
            .map_err(solver)?
        {
            starter
                .start(&mut dae, 0.0, &mut state, &mut rates, &StartOptions::default())
                .map_err(|failure| solver(inconsistent(0.0, &failure)))?;
        }
        let mut this = Self {
            of,
            known,
            held,
            starter,
            consistent: StartOptions {
                tolerance: CONSISTENT * case.solver.rtol,
                ..StartOptions::default()
            },
            solver: OneStep::new(dae, 0.0, &state, &rates, &options).map_err(|failure| solver(fault(&failure)))?,
            observer,
            control,
            columns,
            stops,
            next: 0,
            course: (0.0, None),
            strides,
            end: case.time.end_s,
            max_steps: case.solver.max_steps,
            state,
            rates,
            case: Box::new(case),
            integrals: zeros.clone(),
            carried: zeros,
            spent: SimulatorWallTimes::default(),
        };
        this.enter()?;
        this.sample()?;
        Ok(this)
    }

    /// Simulated time [s].
    pub fn time(&self) -> f64 {
        self.solver.time()
    }

    /// End time of the case [s].
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Columns of [`Simulator::row`].
    pub fn columns(&self) -> &[HistoryColumn] {
        &self.columns
    }

    /// Values of the history's columns at the present time, in their units.
    pub fn row(&self) -> &[f64] {
        self.observer.row().values()
    }

    /// Values of the inputs.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.held.iter().map(|one| one.value)
    }

    /// Number of accepted steps so far, including those undone by a restored state.
    pub fn steps(&self) -> u64 {
        self.solver.steps()
    }

    /// Wall time of [`Simulator::step`] so far.
    pub fn spent(&self) -> SimulatorWallTimes {
        self.spent
    }

    /// Warnings of the case, for inputs that span their ranges, and of the simulation so far; those of the mesh for inputs
    /// as they were.
    pub fn warnings(&self) -> Vec<String> {
        let mut system = self.solver.dae().system().clone();
        for one in &self.held {
            system.put_signal(&one.places, &one.swings.like());
        }
        let mut all = self.known.clone();
        all.extend(resolution::warnings(&self.case, &system));
        all.extend(self.observer.warnings());
        all.extend(self.control.warnings());
        all
    }

    /// Sets the inputs and simulates until time `until` [s]. An input that must not jump reaches its value at that time, by a
    /// cubic. `ask` decides after every step if the simulation continues; if not, it remains at that time.
    ///
    /// # Errors
    /// [`Error::Usage`] for an invalid time or invalid values; [`Error::Solver`] if the simulation fails. It then remains at its last
    /// valid time, and [`Simulator::restore`] returns to an earlier state.
    pub fn step(&mut self, until: f64, values: &[f64], ask: &mut dyn FnMut() -> Control) -> Result<()> {
        let (t, mut clock) = (self.time(), Instant::now());
        if !(until > t && until <= self.end * (1.0 + 1e-12)) {
            return Err(Error::Usage(format!(
                "a step from t = {t} s to {until} s: its end must be later than its start, and at most /time/end_s, {} s",
                self.end
            )));
        }
        inputs::admit(&self.held, values)?;
        let until = self.at_stop(until).min(self.end);
        if self.course.1.is_some() || self.held.iter().zip(values).any(|(one, value)| one.value != *value) {
            self.set(values, until)?;
        }
        SimulatorWallTimes::add(&mut self.spent.jumps, &mut clock);
        let done = self.advance(until, ask);
        let mut clock = Instant::now();
        self.sample()?;
        SimulatorWallTimes::add(&mut self.spent.watching, &mut clock);
        done
    }

    /// Changes the inputs at the present time by jumps, together with everything that the case itself switches there. Inputs that must not
    /// jump begin to move, until time `until` [s].
    fn set(&mut self, values: &[f64], until: f64) -> Result<()> {
        let t = self.time();
        self.leave_stretch()?;
        let behind = self.behind(t);
        let dae = self.solver.dae_mut();
        dae.enter_smooth_interval(behind);
        if self.stands_at_stop() {
            self.control_stop(t)?;
            self.next += 1;
        }
        let dae = self.solver.dae_mut();
        let mut valves = false;
        self.course = (t, None);
        for (one, value) in self.held.iter_mut().zip(values) {
            let signal = one.change([t, until], *value);
            dae.put_signal(&one.places, &signal);
            valves |= one.opens && one.value != *value;
            if one.moves_after(t) {
                self.course.1 = Some(until);
            }
        }
        self.switch(t)?;
        let dae = self.solver.dae_mut();
        for (one, value) in self.held.iter_mut().zip(values) {
            one.swings.jump(t, [one.value, *value]);
            one.value = *value;
            if one.path.is_none() {
                dae.put_signal(&one.places, &one.signal());
            }
        }
        // frequent changes of inputs are small: factors and step size are kept, and the integrator discards them if they fail
        let size = self.solver.size();
        let restarted = self.solver.go_on(t, &self.state, &self.rates);
        restarted.map_err(|failure| solver(fault(&failure)))?;
        // but flow through a closing valve ends within nanoseconds, and its dissipation falls into the first stage of a long step
        if !valves {
            self.solver.propose(size);
        }
        self.enter()
    }

    /// Passes the stop that the simulation has reached.
    fn pass(&mut self) -> Result<()> {
        let ScheduledStop { t, switches, .. } = self.stops[self.next];
        self.leave_stretch()?;
        let changes = self.control_stop(t)?;
        self.next += 1;
        if switches || changes {
            self.switch(t)?;
        } else {
            let ahead = self.inside();
            self.solver.dae_mut().enter_smooth_interval(ahead);
        }
        let restarted = self.solver.restart(t, &self.state, &self.rates);
        restarted.map_err(|failure| solver(fault(&failure)))?;
        self.enter()
    }

    /// Steps until time `until` [s], past all switches of the case on the way.
    fn advance(&mut self, until: f64, ask: &mut dyn FnMut() -> Control) -> Result<()> {
        let (mut pace, mut steps) = (StallDetector::new(self.time()), 0);
        let mut clock = Instant::now();
        while self.time() < until {
            if self.stands_at_stop() {
                self.pass()?;
                SimulatorWallTimes::add(&mut self.spent.jumps, &mut clock);
            }
            let (stop, from) = (self.stops[self.next], self.time());
            let stride = self.strides.at(from);
            self.solver.limit(stride.largest);
            let target = until.min(stop.t).min(stride.to);
            let step = self.solver.step(target).map_err(|failure| solver(fault(&failure)))?;
            SimulatorWallTimes::add(&mut self.spent.integration, &mut clock);
            self.watch(from, step.time)?;
            SimulatorWallTimes::add(&mut self.spent.watching, &mut clock);
            steps += 1;
            if steps >= self.max_steps {
                return Err(solver(too_many_steps(step.time, step.size)));
            }
            if pace.stalled(steps, step.time, self.end) {
                return Err(solver(stalled(step.time, step.size)));
            }
            if let Control::Stop(_) = ask() {
                break;
            }
        }
        Ok(())
    }

    /// Reads state, rates and integrals at a time within the last step [s].
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

    /// Stores the integrals up to the present time, for a restart.
    fn leave_stretch(&mut self) -> Result<()> {
        self.read(self.time())?;
        self.carried.copy_from_slice(&self.integrals);
        Ok(())
    }

    /// Computes a consistent state after a jump of signals at the present time, and adds the works of the jump.
    fn switch(&mut self, t: f64) -> Result<()> {
        let ahead = self.inside();
        let values = [&mut self.state[..], &mut self.rates];
        let start = (&mut self.starter, &self.consistent);
        switch(self.solver.dae_mut(), start, [t, ahead], values, &mut self.carried).map_err(solver)
    }

    /// Observes the start of a smooth interval.
    fn enter(&mut self) -> Result<()> {
        let t = self.time();
        self.integrals.copy_from_slice(&self.carried);
        let dae = self.solver.dae_mut();
        match self.observer.enter(dae, t, &self.state, &self.rates, &self.integrals) {
            Some(what) => Err(solver(beyond(t, what))),
            None => Ok(()),
        }
    }

    /// Samples the history's columns at the present time.
    fn sample(&mut self) -> Result<()> {
        let t = self.time();
        self.read(t)?;
        let [y, yp, integrals] = [&self.state, &self.rates, &self.integrals];
        let nobody = &mut Unrecorded(|_: &_| Control::Continue);
        let dae = self.solver.dae_mut();
        self.observer
            .sample(dae, None, t, y, yp, integrals, true, nobody)
            .map(|_| ())
    }
}

fn solver(fault: SolverError) -> Error {
    Error::Solver(Box::new(fault))
}
