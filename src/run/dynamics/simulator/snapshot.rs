//! States from which a simulator resumes.

use serde::{Deserialize, Serialize};

use super::oscillations::InputOscillations;
use super::{Simulator, fault, inputs, solver};
use crate::dae::Dae as _;
use crate::error::{Error, Result};
use crate::functions::PiecewiseCurve;
use crate::run::control_loop::LoopState;
use crate::run::observe::Observed;

/// Data from which a [`Simulator`] of the same case and inputs resumes bit for bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Simulated time [s].
    pub t: f64,
    /// Values of the inputs.
    pub values: Vec<f64>,
    of: String,
    next: usize,
    /// Step size to try next [s]; if 0, it follows from the state.
    #[serde(default)]
    size: f64,
    y: Vec<f64>,
    yp: Vec<f64>,
    integrals: Vec<f64>,
    observed: Observed,
    #[serde(default)]
    swings: Vec<InputOscillations>,
    #[serde(default)]
    course: (f64, Option<f64>),
    /// Courses of the inputs that must not jump.
    #[serde(default)]
    paths: Vec<PiecewiseCurve>,
    #[serde(default)]
    controllers: Vec<LoopState>,
}

impl Snapshot {
    /// The state as text: a checksum of eight hexadecimal digits, and JSON.
    ///
    /// # Errors
    /// A number cannot be represented in JSON.
    pub fn to_bytes(&self) -> serde_json::Result<Vec<u8>> {
        let json = serde_json::to_vec(self)?;
        Ok([format!("{:08x}", crc32fast::hash(&json)).into_bytes(), json].concat())
    }

    /// Reads the state from a text.
    ///
    /// # Errors
    /// [`Error::Usage`] if the text was changed, truncated, or is not a state.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let wrong = |why: &str| Error::Usage(format!("not a state of a simulator: {why}"));
        let (sum, json) = bytes.split_at_checked(8).ok_or_else(|| wrong("it is truncated"))?;
        if sum != format!("{:08x}", crc32fast::hash(json)).as_bytes() {
            return Err(wrong("it is changed or truncated: its checksum differs"));
        }
        serde_json::from_slice(json).map_err(|error| wrong(&error.to_string()))
    }
}

impl Simulator {
    /// Returns the present state. From it the simulator continues bit for bit like one that restores it, since all other memory is
    /// discarded.
    ///
    /// # Errors
    /// Those of the integrator.
    pub fn save(&mut self) -> Result<Snapshot> {
        self.read(self.time())?;
        let snapshot = Snapshot {
            t: self.time(),
            values: self.values().collect(),
            of: self.of.clone(),
            next: self.next,
            size: self.solver.size(),
            y: self.state.clone(),
            yp: self.rates.clone(),
            integrals: self.integrals.clone(),
            observed: self.observer.seen.clone(),
            swings: self.held.iter().map(|one| one.swings).collect(),
            course: self.course,
            paths: self.held.iter().filter_map(|one| one.path.clone()).collect(),
            controllers: self.control.states.clone(),
        };
        self.restore(&snapshot)?;
        Ok(snapshot)
    }

    /// Sets the simulator to a state, earlier or later, of a simulator of the same case and inputs.
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
            && snapshot.paths.len() == self.held.iter().filter(|one| one.path.is_some()).count()
            && snapshot.paths.iter().all(PiecewiseCurve::is_whole)
            && snapshot.controllers.len() == self.control.states.len()
            && snapshot.next < self.stops.len()
            && (0.0..f64::INFINITY).contains(&snapshot.size)
            && (0.0..=self.end).contains(&snapshot.t);
        if !same {
            return Err(Error::Usage("the state belongs to another case or other inputs".into()));
        }
        inputs::admit(&self.held, &snapshot.values)?;
        let t = snapshot.t;
        self.state.copy_from_slice(&snapshot.y);
        self.rates.copy_from_slice(&snapshot.yp);
        self.carried.copy_from_slice(&snapshot.integrals);
        self.next = snapshot.next;
        self.course = snapshot.course;
        self.starter.forget();
        self.observer.seen.clone_from(&snapshot.observed);
        let restarted = self.solver.restart(t, &self.state, &self.rates);
        restarted.map_err(|failure| solver(fault(&failure)))?;
        let inside = self.inside();
        let dae = self.solver.dae_mut();
        let mut paths = snapshot.paths.iter();
        for (one, value) in self.held.iter_mut().zip(&snapshot.values) {
            one.value = *value;
            one.swings = InputOscillations::new(*value);
            if let Some(path) = &mut one.path {
                path.clone_from(paths.next().unwrap_or(&PiecewiseCurve::constant(0.0, *value)));
            }
            dae.put_signal(&one.places, &one.signal());
        }
        self.control.take_up(dae, &snapshot.controllers);
        dae.enter_smooth_interval(inside);
        for (one, swings) in self.held.iter_mut().zip(&snapshot.swings) {
            one.swings = *swings;
        }
        dae.approach(0.0);
        self.enter()?;
        self.solver.propose(snapshot.size);
        Ok(())
    }
}
