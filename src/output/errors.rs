//! Errors as JSON for scripts and as text for readers.

use serde_json::{Value, json};

use crate::case::LineColumns;
use crate::error::{Code, Error, SolverError, StopPoint, Violation};

/// JSON of an error, as printed by commands with `--json`.
pub fn json(error: &Error) -> Value {
    let mut object = json!({"status": "failed", "exit_code": error.exit_code(), "code": error.code().id(), "what": error.to_string()});
    match error {
        Error::Case(fault) => {
            object["status"] = "invalid".into();
            object["file"] = fault.path.display().to_string().into();
            let mut places = LineColumns::new(&fault.text);
            object["faults"] = fault.violations.iter().map(|v| violation(&mut places, v)).collect();
        }
        Error::Solver(fault) => {
            match fault.at {
                StopPoint::Time(time) => object["time_s"] = time.into(),
                StopPoint::LoadFactor(factor) => object["load_factor"] = factor.into(),
            }
            object["unknown"] = fault.unknown.clone().into();
            object["cause"] = fault.cause.clone().into();
            object["hint"] = fault.hint.clone().into();
        }
        Error::Usage(_) | Error::Interrupted(_) | Error::Output { .. } => {}
    }
    object
}

fn violation(places: &mut LineColumns, violation: &Violation) -> Value {
    let place = violation.span.as_ref().map(|span| match &violation.set {
        Some(set) => LineColumns::new(set).line_and_column(span.start),
        None => places.line_and_column(span.start),
    });
    json!({
        "code": violation.code.id(), "what": violation.what, "pointer": violation.pointer, "set": violation.set,
        "line": place.map(|p| p.0), "column": place.map(|p| p.1),
        "allowed": violation.allowed, "nearest": violation.nearest, "hint": violation.hint
    })
}

/// Text of an error of the solver.
pub fn diagnosis(fault: &SolverError) -> String {
    // modes and equilibria have no time of a run
    let failed = match (fault.code, fault.at) {
        (Code::NoCycle, StopPoint::Time(t)) if t > 0.0 => format!("no cycle, t = {t:.6e} s of its period: "),
        (Code::NoModes | Code::NoEquilibrium | Code::NoCycle | Code::Interrupted, _) => String::new(),
        (_, StopPoint::Time(t)) => format!("the run failed at t = {t:.6e} s: "),
        (_, StopPoint::LoadFactor(factor)) => format!("failed at {factor:.6} of the loads: "),
    };
    let mut lines = vec![format!(
        "slcbeam: {failed}{} (slcbeam explain {})",
        fault.what,
        fault.code.id()
    )];
    for (what, text) in [
        ("worst unknown", &fault.unknown),
        ("likely cause", &fault.cause),
        ("try", &fault.hint),
    ] {
        if let Some(text) = text {
            lines.push(format!("  {what}: {text}"));
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: only a run reports a time of failure.
    #[test]
    fn only_runs_fail_at_a_time() {
        let describe = |code| {
            diagnosis(&SolverError {
                code,
                at: StopPoint::Time(0.25),
                what: "no such thing".into(),
                unknown: None,
                cause: None,
                hint: None,
            })
        };
        assert_eq!(describe(Code::NoModes), "slcbeam: no such thing (slcbeam explain E047)");
        assert!(describe(Code::Integrator).contains("the run failed at t = 2.500000e-1 s"));
        assert!(describe(Code::NoCycle).contains("no cycle") && !describe(Code::NoCycle).contains("run failed"));
    }
}
