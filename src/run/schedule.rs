//! When a run stops to switch, and when it gives output.

use crate::case::schema::Case;
use crate::model::{Model, each_signal};

/// A time at which the integrator stops and starts afresh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// When [s].
    pub t: f64,
    /// A signal kinks or jumps here.
    pub switches: bool,
    /// A checkpoint is due here.
    pub checkpoint: bool,
}

/// All stops of a run in order, its end last.
pub fn stops(case: &Case, model: &Model) -> Vec<Stop> {
    let end = case.time.end_s;
    let closest = 1e-9 * end;
    let mut switches = Vec::new();
    each_signal(&model.ends, &model.loads, model.wet.as_ref().map(|w| &w.network), |s| {
        s.breaks(&mut switches)
    });
    let mut all: Vec<Stop> = switches
        .into_iter()
        .map(|t| Stop {
            t,
            switches: true,
            checkpoint: false,
        })
        .collect();
    if let Some(interval) = case.time.checkpoint_interval_s {
        let count = (end / interval).ceil() as u64;
        all.extend((1..count).map(|k| Stop {
            t: k as f64 * interval,
            switches: false,
            checkpoint: true,
        }));
    }
    all.retain(|s| s.t > closest && s.t < end - closest);
    all.sort_by(|a, b| a.t.total_cmp(&b.t));
    all.dedup_by(|next, kept| {
        let same = next.t - kept.t < closest;
        if same {
            kept.switches |= next.switches;
            kept.checkpoint |= next.checkpoint;
        }
        same
    });
    all.push(Stop {
        t: end,
        switches: false,
        checkpoint: false,
    });
    all
}

/// Shortest time scale of any signal that no stop marks, until `end` [s].
pub fn fastest_period(model: &Model, end: f64) -> Option<f64> {
    let mut fastest: Option<f64> = None;
    each_signal(&model.ends, &model.loads, model.wet.as_ref().map(|w| &w.network), |s| {
        if let Some(period) = s.shortest_unmarked_time_s(end) {
            fastest = Some(fastest.map_or(period, |f| f.min(period)));
        }
    });
    fastest
}

/// Whether any signal changes in time.
pub fn changes(model: &Model) -> bool {
    let mut changes = false;
    each_signal(&model.ends, &model.loads, model.wet.as_ref().map(|w| &w.network), |s| {
        changes |= !s.is_constant()
    });
    changes
}

/// Output times `k interval`, up to and including the end.
#[derive(Clone, Copy, Debug)]
pub struct Outputs {
    interval: f64,
    end: f64,
    next: u64,
    last: u64,
}

impl Outputs {
    /// Times from zero.
    pub fn new(interval: f64, end: f64) -> Self {
        Self {
            interval,
            end,
            next: 0,
            last: (end / interval * (1.0 + 1e-12)).floor() as u64,
        }
    }

    /// Number of the next output.
    pub fn next(&self) -> u64 {
        self.next
    }

    /// Goes on with the output of this number.
    pub fn go_on(&mut self, next: u64) {
        self.next = next;
    }

    /// Next output time not after `t`, and its number.
    pub fn due(&mut self, t: f64) -> Option<(u64, f64)> {
        if self.next > self.last {
            return None;
        }
        let time = (self.next as f64 * self.interval).min(self.end);
        if time > t {
            return None;
        }
        self.next += 1;
        Some((self.next - 1, time))
    }
}
