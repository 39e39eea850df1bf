//! What steps make of their tolerance where they follow a motion.

use serde::{Deserialize, Serialize};

use crate::discrete::Layout;

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
    squares: [f64; 2],
}

impl Tolerance {
    /// Of a layout with scales across and along [m].
    pub fn new(rtol: f64, scales: [f64; 2], layout: &Layout) -> Self {
        let groups = [
            (layout.u1, layout.v1, layout.free_u1.len(), layout.waves[0]),
            (layout.u3, layout.v3, layout.free_u3.len(), layout.waves[1]),
        ];
        Self {
            rtol,
            scales,
            groups: groups.map(|(u, v, number, waves)| [(u, number), (v, if waves { number } else { 0 })]),
            ..Self::default()
        }
    }

    /// Takes a step's own estimates of its errors, of the scaled unknowns; none: as large as they may be.
    pub fn step(&mut self, errors: &[f64]) {
        self.steps += 1;
        for (sum, groups) in self.squares.iter_mut().zip(&self.groups) {
            let mean = |(first, number): &(usize, usize)| match errors.get(*first..first + number) {
                Some(part) => part.iter().map(|e| e * e).sum::<f64>() / (*number).max(1) as f64,
                None => self.rtol * self.rtol,
            };
            *sum += groups.iter().map(mean).fold(0.0, f64::max) / (self.rtol * self.rtol);
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
        let used = (self.squares[which] / (self.steps as f64).max(1.0)).sqrt();
        let beyond = self.scales[which] / size.max(f64::MIN_POSITIVE);
        (self.gathered() * (1.0 + used.min(1.0) * beyond)).min(1.0)
    }
}
