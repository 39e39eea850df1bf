//! Amplitudes from measurements by least squares, weighted with the noise and a prior of the loads.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::misfit::Misfit;
use super::weight::{choose, heaviest};
use crate::error::numbers::counted;
use crate::error::{Error, Result};
use crate::numerics::bayesian_least_squares::{Observability, Posterior, ReducedProblem};
use crate::numerics::{normal, student_t};

/// Forward model: values as a function of amplitudes.
pub trait ForwardModel {
    /// Values at given amplitudes, and their derivatives: a row per value, a column per amplitude.
    ///
    /// # Errors
    /// Those of states that are not found.
    fn at(&mut self, amplitudes: &[f64]) -> Result<(DVector<f64>, DMatrix<f64>)>;

    /// Relative noise of the values as a function of the amplitudes.
    fn grain(&self) -> f64 {
        CLOSE
    }

    /// Largest numbers of Gauss-Newton steps and of halvings of a step.
    fn patience(&self) -> [u32; 2] {
        [STEPS, HALVINGS]
    }
}

/// Measurements to be explained by one set of amplitudes.
pub struct SenseProblem<'a> {
    /// Forward model of the measured values.
    pub forward: Box<dyn ForwardModel + 'a>,
    /// Measured values; `None` for a missing one.
    pub data: Vec<Option<f64>>,
    /// Deviation of the noise of each value if known, else in proportion to it.
    pub deviation: Vec<f64>,
    /// Line of the measurements, if they are one line.
    pub line: Option<usize>,
    /// Initial amplitudes.
    pub start: DVector<f64>,
    /// Values and derivatives at `start`.
    pub first: (DVector<f64>, DMatrix<f64>),
}

impl SenseProblem<'_> {
    /// Adds the line of the measurements to an error.
    pub(super) fn named(&self, mut error: Error) -> Error {
        if let (Error::Solver(fault), Some(line)) = (&mut error, self.line) {
            fault.what = format!("line {line} of the measurements: {}", fault.what);
        }
        error
    }
}

/// Weight of the prior that loads vary smoothly along the beam or in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Smoothing {
    /// By the data: maximum likelihood.
    #[default]
    Likelihood,
    /// Residuals as large as the noise (Morozov's discrepancy principle).
    Discrepancy,
    /// Fixed deviation of second differences.
    Fixed(f64),
    /// No prior.
    Off,
}

/// Options of the estimate.
pub struct EstimateOptions<'a> {
    /// Rows of differences that the prior assumes to be small; no rows, no prior.
    pub differences: &'a DMatrix<f64>,
    /// Weight of the prior.
    pub smoothing: Smoothing,
    /// True if the deviation of the noise is known.
    pub noise_known: bool,
}

/// Estimated amplitudes of one problem.
#[derive(Clone, Debug)]
pub struct Amplitudes {
    /// Mean of the amplitudes.
    pub mean: DVector<f64>,
    /// Covariance of the amplitudes.
    pub covariance: DMatrix<f64>,
    /// Modelled values, measured or not.
    pub predicted: DVector<f64>,
    /// Derivatives of the modelled values.
    pub jacobian: DMatrix<f64>,
    /// Observability by measurements and prior.
    pub seen: Observability,
    /// Number of evaluations of the forward model.
    pub runs: u32,
    /// True if the last iteration converged.
    pub settled: bool,
}

/// Estimates of all problems, and their common quantities.
#[derive(Clone, Debug)]
pub struct LoadEstimates {
    /// One per problem.
    pub found: Vec<Amplitudes>,
    /// Deviation of the noise over the given one; 1 if it is known.
    pub noise: f64,
    /// Residuals of all values.
    pub misfit: Misfit,
    /// Factor by which bands are widened because residuals exceed the noise; 1 if the noise is unknown.
    pub widened: f64,
    /// Half-width of a 95 % band in standard deviations.
    pub quantile: f64,
    /// Prior deviation of the differences; none without a prior.
    pub deviation_of_differences: Option<f64>,
}

/// Largest number of Gauss-Newton steps.
const STEPS: u32 = 40;
/// Largest number of halvings of a step.
const HALVINGS: u32 = 12;
/// Stop criterion: relative change of the values by a step.
const CLOSE: f64 = 1e-9;
/// Largest number of rounds between amplitudes and the weight of the prior.
const ROUNDS: u32 = 12;
/// Stop criterion of the rounds: change of the logarithm of the weight.
const SAME_WEIGHT: f64 = 0.02;

/// Estimates the amplitudes a of problems with measured p(a). All share the deviation σ of the noise and the weight 1/τ of the prior:
///
/// ```text
/// a = argmin |p - p(a)|^2/σ^2 + |R a|^2/τ^2        cov a = (J^T J/σ^2 + R^T R/τ^2)^-1        J = ∂p/∂a
/// τ:  |A|^(-1/2) τ^(-rank R) exp(-S/2) largest        A = cov^-1, S the minimum
/// ```
///
/// Solved by Gauss-Newton iteration. An unknown σ is estimated by `S = (m - k) σ^2`, with k the directions of a that R leaves free; bands
/// then are Student's.
///
/// # Errors
/// Those of the problems; [`Error::Usage`] if there are too few values to estimate the noise.
pub fn estimate(problems: &mut [SenseProblem], ask: &EstimateOptions) -> Result<LoadEstimates> {
    let rank = match ask.smoothing {
        Smoothing::Off => 0,
        _ => rank(ask.differences),
    };
    let mut weight = match ask.smoothing {
        Smoothing::Fixed(deviation) => 1.0 / deviation,
        // starts weak, so that the data dominate at first
        _ => 1.0,
    };
    let chosen = rank > 0 && matches!(ask.smoothing, Smoothing::Likelihood | Smoothing::Discrepancy);
    if !ask.noise_known && ask.smoothing == Smoothing::Discrepancy {
        let what = "--smoothing discrepancy needs the noise of the pressures: give its deviation, --noise PA";
        return Err(Error::Usage(what.into()));
    }
    let before = |weight: f64| match rank {
        0 => DMatrix::zeros(0, ask.differences.ncols()),
        _ => ask.differences * weight,
    };
    let mut states: Vec<State> = problems.iter().map(State::new).collect();
    // if loads alone can reproduce every pressure, a weight chosen by the data would make the noise vanish
    let alone = |state: &State| state.measured.len() - Observability::from_matrix(&state.weighted()).values.len();
    if !ask.noise_known && chosen && states.iter().map(alone).sum::<usize>() == 0 {
        return Err(few(&states));
    }
    let most = heaviest(states.iter().map(State::weighted), ask.differences);
    weight = weight.min(most);
    let mut noise = 1.0;
    for round in 0..ROUNDS {
        let mut posteriors = vec![];
        for (problem, state) in problems.iter_mut().zip(&mut states) {
            // a fixed deviation is that of the amplitudes themselves, not relative to the noise
            let own = match ask.smoothing {
                Smoothing::Fixed(_) => weight * noise,
                _ => weight,
            };
            let found = state.descend(problem, &before(own));
            posteriors.push(found.map_err(|error| problem.named(error))?);
        }
        let sums = Sums::collect(&posteriors, rank, &states);
        if !ask.noise_known {
            if sums.freedom < 0.5 {
                return Err(few(&states));
            }
            let last = std::mem::replace(&mut noise, (sums.left() / sums.freedom).sqrt());
            let fixed = rank > 0 && matches!(ask.smoothing, Smoothing::Fixed(_));
            if fixed && (noise / last).ln().abs() > 1e-3 && round + 1 < ROUNDS {
                continue;
            }
        }
        if !chosen {
            break;
        }
        let linear: Vec<ReducedProblem> = states.iter().map(State::linear).collect();
        let next = choose(&linear, &before, rank, ask, most);
        let same = (next / weight).ln().abs() < SAME_WEIGHT;
        weight = next;
        if same {
            break;
        }
    }
    let own = match ask.smoothing {
        Smoothing::Fixed(_) => weight * noise,
        _ => weight,
    };
    let mut posteriors = vec![];
    for (problem, state) in problems.iter_mut().zip(&mut states) {
        posteriors.push(state.descend(problem, &before(own))?);
    }
    let sums = Sums::collect(&posteriors, rank, &states);
    if !ask.noise_known {
        noise = (sums.left() / sums.freedom).sqrt();
    }
    let misfit = Misfit {
        data: sums.misfit,
        rough: sums.rough,
        values: states.iter().map(|state| state.measured.len()).sum(),
        freedom: sums.freedom,
        by_discrepancy: rank > 0 && ask.smoothing == Smoothing::Discrepancy,
    };
    let found = states.into_iter().zip(posteriors).map(|(state, posterior)| Amplitudes {
        seen: Observability::from_matrix(&stacked(&state.weighted(), &before(own))),
        mean: state.at,
        covariance: posterior.spread * (noise * noise),
        predicted: state.values,
        jacobian: state.jacobian,
        runs: state.runs,
        settled: state.settled,
    });
    Ok(LoadEstimates {
        found: found.collect(),
        noise,
        widened: misfit.beyond_chance().filter(|_| ask.noise_known).unwrap_or(1.0),
        misfit,
        quantile: match ask.noise_known {
            true => normal::quantile(0.975),
            false => student_t::quantile(0.05, sums.freedom),
        },
        deviation_of_differences: (rank > 0).then(|| noise / own),
    })
}

/// Number of linearly independent differences.
fn rank(differences: &DMatrix<f64>) -> usize {
    match differences.is_empty() {
        true => 0,
        false => Observability::from_matrix(differences).values.len(),
    }
}

/// Stacks two matrices, each scaled to a largest entry of 1.
fn stacked(upper: &DMatrix<f64>, lower: &DMatrix<f64>) -> DMatrix<f64> {
    let m = upper.nrows();
    let size = |rows: &DMatrix<f64>| {
        if rows.is_empty() {
            1.0
        } else {
            rows.amax().max(f64::MIN_POSITIVE)
        }
    };
    let sizes = [upper, lower].map(size);
    DMatrix::from_fn(m + lower.nrows(), upper.ncols(), |i, j| {
        if i < m {
            upper[(i, j)] / sizes[0]
        } else {
            lower[(i - m, j)] / sizes[1]
        }
    })
}

fn few(states: &[State]) -> Error {
    let values = counted(states.iter().map(|state| state.measured.len() as u64).sum(), "pressure");
    Error::Usage(format!(
        "{values} determine only the loads. Give the deviation of the noise, --noise PA, or estimate fewer loads"
    ))
}

/// Sums over all problems.
struct Sums {
    misfit: f64,
    rough: f64,
    freedom: f64,
}

impl Sums {
    fn left(&self) -> f64 {
        self.misfit + self.rough
    }

    fn collect(posteriors: &[Posterior], rank: usize, states: &[State]) -> Self {
        let freedom = posteriors.iter().zip(states).map(|(posterior, state)| {
            let free = posterior.rank.saturating_sub(rank);
            state.measured.len() as f64 - free as f64
        });
        Self {
            misfit: posteriors.iter().map(|p| p.misfit).sum(),
            rough: posteriors.iter().map(|p| p.rough).sum(),
            freedom: freedom.sum(),
        }
    }
}

/// Current iterate of a problem.
struct State {
    at: DVector<f64>,
    values: DVector<f64>,
    jacobian: DMatrix<f64>,
    /// Measured values: index, value, deviation.
    measured: Vec<(usize, f64, f64)>,
    runs: u32,
    settled: bool,
}

impl State {
    fn new(problem: &SenseProblem) -> Self {
        let measured = problem.data.iter().zip(&problem.deviation).enumerate();
        let measured = measured.filter_map(|(k, (value, deviation))| Some((k, (*value)?, *deviation)));
        let (values, jacobian) = problem.first.clone();
        Self {
            at: problem.start.clone(),
            values,
            jacobian,
            measured: measured.collect(),
            runs: 1,
            settled: true,
        }
    }

    /// Residuals of the measurements over their deviations.
    fn residual(&self, values: &DVector<f64>) -> DVector<f64> {
        let left = self
            .measured
            .iter()
            .map(|(k, value, deviation)| (value - values[*k]) / deviation);
        DVector::from_iterator(self.measured.len(), left)
    }

    /// Derivatives of the measured values, over their deviations.
    fn weighted(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.measured.len(), self.at.len(), |i, j| {
            let (k, _, deviation) = self.measured[i];
            self.jacobian[(k, j)] / deviation
        })
    }

    /// Linearization about the current iterate.
    fn linear(&self) -> ReducedProblem {
        let jacobian = self.weighted();
        let right = self.residual(&self.values) + &jacobian * &self.at;
        ReducedProblem::new(jacobian, right)
    }

    /// Iterates to the minimum.
    fn descend(&mut self, problem: &mut SenseProblem, before: &DMatrix<f64>) -> Result<Posterior> {
        let size = self
            .measured
            .iter()
            .map(|(_, value, deviation)| (value / deviation).powi(2))
            .sum::<f64>();
        let size = size.sqrt();
        self.settled = true;
        let [steps, halvings] = problem.forward.patience();
        for _ in 0..steps {
            let posterior = self.linear().posterior(before);
            let whole = &posterior.x - &self.at;
            let change = (self.weighted() * &whole).norm().max((before * &whole).norm());
            if change <= problem.forward.grain() * size.max(f64::MIN_POSITIVE) {
                return Ok(posterior);
            }
            let cost = |at: &DVector<f64>, values: &DVector<f64>| {
                self.residual(values).norm_squared() + (before * at).norm_squared()
            };
            let now = cost(&self.at, &self.values);
            let mut share = 1.0;
            let (mut taken, mut runs) = (None, 0);
            for _ in 0..halvings {
                let there = &self.at + &whole * share;
                runs += 1;
                match problem.forward.at(there.as_slice()) {
                    Ok((values, jacobian)) if cost(&there, &values) <= now * (1.0 + problem.forward.grain()) => {
                        taken = Some((there, values, jacobian));
                        break;
                    }
                    Ok(_) => share *= 0.5,
                    Err(error) if share < 1e-3 => return Err(error),
                    Err(_) => share *= 0.5,
                }
            }
            self.runs += runs;
            match taken {
                Some(taken) => (self.at, self.values, self.jacobian) = taken,
                // no step reduces the cost: the iterate is accurate to rounding errors
                None => return Ok(posterior),
            }
        }
        self.settled = false;
        Ok(self.linear().posterior(before))
    }
}
