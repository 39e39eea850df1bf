//! Nodes of a structure on a page: their beams, and their places in the straight structure.

use std::ops::Range;

use serde_json::{Value, json};

use super::{Place, base64};
use crate::discrete::System;
use crate::discrete::quantities::PlacedNodes;

/// Adds the places of chosen nodes of a structure. `starts` are the first of the chosen nodes of each part between joints.
pub fn add(page: &mut Value, placed: Option<&PlacedNodes>, chosen: &[usize]) {
    let Some(placed) = placed else { return };
    let starts: Vec<usize> = placed
        .parts()
        .iter()
        .filter_map(|part| chosen.iter().position(|node| part.contains(node)))
        .collect();
    let of = |value: &dyn Fn(usize) -> f64| base64::numbers(chosen.iter().map(|node| value(*node)));
    page["placed"] = json!({
        "starts": starts,
        "beam": chosen.iter().map(|node| placed.beam[*node]).collect::<Vec<_>>(),
        "theta": of(&|node| placed.theta[node]),
        "x": of(&|node| placed.rest[node].x),
        "z": of(&|node| placed.rest[node].z),
        "angle": of(&|node| placed.angle[node]),
    });
}

/// Ranges of the nodes `0..len` of each part between joints.
pub fn parts(len: usize, placed: Option<&PlacedNodes>) -> Vec<Range<usize>> {
    placed.map_or_else(|| std::iter::once(0..len).collect(), PlacedNodes::parts)
}

/// Nodes `0..len` at constant steps with both ends, about `most` of them; in a structure with both ends of each part.
pub fn thinned_nodes(len: usize, placed: Option<&PlacedNodes>, most: usize) -> Vec<usize> {
    let share = |part: usize| (most * part / len.max(1)).max(2);
    let each = parts(len, placed).into_iter().map(|part| {
        let own = super::frames::thinned(part.len(), share(part.len()));
        own.into_iter().map(move |k| part.start + k).collect::<Vec<_>>()
    });
    each.flatten().collect()
}

impl Place<'_> {
    /// Nodes of the case of the folder; none for a single beam, or if their number is another one.
    pub(super) fn placed(&self, nodes: usize) -> Option<PlacedNodes> {
        let case = self.case.as_ref().filter(|case| case.is_structure())?;
        let placed = PlacedNodes::new(&System::new(case).ok()?)?;
        (placed.beam.len() == nodes).then_some(placed)
    }
}
