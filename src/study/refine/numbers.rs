//! What each command computes, as numbers that can be compared from mesh to mesh.

use std::collections::BTreeMap;

use super::{Number, Numbers};
use crate::case::Case;
use crate::discrete::quantities::{Observable, probes};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::run::equilibrium::{self, Options, Path};
use crate::run::floquet::{self, Floquet, Multiplier};
use crate::run::modes::{self, Kind, Mode, Plan};
use crate::run::periodic::scene::fault;
use crate::run::periodic::{Cycle, Scene, record, shoot, subharmonic};
use crate::run::record::{Column, Control, Unrecorded};
use crate::run::stop::Stop;
use crate::run::summary::{Status, Summary};
use crate::study::counted::{Floors, counted};

/// Numbers of a unit below this part of others are round-off.
const NOTHING: f64 = 1e-6;
/// A number counts beside this part of the largest of its kind: its error is relative to the larger of both.
const BESIDE: f64 = 0.01;
/// Strain that is round-off beside moving as a whole.
const STRAIN: f64 = 1e-9;
/// Multipliers below this are of what is gone after a period.
pub const GONE: f64 = 0.01;
/// A rate of growth counts beside this part of the mode's own frequency.
const DAMPING: f64 = 0.01;

/// The last state of a load path.
///
/// # Errors
/// Where the path ends before.
pub fn of_equilibrium(case: &Case, options: &Options) -> Result<Numbers> {
    let path = equilibrium::follow(case, options, &mut |_| Control::Continue)?;
    if let Some(fault) = path.fault {
        return Err(Error::Solver(Box::new(fault)));
    }
    let columns = equilibrium::columns(&equilibrium::system(case, options.at_s)?);
    of_path(case, &columns, &path)
}

/// The last state of a load path that was followed.
pub fn of_path(case: &Case, columns: &[Column], path: &Path) -> Result<Numbers> {
    let row = path.states.last().map_or(&[][..], |state| &state.row);
    let length = case.beam.length_m;
    let modulus = case.beam.young_modulus_pa;
    // an angle counts beside displacements, a stress of the solid beside strains
    let alike = |column: &Column| match column.unit {
        "rad" => ("m", length),
        "Pa" if probes::is_stress(&column.name) => ("1", 1.0 / modulus),
        unit => (unit, 1.0),
    };
    let all = || columns.iter().zip(row).skip(1);
    let largest = |unit: &str| {
        let same = all().map(|(c, x)| (alike(c), x)).filter(|((u, _), _)| *u == unit);
        same.map(|((_, factor), x)| factor * x.abs()).fold(0.0, f64::max)
    };
    // what nothing moves or presses is round-off, and so is all that is made of it
    let (floors, model) = (Floors::of(case)?, Model::new(case)?);
    // pressures that differ by no more are equal, and drive no flow
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
        // of probes: strain that is round-off beside what moves
        "1" => floors.displacement.max(STRAIN * largest("m")) / length,
        "W" if largest("Pa") <= floors.pressure => f64::INFINITY,
        "W" => conductance * even * even,
        _ => 0.0,
    };
    let number = |column: &Column, value: f64| {
        let (unit, factor) = alike(column);
        // a pressure counts beside those of ports, a force beside those that act
        let acting = match unit {
            "Pa" => model.scales.pressure,
            "N" => model.scales.force,
            _ => 0.0,
        };
        // the largest of a field of pressures, which are all negative under suction, counts beside the field
        let extreme = [Observable::MaxPressure, Observable::MinPressure].map(Observable::name);
        let part = if extreme.contains(&column.name.as_str()) {
            1.0
        } else {
            BESIDE
        };
        Number::new(value, (part * largest(unit).max(acting)).max(floor(unit)) / factor)
    };
    Ok(all().map(|(c, x)| (c.name.clone(), number(c, *x))).collect())
}

/// Frequencies and rates of the modes: those across by their order, those along, those of the fluid.
///
/// # Errors
/// As [`modes::modes`].
pub fn of_modes(case: &Case, at_rest_under: Option<f64>, plan: &Plan) -> Result<Numbers> {
    let about = match at_rest_under {
        Some(at) => modes::at_equilibrium(case, at)?,
        None => modes::linearise(case, 0.0, None)?,
    };
    let plan = Plan { limits: false, ..*plan };
    let found = modes::of(about, &plan)?;
    let mut counts = BTreeMap::new();
    let mut all = Numbers::new();
    for mode in found.modes.iter().filter(|mode| !mode.kind.stays()) {
        let what = sort(mode);
        let count = counts.entry(what).or_insert(0);
        *count += 1;
        let name = format!("{what}_{count}");
        if let Some(value) = mode.frequency_hz() {
            all.insert(format!("{name}_frequency_hz"), Number { value, size: 0.0 });
        }
        let growth = Number::new(mode.s.re, DAMPING * mode.s.norm());
        all.insert(format!("{name}_growth_per_s"), growth);
    }
    Ok(all)
}

/// What of a mode does not depend on the mesh.
fn sort(mode: &Mode) -> &'static str {
    match mode.shape.transverse() {
        _ if !mode.kind.swings() && mode.kind != Kind::Volume => "decaying",
        _ if mode.kind == Kind::Volume || mode.shape.displacement() == 0.0 => "fluid",
        share if share > 0.5 => "across",
        _ => "along",
    }
}

/// The cycle of a case.
///
/// # Errors
/// Where there is none, or nothing holds the beam.
pub fn cycle(case: &Case, period: Option<f64>, stop: &Stop) -> Result<(Scene, Cycle)> {
    let scene = Scene::new(case, period)?.heeding(stop);
    scene.held(&case.name)?;
    let cycle = shoot(&scene, None).map_err(fault)?;
    Ok((scene, cycle))
}

/// Figures over the cycle of so many periods.
///
/// # Errors
/// As [`cycle`], and where the cycle cannot be followed for a period.
pub fn of_cycle(case: &Case, periods: usize, stop: &Stop) -> Result<Numbers> {
    let (scene, cycle, _) = subharmonic::find_until(case, periods, stop)?;
    recorded(case, &scene, &cycle)
}

fn recorded(case: &Case, scene: &Scene, cycle: &Cycle) -> Result<Numbers> {
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

/// Figures over a cycle that was recorded.
pub fn of_summary(case: &Case, summary: &Summary) -> Result<Numbers> {
    let mut all = Numbers::new();
    for (name, quantity) in counted(summary, &Floors::of(case)?) {
        let largest = quantity.figures().fold(0.0_f64, |s, (_, x)| s.max(x.abs()));
        for (figure, value) in quantity.figures().filter(|(figure, _)| figure.starts_with("window")) {
            all.insert(format!("{name}.{figure}"), Number { value, size: largest });
        }
    }
    Ok(all)
}

/// Figures over the cycle, and so many multipliers.
///
/// # Errors
/// As [`of_cycle`].
pub fn of_cycle_and_multipliers(case: &Case, periods: usize, count: usize, stop: &Stop) -> Result<Numbers> {
    let (scene, mut cycle, _) = subharmonic::find_until(case, periods, stop)?;
    let mut all = recorded(case, &scene, &cycle)?;
    all.extend(of_stability(&floquet::multipliers(&scene, &mut cycle, count)));
    Ok(all)
}

/// The multipliers of the cycle: each beside one, at which stability ends.
///
/// # Errors
/// As [`cycle`].
pub fn of_multipliers(case: &Case, period: Option<f64>, count: usize, stop: &Stop) -> Result<Numbers> {
    let (scene, mut cycle) = cycle(case, period, stop)?;
    Ok(of_floquet(&floquet::multipliers(&scene, &mut cycle, count)))
}

/// The multipliers of the cycle, and how fast that grows or decays which is not gone after a period.
///
/// # Errors
/// As [`cycle`].
pub fn of_growth(case: &Case, period: Option<f64>, count: usize, stop: &Stop) -> Result<Numbers> {
    let (scene, mut cycle) = cycle(case, period, stop)?;
    Ok(of_stability(&floquet::multipliers(&scene, &mut cycle, count)))
}

/// Multipliers that were found, and what is shown of them.
pub fn of_stability(found: &Floquet) -> Numbers {
    let mut all = of_floquet(found);
    for (k, m) in found.multipliers.iter().enumerate().filter(|(_, m)| m.modulus > GONE) {
        let growth = Number::new(
            m.growth_per_s,
            DAMPING * m.growth_per_s.hypot(std::f64::consts::TAU * m.frequency_hz),
        );
        all.insert(format!("multiplier_{}.growth_per_s", k + 1), growth);
    }
    all
}

/// Multipliers that were found.
fn of_floquet(found: &Floquet) -> Numbers {
    let all = named(found).into_iter();
    all.map(|(name, m)| (format!("{name}.modulus"), Number::new(m.modulus, 1.0)))
        .collect()
}

/// Multipliers by the part of the motion that each is mostly of, `mode_1`; of one part the largest first.
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
