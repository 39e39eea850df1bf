//! Figures of ports and accumulators: flows and pressures at the output times.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::summary::Quantity;
use super::tracked_value::TrackedValue;
use crate::case::readable::key_unit;
use crate::discrete::System;
use crate::discrete::quantities::stations;

/// Figures of the flow and pressure of every port, of the pressure in every accumulator, and of the output of every controller, by column of
/// the history.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PortFigures {
    names: Vec<String>,
    /// Indices among the columns of ports, accumulators and walls.
    places: Vec<usize>,
    tracks: Vec<TrackedValue>,
    /// Time [s] and values of the last sample.
    last: Option<(f64, Vec<f64>)>,
    /// Time in the window over which squares have been integrated [s].
    window_time: f64,
}

/// Unit of a figure, by its name.
pub fn unit(name: &str) -> &'static str {
    match name {
        output if output.starts_with("controller_") => key_unit(output).map_or("1", |(_, unit)| unit),
        pressure if pressure.ends_with("_pa") => "Pa",
        _ => "m^3/s",
    }
}

impl PortFigures {
    /// Creates the figures of a system.
    pub fn new(system: &System) -> Self {
        let (places, names): (Vec<usize>, Vec<String>) =
            stations::of_fluid(system).chain(stations::of_outputs(system)).unzip();
        Self {
            tracks: vec![TrackedValue::default(); names.len()],
            names,
            places,
            ..Self::default()
        }
    }

    /// True if there is neither a port nor an accumulator.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Adds a sample of all columns of ports, accumulators and walls.
    pub fn take(&mut self, t: f64, columns: &[f64], in_window: bool) {
        if self.is_empty() {
            return;
        }
        let values: Vec<f64> = self
            .places
            .iter()
            .map(|&place| columns.get(place).copied().unwrap_or(0.0))
            .collect();
        let before = self.last.take().filter(|_| in_window);
        self.window_time += before.as_ref().map_or(0.0, |(from, _)| t - from);
        for (k, (track, &value)) in self.tracks.iter_mut().zip(&values).enumerate() {
            track.take(value, in_window);
            track.see(value, t, in_window);
            if let Some((from, earlier)) = &before {
                let (a, b) = (earlier[k], value);
                track.square((t - from) / 3.0 * (a * a + a * b + b * b));
            }
        }
        self.last = Some((t, values));
    }

    /// The figures by name.
    pub fn quantities(&self) -> BTreeMap<String, Quantity> {
        let of =
            |(name, track): (&String, &TrackedValue)| (name.clone(), track.swing(track.in_window(), self.window_time));
        self.names.iter().zip(&self.tracks).map(of).collect()
    }
}
