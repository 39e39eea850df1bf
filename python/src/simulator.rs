//! Simulations from one control instant to the next.

use std::sync::{Mutex, MutexGuard, PoisonError};

use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use slcbeam::run::dynamics::simulator::{self, SimulatorInput, Snapshot};
use slcbeam::run::record::{Control, Progress};

use crate::case::Case;

use crate::errors::{broken, raised};
use crate::watch::Watch;

/// A case that is simulated piece by piece.
#[pyclass(frozen, module = "slcbeam._slcbeam")]
pub struct Simulator(Mutex<simulator::Simulator>);

impl Simulator {
    fn own(&self) -> MutexGuard<'_, simulator::Simulator> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Does something without Python's lock.
    fn free<T: Send>(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut simulator::Simulator) -> slcbeam::error::Result<T> + Send,
    ) -> PyResult<T> {
        py.detach(|| act(&mut self.own())).map_err(|error| raised(py, &error))
    }
}

#[pymethods]
impl Simulator {
    #[new]
    fn new(py: Python<'_>, case: &Case, inputs: Vec<(String, f64, f64)>) -> PyResult<Self> {
        let inputs: Vec<SimulatorInput> = inputs
            .into_iter()
            .map(|(pointer, low, high)| SimulatorInput {
                pointer,
                range: [low, high],
            })
            .collect();
        let made = py.detach(|| simulator::Simulator::new(&case.0, &inputs));
        made.map(|one| Self(Mutex::new(one)))
            .map_err(|error| raised(py, &error))
    }

    /// Name, unit and meaning of the columns of a row.
    fn columns(&self, py: Python<'_>) -> Vec<(String, &'static str, String)> {
        let all = py.detach(|| self.own().columns().to_vec());
        all.into_iter()
            .map(|column| (column.name, column.unit, column.about))
            .collect()
    }

    /// Simulates until a time, or for one [s], with these values of the inputs, or as they are; returns the row there, and whether Ctrl-C came first.
    fn step<'py>(
        &self,
        py: Python<'py>,
        time: f64,
        further: bool,
        values: Option<PyReadonlyArray1<'_, f64>>,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, bool)> {
        let values = values.as_ref().map(|given| given.as_slice()).transpose()?;
        let (row, stopped, watch) = self.free(py, |own| {
            let (watch, mut stopped) = (Watch::new(None), false);
            let until = if further { own.time() + time } else { time };
            let held: Vec<f64> = values.map_or_else(|| own.values().collect(), <[f64]>::to_vec);
            own.step(until, &held, &mut || {
                let control = watch.step(&Progress::default());
                stopped |= control != Control::Continue;
                control
            })?;
            Ok((own.row().to_vec(), stopped, watch))
        })?;
        watch.end()?;
        Ok((row.into_pyarray(py), stopped))
    }

    /// The row at the present time.
    fn row<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        py.detach(|| self.own().row().to_vec()).into_pyarray(py)
    }

    /// Values of the inputs.
    fn values<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        py.detach(|| self.own().values().collect::<Vec<f64>>()).into_pyarray(py)
    }

    #[getter]
    fn t(&self, py: Python<'_>) -> f64 {
        py.detach(|| self.own().time())
    }

    #[getter]
    fn end(&self, py: Python<'_>) -> f64 {
        py.detach(|| self.own().end())
    }

    #[getter]
    fn steps(&self, py: Python<'_>) -> u64 {
        py.detach(|| self.own().steps())
    }

    /// Wall time of integration, of jumps, of watching [s].
    fn spent(&self, py: Python<'_>) -> (f64, f64, f64) {
        let spent = py.detach(|| self.own().spent());
        (spent.integration, spent.jumps, spent.watching)
    }

    fn warnings(&self, py: Python<'_>) -> Vec<String> {
        py.detach(|| self.own().warnings())
    }

    /// The present state.
    fn save(&self, py: Python<'_>) -> PyResult<State> {
        self.free(py, simulator::Simulator::save).map(State)
    }

    /// Goes to a state.
    fn restore(&self, py: Python<'_>, state: &State) -> PyResult<()> {
        self.free(py, |own| own.restore(&state.0))
    }
}

/// What a simulator goes on from.
#[pyclass(frozen, module = "slcbeam._slcbeam")]
pub struct State(Snapshot);

#[pymethods]
impl State {
    #[staticmethod]
    fn read(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        Snapshot::from_bytes(bytes)
            .map(Self)
            .map_err(|error| raised(py, &error))
    }

    #[getter]
    fn t(&self) -> f64 {
        self.0.t
    }

    fn __repr__(&self) -> String {
        format!("<slcbeam.State at t = {} s>", self.0.t)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.0 == other.0
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let text = self.0.to_bytes().map_err(|error| broken(&error.to_string()))?;
        Ok((py.get_type::<Self>().getattr("read")?, (PyBytes::new(py, &text),)))
    }
}
