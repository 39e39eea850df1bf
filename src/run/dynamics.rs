//! One run in time: from a case to samples and a summary.

use std::time::Instant;

use super::observe::Observer;
use super::record::{Control, Progress, Recorder};
use super::schedule::{self, Outputs};
use super::summary::{Chosen, Counters, Status, Summary, WallTimes};
use crate::case::schema::{Case, MaxOrder};
use crate::dae::{BeamDae, Dae};
use crate::discrete::ledger::FLOWS;
use crate::discrete::{System, start};
use crate::error::{Result, SolverFault};
use crate::model::{audit, characteristic};
use crate::sundials::{Absolute, Ida, IdaFailure, IdaOptions, StartOptions, consistent_start};

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
    let (run, dae) = Run::new(case);
    run.go(dae, recorder)
}

/// Highest BDF order for a case, and why.
pub fn max_order(case: &Case, system: &System) -> (u8, &'static str) {
    match case.solver.max_order {
        MaxOrder::Order(order) => (order, "as given"),
        MaxOrder::Auto if system.layout.inertia => {
            (2, "the solid has inertia: BDF beyond order 2 is unstable for its waves")
        }
        MaxOrder::Auto => (5, "no solid inertia: nothing oscillates freely"),
    }
}

/// Largest step [s]: as given, or a 16th of the shortest time scale of the signals, at most a tenth of the run.
pub fn max_step(case: &Case, system: &System) -> f64 {
    case.solver.max_step_s.unwrap_or_else(|| {
        let tenth = 0.1 * case.time.end_s;
        schedule::fastest_period(&system.model).map_or(tenth, |p| tenth.min(p / 16.0))
    })
}

struct Run<'a> {
    case: &'a Case,
    observer: Observer,
    outputs: Outputs,
    stops: Vec<f64>,
    summary: Summary,
    options: IdaOptions,
    begin: Instant,
    output_wall: f64,
    state: Vec<f64>,
    rates: Vec<f64>,
    integrals: Vec<f64>,
}

/// How a run left its loop.
enum End {
    Finished,
    Stopped(String),
    Failed(SolverFault),
}

impl<'a> Run<'a> {
    fn new(case: &'a Case) -> (Self, BeamDae) {
        let begin = Instant::now();
        let system = System::new(case);
        let interval = case.time.output_interval_s.unwrap_or(1e-3 * case.time.end_s);
        let characteristic = characteristic::numbers(case, &system.model);
        let warnings = audit::warnings(case, &system.model, &characteristic);
        let decisions = &system.model.effects.decisions;
        let (order, _) = max_order(case, &system);
        let run = Self {
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
                        (d.name.to_string(), Chosen { value, reason: d.reason.clone() })
                    })
                    .collect(),
                characteristic,
                warnings,
            },
            options: IdaOptions {
                relative: case.solver.rtol,
                absolute: Absolute::Same(case.solver.rtol),
                max_order: order,
                nonlinear_coefficient: case.solver.nonlinear_coefficient,
                delta_cj_setup: case.solver.delta_cj_setup,
                initial_step: case.solver.initial_step_s,
                max_step: Some(max_step(case, &system)),
                ..IdaOptions::default()
            },
            begin,
            output_wall: 0.0,
            state: vec![],
            rates: vec![],
            integrals: vec![],
        };
        (run, BeamDae::new(system))
    }
}

impl Run<'_> {
    fn go(mut self, mut dae: BeamDae, recorder: &mut dyn Recorder) -> Result<Outcome> {
        let run = &mut self;
        recorder.begin(&Observer::header(run.case, dae.system()))?;
        run.rates = vec![0.0; dae.len()];
        run.integrals = vec![0.0; dae.integrals()];
        dae.look_within(0.5 * run.stops[0]);
        let (system, now) = dae.instant(0.0);
        run.state = start::state(system, run.case, now);
        let end = match consistent_start(&mut dae, 0.0, &mut run.state, &mut run.rates, &StartOptions::default()) {
            Err(failure) => End::Failed(SolverFault {
                time_s: 0.0,
                what: format!("no consistent start: {failure}"),
                unknown: failure.worst.map(|(_, name)| name),
                cause: Some("start values that contradict each other, or a model without a unique state".into()),
                hint: Some("look at `slcbeam check`, and at /start and /ends of the case".into()),
            }),
            Ok(_) => match Ida::new(dae, 0.0, &run.state, &run.rates, &run.options) {
                Err(failure) => End::Failed(fault(&failure)),
                Ok(mut ida) => {
                    let end = run.integrate(&mut ida, recorder)?;
                    run.count(&ida);
                    end
                }
            },
        };
        Ok(self.finish(end))
    }

    fn integrate(&mut self, ida: &mut Ida<BeamDae>, recorder: &mut dyn Recorder) -> Result<End> {
        if let Some(reason) = self.sample(ida, recorder, true)? {
            return Ok(End::Stopped(reason));
        }
        for interval in 0..self.stops.len() {
            let stop = self.stops[interval];
            loop {
                let step = match ida.step(stop) {
                    Ok(step) => step,
                    Err(failure) => return Ok(End::Failed(fault(&failure))),
                };
                self.summary.time_s = step.time;
                if let Some(reason) = self.sample(ida, recorder, false)? {
                    return Ok(End::Stopped(reason));
                }
                let progress = Progress {
                    t: step.time,
                    end: self.case.time.end_s,
                    steps: ida.steps(),
                    step: step.size,
                    order: step.order,
                };
                if let Control::Stop(reason) = recorder.progress(&progress)? {
                    return Ok(End::Stopped(reason));
                }
                if ida.steps() >= self.case.solver.max_steps {
                    return Ok(End::Failed(too_many_steps(step.time, step.size)));
                }
                if step.stopped {
                    break;
                }
            }
            if let Some(&next) = self.stops.get(interval + 1)
                && let Some(fault) = self.switch(ida, stop, next)
            {
                return Ok(End::Failed(fault));
            }
        }
        Ok(End::Finished)
    }

    /// Passes a switching time: the next smooth branch of every signal, a consistent state, a fresh start of the
    /// integrator.
    fn switch(&mut self, ida: &mut Ida<BeamDae>, now: f64, next: f64) -> Option<SolverFault> {
        self.state.copy_from_slice(ida.y());
        self.rates.copy_from_slice(ida.yp());
        let dae = ida.dae_mut();
        dae.look_within(0.5 * (now + next));
        if let Err(failure) =
            consistent_start(dae, now, &mut self.state, &mut self.rates, &StartOptions::default())
        {
            return Some(SolverFault {
                time_s: now,
                what: format!("no consistent state after the switching time {now:.6} s: {failure}"),
                unknown: failure.worst.map(|(_, name)| name),
                cause: Some("what switches leaves the equations without a unique state".into()),
                hint: Some("switch more slowly (a ramp with a duration)".into()),
            });
        }
        ida.restart(now, &self.state, &self.rates).err().map(|failure| fault(&failure))
    }

    /// Takes every sample that is due, from the integrator's own polynomial.
    fn sample(&mut self, ida: &mut Ida<BeamDae>, recorder: &mut dyn Recorder, at_start: bool) -> Result<Option<String>> {
        let now = ida.time();
        let mut begin = None;
        while let Some((number, t)) = self.outputs.due(now) {
            begin.get_or_insert_with(Instant::now);
            let exact = at_start || t == now;
            if exact {
                self.state.copy_from_slice(ida.y());
                self.rates.copy_from_slice(ida.yp());
            }
            let read = if exact {
                ida.integrals(None, &mut self.integrals)
            } else {
                ida.interpolate(t, 0, &mut self.state)
                    .and_then(|()| ida.interpolate(t, 1, &mut self.rates))
                    .and_then(|()| ida.integrals(Some(t), &mut self.integrals))
            };
            if let Err(failure) = read {
                return Ok(Some(format!("the state at t = {t:.6} s could not be read: {failure}")));
            }
            let ended = self.observer.sample(
                ida.dae_mut(),
                number,
                t,
                &self.state,
                &self.rates,
                &self.integrals,
                recorder,
            )?;
            if ended.is_some() {
                return Ok(ended);
            }
        }
        if let Some(begin) = begin {
            self.output_wall += begin.elapsed().as_secs_f64();
        }
        Ok(None)
    }

    fn count(&mut self, ida: &Ida<BeamDae>) {
        let c = ida.counters();
        self.summary.solver = Counters {
            steps: c.steps,
            residual_evaluations: c.residual_evaluations,
            jacobian_evaluations: c.jacobian_evaluations,
            factorizations: c.factorizations,
            pivot_refreshes: c.pivot_refreshes,
            error_test_failures: c.error_test_failures,
            newton_failures: c.newton_failures,
            newton_iterations: c.newton_iterations,
            linear_solves: c.linear_solves,
            restarts: c.restarts,
            steps_by_order: c.steps_by_order,
            max_order: c.max_order,
        };
        let wall = ida.wall();
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
            End::Failed(fault) => {
                s.reason = Some(fault.what.clone());
                s.time_s = fault.time_s;
                Some(fault)
            }
        };
        let o = &self.observer;
        s.quantities = o.figures.quantities();
        let b = &mut s.balances;
        b.energy_residual_relative = o.residuals.energy_relative();
        b.volume_residual_relative = o.residuals.volume_relative();
        b.closed_volume_residual_relative = o.residuals.closed_volume_relative();
        b.momentum_residual_relative = o.residuals.momentum_relative();
        b.angular_momentum_residual_relative = o.residuals.angular_relative();
        let names = [
            "work_loads",
            "work_ends",
            "work_ports",
            "dissipated_bladders",
            "dissipated_tubes",
            "harvested",
            "dissipated_rectifiers",
            "dissipated_damping",
            "work_formulation",
            "work_reciprocity",
        ];
        for (name, flow) in names.into_iter().zip(FLOWS) {
            b.energy_j.insert(name.into(), o.integrals[flow as usize]);
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
        s.warnings.extend(o.warnings());
        s.wall_s.total = self.begin.elapsed().as_secs_f64();
        Outcome { summary: self.summary, fault }
    }
}

fn fault(failure: &IdaFailure) -> SolverFault {
    SolverFault {
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

fn too_many_steps(t: f64, step: f64) -> SolverFault {
    SolverFault {
        time_s: t,
        what: format!("the number of steps allowed is used up at t = {t:.6} s, with steps of {step:.2e} s"),
        unknown: None,
        cause: Some("fast waves that the tolerance asks to follow".into()),
        hint: Some("raise /solver/max_steps, or loosen /solver/rtol".into()),
    }
}
