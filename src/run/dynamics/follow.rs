//! Processing of accepted steps: reads states within them, takes samples, locates exceeded validity limits.

use std::time::{Duration, Instant};

use super::faults::beyond;
use super::{End, Run};
use crate::dae::BeamDae;
use crate::error::Result;
use crate::integrate::IntegrationError;
use crate::run::method::Integrator;
use crate::run::record::{Control, Progress, Recorder, Sampled};
use crate::run::schedule::SampleTime;

/// Wall time after which the recorder is asked if the run continues, however many samples a step has.
const PATIENCE: Duration = Duration::from_millis(50);

/// Number of halvings of a step in the search for the time at which a validity limit is exceeded.
const HALVINGS: u32 = 30;

impl Run<'_> {
    /// Observes the start of a run or of the interval after a stop, and takes the sample that is due there.
    pub(super) fn enter(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        recorder: &mut dyn Recorder,
    ) -> Result<Option<End>> {
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

    /// Processes an accepted step from time `from` [s]: observes its end and possible extrema inside, and takes every due sample. If a
    /// validity limit was exceeded, finds the time within the step.
    pub(super) fn follow(
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
        if left.is_none() {
            for (k, t) in self.observer.reading().enumerate() {
                if let Err(end) = self.read(solver, t) {
                    return Ok(Some(end));
                }
                self.observer
                    .read(solver.dae_mut(), k == 1, t, &self.state, &self.rates);
            }
        }
        if left.is_none()
            && let Some(end) = self.largest(solver, from)
        {
            return Ok(Some(end));
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

    /// Examines the end of a step of length `step` [s] for growing waves, if an examination is due.
    pub(super) fn examine(&mut self, solver: &Integrator<BeamDae>, step: f64) {
        if let Some(watch) = &mut self.waves
            && watch.due(solver.time())
        {
            let state = [solver.y(), solver.yp()];
            watch.examine(
                self.case,
                solver.dae(),
                solver.time(),
                step,
                state,
                &mut self.observer.seen.waves,
            );
        }
    }

    /// Reads derivatives of the values that became largest since time `from` [s], at the times within the step at which they did.
    fn largest(&mut self, solver: &mut Integrator<BeamDae>, from: f64) -> Option<End> {
        self.forward.as_ref()?;
        for t in self.observer.reached(from) {
            if let Err(end) = self.read(solver, t) {
                return Some(end);
            }
            if let (Some(forward), Some(ida)) = (&mut self.forward, solver.ida_mut())
                && let Err(failure) = forward.see(ida, t, [&self.state, &self.rates])
            {
                return Some(unread(t, &failure));
            }
        }
        None
    }

    /// Reads state, rates and integrals: at the present time as they are, at a time within the last step from the integrator's own
    /// polynomial.
    pub(super) fn read(&mut self, solver: &mut Integrator<BeamDae>, t: f64) -> std::result::Result<(), End> {
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
        solver.dae_mut().keep_volumes(t, &mut self.state);
        for (total, carried) in self.integrals.iter_mut().zip(&self.carried) {
            *total += carried;
        }
        solver.dae_mut().settle(t, &mut self.integrals);
        read.map_err(|failure| End::Stopped(format!("the state at t = {t:.6} s could not be read: {failure}")))
    }

    /// Finds the time [s] at which a validity limit is exceeded, and its description, between a time within the limits and one beyond.
    pub(super) fn narrow(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        between: [f64; 2],
        what: String,
    ) -> std::result::Result<(f64, String), End> {
        narrow(between, what, |t| {
            self.read(solver, t)?;
            Ok(self.observer.beyond(solver.dae_mut(), t, &self.state, &self.rates))
        })
    }

    /// Ends the run where a validity limit is exceeded; the state there is recorded last.
    pub(super) fn leave(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        t: f64,
        what: String,
        recorder: &mut dyn Recorder,
    ) -> Result<End> {
        if let Err(end) = self.read(solver, t) {
            return Ok(end);
        }
        match self.record(solver, Some(0), t, true, recorder)? {
            Recorded::Ends(end) => Ok(end),
            _ => Ok(End::Left(beyond(t, what))),
        }
    }

    /// Ends the run on request; the state there is recorded last. The results then end at the stop, however far apart the output times
    /// are. Runs at explicit output times record no such state. A run resumed from a checkpoint drops what was recorded after it.
    pub(super) fn stop(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        reason: String,
        recorder: &mut dyn Recorder,
    ) -> Result<End> {
        let t = solver.time();
        if self.written == Some(t) || self.outputs.are_given() {
            return Ok(End::Stopped(reason));
        }
        if let Err(end) = self.read(solver, t) {
            return Ok(end);
        }
        match self.record(solver, Some(0), t, true, recorder)? {
            Recorded::Ends(end) => Ok(end),
            _ => Ok(End::Stopped(reason)),
        }
    }

    /// Takes every sample up to time `until` [s] within the last step, which began at `from` [s], including the ends of the window. If
    /// there are many samples, the recorder is asked in between if the run continues.
    pub(super) fn sample(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        from: f64,
        until: f64,
        recorder: &mut dyn Recorder,
    ) -> Result<Option<End>> {
        let Some(first) = self.outputs.due(until) else {
            return Ok(None);
        };
        self.spent(|wall| &mut wall.watching);
        let ended = self.take(solver, from, until, first, recorder);
        self.spent(|wall| &mut wall.output);
        ended
    }

    fn take(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        from: f64,
        until: f64,
        first: SampleTime,
        recorder: &mut dyn Recorder,
    ) -> Result<Option<End>> {
        let mut asked = Instant::now();
        let mut within = from;
        let mut due = Some(first);
        while let Some(SampleTime { t, output }) = due {
            if asked.elapsed() >= PATIENCE {
                asked = Instant::now();
                if let Control::Stop(reason) = recorder.progress(&Progress {
                    t: within,
                    ..self.latest
                })? {
                    self.summary.time_s = within;
                    return Ok(Some(End::Stopped(reason)));
                }
            }
            if let Err(end) = self.read(solver, t.max(from)) {
                return Ok(Some(end));
            }
            match self.record(solver, output, t, false, recorder)? {
                Recorded::On => {}
                Recorded::Ends(end) => return Ok(Some(end)),
                Recorded::Beyond(what) => {
                    let (t, what) = match self.narrow(solver, [within, t], what) {
                        Ok(found) => found,
                        Err(end) => return Ok(Some(end)),
                    };
                    return self.leave(solver, t, what, recorder).map(Some);
                }
            }
            within = t;
            due = self.outputs.due(until);
        }
        Ok(None)
    }

    /// Adds the state that was read to all figures, and records it if it is an output. A state beyond a validity limit is
    /// dropped, unless
    /// it is the last.
    pub(super) fn record(
        &mut self,
        solver: &mut Integrator<BeamDae>,
        output: Option<u64>,
        t: f64,
        last: bool,
        recorder: &mut dyn Recorder,
    ) -> Result<Recorded> {
        let sampled = self.observer.sample(
            solver.dae_mut(),
            output,
            t,
            &self.state,
            &self.rates,
            &self.integrals,
            last,
            recorder,
        )?;
        if let Sampled::Beyond(what) = sampled {
            return Ok(Recorded::Beyond(what));
        }
        if sampled == Sampled::Written {
            self.written = Some(t);
        }
        if let (Some(forward), Some(ida)) = (&mut self.forward, solver.ida_mut()) {
            match forward.sample(ida, t, [&self.state, &self.rates], self.observer.row()) {
                Ok(row) if sampled == Sampled::Written => recorder.sensitivities(row)?,
                Ok(_) => {}
                Err(failure) => return Ok(Recorded::Ends(unread(t, &failure))),
            }
        }
        Ok(Recorded::On)
    }
}

/// Outcome of a state that was to be recorded.
pub(super) enum Recorded {
    /// The run continues.
    On,
    /// The run ends.
    Ends(End),
    /// A validity limit was exceeded before, which the text describes.
    Beyond(String),
}

fn unread(t: f64, failure: &IntegrationError) -> End {
    End::Stopped(format!("sensitivities at t = {t:.6} s could not be read: {failure}"))
}

/// Bisects for the time [s] at which a validity limit is exceeded, between a time within the limits and one beyond. `beyond` describes
/// the limit that is exceeded at a time, if any. Returns the time and the description.
pub(super) fn narrow<E>(
    [mut within, mut left]: [f64; 2],
    mut what: String,
    mut beyond: impl FnMut(f64) -> std::result::Result<Option<String>, E>,
) -> std::result::Result<(f64, String), E> {
    for _ in 0..HALVINGS {
        let t = 0.5 * (within + left);
        if t <= within || t >= left {
            break;
        }
        match beyond(t)? {
            Some(found) => (left, what) = (t, found),
            None => within = t,
        }
    }
    Ok((left, what))
}
