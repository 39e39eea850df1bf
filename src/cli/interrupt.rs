//! Ctrl-C asks a command to stop soon; everything so far is written.

use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use super::embedded;
use crate::error::{Error, Result};
pub use crate::integrate::halt::raised;
use crate::run::stop::{INTERRUPTED, Stop};

/// Exit codes of shells for a program that a signal ended begin here.
const SIGNAL: i32 = 128;

/// What the first signal leaves.
#[derive(Default)]
struct Asked {
    raised: Arc<AtomicBool>,
    signal: Arc<AtomicUsize>,
}

static ASKED: OnceLock<Asked> = OnceLock::new();

/// A flag that the first interrupt (or a request to terminate) raises; a second one ends the program at once.
pub fn flag() -> Arc<AtomicBool> {
    if let Some(theirs) = embedded::stop() {
        return theirs;
    }
    let asked = ASKED.get_or_init(|| {
        let asked = Asked::default();
        for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
            // When a handler cannot be installed, the signal ends the program as it would without one.
            let _ =
                signal_hook::flag::register_conditional_shutdown(signal, SIGNAL + signal, Arc::clone(&asked.raised));
            let _ = signal_hook::flag::register_usize(signal, Arc::clone(&asked.signal), signal as usize);
            let _ = signal_hook::flag::register(signal, Arc::clone(&asked.raised));
        }
        asked
    });
    Arc::clone(&asked.raised)
}

/// The same for work that listens on its way.
pub fn stop() -> Stop {
    Stop::by(flag())
}

/// What there is to say in place of how the search for a cycle failed, where that was because somebody asked for the end.
pub fn before_a_cycle<T>(found: Result<T>, stop: &Stop) -> Result<T> {
    match found {
        Err(_) if stop.raised() => Err(Error::Usage(format!(
            "{INTERRUPTED} before a cycle was found; nothing is written"
        ))),
        other => other,
    }
}

/// The exit code of a command that was asked to stop, as shells have it: 130 after Ctrl-C, 143 after a request to terminate.
pub fn code() -> Option<ExitCode> {
    let signal = ASKED.get()?.signal.load(Ordering::Relaxed);
    (signal > 0).then(|| ExitCode::from((SIGNAL as usize + signal) as u8))
}

/// A limit on the size of files is told as a fault of writing, by the name of the file, and does not end the program.
pub fn outlive_limits() {
    let told = Arc::new(AtomicBool::new(false));
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, told);
}
