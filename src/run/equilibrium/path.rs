//! Follower of a path of equilibria.

use super::arclength::Arclength;
use super::faults::stopped;
use super::path_coordinates::PathCoordinates;
use super::predictor::RecentPoints;
use super::state::{self, EquilibriumStability, EquilibriumState};
use super::{EquilibriumEvent, EquilibriumOptions, EventKind, Path};
use crate::discrete::System;
use crate::discrete::extrema::MonitoredQuantity;
use crate::error::SolverError;
use crate::model::network::AccumulatorLaw;
use crate::run::range::Limits;
use crate::run::record::Control;
use crate::sundials::{Kinsol, KinsolError, KinsolOptions};

/// Longest step, in beam lengths and shares of the load.
pub(super) const LONGEST: f64 = 0.5;
/// Shortest step that is tried.
const SHORTEST: f64 = 1e-7;
/// Largest distance of a solution from its prediction, in steps. Farther away it may be on another path.
const ASTRAY: f64 = 0.2;
/// Distance of a solution from its prediction for which steps are chosen, in steps.
const WANTED: f64 = 0.05;
/// Displacements, in beam lengths, that count as motion. If a beam moves little while its loads grow, the load dominates the length
/// of a step, and the distance to a neighboring path is a small part of it. The distance from the prediction is therefore also
/// checked for displacements alone.
const MOTION: f64 = 1e-5;
/// Fraction of a step below which the direction that was found replaces the predicted one.
const TURN: f64 = 0.02;
/// Number of Newton steps for which steps are chosen, and largest growth of a step.
const WANTED_ITERATIONS: f64 = 12.0;
const GROWTH: f64 = 2.5;
/// Distance to a crossing path at which it is entered.
pub(super) const NEAR: f64 = 1e-4;
/// Longest step across a limit point: a load just below it is not passed over.
const ACROSS: f64 = 1e-4;
/// Number of Newton steps after which a prediction is rejected.
pub(super) const PATIENCE: u32 = 14;
/// Number of Newton steps after which the first solution of a stage fails.
const START_PATIENCE: u32 = 60;
/// Largest number of points; a path with more of them is lost.
const MOST_POINTS: usize = 5000;
/// Largest share; a path beyond it is lost.
const FURTHEST: f64 = 100.0;

/// Squared weight of each unknown and of the share in the length of a step: root mean square of displacements in beam lengths, and volumes
/// of vessels that may snap, in ranges of their curves.
pub(super) fn weights(system: &System) -> Vec<f64> {
    let l = &system.layout;
    let mut weights = vec![0.0; l.len + 1];
    for unknown in l.lines.iter().flat_map(|line| line.u.clone()) {
        weights[unknown] = (l.scales[unknown] / system.model.length).powi(2) / system.mesh.nodes as f64;
    }
    for one in system.fluid.iter().flat_map(|fluid| &fluid.accumulators) {
        if let AccumulatorLaw::Curve(curve) = &one.law {
            let unknown = l.network.junction.start + one.junction;
            weights[unknown] = (l.scales[unknown] / curve.range()).powi(2);
        }
    }
    weights[l.len] = 1.0;
    weights
}

/// Error that ends a path early.
pub(super) struct PathError(pub SolverError);

/// Action after a step.
pub(super) enum NextAction {
    /// Another step of this length.
    Step(f64),
    /// Another path crosses before this share, at which the state has this stability.
    Branch(f64, Option<EquilibriumStability>),
    /// The end of the stage.
    Arrived,
}

pub(super) struct PathFollower<'a> {
    /// Stage of the path, from 0.
    pub(super) stage: usize,
    /// Sign of the determinant of the equations. It changes where another path crosses, but not at a limit point.
    pub(super) orientation: i8,
    /// Index of the state with which the present branch begins.
    pub(super) branch: usize,
    pub(super) natural: PathCoordinates,
    /// Indices of states where stability may change: after a limit point, on a new branch.
    pub(super) bounds: Vec<usize>,
    pub(super) solver: Kinsol<Arclength>,
    pub(super) weights: Vec<f64>,
    pub(super) n: usize,
    pub(super) options: EquilibriumOptions,
    pub(super) limits: Limits,
    pub(super) path: &'a mut Path,
    pub(super) watch: &'a mut dyn FnMut(&EquilibriumState) -> Control,
}

/// The path so far: its last points in natural coordinates, the last one also in unknowns.
pub(super) struct PathSoFar {
    natural: RecentPoints,
    /// The last point.
    pub last: Vec<f64>,
}

impl PathSoFar {
    /// Creates the path of two points at a distance.
    pub fn new(follower: &mut PathFollower, before: Vec<f64>, distance: f64, last: Vec<f64>) -> Self {
        let statics = follower.solver.dae_mut().statics();
        let first = follower.natural.of_unknowns(statics, &before, None);
        let second = follower.natural.of_unknowns(statics, &last, Some(&first));
        Self {
            natural: RecentPoints::through(first, distance, second),
            last,
        }
    }

    fn push(&mut self, follower: &mut PathFollower, distance: f64, x: Vec<f64>) {
        let statics = follower.solver.dae_mut().statics();
        let z = follower.natural.of_unknowns(statics, &x, Some(self.natural.last()));
        self.natural.push(distance, z);
        self.last = x;
    }
}

impl PathFollower<'_> {
    /// Follows the path from a state at share 0 to the end of the stage; the state is stored if it is `new`.
    pub(super) fn go(&mut self, start: Vec<f64>, new: bool) -> Result<(), PathError> {
        self.solver.dae_mut().at_share(0.0);
        let mut x = start.clone();
        if let Err(failure) = self.solve(&mut x, START_PATIENCE) {
            x = self.first(start, failure).map_err(|f| self.fail(&f, 0.0))?;
        }
        self.orientation = self.solver.determinant_sign() * self.options.share.signum() as i8;
        if new {
            self.keep(&x)?;
        }
        let longest = LONGEST.min(self.options.points.map_or(LONGEST, |points| 1.0 / points as f64));
        let (mut trail, mut step) = self.set_out(x, self.options.share, longest);
        loop {
            let next = match self.step(&mut trail, step) {
                Err(lost) => self.go_around(&mut trail, lost)?,
                next => next?,
            };
            step = match next {
                NextAction::Step(step) => step.min(longest),
                NextAction::Branch(share, stability) => self.leave(&mut trail, (share, stability))?,
                NextAction::Arrived => return Ok(()),
            };
        }
    }

    /// Path from a state just solved at a prescribed share, and the length of its first step: a share change of `by`, at
    /// most `longest`.
    pub(super) fn set_out(&mut self, x: Vec<f64>, by: f64, longest: f64) -> (PathSoFar, f64) {
        let mut direction = vec![0.0; self.n + 1];
        direction[self.n] = 1.0;
        self.solver.apply_inverse(&mut direction);
        let step = (by.abs() * self.norm(&direction)).min(longest);
        let unit = by.signum() / self.norm(&direction);
        direction.iter_mut().for_each(|d| *d *= unit);
        let behind = 1e-3 * step;
        let before = x.iter().zip(&direction).map(|(x, d)| x - behind * d).collect();
        (PathSoFar::new(self, before, behind, x), step)
    }

    /// Makes one step, shortened until it succeeds.
    fn step(&mut self, trail: &mut PathSoFar, mut step: f64) -> Result<NextAction, PathError> {
        let (n, target) = (self.n, self.options.share);
        let last = trail.last.clone();
        let mut growth = GROWTH;
        let passes = |share: f64| (share - target) * (last[n] - target) <= 0.0;
        // true if a point predicted before the target was found beyond it
        let mut passed = false;
        // direction of the path after a turn, from its last point
        let mut turned: Option<Vec<f64>> = None;
        let asked = step;
        loop {
            let (guess, arrives) = match &turned {
                Some(direction) => {
                    let rate = direction[n];
                    let arrives = passed || passes(last[n] + step * rate);
                    if passes(last[n] + step * rate) {
                        step = (target - last[n]) / rate;
                    }
                    (last.iter().zip(direction).map(|(x, d)| x + step * d).collect(), arrives)
                }
                None => self.foretold(trail, &mut step, passed),
            };
            if arrives {
                self.solver.dae_mut().at_share(target);
            } else {
                self.aim(&last, &guess);
            }
            let mut x = guess.clone();
            let solved = self.solve(&mut x, PATIENCE);
            let off = self.off(&x, &guess, &last, step);
            if let Ok(iterations) = solved
                && off <= ASTRAY
            {
                if self.may_pass_over(&last, &x) {
                    self.path.rejected += 1;
                    (passed, growth) = (false, 1.0);
                    step *= 0.5;
                    continue;
                }
                if !arrives && passes(x[n]) {
                    passed = true;
                    step *= (target - last[n]) / (x[n] - last[n]);
                    continue;
                }
                if !arrives && step > ACROSS && (x[n] - last[n]) * trail.natural.last_change() < 0.0 {
                    self.path.rejected += 1;
                    growth = 1.0;
                    step = (0.25 * step).max(ACROSS);
                    continue;
                }
                // with prescribed load, the sign of the determinant is reversed if the load decreases
                let orientation = if arrives && x[n] < last[n] { -1 } else { 1 } * self.solver.determinant_sign();
                if orientation != self.orientation && self.options.branches {
                    if step <= NEAR {
                        let beyond = EquilibriumStability::assess(self.solver.dae_mut().statics(), x[n], &x[..n]);
                        return Ok(NextAction::Branch(x[n], beyond));
                    }
                    step = (0.25 * step).max(NEAR);
                    growth = 1.0;
                    continue;
                }
                self.orientation = orientation;
                let taken = self.norm(&difference(&x, &last));
                let degree = f64::from(trail.natural.degree());
                if turned.is_some() {
                    *trail = PathSoFar::new(self, last, taken, x.clone());
                } else {
                    trail.push(self, taken, x.clone());
                }
                self.keep(&x)?;
                if arrives {
                    return Ok(NextAction::Arrived);
                }
                if x[n].abs() > FURTHEST || self.path.states.len() > MOST_POINTS {
                    return Err(self.lost(x[n]));
                }
                let by_distance = (WANTED / off.max(1e-12)).powf(1.0 / degree);
                let by_work = WANTED_ITERATIONS / iterations as f64;
                return Ok(NextAction::Step(taken * by_distance.min(by_work).clamp(0.3, growth)));
            }
            self.path.rejected += 1;
            passed = false;
            growth = 1.0;
            // Points before a sharp turn predict a direction that is wrong by its angle, however short the step: use the one found.
            let mut found = difference(&x, &last);
            let distance = self.norm(&found);
            if solved.is_ok() && step < TURN * asked && distance < 2.0 * step {
                found.iter_mut().for_each(|x| *x /= distance);
                if turned.replace(found).is_none() {
                    continue;
                }
            }
            step *= if solved.is_ok() {
                (0.5 * ASTRAY / off).clamp(0.1, 0.5)
            } else {
                0.35
            };
            if step < SHORTEST {
                let what = "the solution is far from the prediction even with the shortest step";
                let astray = || KinsolError::own(what);
                return Err(self.fail(&solved.err().unwrap_or_else(astray), last[n]));
            }
        }
    }

    /// Predicts the next point of the path: a step beyond its last one, or at the requested share if the prediction reaches it. Returns
    /// the point, and true if the step ends at the requested share.
    fn foretold(&mut self, trail: &PathSoFar, step: &mut f64, passed: bool) -> (Vec<f64>, bool) {
        let (n, target) = (self.n, self.options.share);
        let share = |z: &[f64]| z[z.len() - 1];
        let mut guess = trail.natural.beyond(*step);
        let passes = (share(&guess) - target) * (trail.last[n] - target) <= 0.0;
        if passes {
            *step = crossing(|step| share(&trail.natural.beyond(step)) - target, *step);
            guess = trail.natural.beyond(*step);
        }
        let guess = self.natural.to_unknowns(self.solver.dae_mut().statics(), &guess);
        (guess, passed || passes)
    }

    /// Selects the point of the path in the plane through the guess that is normal to the chord from the last point.
    pub(super) fn aim(&mut self, last: &[f64], guess: &[f64]) {
        let mut direction = difference(guess, last);
        let norm = self.norm(&direction);
        for (d, w) in direction.iter_mut().zip(&self.weights) {
            *d *= w / norm;
        }
        let along = self.solver.dae_mut();
        along.position = direction.iter().zip(guess).map(|(d, x)| d * x).sum();
        along.direction = direction;
    }

    /// Solves from a guess. Returns the number of Newton steps.
    pub(super) fn solve(&mut self, x: &mut [f64], patience: u32) -> Result<u64, KinsolError> {
        let options = KinsolOptions {
            max_iterations: patience,
            ..KinsolOptions::default()
        };
        let solution = self.solver.solve(0.0, x, &options)?;
        self.path.work.add(&solution);
        Ok(solution.iterations)
    }

    /// Stores a state and passes it to `watch`.
    pub(super) fn keep(&mut self, x: &[f64]) -> Result<(), PathError> {
        let state = EquilibriumState::read(self.solver.dae_mut().statics(), x, self.stage);
        let factor = state.load_factor();
        let (beyond, glance) = state::within(self.solver.dae_mut().statics(), x, &self.limits, factor);
        self.path.unphysical.take(&self.limits.unphysical, &glance, factor);
        if self.path.beyond.is_none() {
            self.path.beyond = beyond;
        }
        let path = &mut self.path;
        let all = [
            (self.limits.reynolds(&glance), &mut path.reynolds),
            (self.limits.mach(&glance), &mut path.mach),
            (glance.value_and_rate(MonitoredQuantity::Strain)[0], &mut path.strain),
        ];
        for (value, largest) in all {
            if value > largest[0] {
                *largest = [value, factor];
            }
        }
        let control = (self.watch)(&state);
        if let [.., a, b] = &self.path.states[self.branch..]
            && (b.load_factor() - a.load_factor()) * (state.load_factor() - b.load_factor()) < 0.0
        {
            self.path.events.push(EquilibriumEvent {
                stage: self.stage,
                share: b.share,
                kind: EventKind::LimitPoint,
            });
            self.bounds.push(self.path.states.len() - 1);
        }
        let turns = self.turns(&state);
        self.path.states.push(state);
        match control {
            Control::Continue if turns && self.path.beyond.is_some() => Err(self.beyond()),
            Control::Continue => Ok(()),
            Control::Stop(reason) => Err(stopped(self.stage as f64 + x[self.n], &reason)),
        }
    }

    /// Distance of a solution from its prediction: in steps, or for displacements relative to their motion, whichever is larger.
    fn off(&self, x: &[f64], guess: &[f64], last: &[f64], step: f64) -> f64 {
        let off = difference(x, guess);
        let moved = |x: &[f64]| self.norm(&x[..self.n]);
        let whole = self.norm(&off) / step;
        whole.max(moved(&off) / (moved(&difference(guess, last)) + MOTION))
    }

    pub(super) fn norm(&self, x: &[f64]) -> f64 {
        x.iter().zip(&self.weights).map(|(x, w)| w * x * x).sum::<f64>().sqrt()
    }
}

/// Zero of a function that changes sign between 0 and `end` (bisection).
fn crossing(f: impl Fn(f64) -> f64, end: f64) -> f64 {
    let (mut low, mut high) = (0.0, end);
    let sign = f(high).signum();
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle).signum() == sign {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

pub(super) fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
