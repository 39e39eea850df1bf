//! Derivatives of the figures at the means.

use std::collections::BTreeMap;

use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::run::summary::Status;
use crate::study::analysis::AnalysisKind;
use crate::study::analysis::derivatives::{self, GatheredDerivatives};

/// Derivatives of each figure with respect to the numbers, in their order; or the reason why there are none.
pub type FirstOrderSlopes = Result<derivatives::FigureSlopes, String>;

/// Derivatives of the figures of a case with respect to each of its numbers. They are exact, except for numbers that
/// change the period of cycles, and for multipliers: these use differences. `difference` returns the difference
/// quotients of the figures for the number of the given index.
pub fn slopes(
    case: &Case,
    what: &AnalysisKind,
    pointers: &[String],
    stop: &dyn Fn() -> bool,
    difference: &dyn Fn(usize) -> Option<BTreeMap<String, f64>>,
) -> FirstOrderSlopes {
    let exact = || {
        let parameters = Parameter::all(case, pointers)?;
        if what.analysis().allows(case, &parameters).is_err() {
            return Ok(by_differences(pointers.len(), difference));
        }
        let (found, slopes) = what.analysis().derivatives(case, &parameters, None, stop)?;
        if found.status == Status::Finished {
            return Ok(Ok(slopes));
        }
        let why = found.reason.unwrap_or_else(|| "the run did not finish".into());
        Ok(Err(format!("the case at the means, with derivatives: {why}")))
    };
    exact().unwrap_or_else(|error: crate::error::Error| Err(error.to_string().replace("--sensitivity ", "")))
}

fn by_differences(count: usize, difference: &dyn Fn(usize) -> Option<BTreeMap<String, f64>>) -> FirstOrderSlopes {
    let mut all = GatheredDerivatives::new(count);
    for k in 0..count {
        let Some(found) = difference(k) else {
            return Err("no cycle was found for a small change from the means".into());
        };
        found.into_iter().for_each(|(name, slope)| all.put(k, name, slope));
    }
    Ok(all.whole())
}
