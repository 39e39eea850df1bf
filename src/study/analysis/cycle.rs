//! Steady cycles.

use super::derivatives::{of_summary, until};
use super::power::{self, POWERS};
use super::{Analysis, AnalysisOutcome, AnalysisRequest, FoundSlopes, RunCase, StopCheck, accurate, errors, run};
use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::{Code, Result};
use crate::run::drive::comes_to_rest;
use crate::run::floquet::{self, CycleStability, Floquet};
use crate::run::periodic::scene::{fault, whole};
use crate::run::periodic::sensitivity::{allowed, differentiate};
use crate::run::periodic::{PeriodicScene, Settled, record, settle, shoot, subharmonic};
use crate::run::record::{Control, Unrecorded};
use crate::run::stop::StopFlag;
use crate::run::summary::{Status, Summary};
use crate::study::refine::{self, meshes, numbers};

/// Number of multipliers computed with a cycle.
const MULTIPLIERS: usize = 2;

/// `slcbeam periodic`.
pub struct Periodic;

impl Analysis for Periodic {
    fn check(&self, case: &Case) -> Result<()> {
        match comes_to_rest(&whole(case)?) {
            true => Ok(()),
            false => PeriodicScene::new(case, None)?.held(&case.name),
        }
    }

    /// Computes the steady cycle, or the self-oscillation of a case whose signals become constant.
    fn figures(&self, case: &Case, ask: AnalysisRequest, _: StopCheck, _: RunCase) -> Result<AnalysisOutcome> {
        let mut of = |case: &Case| numbers::of_cycle(case, 1, &StopFlag::default());
        let refined = refine::if_asked(case, ask.accuracy, true, &mut of)?;
        let case = refined.as_ref().map_or(case, |(chosen, _)| chosen);
        let (scene, first, _) = subharmonic::find(case, 1)?;
        let Settled {
            case, scene, mut cycle, ..
        } = settle(case, scene, first)?;
        let stability = floquet::multipliers(&scene, &mut cycle, MULTIPLIERS);
        let outcome = record::record(&case, &scene, &cycle, &mut Unrecorded(|_| Control::Continue))?;
        let summary = &outcome.summary;
        let mut found = of_cycle(summary, scene.drive.period, cycle.search.work.steps, Some(&stability));
        if let Some((_, accuracy)) = &refined {
            accurate(&mut found, accuracy, &|name| name.into());
            power::share_errors(&mut found);
        } else if ask.meshes && summary.status == Status::Finished {
            let here = numbers::of_summary(&case, summary)?;
            let by_mesh = meshes::judge(&case, &here, &mut of)?;
            errors(&mut found, &by_mesh, &|name| name.into());
            power::share_errors(&mut found);
        }
        found.warn(&summary.warnings);
        Ok(found)
    }

    fn names(&self, case: &Case) -> Result<Vec<String>> {
        let all = run::names(case, &["window_max_abs", "window_rms"], &["window"])?;
        let network = System::new(case)?.model.wet.map(|wet| wet.network);
        let turbines = network.is_some_and(|network| !network.turbines.is_empty());
        let powers = POWERS[usize::from(!turbines)..].iter().map(|(_, name)| (*name).into());
        Ok(all.into_iter().chain(powers).collect())
    }

    fn allows(&self, case: &Case, parameters: &[Parameter]) -> Result<()> {
        allowed(case, &PeriodicScene::new(case, None)?, parameters)
    }

    fn derivatives(&self, case: &Case, parameters: &[Parameter], _: Option<&System>, stop: StopCheck) -> FoundSlopes {
        let scene = PeriodicScene::new(case, None)?;
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

    fn fault(&self) -> Code {
        Code::NoCycle
    }
}

/// Returns the figures of the summary of a cycle over its period [s], and its stability if that is known.
pub fn of_cycle(summary: &Summary, period: f64, steps: u64, stability: Option<&Floquet>) -> AnalysisOutcome {
    let mut found = AnalysisOutcome {
        steps: Some(steps),
        status: summary.status,
        reason: summary.reason.clone(),
        ..AnalysisOutcome::finished()
    };
    found.put("period_s", period);
    if let Some(all) = stability {
        let stable = all.verdict.stability != CycleStability::Unstable;
        found.put("stable", f64::from(u8::from(stable)));
        found.put("growth_per_s", all.multipliers.first().map(|m| m.growth_per_s));
    }
    for (name, quantity) in summary.quantities.iter().chain(&summary.probes) {
        for (figure, value) in quantity.figures().filter(|(figure, _)| figure.starts_with("window")) {
            found.put(format!("{name}.{figure}"), value);
        }
        found.put(format!("{name}.window_error"), quantity.window_error);
    }
    for (_, power) in POWERS {
        if let Some(figure) = power::figures(&summary.quantities, period)
            .iter()
            .find(|f| f.name == power)
        {
            found.put(power, figure.value);
            found.put(figure.open_name(), figure.open);
        }
    }
    found
}
