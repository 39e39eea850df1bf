//! An instance of an FMU, without its C interface.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use slcbeam::case;
use slcbeam::error::Error;
use slcbeam::output::errors::diagnosis;
use slcbeam::output::fmu::{CASE, FmuSetup, LINEAR, SETUP};
use slcbeam::run::dynamics::simulator::{Simulator, SimulatorInput, Snapshot};
use slcbeam::run::record::Control;
use slcbeam::run::response::stepwise::{LinearSimulator, LinearState};

/// Columns of faults as text.
const WIDTH: usize = 100;

/// Difference between a communication point and the time of the model that is rounding, relative to the time and the step.
const ROUNDING: f64 = 1e-9;

/// State of an instance in the state machine of FMI.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Before initialization.
    Instantiated,
    /// Between the start and the end of initialization.
    Initialization,
    /// Between steps, for events.
    Event,
    /// Between steps.
    Step,
    /// After the end of the simulation.
    Terminated,
}

/// The model of an instance.
enum Model {
    /// The case, and the columns of the outputs.
    Beam(Box<Simulator>, Vec<usize>),
    /// Small motions of the case.
    Linear(Box<LinearSimulator>),
}

/// State of a model.
#[derive(Clone, Debug, Serialize, Deserialize)]
enum ModelState {
    Beam(Box<Snapshot>),
    Linear(LinearState),
}

/// State of an instance.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct InstanceState {
    phase: Phase,
    start: f64,
    stop: Option<f64>,
    values: Vec<f64>,
    model: Option<ModelState>,
}

/// Outcome of a step.
#[derive(Clone, Debug, Default)]
pub struct StepOutcome {
    /// Time reached.
    pub time: f64,
    /// True if the step ended before its end.
    pub early: bool,
    /// True if a signal of the case jumps at the time reached.
    pub event: bool,
    /// True if the simulation cannot continue, for this reason.
    pub ended: Option<String>,
}

/// An instance of an FMU.
pub struct Instance {
    resources: PathBuf,
    setup: FmuSetup,
    /// True if the importer supports event mode.
    pub events: bool,
    /// True if steps may end early.
    pub early_return: bool,
    phase: Phase,
    /// Time of the importer at the start of the case.
    start: f64,
    /// End of the simulation, if it is known.
    stop: Option<f64>,
    values: Vec<f64>,
    model: Option<Model>,
}

/// Text of an error.
fn text(error: &Error) -> String {
    match error {
        Error::Case(fault) => case::render(fault, false, WIDTH).trim_end().to_owned(),
        Error::Solver(fault) => {
            let text = diagnosis(fault);
            text.strip_prefix("slcbeam: ").unwrap_or(&text).to_owned()
        }
        other => other.to_string(),
    }
}

impl Instance {
    /// Instance of the FMU whose resources are in a folder.
    ///
    /// # Errors
    /// The resources cannot be read, or belong to another description.
    pub fn new(resources: PathBuf, token: &str) -> Result<Self, String> {
        let path = resources.join(SETUP);
        let fault = |why: String| format!("cannot read {}: {why}", path.display());
        let bytes = std::fs::read(&path).map_err(|why| fault(why.to_string()))?;
        let setup: FmuSetup = serde_json::from_slice(&bytes).map_err(|why| fault(why.to_string()))?;
        if setup.token != token {
            return Err(format!(
                "the instantiation token is {token}, that of the resources is {}: they belong to different FMUs",
                setup.token
            ));
        }
        Ok(Self {
            values: setup.inputs.iter().map(|input| input.start).collect(),
            resources,
            setup,
            events: false,
            early_return: false,
            phase: Phase::Instantiated,
            start: 0.0,
            stop: None,
            model: None,
        })
    }

    /// Fails unless the instance is in one of these phases.
    pub fn require(&self, phases: &[Phase], call: &str) -> Result<(), String> {
        match phases.contains(&self.phase) {
            true => Ok(()),
            false => Err(format!("{call} is not allowed in the state {:?}", self.phase)),
        }
    }

    /// Enters a phase.
    pub fn enter(&mut self, phase: Phase) {
        self.phase = phase;
    }

    /// Creates the model, which begins at time `start`.
    pub fn begin(&mut self, start: f64, stop: Option<f64>) -> Result<(), String> {
        if !start.is_finite() || stop.is_some_and(|stop| !(stop > start && stop.is_finite())) {
            return Err(format!(
                "start time {start} s, stop time {stop:?} s: both must be finite, and the stop time the later one"
            ));
        }
        (self.start, self.stop) = (start, stop);
        self.model = Some(self.create().map_err(|error| text(&error))?);
        self.phase = Phase::Initialization;
        Ok(())
    }

    fn create(&self) -> Result<Model, Error> {
        let linear = self.resources.join(LINEAR);
        if let Ok(bytes) = std::fs::read(&linear) {
            let model = serde_json::from_slice(&bytes)
                .map_err(|why| Error::Usage(format!("cannot read {}: {why}", linear.display())))?;
            return Ok(Model::Linear(Box::new(LinearSimulator::new(model))));
        }
        let path = self.resources.join(CASE);
        let mut case = case::load(&path, &[])?;
        // a simulation that lasts longer than the run of the case
        let duration = self.stop.map_or(0.0, |stop| stop - self.start);
        if duration > case.time.end_s * (1.0 + ROUNDING) {
            case = case::load(&path, &[format!("/time/end_s={duration:?}")])?;
        }
        let inputs: Vec<SimulatorInput> = self
            .setup
            .inputs
            .iter()
            .map(|input| SimulatorInput {
                pointer: input.pointer.clone(),
                range: input.range.unwrap_or_default(),
            })
            .collect();
        let simulator = Simulator::new(&case, &inputs)?;
        let place = |name: &String| simulator.columns().iter().position(|column| column.name == *name);
        let places = self.setup.outputs.iter().map(|name| {
            place(name).ok_or_else(|| Error::Usage(format!("the case has no output {name}, which the FMU describes")))
        });
        let places = places.collect::<Result<_, _>>()?;
        Ok(Model::Beam(Box::new(simulator), places))
    }

    /// Returns to the state after instantiation.
    pub fn reset(&mut self) {
        self.values = self.setup.inputs.iter().map(|input| input.start).collect();
        (self.start, self.stop, self.model) = (0.0, None, None);
        self.phase = Phase::Instantiated;
    }

    /// Sets inputs: all, or none in case of an error.
    pub fn set_all(&mut self, references: &[u32], values: &[f64]) -> Result<(), String> {
        let before = self.values.clone();
        let mut pairs = references.iter().zip(values);
        let done = pairs.try_for_each(|(reference, value)| self.set(*reference, *value));
        if done.is_err() {
            self.values = before;
        }
        done
    }

    fn set(&mut self, reference: u32, value: f64) -> Result<(), String> {
        let place = (reference as usize).wrapping_sub(1);
        let (Some(input), Some(own)) = (self.setup.inputs.get(place), self.values.get_mut(place)) else {
            return Err(format!("value reference {reference} is no input"));
        };
        let [low, high] = input.range.unwrap_or([f64::MIN, f64::MAX]);
        if !(low..=high).contains(&value) {
            return Err(format!(
                "{}: {value} is outside its range, {low} to {high} {}. Write the FMU with a wider range",
                input.name(),
                input.unit()
            ));
        }
        *own = value;
        Ok(())
    }

    /// Writes the values of variables.
    pub fn get(&self, references: &[u32], values: &mut [f64]) -> Result<(), String> {
        let inputs = self.values.len();
        let mut linear: Option<Vec<f64>> = None;
        for (reference, value) in references.iter().zip(values) {
            let place = *reference as usize;
            *value = match (place, &self.model) {
                (0, model) => self.start + model.as_ref().map_or(0.0, Model::time),
                (input, _) if input <= inputs => self.values[input - 1],
                (_, None) => return Err("outputs exist from the initialization on".into()),
                (output, Some(Model::Beam(simulator, places))) => {
                    let column = places.get(output - inputs - 1);
                    let column = column.ok_or_else(|| format!("value reference {reference} is no variable"))?;
                    simulator.row()[*column]
                }
                (output, Some(Model::Linear(model))) => {
                    let all = linear.get_or_insert_with(|| model.outputs().collect());
                    let found = all.get(output - inputs - 1);
                    *found.ok_or_else(|| format!("value reference {reference} is no variable"))?
                }
            };
        }
        Ok(())
    }

    /// Simulates a step from a communication point.
    ///
    /// # Errors
    /// The point is not the present time; the simulation fails and steps must not end early. The time reached is in the outcome.
    pub fn step(&mut self, from: f64, size: f64, outcome: &mut StepOutcome) -> Result<(), String> {
        let Some(model) = &mut self.model else {
            return Err("the instance is not initialized".into());
        };
        let now = model.time();
        outcome.time = self.start + now;
        if !(size > 0.0 && size.is_finite()) {
            return Err(format!("the size of a step is {size} s; it must be positive"));
        }
        let rounding = ROUNDING * (from.abs() + size);
        if !from.is_finite() || (from - outcome.time).abs() > rounding {
            return Err(format!(
                "the step begins at {from} s, but the model is at {} s",
                outcome.time
            ));
        }
        if let Some(stop) = self.stop.filter(|stop| from + size > stop + rounding) {
            return Err(format!(
                "the step ends at {} s, after the stop time {stop} s",
                from + size
            ));
        }
        let mut until = from + size - self.start;
        match model {
            Model::Linear(model) => {
                if until > now {
                    model.step(until, self.values[0]);
                    if model.outputs().any(|value| !value.is_finite()) {
                        return Err(format!("an output is not finite after a step of {size} s"));
                    }
                }
            }
            Model::Beam(simulator, _) => {
                let end = simulator.end();
                if until > end && until - end <= rounding {
                    until = end;
                }
                let jump = simulator.next_jump().filter(|jump| *jump <= until);
                if let Some(jump) = jump.filter(|_| self.early_return) {
                    outcome.early = jump < until;
                    until = jump;
                }
                if until > now || until - now < -rounding {
                    match simulator.step(until, &self.values, &mut || Control::Continue) {
                        Err(error @ Error::Solver(_)) if self.early_return => {
                            (outcome.early, outcome.ended) = (true, Some(text(&error)));
                        }
                        done => done.map_err(|error| text(&error))?,
                    }
                }
                outcome.event = jump.is_some_and(|jump| simulator.time() == jump) && self.events;
            }
        }
        outcome.time = match outcome.early {
            true => self.start + self.model.as_ref().map_or(now, Model::time),
            false => from + size,
        };
        Ok(())
    }

    /// Warnings of the simulation so far.
    pub fn warnings(&self) -> Vec<String> {
        match &self.model {
            Some(Model::Beam(simulator, _)) => simulator.warnings(),
            _ => vec![],
        }
    }

    /// Time of the next jump of a signal of the case.
    pub fn next_event(&self) -> Option<f64> {
        match &self.model {
            Some(Model::Beam(simulator, _)) => simulator.next_jump().map(|jump| self.start + jump),
            _ => None,
        }
    }

    /// The state.
    pub fn save(&mut self) -> Result<InstanceState, String> {
        let model = match &mut self.model {
            Some(Model::Beam(simulator, _)) => Some(ModelState::Beam(Box::new(
                simulator.save().map_err(|error| text(&error))?,
            ))),
            Some(Model::Linear(model)) => Some(ModelState::Linear(model.save())),
            None => None,
        };
        Ok(InstanceState {
            phase: self.phase,
            start: self.start,
            stop: self.stop,
            values: self.values.clone(),
            model,
        })
    }

    /// Returns to a state of an instance of the same FMU.
    pub fn restore(&mut self, state: &InstanceState) -> Result<(), String> {
        let other = || "the state belongs to another FMU".to_owned();
        if state.values.len() != self.values.len() {
            return Err(other());
        }
        match &state.model {
            None => self.model = None,
            Some(saved) => {
                if self.model.is_none() || self.stop != state.stop {
                    self.begin(state.start, state.stop)?;
                }
                match (&mut self.model, saved) {
                    (Some(Model::Beam(simulator, _)), ModelState::Beam(saved)) => {
                        simulator.restore(saved).map_err(|error| text(&error))?;
                    }
                    (Some(Model::Linear(model)), ModelState::Linear(saved)) => {
                        model.restore(saved).then_some(()).ok_or_else(other)?;
                    }
                    _ => return Err(other()),
                }
            }
        }
        self.values.clone_from(&state.values);
        (self.start, self.stop, self.phase) = (state.start, state.stop, state.phase);
        Ok(())
    }
}

impl Model {
    /// Time since the start [s].
    fn time(&self) -> f64 {
        match self {
            Self::Beam(simulator, _) => simulator.time(),
            Self::Linear(model) => model.time(),
        }
    }
}
