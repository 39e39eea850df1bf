//! Ctrl-C asks the run to stop after its current step; everything so far is written.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::embedded;

/// A flag that the first interrupt (or a request to terminate) raises; a second one ends the program at once.
pub fn flag() -> Arc<AtomicBool> {
    if let Some(theirs) = embedded::stop() {
        return theirs;
    }
    let raised = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        // When a handler cannot be installed, the signal ends the program as it would without one.
        let _ = signal_hook::flag::register_conditional_shutdown(signal, 130, Arc::clone(&raised));
        let _ = signal_hook::flag::register(signal, Arc::clone(&raised));
    }
    raised
}

/// A limit on the size of files is told as a fault of writing, by the name of the file, and does not end the program.
pub fn outlive_limits() {
    let told = Arc::new(AtomicBool::new(false));
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, told);
}

/// Whether the flag is up.
pub fn raised(flag: &AtomicBool) -> bool {
    flag.load(Ordering::Relaxed)
}
