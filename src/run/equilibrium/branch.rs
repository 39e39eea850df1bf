//! Transition from a path to another one that crosses it.

use super::path::{NEAR, PATIENCE, PathError, PathFollower, PathSoFar, difference};
use super::state::EquilibriumStability;
use super::{EquilibriumEvent, EventKind};
use crate::numerics::kernels;
use crate::sundials::KinsolError;

/// First step along the branch, in the norm of the path.
const ASIDE: f64 = 0.02;
/// Largest change of the load share in this step; needed if a moved end buckles the beam.
const SHARE: f64 = 0.02;
const INVERSE_ITERATIONS: usize = 12;

impl PathFollower<'_> {
    /// Leaves a path where another one crosses it, by a step in the direction of least stiffness, in which the matrix is nearly
    /// singular. The step is towards a positive sign of its largest displacement. If the other side has fewer unstable directions,
    /// the step is towards that side.
    pub(super) fn leave(
        &mut self,
        trail: &mut PathSoFar,
        beyond: (f64, Option<EquilibriumStability>),
    ) -> Result<f64, PathError> {
        let n = self.n;
        let last = trail.last.clone();
        let mut x = last.clone();
        self.solve(&mut x, PATIENCE)
            .map_err(|failure| self.fail(&failure, last[n]))?;
        let mut direction = self.softest();
        // the eigenvalue that changes sign is proportional to the distance
        let here = EquilibriumStability::assess(self.solver.dae_mut().statics(), last[n], &last[..n]);
        let share = last[n] + (beyond.0 - last[n]) * between(here, beyond.1);
        self.path.events.push(EquilibriumEvent {
            stage: self.stage,
            share,
            kind: EventKind::Bifurcation,
        });
        self.branch = self.path.states.len();
        self.bounds.push(self.branch);
        direction[n] = 0.0;
        let displacements = direction
            .iter()
            .zip(&self.weights)
            .filter(|(_, w)| **w > 0.0)
            .map(|(x, _)| *x);
        let largest = displacements.fold(0.0_f64, |m, x| if x.abs() > m.abs() { x } else { m });
        let unit = largest.signum() / self.norm(&direction).max(f64::MIN_POSITIVE);
        direction.iter_mut().for_each(|x| *x *= unit);
        let first = self.aside(&last, &direction);
        let ways = self.unstable(first.as_ref().ok());
        let taken = if ways == 0 {
            first
        } else {
            direction.iter_mut().for_each(|x| *x = -*x);
            let other = self.aside(&last, &direction);
            if self.unstable(other.as_ref().ok()) >= ways {
                direction.iter_mut().for_each(|x| *x = -*x);
            }
            // repeated, since the solver must keep the matrix of this side
            self.aside(&last, &direction)
        };
        let x = taken.map_err(|failure| {
            let none = || KinsolError::own("the crossing path was not found");
            self.fail(&failure.unwrap_or_else(none), share)
        })?;
        self.orientation = self.solver.determinant_sign();
        let taken = self.norm(&difference(&x, &last));
        *trail = PathSoFar::new(self, last, taken, x.clone());
        self.keep(&x)?;
        Ok(taken)
    }

    /// State of the crossing path, on one side of the state at which the current path is left.
    fn aside(&mut self, last: &[f64], direction: &[f64]) -> Result<Vec<f64>, Option<KinsolError>> {
        let n = self.n;
        let mut step = ASIDE;
        loop {
            let guess: Vec<f64> = last.iter().zip(direction).map(|(x, d)| x + step * d).collect();
            self.aim(last, &guess);
            let mut x = guess.clone();
            let solved = self.solve(&mut x, PATIENCE);
            let mut off = difference(&x, &guess);
            let share = off[n].abs();
            off[n] = 0.0;
            if solved.is_ok() && self.norm(&off) <= 0.5 * step && share <= SHARE.max(0.5 * step) {
                return Ok(x);
            }
            self.path.rejected += 1;
            step *= 0.5;
            if step < NEAR {
                return Err(solved.err());
            }
        }
    }

    /// Number of unstable directions of a state; `usize::MAX` if there is no state or its stability is unknown.
    fn unstable(&mut self, x: Option<&Vec<f64>>) -> usize {
        let n = self.n;
        let stability = x.and_then(|x| EquilibriumStability::assess(self.solver.dae_mut().statics(), x[n], &x[..n]));
        stability.map_or(usize::MAX, |s| s.unstable)
    }

    /// Vector that the last factored matrix shortens most (inverse iteration).
    fn softest(&mut self) -> Vec<f64> {
        let mut x: Vec<f64> = (0..=self.n).map(|k| (1.0 + k as f64).sin()).collect();
        for _ in 0..INVERSE_ITERATIONS {
            self.solver.apply_inverse(&mut x);
            let norm = kernels::dot(&x, &x).sqrt().max(f64::MIN_POSITIVE);
            x.iter_mut().for_each(|x| *x /= norm);
        }
        x
    }
}

/// Position of an eigenvalue's zero between two states, as a fraction of the distance; 0.5 if it is unknown.
fn between(before: Option<EquilibriumStability>, beyond: Option<EquilibriumStability>) -> f64 {
    let softest = |s: Option<EquilibriumStability>| s.and_then(|s| s.softest);
    let share = softest(before).zip(softest(beyond)).map(|(a, b)| a / (a - b));
    share.filter(|share| (0.0..=1.0).contains(share)).unwrap_or(0.5)
}
