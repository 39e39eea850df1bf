//! Runs in time.

use super::derivatives::{alike_or_own, of_summary, until};
use super::{Analysis, AnalysisOutcome, AnalysisRequest, FoundSlopes, RunCase, StopCheck, reached};
use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::discrete::quantities::{Interest, InterestSource, probes};
use crate::error::{Code, Result};
use crate::run::dynamics;
use crate::run::record::FiguresAlone;
use crate::run::summary::{Quantity, Status, Summary};

/// `slcbeam run`.
pub struct Run;

impl Analysis for Run {
    fn check(&self, case: &Case) -> Result<()> {
        System::new(case).map(|_| ())
    }

    fn figures(&self, case: &Case, _: AnalysisRequest, _: StopCheck, run: RunCase) -> Result<AnalysisOutcome> {
        run(case).map(|outcome| of_run(&outcome.summary))
    }

    fn names(&self, case: &Case) -> Result<Vec<String>> {
        let motion = ["max_abs", "final", "window_max_abs", "window_rms"];
        names(case, &motion, &["final", "window"])
    }

    fn derivatives(
        &self,
        case: &Case,
        parameters: &[Parameter],
        alike: Option<&System>,
        stop: StopCheck,
    ) -> FoundSlopes {
        let system = alike_or_own(case, alike)?;
        let outcome = dynamics::run_with(case, system, parameters, &mut FiguresAlone(until(stop)))?;
        let all = of_summary(&outcome.summary, parameters);
        Ok((of_run(&outcome.summary), all.whole()))
    }

    fn fault(&self) -> Code {
        Code::Integrator
    }
}

/// Names of the figures of quantities and probes: `motion` for quantities of the motion, `sums` for accumulated ones.
pub(super) fn names(case: &Case, motion: &[&str], sums: &[&str]) -> Result<Vec<String>> {
    let system = System::new(case)?;
    let network = system.model.wet.as_ref().map(|wet| &wet.network);
    let turbines = network.is_some_and(|network| !network.turbines.is_empty());
    let mut all = vec![];
    for one in Interest::recorded([network.is_some(), turbines]) {
        let figures = match one.source() {
            InterestSource::Motion(_) => motion,
            _ => sums,
        };
        all.extend(figures.iter().map(|figure| format!("{}.{figure}", one.name())));
    }
    for probe in probes::columns(&system) {
        all.extend(motion.iter().map(|figure| format!("{}.{figure}", probe.key())));
    }
    Ok(all)
}

/// Figures of a summary.
pub fn of_run(summary: &Summary) -> AnalysisOutcome {
    let mut found = AnalysisOutcome {
        status: summary.status,
        reason: summary.reason.clone(),
        steps: Some(summary.solver.steps),
        figures: vec![],
        warnings: vec![],
        messages: vec![],
    };
    found.warn(&summary.warnings);
    // a run that never started has no figures, and zeros would look like results
    if summary.status == Status::Failed && summary.time_s == 0.0 {
        return found;
    }
    for (name, quantity) in summary.quantities.iter().chain(&summary.probes) {
        put(&mut found, name, quantity);
        found.put(format!("{name}.error"), summary.relative_error(name));
    }
    let balances = &summary.balances;
    found.put("energy_residual_relative", balances.energy_residual_relative);
    found.put("volume_residual_relative", balances.volume_residual_relative);
    if let Some(accuracy) = &summary.accuracy {
        reached(&mut found, accuracy);
    }
    found
}

/// Adds every figure of a quantity.
fn put(found: &mut AnalysisOutcome, name: &str, quantity: &Quantity) {
    for (figure, value) in quantity.figures() {
        found.put(format!("{name}.{figure}"), value);
    }
    found.put(format!("{name}.max_abs_at_s"), quantity.max_abs_at_s);
    found.put(format!("{name}.extreme"), quantity.extreme);
    found.put(format!("{name}.window_extreme"), quantity.window_extreme);
    found.put(format!("{name}.window_power_w"), quantity.window_power_w);
    found.put(format!("{name}.final_error"), quantity.final_error);
    found.put(format!("{name}.window_error"), quantity.window_error);
}
