//! Derivatives of the quantities of interest, followed as the history is: of largest values and means over the output times, which must
//! be close enough for these to be those of the motion; of last values and increments at the ends of the run and of the window.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::run::summary::Quantity;

/// Derivatives with respect to one number of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensitivity {
    /// The number, in the unit that its key names.
    pub value: f64,
    /// Derivatives of the quantities, each per unit of the number; by the names and keys of the quantities themselves.
    pub quantities: BTreeMap<String, Quantity>,
}

/// Derivatives of the figures of one number: of a largest value, its own at the instant when it is reached.
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
    /// The last output time in the window with both integrands.
    before: Option<[f64; 3]>,
}

impl Track {
    /// Takes a value with its derivative.
    fn take(&mut self, t: f64, now: [f64; 2], in_window: bool) {
        let [value, slope] = now;
        let size = [value.abs(), slope * value.signum()];
        let larger = |old: &mut [f64; 2]| {
            if size[0] > old[0] {
                *old = size;
            }
        };
        self.last = now;
        larger(&mut self.largest);
        if in_window {
            self.first.get_or_insert(now);
            larger(&mut self.window_largest);
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

/// Columns that are quantities by themselves, with their names as such.
const PLAIN: [(&str, &str); 3] = [
    ("tip_u1", "tip_u1_m"),
    ("tip_u3", "tip_u3_m"),
    ("tip_angle", "tip_angle_rad"),
];

/// What goes besides the harvest, with its sign in `H + D - P` ([`crate::run::energies`]).
const SPENT: [(&str, f64); 6] = [
    ("dissipated_bladders", 1.0),
    ("dissipated_tubes", 1.0),
    ("dissipated_rectifiers", 1.0),
    ("dissipated_damping", 1.0),
    ("work_formulation", -1.0),
    ("work_reciprocity", -1.0),
];
/// Their sum with the harvest: followed for the efficiency, no quantity itself.
const SPENT_NAME: &str = "spent";

/// Follows a history and its derivatives; the quantities are those of [`crate::run::figures::Figures`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    window_start: f64,
    turbines: bool,
    tracks: BTreeMap<String, Track>,
}

impl Figures {
    /// From an instant [s] on the window is open; `turbines` when there are any.
    pub fn new(window_start: f64, turbines: bool) -> Self {
        Self {
            window_start,
            turbines,
            tracks: BTreeMap::new(),
        }
    }

    /// Takes one instant: `at` gives a column's value and its derivative, `None` where there is no such column.
    pub fn take(&mut self, t: f64, at: impl Fn(&str) -> Option<[f64; 2]>) {
        let in_window = t >= self.window_start;
        let mut track = |name: &str, now: [f64; 2]| match self.tracks.get_mut(name) {
            Some(track) => track.take(t, now, in_window),
            None => self.tracks.entry(name.into()).or_default().take(t, now, in_window),
        };
        for (column, name) in PLAIN {
            if let Some(now) = at(column) {
                track(name, now);
            }
        }
        if let (Some(high), Some(low)) = (at("max_pressure"), at("min_pressure")) {
            let larger = if high[0].abs() >= low[0].abs() { high } else { low };
            track("max_pressure_pa", [larger[0].abs(), larger[1] * larger[0].signum()]);
        }
        let works = ["work_loads", "work_ends", "work_ports"].into_iter().filter_map(&at);
        let input = works.fold([0.0; 2], |sum, work| [sum[0] + work[0], sum[1] + work[1]]);
        track("input_energy_j", input);
        if let Some(now) = at("harvested").filter(|_| self.turbines) {
            track("harvested_energy_j", now);
            let parts = SPENT.iter().filter_map(|(column, sign)| Some((at(column)?, sign)));
            let spent = parts.fold(now, |sum, (part, sign)| {
                [sum[0] + sign * part[0], sum[1] + sign * part[1]]
            });
            track(SPENT_NAME, spent);
        }
    }

    /// The derivatives by quantity, per unit of the number.
    pub fn quantities(&self) -> BTreeMap<String, Quantity> {
        let mut all = BTreeMap::new();
        for (name, track) in self.tracks.iter().filter(|(name, _)| *name != SPENT_NAME) {
            let energy = name.ends_with("_j");
            all.insert(name.clone(), if energy { track.energy() } else { track.sizes() });
        }
        let track = |name: &str| self.tracks.get(name);
        if let (Some(harvested), Some(input), Some(spent)) =
            (track("harvested_energy_j"), track("input_energy_j"), track(SPENT_NAME))
        {
            let efficiency = Quantity {
                last: ratio(harvested.last, input.last),
                window: ratio(harvested.increment(), spent.increment()),
                ..Quantity::default()
            };
            all.insert("efficiency".into(), efficiency);
        }
        all
    }
}

/// Derivative of a/b.
fn ratio([a, da]: [f64; 2], [b, db]: [f64; 2]) -> Option<f64> {
    let slope = (da - a / b * db) / b;
    slope.is_finite().then_some(slope)
}
