//! The figures of a case by each command with their derivatives by numbers of it.
//!
//! Exact for runs (IDA's sensitivities, [E41]), equilibria [E43], modes [E44] and cycles [E76].

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::sweep::compute::{at_the_end, lowest, of_cycle, of_modes, of_path, of_run, swinging};
use super::sweep::plan::What;
use super::sweep::power::POWERS;
use super::sweep::row::Found;
use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::run::dynamics;
use crate::run::equilibrium;
use crate::run::modes;
use crate::run::periodic::scene::fault;
use crate::run::periodic::sensitivity::{allowed, differentiate};
use crate::run::periodic::{Scene, settle, shoot};
use crate::run::record::{Control, Progress, Unrecorded};
use crate::run::summary::{Status, Summary};

/// Derivatives by figure, each by the numbers in their order.
pub type Slopes = BTreeMap<String, Vec<f64>>;

/// The figures of a case, and the derivatives of those that have some by each of its numbers; of what did not finish none. A run has the
/// effects of the system that is given beside it.
///
/// # Errors
/// Those of the command; a number by which nothing is differentiated.
pub fn slopes(
    case: &Case,
    what: What,
    parameters: &[Parameter],
    alike: Option<&System>,
    stop: &dyn Fn() -> bool,
) -> Result<(Found, Slopes)> {
    match what {
        What::Run => run(case, parameters, alike, stop),
        What::Equilibrium => at_rest(case, parameters, stop),
        What::Modes => small(case, parameters),
        What::Periodic => cycle(case, parameters, stop),
        What::Floquet => Err(no_multipliers()),
    }
}

/// Says before anything is computed whether figures have derivatives by numbers of a case.
///
/// # Errors
/// [`Error::Usage`] for a number by which there are none.
pub fn check(case: &Case, what: What, parameters: &[Parameter]) -> Result<()> {
    match what {
        What::Periodic => allowed(case, &Scene::new(case, None)?, parameters),
        What::Floquet => Err(no_multipliers()),
        _ => Ok(()),
    }
}

fn no_multipliers() -> Error {
    Error::Usage("multipliers of a cycle have no derivatives by numbers of the case".into())
}

/// Asks after every step whether to stop.
pub fn until(stop: &dyn Fn() -> bool) -> impl FnMut(&Progress) -> Control + '_ {
    |_| match stop() {
        true => Control::Stop("interrupted".into()),
        false => Control::Continue,
    }
}

fn run(
    case: &Case,
    parameters: &[Parameter],
    alike: Option<&System>,
    stop: &dyn Fn() -> bool,
) -> Result<(Found, Slopes)> {
    let system = alike_or_own(case, alike)?;
    let outcome = dynamics::run_with(case, system, parameters, &mut Unrecorded(until(stop)))?;
    let all = of_summary(&outcome.summary, parameters);
    Ok((of_run(&outcome.summary), all.whole()))
}

/// The system of a case with the effects of another, where that is given and has the same unknowns.
///
/// # Errors
/// Those of [`System::new`].
pub fn alike_or_own(case: &Case, alike: Option<&System>) -> Result<System> {
    let found = alike.map_or(Ok(None), |own| own.like(case))?;
    found.map_or_else(|| System::new(case), Ok)
}

fn of_summary(summary: &Summary, parameters: &[Parameter]) -> Gathered {
    let mut all = Gathered::new(parameters.len());
    if summary.status != Status::Finished {
        return all;
    }
    for (k, parameter) in parameters.iter().enumerate() {
        let Some(found) = summary.sensitivities.get(&parameter.pointer) else {
            continue;
        };
        for (name, quantity) in found.quantities.iter().chain(&found.probes) {
            for (figure, slope) in quantity.figures() {
                all.put(k, format!("{name}.{figure}"), slope);
            }
        }
    }
    all
}

fn cycle(case: &Case, parameters: &[Parameter], stop: &dyn Fn() -> bool) -> Result<(Found, Slopes)> {
    let scene = Scene::new(case, None)?;
    scene.held(&case.name)?;
    let first = shoot(&scene, None).map_err(fault)?;
    let mut settled = settle(case, scene, first)?;
    let period = settled.scene.drive.period;
    let outcome = differentiate(&mut settled, parameters, &mut Unrecorded(until(stop)))?;
    let mut all = of_summary(&outcome.summary, parameters);
    for (k, parameter) in parameters.iter().enumerate() {
        for (energy, power) in POWERS {
            let slopes = outcome.summary.sensitivities.get(&parameter.pointer);
            if let Some(slope) = slopes.and_then(|s| s.quantities.get(energy.name())?.window) {
                all.put(k, power.into(), slope / period);
            }
        }
    }
    let found = of_cycle(&outcome.summary, period, settled.cycle.search.work.steps, None);
    let mut slopes = all.whole();
    slopes.retain(|name, _| found.figure(name).is_some());
    Ok((found, slopes))
}

fn at_rest(case: &Case, parameters: &[Parameter], stop: &dyn Fn() -> bool) -> Result<(Found, Slopes)> {
    let options = at_the_end(case);
    let path = equilibrium::follow(case, &options, &mut |_| match stop() {
        true => Control::Stop("interrupted".into()),
        false => Control::Continue,
    })?;
    if let Some(fault) = path.fault {
        return Err(Error::Solver(Box::new(fault)));
    }
    let columns = equilibrium::columns(&equilibrium::system(case, options.at_s)?);
    let slopes = equilibrium::differentiate(case, &options, &path, parameters)?;
    let mut all = Gathered::new(parameters.len());
    for (k, one) in slopes.iter().enumerate() {
        for (column, slope) in columns.iter().zip(&one.row) {
            all.put(k, column.key(), *slope);
        }
    }
    Ok((of_path(&columns, &path), all.whole()))
}

fn small(case: &Case, parameters: &[Parameter]) -> Result<(Found, Slopes)> {
    let (found, _) = swinging(case)?;
    let slopes = modes::differentiate(case, None, &found.about, &found.modes, parameters)?;
    let mut all = Gathered::new(parameters.len());
    for (rank, place) in lowest(&found.modes).into_iter().enumerate() {
        let name = format!("mode_{}", rank + 1);
        let s = found.modes[place].s;
        for (k, slope) in slopes.iter().enumerate() {
            let d = slope.s[place];
            all.put(k, format!("{name}.frequency_hz"), d.im / TAU);
            all.put(k, format!("{name}.growth_per_s"), d.re);
            // of -re/|s|
            let size = s.norm();
            let ratio = -d.re / size + s.re * (s.re * d.re + s.im * d.im) / size.powi(3);
            all.put(k, format!("{name}.damping_ratio"), ratio);
        }
    }
    Ok((of_modes(&found), all.whole()))
}

/// Slopes by figure, as far as they are known.
pub struct Gathered {
    count: usize,
    all: BTreeMap<String, Vec<Option<f64>>>,
}

impl Gathered {
    /// Of so many numbers.
    pub fn new(count: usize) -> Self {
        Self {
            count,
            all: BTreeMap::new(),
        }
    }

    /// The derivative of a figure by one of the numbers.
    pub fn put(&mut self, number: usize, name: String, slope: f64) {
        let slopes = self.all.entry(name).or_insert_with(|| vec![None; self.count]);
        slopes[number] = Some(slope).filter(|slope| slope.is_finite());
    }

    /// Those that are known by every number.
    pub fn whole(self) -> Slopes {
        let known = |(name, slopes): (String, Vec<Option<f64>>)| {
            let slopes: Option<Vec<f64>> = slopes.into_iter().collect();
            Some((name, slopes?))
        };
        self.all.into_iter().filter_map(known).collect()
    }
}
