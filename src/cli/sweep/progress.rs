//! Progress of a sweep: a moving line on a terminal, occasional lines elsewhere.

use std::time::{Duration, Instant};

use crate::cli::progress_line::{PLAIN, ProgressLine};
use crate::cli::terminal;
use crate::output::numbers::{count, counted, duration};

/// Interval between two lines without a terminal.
const EVERY: Duration = Duration::from_secs(30);

/// Counts designs.
pub struct Counter {
    shown: ProgressLine,
    what: &'static str,
    done: usize,
    of: usize,
    failed: usize,
    begun: Instant,
    printed: Instant,
}

impl Counter {
    /// Creates a counter for `of` designs.
    pub fn new(quiet: bool, what: &'static str, of: usize) -> Self {
        let now = Instant::now();
        Self {
            shown: ProgressLine::new(quiet, PLAIN),
            what,
            done: 0,
            of,
            failed: 0,
            begun: now,
            printed: now,
        }
    }

    /// Counts one more design.
    pub fn one(&mut self, failed: bool) {
        self.done += 1;
        self.failed += usize::from(failed);
        let describe = || {
            let left = self.begun.elapsed().as_secs_f64() / self.done as f64 * (self.of - self.done) as f64;
            let failed = match self.failed {
                0 => String::new(),
                n => format!(", {} not finished", count(n as u64)),
            };
            let (done, of) = (count(self.done as u64), counted(self.of as u64, "design"));
            format!("{done} of {of} {}{failed} · {} left", self.what, duration(left))
        };
        if let Some(bar) = &self.shown.bar {
            bar.set_message(describe());
            bar.tick();
        } else if self.shown.lines && self.printed.elapsed() >= EVERY {
            terminal::print_line(&describe());
            self.printed = Instant::now();
        }
    }
}
