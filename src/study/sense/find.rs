//! Loads behind measured pressures at rest.

use nalgebra::{DMatrix, DVector};

use super::basis::{self, Amplitude, Basis};
use super::choose::{self, Criterion};
use super::estimate::{Ask, Estimate, Forward as _, Found, Problem, Smoothing, estimate};
use super::pressures::Measured;
use super::rest::{AtRest, labels, probed};
use super::sensed::{Banded, Chosen, Combination, Noise, NoiseFrom, Row, Sensed, Sight, Smoothed, Unknown};
use crate::case::schema::Case;
use crate::error::{Code, Error, Result};
use crate::numerics::inverse::{Linear, Seen, second_differences};
use crate::numerics::normal;
use crate::run::equilibrium::{self, Options};
use crate::run::known;

/// What is asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Asked {
    /// Loads; the usual ones where there are none.
    pub loads: Vec<Basis>,
    /// Deviation of the noise [Pa], where it is known.
    pub noise_pa: Option<f64>,
    /// What is made of it that a profile is smooth; a fixed deviation in N/m.
    pub smoothing: Smoothing,
    /// Instant whose own loads of the case act besides [s].
    pub at_s: f64,
    /// What the best bladders to measure are judged by, where they are asked for.
    pub choose: Option<Criterion>,
}

/// Chance of a sum of squares above which the model does not explain the data.
const UNLIKELY: f64 = 1e-3;
/// Share by which pressures may differ from those along the path from rest.
const SAME: f64 = 1e-6;

/// Looks for loads; `measured` none: what pressures would tell of them. `stop` is asked before every state.
///
/// # Errors
/// [`Error::Usage`]: a case without pressures, loads that act where nothing moves, a noise that cannot be told; states that are not found.
pub fn find(case: &Case, measured: Option<&Measured>, asked: &Asked, stop: &dyn Fn() -> bool) -> Result<Sensed> {
    let loads = match asked.loads.is_empty() {
        true => Basis::usual(case),
        false => asked.loads.clone(),
    };
    let amplitudes = basis::amplitudes(case, &loads)?;
    let (probed, names) = probed(case)?;
    let options = Options::at(asked.at_s);
    let mut model = AtRest::new(&probed, &names, &amplitudes, &options)?.until(stop);
    let zeros = vec![0.0; amplitudes.len()];
    let first = model.at(&zeros)?;
    let all = labels(case);
    let columns = measured.map_or_else(|| (0..all.len()).collect(), |measured| measured.bladders.clone());
    let own = first.1.select_rows(&columns);
    let seen = Seen::of(&own);
    // about which the best bladders are looked for: the largest loads that are found
    let mut about = first.1.clone();
    let mut warnings = known::at_rest(case, &equilibrium::system(case, asked.at_s)?);
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
        let what = "no bladder that is measured feels any of these loads, since at rest its pressure is that of a port, or it holds no fluid: nothing of \
                    them can be told";
        return Err(Error::Usage(what.into()));
    }
    sight(&mut found, &amplitudes, &own);
    if let Some(measured) = measured {
        let differences = differences(&amplitudes, &found.loads);
        let whole = whole(measured, &columns, all.len());
        let deviations = measured.deviations.as_deref();
        let mut problems: Vec<Problem> = (0..measured.rows.len())
            .map(|row| {
                let mut deviation = vec![asked.noise_pa.unwrap_or(1.0); all.len()];
                for (place, own) in columns.iter().zip(deviations.map_or(&[][..], |all| &all[row])) {
                    deviation[*place] = *own;
                }
                Problem {
                    forward: Box::new(model.clone()),
                    data: whole[row].clone(),
                    deviation,
                    start: DVector::zeros(amplitudes.len()),
                    first: first.clone(),
                }
            })
            .collect();
        let ask = Ask {
            differences: &differences,
            smoothing: match asked.smoothing {
                Smoothing::Fixed(deviation) => Smoothing::Fixed(deviation / spread(&amplitudes)),
                other => other,
            },
            noise_known: deviations.is_some() || asked.noise_pa.is_some(),
        };
        let all_found = estimate(&mut problems, &ask)?;
        // what goes together is another sum where the beam is bent far
        if let Some(largest) = largest(&all_found) {
            sight(&mut found, &amplitudes, &largest.jacobian.select_rows(&columns));
        }
        let combinations: Vec<Vec<f64>> = found
            .seen
            .together
            .iter()
            .map(|one| over_sizes(one, &amplitudes))
            .collect();
        let told = Told {
            amplitudes: &amplitudes,
            combinations: &combinations,
            estimate: &all_found,
        };
        found.rows = measured
            .rows
            .iter()
            .enumerate()
            .zip(&all_found.found)
            .map(|((k, row), one)| Row {
                line: measured.lines[k],
                t_s: measured.times.as_ref().map(|times| times[k]),
                amplitudes: (0..amplitudes.len()).map(|j| told.amplitude(one, j)).collect(),
                together: (0..combinations.len()).map(|j| told.together(one, j)).collect(),
                measured_pa: row.clone(),
                modelled_pa: columns.iter().map(|b| one.predicted[*b]).collect(),
            })
            .collect();
        found.smoothing = all_found.deviation_of_differences.map(|deviation| Smoothed {
            by: asked.smoothing,
            deviation_n_m: deviation * spread(&amplitudes),
        });
        found.noise = Some(noise(asked, measured, &all_found));
        warnings.extend(unexplained(&found, &ask, &problems, &all_found));
        if let Some(largest) = largest(&all_found) {
            warnings.extend(aside(&model, largest)?);
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

/// What pressures tell of loads, by their derivatives.
fn sight(found: &mut Sensed, amplitudes: &[Amplitude], jacobian: &DMatrix<f64>) {
    let seen = Seen::of(jacobian);
    found.amplitudes = unknowns(amplitudes, &seen, jacobian);
    let most = seen.values.first().copied().unwrap_or(1.0);
    found.seen = Sight {
        condition: seen.values.last().map_or(1.0, |least| most / least),
        blind: seen.blind.iter().map(|change| changed(change, amplitudes)).collect(),
        together: combinations(&seen, amplitudes),
    };
}

/// Factors of a sum for amplitudes over their sizes.
fn over_sizes(sum: &Combination, amplitudes: &[Amplitude]) -> Vec<f64> {
    sum.factors
        .iter()
        .zip(amplitudes)
        .map(|(factor, a)| factor * a.size)
        .collect()
}

/// Measurements with a place for every bladder.
fn whole(measured: &Measured, columns: &[usize], count: usize) -> Vec<Vec<Option<f64>>> {
    let of = |row: &Vec<Option<f64>>| {
        let mut all = vec![None; count];
        for (place, value) in columns.iter().zip(row) {
            all[*place] = *value;
        }
        all
    };
    measured.rows.iter().map(of).collect()
}

/// The size of forces per length across.
fn spread(amplitudes: &[Amplitude]) -> f64 {
    let one = amplitudes.iter().find(|a| a.place.is_some() && a.unit == "N/m");
    one.map_or(1.0, |a| a.size)
}

/// Second differences of the amplitudes of a profile.
fn differences(amplitudes: &[Amplitude], loads: &[Basis]) -> DMatrix<f64> {
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

fn unknowns(amplitudes: &[Amplitude], seen: &Seen, jacobian: &DMatrix<f64>) -> Vec<Unknown> {
    let spread = linear(jacobian).spread;
    let of = |(k, a): (usize, &Amplitude)| Unknown {
        name: a.name.clone(),
        unit: a.unit.into(),
        place: a.place,
        error_per_pa: seen.alone[k].then(|| spread[(k, k)].max(0.0).sqrt() * a.size),
    };
    amplitudes.iter().enumerate().map(of).collect()
}

fn linear(jacobian: &DMatrix<f64>) -> crate::numerics::inverse::Posterior {
    let none = DMatrix::zeros(0, jacobian.ncols());
    Linear::new(jacobian.clone(), DVector::zeros(jacobian.nrows())).posterior(&none)
}

/// How much each amplitude changes, in its unit, the one that leads by 1.
fn changed(change: &[f64], amplitudes: &[Amplitude]) -> Vec<f64> {
    let lead = amplitudes[leading(change)].size;
    change.iter().zip(amplitudes).map(|(c, a)| c * a.size / lead).collect()
}

/// Which of the factors of a reduced row is the 1 that no other has.
fn leading(row: &[f64]) -> usize {
    row.iter().position(|c| (c - 1.0).abs() < 1e-9).unwrap_or(0)
}

/// Sums of several amplitudes that are told.
fn combinations(seen: &Seen, amplitudes: &[Amplitude]) -> Vec<Combination> {
    let several = |one: &&Vec<f64>| one.iter().filter(|c| **c != 0.0).count() > 1;
    let of = |one: &Vec<f64>| {
        let first = leading(one);
        let size = amplitudes[first].size;
        let factors: Vec<f64> = one.iter().zip(amplitudes).map(|(c, a)| c * size / a.size).collect();
        let mut name = String::new();
        for (factor, a) in factors.iter().zip(amplitudes).filter(|(factor, _)| **factor != 0.0) {
            let sign = match (name.is_empty(), *factor < 0.0) {
                (true, _) => "",
                (_, true) => " - ",
                (_, false) => " + ",
            };
            let times = match (factor.abs() - 1.0).abs() < 1e-9 {
                true => String::new(),
                false => short(factor.abs()) + " ",
            };
            name += &format!("{sign}{times}{}", a.name);
        }
        Combination {
            name,
            unit: amplitudes[first].unit.into(),
            factors,
        }
    };
    seen.told.iter().filter(several).map(of).collect()
}

/// Four digits.
fn short(x: f64) -> String {
    match (1e-3..1e4).contains(&x) {
        true => format!("{x:.4}"),
        false => format!("{x:.3e}"),
    }
}

/// What is told of a row.
struct Told<'a> {
    amplitudes: &'a [Amplitude],
    combinations: &'a [Vec<f64>],
    estimate: &'a Estimate,
}

impl Told<'_> {
    /// A sum of amplitudes over their sizes, if it is told.
    fn of(&self, found: &Found, factors: &[f64]) -> Option<Banded> {
        found.seen.tells(factors).then(|| {
            let factors = DVector::from_column_slice(factors);
            let value = factors.dot(&found.mean);
            let sd = factors.dot(&(&found.covariance * &factors)).max(0.0).sqrt();
            let half = self.estimate.quantile * sd;
            Banded {
                value,
                sd,
                low: value - half,
                high: value + half,
            }
        })
    }

    fn amplitude(&self, found: &Found, k: usize) -> Option<Banded> {
        let mut factors = vec![0.0; self.amplitudes.len()];
        factors[k] = self.amplitudes[k].size;
        self.of(found, &factors)
    }

    fn together(&self, found: &Found, k: usize) -> Option<Banded> {
        self.of(found, &self.combinations[k])
    }
}

fn noise(asked: &Asked, measured: &Measured, estimate: &Estimate) -> Noise {
    let (from, sd_pa) = match (&measured.deviations, asked.noise_pa) {
        (Some(_), _) => (NoiseFrom::Table, None),
        (None, Some(given)) => (NoiseFrom::Given, Some(given)),
        (None, None) => (NoiseFrom::Estimated, Some(estimate.noise)),
    };
    Noise {
        from,
        sd_pa,
        freedom: estimate.freedom,
        chi_square: estimate.left / (estimate.noise * estimate.noise),
        quantile: estimate.quantile,
    }
}

/// What is said where pressures are further from the model than their noise explains, with the bladder that is worst.
fn unexplained(found: &Sensed, ask: &Ask, problems: &[Problem], estimate: &Estimate) -> Option<String> {
    // Wilson and Hilferty's quantile of the sum of squares
    let f = estimate.freedom;
    if !ask.noise_known || f < 0.5 {
        return None;
    }
    let share = 2.0 / (9.0 * f);
    let limit = f * (1.0 - share - normal::quantile(UNLIKELY) * share.sqrt()).powi(3);
    if estimate.left <= limit {
        return None;
    }
    let mut worst = (0, 0.0);
    for k in 0..problems[0].data.len() {
        let off = problems.iter().zip(&estimate.found).filter_map(|(problem, one)| {
            let value = problem.data[k]?;
            Some(((value - one.predicted[k]) / problem.deviation[k]).powi(2))
        });
        let (count, sum) = off.fold((0, 0.0), |(count, sum), x| (count + 1, sum + x));
        let mean = if count > 0 {
            (sum / f64::from(count)).sqrt()
        } else {
            0.0
        };
        if mean > worst.1 {
            worst = (k, mean);
        }
    }
    let per_row = problems[0].data.len() / 2;
    let label = crate::case::wiring::bladder_label(worst.0, per_row);
    let loads: Vec<String> = found.loads.iter().map(ToString::to_string).collect();
    Some(Code::UnexplainedPressures.warning(format!(
        "{} leaves {:.1} times the noise of the pressures, mean square over {f:.0} degrees of freedom; furthest off is bladder {label}, by {:.1} times its noise: bands are too narrow",
        loads.join(" + "),
        (estimate.left / f).sqrt(),
        worst.1
    )))
}

/// That with the largest loads.
fn largest(estimate: &Estimate) -> Option<&Found> {
    let size = |one: &&Found| one.mean.norm();
    estimate.found.iter().max_by(|a, b| size(a).total_cmp(&size(b)))
}

/// What is said where the state of the largest loads is not that to which they lead from rest.
fn aside(model: &AtRest, largest: &Found) -> Result<Vec<String>> {
    let (followed, mut warnings) = model.followed(largest.mean.as_slice())?;
    if (&followed - &largest.predicted).norm() > SAME * followed.norm() {
        warnings.push(Code::StateAside.warning(
            "the loads found lead along their path from rest to other pressures than those that were fitted: the state of the fit is another one",
        ));
    }
    Ok(warnings)
}

/// The best bladders, for noise of a deviation.
fn chosen(
    jacobian: &DMatrix<f64>,
    all: &[i64],
    amplitudes: &[Amplitude],
    criterion: Criterion,
    noise: f64,
) -> Vec<Chosen> {
    let none = DMatrix::zeros(0, amplitudes.len());
    let of = |choice: choose::Choice| Chosen {
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
