//! Every command of the program, on a thread of its own beside which Python stays able to stop it.

use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::Builder;
use std::time::Duration;

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use slcbeam::cli::{self, embedded};

use crate::errors::{broken, raised, told};

/// The program itself, with words of the command line behind its name: it prints and is stopped as in a shell. Gives its exit code.
#[pyfunction]
pub fn program(py: Python<'_>, words: Vec<OsString>) -> u8 {
    let all = std::iter::once("slcbeam".into()).chain(words);
    let code = py.detach(|| cli::main_of(all));
    // no code tells its number
    (0..=u8::MAX)
        .find(|&number| ExitCode::from(number) == code)
        .unwrap_or(1)
}

/// How often Python is asked for a signal.
const OFTEN: Duration = Duration::from_millis(50);
/// Room for the command, as a main thread has it [bytes].
const STACK: usize = 8 << 20;

/// What a command printed; words and JSON of why it could not go on; whether it was asked to stop.
type Told = (String, Option<(String, String)>, bool);

/// Does what words of the command line ask for; the lock of Python is free meanwhile, and Ctrl-C asks for the end.
#[pyfunction]
pub fn command(py: Python<'_>, words: Vec<OsString>) -> PyResult<Told> {
    let stop = Arc::new(AtomicBool::new(false));
    let mut other = None;
    let answer = py.detach(|| -> PyResult<_> {
        let (give, take) = channel();
        let theirs = Arc::clone(&stop);
        let work = move || {
            // whoever asked has gone where this fails
            let _ = give.send(embedded::answer(words, &theirs));
        };
        let thread = Builder::new().stack_size(STACK).spawn(work)?;
        loop {
            match take.recv_timeout(OFTEN) {
                Ok(answer) => {
                    let _ = thread.join();
                    return Ok(answer);
                }
                Err(RecvTimeoutError::Timeout) if !stop.load(Ordering::Relaxed) => {
                    if let Err(error) = Python::attach(|py| py.check_signals()) {
                        stop.store(true, Ordering::Relaxed);
                        other = Some(error);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Err(broken("the command ended without an answer")),
            }
        }
    })?;
    let interrupted = other.is_some();
    if let Some(error) = other.filter(|error| !error.is_instance_of::<PyKeyboardInterrupt>(py)) {
        return Err(error);
    }
    let answer = match answer {
        // what it was asked to stop for
        Err(_) if interrupted => return Err(PyKeyboardInterrupt::new_err(())),
        other => other.map_err(|error| raised(py, &error))?,
    };
    let fault = answer.fault.as_deref().map(told);
    Ok((answer.printed, fault, answer.interrupted))
}
