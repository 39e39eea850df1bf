//! Estimates time-dependent loads from pressures, with inertia and flow.
//!
//! A load is a natural cubic spline. Its values at the knots are estimated like amplitudes of loads at rest:
//!
//! ```text
//! a = argmin Σ ((p(t_i) - p(t_i; a))/σ)² + |R a|²/τ²        R: second differences of each load in time
//! ```
//!
//! Among all curves through given values, the spline has the least integral of the squared second derivative. With many knots, the estimate
//! is the posterior mean of a load whose prior is an integrated Wiener process (Wahba, J. R. Stat. Soc. B 40, 364, 1978).

use nalgebra::{DMatrix, DVector};

use super::basis::{self, Amplitude};
use super::diagnostics::{self, PressureResidual, alone, banded, doubts, left};
use super::estimate::{
    Amplitudes, EstimateOptions, ForwardModel as _, LoadEstimates, SenseProblem, Smoothing, estimate,
};
use super::estimate_at_rest::{SenseOptions, differences as along_the_beam, unobservable};
use super::in_time::{InTime, Knots};
use super::observability::{over_sizes, sight};
use super::pressures::PressureTable;
use super::pressures_at_rest::{labels, probed};
use super::sensed::{BandKind, MeasurementRow, OverTime, Sensed, Smoothed};
use crate::case::schema::Case;
use crate::error::numbers::counted;
use crate::error::{Code, Error, Result};
use crate::model::characteristic;
use crate::numerics::bayesian_least_squares::{Observability, second_differences};
use crate::run::early_warnings;

/// Largest number of knots at which a warning still suggests more.
const MOST: usize = 200;
/// Default number of knots, at most.
const USUAL: usize = 41;
/// Largest number of amplitudes of all loads at all knots; each is a sensitivity parameter of every run.
const ALL: usize = 400;
/// Part of the knot values determined by the pressures above which the number of knots may be too small.
const ALL_DETERMINED: f64 = 0.9;
/// Correlation, in standard errors, above which residuals are not white noise.
const UNLIKELY: f64 = 4.0;

/// Estimates loads over time from measured pressures.
///
/// # Errors
/// [`Error::Usage`] without instants, with too few of them, with instants after the end of the run, or for too many knots; errors of the
/// runs.
pub(super) fn find(
    case: &Case,
    measured: &PressureTable,
    asked: &SenseOptions,
    knots: Option<usize>,
    stop: &dyn Fn() -> bool,
) -> Result<Sensed> {
    let loads = asked.loads(case);
    let amplitudes = basis::amplitudes(case, &loads)?;
    let instants = instants(case, measured)?;
    let knots = Knots::new(
        knot_count(knots, instants.len(), amplitudes.len())?,
        instants[instants.len() - 1],
    );
    let (probed, names) = probed(case)?;
    let all = labels(case);
    let names: Vec<String> = measured.bladders.iter().map(|b| names[*b].clone()).collect();
    let mut model = InTime::new(&probed, names, &amplitudes, &knots, &instants, stop)?;
    let zeros = vec![0.0; knots.at.len() * amplitudes.len()];
    let first = model.at(&zeros)?;
    let mut found = Sensed {
        case: case.name.clone(),
        loads,
        bladders: measured.bladders.iter().map(|b| all[*b]).collect(),
        band: match asked.smoothing {
            Smoothing::Off => BandKind::AssumedForm,
            _ => BandKind::SmoothInTime,
        },
        ..Sensed::default()
    };
    let lasting = constant(&first.1, amplitudes.len());
    if Observability::from_matrix(&lasting).values.is_empty() {
        return Err(unobservable());
    }
    sight(&mut found, &amplitudes, &lasting);
    let differences = differences(&amplitudes, &found, knots.at.len());
    let deviation = (0..instants.len()).flat_map(|row| match &measured.deviations {
        Some(all) => all[row].clone(),
        None => vec![asked.noise_pa.unwrap_or(1.0); measured.bladders.len()],
    });
    let system = model.system(&model.loaded(&zeros))?;
    let warnings = early_warnings::lasting(case, &system, &characteristic::numbers(case, &system.model));
    let mut problems = [SenseProblem {
        line: None,
        forward: Box::new(model),
        data: measured.rows.iter().flatten().copied().collect(),
        deviation: deviation.collect(),
        start: DVector::zeros(zeros.len()),
        first,
    }];
    let ask = EstimateOptions {
        differences: &differences,
        smoothing: asked.smoothing,
        noise_known: measured.deviations.is_some() || asked.noise_pa.is_some(),
    };
    let estimate = estimate(&mut problems, &ask)?;
    let one = &estimate.found[0];
    sight(&mut found, &amplitudes, &constant(&one.jacobian, amplitudes.len()));
    found.rows = rows(&found, measured, (&knots, &amplitudes), &estimate);
    found.noise = Some(diagnostics::noise(asked, measured, &estimate));
    found.smoothing = estimate.deviation_of_differences.map(|_| Smoothed {
        by: asked.smoothing,
        deviation_n_m: None,
        load_deviation_n_m: None,
    });
    let left: Vec<PressureResidual> = left(&problems[0], one, &measured.bladders).collect();
    let correlation = correlation(&left);
    found.over_time = Some(OverTime {
        knots: knots.at.len(),
        every_s: knots.every(),
        determined: resolved(one, &problems[0], &estimate, amplitudes.len()),
        correlation,
        runs: one.runs,
    });
    found.warnings = warnings;
    found.doubts = doubts(&found, &left, all.len(), &estimate);
    let coloured = coloured(&found, correlation, left.len(), knots.at.len());
    found.warnings.extend(found.doubts.clone());
    found.warnings.extend(coloured);
    if let Some(over_time) = &found.over_time {
        let fast = fast(&found, over_time, instants.len());
        found.warnings.extend(fast);
    }
    if !one.settled {
        found.warnings.push(Code::UnexplainedPressures.warning(format!(
            "the search ended before it converged, after {}. The reported loads are not the best fit. Use fewer \
             knots, or more smoothing",
            counted(u64::from(one.runs), "run")
        )));
    }
    Ok(found)
}

/// Instants of the measurements within the run [s].
fn instants(case: &Case, measured: &PressureTable) -> Result<Vec<f64>> {
    let usage = |what: String| Error::Usage(format!("--dynamic: {what}"));
    let Some(times) = &measured.times else {
        return Err(usage(
            "the measurements have no times. Add a column t_s, with times from the start of the run".into(),
        ));
    };
    if times.len() < Knots::FEWEST {
        return Err(usage(format!(
            "{}: too few to estimate a load over time (at least {})",
            counted(times.len() as u64, "instant"),
            Knots::FEWEST
        )));
    }
    let end = case.time.end_s;
    if let Some(late) = times.iter().position(|t| *t > end * (1.0 + 1e-12)) {
        return Err(usage(format!(
            "line {}: {} s is after the end of the run at {end} s. Extend the run with --set /time/end_s={}",
            measured.lines[late],
            times[late],
            times[times.len() - 1]
        )));
    }
    Ok(times.iter().map(|t| t.min(end)).collect())
}

fn knot_count(asked: Option<usize>, rows: usize, loads: usize) -> Result<usize> {
    let room = ALL / loads;
    let count = asked.unwrap_or(USUAL.min(rows).min(room));
    if count > room {
        return Err(Error::Usage(format!(
            "--knots {count}: {} have {} values at that many knots (limit {ALL}). Use at most {room} knots, or fewer \
             loads",
            counted(loads as u64, "load"),
            count * loads
        )));
    }
    if count > rows {
        return Err(Error::Usage(format!(
            "--knots {count}: the measurements have only {rows} instants and do not determine values between them. \
             Use at most {rows} knots"
        )));
    }
    match count >= Knots::FEWEST {
        true => Ok(count),
        false => Err(Error::Usage(format!(
            "--dynamic: {loads} loads are too many: each needs {} knots (limit {ALL} values in all)",
            Knots::FEWEST
        ))),
    }
}

/// Derivatives with respect to loads that are constant in time.
fn constant(jacobian: &DMatrix<f64>, loads: usize) -> DMatrix<f64> {
    DMatrix::from_fn(jacobian.nrows(), loads, |i, k| {
        (k..jacobian.ncols()).step_by(loads).map(|j| jacobian[(i, j)]).sum()
    })
}

/// Second differences of every load in time, and of a profile along the beam at every knot.
fn differences(amplitudes: &[Amplitude], found: &Sensed, knots: usize) -> DMatrix<f64> {
    let loads = amplitudes.len();
    let in_time = second_differences(knots).kronecker(&DMatrix::identity(loads, loads));
    let along = DMatrix::identity(knots, knots).kronecker(&along_the_beam(amplitudes, &found.loads));
    let mut all = DMatrix::zeros(in_time.nrows() + along.nrows(), knots * loads);
    all.rows_mut(0, in_time.nrows()).copy_from(&in_time);
    all.rows_mut(in_time.nrows(), along.nrows()).copy_from(&along);
    all
}

/// One row per instant: loads and sums of loads, evaluated on their splines.
fn rows(
    found: &Sensed,
    measured: &PressureTable,
    (knots, amplitudes): (&Knots, &[Amplitude]),
    estimate: &LoadEstimates,
) -> Vec<MeasurementRow> {
    let (one, loads, each) = (&estimate.found[0], amplitudes.len(), measured.bladders.len());
    let sums: Vec<Vec<f64>> = found
        .seen
        .together
        .iter()
        .map(|sum| over_sizes(sum, amplitudes))
        .collect();
    let times = measured.times.as_deref().unwrap_or_default();
    let row = |(k, t): (usize, &f64)| {
        let weights = knots.weights(*t);
        let of = |factors: &[f64]| {
            let whole = weights.iter().flat_map(|w| factors.iter().map(move |f| w * f));
            banded(estimate, one, &whole.collect::<Vec<_>>())
        };
        MeasurementRow {
            line: measured.lines[k],
            t_s: Some(*t),
            amplitudes: (0..loads).map(|j| of(&alone(amplitudes, j))).collect(),
            together: sums.iter().map(|sum| of(sum)).collect(),
            measured_pa: measured.rows[k].clone(),
            modelled_pa: one.predicted.as_slice()[k * each..(k + 1) * each].to_vec(),
        }
    };
    times.iter().enumerate().map(row).collect()
}

/// Number of knot values of each load that the data determine: its share of the trace of `cov a J^T J/σ^2`.
fn resolved(one: &Amplitudes, problem: &SenseProblem, estimate: &LoadEstimates, loads: usize) -> Vec<f64> {
    let measured: Vec<usize> = (0..problem.data.len()).filter(|k| problem.data[*k].is_some()).collect();
    let weighted = DMatrix::from_fn(measured.len(), one.jacobian.ncols(), |i, j| {
        one.jacobian[(measured[i], j)] / (problem.deviation[measured[i]] * estimate.noise)
    });
    let whole = &one.covariance * weighted.transpose() * weighted;
    let of = |k: usize| (k..whole.ncols()).step_by(loads).map(|j| whole[(j, j)]).sum();
    (0..loads).map(of).collect()
}

/// Lag-1 autocorrelation of the residuals of each pressure.
fn correlation(left: &[PressureResidual]) -> f64 {
    let (mut products, mut squares) = (0.0, 0.0);
    let mut last = std::collections::BTreeMap::new();
    for one in left {
        squares += one.over_noise.powi(2);
        if let Some(before) = last.insert(one.bladder, one.over_noise) {
            products += before * one.over_noise;
        }
    }
    products / squares.max(f64::MIN_POSITIVE)
}

/// Warns if the pressures determine nearly every knot value: the load may change faster than the spline.
fn fast(found: &Sensed, over_time: &OverTime, rows: usize) -> Option<String> {
    let pairs = found.amplitudes.iter().zip(&over_time.determined);
    let names = pairs.filter(|(_, determined)| **determined > ALL_DETERMINED * over_time.knots as f64);
    let names: Vec<&str> = names.map(|(a, _)| a.name.as_str()).collect();
    let remedy = match over_time.knots < rows.min(MOST) {
        true => "Use more knots (--knots)",
        false => "Measure at more instants",
    };
    (!names.is_empty()).then(|| {
        Code::FastLoad.warning(format!(
            "{}: the pressures determine nearly every value at the {} knots (one every {:.3e} s). A faster change of \
             the load is not visible, and bands are valid only without it. {remedy}",
            names.join(", "),
            over_time.knots,
            over_time.every_s
        ))
    })
}

/// Warns if residuals are autocorrelated in time.
fn coloured(found: &Sensed, correlation: f64, count: usize, knots: usize) -> Option<String> {
    (correlation * (count as f64).sqrt() > UNLIKELY).then(|| {
        Code::UnexplainedPressures.warning(format!(
            "the residuals of {} with {knots} knots are correlated in time (lag-1 correlation {correlation:.2}): the \
             load changes faster than the knots resolve, the model has an error, or the noise is correlated. Bands \
             are too narrow. Use more knots (--knots)",
            diagnostics::names(found)
        ))
    })
}
