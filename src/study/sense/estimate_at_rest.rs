//! Estimates loads from pressures measured at rest.

use nalgebra::{DMatrix, DVector};

use super::basis::{self, Amplitude, Basis};
use super::choose::{self, Criterion};
use super::diagnostics::{self, PressureResidual, alone, banded, doubts, left};
use super::estimate::{
    Amplitudes, EstimateOptions, ForwardModel as _, LoadEstimates, SenseProblem, Smoothing, estimate,
};
use super::local_mean::{FineFound, FineLoad, local_band, local_means};
use super::observability::{over_sizes, sight};
use super::over_time;
use super::pressures::PressureTable;
use super::pressures_at_rest::{AtRest, labels, probed};
use super::sensed::{BandKind, Banded, ChosenSensors, MeasurementRow, Sensed, Smoothed};
use crate::case::schema::Case;
use crate::error::{Code, Error, Result};
use crate::numerics::bayesian_least_squares::{Observability, second_differences};
use crate::run::equilibrium::{self, EquilibriumOptions};
use crate::run::{early_warnings, slow_fluid};

/// Options of the estimate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SenseOptions {
    /// Loads to estimate; [`Basis::usual`] if empty.
    pub loads: Vec<Basis>,
    /// Standard deviation of the noise [Pa], if known.
    pub noise_pa: Option<f64>,
    /// Weight of the prior that a profile is smooth; a fixed deviation in N/m.
    pub smoothing: Smoothing,
    /// Instant [s] whose own loads of the case also act.
    pub at_s: f64,
    /// Options of loads that change during the measurement; none for pressures at rest.
    pub dynamic: Option<TimeDependentOptions>,
    /// Criterion of the best bladders to measure; none to skip that choice.
    pub choose: Option<Criterion>,
}

/// Options of time-dependent loads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TimeDependentOptions {
    /// Number of knots of each load curve; the usual number if none.
    pub knots: Option<usize>,
}

impl SenseOptions {
    /// Loads to estimate: the given ones or the usual ones.
    pub(super) fn loads(&self, case: &Case) -> Vec<Basis> {
        match self.loads.is_empty() {
            true => Basis::usual(case),
            false => self.loads.clone(),
        }
    }
}

/// Error that no measured pressure depends on the loads.
pub(super) fn unobservable() -> Error {
    let what = "the loads are not observable: no measured bladder responds to any of them. Such a bladder is at the \
                pressure of a port, is empty, or is joined with bladders whose volume changes by the opposite amount \
                (as in a pair under bending)";
    Error::Usage(what.into())
}

/// Amplitudes over their sizes below this count as zero load; their path is not checked.
const UNLOADED: f64 = 1e-12;

/// Relative difference of fitted pressures from those on the path from rest, above which a warning is given.
const SAME: f64 = 1e-6;

/// Estimates loads from measured pressures; without `measured`, only their observability. Checks `stop` before every state.
///
/// # Errors
/// [`Error::Usage`] for a case without pressures, loads that no pressure responds to, or noise that cannot be estimated; errors of states
/// that are not found.
pub fn find(
    case: &Case,
    measured: Option<&PressureTable>,
    asked: &SenseOptions,
    stop: &dyn Fn() -> bool,
) -> Result<Sensed> {
    if let (Some(dynamic), Some(measured)) = (&asked.dynamic, measured) {
        return over_time::find(case, measured, asked, dynamic.knots, stop);
    }
    let loads = asked.loads(case);
    let amplitudes = basis::amplitudes(case, &loads)?;
    let (probed, names) = probed(case)?;
    let options = EquilibriumOptions::at(asked.at_s);
    let mut model = AtRest::new(&probed, &names, &amplitudes, &options)?.until(stop);
    let zeros = vec![0.0; amplitudes.len()];
    let first = model.at(&zeros)?;
    let all = labels(case);
    let columns = measured.map_or_else(|| (0..all.len()).collect(), |measured| measured.bladders.clone());
    let own = first.1.select_rows(&columns);
    let seen = Observability::from_matrix(&own);
    // sensitivities for the choice of bladders: at the largest loads found, else at zero load
    let mut about = first.1.clone();
    let system = equilibrium::system(case, asked.at_s)?;
    let mut warnings = early_warnings::at_rest(case, &system);
    warnings.extend(slow_fluid::warning(case, &system, asked.at_s));
    warnings.extend(equilibrium::trapped(case, &options)?);
    let mut found = Sensed {
        case: case.name.clone(),
        data: None,
        left_alone: vec![],
        loads,
        loads_at_s: asked.at_s,
        own_loads: basis::own(case, asked.at_s),
        bladders: columns.iter().map(|b| all[*b]).collect(),
        ..Sensed::default()
    };
    if seen.values.is_empty() {
        return Err(unobservable());
    }
    sight(&mut found, &amplitudes, &own);
    if let Some(measured) = measured {
        let differences = differences(&amplitudes, &found.loads);
        let whole = whole(measured, &columns, all.len());
        let deviations = measured.deviations.as_deref();
        let mut problems: Vec<SenseProblem> = (0..measured.rows.len())
            .map(|row| {
                let mut deviation = vec![asked.noise_pa.unwrap_or(1.0); all.len()];
                for (place, own) in columns.iter().zip(deviations.map_or(&[][..], |all| &all[row])) {
                    deviation[*place] = *own;
                }
                SenseProblem {
                    line: measured.lines.get(row).copied(),
                    forward: Box::new(model.clone()),
                    data: whole[row].clone(),
                    deviation,
                    start: DVector::zeros(amplitudes.len()),
                    first: first.clone(),
                }
            })
            .collect();
        let ask = EstimateOptions {
            differences: &differences,
            smoothing: match asked.smoothing {
                Smoothing::Fixed(deviation) => Smoothing::Fixed(deviation / spread(&amplitudes)),
                other => other,
            },
            noise_known: deviations.is_some() || asked.noise_pa.is_some(),
        };
        let mut all_found = estimate(&mut problems, &ask)?;
        found.band = match (differences.nrows(), asked.smoothing) {
            (0, _) => BandKind::AssumedForm,
            _ => BandKind::AssumedSmoothness,
        };
        let fine = FineLoad::new(&found.loads).filter(|_| asked.smoothing == Smoothing::Likelihood);
        let fine_amplitudes = match &fine {
            Some(fine) => basis::amplitudes(case, &fine.loads)?,
            None => vec![],
        };
        let mut fine_model = match &fine {
            Some(_) => Some(AtRest::new(&probed, &names, &fine_amplitudes, &options)?.until(stop)),
            None => None,
        };
        let mut means: Vec<FineFound> = vec![];
        if let (Some(fine), Some(model)) = (&fine, &mut fine_model) {
            found.band = BandKind::LocalMean;
            means = local_means(&problems, &mut all_found, (fine, model), ask.noise_known)?;
        }
        // large deflection changes which combinations of amplitudes are observable
        if let Some((_, largest)) = largest(&all_found) {
            sight(&mut found, &amplitudes, &largest.jacobian.select_rows(&columns));
        }
        let combinations: Vec<Vec<f64>> = found
            .seen
            .together
            .iter()
            .map(|one| over_sizes(one, &amplitudes))
            .collect();
        let each = |row: usize| -> Vec<Option<Banded>> {
            match means.get(row) {
                Some(one) => (0..amplitudes.len())
                    .map(|k| local_band(&all_found, one, k, &amplitudes[k]))
                    .collect(),
                None => (0..amplitudes.len())
                    .map(|k| banded(&all_found, &all_found.found[row], &alone(&amplitudes, k)))
                    .collect(),
            }
        };
        // local means do not add up like amplitudes of a piecewise linear load, so sums have no bands here
        let sum =
            |one: &Amplitudes, factors: &Vec<f64>| means.is_empty().then(|| banded(&all_found, one, factors)).flatten();
        found.rows = measured
            .rows
            .iter()
            .enumerate()
            .zip(&all_found.found)
            .map(|((k, row), one)| MeasurementRow {
                line: measured.lines[k],
                t_s: measured.times.as_ref().map(|times| times[k]),
                amplitudes: each(k),
                together: combinations.iter().map(|factors| sum(one, factors)).collect(),
                measured_pa: row.clone(),
                modelled_pa: columns.iter().map(|b| one.predicted[*b]).collect(),
            })
            .collect();
        found.smoothing = all_found.deviation_of_differences.map(|deviation| Smoothed {
            by: asked.smoothing,
            deviation_n_m: means.is_empty().then(|| deviation * spread(&amplitudes)),
            load_deviation_n_m: means
                .iter()
                .map(|one| one.posterior.scale * spread(&amplitudes))
                .max_by(f64::total_cmp),
        });
        found.noise = Some(diagnostics::noise(asked, measured, &all_found));
        let places: Vec<usize> = (0..all.len()).collect();
        let rows = problems.iter().zip(&all_found.found);
        let left: Vec<PressureResidual> = rows.flat_map(|(problem, one)| left(problem, one, &places)).collect();
        found.doubts = doubts(&found, &left, all.len(), &all_found);
        warnings.extend(found.doubts.clone());
        if let Some((row, largest)) = largest(&all_found) {
            let line = measured.lines[row];
            warnings.extend(match (&fine_model, means.get(row)) {
                (Some(model), Some(one)) => aside(model, &one.amplitudes, &one.predicted, line)?,
                _ => aside(&model, &largest.mean, &largest.predicted, line)?,
            });
            about.clone_from(&largest.jacobian);
        }
    }
    if let Some(criterion) = asked.choose {
        let estimated = found.noise.as_ref().and_then(|noise| noise.sd_pa);
        found.choice_noise_pa = asked.noise_pa.or(estimated).unwrap_or(1.0);
        found.choice = chosen(&about, &all, &amplitudes, criterion, found.choice_noise_pa);
    }
    found.warnings = warnings;
    Ok(found)
}

/// Measurements padded to all bladders; `None` for a bladder that was not measured.
fn whole(measured: &PressureTable, columns: &[usize], count: usize) -> Vec<Vec<Option<f64>>> {
    let of = |row: &Vec<Option<f64>>| {
        let mut all = vec![None; count];
        for (place, value) in columns.iter().zip(row) {
            all[*place] = *value;
        }
        all
    };
    measured.rows.iter().map(of).collect()
}

/// Size of a transverse force per length; 1 without a profile.
fn spread(amplitudes: &[Amplitude]) -> f64 {
    let one = amplitudes.iter().find(|a| a.place.is_some() && a.unit == "N/m");
    one.map_or(1.0, |a| a.size)
}

/// Matrix of second differences of the amplitudes of a profile.
pub(super) fn differences(amplitudes: &[Amplitude], loads: &[Basis]) -> DMatrix<f64> {
    let of_profile = |a: &Amplitude| a.place.is_some() && a.unit == "N/m";
    let first = amplitudes.iter().position(of_profile).unwrap_or(0);
    let profile = loads.iter().find_map(|load| match load {
        Basis::Profile(places) => Some(*places),
        _ => None,
    });
    let own = second_differences(profile.unwrap_or(0));
    let mut all = DMatrix::zeros(own.nrows(), amplitudes.len());
    if own.nrows() > 0 {
        all.columns_mut(first, own.ncols()).copy_from(&own);
    }
    all
}

/// Row with the largest loads, and its estimate.
fn largest(estimate: &LoadEstimates) -> Option<(usize, &Amplitudes)> {
    let rows = estimate.found.iter().enumerate();
    rows.max_by(|(_, a), (_, b)| a.mean.norm().total_cmp(&b.mean.norm()))
}

/// Warns if the path from rest to the largest loads, found in line `line`, fails or ends at other pressures than the fit.
fn aside(model: &AtRest, loads: &DVector<f64>, predicted: &DVector<f64>, line: usize) -> Result<Vec<String>> {
    if loads.amax() < UNLOADED {
        return Ok(vec![]);
    }
    let (followed, mut warnings) = match model.followed(loads.as_slice()) {
        Ok(followed) => followed,
        Err(Error::Solver(fault)) => {
            return Ok(vec![Code::StateAside.warning(format!(
                "line {line} of the measurements: the estimated loads have no equilibrium on their path from rest: \
                 {}. Check the numbers of that line",
                fault.what
            ))]);
        }
        Err(other) => return Err(other),
    };
    if (&followed - predicted).norm() > SAME * followed.norm() {
        warnings.push(Code::StateAside.warning(
            "the estimated loads, increased from rest, give other pressures than the fit: the fit is on another \
             equilibrium branch",
        ));
    }
    Ok(warnings)
}

/// Best sets of bladders for noise of the given deviation.
fn chosen(
    jacobian: &DMatrix<f64>,
    all: &[i64],
    amplitudes: &[Amplitude],
    criterion: Criterion,
    noise: f64,
) -> Vec<ChosenSensors> {
    let none = DMatrix::zeros(0, amplitudes.len());
    let of = |choice: choose::SensorSet| ChosenSensors {
        errors: choice
            .errors
            .iter()
            .zip(amplitudes)
            .map(|(error, a)| error.map(|error| error * a.size * noise))
            .collect(),
        bladders: choice.sensors.iter().map(|b| all[*b]).collect(),
    };
    choose::choose(jacobian, &none, criterion).into_iter().map(of).collect()
}
