//! Checks of probes, whose names begin columns, and of the time of the step response.

use std::collections::HashMap;

use super::time::END;
use crate::case::faults::Violations;
use crate::case::schema::Case;
use crate::error::{Code, Violation};

pub(super) fn check(case: &Case, faults: &mut Violations) {
    let good = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    let mut known = HashMap::new();
    for (i, probe) in case.probes.iter().enumerate() {
        let name = &probe.name;
        let mut fault = |what: String| {
            let fault = Violation::new(Code::CaseName, format!("/probes/{i}/name"), what);
            faults.push(fault.allowed("letters, digits, `-` and `_`, a name for each probe, not \"tip\""));
        };
        if name.is_empty() || !name.chars().all(good) {
            fault(format!("\"{name}\" cannot begin the name of a column"));
        } else if name == TIP {
            fault(format!("the name \"{name}\" is reserved for the columns of the tip"));
        }
        if let Some(first) = known.insert(name, i) {
            fault(format!(
                "two probes have the name \"{name}\", the first is /probes/{first}"
            ));
        }
    }
}

/// Checks that the step is before the end of the run.
pub(super) fn step(case: &Case, faults: &mut Violations) {
    let Some(step) = case.step_response.filter(|step| step.at_s >= case.time.end_s) else {
        return;
    };
    let what = format!(
        "the step is at {} s, and the run ends at {} s",
        step.at_s, case.time.end_s
    );
    let fault = Violation::new(Code::Times, "/step_response/at_s", what).allowed("times before /time/end_s");
    let fault = fault.hint("make the run longer than the settling time");
    faults.push_beside(&[END], fault);
}

/// Reserved name: the tip has columns of its own.
const TIP: &str = "tip";
