//! Derivatives of the quantities of interest. Those of largest values are taken at the instants at which they are reached, those of
//! last values and increments at the ends of run and window. Those of root mean squares use the output times, which must be close
//! enough to represent the motion.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::discrete::quantities::{Group, Interest, InterestSource, Observable};
use crate::run::summary::Quantity;

/// Derivatives with respect to one number of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FigureSensitivity {
    /// Value of the number, in the unit of its key.
    pub value: f64,
    /// Derivatives of the quantities per unit of the number, by the names and keys of the quantities.
    pub quantities: BTreeMap<String, Quantity>,
    /// Derivatives of the quantities at probes.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub probes: BTreeMap<String, Quantity>,
}

/// Figures of one quantity with derivatives by one number; that of a largest value is taken at the instant at which it is reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Track {
    last: [f64; 2],
    first: Option<[f64; 2]>,
    largest: [f64; 2],
    window_largest: [f64; 2],
    /// Integrals of the square and of value times derivative over the window, by the trapezoid rule between output times, and the
    /// time that they cover.
    squares: f64,
    slopes: f64,
    time: f64,
    /// Last output time in the window, with both integrands.
    before: Option<[f64; 3]>,
}

impl Track {
    /// Adds a value and its derivative.
    fn take(&mut self, t: f64, now: [f64; 2], in_window: bool) {
        let [value, slope] = now;
        self.last = now;
        self.see(now, in_window);
        if in_window {
            self.first.get_or_insert(now);
            let here = [t, value * value, value * slope];
            if let Some(before) = self.before {
                let half = 0.5 * (t - before[0]);
                self.squares += half * (before[1] + here[1]);
                self.slopes += half * (before[2] + here[2]);
                self.time += 2.0 * half;
            }
            self.before = Some(here);
        }
    }

    /// Records a value and its derivative at any time, if it is the largest.
    fn see(&mut self, [value, slope]: [f64; 2], in_window: bool) {
        let size = [value.abs(), slope * value.signum()];
        let larger = |old: &mut [f64; 2]| {
            if size[0] > old[0] {
                *old = size;
            }
        };
        larger(&mut self.largest);
        if in_window {
            larger(&mut self.window_largest);
        }
    }

    /// Derivative of `√(∫ v² dt/T)`, which is `∫ v v' dt / √(T ∫ v² dt)`.
    fn rms(&self) -> Option<f64> {
        (self.squares > 0.0).then(|| self.slopes / (self.time * self.squares).sqrt())
    }

    fn sizes(&self) -> Quantity {
        let reached = |largest: [f64; 2]| (largest[0] > 0.0).then_some(largest[1]);
        Quantity {
            last: Some(self.last[1]),
            max_abs: reached(self.largest),
            window_max_abs: reached(self.window_largest),
            window_rms: self.rms(),
            ..Quantity::default()
        }
    }

    fn increment(&self) -> [f64; 2] {
        let first = self.first.unwrap_or(self.last);
        [self.last[0] - first[0], self.last[1] - first[1]]
    }

    fn energy(&self) -> Quantity {
        Quantity {
            last: Some(self.last[1]),
            window: self.first.map(|_| self.increment()[1]),
            ..Quantity::default()
        }
    }
}

/// Accumulates a history and its derivatives; the quantities are those of [`crate::run::figures::Figures`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DerivativeAccumulator {
    window_start: f64,
    turbines: bool,
    tracks: BTreeMap<Interest, Track>,
    /// Tracks of the quantities at probes, in their order.
    probes: Vec<Track>,
    /// Energy spent, `H + D - P` ([`crate::run::energies`]), for the efficiency.
    spent: Track,
}

impl DerivativeAccumulator {
    /// Creates the figures with a window from `window_start` [s] on; `turbines` is true if there are any.
    pub fn new(window_start: f64, turbines: bool) -> Self {
        Self {
            window_start,
            turbines,
            tracks: BTreeMap::new(),
            probes: vec![],
            spent: Track::default(),
        }
    }

    /// Adds one instant: `at` returns a quantity's value and its derivative, `None` if there is no such column.
    pub fn take(&mut self, t: f64, at: impl Fn(Observable) -> Option<[f64; 2]>) {
        let in_window = t >= self.window_start;
        let add = |sum: [f64; 2], sign: f64, of: Observable| {
            let [value, slope] = at(of).unwrap_or_default();
            [sum[0] + sign * value, sum[1] + sign * slope]
        };
        let sum = |group: Group| Observable::grouped(group).fold([0.0; 2], |sum, of| add(sum, 1.0, of));
        for one in Interest::recorded([true, self.turbines]) {
            let now = match one.source() {
                InterestSource::Motion(_) => motion(one, &at),
                InterestSource::Energy(group) => Some(sum(group)),
                InterestSource::Efficiency => None,
            };
            if let Some(now) = now {
                self.tracks.entry(one).or_default().take(t, now, in_window);
            }
        }
        if self.turbines {
            let spent = Observable::grouped(Group::Lost).fold(sum(Group::Harvested), |sum, of| add(sum, 1.0, of));
            let spent = Observable::grouped(Group::Added).fold(spent, |sum, of| add(sum, -1.0, of));
            self.spent.take(t, spent, in_window);
        }
    }

    /// Adds an instant at which a value may be largest: motions with `at` as in [`Figures::take`], and values at probes.
    pub fn see(
        &mut self,
        t: f64,
        at: impl Fn(Observable) -> Option<[f64; 2]>,
        probes: impl ExactSizeIterator<Item = [f64; 2]>,
    ) {
        let in_window = t >= self.window_start;
        let swings =
            Interest::recorded([true, self.turbines]).filter(|one| matches!(one.source(), InterestSource::Motion(_)));
        for one in swings {
            if let Some(now) = motion(one, &at) {
                self.tracks.entry(one).or_default().see(now, in_window);
            }
        }
        self.probes.resize(probes.len(), Track::default());
        for (track, now) in self.probes.iter_mut().zip(probes) {
            track.see(now, in_window);
        }
    }

    /// Adds values at probes and their derivatives at one instant.
    pub fn take_probes(&mut self, t: f64, all: impl ExactSizeIterator<Item = [f64; 2]>) {
        self.probes.resize(all.len(), Track::default());
        for (track, now) in self.probes.iter_mut().zip(all) {
            track.take(t, now, t >= self.window_start);
        }
    }

    /// Derivatives at probes by their names, per unit of the number.
    pub fn at_probes(&self, names: &[String]) -> BTreeMap<String, Quantity> {
        let all = names.iter().cloned().zip(&self.probes);
        all.map(|(name, track)| (name, track.sizes())).collect()
    }

    /// The derivatives by quantity, per unit of the number.
    pub fn quantities(&self) -> BTreeMap<String, Quantity> {
        let of = |(one, track): (&Interest, &Track)| {
            let quantity = match one.source() {
                InterestSource::Energy(_) => track.energy(),
                _ => track.sizes(),
            };
            (one.name().to_string(), quantity)
        };
        let mut all: BTreeMap<_, _> = self.tracks.iter().map(of).collect();
        let track = |of: Interest| self.tracks.get(&of);
        if let (Some(harvested), Some(input)) = (track(Interest::HarvestedEnergy), track(Interest::InputEnergy)) {
            let efficiency = Quantity {
                last: ratio(harvested.last, input.last),
                window: ratio(harvested.increment(), self.spent.increment()),
                ..Quantity::default()
            };
            all.insert(Interest::Efficiency.name().into(), efficiency);
        }
        all
    }
}

/// Value of a motion and its derivative, from its columns; of several the one of largest magnitude.
fn motion(one: Interest, at: &impl Fn(Observable) -> Option<[f64; 2]>) -> Option<[f64; 2]> {
    match one.columns() {
        [column] => at(*column),
        columns => {
            let all = columns.iter().filter_map(|column| at(*column));
            let larger = all.reduce(|a, b| if b[0].abs() > a[0].abs() { b } else { a });
            larger.map(|[value, slope]| [value.abs(), slope * value.signum()])
        }
    }
}

/// Derivative of a/b.
fn ratio([a, da]: [f64; 2], [b, db]: [f64; 2]) -> Option<f64> {
    let slope = (da - a / b * db) / b;
    slope.is_finite().then_some(slope)
}
