//! Amplitudes from measurements: least squares, weighted with what is known of noise and of the loads.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::misfit::Misfit;
use super::weight::{choose, heaviest};
use crate::error::numbers::counted;
use crate::error::{Error, Result};
use crate::numerics::inverse::{Linear, Posterior, Seen};
use crate::numerics::{normal, student};

/// What amplitudes make of the quantities that are measured.
pub trait Forward {
    /// Values at amplitudes, and their derivatives, a row a value and a column an amplitude.
    ///
    /// # Errors
    /// There is no such state.
    fn at(&mut self, amplitudes: &[f64]) -> Result<(DVector<f64>, DMatrix<f64>)>;

    /// Share of the values below which they are not smooth in the amplitudes.
    fn grain(&self) -> f64 {
        CLOSE
    }

    /// Steps of Gauss and Newton's iteration at most, and halvings of a step.
    fn patience(&self) -> [u32; 2] {
        [STEPS, HALVINGS]
    }
}

/// Measurements that some amplitudes are to explain.
pub struct Problem<'a> {
    /// What would be measured.
    pub forward: Box<dyn Forward + 'a>,
    /// What was; nothing where nothing was.
    pub data: Vec<Option<f64>>,
    /// Deviation of the noise of each value, where that is known; else in proportion to it.
    pub deviation: Vec<f64>,
    /// Line of the measurements, where it is one.
    pub line: Option<usize>,
    /// Amplitudes to begin with.
    pub start: DVector<f64>,
    /// Values there, and derivatives.
    pub first: (DVector<f64>, DMatrix<f64>),
}

impl Problem<'_> {
    /// An error with the line of the measurements that leads to it.
    pub(super) fn named(&self, mut error: Error) -> Error {
        if let (Error::Solver(fault), Some(line)) = (&mut error, self.line) {
            fault.what = format!("line {line} of the measurements: {}", fault.what);
        }
        error
    }
}

/// How much is made of what is known before: that loads change little from one place, or instant, to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Smoothing {
    /// As the data say themselves: the largest likelihood.
    #[default]
    Likelihood,
    /// So that what is left of the data is their noise (Morozov's discrepancy principle).
    Discrepancy,
    /// Second differences of this deviation.
    Fixed(f64),
    /// Nothing is known before.
    Off,
}

/// What is asked of the estimate.
pub struct Ask<'a> {
    /// Differences that are small, a row each; without rows nothing is known before.
    pub differences: &'a DMatrix<f64>,
    /// What is made of them.
    pub smoothing: Smoothing,
    /// Whether the deviation of the noise is known.
    pub noise_known: bool,
}

/// Amplitudes of one problem.
#[derive(Clone, Debug)]
pub struct Found {
    /// The mean.
    pub mean: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
    /// What they make of every value, measured or not.
    pub predicted: DVector<f64>,
    /// Derivatives of these.
    pub jacobian: DMatrix<f64>,
    /// What of the amplitudes is told, by the measurements and what is known before.
    pub seen: Seen,
    /// Times that values were computed.
    pub runs: u32,
    /// Whether the last iteration came to an end by itself.
    pub settled: bool,
}

/// Amplitudes of all problems, and what they share.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// One a problem.
    pub found: Vec<Found>,
    /// Deviation of the noise over that which was given: 1 where it is known.
    pub noise: f64,
    /// What is left of all values.
    pub misfit: Misfit,
    /// By how much bands are wider than the noise makes them, since more is left than it explains; 1 where it is not known.
    pub widened: f64,
    /// Half of a band of 95 %, in deviations.
    pub quantile: f64,
    /// Deviation of the differences that was used; none where nothing is known before.
    pub deviation_of_differences: Option<f64>,
}

/// Steps of Gauss and Newton's iteration at most.
const STEPS: u32 = 40;
/// Halvings of a step at most.
const HALVINGS: u32 = 12;
/// What a step may still change of the values, over these, when it is the last one.
const CLOSE: f64 = 1e-9;
/// Rounds between amplitudes and the weight of what is known before.
const ROUNDS: u32 = 12;
/// Change of the logarithm of that weight that is none.
const SAME_WEIGHT: f64 = 0.02;

/// Finds the amplitudes a of problems with p(a) measured, which share the deviation σ of the noise and the weight 1/τ of what is known:
///
/// ```text
/// a = argmin |p - p(a)|^2/σ^2 + |R a|^2/τ^2        cov a = (J^T J/σ^2 + R^T R/τ^2)^-1        J = ∂p/∂a
/// τ:  |A|^(-1/2) τ^(-rank R) exp(-S/2) largest        A = cov^-1, S the minimum
/// ```
///
/// by Gauss and Newton's iteration. Where σ is not known it is estimated by `S = (m - k) σ^2`, k the directions of a that R leaves free, and bands are
/// Student's.
///
/// # Errors
/// Those of the problems; noise that cannot be told from so few values.
pub fn estimate(problems: &mut [Problem], ask: &Ask) -> Result<Estimate> {
    let rank = match ask.smoothing {
        Smoothing::Off => 0,
        _ => rank(ask.differences),
    };
    let mut weight = match ask.smoothing {
        Smoothing::Fixed(deviation) => 1.0 / deviation,
        // begins weak, so that the data are heard first
        _ => 1.0,
    };
    let chosen = rank > 0 && matches!(ask.smoothing, Smoothing::Likelihood | Smoothing::Discrepancy);
    if !ask.noise_known && ask.smoothing == Smoothing::Discrepancy {
        let what = "--smoothing discrepancy leaves the pressures their noise, which must be known: give its deviation, --noise PA";
        return Err(Error::Usage(what.into()));
    }
    let before = |weight: f64| match rank {
        0 => DMatrix::zeros(0, ask.differences.ncols()),
        _ => ask.differences * weight,
    };
    let mut states: Vec<State> = problems.iter().map(State::of).collect();
    // where loads alone could follow every pressure, a weight chosen by the data would take their noise for nothing
    let alone = |state: &State| state.measured.len() - Seen::of(&state.weighted()).values.len();
    if !ask.noise_known && chosen && states.iter().map(alone).sum::<usize>() == 0 {
        return Err(few(&states));
    }
    let most = heaviest(states.iter().map(State::weighted), ask.differences);
    weight = weight.min(most);
    let mut noise = 1.0;
    for round in 0..ROUNDS {
        let mut posteriors = vec![];
        for (problem, state) in problems.iter_mut().zip(&mut states) {
            // a fixed deviation is one of the amplitudes themselves, not of their share of the noise
            let own = match ask.smoothing {
                Smoothing::Fixed(_) => weight * noise,
                _ => weight,
            };
            let found = state.descend(problem, &before(own));
            posteriors.push(found.map_err(|error| problem.named(error))?);
        }
        let sums = Sums::of(&posteriors, rank, &states);
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
        let linear: Vec<Linear> = states.iter().map(State::linear).collect();
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
    let sums = Sums::of(&posteriors, rank, &states);
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
    let found = states.into_iter().zip(posteriors).map(|(state, posterior)| Found {
        seen: Seen::of(&stacked(&state.weighted(), &before(own))),
        mean: state.at,
        covariance: posterior.spread * (noise * noise),
        predicted: state.values,
        jacobian: state.jacobian,
        runs: state.runs,
        settled: state.settled,
    });
    Ok(Estimate {
        found: found.collect(),
        noise,
        widened: misfit.beyond_chance().filter(|_| ask.noise_known).unwrap_or(1.0),
        misfit,
        quantile: match ask.noise_known {
            true => normal::quantile(0.975),
            false => student::quantile(0.05, sums.freedom),
        },
        deviation_of_differences: (rank > 0).then(|| noise / own),
    })
}

/// Differences that do not follow from the others.
fn rank(differences: &DMatrix<f64>) -> usize {
    match differences.is_empty() {
        true => 0,
        false => Seen::of(differences).values.len(),
    }
}

/// The rows of both, each of size 1.
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
        "{values} tell no more than the loads, and nothing is left to tell the noise by; give its deviation, --noise PA, or look for fewer loads"
    ))
}

/// What problems add up to.
struct Sums {
    misfit: f64,
    rough: f64,
    freedom: f64,
}

impl Sums {
    fn left(&self) -> f64 {
        self.misfit + self.rough
    }

    fn of(posteriors: &[Posterior], rank: usize, states: &[State]) -> Self {
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

/// Where the iteration of a problem stands.
struct State {
    at: DVector<f64>,
    values: DVector<f64>,
    jacobian: DMatrix<f64>,
    /// Values that were measured: place, measurement, deviation.
    measured: Vec<(usize, f64, f64)>,
    runs: u32,
    settled: bool,
}

impl State {
    fn of(problem: &Problem) -> Self {
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

    /// What is left of the measurements, over their deviations.
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

    /// The problem, linear about where it stands.
    fn linear(&self) -> Linear {
        let jacobian = self.weighted();
        let right = self.residual(&self.values) + &jacobian * &self.at;
        Linear::new(jacobian, right)
    }

    /// Goes on to the minimum.
    fn descend(&mut self, problem: &mut Problem, before: &DMatrix<f64>) -> Result<Posterior> {
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
                // no step makes it better: it is as good as round-off lets it be
                None => return Ok(posterior),
            }
        }
        self.settled = false;
        Ok(self.linear().posterior(before))
    }
}
