//! Fields of a run at selected instants and places, limited to the size of a page.

use std::io;
use std::path::Path;

use serde_json::{Value, json};

use super::base64;
use super::placed::{self, thinned_nodes};
use crate::discrete::quantities::{BeamField, PlacedNodes};
use crate::output::arrays::TIMES;
use crate::output::folder::damaged;
use crate::output::npz::Npz;
use crate::output::numbers::counted;
use crate::output::plot;

/// Largest number of values in all frames; each has four bytes, and a third more as text.
const MOST_NUMBERS: usize = 420_000;
/// Largest number of frames: a minute of animation.
const MOST_FRAMES: usize = 1500;
/// Largest number of nodes of a frame.
const MOST_NODES: usize = 401;
/// Largest number of pressures of a frame; if there are more, one per bladder.
const MOST_PRESSURES: usize = 400;
/// Number of curves of the last cycle.
const CURVES: usize = 24;

/// Data of animation, profiles and maps. `frequency` is that of the drive [Hz].
///
/// # Errors
///
/// The file cannot be read as arrays.
pub fn read(path: &Path, frequency: Option<f64>) -> io::Result<Value> {
    let mut npz = Npz::open(path)?;
    let mut axis = |name: &str| npz.entry(name).is_some().then(|| npz.read(name)).transpose();
    let mut axis = |name: &str| axis(name).map(Option::unwrap_or_default);
    let (times, theta, bladder) = (axis(TIMES)?, axis("theta_node_m")?, axis("bladder")?);
    let (x_f, array) = (axis("x_f")?, axis("array")?);
    if times.is_empty() || theta.is_empty() {
        return Ok(Value::Null);
    }
    let placed = PlacedNodes::from_axes(|one| axis(one.name()).ok());
    let nodes = thinned_nodes(theta.len(), placed.as_ref(), MOST_NODES);
    let groups = pressure_groups(&bladder);
    let a_frame = 4 * nodes.len() + groups.len();
    let most = (MOST_NUMBERS / a_frame).clamp(2, MOST_FRAMES);
    let chosen = thinned(times.len(), most);
    let kept: Vec<f64> = chosen.iter().map(|&k| times[k]).collect();
    let alone: Vec<Vec<usize>> = nodes.iter().map(|&k| vec![k]).collect();
    // cells on both sides of each node
    let parts = placed::parts(theta.len(), placed.as_ref());
    let beside: Vec<Vec<usize>> = (nodes.iter())
        .map(|&k| {
            let before = parts.partition_point(|part| part.end <= k);
            // no cell lies between two parts
            let (first, last) = (
                parts[before].start - before,
                (parts[before].end - before).saturating_sub(2),
            );
            let cell = k - before;
            vec![cell.saturating_sub(1).clamp(first, last.max(first)), cell.min(last)]
        })
        .collect();
    let mut field = |name: &str, groups: &[Vec<usize>]| -> io::Result<Value> {
        let Some(entry) = npz.entry(name) else {
            return Ok(Value::Null);
        };
        if entry.rows() != times.len() {
            let why = format!(
                "{name} has {}, {TIMES} has {}",
                counted(entry.rows() as u64, "instant"),
                times.len()
            );
            return Err(damaged(why));
        }
        let mut means = Vec::with_capacity(chosen.len() * groups.len());
        npz.chosen(name, &chosen, &mut |row| {
            means.extend(groups.iter().map(|g| mean(g, row)))
        })?
        .finish()?;
        Ok(base64::numbers(means))
    };
    let (span, cycle) = plot::instants(&kept, frequency, CURVES);
    let first = |values: &[f64]| base64::numbers(groups.iter().map(|g| mean(g, values)));
    let mut page = json!({
        "times": base64::numbers(kept.iter().copied()),
        "recorded": times.len(),
        "theta": base64::numbers(nodes.iter().map(|&k| theta[k])),
        "nodes_recorded": theta.len(),
        "cycle": cycle,
        "whole": span == plot::TimeSpan::WholeRun,
        "frequency_hz": frequency,
        "u1": field("u1_m", &alone)?,
        "u3": field("u3_m", &alone)?,
        "curvature": field("curvature_1_m", &alone)?,
        "angle": field(BeamField::SectionAngle.name(), &beside)?,
        "pressure": field("pressure_pa", &groups)?,
        "x_f": first(&x_f),
        "bladder": first(&bladder),
        "array": first(&array),
    });
    placed::add(&mut page, placed.as_ref(), &nodes);
    Ok(page)
}

/// Indices `0..len` at constant steps, with the first and the last.
pub fn thinned(len: usize, most: usize) -> Vec<usize> {
    let step = (len.saturating_sub(1)).div_ceil(most.max(2) - 1).max(1);
    let mut all: Vec<usize> = (0..len).step_by(step).collect();
    if all.last() != Some(&(len - 1)) {
        all.push(len - 1);
    }
    all
}

/// Cells along `X_f`: single, or grouped by bladder if there are many.
fn pressure_groups(bladder: &[f64]) -> Vec<Vec<usize>> {
    if bladder.len() <= MOST_PRESSURES {
        return (0..bladder.len()).map(|k| vec![k]).collect();
    }
    let mut groups: Vec<Vec<usize>> = vec![];
    for k in 0..bladder.len() {
        match groups.last_mut() {
            Some(group) if bladder[group[0]] == bladder[k] => group.push(k),
            _ => groups.push(vec![k]),
        }
    }
    groups
}

fn mean(group: &[usize], values: &[f64]) -> f64 {
    let sum: f64 = group.iter().map(|&k| values.get(k).copied().unwrap_or(f64::NAN)).sum();
    sum / group.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_both_ends_and_its_bound() {
        assert_eq!(thinned(5, 10), [0, 1, 2, 3, 4]);
        assert_eq!(thinned(1, 10), [0]);
        for (len, most) in [(1001, 100), (100_000, 1500), (12, 11), (7, 2)] {
            let kept = thinned(len, most);
            assert_eq!((kept[0], kept[kept.len() - 1]), (0, len - 1));
            assert!(kept.len() <= most + 1, "{len} to {}", kept.len());
        }
    }
}
