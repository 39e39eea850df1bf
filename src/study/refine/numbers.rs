//! Numbers that each command computes, in a form that can be compared between meshes.

use std::collections::BTreeMap;

use super::{ReferencedNumber, RefinedNumbers};
use crate::case::{Case, spans};
use crate::discrete::quantities::{Observable, probes};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::run::equilibrium::{self, EquilibriumOptions, Path};
use crate::run::floquet::{self, Floquet, Multiplier};
use crate::run::modes::{self, Mode, ModeOptions, TimeBehavior};
use crate::run::periodic::scene::fault;
use crate::run::periodic::{Cycle, PeriodicScene, record, shoot, subharmonic};
use crate::run::record::{Control, HistoryColumn, Unrecorded};
use crate::run::stop::StopFlag;
use crate::run::summary::{Status, Summary};
use crate::study::significant::{RoundingScales, counted};

/// Share of the largest number of a unit below which others are rounding errors.
const NOTHING: f64 = 1e-6;
/// Share of the largest number of a kind that is the reference size: errors refer to the larger of it and the number.
const BESIDE: f64 = 0.01;
/// Strain that is a rounding error compared with rigid-body motion.
const STRAIN: f64 = 1e-9;
/// Modulus below which a multiplier belongs to motion that vanishes within a period.
pub const GONE: f64 = 0.01;
/// Share of a mode's own frequency that is the reference size of its growth rate.
const DAMPING: f64 = 0.01;

/// Numbers of the last state of a load path.
///
/// # Errors
/// The path ends early.
pub fn of_equilibrium(case: &Case, options: &EquilibriumOptions) -> Result<RefinedNumbers> {
    let path = equilibrium::follow(case, options, &mut |_| Control::Continue)?;
    if let Some(fault) = path.fault {
        return Err(Error::Solver(Box::new(fault)));
    }
    let columns = equilibrium::columns(&equilibrium::system(case, options.at_s)?);
    of_path(case, &columns, &path)
}

/// Numbers of the last state of a load path that was computed before.
pub fn of_path(case: &Case, columns: &[HistoryColumn], path: &Path) -> Result<RefinedNumbers> {
    let row = path.states.last().map_or(&[][..], |state| &state.row);
    let length = case.beam.length_m;
    let modulus = spans::softest_modulus(case);
    // compare angles with displacements, stresses of the solid with strains
    let alike = |column: &HistoryColumn| match column.unit {
        "rad" => ("m", length),
        "Pa" if probes::is_stress(&column.name) => ("1", 1.0 / modulus),
        unit => (unit, 1.0),
    };
    let all = || columns.iter().zip(row).skip(1);
    let largest = |unit: &str| {
        let same = all().map(|(c, x)| (alike(c), x)).filter(|((u, _), _)| *u == unit);
        same.map(|((_, factor), x)| factor * x.abs()).fold(0.0, f64::max)
    };
    // displacements and pressures below these floors are rounding errors, and so is everything computed from them
    let (floors, model) = (RoundingScales::from_case(case)?, Model::new(case)?);
    // smaller differences of pressure are zero and drive no flow
    let even = (NOTHING * largest("Pa")).max(floors.pressure);
    let conductance = model.wet.as_ref().map_or(0.0, |wet| {
        wet.network
            .conductance(wet.bladder_length / case.mesh.cells_per_bladder as f64)
    });
    let floor = |unit: &str| match unit {
        "m" => floors.displacement,
        "Pa" => floors.pressure,
        "1/m" => floors.displacement / (length * length),
        "N" => (model.section.axial_stiffness * STRAIN).min(NOTHING * model.scales.force),
        "N m" => (model.section.bending_stiffness / length * STRAIN).min(NOTHING * model.scales.moment),
        "J" => model.section.axial_stiffness * length * STRAIN * STRAIN,
        "m^3" => floors.volume,
        "m^3/s" => conductance * even,
        // of probes: strain that is a rounding error compared with displacements
        "1" => floors.displacement.max(STRAIN * largest("m")) / length,
        "W" if largest("Pa") <= floors.pressure => f64::INFINITY,
        "W" => conductance * even * even,
        _ => 0.0,
    };
    let number = |column: &HistoryColumn, value: f64| {
        let (unit, factor) = alike(column);
        // compare pressures with those of ports, forces with those that act
        let acting = match unit {
            "Pa" => model.scales.pressure,
            "N" => model.scales.force,
            _ => 0.0,
        };
        // compare extrema of a pressure field, which are all negative under suction, with the whole field
        let extreme = [Observable::MaxPressure, Observable::MinPressure].map(Observable::name);
        let part = if extreme.contains(&column.name.as_str()) {
            1.0
        } else {
            BESIDE
        };
        ReferencedNumber::new(value, (part * largest(unit).max(acting)).max(floor(unit)) / factor)
    };
    Ok(all().map(|(c, x)| (c.name.clone(), number(c, *x))).collect())
}

/// Frequencies and growth rates of the modes: transverse ones by their order, axial ones, those of the fluid.
///
/// # Errors
/// As [`modes::modes`].
pub fn of_modes(case: &Case, at_rest_under: Option<f64>, plan: &ModeOptions) -> Result<RefinedNumbers> {
    let about = match at_rest_under {
        Some(at) => modes::at_equilibrium(case, at)?,
        None => modes::linearise(case, 0.0, None)?,
    };
    let plan = ModeOptions { limits: false, ..*plan };
    let found = modes::compute(about, &plan)?;
    let mut counts = BTreeMap::new();
    let mut all = RefinedNumbers::new();
    for mode in found.modes.iter().filter(|mode| !mode.kind.stays()) {
        let what = sort(mode);
        let count = counts.entry(what).or_insert(0);
        *count += 1;
        let name = format!("{what}_{count}");
        if let Some(value) = mode.frequency_hz() {
            all.insert(format!("{name}_frequency_hz"), ReferencedNumber { value, size: 0.0 });
        }
        let growth = ReferencedNumber::new(mode.s.re, DAMPING * mode.s.norm());
        all.insert(format!("{name}_growth_per_s"), growth);
    }
    Ok(all)
}

/// Kind of a mode, independent of the mesh.
fn sort(mode: &Mode) -> &'static str {
    match mode.shape.transverse() {
        _ if !mode.kind.swings() && mode.kind != TimeBehavior::Volume => "decaying",
        _ if mode.kind == TimeBehavior::Volume || mode.shape.displacement() == 0.0 => "fluid",
        share if share > 0.5 => "across",
        _ => "along",
    }
}

/// Computes the cycle of a case.
///
/// # Errors
/// There is no cycle, or nothing holds the beam.
pub fn cycle(case: &Case, period: Option<f64>, stop: &StopFlag) -> Result<(PeriodicScene, Cycle)> {
    let scene = PeriodicScene::new(case, period)?.heeding(stop);
    scene.held(&case.name)?;
    let cycle = shoot(&scene, None).map_err(fault)?;
    Ok((scene, cycle))
}

/// Figures over a cycle of `periods` periods.
///
/// # Errors
/// As [`cycle`], and if the cycle cannot be followed for a period.
pub fn of_cycle(case: &Case, periods: usize, stop: &StopFlag) -> Result<RefinedNumbers> {
    let (scene, cycle, _) = subharmonic::find_until(case, periods, stop)?;
    recorded(case, &scene, &cycle)
}

fn recorded(case: &Case, scene: &PeriodicScene, cycle: &Cycle) -> Result<RefinedNumbers> {
    let outcome = record::record(case, scene, cycle, &mut Unrecorded(|_| Control::Continue))?;
    if outcome.summary.status != Status::Finished {
        let reason = outcome.summary.reason.unwrap_or_default();
        return Err(match outcome.fault {
            Some(fault) => Error::Solver(Box::new(fault)),
            None => Error::Interrupted(reason),
        });
    }
    of_summary(case, &outcome.summary)
}

/// Figures over a recorded cycle.
pub fn of_summary(case: &Case, summary: &Summary) -> Result<RefinedNumbers> {
    let mut all = RefinedNumbers::new();
    for (name, quantity) in counted(summary, &RoundingScales::from_case(case)?) {
        let largest = quantity.figures().fold(0.0_f64, |s, (_, x)| s.max(x.abs()));
        for (figure, value) in quantity.figures().filter(|(figure, _)| figure.starts_with("window")) {
            all.insert(format!("{name}.{figure}"), ReferencedNumber { value, size: largest });
        }
    }
    Ok(all)
}

/// Figures over the cycle, and `count` multipliers.
///
/// # Errors
/// As [`of_cycle`].
pub fn of_cycle_and_multipliers(case: &Case, periods: usize, count: usize, stop: &StopFlag) -> Result<RefinedNumbers> {
    let (scene, mut cycle, _) = subharmonic::find_until(case, periods, stop)?;
    let mut all = recorded(case, &scene, &cycle)?;
    all.extend(of_stability(&floquet::multipliers(&scene, &mut cycle, count)));
    Ok(all)
}

/// Multipliers of the cycle; their reference size is 1, the limit of stability.
///
/// # Errors
/// As [`cycle`].
pub fn of_multipliers(case: &Case, period: Option<f64>, count: usize, stop: &StopFlag) -> Result<RefinedNumbers> {
    let (scene, mut cycle) = cycle(case, period, stop)?;
    Ok(of_floquet(&floquet::multipliers(&scene, &mut cycle, count)))
}

/// Multipliers of the cycle, and growth rates of those that do not vanish within a period.
///
/// # Errors
/// As [`cycle`].
pub fn of_growth(case: &Case, period: Option<f64>, count: usize, stop: &StopFlag) -> Result<RefinedNumbers> {
    let (scene, mut cycle) = cycle(case, period, stop)?;
    Ok(of_stability(&floquet::multipliers(&scene, &mut cycle, count)))
}

/// Moduli of multipliers, and growth rates of those above [`GONE`].
pub fn of_stability(found: &Floquet) -> RefinedNumbers {
    let mut all = of_floquet(found);
    for (k, m) in found.multipliers.iter().enumerate().filter(|(_, m)| m.modulus > GONE) {
        let growth = ReferencedNumber::new(
            m.growth_per_s,
            DAMPING * m.growth_per_s.hypot(std::f64::consts::TAU * m.frequency_hz),
        );
        all.insert(format!("multiplier_{}.growth_per_s", k + 1), growth);
    }
    all
}

/// Moduli of multipliers.
fn of_floquet(found: &Floquet) -> RefinedNumbers {
    let all = named(found).into_iter();
    all.map(|(name, m)| (format!("{name}.modulus"), ReferencedNumber::new(m.modulus, 1.0)))
        .collect()
}

/// Multipliers named by the dominant part of the motion, such as `mode_1`; of one part, the largest first.
pub fn named(found: &Floquet) -> Vec<(String, &Multiplier)> {
    let mut counts = BTreeMap::new();
    let name = |m: &Multiplier| {
        let part = m.part.to_string().replace(' ', "_");
        let count = counts.entry(part.clone()).or_insert(0);
        *count += 1;
        if *count == 1 { part } else { format!("{part}_{count}") }
    };
    let names: Vec<String> = found.multipliers.iter().map(name).collect();
    names.into_iter().zip(&found.multipliers).collect()
}
