//! What steps make of their tolerance where they follow a motion.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::discrete::Layout;
use crate::model::Scales;

/// What steps make of a tolerance of 1 in a motion that they follow, at least, and of its root at most: what is measured with stiff
/// and soft beams at tolerances from 1e-7 to 1e-2. Between the two it gathers like the root of their number.
const AT_LEAST: f64 = 2.0;
const AT_MOST: f64 = 0.05;

/// Follows how much of an absolute tolerance the steps use: it refers to what the case is expected to do, and where it does less
/// steps are mostly held by something else, so that what the tolerance allows says nothing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tolerance {
    rtol: f64,
    /// Steps taken.
    steps: u64,
    /// Sizes of displacements across and along to which it refers [m].
    scales: [f64; 2],
    /// First unknowns of displacement and of velocity, and their number; across, along.
    groups: [[(usize, usize); 2]; 2],
    /// Sums over steps of mean squares of their errors over the tolerance.
    squares: [[f64; 2]; 2],
    /// Size of velocities over that of displacements [1/s], and time gone [s]: a velocity's error needs time to become one of displacement.
    frequency: f64,
    /// See above.
    time: f64,
}

impl Tolerance {
    /// Of a layout of unknowns of these sizes.
    pub fn new(rtol: f64, scales: &Scales, layout: &Layout) -> Self {
        let group = |unknowns: &Range<usize>| (unknowns.start, unknowns.len());
        let groups = layout.lines.each_ref();
        Self {
            rtol,
            scales: [scales.transverse, scales.axial],
            frequency: scales.frequency,
            groups: groups.map(|line| [group(&line.u), line.v.as_ref().map_or((0, 0), group)]),
            ..Self::default()
        }
    }

    /// Takes the estimates that a step of a size [s] made of its errors, of the scaled unknowns; none: as large as they may be.
    pub fn step(&mut self, size: f64, errors: &[f64]) {
        self.steps += 1;
        self.time += size;
        let allowed = self.rtol * self.rtol;
        for (sums, groups) in self.squares.iter_mut().zip(&self.groups) {
            for (sum, &(first, number)) in sums.iter_mut().zip(groups) {
                *sum += match errors.get(first..first + number) {
                    Some(part) => part.iter().map(|e| e * e).sum::<f64>() / number.max(1) as f64 / allowed,
                    None => 1.0,
                };
            }
        }
    }

    /// What the steps make of their tolerance where they follow the motion, relative to what it refers to.
    pub fn gathered(&self) -> f64 {
        let more = self.rtol * (self.steps as f64).sqrt();
        more.min(AT_MOST * self.rtol.sqrt()).max(AT_LEAST * self.rtol)
    }

    /// Error by steps of a displacement of a size [m] across (0) or along (1), relative to it: of the relative tolerance, and as much of
    /// the absolute one as they used.
    pub fn of(&self, which: usize, size: f64) -> f64 {
        let [displacement, velocity] = self.squares[which].map(|sum| (sum / (self.steps as f64).max(1.0)).sqrt());
        let used = displacement.max(velocity * (self.frequency * self.time).min(1.0));
        let beyond = self.scales[which] / size.max(f64::MIN_POSITIVE);
        (self.gathered() * (1.0 + used.min(1.0) * beyond)).min(1.0)
    }
}
