//! Changes of figures between two runs, and the integrator's own error.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::run::json_null;
use crate::run::summary::{Quantity, Summary};
use crate::study::significant::{RoundingScales, counted};

/// Figures of quantities that are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ComparedFigures {
    /// All figures.
    #[default]
    Figures,
    /// Only figures over the window: root mean squares and increments.
    WindowStatistics,
}

/// Relative changes by quantity.
pub type Changes = BTreeMap<String, f64>;

/// A quantity of the full model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelMeasure {
    /// Its name, unit included.
    pub name: String,
    /// Its largest figure, in its unit.
    #[serde(deserialize_with = "json_null::number")]
    pub size: f64,
    /// The integrator's own relative error; `None` if the run at a tenth of the tolerance did not finish.
    pub own: Option<f64>,
}

/// Quantities of the full model, and the figures by which runs are compared.
#[derive(Clone, Debug)]
pub struct Reference {
    quantities: BTreeMap<String, Quantity>,
    /// Figures that are compared.
    pub judged_by: ComparedFigures,
}

impl Reference {
    /// Collects the quantities of the full model that exceed rounding errors.
    pub fn new(full: &Summary, floors: &RoundingScales) -> Self {
        Self {
            quantities: counted(full, floors).map(|(name, q)| (name.clone(), *q)).collect(),
            judged_by: ComparedFigures::Figures,
        }
    }

    /// Returns the relative change of every quantity from one run to another.
    pub fn changes(&self, from: &Summary, to: &Summary) -> Changes {
        let judged = |q: &Quantity| match self.judged_by {
            ComparedFigures::Figures => q.figures().collect::<Vec<_>>(),
            ComparedFigures::WindowStatistics => q.statistics().collect(),
        };
        let figures = |run: &Summary, name: &str| run.quantities.get(name).map(judged).unwrap_or_default();
        let change = |(name, q): (&String, &Quantity)| {
            let (from, to) = (figures(from, name), figures(to, name));
            let at = |all: &[(&str, f64)], figure: &str| all.iter().find(|f| f.0 == figure).map_or(0.0, |f| f.1);
            let apart = judged(q)
                .into_iter()
                .map(|(figure, _)| (at(&from, figure) - at(&to, figure)).abs());
            let apart = apart.fold(0.0, f64::max);
            let relative = if apart > 0.0 { apart / q.size() } else { 0.0 };
            (name.clone(), relative)
        };
        self.quantities.iter().map(change).collect()
    }

    /// Returns the quantities with the integrator's own error.
    pub fn measures(&self, own: Option<&Changes>) -> Vec<ModelMeasure> {
        let measure = |(name, q): (&String, &Quantity)| ModelMeasure {
            name: name.clone(),
            size: q.size(),
            own: own.and_then(|own| own.get(name)).copied(),
        };
        self.quantities.iter().map(measure).collect()
    }
}

/// Size of changes relative to the tolerance and to the integrator's own error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Above the tolerance, and above the integrator's own error.
    Large,
    /// Above the tolerance, but the integrator's own error is, too.
    Hidden,
    /// Below the tolerance.
    Small,
}

/// Compares changes with a tolerance.
pub fn judge(changes: &Changes, measures: &[ModelMeasure], tolerance: f64) -> Size {
    let beyond: Vec<_> = measures
        .iter()
        .filter(|m| largest_change(changes, m) > tolerance)
        .collect();
    if beyond.iter().any(|m| largest_change(changes, m) > m.own.unwrap_or(0.0)) {
        Size::Large
    } else if !beyond.is_empty() {
        Size::Hidden
    } else {
        Size::Small
    }
}

/// Returns the quantity with the largest change. Changes above the integrator's own error have priority, unless that
/// error hides whether the tolerance is met.
pub fn largest<'a>(changes: &Changes, measures: &'a [ModelMeasure], tolerance: f64) -> Option<(&'a ModelMeasure, f64)> {
    let hidden = judge(changes, measures, tolerance) == Size::Hidden;
    let above = |m: &&ModelMeasure| !hidden && largest_change(changes, m) > m.own.unwrap_or(0.0);
    let most = |all: &mut dyn Iterator<Item = &'a ModelMeasure>| {
        all.max_by(|a, b| largest_change(changes, a).total_cmp(&largest_change(changes, b)))
            .map(|m| (m, largest_change(changes, m)))
    };
    most(&mut measures.iter().filter(above)).or_else(|| most(&mut measures.iter()))
}

fn largest_change(changes: &Changes, measure: &ModelMeasure) -> f64 {
    changes.get(&measure.name).copied().unwrap_or(1.0)
}
