//! A result folder as plain data.

use serde_json::Value;

use crate::run::summary::Summary;

/// One column of a history.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name without unit.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// One value an output time.
    pub values: Vec<f64>,
}

/// A field over time and place.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Name, unit included: `u1_m`.
    pub name: String,
    /// Positions.
    pub len: usize,
    /// Values, position by position, time after time.
    pub values: Vec<f64>,
}

impl Array {
    /// All positions at one instant.
    pub fn row(&self, instant: usize) -> &[f64] {
        &self.values[instant * self.len..][..self.len]
    }
}

/// Everything that a result folder holds.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Folder.
    pub label: String,
    /// `case.json`.
    pub case: Value,
    /// `summary.json`.
    pub summary: Summary,
    /// Times of the history [s].
    pub times: Vec<f64>,
    /// Columns of the history, time not among them.
    pub columns: Vec<Series>,
    /// Times of the fields [s].
    pub field_times: Vec<f64>,
    /// Coordinates by name.
    pub axes: Vec<(String, Vec<f64>)>,
    /// Fields.
    pub fields: Vec<Array>,
}

impl Recording {
    /// A column by name.
    pub fn column(&self, name: &str) -> Option<&Series> {
        self.columns.iter().find(|c| c.name == name)
    }

    /// A field by name.
    pub fn field(&self, name: &str) -> Option<&Array> {
        self.fields.iter().find(|f| f.name == name)
    }

    /// A coordinate by name.
    pub fn axis(&self, name: &str) -> Option<&[f64]> {
        self.axes.iter().find(|a| a.0 == name).map(|a| a.1.as_slice())
    }

    /// Length of the beam [m], to which positions along it refer.
    pub fn length(&self) -> f64 {
        self.case
            .pointer("/beam/length_m")
            .and_then(Value::as_f64)
            .unwrap_or(1.0)
    }
}
