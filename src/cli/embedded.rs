//! The commands inside another program: output is returned, and the calling program stops a command by a flag, not by a signal.

use std::cell::RefCell;
use std::ffi::OsString;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use clap::Parser as _;

use super::act;
use super::arguments::{Arguments, uncertain};
use crate::error::{Error, Result, SolverError};
use crate::integrate::halt::{self, StopRequest};

thread_local! {
    /// The command that this thread executes for another program.
    static ASKED: RefCell<Option<Asked>> = const { RefCell::new(None) };
}

struct Asked {
    stop: Arc<AtomicBool>,
    answer: EmbeddedAnswer,
}

/// Answer of a command.
#[derive(Debug, Default)]
pub struct EmbeddedAnswer {
    /// Text that it would have printed to standard output.
    pub printed: String,
    /// Reason why it ended early, if it has reported its results until then.
    pub fault: Option<Box<SolverError>>,
    /// True if raising the flag ended a part of it early.
    pub interrupted: bool,
}

/// Executes the command of the words after the program's name, such as `["modes", "case.json", "--json", "--quiet"]`, on this thread.
/// Raising `stop` has the effect of Ctrl-C on the command line.
///
/// # Errors
///
/// Those of the command; [`Error::Usage`] if there is no such command.
pub fn answer<I: IntoIterator<Item = OsString>>(words: I, stop: &Arc<AtomicBool>) -> Result<EmbeddedAnswer> {
    let all: Vec<OsString> = std::iter::once("slcbeam".into()).chain(words).collect();
    let arguments = Arguments::try_parse_from(&all)
        .map_err(|error| uncertain::elsewhere(&all, &error).unwrap_or_else(|| usage_error(&error)))?;
    let asked = Asked {
        stop: Arc::clone(stop),
        answer: EmbeddedAnswer::default(),
    };
    ASKED.replace(Some(asked));
    let request = StopRequest::by(stop);
    request.listen();
    let done = act(&arguments.command, Instant::now());
    halt::deaf();
    let answer = ASKED.take().map(|asked| asked.answer).unwrap_or_default();
    done.map(|_| EmbeddedAnswer {
        interrupted: request.was_seen(),
        ..answer
    })
}

/// Error of words that are no command.
pub(super) fn usage_error(answer: &clap::Error) -> Error {
    let words = answer.render().to_string();
    Error::Usage(words.trim().trim_start_matches("error: ").to_owned())
}

/// Flag of the calling program; none on the command line.
pub(super) fn stop() -> Option<Arc<AtomicBool>> {
    ASKED.with_borrow(|asked| asked.as_ref().map(|asked| Arc::clone(&asked.stop)))
}

/// Stores printed text for the calling program; false on the command line.
pub(super) fn kept(text: &str) -> bool {
    with(|answer| answer.printed.push_str(text))
}

/// Stores an error that a command reports before it continues; false on the command line.
pub(super) fn kept_fault(error: &Error) -> bool {
    with(|answer| {
        if let Error::Solver(fault) = error {
            answer.fault = Some(fault.clone());
        }
    })
}

fn with(keep: impl FnOnce(&mut EmbeddedAnswer)) -> bool {
    ASKED.with_borrow_mut(|asked| match asked {
        Some(asked) => {
            keep(&mut asked.answer);
            true
        }
        None => false,
    })
}
