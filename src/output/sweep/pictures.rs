//! Converts rows to the data of pictures.

use std::collections::BTreeMap;

use super::warnings::find_exchanges;
use super::{JournalSummary, numeric, table, unit};
use crate::case::readable;
use crate::error::Result;
use crate::output::plot::designs::{self, DesignNumbers, Drawn};
use crate::results::sweep::SweepPlan;
use crate::run::summary::Status;

/// Largest number of designs drawn, spread over all.
const DRAWN: usize = 2000;
/// Largest number of figures drawn.
const FIGURES: usize = 4;
/// Figures that can be drawn, in order of preference; only those that exist and vary are drawn.
pub const FIRST: [&str; 13] = [
    "harvested_power_w.mean",
    "harvested_energy_j.final",
    "efficiency.window",
    "tip_u1_m.window_max_abs",
    "tip_u3_m.window_max_abs",
    "max_pressure_pa.window_max_abs",
    "tip_u1_m",
    "tip_u3_m",
    "max_pressure_pa",
    "mode_1.frequency_hz",
    "mode_1.damping_ratio",
    "mode_2.frequency_hz",
    "mode_2.damping_ratio",
];

/// Informative pictures of these designs, by file name.
///
/// # Errors
/// The journal cannot be read.
pub fn draw(plan: &SweepPlan, survey: &JournalSummary) -> Result<Vec<(&'static str, String)>> {
    let data = data(plan, survey)?;
    if data.designs.len() < 2 || data.varied.is_empty() {
        return Ok(vec![]);
    }
    let many = data.varied.len() + usize::from(plan.cases.len() > 1);
    let picture = match data.varied.len() {
        1 => designs::along(&data).map(|text| ("sweep.svg", text)),
        2 if many == 2 => designs::over_two(&data).map(|text| ("map.svg", text)),
        _ => None,
    };
    Ok(picture.into_iter().collect())
}

/// Data of the designs that finished, thinned to those drawn.
fn data(plan: &SweepPlan, survey: &JournalSummary) -> Result<Drawn> {
    let mut varied: Vec<Vec<Option<f64>>> = vec![vec![]; plan.axes.len()];
    let (mut named, mut numbers) = (vec![], vec![]);
    let mut figures: BTreeMap<&str, Vec<f64>> = FIRST.iter().map(|name| (*name, vec![])).collect();
    let all = survey.statuses.get(&Status::Finished).copied().unwrap_or(0);
    let mut of = 0;
    survey.each(|row| {
        let finished = row.found.status == Status::Finished;
        let drawn = finished && (of * DRAWN) % all.max(1) < DRAWN;
        of += usize::from(finished);
        if drawn {
            numbers.push(row.number);
            for (axis, value) in varied.iter_mut().zip(&row.values) {
                axis.push(numeric(value));
            }
            for (name, values) in &mut figures {
                values.push(row.found.figure(name).unwrap_or(f64::NAN));
            }
            named.push((row.case, row.values));
        }
        Ok(())
    })?;
    let differs = |values: &[f64]| values.iter().any(|x| x.is_finite() && *x != values[0]);
    let numbered: Vec<usize> = (0..varied.len())
        .filter(|k| {
            let values: Option<Vec<f64>> = varied[*k].iter().copied().collect();
            values.is_some_and(|values| differs(&values))
        })
        .collect();
    // values that are not numbers, or do not vary, distinguish curves
    let mut curves: Vec<String> = vec![];
    let curve = named.iter().map(|(case, values)| {
        let own = plan
            .axes
            .iter()
            .zip(values)
            .enumerate()
            .filter(|(k, _)| !numbered.contains(k));
        let mut parts: Vec<String> = own
            .map(|(_, (axis, value))| format!("{} = {}", axis.pointer, table::cell(value)))
            .collect();
        if plan.cases.len() > 1 {
            parts.insert(0, plan.cases[*case].name.clone());
        }
        let name = parts.join(", ");
        curves.iter().position(|own| *own == name).unwrap_or_else(|| {
            curves.push(name);
            curves.len() - 1
        })
    });
    let curve = curve.collect();
    let chosen = FIRST.iter().filter_map(|name| {
        let values = figures.remove(name)?;
        (!values.is_empty() && differs(&values)).then(|| DesignNumbers {
            name: (*name).into(),
            label: readable::figure_name(name),
            unit: unit(name).into(),
            logarithmic: false,
            values,
        })
    });
    let figures = chosen.take(FIGURES).collect();
    Ok(Drawn {
        case: plan.title(),
        varied: numbered
            .iter()
            .map(|&k| DesignNumbers {
                name: plan.axes[k].pointer.clone(),
                label: readable::pointer_name(&plan.axes[k].pointer),
                unit: readable::pointer_unit(&plan.axes[k].pointer).into(),
                logarithmic: plan.logarithmic(k) || plan.listed(k) && by_factors(&varied[k]),
                values: varied[k].iter().map(|x| x.unwrap_or(f64::NAN)).collect(),
            })
            .collect(),
        joined: numbered.iter().all(|&k| plan.listed(k)),
        apart: find_exchanges(plan, survey)?,
        designs: numbers,
        of,
        figures,
        curve,
        curves,
    })
}

/// True if values cover at least a decade and their logarithms are spaced more evenly than the values.
fn by_factors(values: &[Option<f64>]) -> bool {
    let mut all: Vec<f64> = values.iter().flatten().copied().collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    let [low, _, .., high] = all[..] else { return false };
    let uneven = |of: fn(f64) -> f64| {
        let steps = || all.windows(2).map(|pair| of(pair[1]) - of(pair[0]));
        steps().fold(0.0, f64::max) / steps().fold(f64::INFINITY, f64::min)
    };
    low > 0.0 && high >= 10.0 * low && uneven(f64::ln) < uneven(|x| x)
}

#[cfg(test)]
mod tests {
    use super::by_factors;

    #[test]
    fn axes_follow_the_spacing_of_values() {
        let are = |values: &[f64]| by_factors(&values.iter().copied().map(Some).collect::<Vec<_>>());
        assert!(are(&[0.1, 1.0, 10.0]) && are(&[1e-3, 3e-3, 1e-2, 3e-2]));
        for values in [
            &[11.0, 12.3, 14.0][..],
            &[1.0, 10.0],
            &[1.0, 5.5, 10.0],
            &[-10.0, 0.1, 1.0],
            &[0.0, 1.0, 10.0],
        ] {
            assert!(!are(values), "{values:?}");
        }
    }
}
