//! Ctrl-C asks a command to stop soon; everything so far is written.

use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

use rustix::time::{ClockId, clock_gettime};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::{flag as raise, low_level};

use super::{embedded, terminal};
use crate::error::{Error, Result};
use crate::integrate::halt::Halt;
pub use crate::integrate::halt::raised;
use crate::run::stop::{INTERRUPTED, Stop};

/// Exit codes of shells for a program that a signal ended begin here.
const SIGNAL: i32 = 128;

/// Signals that follow the first within this are the same request: `timeout` signals a program and then the group that it is in, schedulers each of its processes.
const ONE_REQUEST: Duration = Duration::from_millis(300);

/// CPU time of the program after a first signal within which the command has to look at it: computations do so far more often, and files
/// that are not whole do not have their names yet.
const PATIENCE: Duration = Duration::from_secs(1);

/// How often the program is looked at after a first signal.
const OFTEN: Duration = Duration::from_millis(20);

/// What the first signal leaves.
#[derive(Default)]
struct Asked {
    raised: Arc<AtomicBool>,
    signal: Arc<AtomicUsize>,
    halt: Halt,
}

static ASKED: OnceLock<Asked> = OnceLock::new();

/// A flag that the first interrupt (or request to terminate) raises. A second one ends the program at once, and so does the first where the
/// command does not look at it within [`PATIENCE`].
pub fn flag() -> Arc<AtomicBool> {
    if let Some(theirs) = embedded::stop() {
        return theirs;
    }
    let asked = ASKED.get_or_init(|| {
        let raised = Arc::new(AtomicBool::new(false));
        let asked = Asked {
            halt: Halt::by(&raised),
            raised,
            ..Asked::default()
        };
        // When a handler cannot be installed, the signal ends the program as it would without one.
        for signal in [SIGINT, SIGTERM] {
            let _ = raise::register_usize(signal, Arc::clone(&asked.signal), signal as usize);
            let _ = raise::register(signal, Arc::clone(&asked.raised));
        }
        if let Ok(signals) = Signals::new([SIGINT, SIGTERM]) {
            let halt = asked.halt.clone();
            let _ = thread::Builder::new().spawn(move || end_in_time(signals, &halt));
        }
        asked
    });
    asked.halt.listen();
    Arc::clone(&asked.raised)
}

fn end_in_time(mut signals: Signals, halt: &Halt) {
    let Some(first) = signals.forever().next() else { return };
    let (begin, mut spent) = (Instant::now(), cpu_time());
    loop {
        thread::sleep(OFTEN);
        let again = signals.pending().next();
        if let Some(signal) = again.filter(|_| begin.elapsed() > ONE_REQUEST) {
            low_level::exit(SIGNAL + signal);
        }
        if halt.is_answered() {
            spent = cpu_time();
        } else if cpu_time().saturating_sub(spent) > PATIENCE {
            terminal::tell("slcbeam: interrupted; what had not been written yet is lost");
            low_level::exit(SIGNAL + first);
        }
    }
}

/// CPU time of all threads of the program.
fn cpu_time() -> Duration {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec.unsigned_abs() as u32)
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
    let _ = raise::register(signal_hook::consts::SIGXFSZ, told);
}
