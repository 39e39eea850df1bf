//! Stop requests to a command: Ctrl-C, a request to terminate, a closed terminal, or the clock. All results so far are written.

use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock, Weak};
use std::thread;
use std::time::{Duration, Instant};

use clap::Args;
use rustix::time::{ClockId, clock_gettime};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::{flag as raise, low_level};

use super::{embedded, terminal};
use crate::error::{Error, Result};
use crate::integrate::halt::StopRequest;
pub use crate::integrate::halt::raised;
use crate::run::stop::{INTERRUPTED, StopFlag};

/// Offset of the exit codes of shells for a program that a signal ended.
const SIGNAL: i32 = 128;

/// Signals within this time after the first belong to the same request: `timeout` signals a program and then its group, schedulers signal
/// each of its processes.
const ONE_REQUEST: Duration = Duration::from_millis(300);

/// CPU time of the program after a first signal within which the command must check for it. Computations check far more often, and
/// incomplete files do not have their names yet.
const PATIENCE: Duration = Duration::from_secs(1);

/// Message of the clock.
const LATE_WORDS: &str = "the wall time allowed (--max-wall) is used up";

/// Exit code if the clock ends a command before it has a result: that of a computation without the requested result.
const NOTHING: u8 = 4;

/// Interval between two checks of a waiting thread.
const OFTEN: Duration = Duration::from_millis(20);

/// State that the first signal sets.
#[derive(Default)]
struct Asked {
    raised: Arc<AtomicBool>,
    signal: Arc<AtomicUsize>,
    halt: StopRequest,
}

static ASKED: OnceLock<Asked> = OnceLock::new();

/// True if the allowed wall time is used up.
static LATE: AtomicBool = AtomicBool::new(false);

/// The wall time that a command is allowed.
#[derive(Clone, Debug, Default, Args)]
pub struct WallArguments {
    /// Stop after this wall time, as after Ctrl-C; results so far are written
    #[arg(long, value_name = "SECONDS", value_parser = super::progress_line::duration)]
    pub max_wall: Option<f64>,
}

impl WallArguments {
    /// The flag of [`flag`], which the clock also raises. On the command line the program ends if no code checks the flag within
    /// [`PATIENCE`].
    pub fn flag(&self) -> Arc<AtomicBool> {
        let flag = flag();
        if let Some(seconds) = self.max_wall {
            let deadline = Instant::now() + Duration::from_secs_f64(seconds);
            let (theirs, program) = (Arc::downgrade(&flag), embedded::stop().is_none());
            let wait = move || wait_until(deadline, &theirs, program);
            match seconds > 0.0 {
                true => drop(thread::Builder::new().spawn(wait)),
                // a thread would begin too late
                false => raise_late(&flag, program),
            }
        }
        flag
    }

    /// The flag as a stop request, for computations that check it as they proceed.
    pub fn stop(&self) -> StopFlag {
        StopFlag::by(self.flag())
    }
}

/// Waits for the clock as long as the command lasts.
fn wait_until(deadline: Instant, theirs: &Weak<AtomicBool>, program: bool) {
    while let Some(left) = deadline.checked_duration_since(Instant::now()) {
        thread::sleep(left.min(OFTEN));
        if theirs.strong_count() == 0 {
            return;
        }
    }
    let Some(flag) = theirs.upgrade() else { return };
    raise_late(&flag, program);
    if let (true, Some(asked)) = (program, ASKED.get()) {
        end_unless_answered(&asked.halt, || None, (LATE_WORDS, NOTHING.into()));
    }
}

fn raise_late(flag: &AtomicBool, program: bool) {
    LATE.store(program, Ordering::Relaxed);
    flag.store(true, Ordering::Relaxed);
}

/// Signals that ask the program to stop. `nohup` starts the program with SIGHUP ignored, and it stays ignored.
fn requests() -> Vec<i32> {
    let hangup = (!ignores(SIGHUP)).then_some(SIGHUP);
    [SIGINT, SIGTERM].into_iter().chain(hangup).collect()
}

/// True if the program ignores a signal. If the system does not report it as Linux does, the signal counts as ignored.
fn ignores(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| mask & (1 << (signal - 1)) != 0)
}

/// A flag that the first interrupt, request to terminate, or hangup raises. A second one ends the program at once. So does the first if the
/// command does not check the flag within [`PATIENCE`].
pub fn flag() -> Arc<AtomicBool> {
    if let Some(theirs) = embedded::stop() {
        return theirs;
    }
    let asked = ASKED.get_or_init(|| {
        let raised = Arc::new(AtomicBool::new(false));
        let asked = Asked {
            halt: StopRequest::by(&raised),
            raised,
            ..Asked::default()
        };
        // If a handler cannot be installed, the signal ends the program as it would without one.
        let requests = requests();
        for &signal in &requests {
            let _ = raise::register_usize(signal, Arc::clone(&asked.signal), signal as usize);
            let _ = raise::register(signal, Arc::clone(&asked.raised));
        }
        if let Ok(signals) = Signals::new(&requests) {
            let halt = asked.halt.clone();
            let _ = thread::Builder::new().spawn(move || end_in_time(signals, &halt));
        }
        asked
    });
    asked.halt.listen();
    Arc::clone(&asked.raised)
}

fn end_in_time(mut signals: Signals, halt: &StopRequest) {
    let Some(first) = signals.forever().next() else { return };
    let begin = Instant::now();
    // kernel and shell may both report the closed terminal, at different times
    let impatient = |signal: &i32| *signal != SIGHUP && begin.elapsed() > ONE_REQUEST;
    let again = || signals.pending().find(impatient);
    end_unless_answered(halt, again, ("interrupted", SIGNAL + first));
}

/// Ends the program with a code if no code answers a request within [`PATIENCE`], or if the request is repeated (`again`).
fn end_unless_answered(halt: &StopRequest, mut again: impl FnMut() -> Option<i32>, (why, code): (&str, i32)) {
    let mut spent = cpu_time();
    loop {
        thread::sleep(OFTEN);
        if let Some(signal) = again() {
            low_level::exit(SIGNAL + signal);
        }
        if halt.is_answered() {
            spent = cpu_time();
        } else if cpu_time().saturating_sub(spent) > PATIENCE {
            terminal::print_line(&format!("slcbeam: {why}; results not yet written are lost"));
            low_level::exit(code);
        }
    }
}

/// CPU time of all threads of the program.
fn cpu_time() -> Duration {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec.unsigned_abs() as u32)
}

/// Replaces the error of a search for a cycle by that of an interruption, if a stop was requested.
pub fn before_a_cycle<T>(found: Result<T>, stop: &StopFlag) -> Result<T> {
    match found {
        Err(_) if stop.raised() => Err(Error::Interrupted(format!(
            "{INTERRUPTED} before a cycle was found; nothing is written"
        ))),
        other => other,
    }
}

/// Exit code of a command that was asked to stop, as in shells: 130 after Ctrl-C, 143 after a request to terminate, 129 after a hangup.
fn code() -> Option<ExitCode> {
    let signal = ASKED.get()?.signal.load(Ordering::Relaxed);
    (signal > 0).then(|| ExitCode::from((SIGNAL as usize + signal) as u8))
}

/// True if the clock has ended a part of the command.
pub fn late() -> bool {
    LATE.load(Ordering::Relaxed) && ASKED.get().is_some_and(|asked| asked.halt.was_seen())
}

/// Final exit code of a command, from its own code or error and from the request that has stopped it. Prints a message if the clock has.
pub fn ended(with: std::result::Result<ExitCode, &Error>) -> ExitCode {
    if late() {
        terminal::print_line(&format!("slcbeam: {LATE_WORDS}"));
    }
    code().unwrap_or_else(|| match with {
        Ok(code) => code,
        Err(error) if late() && !matches!(error, Error::Output { .. }) => ExitCode::from(NOTHING),
        Err(error) => ExitCode::from(error.exit_code()),
    })
}

/// Catches the signal of a file size limit. The limit is then reported as an error of writing, with the name of the file, and does not end
/// the program.
pub fn outlive_limits() {
    let caught = Arc::new(AtomicBool::new(false));
    let _ = raise::register(signal_hook::consts::SIGXFSZ, caught);
}
