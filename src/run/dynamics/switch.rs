//! Stops of a run: switches, checkpoints, restarts of the integrator.

use super::Run;
use super::faults::{fault, inconsistent};
use crate::dae::BeamDae;
use crate::error::{Result, SolverError};
use crate::integrate::{StartOptions, Starter};
use crate::run::checkpoint::{Checkpoint, VERSION};
use crate::run::method::Integrator;
use crate::run::record::Recorder;
use crate::run::schedule::ScheduledStop;
use crate::run::sensitivity::forward::ForwardSensitivities;
use crate::run::summary::Counters;

/// Passes a switch at `t` [s]. Selects the next smooth branch of every signal by an instant `ahead` within it [s]. Computes a
/// consistent state with its rates, and adds the works of the jump to the integrals.
pub(super) fn switch(
    dae: &mut BeamDae,
    (starter, options): (&mut Starter, &StartOptions),
    [t, ahead]: [f64; 2],
    [state, rates]: [&mut [f64]; 2],
    carried: &mut [f64],
) -> std::result::Result<(), SolverError> {
    let (before, within) = (state.to_vec(), dae.within());
    dae.switch(t, ahead, state);
    let start = starter.start(dae, t, state, rates, options);
    start.map_err(|failure| inconsistent(t, &failure))?;
    dae.jump(t, (&before, within), state, carried);
    Ok(())
}

impl Run<'_> {
    /// Passes a switch.
    pub(super) fn switch(&mut self, dae: &mut BeamDae, t: f64, ahead: f64) -> Option<SolverError> {
        let values = [&mut self.state[..], &mut self.rates];
        let mut starter = match Starter::new(dae) {
            Ok(starter) => starter,
            Err(failure) => return Some(inconsistent(t, &failure)),
        };
        let start = (&mut starter, &StartOptions::default());
        switch(dae, start, [t, ahead], values, &mut self.carried).err()
    }

    /// Passes a stop: selects the next smooth branch of every signal, computes a consistent state, writes a checkpoint if one is due,
    /// and restarts the integrator.
    pub(super) fn pass(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        stop: usize,
        next: f64,
        recorder: &mut dyn Recorder,
    ) -> Result<Option<SolverError>> {
        let ScheduledStop {
            t,
            mut switches,
            checkpoint,
            samples,
        } = self.stops[stop];
        self.spent(|wall| &mut wall.watching);
        self.state.copy_from_slice(solver.y());
        self.rates.copy_from_slice(solver.yp());
        if let Err(failure) = solver.integrals(None, &mut self.integrals) {
            return Ok(Some(fault(&failure)));
        }
        for (total, carried) in self.integrals.iter_mut().zip(&self.carried) {
            *total += carried;
        }
        let dae = solver.dae_mut();
        dae.settle(t, &mut self.integrals);
        let controllers = self.control.states.clone();
        if samples {
            match self.control.sample(dae, t, [&self.state, &self.rates, &self.integrals]) {
                Ok(changes) => switches |= changes,
                Err(fault) => return Ok(Some(fault)),
            }
        }
        if !(switches || checkpoint) {
            dae.enter_smooth_interval(0.5 * (t + next));
            return Ok(None);
        }
        self.carried.copy_from_slice(&self.integrals);
        let before = match (&mut self.forward, solver.ida_mut()) {
            (Some(forward), Some(ida)) => match forward.leave(ida, t, [&self.state, &self.rates]) {
                Ok(before) => Some(before),
                Err(failure) => return Ok(Some(fault(&failure))),
            },
            _ => None,
        };
        if checkpoint {
            self.count(solver);
            self.spent(|wall| &mut wall.steps);
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
                controllers,
                forward: self.forward.as_ref().map(ForwardSensitivities::kept),
            })?;
            self.spent(|wall| &mut wall.output);
        }
        let dae = solver.dae_mut();
        let ahead = 0.5 * (t + next);
        if !switches {
            dae.enter_smooth_interval(ahead);
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
        self.spent(|wall| &mut wall.consistent_start);
        let restarted =
            solver
                .restart(t, &self.state, &self.rates)
                .and_then(|()| match (&self.forward, solver.ida_mut()) {
                    (Some(forward), Some(ida)) => forward.hand_over(ida, true),
                    _ => Ok(()),
                });
        self.spent(|wall| &mut wall.steps);
        Ok(restarted.err().map(|failure| fault(&failure)))
    }
}
