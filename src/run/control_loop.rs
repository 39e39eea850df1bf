//! Samples of controllers during a run.

use serde::{Deserialize, Serialize};

use super::schedule::CLOSEST;
use crate::dae::BeamDae;
use crate::discrete::quantities::{ObservableRow, StateView};
use crate::discrete::{System, ledger};
use crate::error::{Code, SolverError, StopPoint};
use crate::functions::control::{ControlState, Controller};
use crate::model::ControlledInput;

/// Fewest samples after which a controller that only measures its own output is reported.
const ENOUGH: u64 = 3;

/// Controllers of a run with their states.
pub struct ControlLoop {
    controllers: Vec<Controller>,
    /// Indices of the measured columns in a row of the history.
    places: Vec<usize>,
    row: ObservableRow,
    /// Time within which samples coincide with a stop [s].
    closest: f64,
    /// States of the controllers.
    pub states: Vec<LoopState>,
}

/// State of a controller during a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LoopState {
    /// State of its law.
    pub law: ControlState,
    /// Number of samples at which the measured quantity was the output itself.
    own: u64,
}

impl ControlLoop {
    /// Controllers of a system for a run until `end` [s].
    pub fn new(system: &System, end: f64) -> Self {
        let inputs = &system.model.controllers;
        let measured = |name: &String| system.measured(name).unwrap_or_default();
        Self {
            controllers: inputs.iter().map(|one| one.controller.clone()).collect(),
            places: inputs.iter().map(|one| measured(&one.controller.measures)).collect(),
            row: match inputs.is_empty() {
                true => ObservableRow::default(),
                false => ObservableRow::from_system(system),
            },
            closest: 2.0 * CLOSEST * end,
            states: vec![LoopState::default(); inputs.len()],
        }
    }

    /// True if there are no controllers.
    pub fn is_empty(&self) -> bool {
        self.controllers.is_empty()
    }

    /// Restores the states of a checkpoint, and sets the outputs.
    pub fn take_up(&mut self, dae: &mut BeamDae, states: &[LoopState]) {
        for (k, (own, state)) in self.states.iter_mut().zip(states).enumerate() {
            own.clone_from(state);
            dae.hold_output(k, &state.law);
        }
    }

    /// Takes all samples that are due at time `t` [s], of a state on the left side with its integrals. Sets the outputs; returns true if any
    /// of them changes.
    pub fn sample(&mut self, dae: &mut BeamDae, t: f64, [y, yp, integrals]: [&[f64]; 3]) -> Result<bool, SolverError> {
        let due = |k: &usize| self.controllers[*k].sample_time(self.states[*k].law.next) <= t + self.closest;
        let due: Vec<usize> = (0..self.controllers.len()).filter(due).collect();
        if due.is_empty() {
            return Ok(false);
        }
        let (system, now, w) = dae.evaluate(t, y, yp);
        let clock = now.clock();
        let look = StateView::new(system, now, w, ledger::energies(system, now, w));
        self.row.take(t, &look, integrals, 0.0);
        let mut changes = false;
        for k in due {
            let controller = &self.controllers[k];
            let measured = self.row.values().get(self.places[k]).copied().unwrap_or(f64::NAN);
            if !measured.is_finite() {
                return Err(unreadable(t, controller));
            }
            let state = &mut self.states[k];
            let output = dae.system().model.controllers[k].controller.output(clock);
            state.own += u64::from((measured - output).abs() <= CLOSEST * measured.abs());
            if controller.sample(&mut state.law, t, measured) {
                dae.hold_output(k, &state.law);
                changes = true;
            }
        }
        Ok(changes)
    }

    /// Warnings of controllers that measured nothing but their own output.
    pub fn warnings(&self) -> Vec<String> {
        let own = |(one, state): (&Controller, &LoopState)| {
            (state.own >= ENOUGH && state.own == state.law.next && state.law.has_acted()).then(|| {
                Code::Controller.warning(format!(
                    "the controller \"{}\" measures its own output: {} equals it at all {} samples. It controls nothing. \
                     Measure a quantity that follows from the input.",
                    one.name, one.measures, state.own
                ))
            })
        };
        self.controllers.iter().zip(&self.states).filter_map(own).collect()
    }
}

fn unreadable(t: f64, controller: &Controller) -> SolverError {
    SolverError {
        code: Code::Integrator,
        at: StopPoint::Time(t),
        what: format!(
            "the controller \"{}\" cannot measure {} at t = {t:.6} s: it is not a finite number",
            controller.name, controller.measures
        ),
        unknown: None,
        cause: None,
        hint: Some("measure another quantity".into()),
    }
}

/// Warnings of analyses without time: controllers keep the output before their first sample there.
pub fn held(system: &System) -> Vec<String> {
    let held = |one: &ControlledInput| {
        let Controller { name, start, .. } = &one.controller;
        let unit = if one.unit == "1" {
            String::new()
        } else {
            format!(" {}", one.unit)
        };
        Code::Controller.warning(format!(
            "{}: the controller \"{name}\" does not act outside runs. The result is that with its output {start}{unit} before the first \
             sample. Change \"start\" for another output.",
            one.pointer
        ))
    };
    system.model.controllers.iter().map(held).collect()
}
