//! Motion without inertia to the next equilibrium, where walls turn the path too sharply to be followed.

use super::path::{self, NextAction, PATIENCE, PathError, PathFollower, PathSoFar, difference};
use crate::discrete::contact_points;
use crate::sundials::KinsolError;

/// First resistance [1/s^2], and its factors after a failed and after a successful step.
const FIRST: f64 = 1e4;
const HARDER: f64 = 10.0;
const SOFTER: f64 = 0.25;
/// Number of Newton steps up to which the resistance falls faster.
const EASY: u64 = 5;
/// Largest motion of a step, in beam lengths.
const LONGEST: f64 = 0.03;
/// Motion of a step below which the beam counts as nearly at rest.
const SLOW: f64 = 1e-4;
/// Largest number of steps of a motion.
const MOST: usize = 600;
/// Fractions of the requested share by which the load increases, largest first.
const SHARES: [f64; 3] = [1.0 / 16.0, 1.0 / 128.0, 1.0 / 1024.0];

impl PathFollower<'_> {
    /// True if the beam can touch an obstacle.
    fn has_walls(&mut self) -> bool {
        !self.solver.dae_mut().statics().system().touching.is_empty()
    }

    /// True if the beam may pass over a circle between two points.
    pub(super) fn may_pass_over(&mut self, last: &[f64], next: &[f64]) -> bool {
        let n = self.n;
        let statics = self.solver.dae_mut().statics();
        let mut contacts = statics.system().model.contacts.iter();
        if contacts.all(|law| law.bend_radius().is_none()) {
            return false;
        }
        let rates = vec![0.0; n];
        let [from, to] = [last, next].map(|x| {
            let (_, _, w) = statics.beam().evaluate(x[n], &x[..n], &rates);
            w.motion.u.clone()
        });
        contact_points::may_pass_over(statics.system(), &from, &to)
    }

    /// Moves to rest at a fixed share of the loads, against a resistance that falls as the motion slows down:
    ///
    /// ```text
    /// F(s, y) + ρ D (y - y_before) = 0        ρ -> 0
    /// ```
    pub(super) fn move_to_rest(&mut self, x: &mut Vec<f64>, share: f64) -> Result<(), KinsolError> {
        let n = self.n;
        self.solver.dae_mut().at_share(share);
        x[n] = share;
        let mut rho = FIRST;
        let mut failure = KinsolError::own("the beam does not come to rest");
        for _ in 0..MOST {
            self.solver.dae_mut().statics().resist(rho, &x[..n]);
            let mut next = x.clone();
            let solved = self.solve(&mut next, PATIENCE);
            self.solver.dae_mut().statics().resist(0.0, &[]);
            let moved = self.norm(&difference(&next, x));
            let iterations = match solved {
                Ok(iterations) if moved <= LONGEST && !self.may_pass_over(x, &next) => iterations,
                other => {
                    failure = other.err().unwrap_or(failure);
                    rho *= HARDER;
                    if !rho.is_finite() {
                        return Err(failure);
                    }
                    continue;
                }
            };
            *x = next;
            if moved < SLOW {
                let mut next = x.clone();
                let solved = self.solve(&mut next, PATIENCE);
                if solved.is_ok() && self.norm(&difference(&next, x)) <= LONGEST {
                    *x = next;
                    return Ok(());
                }
            }
            rho *= if iterations <= EASY { SOFTER * SOFTER } else { SOFTER };
        }
        Err(failure)
    }

    /// Finds the first state of a stage after Newton's method alone failed with `failure`.
    pub(super) fn first(&mut self, mut x: Vec<f64>, failure: KinsolError) -> Result<Vec<f64>, KinsolError> {
        if !self.has_walls() {
            return Err(failure);
        }
        self.move_to_rest(&mut x, 0.0).map(|()| x)
    }

    /// Continues where the path cannot be followed: the beam moves to equilibrium at a larger share of the loads. `lost` is the error.
    pub(super) fn go_around(&mut self, way: &mut PathSoFar, lost: PathError) -> Result<NextAction, PathError> {
        if lost.0.cause.is_none() || !self.has_walls() {
            return Err(lost);
        }
        let (n, target) = (self.n, self.options.share);
        let left = target - way.last[n];
        for part in SHARES {
            let by = left.signum() * left.abs().min(part * target.abs());
            let share = if by == left { target } else { way.last[n] + by };
            let mut x = way.last.clone();
            if self.move_to_rest(&mut x, share).is_err() {
                continue;
            }
            self.orientation = self.solver.determinant_sign() * left.signum() as i8;
            self.branch = self.path.states.len();
            self.bounds.push(self.branch);
            self.keep(&x)?;
            if share == target {
                return Ok(NextAction::Arrived);
            }
            let (next, step) = self.set_out(x, by, path::LONGEST);
            *way = next;
            return Ok(NextAction::Step(step));
        }
        Err(lost)
    }
}
