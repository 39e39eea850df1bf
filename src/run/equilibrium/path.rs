//! Along the path of equilibria.

use super::arclength::Arclength;
use super::natural::Natural;
use super::predict::Trail;
use super::state::{self, Stability, State};
use super::{Event, Kind, Options, Path, rest, system};
use crate::case::schema::Case;
use crate::discrete::System;
use crate::error::{self, At, Code, SolverError};
use crate::run::range::Limits;
use crate::run::record::Control;
use crate::sundials::{Kinsol, KinsolError, KinsolOptions};

/// Longest step, in lengths of the beam and shares of the load.
const LONGEST: f64 = 0.5;
/// Shortest step worth trying.
const SHORTEST: f64 = 1e-7;
/// How far a solution may lie from its prediction, in steps: further off it may be on another path.
const ASTRAY: f64 = 0.2;
/// The same that steps are chosen for.
const WANTED: f64 = 0.05;
/// Newton steps that steps are chosen for, and largest growth of a step.
const WANTED_ITERATIONS: f64 = 12.0;
const GROWTH: f64 = 2.5;
/// Distance to a crossing path at which it is entered.
pub(super) const NEAR: f64 = 1e-4;
/// Newton steps after which a prediction counts as bad.
pub(super) const PATIENCE: u32 = 14;
/// The same at rest.
const START_PATIENCE: u32 = 60;
/// Points of a path that has lost its way.
const MOST_POINTS: usize = 5000;
/// Shares beyond which a path has lost its way.
const FURTHEST: f64 = 100.0;

/// Follows the equilibria of a case from rest to a share of its loads. `watch` sees every state and may end the path.
///
/// # Errors
/// Those of [`System::new`]; a path that ends early has its fault.
pub fn follow(case: &Case, options: &Options, watch: &mut dyn FnMut(&State) -> Control) -> error::Result<Path> {
    Ok(follow_of(case, system(case, options.at_s)?, options, true, watch))
}

/// The same of another static system of the case; whether its states hold is judged where that is wanted.
pub(super) fn follow_of(
    case: &Case,
    system: System,
    options: &Options,
    judged: bool,
    watch: &mut dyn FnMut(&State) -> Control,
) -> Path {
    let (statics, y) = rest(case, system);
    let mut path = Path::default();
    if let Some(inflow) = statics.fed() {
        let what =
            format!("there is no equilibrium: a closed network takes in {inflow:.3e} m^3/s which nothing lets out");
        path.fault = Some(SolverError {
            cause: Some("a port of prescribed flow without one of prescribed pressure in the same network".into()),
            hint: Some("open the network by a port with pressure_pa, or let the flows sum to zero".into()),
            ..fault(0.0, &what)
        });
        return path;
    }
    let n = y.len();
    let weights = weights(statics.system());
    let limits = Limits::new(case, statics.system());
    let natural = Natural::of(&statics);
    match Kinsol::new(Arclength::new(statics)) {
        Err(failure) => path.fault = Some(fault(0.0, &failure.what)),
        Ok(solver) => {
            let mut x = y;
            x.push(0.0);
            let mut follower = Follower {
                orientation: 0,
                branch: 0,
                natural,
                bounds: vec![0],
                solver,
                weights,
                n,
                options: *options,
                limits,
                path: &mut path,
                watch,
            };
            let ended = follower.go(x);
            if judged {
                follower.judge();
            }
            path.fault = ended.err().map(|End(fault)| fault);
        }
    }
    path
}

/// Squared weight of each unknown and of the share in the length of a step: displacements in lengths of the beam, root mean
/// square over its nodes; the others follow from these.
fn weights(system: &System) -> Vec<f64> {
    let l = &system.layout;
    let mut weights = vec![0.0; l.len + 1];
    for unknown in l.lines.iter().flat_map(|line| line.u.clone()) {
        weights[unknown] = (l.scales[unknown] / system.model.length).powi(2) / system.mesh.nodes as f64;
    }
    weights[l.len] = 1.0;
    weights
}

/// Why a path ends early.
pub(super) struct End(pub SolverError);

/// What comes after a step.
enum Next {
    /// Another one of this length.
    Step(f64),
    /// The path is crossed by another one before this share, where it is as stable as this.
    Branch(f64, Option<Stability>),
    /// Nothing.
    Arrived,
}

pub(super) struct Follower<'a> {
    /// Sign of the determinant of the equations: it changes where another path crosses, not at a limit point.
    pub(super) orientation: i8,
    /// State with which the present branch begins.
    pub(super) branch: usize,
    natural: Natural,
    /// States where stability may change: after a limit point, on a new branch.
    pub(super) bounds: Vec<usize>,
    pub(super) solver: Kinsol<Arclength>,
    pub(super) weights: Vec<f64>,
    pub(super) n: usize,
    options: Options,
    limits: Limits,
    pub(super) path: &'a mut Path,
    watch: &'a mut dyn FnMut(&State) -> Control,
}

/// The way so far: its last points in natural coordinates, the last one in unknowns too.
pub(super) struct Way {
    natural: Trail,
    /// The last point.
    pub last: Vec<f64>,
}

impl Way {
    /// Two points at a distance.
    pub fn new(follower: &mut Follower, before: Vec<f64>, distance: f64, last: Vec<f64>) -> Self {
        let statics = follower.solver.dae_mut().statics();
        let first = follower.natural.of_unknowns(statics, &before, None);
        let second = follower.natural.of_unknowns(statics, &last, Some(&first));
        Self {
            natural: Trail::through(first, distance, second),
            last,
        }
    }

    fn push(&mut self, follower: &mut Follower, distance: f64, x: Vec<f64>) {
        let statics = follower.solver.dae_mut().statics();
        let z = follower.natural.of_unknowns(statics, &x, Some(self.natural.last()));
        self.natural.push(distance, z);
        self.last = x;
    }
}

impl Follower<'_> {
    fn go(&mut self, mut x: Vec<f64>) -> Result<(), End> {
        self.solver.dae_mut().at_share(0.0);
        self.solve(&mut x, START_PATIENCE).map_err(|f| self.fail(&f, 0.0))?;
        self.orientation = self.solver.determinant_sign() * self.options.share.signum() as i8;
        self.keep(&x)?;
        let longest = LONGEST.min(self.options.points.map_or(LONGEST, |points| 1.0 / points as f64));
        let mut direction = self.by_share();
        let mut step = (self.options.share.abs() * self.norm(&direction)).min(longest);
        let unit = self.options.share.signum() / self.norm(&direction);
        direction.iter_mut().for_each(|d| *d *= unit);
        let behind = 1e-3 * step;
        let before: Vec<f64> = x.iter().zip(&direction).map(|(x, d)| x - behind * d).collect();
        let mut trail = Way::new(self, before, behind, x);
        loop {
            step = match self.step(&mut trail, step)? {
                Next::Step(step) => step.min(longest),
                Next::Branch(share, stability) => self.leave(&mut trail, (share, stability))?,
                Next::Arrived => return Ok(()),
            };
        }
    }

    /// Takes one step, shortened until it succeeds.
    fn step(&mut self, trail: &mut Way, mut step: f64) -> Result<Next, End> {
        let (n, target) = (self.n, self.options.share);
        let last = trail.last.clone();
        let mut growth = GROWTH;
        let passes = |share: f64| (share - target) * (last[n] - target) <= 0.0;
        // a point beyond the target that was predicted before it
        let mut passed = false;
        loop {
            let mut guess = trail.natural.beyond(step);
            let share = |z: &[f64]| z[z.len() - 1];
            let arrives = passed || passes(share(&guess));
            if passes(share(&guess)) {
                step = crossing(|step| share(&trail.natural.beyond(step)) - target, step);
                guess = trail.natural.beyond(step);
            }
            let guess = self.natural.to_unknowns(self.solver.dae_mut().statics(), &guess);
            if arrives {
                self.solver.dae_mut().at_share(target);
            } else {
                self.aim(&last, &guess);
            }
            let mut x = guess.clone();
            let solved = self.solve(&mut x, PATIENCE);
            let off = self.norm(&difference(&x, &guess)) / step;
            if let Ok(iterations) = solved
                && off <= ASTRAY
            {
                if !arrives && passes(x[n]) {
                    passed = true;
                    step *= (target - last[n]) / (x[n] - last[n]);
                    continue;
                }
                // With the load prescribed the equations are turned around where it falls.
                let orientation = if arrives && x[n] < last[n] { -1 } else { 1 } * self.solver.determinant_sign();
                if orientation != self.orientation && self.options.branches {
                    if step <= NEAR {
                        let beyond = Stability::of(self.solver.dae_mut().statics(), x[n], &x[..n]);
                        return Ok(Next::Branch(x[n], beyond));
                    }
                    step = (0.25 * step).max(NEAR);
                    growth = 1.0;
                    continue;
                }
                self.orientation = orientation;
                let taken = self.norm(&difference(&x, &last));
                let degree = f64::from(trail.natural.degree());
                trail.push(self, taken, x.clone());
                self.keep(&x)?;
                if arrives {
                    return Ok(Next::Arrived);
                }
                if x[n].abs() > FURTHEST || self.path.states.len() > MOST_POINTS {
                    return Err(self.lost(x[n]));
                }
                let by_distance = (WANTED / off.max(1e-12)).powf(1.0 / degree);
                let by_work = WANTED_ITERATIONS / iterations as f64;
                return Ok(Next::Step(taken * by_distance.min(by_work).clamp(0.3, growth)));
            }
            self.path.rejected += 1;
            passed = false;
            growth = 1.0;
            step *= if solved.is_ok() {
                (0.5 * ASTRAY / off).clamp(0.1, 0.5)
            } else {
                0.35
            };
            if step < SHORTEST {
                let what = "what is found lies far from what was predicted, however short the step";
                let astray = || KinsolError::own(what);
                return Err(self.fail(&solved.err().unwrap_or_else(astray), last[n]));
            }
        }
    }

    /// Asks for the point of the path in the plane through the guess, across the chord from the last point to it.
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

    /// `d(y, s)/ds` of the path at the last solution, found with s prescribed.
    fn by_share(&mut self) -> Vec<f64> {
        let mut direction = vec![0.0; self.n + 1];
        direction[self.n] = 1.0;
        self.solver.apply_inverse(&mut direction);
        direction
    }

    /// Solves from a guess; Newton steps done.
    pub(super) fn solve(&mut self, x: &mut [f64], patience: u32) -> Result<u64, KinsolError> {
        let options = KinsolOptions {
            max_iterations: patience,
            ..KinsolOptions::default()
        };
        let solution = self.solver.solve(0.0, x, &options)?;
        self.path.work.add(&solution);
        Ok(solution.iterations)
    }

    /// Keeps a state and shows it.
    pub(super) fn keep(&mut self, x: &[f64]) -> Result<(), End> {
        let state = State::read(self.solver.dae_mut().statics(), x);
        let (beyond, reynolds) = state::within(self.solver.dae_mut().statics(), x, &self.limits);
        if self.path.beyond.is_none() {
            self.path.beyond = beyond;
        }
        if reynolds > self.path.reynolds[0] {
            self.path.reynolds = [reynolds, state.share];
        }
        let control = (self.watch)(&state);
        if let [.., a, b] = &self.path.states[self.branch..]
            && (b.share - a.share) * (state.share - b.share) < 0.0
        {
            self.path.events.push(Event {
                share: b.share,
                kind: Kind::LimitPoint,
            });
            self.bounds.push(self.path.states.len() - 1);
        }
        self.path.states.push(state);
        match control {
            Control::Continue => Ok(()),
            Control::Stop(reason) => {
                let share = x[self.n];
                let mut fault = fault(share, &reason);
                fault.cause = None;
                Err(End(fault))
            }
        }
    }

    pub(super) fn norm(&self, x: &[f64]) -> f64 {
        x.iter().zip(&self.weights).map(|(x, w)| w * x * x).sum::<f64>().sqrt()
    }

    fn lost(&self, share: f64) -> End {
        let points = self.path.states.len();
        let what =
            format!("the path does not come to the load factor that is asked for: {points} points end at {share:.4}");
        End(fault(share, &what))
    }

    pub(super) fn fail(&self, failure: &KinsolError, share: f64) -> End {
        End(SolverError {
            unknown: failure.worst.clone(),
            ..fault(
                share,
                &format!(
                    "no equilibrium is found beyond {share:.6} of the loads: {}",
                    failure.what
                ),
            )
        })
    }
}

pub(super) fn fault(share: f64, what: &str) -> SolverError {
    SolverError {
        code: Code::NoEquilibrium,
        at: At::LoadFactor(share),
        what: what.into(),
        unknown: None,
        cause: Some(if share == 0.0 {
            "nothing holds the beam, or a part of the network has neither bladder nor pressure".into()
        } else {
            "two paths that meet, a coupling that is not convex, a bladder that closes".to_string()
        }),
        hint: Some("look at the states up to there; a small load across tells which way a symmetric beam bends".into()),
    }
}

/// Where a function that changes sign between 0 and `end` is zero (bisection).
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
