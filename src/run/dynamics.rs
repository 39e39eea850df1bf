//! One run in time: from a case to samples and a summary.

use std::time::Instant;

use super::checkpoint::{Checkpoint, VERSION};
use super::equilibrium;
use super::estimate::resonance;
use super::growth::Linear;
use super::method::{self, Integrator, Options};
use super::observe::Observer;
use super::order;
use super::record::{Control, Header, Progress, Recorder};
use super::schedule::{self, Outputs, Stop};
use super::sensitivity::forward::Forward;
use super::summary::{Chosen, Counters, Status, Summary, WallTimes};
use crate::case::parameter::Parameter;
use crate::case::schema::Case;
use crate::dae::{BeamDae, Dae};
use crate::discrete::ledger::FLOWS;
use crate::discrete::{System, resolution, start};
use crate::error::{Code, Result, SolverFault};
use crate::model::{audit, characteristic};
use crate::sundials::{IdaFailure, StartFailure, StartOptions, consistent_start};

/// A run that ended, in whatever way; everything up to its end is recorded.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Summary, complete in every case.
    pub summary: Summary,
    /// Why the solver could not go on, when it could not.
    pub fault: Option<SolverFault>,
}

/// Runs a checked case. An error means that the recorder failed; a failing solver is an [`Outcome`].
pub fn run(case: &Case, recorder: &mut dyn Recorder) -> Result<Outcome> {
    run_with(case, &[], recorder)
}

/// Runs a checked case with derivatives by some of its numbers, as [`run`].
///
/// # Errors
/// Besides the recorder's, [`Error::Usage`] for a number by which there is no derivative.
pub fn run_with(case: &Case, parameters: &[Parameter], recorder: &mut dyn Recorder) -> Result<Outcome> {
    let (run, dae) = Run::new(case, parameters)?;
    run.go(dae, None, recorder)
}

/// Runs a system of the case from consistent values and rates of its scaled unknowns at t = 0.
pub fn go_on(case: &Case, system: System, y: &[f64], yp: &[f64], recorder: &mut dyn Recorder) -> Result<Outcome> {
    let (mut run, mut dae) = Run::of(case, system, &[])?;
    dae.look_within(0.5 * run.stops[0].t);
    run.prepare(&dae);
    run.state.copy_from_slice(y);
    run.rates.copy_from_slice(yp);
    let header = Observer::header(case, dae.system());
    let end = run.solve(dae, 0.0, 0, Some(header), recorder)?;
    Ok(run.finish(end))
}

/// What a run of the case records.
pub fn header(case: &Case) -> Header {
    Observer::header(case, &System::new(case))
}

/// Goes on from a checkpoint of the same case; the recorder holds what was recorded before it.
pub fn resume(case: &Case, checkpoint: &Checkpoint, recorder: &mut dyn Recorder) -> Result<Outcome> {
    checkpoint.fits(case)?;
    let (run, dae) = Run::new(case, &[])?;
    run.go(dae, Some(checkpoint), recorder)
}

/// Largest step [s]: as given, or a 16th of the shortest time scale of the signals, at most a tenth of the run. More at tolerances
/// looser than 1e-3, with the fourth root, so that errors go on to follow the tolerance; a hundredth of the run where something
/// changes without inertia: a high order would stride over what the ledger integrates.
pub fn max_step(case: &Case, system: &System) -> f64 {
    case.solver.max_step_s.unwrap_or_else(|| {
        let strides = system.layout.inertia || !schedule::changes(&system.model);
        let part = if strides { 0.1 } else { 0.01 };
        let parts = 16.0 * (1e-3 / case.solver.rtol.max(1e-3)).powf(0.25);
        let largest = part * case.time.end_s;
        schedule::fastest_period(&system.model, case.time.end_s).map_or(largest, |p| largest.min(p / parts))
    })
}

struct Run<'a> {
    case: &'a Case,
    observer: Observer,
    outputs: Outputs,
    stops: Vec<Stop>,
    summary: Summary,
    options: Options,
    linear: Linear,
    inertia: bool,
    forward: Option<Forward<'a>>,
    held: Option<String>,
    begin: Instant,
    output_wall: f64,
    state: Vec<f64>,
    rates: Vec<f64>,
    integrals: Vec<f64>,
    /// Integrals up to the last restart.
    carried: Vec<f64>,
    /// Work before the checkpoint from which this run goes on.
    earlier: Counters,
}

/// How a run left its loop.
enum End {
    Finished,
    Stopped(String),
    /// What lies beyond the model.
    Left(SolverFault),
    Failed(SolverFault),
}

impl<'a> Run<'a> {
    fn new(case: &'a Case, parameters: &'a [Parameter]) -> Result<(Self, BeamDae)> {
        Self::of(case, System::new(case), parameters)
    }

    fn of(case: &'a Case, system: System, parameters: &'a [Parameter]) -> Result<(Self, BeamDae)> {
        let begin = Instant::now();
        let interval = case.time.output_interval();
        let characteristic = characteristic::numbers(case, &system.model);
        let mut warnings = audit::lasting(case, &system.model, &characteristic);
        warnings.extend(resolution::warnings(case, &system));
        warnings.extend(resonance::warning(&system));
        let decisions = &system.model.effects.decisions;
        let chosen = if parameters.is_empty() {
            method::choose(case, &system)
        } else {
            method::with_sensitivities(case, &system)
        };
        let options = Options::new(case, &system, &chosen, max_step(case, &system));
        let inertia = system.layout.inertia;
        let mathieu = characteristic::mathieu(&system.model);
        let linear = Linear {
            mathieu,
            euler_load: characteristic.get("euler_load_n").copied(),
        };
        let mut run = Self {
            case,
            observer: Observer::new(case, &system, interval),
            outputs: Outputs::new(interval, case.time.end_s),
            stops: schedule::stops(case, &system.model),
            summary: Summary {
                case: case.name.clone(),
                status: Status::Failed,
                reason: None,
                time_s: 0.0,
                unknowns: system.layout.len,
                quantities: Default::default(),
                balances: Default::default(),
                solver: Counters::default(),
                wall_s: WallTimes::default(),
                effects: decisions
                    .iter()
                    .map(|d| {
                        let value = if d.on { "on" } else { "off" }.to_string();
                        (
                            d.name.to_string(),
                            Chosen {
                                value,
                                reason: d.reason.clone(),
                            },
                        )
                    })
                    .chain([
                        (
                            "method".into(),
                            Chosen {
                                value: chosen.name(),
                                reason: chosen.reason,
                            },
                        ),
                        (
                            "max_order".into(),
                            Chosen {
                                value: chosen.order.order.to_string(),
                                reason: chosen.order.reason,
                            },
                        ),
                    ])
                    .collect(),
                growth: None,
                estimate: None,
                accuracy: None,
                sensitivities: Default::default(),
                characteristic,
                origins: case.origins.words(),
                warnings,
            },
            options,
            linear,
            inertia,
            forward: None,
            held: None,
            begin,
            output_wall: 0.0,
            state: vec![],
            rates: vec![],
            integrals: vec![],
            carried: vec![],
            earlier: Counters::default(),
        };
        let mut dae = BeamDae::new(system);
        if !parameters.is_empty() {
            let (forward, with_neighbours) = Forward::new(case, dae, parameters)?;
            (run.forward, dae) = (Some(forward), with_neighbours);
        }
        Ok((run, dae))
    }
}

impl Run<'_> {
    fn go(mut self, mut dae: BeamDae, from: Option<&Checkpoint>, recorder: &mut dyn Recorder) -> Result<Outcome> {
        self.prepare(&dae);
        let (t, first_stop) = match from {
            None => {
                dae.look_within(0.5 * self.stops[0].t);
                let (system, now) = dae.instant(0.0);
                self.state = start::state(system, self.case, now);
                if let Some(start) = &self.case.start.equilibrium {
                    match equilibrium::at_start(self.case, start.loads_at_s, &mut dae, &self.state) {
                        Ok(state) => self.state = state,
                        Err(fault) => return Ok(self.finish(End::Failed(fault))),
                    }
                }
                (0.0, 0)
            }
            Some(checkpoint) => {
                self.take_up(checkpoint);
                (checkpoint.t, checkpoint.stop + 1)
            }
        };
        let ahead = 0.5 * (t + self.stops[first_stop].t);
        match from.map(|c| self.stops[c.stop]) {
            Some(stop) if stop.switches => {
                let last = first_stop.checked_sub(2).map_or(0.0, |k| self.stops[k].t);
                dae.look_within(0.5 * (last + t));
            }
            _ => dae.look_within(ahead),
        }
        let consistent = match from.map(|c| self.stops[c.stop].switches) {
            Some(true) => self.switch(&mut dae, t, ahead),
            Some(false) => None,
            None => consistent_start(&mut dae, t, &mut self.state, &mut self.rates, &StartOptions::default())
                .map_err(|failure| inconsistent(t, &failure))
                .err(),
        };
        let consistent = consistent.or_else(|| self.begin_forward(&mut dae).err());
        let header = from.is_none().then(|| self.header(dae.system()));
        let end = match consistent {
            Some(fault) => End::Failed(fault),
            None => self.solve(dae, t, first_stop, header, recorder)?,
        };
        Ok(self.finish(end))
    }

    fn header(&self, system: &System) -> Header {
        let mut header = Observer::header(self.case, system);
        if let Some(forward) = &self.forward {
            header.sensitivities = forward.names(&header.columns);
        }
        header
    }

    fn begin_forward(&mut self, dae: &mut BeamDae) -> std::result::Result<(), SolverFault> {
        let Some(forward) = &mut self.forward else {
            return Ok(());
        };
        forward.begin(dae)?;
        forward.complete(dae, 0.0, [&self.state, &self.rates])
    }

    /// Room for the values of a system.
    fn prepare(&mut self, dae: &BeamDae) {
        self.state = vec![0.0; dae.len()];
        self.rates = vec![0.0; dae.len()];
        self.integrals = vec![0.0; dae.integrals()];
        self.carried = vec![0.0; dae.integrals()];
    }

    /// From the present state, which is consistent, to the end.
    fn solve(
        &mut self,
        dae: BeamDae,
        t: f64,
        first_stop: usize,
        header: Option<Header>,
        recorder: &mut dyn Recorder,
    ) -> Result<End> {
        match Integrator::new(dae, t, &self.state, &self.rates, &self.options) {
            Err(failure) => Ok(End::Failed(fault(&failure))),
            Ok(mut solver) => {
                if let (Some(forward), Some(ida)) = (&self.forward, solver.ida_mut())
                    && let Err(failure) = forward.hand_over(ida, false)
                {
                    return Ok(End::Failed(fault(&failure)));
                }
                header.map_or(Ok(()), |header| recorder.begin(&header))?;
                let end = self.integrate(&mut solver, first_stop, recorder)?;
                self.count(&solver);
                Ok(end)
            }
        }
    }

    fn take_up(&mut self, checkpoint: &Checkpoint) {
        self.state.clone_from(&checkpoint.y);
        self.rates.clone_from(&checkpoint.yp);
        self.carried.clone_from(&checkpoint.integrals);
        self.earlier.clone_from(&checkpoint.counters);
        self.observer.seen.clone_from(&checkpoint.observed);
        self.outputs.go_on(checkpoint.next_output);
    }

    fn integrate(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        first: usize,
        recorder: &mut dyn Recorder,
    ) -> Result<End> {
        if let Some(end) = self.enter(solver, recorder)? {
            return Ok(end);
        }
        let mut pace = Pace::new(solver.time());
        for k in first..self.stops.len() {
            let stop = self.stops[k];
            loop {
                let from = solver.time();
                let step = match solver.step(stop.t) {
                    Ok(step) => step,
                    Err(failure) => return Ok(End::Failed(fault(&failure))),
                };
                self.summary.time_s = step.time;
                let method = self.options.one_step();
                self.observer
                    .seen
                    .estimate
                    .step(method, &step, [solver.y(), solver.yp()]);
                if let Some(end) = self.follow(solver, from, recorder)? {
                    return Ok(end);
                }
                let steps = solver.steps();
                let progress = Progress {
                    t: step.time,
                    end: self.case.time.end_s,
                    steps: self.earlier.steps + steps,
                    step: step.size,
                    order: step.order,
                };
                if let Control::Stop(reason) = recorder.progress(&progress)? {
                    return Ok(End::Stopped(reason));
                }
                if progress.steps >= self.case.solver.max_steps {
                    return Ok(End::Failed(too_many_steps(step.time, step.size)));
                }
                if pace.stalled(steps, step.time, self.case.time.end_s) {
                    return Ok(End::Failed(stalled(step.time, step.size)));
                }
                if step.stopped {
                    break;
                }
            }
            if let Some(next) = self.stops.get(k + 1).copied() {
                if let Some(fault) = self.pass(solver, k, next.t, recorder)? {
                    return Ok(End::Failed(fault));
                }
                if let Some(end) = self.enter(solver, recorder)? {
                    return Ok(end);
                }
            }
        }
        Ok(End::Finished)
    }

    /// Passes a switch: the next smooth branch of every signal, a consistent state, and what is done in no time in between.
    fn switch(&mut self, dae: &mut BeamDae, t: f64, ahead: f64) -> Option<SolverFault> {
        let (before, within) = (self.state.clone(), dae.within());
        dae.switch(t, ahead, &mut self.state);
        if let Err(failure) = consistent_start(dae, t, &mut self.state, &mut self.rates, &StartOptions::default()) {
            return Some(inconsistent(t, &failure));
        }
        dae.jump(t, (&before, within), &self.state, &mut self.carried);
        None
    }

    /// Passes a stop: the next smooth branch of every signal, a consistent state, a checkpoint if one is due, a fresh
    /// start of the integrator.
    fn pass(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        stop: usize,
        next: f64,
        recorder: &mut dyn Recorder,
    ) -> Result<Option<SolverFault>> {
        let Stop {
            t,
            switches,
            checkpoint,
        } = self.stops[stop];
        self.state.copy_from_slice(solver.y());
        self.rates.copy_from_slice(solver.yp());
        if let Err(failure) = solver.integrals(None, &mut self.integrals) {
            return Ok(Some(fault(&failure)));
        }
        for (carried, more) in self.carried.iter_mut().zip(&self.integrals) {
            *carried += more;
        }
        if checkpoint {
            self.count(solver);
            recorder.checkpoint(&Checkpoint {
                version: VERSION.into(),
                case: self.case.resolved_json(),
                t,
                stop,
                y: self.state.clone(),
                yp: self.rates.clone(),
                integrals: self.carried.clone(),
                next_output: self.outputs.next(),
                counters: Counters {
                    restarts: self.summary.solver.restarts + 1,
                    ..self.summary.solver.clone()
                },
                observed: self.observer.seen.clone(),
            })?;
        }
        let before = match (&mut self.forward, solver.ida_mut()) {
            (Some(forward), Some(ida)) => match forward.leave(ida, t, [&self.state, &self.rates]) {
                Ok(before) => Some(before),
                Err(failure) => return Ok(Some(fault(&failure))),
            },
            _ => None,
        };
        let dae = solver.dae_mut();
        let ahead = 0.5 * (t + next);
        if !switches {
            dae.look_within(ahead);
        } else if let Some(fault) = self.switch(dae, t, ahead) {
            return Ok(Some(fault));
        }
        if let (Some(forward), Some(before)) = (&mut self.forward, &before) {
            if !switches {
                forward.go_on(dae, stop);
            } else if let Err(fault) = forward.pass(dae, stop, t, before, [&self.state, &self.rates]) {
                return Ok(Some(fault));
            }
        }
        let restarted =
            solver
                .restart(t, &self.state, &self.rates)
                .and_then(|()| match (&self.forward, solver.ida_mut()) {
                    (Some(forward), Some(ida)) => forward.hand_over(ida, true),
                    _ => Ok(()),
                });
        Ok(restarted.err().map(|failure| fault(&failure)))
    }

    /// Looks at the start of a run or of what follows a stop, and takes the sample that is due there.
    fn enter(&mut self, solver: &mut Integrator<BeamDae>, recorder: &mut dyn Recorder) -> Result<Option<End>> {
        let t = solver.time();
        if let Err(end) = self.read(solver, t) {
            return Ok(Some(end));
        }
        let left = self
            .observer
            .enter(solver.dae_mut(), t, &self.state, &self.rates, &self.integrals);
        match left {
            Some(what) => self.leave(solver, t, what, recorder).map(Some),
            None => self.sample(solver, t, t, recorder),
        }
    }

    /// Follows an accepted step from time `from` [s]: looks at its end, and inside wherever something may have turned, takes every
    /// sample that is due, and finds out where in the step the model was left, if it was.
    fn follow(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        from: f64,
        recorder: &mut dyn Recorder,
    ) -> Result<Option<End>> {
        let now = solver.time();
        if let Err(end) = self.read(solver, now) {
            return Ok(Some(end));
        }
        let dae = solver.dae_mut();
        let left = self
            .observer
            .arrive(dae, now, &self.state, &self.rates, &self.integrals);
        let mut left = left.map(|what| (now, what));
        let mut within = from;
        for k in 0..self.observer.turning().len() {
            let t = self.observer.turning()[k];
            if let Err(end) = self.read(solver, t) {
                return Ok(Some(end));
            }
            let dae = solver.dae_mut();
            match self.observer.look(dae, t, &self.state, &self.rates, &self.integrals) {
                Some(what) => {
                    left = Some((t, what));
                    break;
                }
                None => within = t,
            }
        }
        match left {
            None => self.sample(solver, from, now, recorder),
            Some((t, what)) => {
                let (t, what) = match self.narrow(solver, [within, t], what) {
                    Ok(found) => found,
                    Err(end) => return Ok(Some(end)),
                };
                match self.sample(solver, from, t, recorder)? {
                    Some(end) => Ok(Some(end)),
                    None => self.leave(solver, t, what, recorder).map(Some),
                }
            }
        }
    }

    /// Reads state, rates and integrals at a time within the last step from the integrator's own polynomial, or as they are at
    /// the present time.
    fn read(&mut self, solver: &mut Integrator<BeamDae>, t: f64) -> std::result::Result<(), End> {
        let read = if t == solver.time() {
            self.state.copy_from_slice(solver.y());
            self.rates.copy_from_slice(solver.yp());
            solver.integrals(None, &mut self.integrals)
        } else {
            solver
                .interpolate(t, 0, &mut self.state)
                .and_then(|()| solver.interpolate(t, 1, &mut self.rates))
                .and_then(|()| solver.integrals(Some(t), &mut self.integrals))
        };
        for (total, carried) in self.integrals.iter_mut().zip(&self.carried) {
            *total += carried;
        }
        read.map_err(|failure| End::Stopped(format!("the state at t = {t:.6} s could not be read: {failure}")))
    }

    /// The time, and in words, at which the model was left, between a time at which it held and one at which it did not [s].
    fn narrow(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        [mut within, mut beyond]: [f64; 2],
        mut what: String,
    ) -> std::result::Result<(f64, String), End> {
        for _ in 0..HALVINGS {
            let t = 0.5 * (within + beyond);
            if t <= within || t >= beyond {
                break;
            }
            self.read(solver, t)?;
            match self.observer.beyond(solver.dae_mut(), t, &self.state, &self.rates) {
                Some(found) => (beyond, what) = (t, found),
                None => within = t,
            }
        }
        Ok((beyond, what))
    }

    /// Ends the run where the model was left; the state there is recorded last.
    fn leave(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        t: f64,
        what: String,
        recorder: &mut dyn Recorder,
    ) -> Result<End> {
        if let Err(end) = self.read(solver, t) {
            return Ok(end);
        }
        if let Some(end) = self.record(solver, 0, t, recorder)? {
            return Ok(end);
        }
        Ok(End::Left(beyond(t, what)))
    }

    /// Takes every sample that is due up to a time `until` [s] within the last step, which began at `from` [s].
    fn sample(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        from: f64,
        until: f64,
        recorder: &mut dyn Recorder,
    ) -> Result<Option<End>> {
        let mut begin = None;
        let mut within = from;
        while let Some((number, t)) = self.outputs.due(until) {
            begin.get_or_insert_with(Instant::now);
            if let Err(end) = self.read(solver, t.max(from)) {
                return Ok(Some(end));
            }
            let left = self.observer.beyond(solver.dae_mut(), t, &self.state, &self.rates);
            if let Some(what) = left {
                let (t, what) = match self.narrow(solver, [within, t], what) {
                    Ok(found) => found,
                    Err(end) => return Ok(Some(end)),
                };
                return self.leave(solver, t, what, recorder).map(Some);
            }
            if let Some(end) = self.record(solver, number, t, recorder)? {
                return Ok(Some(end));
            }
            within = t;
        }
        if let Some(begin) = begin {
            self.output_wall += begin.elapsed().as_secs_f64();
        }
        Ok(None)
    }

    /// Records the state that has been read, as sample number `number`.
    fn record(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        number: u64,
        t: f64,
        recorder: &mut dyn Recorder,
    ) -> Result<Option<End>> {
        self.observer.sample(
            solver.dae_mut(),
            number,
            t,
            &self.state,
            &self.rates,
            &self.integrals,
            recorder,
        )?;
        if let (Some(forward), Some(ida)) = (&mut self.forward, solver.ida_mut()) {
            match forward.sample(ida, t, [&self.state, &self.rates], self.observer.row()) {
                Ok(row) => recorder.sensitivities(row)?,
                Err(failure) => {
                    return Ok(Some(End::Stopped(format!(
                        "sensitivities at t = {t:.6} s could not be read: {failure}"
                    ))));
                }
            }
        }
        Ok(None)
    }

    fn count(&mut self, solver: &Integrator<BeamDae>) {
        self.summary.solver = solver.counters();
        self.summary.solver.add(&self.earlier);
        let s = &self.summary.solver;
        self.held = match self.options {
            Options::OneStep(_) => None,
            Options::Ida(_) => order::held_by_stability(
                solver.dae().system(),
                s.max_order,
                self.summary.time_s,
                s.steps,
                s.error_test_failures,
            ),
        };
        let wall = solver.wall();
        self.summary.wall_s = WallTimes {
            total: 0.0,
            residual: wall.residual.as_secs_f64(),
            jacobian: wall.jacobian.as_secs_f64(),
            linear_solver: wall.linear_solver.as_secs_f64(),
            output: self.output_wall + wall.integrands.as_secs_f64(),
        };
    }

    fn finish(mut self, end: End) -> Outcome {
        let s = &mut self.summary;
        let fault = match end {
            End::Finished => {
                s.status = Status::Finished;
                None
            }
            End::Stopped(reason) => {
                s.status = Status::Stopped;
                s.reason = Some(reason);
                None
            }
            End::Left(fault) => {
                s.status = Status::OutOfRange;
                s.reason = Some(fault.what.clone());
                s.time_s = fault.time_s;
                Some(fault)
            }
            End::Failed(fault) => {
                s.reason = Some(fault.what.clone());
                s.time_s = fault.time_s;
                Some(fault)
            }
        };
        let o = &self.observer.seen;
        s.quantities = o.figures.quantities();
        o.energies.complete(&mut s.quantities);
        s.warnings.extend(o.energies.warning(&s.quantities));
        s.estimate = o.estimate.judge(&s.quantities);
        s.warnings.extend(s.estimate.as_ref().and_then(|e| e.warning()));
        s.sensitivities = self.forward.as_ref().map(Forward::summary).unwrap_or_default();
        let b = &mut s.balances;
        b.energy_residual_relative = o.residuals.energy_relative();
        b.volume_residual_relative = o.residuals.volume_relative();
        b.closed_volume_residual_relative = o.residuals.closed_volume_relative();
        b.port_flow_residual_relative = o.residuals.port_flow_relative();
        b.reaction_difference_relative = o.residuals.reaction_relative();
        b.momentum_residual_relative = o.residuals.momentum_relative();
        b.angular_momentum_residual_relative = o.residuals.angular_relative();
        for flow in FLOWS.iter().filter(|f| f.energy_sign() != 0.0) {
            b.energy_j.insert(flow.name().into(), o.integrals[*flow as usize]);
        }
        let e = &o.stored;
        for (name, value) in [
            ("kinetic_energy", e.kinetic),
            ("rotary_energy", e.rotary),
            ("axial_energy", e.axial),
            ("bending_energy", e.bending),
            ("bladder_energy", e.bladders),
        ] {
            b.energy_j.insert(name.into(), value);
        }
        s.growth = o.growth.judge(self.case.beam.length_m, &self.linear);
        s.warnings
            .extend(s.growth.as_ref().map(|g| Code::Growth.warning(g.warning())));
        if !self.inertia {
            let buckled = o.growth.straight_beyond_buckling(self.case.beam.length_m, &self.linear);
            s.warnings.extend(buckled.map(|w| Code::Buckling.warning(w)));
        }
        s.warnings.extend(self.held.map(|w| Code::OrderHeld.warning(w)));
        s.warnings.extend(self.observer.warnings());
        s.wall_s.total = self.begin.elapsed().as_secs_f64();
        Outcome {
            summary: self.summary,
            fault,
        }
    }
}

fn fault(failure: &IdaFailure) -> SolverFault {
    SolverFault {
        code: if failure.singular.is_some() { Code::Singular } else { Code::Integrator },
        time_s: failure.time,
        what: failure.to_string(),
        unknown: failure.worst.as_ref().map(|w| w.name.clone()).or_else(|| failure.singular.clone()),
        cause: Some(
            if failure.singular.is_some() {
                "the equations lose their unique solution here: a buckled quasi-static beam, or a coupling that is not convex"
            } else {
                "the solution changes faster than the smallest step: a bladder closing, an instability, or a tolerance \
                 beyond double precision"
            }
            .into(),
        ),
        hint: Some("look at the balances and fields up to this time; try another rtol, a wider kink_width, or damping".into()),
    }
}

fn beyond(t: f64, what: String) -> SolverFault {
    SolverFault {
        code: Code::OutOfRange,
        time_s: t,
        what,
        unknown: None,
        cause: Some(
            "loads, pressures or flows beyond what the model describes, or a motion that grows without bounds".into(),
        ),
        hint: Some(
            "results stand up to this time; look at the fields before it, at the units of loads and flows".into(),
        ),
    }
}

fn too_many_steps(t: f64, step: f64) -> SolverFault {
    SolverFault {
        code: Code::Steps,
        time_s: t,
        what: format!("the number of steps allowed is used up at t = {t:.6} s, with steps of {step:.2e} s"),
        unknown: None,
        cause: Some("fast waves that the tolerance asks to follow".into()),
        hint: Some("raise /solver/max_steps, or loosen /solver/rtol".into()),
    }
}

fn inconsistent(t: f64, failure: &StartFailure) -> SolverFault {
    let (what, cause, hint) = if t == 0.0 {
        (
            "no consistent start".to_string(),
            "start values that contradict each other, or a model without a unique state",
            "look at `slcbeam check`, and at /start and /ends of the case",
        )
    } else {
        (
            format!("no consistent state after the switching time {t:.6} s"),
            "what switches leaves the equations without a unique state",
            "switch more slowly (a ramp with a duration)",
        )
    };
    SolverFault {
        code: Code::NoStart,
        time_s: t,
        what: format!("{what}: {}", failure.what),
        unknown: failure.worst.as_ref().map(|(_, name)| name.clone()),
        cause: Some(cause.into()),
        hint: Some(hint.into()),
    }
}

fn stalled(t: f64, step: f64) -> SolverFault {
    SolverFault {
        code: Code::Stalled,
        time_s: t,
        what: format!(
            "no progress: {STALL_STEPS} steps have hardly moved the time on from t = {t:.9} s (step {step:.2e} s)"
        ),
        unknown: None,
        cause: Some(
            "the solution changes ever faster towards this time: a closing bladder, an instability, a jump".into(),
        ),
        hint: Some("look at the fields just before this time; damping or a smoother signal may help".into()),
    }
}

/// Halvings of a step in search of the time at which the model was left.
const HALVINGS: u32 = 30;

/// Steps over which progress is judged.
const STALL_STEPS: u64 = 20_000;

/// Notices when steps no longer move the time on.
struct Pace {
    steps: u64,
    t: f64,
}

impl Pace {
    fn new(t: f64) -> Self {
        Self { steps: 0, t }
    }

    /// True when the last [`STALL_STEPS`] steps advanced by less than 1e-8 of the run: the rest would take more than
    /// 10^12 steps.
    fn stalled(&mut self, steps: u64, t: f64, end: f64) -> bool {
        if steps < self.steps + STALL_STEPS {
            return false;
        }
        let stalled = t - self.t < 1e-8 * end;
        (self.steps, self.t) = (steps, t);
        stalled
    }
}
