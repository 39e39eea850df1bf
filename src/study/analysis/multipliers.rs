//! Floquet multipliers of cycles, named by the part of the motion that dominates each of them, since their order may
//! change.

use super::{Analysis, AnalysisOutcome, AnalysisRequest, FoundSlopes, RunCase, StopCheck};
use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::{Code, Error, Result};
use crate::run::floquet::{self, CycleStability, Floquet};
use crate::run::periodic::PeriodicScene;
use crate::run::stop::StopFlag;
use crate::study::refine::{meshes, numbers};

/// Number of multipliers with figures, the largest ones.
const COUNT: usize = 6;

/// `slcbeam floquet`.
pub struct Multipliers;

impl Analysis for Multipliers {
    fn check(&self, case: &Case) -> Result<()> {
        PeriodicScene::new(case, None)?.held(&case.name)
    }

    /// Computes the multipliers of a case, with errors estimated by comparing meshes on request.
    fn figures(&self, case: &Case, ask: AnalysisRequest, _: StopCheck, _: RunCase) -> Result<AnalysisOutcome> {
        let stop = StopFlag::default();
        let (scene, mut cycle) = numbers::cycle(case, None, &stop)?;
        let all = floquet::multipliers(&scene, &mut cycle, COUNT);
        let mut found = of_multipliers(&all);
        found.steps = Some(cycle.search.work.steps);
        found.warn(&cycle.range(case, &scene));
        if ask.meshes {
            let here = numbers::of_stability(&all);
            let mut of = |case: &Case| numbers::of_growth(case, None, COUNT, &stop);
            let by_mesh = meshes::judge(case, &here, &mut of)?;
            let named = numbers::named(&all);
            for (k, (name, multiplier)) in named.iter().enumerate() {
                // converts a share of the reference size into an error relative to the figure itself
                let error = |key: &str, value: f64, by_steps: f64| {
                    let share = by_mesh.quantities.get(key).filter(|share| share.known());
                    share.zip(here.get(key)).map(|(share, number)| {
                        let counts = number.size.max(value.abs());
                        share.total() * counts / value.abs() + by_steps
                    })
                };
                let (modulus, growth) = (multiplier.modulus, multiplier.growth_per_s);
                let by_steps = multiplier.numerical_damping_per_s.abs();
                let of_modulus = error(&format!("{name}.modulus"), modulus, by_steps * all.period_s);
                let of_growth = error(
                    &format!("multiplier_{}.growth_per_s", k + 1),
                    growth,
                    by_steps / growth.abs(),
                );
                found.put(format!("{name}.modulus.error"), of_modulus);
                found.put(format!("{name}.growth_per_s.error"), of_growth);
                if k == 0 {
                    found.put("growth_per_s.error", of_growth);
                }
            }
            found.warn(by_mesh.warning().as_slice());
            // multipliers that vanish within a period are rounding errors, not figures of the case
            let gone = named
                .iter()
                .filter(|(_, multiplier)| multiplier.modulus <= numbers::GONE);
            let gone: Vec<String> = gone.map(|(own, _)| format!("{own}.")).collect();
            found
                .figures
                .retain(|(name, _)| !gone.iter().any(|own| name.starts_with(own)));
        }
        found.warn(scene.trapped.as_slice());
        Ok(found)
    }

    fn names(&self, _: &Case) -> Result<Vec<String>> {
        Ok(vec!["growth_per_s".into()])
    }

    fn allows(&self, _: &Case, _: &[Parameter]) -> Result<()> {
        Err(no_derivatives())
    }

    fn derivatives(&self, _: &Case, _: &[Parameter], _: Option<&System>, _: StopCheck) -> FoundSlopes {
        Err(no_derivatives())
    }

    fn fault(&self) -> Code {
        Code::NoCycle
    }
}

fn no_derivatives() -> Error {
    Error::Usage("derivatives of cycle multipliers with respect to numbers of the case are not available".into())
}

/// Moduli, rates and frequencies by part of the motion, and the rate of the largest multiplier.
fn of_multipliers(all: &Floquet) -> AnalysisOutcome {
    let mut found = AnalysisOutcome::finished();
    let stable = all.verdict.stability != CycleStability::Unstable;
    found.put("period_s", all.period_s);
    found.put("stable", f64::from(u8::from(stable)));
    found.put("growth_per_s", all.multipliers.first().map(|m| m.growth_per_s));
    for (name, multiplier) in numbers::named(all) {
        found.put(format!("{name}.modulus"), multiplier.modulus);
        found.put(format!("{name}.growth_per_s"), multiplier.growth_per_s);
        found.put(format!("{name}.frequency_hz"), multiplier.frequency_hz);
    }
    found
}
