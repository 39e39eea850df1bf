//! The command line: one file per subcommand, and the only module that prints.

mod arguments;
mod bands;
mod check;
mod coefficients;
mod compare;
mod compare_responses;
mod completions;
mod cycle_response;
mod effects;
pub mod embedded;
mod equilibrium;
mod explain;
mod export;
mod fit;
mod floquet;
mod inflation;
mod interrupt;
mod journal;
mod mapping;
mod measure;
mod merge;
mod modes;
mod new;
mod optimize;
mod paper;
mod periodic;
mod plot;
pub mod progress;
mod progress_line;
mod report;
mod resources;
mod response;
mod response_shapes;
mod result_folder;
mod run;
mod schema;
mod sense;
mod study;
pub mod summary_box;
mod sweep;
mod terminal;
mod uncertain;
mod verify;

use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use clap::Parser;
use serde_json::Value;

use crate::error::{Error, Result, visible};
use crate::output::machine;
use arguments::{Arguments, Command};

/// True once standard output has an answer.
static ANSWERED: AtomicBool = AtomicBool::new(false);

/// Reads the arguments, executes the command, reports errors, and returns the exit code.
pub fn main() -> ExitCode {
    #[cfg(target_os = "linux")]
    begin_with_one_heap();
    main_of(std::env::args_os())
}

/// Restarts the program with one heap if its address space is limited: the allocator reserves 64 MB of it for the heap of each thread.
#[cfg(target_os = "linux")]
fn begin_with_one_heap() {
    use std::os::unix::process::CommandExt as _;

    const HEAPS: &str = "MALLOC_ARENA_MAX";
    const MANY: f64 = 1e9;
    let limited = machine::address_space().is_some_and(|left| left < MANY);
    if limited
        && std::env::var_os(HEAPS).is_none()
        && let Ok(program) = std::env::current_exe()
    {
        let mut words = std::env::args_os();
        let name = words.next().unwrap_or_default();
        // returns only on failure; the program then continues as it is
        let _ = std::process::Command::new(program)
            .arg0(name)
            .args(words)
            .env(HEAPS, "1")
            .exec();
    }
}

/// [`main`] with given words, the first of them the program's name.
pub fn main_of(words: impl IntoIterator<Item = OsString>) -> ExitCode {
    let began = Instant::now();
    if let Err(error) = room() {
        terminal::report(&error);
        return ExitCode::from(error.exit_code());
    }
    let words: Vec<OsString> = words.into_iter().collect();
    let json = words.iter().skip(1).any(|word| word == "--json");
    let in_json = |error: &Error| {
        // a second document after an answer would make the output unreadable
        if json && !ANSWERED.load(Ordering::Relaxed) {
            let _ = print(&format!("{:#}\n", terminal::json(error)));
        }
    };
    let arguments = match Arguments::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(answer) if let Some(error) = arguments::uncertain::elsewhere(&words, &answer) => {
            terminal::report(&error);
            in_json(&error);
            return ExitCode::from(error.exit_code());
        }
        Err(answer) => {
            // Help and version are answers, everything else is a usage error; clap prints both.
            terminal::answer(&answer, &words);
            if !answer.use_stderr() {
                return ExitCode::SUCCESS;
            }
            in_json(&embedded::usage_error(&answer));
            return ExitCode::from(2);
        }
    };
    interrupt::outlive_limits();
    match act(&arguments.command, began) {
        Ok(code) => interrupt::ended(Ok(code)),
        Err(error) => {
            terminal::report(&error);
            in_json(&error);
            interrupt::ended(Err(&error))
        }
    }
}

/// Least memory with which a case can be rejected by a message [byte].
const LEAST: f64 = 32e6;

/// Rejects a start with hardly any memory: an allocation that fails later ends the process without a message.
fn room() -> Result<()> {
    match machine::address_space() {
        Some(left) if left < LEAST => Err(Error::Output {
            action: "begin",
            path: "slcbeam".into(),
            source: io::Error::new(
                io::ErrorKind::OutOfMemory,
                format!(
                    "{:.0} MB of address space are left (at least {:.0} MB); raise the limit (ulimit -v)",
                    left / 1e6,
                    LEAST / 1e6
                ),
            ),
        }),
        _ => Ok(()),
    }
}

fn act(command: &Command, began: Instant) -> Result<ExitCode> {
    match command {
        Command::Run(asked) => run::run(asked, began),
        Command::Check(asked) => check::check(asked),
        Command::Coefficients(asked) => coefficients::coefficients(asked),
        Command::Measure(asked) => measure::measure(asked),
        Command::Equilibrium(asked) => equilibrium::equilibrium(asked),
        Command::Study(asked) => study::study(asked),
        Command::Effects(asked) => effects::effects(asked),
        Command::Floquet(asked) => floquet::floquet(asked),
        Command::Periodic(asked) => periodic::periodic(asked),
        Command::Sweep(asked) => sweep::sweep(asked),
        Command::Merge(asked) => merge::merge(asked),
        Command::Fit(asked) => fit::fit(asked),
        Command::Sense(asked) => sense::sense(asked),
        Command::Optimize(asked) => optimize::optimize(asked),
        Command::Compare(asked) => compare::compare(asked),
        Command::Modes(asked) => modes::modes(asked),
        Command::Response(asked) => response::response(asked),
        Command::Bands(asked) => bands::bands(asked),
        Command::Export(asked) => export::export(asked),
        Command::Report(asked) => report::report(asked),
        Command::Plot(asked) => plot::plot(asked),
        Command::Mapping(asked) => mapping::mapping(asked),
        Command::Verify(asked) => verify::verify(asked),
        Command::Schema(_) => schema::schema(),
        Command::Explain(asked) => explain::explain(asked),
        Command::New(asked) => new::new(asked),
        Command::Completions(asked) => completions::completions(asked),
    }
}

/// Writes to standard output, with terminal control sequences made visible; a closed pipe ends the output, not the program.
fn print(text: &str) -> Result<()> {
    print_painted(&visible(text))
}

/// Prints the answer of a command without a result folder, as JSON or as text.
fn answer(json: bool, value: impl FnOnce() -> Value, text: impl FnOnce() -> String) -> Result<ExitCode> {
    print(&if json { format!("{:#}\n", value()) } else { text() })?;
    Ok(ExitCode::SUCCESS)
}

/// Prints a result as JSON, or as text with the folder of its files. Prints it even if its files could not be `written`.
///
/// # Errors
/// The fault of writing, or that of printing.
fn print_result(
    json: bool,
    dir: &Path,
    written: Result<()>,
    text: impl FnOnce() -> String,
    describe: impl FnOnce() -> String,
) -> Result<ExitCode> {
    let printed = match json {
        true => print(&text()),
        false if written.is_ok() => print(&format!("{}\nfiles in {}\n", describe(), dir.display())),
        false => print(&format!("{}\n", describe())),
    };
    written.and(printed).map(|()| ExitCode::SUCCESS)
}

/// [`print`] for text with the program's own colors, in which foreign control sequences are already visible.
fn print_painted(text: &str) -> Result<()> {
    use std::io::Write as _;
    if embedded::kept(text) {
        return Ok(());
    }
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(Error::Output {
            action: "write",
            path: "standard output".into(),
            source: e,
        }),
        _ => {
            ANSWERED.store(true, Ordering::Relaxed);
            Ok(())
        }
    }
}
