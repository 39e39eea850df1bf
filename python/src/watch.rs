//! Asked after every step: Ctrl-C, and the caller's progress.

use std::cell::{Cell, RefCell};
use std::time::{Duration, Instant};

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use slcbeam::run::record::{Control, Progress};

/// How often Python is asked.
const OFTEN: Duration = Duration::from_millis(50);
/// Steps between looks at the clock.
const STEPS: u32 = 8;

/// Looks after a computation that runs without Python's lock.
pub struct Watch {
    progress: Option<Py<PyAny>>,
    asked: Cell<Instant>,
    steps: Cell<u32>,
    stopped: Cell<bool>,
    raised: RefCell<Option<PyErr>>,
}

impl Watch {
    /// One that calls `progress(t, end, steps)` now and then.
    pub fn new(progress: Option<Py<PyAny>>) -> Self {
        Self {
            progress,
            asked: Cell::new(Instant::now()),
            steps: Cell::new(0),
            stopped: Cell::new(false),
            raised: RefCell::new(None),
        }
    }

    /// Whether to go on.
    pub fn step(&self, now: &Progress) -> Control {
        match self.ask(Some(now)) {
            true => Control::Stop(format!("interrupted at t = {:.6} s", now.t)),
            false => Control::Continue,
        }
    }

    /// Whether to stop; cheap.
    fn ask(&self, now: Option<&Progress>) -> bool {
        if self.stopped.get() {
            return true;
        }
        self.steps.set(self.steps.get().wrapping_add(1));
        if !self.steps.get().is_multiple_of(STEPS) || self.asked.get().elapsed() < OFTEN {
            return false;
        }
        let answer = Python::attach(|py| {
            py.check_signals()?;
            if let (Some(progress), Some(now)) = (&self.progress, now) {
                progress.call1(py, (now.t, now.end, now.steps))?;
            }
            PyResult::Ok(())
        });
        self.asked.set(Instant::now());
        if let Err(error) = answer {
            self.stopped.set(true);
            let interrupted = Python::attach(|py| error.is_instance_of::<PyKeyboardInterrupt>(py));
            if !interrupted {
                self.raised.replace(Some(error));
            }
        }
        self.stopped.get()
    }

    /// Whether something asked to stop.
    pub fn stopped(&self) -> bool {
        self.stopped.get()
    }

    /// What the caller's function raised, if anything.
    pub fn end(self) -> PyResult<()> {
        self.raised.into_inner().map_or(Ok(()), Err)
    }
}
