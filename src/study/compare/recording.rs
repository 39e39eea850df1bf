//! A result folder as plain data.

use serde::Deserialize;
use serde_json::Value;

use crate::case::schema::Thinning;
use crate::case::wiring::BladderLabels;
use crate::run::schedule::SAME;
use crate::run::summary::Summary;

/// One column of a history.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name without unit.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// One value per output time.
    pub values: Vec<f64>,
}

/// Field over time and position.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Name, unit included: `u1_m`.
    pub name: String,
    /// Number of positions.
    pub len: usize,
    /// Values: all positions of an instant, one instant after another.
    pub values: Vec<f64>,
}

impl Array {
    /// All positions at one instant.
    pub fn row(&self, instant: usize) -> &[f64] {
        &self.values[instant * self.len..][..self.len]
    }
}

/// Properties of the case that a comparison needs. A case of another version may not be readable as a whole.
#[derive(Clone, Debug, Deserialize)]
pub struct ComparedCase {
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

/// Contents of a result folder.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Folder.
    pub label: String,
    /// `case.json`.
    pub case: Value,
    /// Properties read from the case.
    pub known: ComparedCase,
    /// `summary.json`.
    pub summary: Summary,
    /// Times of the history [s].
    pub times: Vec<f64>,
    /// Columns of the history, without time.
    pub columns: Vec<Series>,
    /// Times of the fields [s].
    pub field_times: Vec<f64>,
    /// Coordinates by name.
    pub axes: Vec<(String, Vec<f64>)>,
    /// Fields.
    pub fields: Vec<Array>,
}

impl Recording {
    /// Removes the data before the window if their output was thinned: values are not interpolated across gaps.
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

    /// Length of the beam [m], the reference of positions along it.
    pub fn length(&self) -> f64 {
        self.known.beam.length_m
    }

    /// Labels of beams and bladders.
    pub fn labels(&self) -> BladderLabels {
        let beams = self.case["beams"].as_array().into_iter().flatten();
        let beam = |beam: &Value| {
            let name = beam["name"].as_str().unwrap_or_default().to_owned();
            (name, beam["segments"].as_u64().unwrap_or(1) as usize)
        };
        let per_row = self.case["bladders"]["per_row"].as_u64().unwrap_or(0) as usize;
        BladderLabels::new(per_row, beams.map(beam))
    }

    /// Length of the bladders [m]; `None` for a dry beam.
    pub fn bladder_length(&self) -> Option<f64> {
        self.known.bladders.as_ref().map(|bladders| bladders.length_m)
    }
}
