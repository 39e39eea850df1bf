//! What a cycle's multipliers tell, with what meshes and steps make of them: by the part of the motion that each is mostly of, whose place
//! among the others may change.

use super::compute::Ask;
use super::row::Found;
use crate::case::Case;
use crate::error::Result;
use crate::run::floquet::{self, Floquet, Stability};
use crate::run::stop::Stop;
use crate::study::refine::{meshes, numbers};

/// Multipliers told, those largest.
const COUNT: usize = 6;

/// The multipliers of a case, with the errors that meshes make on request.
///
/// # Errors
/// Those of [`numbers::cycle`].
pub fn multipliers(case: &Case, ask: Ask) -> Result<Found> {
    let stop = Stop::default();
    let (scene, mut cycle) = numbers::cycle(case, None, &stop)?;
    let all = floquet::multipliers(&scene, &mut cycle, COUNT);
    let mut found = of_multipliers(&all);
    found.steps = Some(cycle.search.work.steps);
    if ask.meshes {
        let here = numbers::of_stability(&all);
        let mut of = |case: &Case| numbers::of_growth(case, None, COUNT, &stop);
        let by_mesh = meshes::judge(case, &here, &mut of)?;
        for (k, (name, multiplier)) in numbers::named(&all).into_iter().enumerate() {
            let growth = format!("multiplier_{}.growth_per_s", k + 1);
            let known = [("modulus", format!("{name}.modulus")), ("growth_per_s", growth)];
            for (figure, key) in known {
                let value = if figure == "modulus" {
                    multiplier.modulus
                } else {
                    multiplier.growth_per_s
                };
                let share = by_mesh.quantities.get(&key).filter(|share| share.known());
                // a share is of the size that counts, an error of the figure itself
                let by_steps = match figure {
                    "modulus" => multiplier.numerical_damping_per_s.abs() * all.period_s,
                    _ => multiplier.numerical_damping_per_s.abs() / value.abs(),
                };
                let error = share.zip(here.get(&key)).map(|(share, number)| {
                    let counts = number.size.max(value.abs());
                    share.total() * counts / value.abs() + by_steps
                });
                found.put(format!("{name}.{figure}.error"), error);
                if k == 0 && figure == "growth_per_s" {
                    found.put("growth_per_s.error", error);
                }
            }
        }
        found.warn(by_mesh.warning().as_slice());
        // what is gone after a period is round-off, and is no figure of the case; of samples it is there where it is not
        found.figures.retain(|(name, _)| {
            let of = numbers::named(&all)
                .into_iter()
                .find(|(own, _)| name.starts_with(&format!("{own}.")));
            of.is_none_or(|(_, multiplier)| multiplier.modulus > numbers::GONE)
        });
    }
    found.warn(scene.trapped.as_slice());
    Ok(found)
}

/// Moduli, rates and frequencies by part, and the rate of the largest.
pub fn of_multipliers(all: &Floquet) -> Found {
    let mut found = Found::finished();
    let stable = all.verdict.stability != Stability::Unstable;
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
