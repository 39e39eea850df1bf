//! One run in time: from a case to samples and a summary.

mod begin;
mod continued;
mod faults;
mod finish;
mod follow;
pub mod simulator;
mod stall;
mod switch;

use std::collections::BTreeMap;
use std::time::Instant;

pub use continued::{ContinuedDerivatives, go_on};
use faults::{fault, stalled, too_many_steps};
use stall::StallDetector;

use super::checkpoint::Checkpoint;
use super::control_loop::ControlLoop;
use super::growth::LinearProperties;
use super::max_step::StepLimits;
use super::method::{self, Integrator, IntegratorOptions};
use super::observe::Observer;
use super::record::{Control, Header, Progress, Recorder};
use super::schedule::{self, Outputs, ScheduledStop};
use super::sensitivity::forward::{DerivativeParameters, ForwardSensitivities};
use super::summary::{Counters, ProgramChoice, Status, Summary, WallTimes};
use super::{early_warnings, wall_time::Stopwatch, waves};
use crate::case::{inherited, parameter::Parameter, schema::Case};
use crate::dae::BeamDae;
use crate::discrete::{System, start};
use crate::error::{Result, SolverError};
use crate::integrate::halt;
use crate::model::{audit, characteristic};

/// A run that ended, in whatever way; everything up to its end is recorded.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Summary, complete in every case.
    pub summary: Summary,
    /// Why the solver could not go on, when it could not.
    pub fault: Option<SolverError>,
}

/// Runs a checked case. A failing solver is an [`Outcome`].
///
/// # Errors
/// Those of [`System::new`], and the recorder's.
pub fn run(case: &Case, recorder: &mut dyn Recorder) -> Result<Outcome> {
    run_with(case, System::new(case)?, &[], recorder)
}

/// Runs the system of a case with derivatives by some of its numbers, as [`run`].
///
/// # Errors
/// The recorder's, and [`Error::Usage`](crate::error::Error::Usage) for a number by which there is no derivative.
pub fn run_with(case: &Case, system: System, by: &[Parameter], recorder: &mut dyn Recorder) -> Result<Outcome> {
    let (run, dae) = Run::new(case, system, DerivativeParameters::pointers(by))?;
    run.go(dae, None, recorder)
}

/// The same, recorded at instants [s] of its own in place of the output times: ascending, none after the end, at least one. States there
/// are those of the integrator's own polynomials, to its order.
///
/// # Errors
/// As [`run_with`].
pub fn run_at(
    case: &Case,
    system: System,
    by: DerivativeParameters<'_>,
    instants: &[f64],
    recorder: &mut dyn Recorder,
) -> Result<Outcome> {
    let (mut run, dae) = Run::new(case, system, by)?;
    run.outputs = Outputs::at(case, instants);
    run.go(dae, None, recorder)
}

/// Goes on with the system of a case from a checkpoint of it; the recorder holds what was recorded before.
pub fn resume(case: &Case, system: System, checkpoint: &Checkpoint, recorder: &mut dyn Recorder) -> Result<Outcome> {
    checkpoint.fits(case, &system)?;
    let parameters = checkpoint.forward.as_ref().map_or(&[][..], |kept| &kept.parameters);
    let (run, dae) = Run::new(case, system, DerivativeParameters::pointers(parameters))?;
    run.go(dae, Some(checkpoint), recorder)
}

struct Run<'a> {
    case: &'a Case,
    observer: Observer,
    control: ControlLoop,
    outputs: Outputs,
    stops: Vec<ScheduledStop>,
    strides: StepLimits,
    /// Examination for growing waves, where there may be any.
    waves: Option<waves::WaveWatch>,
    summary: Summary,
    options: IntegratorOptions,
    linear: LinearProperties,
    inertia: bool,
    forward: Option<ForwardSensitivities<'a>>,
    held: Option<String>,
    laps: Stopwatch,
    /// State of progress at the end of the last step.
    latest: Progress,
    /// Time of the last output that was recorded [s].
    written: Option<f64>,
    state: Vec<f64>,
    rates: Vec<f64>,
    integrals: Vec<f64>,
    /// Integrals up to the last restart.
    carried: Vec<f64>,
    /// Work before the checkpoint from which this run goes on.
    earlier: Counters,
}

/// Outcome of the loop over steps.
enum End {
    Finished,
    Stopped(String),
    /// A validity limit was exceeded.
    Left(SolverError),
    Failed(SolverError),
}

impl<'a> Run<'a> {
    fn new(case: &'a Case, system: System, by: DerivativeParameters<'a>) -> Result<(Self, BeamDae)> {
        let laps = Stopwatch::since(Instant::now());
        let interval = case.time.output_interval();
        let mathieu = characteristic::mathieu(&system.model);
        let characteristic = characteristic::numbers_with(case, &system.model, mathieu.as_ref());
        let mut warnings = early_warnings::before_a_run(case, &system, &characteristic);
        if !by.parameters.is_empty() {
            warnings.extend(audit::derivatives(case));
            warnings.extend(inherited::varied(
                case,
                by.parameters.iter().map(|one| one.pointer.as_str()),
            ));
        }
        let decisions = &system.model.effects.decisions;
        let chosen = if by.parameters.is_empty() {
            method::choose(case, &system)
        } else {
            method::with_sensitivities(case, &system)
        };
        let strides = StepLimits::new(case, &system);
        let options = IntegratorOptions::new(case, &system, &chosen, strides.least());
        let inertia = system.layout.inertia;
        let linear = LinearProperties {
            mathieu,
            euler_load: characteristic.get("euler_load_n").copied(),
        };
        let mut run = Self {
            case,
            observer: Observer::new(case, &system, interval),
            control: ControlLoop::new(&system, case.time.end_s),
            outputs: Outputs::new(case),
            stops: schedule::stops(case, &system.model),
            strides,
            waves: waves::WaveWatch::new(&system.model, case.time.end_s),
            summary: Summary {
                case: case.name.clone(),
                status: Status::Failed,
                reason: None,
                time_s: 0.0,
                unknowns: system.layout.len,
                quantities: Default::default(),
                errors: Default::default(),
                companion: None,
                probes: Default::default(),
                ports: Default::default(),
                step_response: Default::default(),
                bands: Default::default(),
                balances: Default::default(),
                solver: Counters::default(),
                wall_s: WallTimes::default(),
                effects: decisions
                    .iter()
                    .map(|d| {
                        let value = if d.on { "on" } else { "off" }.to_string();
                        (
                            d.effect.to_string(),
                            ProgramChoice {
                                value,
                                reason: d.cause.to_string(),
                            },
                        )
                    })
                    .chain([
                        (
                            "method".into(),
                            ProgramChoice {
                                value: chosen.name(),
                                reason: chosen.reason,
                            },
                        ),
                        (
                            "max_order".into(),
                            ProgramChoice {
                                value: chosen.order.order.to_string(),
                                reason: chosen.order.reason,
                            },
                        ),
                    ])
                    .collect(),
                growth: None,
                tables_crc32: BTreeMap::new(),
                growing_wave: None,
                accuracy: None,
                sensitivities: Default::default(),
                characteristic,
                origins: case.origins.describe(),
                warnings,
            },
            options,
            linear,
            inertia,
            forward: None,
            held: None,
            laps,
            latest: Progress {
                t: 0.0,
                end: case.time.end_s,
                steps: 0,
                step: 0.0,
                order: 0,
            },
            written: None,
            state: vec![],
            rates: vec![],
            integrals: vec![],
            carried: vec![],
            earlier: Counters::default(),
        };
        let mut dae = BeamDae::new(system);
        if !by.parameters.is_empty() {
            let (forward, with_neighbours) = ForwardSensitivities::new(case, dae, by)?;
            (run.forward, dae) = (Some(forward), with_neighbours);
        }
        Ok((run, dae))
    }
}

impl Run<'_> {
    fn go(mut self, mut dae: BeamDae, from: Option<&Checkpoint>, recorder: &mut dyn Recorder) -> Result<Outcome> {
        self.waves.take_if(|_| !recorder.examines_waves());
        self.prepare(&dae);
        self.spent(|wall| &mut wall.set_up);
        let (t, first_stop) = match from {
            None => {
                dae.enter_smooth_interval(0.5 * self.stops[0].t);
                let (system, now) = dae.instant(0.0);
                self.state = start::state(system, self.case, now);
                if let Some(start) = &self.case.start.equilibrium {
                    match self.seek(start, &mut dae, recorder)? {
                        Ok(state) => self.state = state,
                        Err(end) => return Ok(self.finish(end)),
                    }
                }
                dae.find_turns(0.0, &self.state, &self.rates);
                (0.0, 0)
            }
            Some(checkpoint) => {
                self.take_up(checkpoint);
                dae.hold_turns(&checkpoint.observed.turns);
                (checkpoint.t, checkpoint.stop + 1)
            }
        };
        let ahead = 0.5 * (t + self.stops[first_stop].t);
        match from.map(|c| self.stops[c.stop]) {
            Some(stop) if stop.switches => {
                let last = first_stop.checked_sub(2).map_or(0.0, |k| self.stops[k].t);
                dae.enter_smooth_interval(0.5 * (last + t));
            }
            _ => dae.enter_smooth_interval(ahead),
        }
        let before = from.and_then(|c| self.before(&mut dae, c));
        let consistent = match from {
            Some(checkpoint) => self.switch_again(&mut dae, checkpoint, ahead),
            None => self.consistent_start(&mut dae).err(),
        };
        let consistent = consistent.or_else(|| match from {
            None => self.begin_forward(&mut dae).err(),
            Some(checkpoint) => self.go_on_forward(&mut dae, checkpoint, before).err(),
        });
        self.spent(|wall| &mut wall.consistent_start);
        let header = from.is_none().then(|| self.header(dae.system()));
        let end = match consistent {
            Some(fault) => End::Failed(fault),
            None => self.solve(dae, t, first_stop, header, recorder)?,
        };
        Ok(self.finish(end))
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
                self.spent(|wall| &mut wall.set_up);
                let end = self.integrate(&mut solver, first_stop, recorder)?;
                self.observer.close(recorder)?;
                self.spent(|wall| &mut wall.output);
                self.count(&solver);
                self.divide(&solver.wall());
                self.judge_network(solver.dae().system());
                Ok(end)
            }
        }
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
        let mut pace = StallDetector::new(solver.time());
        for k in first..self.stops.len() {
            let stop = self.stops[k];
            loop {
                self.spent(|wall| &mut wall.watching);
                let from = solver.time();
                let stride = self.strides.at(from);
                let stepped = solver
                    .limit(stride.largest)
                    .and_then(|()| solver.step(stop.t.min(stride.to).min(from + self.observer.longest_step)));
                self.spent(|wall| &mut wall.steps);
                let step = match stepped {
                    Ok(step) => step,
                    Err(failure) => return Ok(End::Failed(fault(&failure))),
                };
                self.summary.time_s = step.time;
                let steps = solver.steps();
                let progress = Progress {
                    t: step.time,
                    steps: self.earlier.steps + steps,
                    step: step.size,
                    order: step.order,
                    ..self.latest
                };
                self.latest = progress;
                if let Some(end) = self.follow(solver, from, recorder)? {
                    return Ok(end);
                }
                self.examine(solver, step.size);
                if let Control::Stop(reason) = recorder.progress(&progress)? {
                    return self.stop(solver, reason, recorder);
                }
                if halt::asked() {
                    let reason = format!("interrupted at t = {:.6} s", progress.t);
                    return self.stop(solver, reason, recorder);
                }
                if progress.steps >= self.case.solver.max_steps {
                    return Ok(End::Failed(too_many_steps(step.time, step.size)));
                }
                if pace.stalled(steps, step.time, self.case.time.end_s) {
                    return Ok(End::Failed(stalled(step.time, step.size)));
                }
                if step.stopped && step.time >= stop.t {
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
}
