//! Signals compared between runs, and a recorder that stores only these.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::discrete::quantities::{BeamField, Interest, Observable, QuantityRole};
use crate::error::Result;
use crate::run::ports;
use crate::run::record::{Control, Header, Progress, Recorder};
use crate::run::summary::Summary;

/// Compared columns of the history.
fn histories() -> impl Iterator<Item = Observable> {
    Observable::ALL
        .iter()
        .copied()
        .filter(|one| one.role() >= QuantityRole::Studied)
}

/// Compared fields, at the nodes between segments, which all meshes share.
fn fields() -> impl Iterator<Item = BeamField> {
    BeamField::ALL
        .into_iter()
        .filter(|one| one.role() >= QuantityRole::Studied)
}

/// True if a case may have a signal of this name. Names of summary figures, `quantity.figure`, always pass: they are
/// unknown before a run.
pub fn possible(name: &str) -> bool {
    name.contains('.') || histories().any(|one| one.name() == name) || fields().any(|one| one.name() == name)
}

/// Names of histories and fields.
pub fn names() -> String {
    let all = histories().map(Observable::name).chain(fields().map(BeamField::name));
    all.collect::<Vec<_>>().join(", ")
}

/// Kind of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SignalKind {
    /// One number per output time.
    History,
    /// Numbers at the nodes between segments, one output time after another.
    Field,
    /// One number per run.
    Quantity,
}

/// Vector by which runs are compared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparedSignal {
    /// Column, field or quantity: `tip_u1`, `v1_m_s`, `tip_u1_m.max_abs`.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Kind of the signal.
    pub kind: SignalKind,
    /// Values.
    pub values: Vec<f64>,
    /// Size to which errors refer, if it is not the signal's own; a final value may be zero.
    pub scale: Option<f64>,
}

/// Limit at which a run is stopped.
#[derive(Clone, Copy, Debug)]
pub enum StopLimit {
    /// Wall-clock time.
    Wall(Instant),
    /// Number of steps.
    Steps(u64),
}

/// Reason of a run that was stopped at its limit.
pub const TOO_SLOW: &str = "too slow";

/// Steps between two checks of the clock.
const LOOK: u64 = 64;

/// Recorder of the compared signals.
#[derive(Debug)]
pub struct SignalRecorder {
    limit: StopLimit,
    stride: usize,
    columns: Vec<(usize, ComparedSignal)>,
    fields: Vec<(usize, ComparedSignal)>,
}

impl SignalRecorder {
    /// Creates a recorder for a mesh of `cells` beam cells per segment.
    pub fn new(cells: usize, limit: StopLimit) -> Self {
        Self {
            limit,
            stride: cells,
            columns: vec![],
            fields: vec![],
        }
    }

    /// Returns all signals after the run.
    pub fn signals(self, summary: &Summary) -> Vec<ComparedSignal> {
        let kept = self.columns.into_iter().chain(self.fields).map(|(_, signal)| signal);
        kept.chain(quantities(summary)).collect()
    }
}

fn quantities(summary: &Summary) -> Vec<ComparedSignal> {
    let mut all = vec![];
    let of_ports = summary.ports.iter().map(|(name, q)| (name, q, ports::unit(name)));
    let own = summary.quantities.iter();
    let own = own.map(|(name, q)| (name, q, Interest::named(name).map_or("1", Interest::unit)));
    for (name, q, unit) in own.chain(of_ports) {
        let scale = q.size();
        all.extend(q.figures().map(|(figure, value)| ComparedSignal {
            name: format!("{name}.{figure}"),
            unit: unit.into(),
            kind: SignalKind::Quantity,
            values: vec![value],
            scale: Some(scale),
        }));
    }
    all
}

fn empty(name: &str, unit: &str, kind: SignalKind) -> ComparedSignal {
    ComparedSignal {
        name: name.into(),
        unit: unit.into(),
        kind,
        values: vec![],
        scale: None,
    }
}

impl Recorder for SignalRecorder {
    fn begin(&mut self, header: &Header) -> Result<()> {
        let wanted = header
            .columns
            .iter()
            .enumerate()
            .filter(|(_, c)| histories().any(|one| one.name() == c.name));
        self.columns = wanted
            .map(|(k, c)| (k, empty(&c.name, c.unit, SignalKind::History)))
            .collect();
        let wanted = header
            .fields
            .iter()
            .enumerate()
            .filter(|(_, f)| fields().any(|one| one.name() == f.name));
        self.fields = wanted
            .map(|(k, f)| (k, empty(f.name, f.unit, SignalKind::Field)))
            .collect();
        Ok(())
    }

    fn history(&mut self, row: &[f64]) -> Result<()> {
        for (k, signal) in &mut self.columns {
            signal.values.push(row[*k]);
        }
        Ok(())
    }

    fn fields(&mut self, _: f64, arrays: &[&[f64]]) -> Result<()> {
        for (k, signal) in &mut self.fields {
            signal.values.extend(arrays[*k].iter().step_by(self.stride));
        }
        Ok(())
    }

    fn progress(&mut self, progress: &Progress) -> Result<Control> {
        let over = match self.limit {
            StopLimit::Steps(most) => progress.steps >= most && progress.t < progress.end,
            StopLimit::Wall(end) => progress.steps.is_multiple_of(LOOK) && Instant::now() >= end,
        };
        Ok(if over {
            Control::Stop(format!(
                "{TOO_SLOW}: {:.3} % of the simulated time",
                100.0 * progress.t / progress.end
            ))
        } else {
            Control::Continue
        })
    }
}
