//! Modes about the initial state of a case.

use std::f64::consts::TAU;

use super::derivatives::GatheredDerivatives;
use super::{Analysis, AnalysisOutcome, AnalysisRequest, FoundSlopes, RunCase, StopCheck, reached};
use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::{Code, Result};
use crate::run::early_warnings;
use crate::run::modes::{self, sort};
use crate::study::refine::{self, numbers};

/// Number of modes with figures, those of lowest frequency.
pub const MODES: usize = 6;
/// Damping ratio above which a mode decays to less than a thirtieth within a period: it hardly oscillates.
const STRONG: f64 = 0.5;

/// `slcbeam modes`.
pub struct ModesAnalysis;

impl Analysis for ModesAnalysis {
    fn check(&self, case: &Case) -> Result<()> {
        System::new(case).map(|_| ())
    }

    /// Figures of small motions about the initial state: the lowest modes that oscillate.
    fn figures(&self, case: &Case, ask: AnalysisRequest, _: StopCheck, _: RunCase) -> Result<AnalysisOutcome> {
        let (mut all, plan) = swinging(case)?;
        let mut of = |case: &Case| numbers::of_modes(case, None, &plan);
        let refined = refine::if_asked(case, ask.accuracy, false, &mut of)?;
        let case = match &refined {
            None => case,
            Some((chosen, _)) => {
                all = modes::modes(chosen, &plan)?;
                chosen
            }
        };
        if ask.meshes && refined.is_none() {
            refine::meshes::judge_modes(case, None, &plan, &mut all)?;
        }
        let mut found = of_modes(&all);
        if let Some((_, accuracy)) = &refined {
            reached(&mut found, accuracy);
            let worst = accuracy.quantities.values().filter_map(|estimate| estimate.total);
            found.put("largest_error", worst.reduce(f64::max));
        }
        found.warn(&early_warnings::at_rest(case, &System::new(case)?));
        // warn only about modes that are reported
        all.modes = lowest(&all.modes)
            .into_iter()
            .map(|place| all.modes[place].clone())
            .collect();
        found.warn(&all.warnings("the start"));
        Ok(found)
    }

    fn names(&self, _: &Case) -> Result<Vec<String>> {
        let figures = ["frequency_hz", "growth_per_s", "damping_ratio"];
        let of = |k: usize| figures.map(|figure| format!("mode_{k}.{figure}"));
        Ok((1..=MODES).flat_map(of).collect())
    }

    fn derivatives(&self, case: &Case, parameters: &[Parameter], _: Option<&System>, _: StopCheck) -> FoundSlopes {
        let (found, _) = swinging(case)?;
        let slopes = modes::differentiate(case, None, &found.about, &found.modes, parameters)?;
        let mut all = GatheredDerivatives::new(parameters.len());
        for (rank, place) in lowest(&found.modes).into_iter().enumerate() {
            let name = format!("mode_{}", rank + 1);
            let s = found.modes[place].s;
            for (k, slope) in slopes.iter().enumerate() {
                let d = slope.s[place];
                all.put(k, format!("{name}.frequency_hz"), d.im / TAU);
                all.put(k, format!("{name}.growth_per_s"), d.re);
                // derivative of -re/|s|
                let size = s.norm();
                let ratio = -d.re / size + s.re * (s.re * d.re + s.im * d.im) / size.powi(3);
                all.put(k, format!("{name}.damping_ratio"), ratio);
            }
        }
        Ok((of_modes(&found), all.whole()))
    }

    fn fault(&self) -> Code {
        Code::NoModes
    }

    fn is_in_time(&self) -> bool {
        false
    }
}

/// Computes enough modes about the initial state of a case to know the six lowest oscillations, if there are as many. Returns
/// the modes and a plan that finds them.
///
/// # Errors
/// Those of [`modes::modes`].
pub fn swinging(case: &Case) -> Result<(modes::Modes, modes::ModeOptions)> {
    let plan = modes::ModeOptions {
        count: MODES,
        near_hz: 0.0,
        limits: false,
    };
    sort::of_sort(
        modes::linearise(case, 0.0, None)?,
        &plan,
        Some(modes::ModeFilter::Oscillation),
    )
}

/// Indices of the oscillating modes, the lowest first; at most [`MODES`].
pub fn lowest(all: &[modes::Mode]) -> Vec<usize> {
    let mut swinging: Vec<usize> = (0..all.len()).filter(|k| all[*k].kind.swings()).collect();
    swinging.sort_by(|a, b| all[*a].s.im.total_cmp(&all[*b].s.im));
    swinging.truncate(MODES);
    swinging
}

/// Figures of the lowest modes that oscillate.
pub fn of_modes(all: &modes::Modes) -> AnalysisOutcome {
    let mut found = AnalysisOutcome::finished();
    let stable = !all.modes.iter().any(|mode| mode.kind.grows());
    found.put("stable", f64::from(u8::from(stable)));
    for (k, mode) in lowest(&all.modes)
        .into_iter()
        .map(|place| &all.modes[place])
        .enumerate()
    {
        let name = format!("mode_{}", k + 1);
        let size = mode.s.norm();
        found.put(format!("{name}.frequency_hz"), mode.frequency_hz());
        found.put(format!("{name}.frequency_bound_hz"), mode.error / TAU);
        let [frequency, rate] = mode.errors();
        found.put(format!("{name}.frequency_hz.error"), frequency);
        found.put(format!("{name}.damping_ratio"), mode.damping_ratio());
        found.put(format!("{name}.damping_ratio_bound"), mode.error / size);
        found.put(format!("{name}.damping_ratio.error"), rate);
        found.put(format!("{name}.growth_per_s"), mode.s.re);
        let strong = mode.damping_ratio().map(|ratio| f64::from(u8::from(ratio > STRONG)));
        found.put(format!("{name}.strongly_damped"), strong);
    }
    found
}
