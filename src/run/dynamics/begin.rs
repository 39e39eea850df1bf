//! Start of a run: its state and sensitivities, from the start of the case or from a checkpoint.

use super::faults::inconsistent;
use super::{End, Run};
use crate::case::schema::EquilibriumStart;
use crate::dae::{BeamDae, Dae};
use crate::discrete::System;
use crate::error::{Result, SolverError};
use crate::integrate::{StartOptions, consistent_start};
use crate::run::checkpoint::Checkpoint;
use crate::run::equilibrium::{self, EquilibriumOptions};
use crate::run::observe::Observer;
use crate::run::record::{Control, Header, Recorder};
use crate::run::sensitivity::forward::BeforeSwitch;

impl Run<'_> {
    /// Computes the equilibrium in which the case begins. The recorder can stop the search at every point of the path.
    pub(super) fn seek(
        &self,
        start: &EquilibriumStart,
        dae: &mut BeamDae,
        recorder: &mut dyn Recorder,
    ) -> Result<std::result::Result<Vec<f64>, End>> {
        let mut asked = Ok(Control::Continue);
        let found = equilibrium::at_start_watched(
            self.case,
            &EquilibriumOptions::of_start(start),
            dae,
            &self.state,
            &mut || {
                asked = recorder.progress(&self.latest);
                asked.as_ref().map_or(Control::Stop(String::new()), Control::clone)
            },
        );
        let stopped = |reason: String| End::Stopped(format!("{reason}, in search of the equilibrium to start from"));
        Ok(match asked? {
            Control::Stop(reason) => Err(stopped(reason)),
            Control::Continue => found.map_err(End::Failed),
        })
    }

    pub(super) fn header(&self, system: &System) -> Header {
        let mut header = Observer::header(self.case, system);
        if let Some(forward) = &self.forward {
            header.sensitivities = forward.names();
        }
        header
    }

    /// Sensitivities stored in a checkpoint, on the left side of its stop.
    pub(super) fn before(&mut self, dae: &mut BeamDae, from: &Checkpoint) -> Option<BeforeSwitch> {
        let (forward, kept) = (self.forward.as_mut()?, from.forward.as_ref()?);
        Some(forward.take_up(kept, dae, from.t, [&self.state, &self.rates]))
    }

    /// Continues the sensitivities on the right side of a checkpoint's stop.
    pub(super) fn go_on_forward(
        &mut self,
        dae: &mut BeamDae,
        from: &Checkpoint,
        before: Option<BeforeSwitch>,
    ) -> std::result::Result<(), SolverError> {
        let (Some(forward), Some(before)) = (&mut self.forward, before) else {
            return Ok(());
        };
        if self.stops[from.stop].switches {
            return forward.pass(dae, from.stop, from.t, &before, [&self.state, &self.rates]);
        }
        forward.go_on(dae, from.stop);
        Ok(())
    }

    pub(super) fn begin_forward(&mut self, dae: &mut BeamDae) -> std::result::Result<(), SolverError> {
        let Some(forward) = &mut self.forward else {
            return Ok(());
        };
        forward.begin(dae)?;
        forward.complete(dae, 0.0, [&self.state, &self.rates])
    }

    /// Computes the consistent state in which the run starts. Controllers take their first sample of that with their first outputs, and
    /// begin with those of the sample.
    pub(super) fn consistent_start(&mut self, dae: &mut BeamDae) -> std::result::Result<(), SolverError> {
        let options = StartOptions::default();
        let start = |dae: &mut BeamDae, [state, rates]: [&mut Vec<f64>; 2]| {
            consistent_start(dae, 0.0, state, rates, &options).map_err(|failure| inconsistent(0.0, &failure))
        };
        start(dae, [&mut self.state, &mut self.rates])?;
        if self
            .control
            .sample(dae, 0.0, [&self.state, &self.rates, &self.carried])?
        {
            start(dae, [&mut self.state, &mut self.rates])?;
        }
        Ok(())
    }

    /// Passes the stop of a checkpoint once more.
    pub(super) fn switch_again(&mut self, dae: &mut BeamDae, from: &Checkpoint, ahead: f64) -> Option<SolverError> {
        self.control.take_up(dae, &from.controllers);
        match self
            .control
            .sample(dae, from.t, [&self.state, &self.rates, &self.carried])
        {
            Ok(changes) if changes || self.stops[from.stop].switches => self.switch(dae, from.t, ahead),
            Ok(_) => {
                dae.enter_smooth_interval(ahead);
                None
            }
            Err(fault) => Some(fault),
        }
    }

    /// Allocates the arrays for the values of a system.
    pub(super) fn prepare(&mut self, dae: &BeamDae) {
        self.state = vec![0.0; dae.len()];
        self.rates = vec![0.0; dae.len()];
        self.integrals = vec![0.0; dae.integrals()];
        self.carried = vec![0.0; dae.integrals()];
    }

    pub(super) fn take_up(&mut self, checkpoint: &Checkpoint) {
        self.state.clone_from(&checkpoint.y);
        self.rates.clone_from(&checkpoint.yp);
        self.carried.clone_from(&checkpoint.integrals);
        self.earlier.clone_from(&checkpoint.counters);
        self.observer.seen.clone_from(&checkpoint.observed);
        self.outputs.go_on(checkpoint.next_output, checkpoint.t);
        if let Some(watch) = &mut self.waves {
            watch.skip(checkpoint.t);
        }
    }
}
