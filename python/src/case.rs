//! A checked case.

use std::path::Path;

use pyo3::prelude::*;
use slcbeam::case;

use crate::errors::raised;

/// A case that was checked and stays as it is.
#[pyclass(frozen, module = "slcbeam._slcbeam")]
pub struct Case(pub case::Case);

#[pymethods]
impl Case {
    /// From text; `path` is what messages call it, files that it names are looked for in `base`, `sets` are `POINTER=JSON`.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, path: &str, base: &str, sets: Vec<String>) -> PyResult<Self> {
        let parsed = py.detach(|| case::parse(text, Path::new(path), Path::new(base), &sets));
        parsed.map(Self).map_err(|error| raised(py, &error))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// JSON text with every default filled in and every table within.
    fn json(&self) -> String {
        serde_json::to_value(self.0.resolved()).unwrap_or_default().to_string()
    }
}
