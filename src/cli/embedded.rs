//! The commands inside another program: what they print is handed back, and who asks is who stops them, not a signal.

use std::cell::RefCell;
use std::ffi::OsString;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use clap::Parser as _;

use super::act;
use super::arguments::{Arguments, uncertain};
use crate::error::{Error, Result, SolverError};
use crate::integrate::halt::{self, Halt};

thread_local! {
    /// The command that this thread does for another program.
    static ASKED: RefCell<Option<Asked>> = const { RefCell::new(None) };
}

struct Asked {
    stop: Arc<AtomicBool>,
    answer: Answer,
}

/// What a command gave.
#[derive(Debug, Default)]
pub struct Answer {
    /// What it would have printed to standard output.
    pub printed: String,
    /// Why it could not go on, where it has told what it had until then.
    pub fault: Option<Box<SolverError>>,
    /// Whether raising the flag made something of it end early.
    pub interrupted: bool,
}

/// Does what the words behind the program's name ask for, such as `["modes", "case.json", "--json", "--quiet"]`, on this thread; raising
/// `stop` is what Ctrl-C is on the command line.
///
/// # Errors
///
/// Those of the command; [`Error::Usage`] where there is none like it.
pub fn answer<I: IntoIterator<Item = OsString>>(words: I, stop: &Arc<AtomicBool>) -> Result<Answer> {
    let all: Vec<OsString> = std::iter::once("slcbeam".into()).chain(words).collect();
    let arguments = Arguments::try_parse_from(&all).map_err(|error| {
        let words = error.render().to_string();
        let own = || Error::Usage(words.trim().trim_start_matches("error: ").to_owned());
        uncertain::elsewhere(&all, &error).unwrap_or_else(own)
    })?;
    let asked = Asked {
        stop: Arc::clone(stop),
        answer: Answer::default(),
    };
    ASKED.replace(Some(asked));
    let request = Halt::by(stop);
    request.listen();
    let done = act(&arguments.command, Instant::now());
    halt::deaf();
    let told = ASKED.take().map(|asked| asked.answer).unwrap_or_default();
    done.map(|_| Answer {
        interrupted: request.was_seen(),
        ..told
    })
}

/// The flag of who asks; nothing on the command line.
pub(super) fn stop() -> Option<Arc<AtomicBool>> {
    ASKED.with_borrow(|asked| asked.as_ref().map(|asked| Arc::clone(&asked.stop)))
}

/// Keeps what is printed; false on the command line.
pub(super) fn kept(text: &str) -> bool {
    with(|answer| answer.printed.push_str(text))
}

/// Keeps what an error is that a command reports and goes on from; false on the command line.
pub(super) fn kept_fault(error: &Error) -> bool {
    with(|answer| {
        if let Error::Solver(fault) = error {
            answer.fault = Some(fault.clone());
        }
    })
}

fn with(keep: impl FnOnce(&mut Answer)) -> bool {
    ASKED.with_borrow_mut(|asked| match asked {
        Some(asked) => {
            keep(&mut asked.answer);
            true
        }
        None => false,
    })
}
