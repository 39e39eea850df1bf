//! A result folder as plain data.

use serde::Deserialize;
use serde_json::Value;

use crate::case::schema::Thinning;
use crate::run::schedule::SAME;
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

/// What a result has to know of its case. That of another version may no longer be one as a whole.
#[derive(Clone, Debug, Deserialize)]
pub struct Known {
    beam: Long,
    bladders: Option<Long>,
    time: Times,
}

#[derive(Clone, Debug, Deserialize)]
struct Long {
    length_m: f64,
}

#[derive(Clone, Debug, Deserialize)]
struct Times {
    end_s: f64,
    window_s: Option<f64>,
    #[serde(default)]
    history: Thinning,
}

/// Everything that a result folder holds.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Folder.
    pub label: String,
    /// `case.json`.
    pub case: Value,
    /// What is known of it.
    pub known: Known,
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
    /// The window alone, where not all output times before it were written: nothing is interpolated over what is not there.
    pub fn without_gaps(mut self) -> Self {
        let time = &self.known.time;
        if time.history == Thinning::All {
            return self;
        }
        let begin = time.end_s - time.window_s.unwrap_or(0.0) * (1.0 + SAME);
        let before = |times: &[f64]| times.partition_point(|t| *t < begin);
        let rows = before(&self.times);
        self.times.drain(..rows);
        for column in &mut self.columns {
            column.values.drain(..rows);
        }
        let instants = before(&self.field_times);
        self.field_times.drain(..instants);
        for field in &mut self.fields {
            field.values.drain(..instants * field.len);
        }
        self
    }

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
        self.known.beam.length_m
    }

    /// Length of its bladders [m]; nothing in a dry beam.
    pub fn bladder_length(&self) -> Option<f64> {
        self.known.bladders.as_ref().map(|bladders| bladders.length_m)
    }
}
