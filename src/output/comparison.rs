//! The picture of a comparison, from two recordings.

use super::plot::Curve;
use super::plot::overlay::{self, Overlay, Pair};
use crate::discrete::quantities::{Observable, Role};
use crate::study::compare::interpolate::cubic;
use crate::study::compare::{Comparison, Recording};

/// Rows drawn of a history, at most.
const ROWS: usize = 1500;

/// The text of the picture; `None` when no quantity is in both.
pub fn picture(a: &Recording, b: &Recording, comparison: &Comparison) -> Option<String> {
    let headlines = Observable::ALL.iter().filter(|one| one.role() == Role::Headline);
    let pairs = headlines.filter_map(|one| {
        comparison.histories.iter().find(|d| d.name == one.name())?;
        pair(a, b, one.name())
    });
    overlay::draw(&Overlay {
        names: [a.label.clone(), b.label.clone()],
        pairs: pairs.collect(),
    })
}

fn pair(a: &Recording, b: &Recording, name: &str) -> Option<Pair> {
    let (of_a, of_b) = (a.column(name)?, b.column(name)?);
    let curve = |name: &str, points: Vec<(f64, f64)>| Curve {
        name: name.into(),
        unit: of_a.unit.clone(),
        points: points.iter().copied().step_by((points.len() / ROWS).max(1)).collect(),
    };
    let (first, last) = (b.times.first()?, b.times.last()?);
    let between = a
        .times
        .iter()
        .zip(&of_a.values)
        .filter(|(t, _)| (first..=last).contains(t));
    let difference = between.map(|(&t, x)| (t, x - cubic(&b.times, t).mean(|k| of_b.values[k])));
    let points = |times: &[f64], values: &[f64]| times.iter().copied().zip(values.iter().copied()).collect();
    Some(Pair {
        a: curve(name, points(&a.times, &of_a.values)),
        b: curve(name, points(&b.times, &of_b.values)),
        difference: curve("difference", difference.collect()),
    })
}
