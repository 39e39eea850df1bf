//! One row of a history.

use serde::{Deserialize, Serialize};

use super::{Group, Observable, QuantitySource, StateView, probes, stations};
use crate::discrete::System;

/// Values of observables at one instant, followed by those of ports, accumulators, walls and reactions, and those of probes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ObservableRow {
    columns: Vec<Observable>,
    /// Number of values of ports, accumulators, walls and reactions.
    stations: usize,
    values: Vec<f64>,
}

impl ObservableRow {
    /// Creates a row of zeros for a system.
    pub fn from_system(system: &System) -> Self {
        let stations = stations::columns(system, false).len();
        Self::new(
            Observable::recorded(system),
            [stations, probes::columns(system).count()],
        )
    }

    /// Creates a row of zeros for columns and for the given numbers of values of stations and of probes.
    pub fn new(columns: Vec<Observable>, [stations, probes]: [usize; 2]) -> Self {
        let values = vec![0.0; columns.len() + stations + probes];
        Self {
            columns,
            stations,
            values,
        }
    }

    /// Evaluates a state at a time [s], with integrals up to that time and the residual of the energy balance [J].
    pub fn take(&mut self, t: f64, look: &StateView, integrals: &[f64], open: f64) {
        let (values, rest) = self.values.split_at_mut(self.columns.len());
        let (at_stations, at_probes) = rest.split_at_mut(self.stations);
        if !at_stations.is_empty() {
            stations::values(look, Some(integrals).filter(|all| !all.is_empty()), at_stations);
        }
        for (value, column) in values.iter_mut().zip(&self.columns) {
            *value = match column.read() {
                QuantitySource::Time => t,
                QuantitySource::State(read) => read(look),
                QuantitySource::Integral(of) => of(integrals),
                QuantitySource::Through(of) => of(look.system, integrals),
                QuantitySource::Open => open,
            };
        }
        for (value, read) in at_probes.iter_mut().zip(probes::values(look)) {
            *value = read;
        }
    }

    /// Values in the order of the columns, followed by those of stations and probes.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Values at ports, accumulators, walls and reactions.
    pub fn at_stations(&self) -> &[f64] {
        &self.values[self.columns.len()..][..self.stations]
    }

    /// Values at probes.
    pub fn at_probes(&self) -> &[f64] {
        &self.values[self.columns.len() + self.stations..]
    }

    /// Time [s].
    pub fn t(&self) -> f64 {
        self.get(Observable::Time).unwrap_or(0.0)
    }

    /// Value of a column, if it exists.
    pub fn get(&self, which: Observable) -> Option<f64> {
        let place = self.columns.iter().position(|column| *column == which)?;
        Some(self.values[place])
    }

    /// Sets the value of a column, if it exists.
    pub fn set(&mut self, which: Observable, value: f64) {
        if let Some(place) = self.columns.iter().position(|column| *column == which) {
            self.values[place] = value;
        }
    }

    /// Each observable with its value.
    pub fn each(&self) -> impl Iterator<Item = (Observable, f64)> {
        self.columns.iter().copied().zip(self.values.iter().copied())
    }

    /// Sum of the values of a group.
    pub fn sum(&self, group: Group) -> f64 {
        let own = self.each().filter(|(column, _)| column.group() == group);
        own.map(|(_, value)| value).sum()
    }
}
