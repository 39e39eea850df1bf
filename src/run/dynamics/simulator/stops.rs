//! Stops of the case and of inputs that move, and the smooth intervals between them.

use super::Simulator;
use crate::run::schedule::ScheduledStop;

impl Simulator {
    /// Returns the time [s], or that of a stop of the case if they differ by round-off alone.
    pub(super) fn at_stop(&self, until: f64) -> f64 {
        let near = |stop: &&ScheduledStop| (stop.t - until).abs() <= 1e-12 * until && stop.t > self.time();
        let ahead = self.stops[self.next..].iter();
        let mut ahead = ahead.take_while(|stop| stop.t <= until * (1.0 + 1e-12));
        ahead.find(near).map_or(until, |stop| stop.t)
    }

    /// True if the simulation is at a stop that it has not passed: its row is that before the stop, as in a history.
    pub(super) fn stands_at_stop(&self) -> bool {
        self.next + 1 < self.stops.len() && self.time() >= self.stops[self.next].t
    }

    /// An instant in the smooth interval that ends at time `t` [s].
    pub(super) fn behind(&self, t: f64) -> f64 {
        let mut last = self.next.checked_sub(1).map_or(0.0, |k| self.stops[k].t);
        if self.course.0 < t {
            last = last.max(self.course.0);
        }
        if last < t {
            0.5 * (last + t)
        } else {
            t - 1e-9 * self.end
        }
    }

    /// An instant in the present smooth interval.
    pub(super) fn inside(&self) -> f64 {
        let t = self.time();
        let end = self.course.1.unwrap_or(f64::INFINITY);
        if self.stands_at_stop() || t >= end {
            self.behind(t)
        } else {
            0.5 * (t + self.stops[self.next].t.min(end))
        }
    }

    /// Time of the next jump of the case's own signals [s].
    pub fn next_jump(&self) -> Option<f64> {
        let ahead = self.stops[self.next..].iter().skip(usize::from(self.stands_at_stop()));
        ahead.filter(|stop| stop.switches).map(|stop| stop.t).next()
    }
}
