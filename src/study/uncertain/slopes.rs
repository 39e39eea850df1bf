//! Derivatives of all figures by numbers of a case.
//!
//! Exact for runs (IDA's sensitivities, [E41]), equilibria [E43] and modes [E44]; of cycles by central differences over two cycles a
//! number, wrong by the square of the step.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::Result;
use crate::run::dynamics;
use crate::run::equilibrium;
use crate::run::modes;
use crate::run::record::{Control, Unrecorded};
use crate::run::summary::Status;
use crate::study::sweep::compute::{at_the_end, lowest, swinging};
use crate::study::sweep::plan::What;

/// Derivatives by figure, each by the numbers in their order; or why there are none.
pub type Slopes = std::result::Result<BTreeMap<String, Vec<f64>>, String>;

/// Derivatives of the figures of a case by each of its numbers. `difference` is told which number, and gives differences of figures over a step
/// of it.
pub fn slopes(
    case: &Case,
    what: What,
    pointers: &[String],
    stop: &dyn Fn() -> bool,
    difference: &dyn Fn(usize) -> Option<BTreeMap<String, f64>>,
) -> Slopes {
    let exact = || -> Result<Slopes> {
        let parameters = Parameter::all(case, pointers)?;
        match what {
            What::Run => of_run(case, &parameters, stop),
            What::Equilibrium => at_rest(case, &parameters, stop),
            What::Modes => of_modes(case, &parameters),
            What::Periodic => Ok(by_differences(pointers.len(), difference)),
        }
    };
    exact().unwrap_or_else(|error| Err(error.to_string().replace("--sensitivity ", "")))
}

fn of_run(case: &Case, parameters: &[Parameter], stop: &dyn Fn() -> bool) -> Result<Slopes> {
    let hook = |_: &_| match stop() {
        true => Control::Stop("interrupted".into()),
        false => Control::Continue,
    };
    let outcome = dynamics::run_with(case, System::new(case)?, parameters, &mut Unrecorded(hook))?;
    let summary = outcome.summary;
    if summary.status != Status::Finished {
        let why = summary.reason.unwrap_or_else(|| "the run did not finish".into());
        return Ok(Err(format!("the run with derivatives about the means: {why}")));
    }
    let mut all = Gathered::new(parameters.len());
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
    Ok(Ok(all.whole()))
}

fn at_rest(case: &Case, parameters: &[Parameter], stop: &dyn Fn() -> bool) -> Result<Slopes> {
    let options = at_the_end(case);
    let path = equilibrium::follow(case, &options, &mut |_| match stop() {
        true => Control::Stop("interrupted".into()),
        false => Control::Continue,
    })?;
    if let Some(fault) = &path.fault {
        return Ok(Err(format!("the equilibrium about the means: {}", fault.what)));
    }
    let columns = equilibrium::columns(&equilibrium::system(case, options.at_s)?);
    let found = equilibrium::differentiate(case, &options, &path, parameters)?;
    let mut all = Gathered::new(parameters.len());
    for (k, one) in found.iter().enumerate() {
        for (column, slope) in columns.iter().zip(&one.row) {
            all.put(k, column.key(), *slope);
        }
    }
    Ok(Ok(all.whole()))
}

fn of_modes(case: &Case, parameters: &[Parameter]) -> Result<Slopes> {
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
    Ok(Ok(all.whole()))
}

fn by_differences(count: usize, difference: &dyn Fn(usize) -> Option<BTreeMap<String, f64>>) -> Slopes {
    let mut all = Gathered::new(count);
    for k in 0..count {
        let Some(found) = difference(k) else {
            return Err("a cycle beside the means was not found".into());
        };
        found.into_iter().for_each(|(name, slope)| all.put(k, name, slope));
    }
    Ok(all.whole())
}

/// Slopes by figure, as far as they are known.
struct Gathered {
    count: usize,
    all: BTreeMap<String, Vec<Option<f64>>>,
}

impl Gathered {
    fn new(count: usize) -> Self {
        Self {
            count,
            all: BTreeMap::new(),
        }
    }

    fn put(&mut self, number: usize, name: String, slope: f64) {
        let slopes = self.all.entry(name).or_insert_with(|| vec![None; self.count]);
        slopes[number] = Some(slope).filter(|slope| slope.is_finite());
    }

    /// Those that are known by every number.
    fn whole(self) -> BTreeMap<String, Vec<f64>> {
        let known = |(name, slopes): (String, Vec<Option<f64>>)| {
            let slopes: Option<Vec<f64>> = slopes.into_iter().collect();
            Some((name, slopes?))
        };
        self.all.into_iter().filter_map(known).collect()
    }
}
