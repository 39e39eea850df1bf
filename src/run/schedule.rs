//! Schedule of a run: stops at switches and checkpoints, output times, and ends of the window.

use std::collections::VecDeque;

use crate::case::schema::Case;
use crate::model::Model;

/// A time at which the integrator stops and restarts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScheduledStop {
    /// Time [s].
    pub t: f64,
    /// True if a signal has a kink or jump here.
    pub switches: bool,
    /// True if a checkpoint is due here.
    pub checkpoint: bool,
    /// True if a controller takes a sample here.
    pub samples: bool,
}

impl ScheduledStop {
    /// A stop at a time [s] for nothing yet.
    fn at(t: f64) -> Self {
        Self {
            t,
            switches: false,
            checkpoint: false,
            samples: false,
        }
    }
}

/// Part of a run within which two stops coincide.
pub const CLOSEST: f64 = 1e-9;

/// Relative difference of equal times by rounding errors.
const ROUND_OFF: f64 = 1e-15;

/// All stops of a run in order, its end last.
pub fn stops(case: &Case, model: &Model) -> Vec<ScheduledStop> {
    let end = case.time.end_s;
    let closest = CLOSEST * end;
    let mut switches = Vec::new();
    model.each_signal(|s| s.breaks(end, &mut switches));
    let switch = |t| ScheduledStop {
        switches: true,
        ..ScheduledStop::at(t)
    };
    let mut all: Vec<ScheduledStop> = switches.into_iter().map(switch).collect();
    let samples = model
        .controllers
        .iter()
        .flat_map(|one| one.controller.sample_times(end));
    all.extend(samples.map(|t| ScheduledStop {
        samples: true,
        ..ScheduledStop::at(t)
    }));
    if let Some(interval) = case.time.checkpoint_interval_s {
        let count = (end / interval).ceil() as u64;
        all.extend((1..count).map(|k| ScheduledStop {
            checkpoint: true,
            ..ScheduledStop::at(k as f64 * interval)
        }));
    }
    // a stop at an output time has its bits, so that the output is the one before the stop
    let interval = case.time.output_interval();
    for stop in &mut all {
        let output = (stop.t / interval).round() * interval;
        if (stop.t - output).abs() <= ROUND_OFF * output {
            stop.t = output;
        }
    }
    all.retain(|s| s.t > closest && s.t < end - closest);
    all.sort_by(|a, b| a.t.total_cmp(&b.t));
    all.dedup_by(|next, kept| {
        let same = next.t - kept.t < closest;
        if same {
            kept.switches |= next.switches;
            kept.checkpoint |= next.checkpoint;
            kept.samples |= next.samples;
        }
        same
    });
    all.push(ScheduledStop::at(end));
    all
}

/// True if any signal changes in time.
pub fn changes(model: &Model) -> bool {
    let mut changes = false;
    model.each_signal(|s| changes |= !s.is_constant());
    changes
}

/// A time at which the state is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleTime {
    /// Time [s].
    pub t: f64,
    /// Number of the output that is due; `None` at an end of the window between two outputs.
    pub output: Option<u64>,
}

/// Output times: multiples of the interval, the end of the run even if it is none of them, and the ends of the window.
#[derive(Clone, Debug)]
pub struct Outputs {
    interval: f64,
    end: f64,
    next: u64,
    last: u64,
    /// Explicit output times that replace the multiples of the interval [s].
    own: Option<Vec<f64>>,
    /// Remaining ends of the window at which there is no output [s].
    marks: VecDeque<f64>,
}

/// Fraction of the window within which an output coincides with an end of it.
pub const SAME: f64 = 1e-9;

impl Outputs {
    /// Output times of a case, from zero.
    pub fn new(case: &Case) -> Self {
        let (interval, end, window) = (case.time.output_interval(), case.time.end_s, case.time.window());
        let last = (end / interval * (1.0 - 1e-12)).ceil();
        let apart = |t: f64| t < end && (t - (t / interval).round() * interval).abs() > SAME * window;
        Self {
            interval,
            end,
            next: 0,
            last: last as u64,
            own: None,
            marks: [end - window, end]
                .into_iter()
                .filter(|t| *t > 0.0 && apart(*t))
                .collect(),
        }
    }

    /// Explicit output times [s] in place of those of the case: at least one, in ascending order, none after its end.
    pub fn at(case: &Case, instants: &[f64]) -> Self {
        Self {
            last: instants.len().saturating_sub(1) as u64,
            own: Some(instants.to_vec()),
            ..Self::new(case)
        }
    }

    /// Time of output `number` [s].
    fn time(&self, number: u64) -> f64 {
        let time = match &self.own {
            Some(own) => own.get(number as usize).copied().unwrap_or(self.end),
            None => number as f64 * self.interval,
        };
        time.min(self.end)
    }

    /// True if the output times were given explicitly, so that no others are wanted.
    pub fn are_given(&self) -> bool {
        self.own.is_some()
    }

    /// Number of the next output.
    pub fn next(&self) -> u64 {
        self.next
    }

    /// Continues after time `t` [s], up to which all samples are done, with output `next`.
    pub fn go_on(&mut self, next: u64, t: f64) {
        self.next = next;
        self.marks.retain(|mark| *mark > t);
    }

    /// Next time at which the state is sampled, if not after `t` [s].
    pub fn due(&mut self, t: f64) -> Option<SampleTime> {
        let output = (self.next <= self.last).then(|| self.time(self.next));
        let mark = self.marks.front().copied();
        match (output, mark) {
            (output, Some(mark)) if mark <= t && output.is_none_or(|output| mark < output) => {
                self.marks.pop_front();
                Some(SampleTime { t: mark, output: None })
            }
            (Some(output), _) if output <= t => {
                self.next += 1;
                Some(SampleTime {
                    t: output,
                    output: Some(self.next - 1),
                })
            }
            _ => None,
        }
    }
}
