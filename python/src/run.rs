//! Runs in time, and their folders.

use std::path::PathBuf;

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slcbeam::case::parameter::Parameter;
use slcbeam::discrete::System;
use slcbeam::error::{Error, Result, SolverError};
use slcbeam::output::Labels;
use slcbeam::output::folder::ResultFolder;
use slcbeam::output::kind::FolderKind;
use slcbeam::output::recorder::FolderRecorder;
use slcbeam::output::{report, summary};
use slcbeam::run::dynamics::Outcome;
use slcbeam::run::observe::Observer;
use slcbeam::run::record::{Control, Header, Progress, Recorder, ThinnedRows};
use slcbeam::run::summary::{Status, Summary};
use slcbeam::study::companion::{self, Accurate};
use slcbeam::study::target::effects::Annotate;
use slcbeam::study::{refine, target};

use crate::case::Case;
use crate::errors::{broken, raised, told};
use crate::record::{Arrays, Keeper};
use crate::watch::Watch;

/// A run that has ended, without its arrays.
#[pyclass(frozen, module = "slcbeam._slcbeam")]
pub struct Recorded {
    case: slcbeam::case::Case,
    header: Header,
    began: bool,
    interrupted: bool,
    summary: Summary,
    fault: Option<SolverError>,
}

/// A case that was run and what came of it.
struct Ended {
    case: slcbeam::case::Case,
    header: Option<Header>,
    arrays: Arrays,
    outcome: Outcome,
}

/// Runs a case; the lock of Python is free meanwhile. Returns what is known of it and its arrays.
#[pyfunction]
#[pyo3(signature = (case, accuracy, sensitivities, progress))]
pub fn run<'py>(
    py: Python<'py>,
    case: &Case,
    accuracy: Option<f64>,
    sensitivities: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Recorded, Bound<'py, PyDict>)> {
    let case = &case.0;
    if let Some(accuracy) = accuracy.filter(|accuracy| !refine::sensible(*accuracy)) {
        let what = format!("accuracy {accuracy}: a relative error from 1e-6 to 0.5, such as 0.01 for one per cent");
        return Err(raised(py, &Error::Usage(what)));
    }
    let (ended, stopped) = py.detach(|| {
        let watch = Watch::new(progress);
        let ended = match accuracy {
            None => settle(case, &sensitivities, &watch),
            Some(accuracy) => reach(case, accuracy, &watch),
        };
        (ended, (watch.stopped(), watch.end()))
    });
    let (interrupted, raised_there) = stopped;
    raised_there?;
    let ended = ended.map_err(|error| raised(py, &error))?;
    let recorded = Recorded {
        began: ended.header.is_some(),
        interrupted,
        header: ended.header.unwrap_or_default(),
        case: ended.case,
        summary: ended.outcome.summary,
        fault: ended.outcome.fault,
    };
    let arrays = arrays(py, &recorded.header, ended.arrays)?;
    Ok((recorded, arrays))
}

/// A run that was told by another process: its case, its summary, and the names of its tables.
#[pyfunction]
#[pyo3(signature = (case, summary, envelope, sensitivities, began, interrupted))]
pub fn again(
    py: Python<'_>,
    case: &Case,
    summary: &str,
    envelope: Vec<String>,
    sensitivities: Vec<String>,
    began: bool,
    interrupted: bool,
) -> PyResult<Recorded> {
    let case = case.0.clone();
    let system = System::new(&case).map_err(|error| raised(py, &error))?;
    let header = Header {
        envelope,
        sensitivities,
        ..Observer::header(&case, &system)
    };
    let summary = serde_json::from_str(summary).map_err(|error| broken(&error.to_string()))?;
    Ok(Recorded {
        header: if began { header } else { Header::default() },
        began,
        interrupted,
        case,
        summary,
        fault: None,
    })
}

/// A run with or without error bars.
type Run<'a> = &'a dyn Fn(&slcbeam::case::Case, System, &[Parameter], &mut dyn Recorder) -> Result<Outcome>;

/// One run on the mesh of the case.
fn once(case: &slcbeam::case::Case, sensitivities: &[String], watch: &Watch, run: Run) -> Result<Ended> {
    let by = Parameter::find_all(case, sensitivities)?;
    let mut keeper = Keeper::new(watch);
    let outcome = run(case, System::new(case)?, &by, &mut keeper)?;
    Ok(Ended {
        case: case.clone(),
        header: keeper.header,
        arrays: keeper.arrays,
        outcome,
    })
}

/// One run, and again with effects that its companion shows to matter.
fn settle(case: &slcbeam::case::Case, sensitivities: &[String], watch: &Watch) -> Result<Ended> {
    let mut ended = once(case, sensitivities, watch, &companion::run)?;
    let first = ended.outcome.clone();
    let mut again = |case: &slcbeam::case::Case, annotate: Annotate| -> Result<Outcome> {
        let mut repeated = once(case, sensitivities, watch, &companion::run)?;
        annotate(&mut repeated.outcome.summary);
        let outcome = repeated.outcome.clone();
        if outcome.summary.status == Status::Finished {
            ended = repeated;
        }
        Ok(outcome)
    };
    let outcome = target::effects::settle(case, first, &mut again)?;
    Ok(Ended { outcome, ..ended })
}

/// Runs until every figure is known well enough; the last candidate that finished is the result, or the first.
fn reach(case: &slcbeam::case::Case, accuracy: f64, watch: &Watch) -> Result<Ended> {
    let mut placed: Option<Ended> = None;
    let mut candidate = |case: &slcbeam::case::Case, accuracy: &Accurate| -> Result<Outcome> {
        let measured: Run = &|case, system, _, recorder| companion::measured(case, system, accuracy, recorder);
        let ended = once(case, &[], watch, measured)?;
        let outcome = ended.outcome.clone();
        if outcome.summary.status == Status::Finished || placed.is_none() {
            placed = Some(ended);
        }
        Ok(outcome)
    };
    let outcome = target::reach(case, accuracy, None, &mut candidate)?;
    Ok(match placed {
        Some(ended) => Ended { outcome, ..ended },
        None => Ended {
            case: case.clone(),
            header: None,
            arrays: Arrays::default(),
            outcome,
        },
    })
}

/// A flat array as a table of so many columns, without a copy.
fn table<'py>(py: Python<'py>, flat: Vec<f64>, columns: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let rows = flat.len().checked_div(columns).unwrap_or_default();
    flat.into_pyarray(py).reshape([rows, columns])
}

fn arrays<'py>(py: Python<'py>, header: &Header, arrays: Arrays) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    all.set_item("history", table(py, arrays.history, header.columns.len())?)?;
    all.set_item("companion", table(py, arrays.companion, header.columns.len())?)?;
    all.set_item("envelope", table(py, arrays.envelope, header.envelope.len())?)?;
    all.set_item(
        "sensitivities",
        table(py, arrays.sensitivities, header.sensitivities.len())?,
    )?;
    all.set_item("times", arrays.times.into_pyarray(py))?;
    let mut fields = vec![];
    for (field, flat) in header.fields.iter().zip(arrays.fields) {
        fields.push(table(py, flat, field.len)?);
    }
    all.set_item("fields", fields)?;
    Ok(all)
}

/// Arrays of numpy as they came.
#[derive(FromPyObject)]
struct Given<'py> {
    #[pyo3(item)]
    history: PyReadonlyArray2<'py, f64>,
    #[pyo3(item)]
    companion: PyReadonlyArray2<'py, f64>,
    #[pyo3(item)]
    envelope: PyReadonlyArray2<'py, f64>,
    #[pyo3(item)]
    sensitivities: PyReadonlyArray2<'py, f64>,
    #[pyo3(item)]
    times: Bound<'py, PyArray1<f64>>,
    #[pyo3(item)]
    fields: Vec<PyReadonlyArray2<'py, f64>>,
}

/// Hands rows over, one by one.
fn rows(array: &PyReadonlyArray2<'_, f64>, mut take: impl FnMut(&[f64]) -> Result<()>) -> PyResult<Result<()>> {
    let columns = array.as_array().ncols();
    if columns == 0 {
        return Ok(Ok(()));
    }
    let mut all = array.as_slice()?.chunks_exact(columns);
    Ok(all.try_for_each(&mut take))
}

impl Recorded {
    /// Gives the folder's recorder all that the run gave.
    fn replay(&self, given: &Given<'_>, recorder: &mut FolderRecorder) -> PyResult<Result<()>> {
        if !self.began {
            return Ok(Ok(()));
        }
        let times = given.times.readonly();
        let fields: Vec<&[f64]> = given
            .fields
            .iter()
            .map(|f| Ok(f.as_slice()?))
            .collect::<PyResult<_>>()?;
        let mut go = || -> PyResult<Result<()>> {
            if let Err(error) = recorder.begin(&self.header) {
                return Ok(Err(error));
            }
            let mut done = rows(&given.history, |row| recorder.history(row))?;
            done = done.and(rows(&given.envelope, |row| recorder.envelope(row))?);
            done = done.and(rows(&given.sensitivities, |row| recorder.sensitivities(row))?);
            for (k, t) in times.as_slice()?.iter().enumerate() {
                let lengths = self.header.fields.iter().map(|field| field.len);
                let now: Vec<&[f64]> = fields
                    .iter()
                    .zip(lengths)
                    .map(|(flat, n)| &flat[k * n..(k + 1) * n])
                    .collect();
                done = done.and_then(|()| recorder.fields(*t, &now));
            }
            let mut companion = vec![];
            done = done.and(rows(&given.companion, |row| {
                companion.push(row.to_vec());
                Ok(())
            })?);
            if !companion.is_empty() {
                let companion = ThinnedRows::from_rows(&self.header.columns, companion);
                done = done.and_then(|()| recorder.companion(&companion));
            }
            Ok(done)
        };
        go()
    }
}

#[pymethods]
impl Recorded {
    /// Text of `summary.json`.
    fn summary(&self) -> String {
        summary::to_json(&self.summary)
    }

    /// The case that was run: on the mesh that an accuracy led to, where one was asked for.
    fn case(&self) -> Case {
        Case(self.case.clone())
    }

    /// Whether Ctrl-C came before it had ended.
    #[getter]
    fn interrupted(&self) -> bool {
        self.interrupted
    }

    /// Whether the run began.
    #[getter]
    fn began(&self) -> bool {
        self.began
    }

    /// Name, unit and meaning of the columns of the history.
    fn columns(&self) -> Vec<(String, &'static str, String)> {
        let all = self.header.columns.iter();
        all.map(|column| (column.name.clone(), column.unit, column.about.clone()))
            .collect()
    }

    /// Columns of what is left of output times.
    fn envelope(&self) -> Vec<String> {
        self.header.envelope.clone()
    }

    /// Columns of derivatives.
    fn sensitivities(&self) -> Vec<String> {
        self.header.sensitivities.clone()
    }

    /// Name, unit, meaning and values of the axes.
    fn axes<'py>(&self, py: Python<'py>) -> Vec<(&'static str, &'static str, &'static str, Bound<'py, PyArray1<f64>>)> {
        let all = self.header.axes.iter();
        all.map(|axis| (axis.name, axis.unit, axis.about, axis.values.clone().into_pyarray(py)))
            .collect()
    }

    /// Name, unit, axis and meaning of the fields.
    fn fields(&self) -> Vec<(&'static str, &'static str, &'static str, &'static str)> {
        let all = self.header.fields.iter();
        all.map(|field| (field.name, field.unit, field.axis, field.about))
            .collect()
    }

    /// Why the solver could not go on, in words and as JSON.
    fn fault(&self) -> Option<(String, String)> {
        self.fault.as_ref().map(told)
    }

    /// Writes the result folder that the command line writes.
    fn save(&self, py: Python<'_>, dir: PathBuf, force: bool, arrays: Given<'_>) -> PyResult<()> {
        let done = self.write(dir, force, &arrays)?;
        done.map_err(|error| raised(py, &error))
    }
}

impl Recorded {
    fn write(&self, dir: PathBuf, force: bool, arrays: &Given<'_>) -> PyResult<Result<()>> {
        let folder = match ResultFolder::claim(&dir, FolderKind::Run, force) {
            Ok(folder) => folder,
            Err(error) => return Ok(Err(error)),
        };
        let hook = Box::new(|_: &Progress| Control::Continue);
        let mut recorder = FolderRecorder::new(folder, Labels::from_case(&self.case), hook);
        let replayed = self.replay(arrays, &mut recorder)?;
        let complete = || -> Result<()> {
            replayed?;
            let finished = recorder.finish(&self.summary)?;
            report::write(&dir, None)?;
            finished.close().map(|_| ())
        };
        Ok(complete())
    }
}

/// Asks whether a result may come into a folder, before hours are spent on it; what is there stays as it is.
#[pyfunction]
pub fn claimable(py: Python<'_>, dir: PathBuf) -> PyResult<()> {
    ResultFolder::claim(&dir, FolderKind::Run, false)
        .map(drop)
        .map_err(|error| raised(py, &error))
}
