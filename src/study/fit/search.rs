//! Search from the starts to the minimum; estimates noise and weights that are not given on the way.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::{DMatrix, DVector};

use super::evaluation;
use super::outcome::FitStart;
use super::problem::{FitProblem, FitRequest};
use super::robust::LossFunction;
use super::simulate::{Simulated, simulate};
use crate::error::{Error, Result};
use crate::numerics::levenberg::{LevenbergMinimum, LevenbergStatus, minimise};
use crate::run::stop::INTERRUPTED;
use crate::study::search_bounds;
use crate::study::sweep::pool;

/// Largest number of steps of a search.
const STEPS: usize = 100;
/// Largest number of fits, each with the noise and weights of the previous one.
const ROUNDS: usize = 30;
/// Change of noise and weights below which they have converged.
const SAME: f64 = 1e-3;
/// Least noise, relative to the size of a column.
const LEAST: f64 = 1e-12;

/// Search for the minimum.
pub struct FitSearch<'a> {
    problem: &'a FitProblem,
    asked: &'a FitRequest,
    stop: &'a (dyn Fn() -> bool + Sync),
    report: &'a (dyn Fn(usize, f64) + Sync),
    simulations: AtomicUsize,
    fault: Mutex<Option<Error>>,
}

/// Minimum, and the simulation there.
#[derive(Clone, Debug)]
struct Found {
    minimum: LevenbergMinimum,
    simulated: Simulated,
}

/// Result of all searches.
pub struct FitOutcome {
    /// The minimum.
    pub minimum: LevenbergMinimum,
    /// Values of the numbers at the minimum.
    pub values: Vec<f64>,
    /// Simulation at the minimum.
    pub simulated: Simulated,
    /// Standard deviation of each observation.
    pub sigmas: Vec<f64>,
    /// True for each column whose noise was given.
    pub given: Vec<bool>,
    /// Weight of each observation by the loss function.
    pub weights: Vec<f64>,
    /// Searches from all starts.
    pub starts: Vec<FitStart>,
    /// Total number of steps.
    pub steps: usize,
}

impl FitOutcome {
    /// Residuals and derivatives over the standard deviations, without the weights of the loss.
    pub fn plain(&self, problem: &FitProblem) -> (DVector<f64>, DMatrix<f64>) {
        let scale: Vec<f64> = self.sigmas.iter().map(|sigma| sigma.recip()).collect();
        let plain = evaluation(&self.simulated, problem, &self.values, &scale);
        (plain.residuals, plain.jacobian)
    }
}

impl<'a> FitSearch<'a> {
    /// Creates the search of a problem.
    pub fn new(
        problem: &'a FitProblem,
        asked: &'a FitRequest,
        stop: &'a (dyn Fn() -> bool + Sync),
        report: &'a (dyn Fn(usize, f64) + Sync),
    ) -> Self {
        Self {
            problem,
            asked,
            stop,
            report,
            simulations: AtomicUsize::new(0),
            fault: Mutex::new(None),
        }
    }

    /// Number of simulations so far.
    pub fn simulations(&self) -> usize {
        self.simulations.load(Ordering::Relaxed)
    }

    /// Searches from every start, then continues from the best end. After a stop, returns the best so far.
    ///
    /// # Errors
    /// The case cannot be simulated at any start, or the search was stopped before the first simulation.
    pub fn go(&self) -> Result<FitOutcome> {
        let places = search_bounds::places(&self.problem.spans, &self.problem.start, self.asked.starts)?;
        let (mut sigmas, given) = self.first_noise();
        let mut weights = vec![1.0; sigmas.len()];
        let (many, within) = match places.len() {
            1 => (1, self.asked.jobs),
            _ => (self.asked.jobs, 1),
        };
        let one = |k: usize| (!(self.stop)()).then(|| self.minimise(&places[k], &scale(&sigmas, &weights), within));
        let found = pool::all(places.len(), many, &one);
        let found: Vec<Option<Found>> = found.into_iter().map(Option::flatten).collect();
        let mut steps = found.iter().flatten().map(|one| one.minimum.steps).sum();
        let start = |(from, found): (&Vec<f64>, &Option<Found>)| FitStart {
            from: self.problem.values(from),
            to: found.as_ref().map(|one| self.problem.values(&one.minimum.x)),
            chi_square: found.as_ref().map(|one| one.minimum.at.cost()),
        };
        // omit starts that had not begun at the stop
        let begun = |(_, found): &(&Vec<f64>, &Option<Found>)| found.is_some() || !(self.stop)();
        let starts = places.iter().zip(&found).filter(begun).map(start).collect();
        let best = found
            .into_iter()
            .flatten()
            .min_by(|a, b| a.minimum.at.cost().total_cmp(&b.minimum.at.cost()));
        let Some(mut best) = best else {
            if (self.stop)() {
                let what = format!("{INTERRUPTED} before the first simulation finished. No results are written");
                return Err(Error::Interrupted(what));
            }
            return Err(self.fault(|| "the simulation fails at every starting point".into()));
        };
        let unknown = given.iter().filter(|given| !**given).count();
        let again = self.asked.loss != LossFunction::Squares || unknown > 1;
        for round in 0..ROUNDS {
            let change = self.weigh(&best.simulated, &given, &mut sigmas, &mut weights);
            let settled = change < SAME || round + 1 == ROUNDS;
            if !again || settled || (self.stop)() {
                break;
            }
            match self.minimise(&best.minimum.x, &scale(&sigmas, &weights), self.asked.jobs) {
                Some(next) => best = next,
                None if (self.stop)() => break,
                None => return Err(self.fault(|| "the simulation fails after the data are weighted again".into())),
            }
            steps += best.minimum.steps;
        }
        let Found { mut minimum, simulated } = best;
        let values = self.problem.values(&minimum.x);
        minimum.at = evaluation(&simulated, self.problem, &values, &scale(&sigmas, &weights));
        Ok(FitOutcome {
            values,
            minimum,
            simulated,
            sigmas,
            given,
            weights,
            starts,
            steps,
        })
    }

    fn minimise(&self, start: &[f64], scale: &[f64], jobs: usize) -> Option<Found> {
        // best point so far, with its simulation
        let mut best: Option<Found> = None;
        let mut evaluate = |places: &[f64]| {
            if (self.stop)() {
                return Err(());
            }
            let values = self.problem.values(places);
            let simulated = match self.simulate(&values, jobs) {
                Ok(simulated) => simulated,
                Err(_) if (self.stop)() => return Err(()),
                Err(error) => {
                    *self.fault.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(error);
                    return Ok(None);
                }
            };
            let found = evaluation(&simulated, self.problem, &values, scale);
            (self.report)(self.simulations(), found.cost());
            let finite = found
                .residuals
                .iter()
                .chain(found.jacobian.iter())
                .all(|x| x.is_finite());
            let cost = found.cost();
            if finite && best.as_ref().is_none_or(|best| cost < best.minimum.at.cost()) {
                let minimum = LevenbergMinimum {
                    x: places.to_vec(),
                    at: found.clone(),
                    ended: LevenbergStatus::Unfinished,
                    steps: 0,
                    evaluations: 0,
                };
                best = Some(Found { minimum, simulated });
            }
            Ok(finite.then_some(found))
        };
        let found = minimise(start, STEPS, &mut evaluate);
        match found {
            Err(()) => best,
            Ok(minimum) => {
                let minimum = minimum?;
                let simulated = match best {
                    Some(best) if best.minimum.x == minimum.x => best.simulated,
                    _ => self.simulate(&self.problem.values(&minimum.x), jobs).ok()?,
                };
                Some(Found { minimum, simulated })
            }
        }
    }

    fn simulate(&self, values: &[f64], jobs: usize) -> Result<Simulated> {
        self.simulations.fetch_add(1, Ordering::Relaxed);
        simulate(self.problem, values, jobs, self.stop)
    }

    fn fault(&self, otherwise: impl FnOnce() -> String) -> Error {
        let own = self
            .fault
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
            .take();
        own.unwrap_or_else(|| Error::Usage(otherwise()))
    }

    /// Initial noise of each observation: the given noise, otherwise the size of the column. Second: true for each
    /// column whose noise was given.
    fn first_noise(&self) -> (Vec<f64>, Vec<bool>) {
        let all = &self.problem.observations;
        let sizes: Vec<f64> = (0..self.problem.matched.len()).map(|k| self.size(k)).collect();
        let sigmas = all.iter().map(|one| one.sigma.unwrap_or(sizes[one.of])).collect();
        let given = |k| self.problem.observations(k).all(|(_, one)| one.sigma.is_some());
        (sigmas, (0..sizes.len()).map(given).collect())
    }

    /// Largest value of a column; 1 if all are 0.
    fn size(&self, column: usize) -> f64 {
        let own = self.problem.observations(column);
        let largest = own.map(|(_, one)| one.value.abs()).fold(0.0, f64::max);
        if largest > 0.0 { largest } else { 1.0 }
    }

    /// Estimates noise and weights from the residuals of a fit; returns their largest change.
    fn weigh(&self, simulated: &Simulated, given: &[bool], sigmas: &mut [f64], weights: &mut [f64]) -> f64 {
        let (all, loss) = (&self.problem.observations, self.asked.loss);
        let mut change = 0.0_f64;
        for (column, _) in given.iter().enumerate().filter(|(_, given)| !**given) {
            let own = || self.problem.observations(column);
            let errors: Vec<f64> = own().map(|(i, one)| simulated.values[i] - one.value).collect();
            let lost = self.problem.spans.len() as f64 * errors.len() as f64 / all.len() as f64;
            let sigma = loss.deviation(&errors, lost).max(LEAST * self.size(column));
            for (i, _) in own() {
                change = change.max((sigma / sigmas[i] - 1.0).abs());
                sigmas[i] = sigma;
            }
        }
        for (i, weight) in weights.iter_mut().enumerate() {
            let next = loss.weight((simulated.values[i] - all[i].value) / sigmas[i]);
            change = change.max((next - *weight).abs());
            *weight = next;
        }
        change
    }
}

/// Factors by which residuals are multiplied.
fn scale(sigmas: &[f64], weights: &[f64]) -> Vec<f64> {
    sigmas
        .iter()
        .zip(weights)
        .map(|(sigma, weight)| weight.sqrt() / sigma)
        .collect()
}
