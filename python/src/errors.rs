//! The library's errors as exceptions of the package.

use pyo3::prelude::*;
use slcbeam::case;
use slcbeam::error::{Error, SolverError};
use slcbeam::output::errors::{diagnosis, json};

/// Columns of faults as text.
const WIDTH: usize = 100;

/// Makes an exception of `slcbeam._errors` from its text and what scripts read, as JSON.
fn made(py: Python<'_>, class: &str, words: &str, told: &str) -> PyErr {
    let make = || -> PyResult<PyErr> {
        let class = py.import("slcbeam._errors")?.getattr(class)?;
        Ok(PyErr::from_value(class.call1((words, told))?))
    };
    make().unwrap_or_else(|error| error)
}

/// Words without the program's name in front.
fn words(fault: &SolverError) -> String {
    let text = diagnosis(fault);
    text.strip_prefix("slcbeam: ").unwrap_or(&text).to_owned()
}

/// The exception of an error.
pub fn raised(py: Python<'_>, error: &Error) -> PyErr {
    let told = json(error).to_string();
    match error {
        Error::Usage(what) => made(py, "UsageError", what, &told),
        Error::Case(fault) => made(py, "CaseError", case::render(fault, false, WIDTH).trim_end(), &told),
        Error::Solver(fault) => made(py, "SolverError", &words(fault), &told),
        Error::Interrupted(what) => made(py, "SolverError", what, &told),
        Error::Output { .. } => made(py, "FileError", &error.to_string(), &told),
    }
}

/// What a run that could not go on says: words, and what scripts read as JSON.
pub fn told(fault: &SolverError) -> (String, String) {
    let error = Error::Solver(Box::new(fault.clone()));
    (words(fault), json(&error).to_string())
}

/// An internal fault, as the package's base error.
pub fn broken(what: &str) -> PyErr {
    Python::attach(|py| made(py, "Error", what, "{}"))
}
