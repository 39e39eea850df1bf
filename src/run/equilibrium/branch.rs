//! From one path onto another that crosses it.

use super::path::{End, Follower, NEAR, PATIENCE, Way, difference};
use super::state::Stability;
use super::{Event, Kind};
use crate::numerics::kernels;
use crate::sundials::KinsolError;

/// First step along the branch, over its size.
const ASIDE: f64 = 0.02;
/// Share of the loads that this step may come to beside: an end that is moved buckles a beam by a hundredth of its depth.
const SHARE: f64 = 0.02;
const INVERSE_ITERATIONS: usize = 12;

impl Follower<'_> {
    /// Leaves a path where another one crosses it: a step along the direction that costs no force, which is where the
    /// matrix is nearly singular, to the side on which it bends (its largest displacement across, or else along) in the positive sense, or to
    /// the other one where only that holds.
    pub(super) fn leave(&mut self, trail: &mut Way, beyond: (f64, Option<Stability>)) -> Result<f64, End> {
        let n = self.n;
        let last = trail.last.clone();
        let mut x = last.clone();
        self.solve(&mut x, PATIENCE)
            .map_err(|failure| self.fail(&failure, last[n]))?;
        let mut direction = self.softest();
        // The eigenvalue that changes sign does so in proportion to the distance.
        let here = Stability::of(self.solver.dae_mut().statics(), last[n], &last[..n]);
        let share = last[n] + (beyond.0 - last[n]) * between(here, beyond.1);
        self.path.events.push(Event {
            stage: self.stage,
            share,
            kind: Kind::Bifurcation,
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
            // once more: the solver keeps the matrix of this side
            self.aside(&last, &direction)
        };
        let x = taken.map_err(|failure| {
            let none = || KinsolError::own("the path that crosses here is not found");
            self.fail(&failure.unwrap_or_else(none), share)
        })?;
        self.orientation = self.solver.determinant_sign();
        let taken = self.norm(&difference(&x, &last));
        *trail = Way::new(self, last, taken, x.clone());
        self.keep(&x)?;
        Ok(taken)
    }

    /// A state of the path that crosses, on one side of the state in which it is left.
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

    /// In how many ways a state gives way; more than any where it is none, or not known.
    fn unstable(&mut self, x: Option<&Vec<f64>>) -> usize {
        let n = self.n;
        let stability = x.and_then(|x| Stability::of(self.solver.dae_mut().statics(), x[n], &x[..n]));
        stability.map_or(usize::MAX, |s| s.unstable)
    }

    /// Vector that the matrix last factored makes shortest (inverse iteration).
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

/// Where between two states an eigenvalue is zero, a share of the distance; halfway when they do not tell.
fn between(before: Option<Stability>, beyond: Option<Stability>) -> f64 {
    let softest = |s: Option<Stability>| s.and_then(|s| s.softest);
    let share = softest(before).zip(softest(beyond)).map(|(a, b)| a / (a - b));
    share.filter(|share| (0.0..=1.0).contains(share)).unwrap_or(0.5)
}
