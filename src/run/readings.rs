//! Readings of tip and probes within each step: values at its ends and at thirds, and the cubics through them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::cubic::{self, Cubic};
use super::ports::PortFigures;
use super::schedule::SAME;
use super::summary::Quantity;
use super::tracked_value::TrackedValue;
use crate::case::schema::Case;
use crate::discrete::ledger::StoredEnergies;
use crate::discrete::quantities::{Observable, ObservableRow, QuantitySource, StateView, probes};
use crate::discrete::{CompleteState, System, TimeData};

/// Quantities read at the tip.
const TIP: [Observable; 3] = [Observable::TipU1, Observable::TipU3, Observable::TipAngle];

/// Names of the read quantities, with units.
pub fn names(system: &System) -> Vec<String> {
    let tip = TIP.iter().map(|one| probes::key(one.name(), one.unit()));
    tip.chain(probes::columns(system).map(|one| probes::key(&one.name, one.unit)))
        .collect()
}

/// Readings of the current step.
#[derive(Clone, Debug, Default)]
pub struct StepReadings {
    follows: bool,
    /// Start and end of the step [s].
    span: [f64; 2],
    /// Values at its start, its thirds and its end.
    values: [Vec<f64>; 4],
}

impl StepReadings {
    /// Creates the readings of a case; nothing is read without probes and step responses.
    pub fn new(case: &Case, system: &System) -> Self {
        Self {
            follows: !system.probes.is_empty() || case.step_response.is_some(),
            ..Self::default()
        }
    }

    /// Times [s] within the step at which to read; empty if nothing is read.
    pub fn times(&self) -> impl Iterator<Item = f64> + use<> {
        let [from, to] = self.span;
        let inner = if self.follows && to > from { 1..3 } else { 0..0 };
        inner.map(move |k| from + f64::from(k) / 3.0 * (to - from))
    }

    /// Reads the end of a step at `t` [s], which is the start of the next step. `first` marks the start of a smooth interval.
    pub fn arrive(&mut self, t: f64, first: bool, system: &System, now: &TimeData, w: CompleteState) {
        if self.follows {
            self.span = [if first { t } else { self.span[1] }, t];
            self.values.swap(0, 3);
            read(system, now, w, &mut self.values[3]);
        }
    }

    /// Reads a state within the step, at the first or the second of [`Readings::times`].
    pub fn within(&mut self, second: bool, system: &System, now: &TimeData, w: CompleteState) {
        read(system, now, w, &mut self.values[1 + usize::from(second)]);
    }

    /// Start and end of the step [s], and the cubics over it.
    pub fn step(&self) -> ([f64; 2], impl Iterator<Item = Cubic>) {
        let [a, b, c, d] = &self.values;
        let all = a.iter().zip(b).zip(c).zip(d);
        (self.span, all.map(|(((a, b), c), d)| Cubic::through([*a, *b, *c, *d])))
    }
}

fn read(system: &System, now: &TimeData, w: CompleteState, out: &mut Vec<f64>) {
    let look = StateView::new(system, now, w, StoredEnergies::default());
    out.clear();
    out.extend(TIP.iter().filter_map(|one| match one.read() {
        QuantitySource::State(read) => Some(read(&look)),
        _ => None,
    }));
    out.extend(probes::values(&look));
}

/// Figures of the quantities recorded at probes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ProbeFigures {
    names: Vec<String>,
    window_start: f64,
    /// Time in the window over which squares have been integrated [s].
    window_time: f64,
    tracks: Vec<TrackedValue>,
    /// Figures of ports and accumulators.
    #[serde(default, skip_serializing_if = "PortFigures::is_empty")]
    pub ports: PortFigures,
}

impl ProbeFigures {
    /// Creates the figures of a case and its system.
    pub fn new(case: &Case, system: &System) -> Self {
        let names: Vec<String> = probes::columns(system)
            .map(|one| probes::key(&one.name, one.unit))
            .collect();
        Self {
            tracks: vec![TrackedValue::default(); names.len()],
            names,
            window_start: case.time.end_s - case.time.window() * (1.0 + SAME),
            window_time: 0.0,
            ports: PortFigures::new(system),
        }
    }

    /// Adds a sample.
    pub fn take(&mut self, t: f64, row: &ObservableRow) {
        let in_window = t >= self.window_start;
        self.ports.take(t, row.at_stations(), in_window);
        for (track, value) in self.tracks.iter_mut().zip(row.at_probes()) {
            track.take(*value, in_window);
            track.see(*value, t, in_window);
        }
    }

    /// Adds a step: its ends, the extrema between, and the part that lies in the window.
    pub fn step(&mut self, readings: &StepReadings) {
        if self.tracks.is_empty() {
            return;
        }
        let ([begin, end], cubics) = readings.step();
        let h = end - begin;
        let from = ((self.window_start - begin) / h).clamp(0.0, 1.0);
        self.window_time += h * (1.0 - from);
        for (track, cubic) in self.tracks.iter_mut().zip(cubics.skip(TIP.len())) {
            for x in [0.0, 1.0].into_iter().chain(cubic.turns()) {
                let t = begin + x * h;
                track.see(cubic.at(x), t, t >= self.window_start);
            }
            if from < 1.0 {
                track.square(h * cubic::integral(from, |x| cubic.at(x).powi(2)));
            }
        }
    }

    /// Times after `after` [s] at which largest values were reached.
    pub fn reached(&self, after: f64) -> impl Iterator<Item = f64> {
        self.tracks.iter().flat_map(move |track| track.reached(after))
    }

    /// The figures by name.
    pub fn quantities(&self) -> BTreeMap<String, Quantity> {
        let of = |(name, track): (&String, &TrackedValue)| {
            let reached = self.window_time > 0.0 || track.in_window();
            (name.clone(), track.swing(reached, self.window_time))
        };
        self.names.iter().zip(&self.tracks).map(of).collect()
    }
}
