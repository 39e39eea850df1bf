//! What the Python package `slcbeam` takes from the program's library: cases, runs, folders. Names, types and help that people
//! see are in `package/slcbeam/`, in Python.

mod case;
mod errors;
mod record;
mod run;
mod watch;

use pyo3::prelude::*;

#[pymodule]
fn _slcbeam(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<case::Case>()?;
    module.add_class::<run::Recorded>()?;
    module.add_function(wrap_pyfunction!(run::run, module)?)?;
    module.add_function(wrap_pyfunction!(run::again, module)?)
}
