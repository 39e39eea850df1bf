//! Figures of one design, and their derivatives with respect to the optimized numbers.

use std::time::Instant;

use super::outcome::DerivativeSource;
use super::problem::OptimizationProblem;
use crate::case::Case;
use crate::case::parameter::{Parameter, STEPS, change};
use crate::error::{Error, Result};
use crate::run::dynamics::{self, Outcome};
use crate::run::record::FiguresAlone;
use crate::run::summary::Status;
use crate::study::analysis::AnalysisOutcome;
use crate::study::analysis::derivatives;
use crate::study::analysis::{self, AnalysisRequest};
use crate::study::search_bounds;

/// Change of a position between the bounds in a difference, to either side.
const BESIDE: f64 = 0.01;

/// Figures and derivatives of a design.
#[derive(Clone, Debug)]
pub struct EvaluatedDesign {
    /// Figures in the order of [`Problem::figures`].
    pub figures: Vec<f64>,
    /// Derivatives of each figure with respect to positions between the bounds.
    pub slopes: Vec<Vec<f64>>,
    /// Source of the derivatives.
    pub from: DerivativeSource,
}

/// Callback after each design: values of the numbers, figures or the reason of a failure, wall time [s].
pub type ReportDesign<'a> = dyn Fn(&[f64], &std::result::Result<Vec<f64>, String>, f64) + 'a;

/// Evaluates a position between the bounds; `report` is called after every design that is computed.
///
/// # Errors
/// Reason of the failure, as text.
pub fn look(
    problem: &OptimizationProblem,
    places: &[f64],
    stop: &dyn Fn() -> bool,
    report: &ReportDesign<'_>,
) -> std::result::Result<EvaluatedDesign, String> {
    let mut known = None;
    if let Some(found) = exactly(problem, places, stop, report) {
        match found? {
            (_, Some(seen)) => return Ok(seen),
            (figures, None) => known = Some(figures),
        }
    }
    let plain = |places: &[f64]| {
        let begin = Instant::now();
        let values = search_bounds::values(&problem.spans, places);
        let figures = plain(problem, &values, stop);
        report(&values, &figures, begin.elapsed().as_secs_f64());
        figures
    };
    let figures = known.map_or_else(|| plain(places), Ok)?;
    let mut slopes = vec![vec![0.0; places.len()]; figures.len()];
    for k in 0..places.len() {
        let at = |place: f64| {
            let mut beside = places.to_vec();
            beside[k] = place.clamp(0.0, 1.0);
            Ok::<_, String>((beside[k], plain(&beside)?))
        };
        let (above, high) = at(places[k] + BESIDE)?;
        let (below, low) = at(places[k] - BESIDE)?;
        for (slopes, (high, low)) in slopes.iter_mut().zip(high.iter().zip(&low)) {
            slopes[k] = (high - low) / (above - below);
        }
    }
    Ok(EvaluatedDesign {
        figures,
        slopes,
        from: match places.is_empty() {
            true => DerivativeSource::Exact,
            false => DerivativeSource::Differences,
        },
    })
}

/// Figures of a design, with derivatives if exact ones are available.
type Exactly = std::result::Result<(Vec<f64>, Option<EvaluatedDesign>), String>;

/// Evaluates a position with exact derivatives; `None` if these are not available.
fn exactly(
    problem: &OptimizationProblem,
    places: &[f64],
    stop: &dyn Fn() -> bool,
    report: &ReportDesign<'_>,
) -> Option<Exactly> {
    let begin = Instant::now();
    let values = search_bounds::values(&problem.spans, places);
    if problem.differences.is_some() || places.is_empty() || at_an_end(problem, &values) {
        return None;
    }
    let (figures, slopes) = match exact(problem, &values, stop)? {
        Ok((figures, slopes)) => (Ok(figures), slopes),
        Err(reason) => (Err(reason), None),
    };
    report(&values, &figures, begin.elapsed().as_secs_f64());
    Some(figures.map(|figures| {
        let seen = slopes.map(|mut slopes| {
            for row in &mut slopes {
                for (k, slope) in row.iter_mut().enumerate() {
                    *slope *= problem.spans[k].slope(values[k]);
                }
            }
            EvaluatedDesign {
                figures: figures.clone(),
                slopes,
                from: DerivativeSource::Exact,
            }
        });
        (figures, seen)
    }))
}

/// True if a number is so close to the end of its valid range that the steps of its derivatives lie outside.
fn at_an_end(problem: &OptimizationProblem, values: &[f64]) -> bool {
    let Ok(case) = problem.with(values) else { return false };
    let beyond = |one: &Parameter| {
        let to = |(step, _): &(f64, f64)| one.changed(&case, one.value * (1.0 + step * change(&case))).is_err();
        STEPS.iter().any(to)
    };
    problem.parameters(values).iter().any(beyond)
}

/// Figures, with their derivatives per unit of the numbers if every figure has these.
type Exact = (Vec<f64>, Option<Vec<Vec<f64>>>);

/// Returns figures with exact derivatives; `None` if derivatives with respect to one of the numbers are rejected, so
/// that differences are used.
fn exact(
    problem: &OptimizationProblem,
    values: &[f64],
    stop: &dyn Fn() -> bool,
) -> Option<std::result::Result<Exact, String>> {
    let compute = || differentiated(problem, values, stop);
    problem.evaluations.get(&("exact", values), stop, compute)
}

fn differentiated(
    problem: &OptimizationProblem,
    values: &[f64],
    stop: &dyn Fn() -> bool,
) -> Option<std::result::Result<Exact, String>> {
    let found = problem.with(values).and_then(|case| {
        let parameters = problem.parameters(values);
        problem
            .what
            .analysis()
            .derivatives(&case, &parameters, problem.system.as_ref(), stop)
    });
    let (found, slopes) = match found {
        Ok(found) => found,
        Err(Error::Usage(_) | Error::Interrupted(_)) => return None,
        Err(error) => return Some(Err(why(&error))),
    };
    let figures = match wanted(problem, &found) {
        Ok(figures) => figures,
        Err(reason) => return Some(Err(reason)),
    };
    // derivatives of a root mean square are those of its samples, not of the integral that is reported
    let own = |name: &&str| !name.ends_with("window_rms");
    let all = problem
        .figures()
        .into_iter()
        .map(|name| slopes.get(name).filter(|_| own(&name)).cloned());
    Some(Ok((figures, all.collect())))
}

/// Figures of a design from the plain command.
fn plain(
    problem: &OptimizationProblem,
    values: &[f64],
    stop: &dyn Fn() -> bool,
) -> std::result::Result<Vec<f64>, String> {
    let compute = || computed(problem, values, stop);
    problem.evaluations.get(&("plain", values), stop, compute)
}

fn computed(
    problem: &OptimizationProblem,
    values: &[f64],
    stop: &dyn Fn() -> bool,
) -> std::result::Result<Vec<f64>, String> {
    let case = problem.with(values).map_err(|error| why(&error))?;
    let ask = AnalysisRequest {
        what: &problem.what,
        accuracy: None,
        from: None,
        meshes: false,
        waves: false,
    };
    let run = |case: &Case| run(problem, case, stop);
    let found = analysis::found(&case, ask, stop, &run).ok_or("interrupted")?;
    wanted(problem, &found)
}

fn run(problem: &OptimizationProblem, case: &Case, stop: &dyn Fn() -> bool) -> Result<Outcome> {
    let system = derivatives::alike_or_own(case, problem.system.as_ref())?;
    dynamics::run_with(case, system, &[], &mut FiguresAlone(derivatives::until(stop)))
}

/// Selects the figures of goal and limits from the result of a design.
fn wanted(problem: &OptimizationProblem, found: &AnalysisOutcome) -> std::result::Result<Vec<f64>, String> {
    if found.status != Status::Finished {
        return Err(found.reason.clone().unwrap_or_else(|| "the run did not finish".into()));
    }
    let absence = || problem.what.absence();
    let of = |name: &str| {
        let figure = found.figure(name);
        figure.ok_or_else(|| format!("the result has no {name}{}", absence()))
    };
    problem.figures().into_iter().map(of).collect()
}

fn why(error: &Error) -> String {
    AnalysisOutcome::failed(error).reason.unwrap_or_default()
}
