//! Energies of a run and their errors: each energy figure is compared with the energy balance over the same time.
//!
//! Symbols: H is the harvested energy, D other dissipation, r the residual of the balance. P is the energy added by a
//! nonreciprocal coupling and by the published formulation. Over any time
//!
//! ```text
//! W - ΔE = H + D - P - Δr                    W put in, E stored
//! error of a figure X = max |r(t) - r(t0)|/|X|
//! efficiency = H/W over the run (3.2),  H/(H + D - P) over the window
//! ```
//!
//! Energy stored before the window is no input within it, so the window efficiency divides by `W - ΔE`. This is computed as
//! `H + D - P`: Δr is mainly an error of the works, which are differences of energy put in and returned. Losses only grow and
//! have smaller errors. A quotient whose denominator is below the numerical error of the run has no value:
//!
//! ```text
//! |denominator| <= max(E_f, max(rtol², 1e-12) max(|E|, |W|))        E_f the energy of a displacement that is round-off
//! ```

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::schedule::SAME;
use super::summary::{MissingRatio, Quantity};
use crate::case::schema::Case;
use crate::discrete::quantities::{Group, Interest, ObservableRow};
use crate::error::Code;
use crate::error::numbers::quantity;

/// Relative error of a figure above which the run warns.
const OPEN: f64 = 0.1;
/// Largest number of figures in the warning; the rest is counted.
const NAMED: usize = 2;
/// Energy figures below this fraction of the largest stored energy are remainders of larger terms that cancel.
pub const REMAINDER: f64 = 3e-3;
/// Amount by which an efficiency must be above one, or below zero, to exceed its rounding error.
const ROUND_OFF: f64 = 1e-6;
/// Rounding error of energies summed over the beam and the run, relative to the largest energy.
pub const ROUNDING: f64 = 1e-12;

/// Energies at an instant, or gains over a time [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Parts {
    input: f64,
    harvested: f64,
    dissipated: f64,
    added: f64,
    stored: f64,
}

impl Parts {
    fn since(&self, start: &Self) -> Self {
        Self {
            input: self.input - start.input,
            harvested: self.harvested - start.harvested,
            dissipated: self.dissipated - start.dissipated,
            added: self.added - start.added,
            stored: self.stored - start.stored,
        }
    }

    /// `H + D - P`.
    fn spent(&self) -> f64 {
        self.harvested + self.dissipated - self.added
    }

    /// True if a coupling or formulation that does not conserve energy contributes.
    fn fed(&self) -> bool {
        self.added.abs() > ROUND_OFF * self.harvested.abs()
    }
}

/// Energies and residual of the balance at an instant, and the range of the residual since then [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Since {
    start: Option<(Parts, f64)>,
    residual: Option<[f64; 2]>,
}

impl Since {
    fn see(&mut self, residual: f64) {
        let [low, high] = self.residual.unwrap_or([residual; 2]);
        self.residual = Some([low.min(residual), high.max(residual)]);
    }

    /// Largest change of the residual since the instant [J].
    fn open(&self) -> f64 {
        match (self.start, self.residual) {
            (Some((_, first)), Some([low, high])) => (high - first).max(first - low).max(0.0),
            _ => 0.0,
        }
    }

    fn gained(&self, now: &Parts) -> Parts {
        self.start.map_or(Parts::default(), |(start, _)| now.since(&start))
    }
}

/// Accumulates the energies of a history.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyAccumulator {
    window_start: f64,
    turbines: bool,
    last: Parts,
    /// Largest stored energy of the outputs [J].
    pub largest_stored: f64,
    /// Largest input energy of the outputs [J].
    #[serde(default)]
    pub largest_input: f64,
    /// Energy below which values are round-off [J].
    #[serde(default)]
    floor: f64,
    run: Since,
    window: Since,
}

impl EnergyAccumulator {
    /// Creates the accumulator of a case in which energies below `floor` [J] are round-off.
    pub fn new(case: &Case, floor: f64) -> Self {
        Self {
            floor,
            window_start: case.time.end_s - case.time.window() * (1.0 + SAME),
            turbines: case.network.as_ref().is_some_and(|n| !n.turbines.is_empty()),
            ..Self::default()
        }
    }

    /// Adds one row of the history.
    pub fn take(&mut self, row: &ObservableRow) {
        let now = Parts {
            input: row.sum(Group::PutIn),
            harvested: row.sum(Group::Harvested),
            dissipated: row.sum(Group::Lost),
            added: row.sum(Group::Added),
            stored: row.sum(Group::Stored),
        };
        let residual = row.sum(Group::Open);
        self.last = now;
        self.largest_stored = self.largest_stored.max(now.stored.abs());
        self.largest_input = self.largest_input.max(now.input.abs());
        self.see(row.t(), residual);
        self.run.start.get_or_insert((now, residual));
        if row.t() >= self.window_start {
            self.window.start.get_or_insert((now, residual));
        }
    }

    /// Adds the residual of the balance [J] at any time [s].
    pub fn see(&mut self, t: f64, residual: f64) {
        self.run.see(residual);
        if t >= self.window_start {
            self.window.see(residual);
        }
    }

    /// Numerical error [J] of the energies of a run with relative tolerance `rtol`.
    fn numerical_error(&self, rtol: f64) -> f64 {
        let relative = (rtol * rtol).max(ROUNDING);
        self.floor.max(relative * self.largest_stored.max(self.largest_input))
    }

    /// Sets the error of every energy figure of a run with relative tolerance `rtol`, and the efficiency of the window. An
    /// efficiency whose denominator is below the numerical error has no value.
    pub fn complete(&self, quantities: &mut BTreeMap<String, Quantity>, rtol: f64) {
        let (run, window) = (self.run.gained(&self.last), self.window.gained(&self.last));
        let (opened, open) = (self.run.open(), self.window.open());
        let relative = |open: f64, size: f64| finite(open / size.abs());
        for (name, run, window) in [
            (Interest::InputEnergy, run.input, window.input),
            (Interest::HarvestedEnergy, run.harvested, window.harvested),
        ] {
            if let Some(q) = quantities.get_mut(name.name()) {
                q.final_error = relative(opened, run);
                q.window_error = relative(open, window);
            }
        }
        if let Some(q) = quantities.get_mut(Interest::Efficiency.name()) {
            q.window = finite(window.harvested / window.spent());
            let least = self.numerical_error(rtol);
            let absent = |since: &Since, of: f64| {
                (since.start.is_some() && of.abs() <= least).then_some(MissingRatio::BelowNumericalError)
            };
            q.final_absent = absent(&self.run, run.input);
            q.last = q.last.filter(|_| q.final_absent.is_none());
            q.window_absent = absent(&self.window, window.spent());
            q.window = q.window.filter(|_| q.window_absent.is_none());
            q.final_error = q.last.and_then(|_| relative(opened, run.input));
            q.window_error = q.window.and_then(|_| relative(open, window.spent()));
        }
    }

    /// Warns of energy figures with a large error of the balance, and of efficiencies outside 0 to 1. `None` if there are none.
    pub fn warning(&self, quantities: &BTreeMap<String, Quantity>) -> Option<String> {
        let (mut all, mut fed) = (vec![], false);
        let times = [("over the run", self.run), ("in the window", self.window)];
        if let Some(q) = quantities.get(Interest::Efficiency.name()).filter(|_| self.turbines) {
            let figures = [(q.last, q.final_error), (q.window, q.window_error)];
            for ((value, error), (when, since)) in figures.into_iter().zip(times) {
                let (Some(value), Some(error)) = (value, error) else {
                    continue;
                };
                let mut faults = vec![];
                if !(-ROUND_OFF..=1.0 + ROUND_OFF).contains(&value) {
                    let gained = since.gained(&self.last);
                    let side = if value > 1.0 { "above one" } else { "below zero" };
                    faults.push(format!("{side}: {}", why(&gained)));
                    fed |= gained.fed();
                }
                if error > OPEN {
                    faults.push(format!("balance error {:.0} %", 100.0 * error));
                }
                if !faults.is_empty() {
                    let faults = faults.join(", ");
                    all.push(format!("efficiency {:.1} % {when} ({faults})", 100.0 * value));
                }
            }
        }
        for of in [Interest::InputEnergy, Interest::HarvestedEnergy] {
            let Some(q) = quantities.get(of.name()) else { continue };
            let figures = [(q.last, q.final_error), (q.window, q.window_error)];
            for ((value, error), (when, _)) in figures.into_iter().zip(times) {
                if let (Some(value), Some(error)) = (value, error)
                    && error > OPEN
                    && value.abs() > (REMAINDER * self.largest_stored).max(self.floor)
                {
                    all.push(format!(
                        "{} {} {when} (balance error {:.0} %)",
                        of.describe(),
                        quantity(value, "J", 4),
                        100.0 * error
                    ));
                }
            }
        }
        let more = all.len().saturating_sub(NAMED);
        all.truncate(NAMED);
        if more > 0 {
            all.push(format!("{more} more in summary.json"));
        }
        let action = match fed {
            true => {
                "The published coupling or formulation does not conserve energy. Use the reciprocal coupling and the \
                 conservative formulation, or reduce /solver/rtol"
            }
            false => "Reduce /solver/rtol, or extend the window",
        };
        (!all.is_empty()).then(|| Code::EnergyFigure.warning(format!("energy: {}. {action}.", all.join("; "))))
    }
}

/// Largest error over the window of the efficiency and the energies. Energies that are remainders relative to `largest` [J]
/// do not count.
pub fn open_over_window(quantities: &BTreeMap<String, Quantity>, largest: f64) -> Option<f64> {
    let all = [Interest::InputEnergy, Interest::HarvestedEnergy, Interest::Efficiency];
    let counts = |of: Interest, value: f64| of == Interest::Efficiency || value.abs() > REMAINDER * largest;
    let figures = all.into_iter().filter_map(|of| {
        let q = quantities.get(of.name())?;
        q.window_error
            .filter(|_| q.window.is_some_and(|value| counts(of, value)))
    });
    figures.reduce(f64::max)
}

/// True if a figure with this relative error needs a warning.
pub fn too_open(error: f64) -> bool {
    error > OPEN
}

/// Explains an efficiency outside 0 to 1.
fn why(gained: &Parts) -> String {
    if gained.fed() {
        return format!(
            "{} added to {} put in",
            quantity(gained.added, "J", 3),
            quantity(gained.input, "J", 3)
        );
    }
    if gained.stored < 0.0 {
        return format!("{} stored before was released", quantity(-gained.stored, "J", 3));
    }
    "integration error".into()
}

fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}
