//! Fit of numbers of a case to measured data: bounded nonlinear least squares with exact derivatives, errors and
//! identifiability.
//!
//! ```text
//! abscissa         rows of the data: instants, driven numbers, frequencies
//! problem          case, numbers to be fitted, measured values; rejects inconsistent input
//! simulate         simulated value for each measured one, with derivatives
//! robust           loss functions, and estimates of noise that is not given
//! search           search from the starts to the minimum
//! identifiability  directions that the data do not determine
//! statistics       errors and intervals
//! outcome          the result
//! comparison       comparison of an existing run with data
//! ```

pub mod abscissa;
pub mod comparison;
pub mod identifiability;
pub mod outcome;
pub mod problem;
pub mod robust;
mod search;
mod simulate;
pub mod statistics;

use std::time::Instant;

use nalgebra::{DMatrix, DVector};

use crate::case::Case;
use crate::error::{Code, Result};
use crate::numerics::levenberg::{self, LevenbergStatus, ResidualEvaluation};
use crate::study::analysis::{self, AnalysisRequest};
use crate::study::data::DataTable;
use crate::study::search_bounds::ParameterBounds;
use abscissa::{Abscissa, DrivenNumber, FitAnalysis};
use identifiability::{IdentificationInput, unseen};
use outcome::{Bound, ColumnResiduals, Fit, FittedColumn, FittedNumber, SimulatorError};
use problem::{FitProblem, FitRequest};
use search::{FitOutcome, FitSearch};
use statistics::CovarianceInput;

/// Relative error of the derivatives of equilibria.
const EXACT: f64 = 1e-8;
/// Relative error of IDA's sensitivities, in multiples of its tolerance.
const CARRIED: f64 = 10.0;
/// Deviation of chi-square from its mean, in standard deviations, above which the fit warns.
const UNLIKELY: f64 = 3.0;
/// Correlation of successive residuals, in standard deviations, above which the fit warns.
const TOGETHER: f64 = 2.5;

/// Fit, with the additional data of its files.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The result.
    pub fit: Fit,
    /// The case with the estimates.
    pub case: crate::case::Case,
    /// Simulated value for each observation.
    pub model: Vec<f64>,
    /// Weight of each observation: the inverse of its variance, times the weight of its loss.
    pub weights: Vec<f64>,
}

/// Headings of the columns that the fit does not use: neither matched, nor time, nor set by rows, nor noise of a
/// matched column.
pub fn left_alone(table: &DataTable, asked: &FitRequest) -> Vec<String> {
    let matched = asked.matches.iter().filter_map(|one| table.find(&one.column));
    let noise = matched.clone().filter_map(|k| table.deviation(k));
    let driven = asked.drives.iter().filter_map(|drive| table.find(&drive.column));
    let along = match asked.through() {
        FitAnalysis::Run => table.time(asked.time.as_deref()).ok(),
        FitAnalysis::Equilibrium => None,
        FitAnalysis::Response => table.frequency().ok(),
    };
    let used: Vec<usize> = matched.chain(noise).chain(driven).chain(along).collect();
    let all = table.columns.iter().enumerate();
    all.filter(|(k, _)| !used.contains(k))
        .map(|(_, one)| one.heading.clone())
        .collect()
}

/// Runs a fit. `report` is called after every simulation with their number and the sum of squares. If `stop` becomes
/// true, the result is the best so far and is marked as interrupted.
///
/// # Errors
/// The case cannot be simulated at any start.
pub fn fit(
    problem: &FitProblem,
    asked: &FitRequest,
    data: (&str, u32),
    stop: &(dyn Fn() -> bool + Sync),
    report: &(dyn Fn(usize, f64) + Sync),
) -> Result<Fitted> {
    let begin = Instant::now();
    let search = FitSearch::new(problem, asked, stop, report);
    let reached = search.go()?;
    let interrupted = stop();
    let (values, count) = (&reached.values, problem.observations.len());
    let case = problem.with(values)?;
    let free = levenberg::free(&reached.minimum.x, &reached.minimum.at);
    let (residuals, jacobian) = reached.plain(problem);
    let freedom = count.saturating_sub(free.len()) as f64;
    let known = reached.given.iter().all(|given| *given);
    let plain = asked.loss == robust::LossFunction::Squares;
    let variance = match (plain, known) {
        (true, true) => 1.0,
        (true, false) => residuals.norm_squared() / freedom.max(1.0),
        (false, _) => asked.loss.variance(residuals.as_slice(), free.len()),
    };
    let exact = match problem.through() {
        FitAnalysis::Run => CARRIED * problem.case.solver.rtol,
        FitAnalysis::Equilibrium | FitAnalysis::Response => EXACT,
    };
    let blind = unseen(&IdentificationInput {
        spans: &problem.spans,
        values,
        jacobian: &jacobian,
        spread: variance.sqrt(),
        exact,
    });
    let basis = CovarianceInput {
        spans: &problem.spans,
        values,
        free: &free,
        unseen: &blind,
        jacobian: &jacobian,
        variance,
        freedom: (!known || !plain).then_some(freedom),
    };
    let errors = basis.errors();
    let (finer, moved) = finer(problem, &reached, asked.jobs, &free, stop);
    let estimate = |k: usize| {
        let span: &ParameterBounds = &problem.spans[k];
        FittedNumber {
            pointer: span.pointer.clone(),
            low: span.low,
            high: span.high,
            logarithmic: span.logarithmic(),
            start: problem.start[k],
            value: values[k],
            standard_error: errors.standard[k],
            interval_95: errors.intervals[k],
            at_bound: bound(reached.minimum.x[k], free.contains(&k)),
            finer_change: moved.as_ref().map(|moved| moved[k]),
        }
    };
    let parameters: Vec<FittedNumber> = (0..values.len()).map(estimate).collect();
    let columns = columns(problem, &reached);
    let mut fit = Fit {
        case: problem.case.name.clone(),
        data: data.0.into(),
        data_crc32: data.1,
        command: problem.through(),
        input: asked.input.clone(),
        drives: match &problem.abscissa {
            Abscissa::Time(_) | Abscissa::Frequencies(..) => vec![],
            Abscissa::Drives(drives) => drives
                .iter()
                .map(|(drive, _): &(DrivenNumber, _)| drive.clone())
                .collect(),
        },
        found: reached.minimum.ended != LevenbergStatus::Unfinished && !interrupted,
        interrupted,
        parameters,
        covariance: errors.covariance,
        correlation: errors.correlation,
        columns,
        observations: count,
        chi_square: reached.minimum.at.cost(),
        degrees_of_freedom: freedom,
        loss: asked.loss,
        unseen: blind.into_iter().map(|one| one.words).collect(),
        warnings: vec![],
        simulator: finer,
        left_alone: vec![],
        starts: reached.starts.clone(),
        steps: reached.steps,
        simulations: search.simulations(),
        wall_s: 0.0,
    };
    fit.warnings = warnings(&fit, reached.minimum.ended, known && plain);
    fit.warnings.extend(of_the_model(problem, &case, stop));
    if stop() && !fit.interrupted {
        fit.interrupted = true;
        fit.warnings.push(Code::Fit.warning(
            "interrupted after the search: the minimum is found, but its check on a finer mesh and by the plain \
             command may be missing",
        ));
    }
    fit.wall_s = begin.elapsed().as_secs_f64();
    let weights = reached.weights.iter().zip(&reached.sigmas);
    let weights = weights.map(|(weight, sigma)| weight / sigma.powi(2)).collect();
    Ok(Fitted {
        fit,
        case,
        model: reached.simulated.values,
        weights,
    })
}

fn bound(place: f64, free: bool) -> Option<Bound> {
    match place {
        _ if free => None,
        x if x <= 0.0 => Some(Bound::Low),
        _ => Some(Bound::High),
    }
}

/// Deviations of each column.
fn columns(problem: &FitProblem, reached: &FitOutcome) -> Vec<FittedColumn> {
    let of = |(k, one): (usize, &crate::study::data::Matched)| {
        let model: Vec<f64> = problem
            .observations(k)
            .map(|(i, _)| reached.simulated.values[i])
            .collect();
        let data: Vec<f64> = problem.observations(k).map(|(_, one)| one.value).collect();
        FittedColumn {
            matched: one.asked.clone(),
            quantity: one.key(),
            left: ColumnResiduals::compare(&model, &data),
            noise: problem.observations(k).map(|(i, _)| reached.sigmas[i]).sum::<f64>() / data.len().max(1) as f64,
            noise_given: reached.given[k],
        }
    };
    problem.matched.iter().enumerate().map(of).collect()
}

/// Change of the estimates on a finer mesh with a tenth of the tolerance: one Gauss-Newton step from the change of the
/// simulated values.
fn finer(
    problem: &FitProblem,
    reached: &FitOutcome,
    jobs: usize,
    free: &[usize],
    stop: &(dyn Fn() -> bool + Sync),
) -> (SimulatorError, Option<Vec<f64>>) {
    let mut other = problem.clone();
    other.evaluations = problem.evaluations.scoped("finer");
    other.case.mesh.cells_per_segment *= 2;
    let mut with = vec![format!("{} cells a segment", other.case.mesh.cells_per_segment)];
    if other.case.bladders.is_some() {
        other.case.mesh.cells_per_bladder *= 2;
        with.push(format!("{} a bladder", other.case.mesh.cells_per_bladder));
    }
    if problem.through() == FitAnalysis::Run {
        other.case.solver.rtol = (problem.case.solver.rtol / 10.0).max(1e-12);
        with.push(format!("rtol {:.1e}", other.case.solver.rtol));
    }
    let finer = with.join(", ");
    match simulate::simulate(&other, &reached.values, jobs, stop) {
        Err(error) => {
            let unknown = Some(error.to_string());
            (SimulatorError { finer, unknown }, None)
        }
        Ok(there) => {
            let here = &reached.simulated.values;
            let scale = |i: usize| reached.weights[i].sqrt() / reached.sigmas[i];
            let change = DVector::from_fn(here.len(), |i, _| scale(i) * (there.values[i] - here[i]));
            let jacobian = reached.minimum.at.jacobian.select_columns(free);
            let step = levenberg::newton(&jacobian, &change);
            let mut moved = vec![0.0; problem.spans.len()];
            for (k, d) in free.iter().zip(step.iter()) {
                moved[*k] = d * problem.spans[*k].slope(reached.values[*k]);
            }
            (SimulatorError { finer, unknown: None }, Some(moved))
        }
    }
}

fn warnings(fit: &Fit, ended: LevenbergStatus, known: bool) -> Vec<String> {
    let mut all = vec![];
    let mut say = |what: String| all.push(Code::Fit.warning(what));
    match ended {
        _ if fit.interrupted => say("interrupted. Estimates and errors are those of the best fit so far".into()),
        LevenbergStatus::Found => {}
        LevenbergStatus::Unfinished => say(
            "the search reached its limit of steps before it converged. Estimates are those of the last step. Use \
             them as starting values of another fit (--set)"
                .into(),
        ),
        LevenbergStatus::Stuck => say(
            "the search ended early: no step reduces the sum of squares, although its derivatives predict a \
             reduction. The numerical error exceeds the remaining reduction. Use a smaller /solver/rtol"
                .into(),
        ),
    }
    for one in &fit.unseen {
        say(one.clone());
    }
    for one in &fit.parameters {
        let bound = match one.at_bound {
            None => continue,
            Some(Bound::Low) => format!("its lower bound {}", one.low),
            Some(Bound::High) => format!("its upper bound {}", one.high),
        };
        say(format!(
            "{} lies at {bound}: the best fit is beyond it. Its error is not available. Widen this bound if the case \
             allows it",
            one.pointer
        ));
    }
    let (chi, n) = (fit.chi_square, fit.degrees_of_freedom);
    if known && n > 0.0 && (chi - n).abs() > UNLIKELY * (2.0 * n).sqrt() {
        let what = match chi > n {
            true => {
                "the model does not fit the data within the given noise, or the given noise is too small. The \
                 reported errors are too small"
            }
            false => "the residuals are smaller than the given noise. The given noise is probably too large",
        };
        say(format!(
            "chi-square over degrees of freedom is {:.3} (1 expected): {what}",
            chi / n
        ));
    }
    for column in &fit.columns {
        let ColumnResiduals { count, lag_1, .. } = column.left;
        if count >= 8 && lag_1 * (count as f64).sqrt() > TOGETHER {
            let wider = ((1.0 + lag_1) / (1.0 - lag_1)).sqrt();
            say(format!(
                "the residuals of {} are correlated from row to row (lag-1 correlation {lag_1:.2}): the model has a \
                 systematic error, or the noise is correlated. Errors may be {wider:.1} times as large",
                column.matched.column
            ));
        }
    }
    for one in &fit.parameters {
        if let (Some(change), Some(error)) = (one.finer_change, one.standard_error)
            && change.abs() > 0.5 * error
        {
            say(format!(
                "{} changes by {change:.2e} ({:.1} standard errors) with {}: mesh or tolerance are too coarse for \
                 these data",
                one.pointer,
                change.abs() / error,
                fit.simulator.finer
            ));
        }
    }
    if let Some(why) = &fit.simulator.unknown {
        say(format!(
            "the effect of mesh and tolerance on the estimates is unknown: {why}"
        ));
    }
    all
}

/// Warnings of the plain command at the estimates.
fn of_the_model(problem: &FitProblem, case: &Case, stop: &(dyn Fn() -> bool + Sync)) -> Vec<String> {
    if stop() {
        return vec![];
    }
    let ask = AnalysisRequest {
        what: &problem.analysis(),
        accuracy: None,
        from: None,
        meshes: true,
        waves: true,
    };
    let found = || analysis::found(case, ask, stop, &|case| analysis::run(case, ask, stop));
    let found = analysis::stored(&problem.evaluations, &"check", stop, found);
    found.map_or(vec![], |found| found.messages)
}

/// Residuals and derivatives over the standard deviations, as the search needs them.
fn evaluation(model: &simulate::Simulated, problem: &FitProblem, values: &[f64], scale: &[f64]) -> ResidualEvaluation {
    let all = &problem.observations;
    let slope: Vec<f64> = problem
        .spans
        .iter()
        .zip(values)
        .map(|(span, value)| span.slope(*value))
        .collect();
    ResidualEvaluation {
        residuals: DVector::from_fn(all.len(), |i, _| scale[i] * (model.values[i] - all[i].value)),
        jacobian: DMatrix::from_fn(all.len(), values.len(), |i, k| {
            scale[i] * model.slopes[(i, k)] * slope[k]
        }),
    }
}
