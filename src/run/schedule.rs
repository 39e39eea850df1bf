//! When a run stops to switch, and when it gives output.

use crate::case::schema::Case;
use crate::case::{Rotation, Signal, Translation};
use crate::model::Model;

/// Ends of the smooth intervals of a run, the end of the run last: every time at which a signal kinks or jumps.
pub fn stops(case: &Case, model: &Model) -> Vec<f64> {
    let mut times = Vec::new();
    each_signal(model, |s| s.breaks(&mut times));
    let end = case.time.end_s;
    let closest = 1e-9 * end;
    times.retain(|t| *t > closest && *t < end - closest);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|a, b| *a - *b < closest);
    times.push(end);
    times
}

/// Shortest time scale of any signal [s].
pub fn fastest_period(model: &Model) -> Option<f64> {
    let mut fastest: Option<f64> = None;
    each_signal(model, |s| {
        if let Some(period) = s.fastest_period_s() {
            fastest = Some(fastest.map_or(period, |f| f.min(period)));
        }
    });
    fastest
}

fn each_signal(model: &Model, mut visit: impl FnMut(&Signal)) {
    for end in &model.ends {
        for motion in [&end.transverse, &end.axial] {
            match motion {
                Translation::Displacement(s) | Translation::Force(s) => visit(s),
            }
        }
        match &end.rotation {
            Rotation::Slope(s) | Rotation::Moment(s) => visit(s),
        }
        if let Some(follower) = &end.follower {
            visit(&follower.normal);
            visit(&follower.shear);
        }
    }
    for load in &model.loads {
        visit(&load.signal);
    }
    if let Some(wet) = &model.wet {
        wet.network.links.iter().filter_map(|l| l.opening.as_ref()).for_each(&mut visit);
        wet.network.ports.iter().map(|p| &p.pressure).for_each(&mut visit);
        wet.network.sources.iter().map(|s| &s.flow).for_each(&mut visit);
    }
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
        Self { interval, end, next: 0, last: (end / interval * (1.0 + 1e-12)).floor() as u64 }
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
