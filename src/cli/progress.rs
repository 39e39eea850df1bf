//! Progress of a run on stderr: a bar on a terminal, occasional lines elsewhere.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::terminal;
use crate::output::numbers::{counted, duration, percent, quantity, significant};
use crate::run::record::Progress;

/// Interval between two updates of the bar.
const BAR_EVERY: Duration = Duration::from_millis(100);
/// Interval between two lines without a terminal.
const LINE_EVERY: Duration = Duration::from_secs(30);
/// Largest number of steps between two readings of the clock, which cost more than all else here.
const MOST_STEPS: u32 = 64;
/// Number of positions of the bar.
const FULL: u64 = 1000;

/// Shows the progress of a run. Cleared when dropped.
#[derive(Debug)]
pub struct ProgressDisplay {
    place: Place,
    every: Duration,
    /// Steps until the next reading of the clock.
    wait: u32,
    steps_a_look: u32,
    looked: Instant,
    shown: Instant,
    begun: Instant,
    left: TimeLeft,
}

#[derive(Debug)]
enum Place {
    Nowhere,
    Terminal(ProgressBar),
    Lines,
}

impl ProgressDisplay {
    /// Creates a display on stderr, or a silent one if `quiet` is set.
    pub fn new(quiet: bool) -> Self {
        let place = match (quiet, std::io::stderr().is_terminal()) {
            (true, _) => Place::Nowhere,
            (false, true) => Place::Terminal(bar()),
            (false, false) => Place::Lines,
        };
        let every = if matches!(place, Place::Lines) {
            LINE_EVERY
        } else {
            BAR_EVERY
        };
        let now = Instant::now();
        Self {
            place,
            every,
            wait: 1,
            steps_a_look: 1,
            looked: now,
            shown: now,
            begun: now,
            left: TimeLeft::default(),
        }
    }

    /// Updates the display after a step. Costs a comparison unless the clock is due.
    #[inline]
    pub fn step(&mut self, progress: &Progress) {
        self.wait -= 1;
        if self.wait == 0 {
            self.look(progress);
        }
    }

    #[cold]
    fn look(&mut self, progress: &Progress) {
        if matches!(self.place, Place::Nowhere) {
            self.wait = u32::MAX;
            return;
        }
        let now = Instant::now();
        // The clock is read after each slow step, but less often after fast ones.
        let fast = now - self.looked < BAR_EVERY / 20;
        self.steps_a_look = if fast {
            (2 * self.steps_a_look).min(MOST_STEPS)
        } else {
            (self.steps_a_look / 2).max(1)
        };
        self.wait = self.steps_a_look;
        self.looked = now;
        if now - self.shown < self.every {
            return;
        }
        self.shown = now;
        self.left.update((now - self.begun).as_secs_f64(), progress.t);
        self.show(progress);
    }

    fn show(&self, progress: &Progress) {
        let share = if progress.end > 0.0 {
            (progress.t / progress.end).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let text = line(progress, self.left.left(progress));
        match &self.place {
            Place::Nowhere => {}
            Place::Terminal(bar) => {
                bar.set_message(text);
                bar.set_position((share * FULL as f64) as u64);
            }
            Place::Lines => terminal::print_line(&format!("{}: {text}", percent(share))),
        }
    }
}

impl Drop for ProgressDisplay {
    fn drop(&mut self) {
        if let Place::Terminal(bar) = &self.place {
            bar.finish_and_clear();
        }
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(FULL), ProgressDrawTarget::stderr_with_hz(10));
    let style = ProgressStyle::with_template("{percent:>3} % {wide_bar:.blue/dim} {msg}");
    bar.set_style(
        style
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .progress_chars("━╸━"),
    );
    bar
}

/// `0.210 / 1.00 s · 12 345 steps, now 12 µs, order 4 · 1 min 20 s left`
fn line(progress: &Progress, left: Option<f64>) -> String {
    let left = left.map_or(String::new(), |s| format!(" · {} left", duration(s)));
    format!(
        "{} / {} · {}, now {}, order {}{left}",
        significant(progress.t, 3),
        quantity(progress.end, "s", 3),
        counted(progress.steps, "step"),
        quantity(progress.step, "s", 2),
        progress.order,
    )
}

/// Simulated time per second of wall time, over the recent past.
#[derive(Clone, Copy, Debug, Default)]
struct TimeLeft {
    wall: f64,
    t: f64,
    rate: Option<f64>,
}

impl TimeLeft {
    /// Updates the rate: at the wall time `wall` [s] since the start, the simulated time is `t` [s].
    fn update(&mut self, wall: f64, t: f64) {
        let (passed, gained) = (wall - self.wall, t - self.t);
        if passed <= 0.0 {
            return;
        }
        // A memory of a third of the elapsed time forgets slow starts, and a memory of at most half a minute follows changes of stiffness.
        let memory = (wall / 3.0).clamp(0.5, 30.0);
        let weight = 1.0 - (-passed / memory).exp();
        let now = gained / passed;
        self.rate = Some(self.rate.map_or(now, |rate| rate + weight * (now - rate)));
        (self.wall, self.t) = (wall, t);
    }

    /// Wall time left [s], once it can be estimated.
    fn left(&self, progress: &Progress) -> Option<f64> {
        let rate = self.rate.filter(|r| *r > 0.0)?;
        Some((progress.end - progress.t).max(0.0) / rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn progress(t: f64) -> Progress {
        Progress {
            t,
            end: 1.0,
            steps: 12345,
            step: 1.23e-5,
            order: 4,
        }
    }

    #[test]
    fn time_left_follows_a_change_of_pace() {
        let mut left = TimeLeft::default();
        let mut t = 0.0;
        for k in 1..=600 {
            // Ten times slower in the first ten seconds of a minute.
            t += if k <= 100 { 0.0001 } else { 0.001 };
            left.update(0.1 * f64::from(k), t);
        }
        let seconds = left.left(&progress(t)).expect("an estimate");
        let truth = (1.0 - t) / 0.01;
        assert!((seconds / truth - 1.0).abs() < 0.1, "{seconds} against {truth}");
    }

    #[test]
    fn the_line_reads_well() {
        assert_eq!(
            line(&progress(0.21), Some(80.0)),
            "0.210 / 1.00 s · 12 345 steps, now 12 µs, order 4 · 1 min 20 s left"
        );
    }

    #[test]
    fn a_step_that_is_not_due_costs_next_to_nothing() {
        let mut watcher = ProgressDisplay::new(false);
        watcher.place = Place::Lines;
        watcher.every = Duration::from_secs(3600);
        let start = Instant::now();
        const STEPS: u32 = 200_000;
        for k in 0..STEPS {
            watcher.step(std::hint::black_box(&progress(f64::from(k))));
        }
        let nanoseconds = start.elapsed().as_nanos() as f64 / f64::from(STEPS);
        // The goal is 50 ns; ten times that allows for builds without optimization and for busy machines.
        assert!(nanoseconds < 500.0, "{nanoseconds} ns a step");
    }
}
