//! Modes that change places between neighboring designs: the first mode of one is not the first mode of the other.
//!
//! Modes are numbered by their frequencies, the lowest first. If a fluid mode with so much damping that it hardly
//! oscillates appears below a mode of the beam, all following numbers refer to other modes. The modes of two designs
//! are paired by their eigenvalues:
//!
//! ```text
//! least over all pairings of   Σ |ln(s_k/s'_j)|
//! ```
//!
//! Small changes of a frequency or a damping ratio thus count little, whatever their sizes are.

use std::collections::BTreeMap;

use nalgebra::Complex;
use serde_json::Value;

use super::{SweepPlan, SweepRow};
use crate::run::summary::Status;
use crate::study::analysis::modes::MODES;

/// Least advantage of another pairing over that by numbers.
const BETTER: f64 = 0.2;
/// Largest number of designs compared.
pub const MOST: usize = 2000;

/// Modes of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignModes {
    number: usize,
    case: usize,
    values: Vec<Value>,
    /// Eigenvalues `s`, the lowest frequency first [1/s].
    s: Vec<Complex<f64>>,
}

impl DesignModes {
    /// Reads the modes of a row; `None` if it has none, as for other commands.
    pub fn from_row(row: &SweepRow) -> Option<Self> {
        let mode = |k: usize| {
            let figure = |name: &str| row.found.figure(&format!("mode_{k}.{name}"));
            let frequency = figure("frequency_hz")?;
            Some(Complex::new(figure("growth_per_s")?, std::f64::consts::TAU * frequency))
        };
        let s: Vec<_> = (1..=MODES).map_while(mode).collect();
        (row.found.status == Status::Finished && !s.is_empty()).then(|| Self {
            number: row.number,
            case: row.case,
            values: row.values.clone(),
            s,
        })
    }
}

/// Two neighboring designs in which modes have different numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Exchange {
    /// Numbers of the designs.
    pub designs: [usize; 2],
    /// Pointer of the number that differs between them.
    pub pointer: String,
    /// Values of that number.
    pub values: [f64; 2],
    /// Numbers, from 1, of one mode in both designs: the first mode with two numbers.
    pub modes: [usize; 2],
    /// Numbers, from 1, of all modes that have another number in the second design.
    pub all: Vec<usize>,
}

/// Finds exchanges between neighboring designs along each listed axis.
pub fn exchanges(plan: &SweepPlan, designs: &[DesignModes]) -> Vec<Exchange> {
    let mut all = vec![];
    for (axis, varied) in plan.axes.iter().enumerate().filter(|(k, _)| plan.listed(*k)) {
        let mut lines: BTreeMap<(usize, String), Vec<(f64, &DesignModes)>> = BTreeMap::new();
        for one in designs {
            let Some(value) = one.values.get(axis).and_then(Value::as_f64) else {
                continue;
            };
            let others: Vec<&Value> = one
                .values
                .iter()
                .enumerate()
                .filter(|(k, _)| *k != axis)
                .map(|(_, v)| v)
                .collect();
            let key = serde_json::to_string(&others).unwrap_or_default();
            lines.entry((one.case, key)).or_default().push((value, one));
        }
        for line in lines.values_mut() {
            line.sort_by(|a, b| a.0.total_cmp(&b.0));
            for pair in line.windows(2) {
                let [(from, a), (to, b)] = [pair[0], pair[1]];
                let moved = moved(&a.s, &b.s);
                if let Some(&first) = moved.first() {
                    all.push(Exchange {
                        designs: [a.number, b.number],
                        pointer: varied.pointer.clone(),
                        values: [from, to],
                        modes: first.map(|k| k + 1),
                        all: moved.iter().map(|[k, _]| k + 1).collect(),
                    });
                }
            }
        }
    }
    all
}

/// Index pairs of modes that have another index in the second list; empty if the pairing by numbers is as good as the
/// best.
fn moved(a: &[Complex<f64>], b: &[Complex<f64>]) -> Vec<[usize; 2]> {
    let count = a.len().min(b.len());
    let far = |k: usize, j: usize| (a[k] / b[j]).ln().norm();
    let by_number: f64 = (0..count).map(|k| far(k, k)).sum();
    let mut best = (by_number - BETTER, vec![]);
    let mut taken = vec![];
    search(count, &far, 0.0, &mut taken, &mut best);
    let found = best.1.into_iter().enumerate();
    found.map(|(k, j)| [k, j]).filter(|[k, j]| k != j).collect()
}

/// Searches all pairings that begin with `taken` for one that is better than the best so far.
fn search(
    count: usize,
    far: &dyn Fn(usize, usize) -> f64,
    so_far: f64,
    taken: &mut Vec<usize>,
    best: &mut (f64, Vec<usize>),
) {
    if so_far >= best.0 {
        return;
    }
    let k = taken.len();
    if k == count {
        *best = (so_far, taken.clone());
        return;
    }
    for j in 0..count {
        if !taken.contains(&j) {
            taken.push(j);
            search(count, far, so_far + far(k, j), taken, best);
            taken.pop();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn s(frequency: f64, ratio: f64) -> Complex<f64> {
        let size = frequency / (1.0 - ratio * ratio).sqrt();
        Complex::new(-ratio * size, frequency)
    }

    /// Source: the published beam, its valves varied. Goal: a fluid mode that appears below the modes of the beam moves
    /// them; a mode that changes with its design, even by much, does not.
    #[test]
    fn a_mode_that_comes_in_moves_the_others() {
        let before = [s(12.6, 0.03), s(78.0, 0.02), s(220.0, 0.01)];
        let after = [s(8.71, 0.999), s(12.587, 0.044), s(77.5, 0.02)];
        assert_eq!(moved(&before, &after), [[0, 1], [1, 2], [2, 0]]);
        assert_eq!(moved(&after, &before)[0], [0, 2]);
        let shorter = [s(50.4, 0.03), s(312.0, 0.02), s(880.0, 0.01)];
        assert!(moved(&before, &shorter).is_empty());
        assert!(moved(&before, &before[..1]).is_empty());
    }
}
