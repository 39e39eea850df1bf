//! What the Python package `slcbeam` takes from the program's library: cases, runs, folders. Names, types and help that people
//! see are in `package/slcbeam/`, in Python.

mod case;
mod command;
mod errors;
mod record;
mod run;
mod simulator;
mod watch;

use pyo3::prelude::*;

#[pymodule]
fn _slcbeam(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<case::Case>()?;
    module.add_class::<run::Recorded>()?;
    module.add_class::<simulator::Simulator>()?;
    module.add_class::<simulator::State>()?;
    module.add_function(wrap_pyfunction!(command::command, module)?)?;
    module.add_function(wrap_pyfunction!(command::program, module)?)?;
    module.add_function(wrap_pyfunction!(run::claimable, module)?)?;
    module.add_function(wrap_pyfunction!(run::run, module)?)?;
    module.add_function(wrap_pyfunction!(run::again, module)?)
}
