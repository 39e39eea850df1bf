//! The row of a case, by each command: what the command itself would tell, without its files.

use std::cell::Cell;

use serde::Serialize;

use super::multipliers::multipliers;
use super::plan::What;
use super::power::{self, POWERS};
use super::row::Found;
use crate::case::Case;
use crate::discrete::System;
use crate::error::{Code, Result};
use crate::run::dynamics::{self, Outcome};
use crate::run::equilibrium::{self, Options, Path};
use crate::run::floquet::{self, Floquet, Stability};
use crate::run::modes;
use crate::run::periodic::{Scene, Settled, record, settle, shoot};
use crate::run::record::{Column, Control, Progress, Unrecorded};
use crate::run::stop::Stop;
use crate::run::summary::{Accuracy, Quantity, Status, Summary};
use crate::run::{known, periodic, slow};
use crate::study::evaluations::Evaluations;
use crate::study::refine::{self, meshes, numbers};
use crate::study::{companion, target};

/// Modes told, those lowest.
pub const MODES: usize = 6;
/// Modes looked for at most, where few of the slowest swing.
const MOST_MODES: usize = 384;
/// Damping ratio above which a mode falls to less than a thirtieth within a period: it hardly swings.
const STRONG: f64 = 0.5;
/// Multipliers looked at.
const MULTIPLIERS: usize = 2;
/// Whether an accuracy that was asked for is reached, 1 or 0.
pub const ACCURACY: &str = "accuracy_reached";
/// Points on a path of equilibria at least, as the command has them.
const POINTS: usize = 16;

/// What is asked of every case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ask {
    /// The command.
    pub what: What,
    /// Relative error below which every figure is wanted.
    pub accuracy: Option<f64>,
    /// Mesh and tolerance with which a search for it begins.
    pub from: Option<target::Setting>,
    /// True if errors are measured: by a companion of a run, by two or three meshes of what other commands compute.
    pub meshes: bool,
}

/// Looks at what can be told before anything is computed.
///
/// # Errors
/// In the words of the command.
pub fn check(case: &Case, what: What) -> Result<()> {
    match what {
        What::Run | What::Modes => System::new(case).map(|_| ()),
        What::Equilibrium => equilibrium::system(case, case.time.end_s).map(|_| ()),
        What::Periodic | What::Floquet => Scene::new(case, None)?.held(&case.name),
    }
}

/// Computes a case; `run` runs it in time, where that is asked for. `None` where `stop` became true on the way.
pub fn found(case: &Case, ask: Ask, stop: &dyn Fn() -> bool, run: &dyn Fn(&Case) -> Result<Outcome>) -> Option<Found> {
    let found = match ask.what {
        What::Run => run(case).map(|outcome| of_run(&outcome.summary)),
        What::Periodic => cycle(case, ask),
        What::Floquet => multipliers(case, ask),
        What::Equilibrium => at_rest(case, ask, stop),
        What::Modes => small(case, ask),
    };
    if stop() {
        return None;
    }
    Some(found.unwrap_or_else(|error| Found::failed(&error)))
}

/// What was found of a case under a key of a journal, with its warnings, or what `found` finds.
pub fn stored(
    evaluations: &Evaluations,
    key: &impl Serialize,
    stop: &dyn Fn() -> bool,
    found: impl FnOnce() -> Option<Found>,
) -> Option<Found> {
    let apart = |mut found: Found| {
        let told = std::mem::take(&mut found.told);
        (found, told)
    };
    let (found, told) = evaluations.get(key, stop, || found().map(apart))?;
    Some(Found { told, ..found })
}

/// Runs a case for its summary alone.
///
/// # Errors
/// Those of [`companion::run`].
pub fn run(case: &Case, ask: Ask, stop: &dyn Fn() -> bool) -> Result<Outcome> {
    let wait = Cell::new(0_u32);
    let hook = |_: &Progress| {
        wait.set(wait.get() + 1);
        match wait.get().is_multiple_of(16) && stop() {
            true => Control::Stop("interrupted".into()),
            false => Control::Continue,
        }
    };
    match ask.accuracy {
        None if ask.meshes => target::effects::run(case, &mut Unrecorded(hook)),
        None => dynamics::run(case, &mut Unrecorded(hook)),
        Some(accuracy) => target::reach(case, accuracy, ask.from.as_ref(), &mut |case, accuracy| {
            companion::measured(case, System::new(case)?, accuracy, &mut Unrecorded(hook))
        }),
    }
}

/// What a summary tells.
pub fn of_run(summary: &Summary) -> Found {
    let mut found = Found {
        status: summary.status,
        reason: summary.reason.clone(),
        steps: Some(summary.solver.steps),
        figures: vec![],
        warnings: vec![],
        told: vec![],
    };
    found.warn(&summary.warnings);
    // what never began has no figures, and zeros would pass for some
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
        short(&mut found, accuracy);
    }
    found
}

/// Every figure of a quantity.
fn put(found: &mut Found, name: &str, quantity: &Quantity) {
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

/// The steady cycle.
fn cycle(case: &Case, ask: Ask) -> Result<Found> {
    let mut of = |case: &Case| numbers::of_cycle(case, 1, &Stop::default());
    let refined = ask
        .accuracy
        .map(|accuracy| refine::refine(case, accuracy, true, &mut of))
        .transpose()?;
    let case = refined.as_ref().map_or(case, |(chosen, _)| chosen);
    let scene = Scene::new(case, None)?;
    scene.held(&case.name)?;
    let first = shoot(&scene, None).map_err(periodic::scene::fault)?;
    let Settled {
        case, scene, mut cycle, ..
    } = settle(case, scene, first)?;
    let stability = floquet::multipliers(&scene, &mut cycle, MULTIPLIERS);
    let outcome = record::record(&case, &scene, &cycle, &mut Unrecorded(|_| Control::Continue))?;
    let summary = &outcome.summary;
    let mut found = of_cycle(summary, scene.drive.period, cycle.search.work.steps, Some(&stability));
    if let Some((_, accuracy)) = &refined {
        reached(&mut found, accuracy, &|name| name.into());
        power::share_errors(&mut found);
    } else if ask.meshes && summary.status == Status::Finished {
        let here = numbers::of_summary(&case, summary)?;
        let by_mesh = meshes::judge(&case, &here, &mut of)?;
        off(&mut found, &by_mesh, &|name| name.into());
        power::share_errors(&mut found);
    }
    found.warn(&summary.warnings);
    Ok(found)
}

/// What the summary of a cycle tells, over its period [s], and its stability, where that is known.
pub fn of_cycle(summary: &Summary, period: f64, steps: u64, stability: Option<&Floquet>) -> Found {
    let mut found = Found {
        steps: Some(steps),
        status: summary.status,
        reason: summary.reason.clone(),
        ..Found::finished()
    };
    found.put("period_s", period);
    if let Some(all) = stability {
        let stable = all.verdict.stability != Stability::Unstable;
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

/// Errors of an accuracy that was asked for.
fn reached(found: &mut Found, accuracy: &Accuracy, name: &dyn Fn(&str) -> String) {
    for (own, estimate) in &accuracy.quantities {
        found.put(format!("{}.error", name(own)), estimate.total);
    }
    short(found, accuracy);
}

/// Whether an accuracy that was asked for is reached: a row that lacks it tells so by its reason too.
fn short(found: &mut Found, accuracy: &Accuracy) {
    found.put(ACCURACY, f64::from(u8::from(accuracy.reached)));
    if let (false, None, Status::Finished) = (accuracy.reached, &found.reason, found.status) {
        found.reason = Some(format!(
            "{} accuracy {:e} is not reached",
            Code::Accuracy.id(),
            accuracy.asked
        ));
    }
    found.warn(refine::warning(accuracy).as_slice());
}

/// Errors that meshes make.
fn off(found: &mut Found, by_mesh: &meshes::Meshes, name: &dyn Fn(&str) -> String) {
    for (own, share) in &by_mesh.quantities {
        let total = share.known().then(|| share.total());
        found.put(format!("{}.error", name(own)), total);
    }
    found.warn(by_mesh.warning().as_slice());
}

/// How the equilibrium under the loads at the end of a case is sought.
pub fn at_the_end(case: &Case) -> Options {
    Options {
        points: Some(POINTS),
        ..Options::at(case.time.end_s)
    }
}

/// The equilibrium under the loads at the end.
fn at_rest(case: &Case, ask: Ask, stop: &dyn Fn() -> bool) -> Result<Found> {
    let options = at_the_end(case);
    let mut of = |case: &Case| numbers::of_equilibrium(case, &options);
    let refined = ask
        .accuracy
        .map(|accuracy| refine::refine(case, accuracy, false, &mut of))
        .transpose()?;
    let case = refined.as_ref().map_or(case, |(chosen, _)| chosen);
    let path = equilibrium::follow(case, &options, &mut |_| match stop() {
        true => Control::Stop("interrupted".into()),
        false => Control::Continue,
    })?;
    let system = equilibrium::system(case, options.at_s)?;
    let columns = equilibrium::columns(&system);
    let mut found = of_path(&columns, &path);
    let key = |name: &str| {
        let column = columns.iter().find(|column| column.name == name);
        column.map_or_else(|| name.into(), |column| column.key())
    };
    if let Some((_, accuracy)) = &refined {
        reached(&mut found, accuracy, &key);
    } else if ask.meshes && path.fault.is_none() {
        let here = numbers::of_path(case, &columns, &path)?;
        let by_mesh = meshes::judge_at_rest(case, &here, &mut of)?;
        off(&mut found, &by_mesh, &key);
    }
    found.warn(&known::at_rest(case, &system));
    found.warn(slow::warning(case, &system, options.at_s).as_slice());
    found.warn(&path.warnings());
    Ok(found)
}

/// What the last state of a path tells.
pub fn of_path(columns: &[Column], path: &Path) -> Found {
    let mut found = Found {
        steps: Some(path.work.iterations),
        ..Found::finished()
    };
    if let Some(fault) = &path.fault {
        found.status = Status::Failed;
        found.reason = Some(format!("{} {}", fault.code.id(), fault.what));
    }
    if let Some(last) = path.states.last() {
        for (column, value) in columns.iter().zip(&last.row) {
            found.put(column.key(), *value);
        }
        let stability = last.stability.as_ref();
        found.put("stable", stability.map(|s| f64::from(u8::from(s.unstable == 0))));
        found.put("unstable_modes", stability.map(|s| s.unstable as f64));
    }
    found
}

/// Modes about the start of a case, so many that six of them swing, as far as there are so many; and what was looked for.
///
/// # Errors
/// Those of [`modes::modes`].
pub fn swinging(case: &Case) -> Result<(modes::Modes, modes::Plan)> {
    let mut plan = modes::Plan {
        count: 2 * MODES,
        near_hz: 0.0,
        limits: false,
    };
    loop {
        let found = modes::modes(case, &plan)?;
        if lowest(&found.modes).len() == MODES || found.modes.len() < plan.count || plan.count >= MOST_MODES {
            return Ok((found, plan));
        }
        plan.count *= 2;
    }
}

/// Places of those that swing among modes, the lowest first.
pub fn lowest(all: &[modes::Mode]) -> Vec<usize> {
    let mut swinging: Vec<usize> = (0..all.len()).filter(|k| all[*k].kind.swings()).collect();
    swinging.sort_by(|a, b| all[*a].s.im.total_cmp(&all[*b].s.im));
    swinging.truncate(MODES);
    swinging
}

/// Small motions about the start: the lowest that swing.
fn small(case: &Case, ask: Ask) -> Result<Found> {
    let (mut all, plan) = swinging(case)?;
    let mut of = |case: &Case| numbers::of_modes(case, None, &plan);
    let refined = ask
        .accuracy
        .map(|accuracy| refine::refine(case, accuracy, false, &mut of))
        .transpose()?;
    let case = match &refined {
        None => case,
        Some((chosen, _)) => {
            all = modes::modes(chosen, &plan)?;
            chosen
        }
    };
    if ask.meshes && refined.is_none() {
        modes::compare_meshes(case, None, &plan, &mut all);
    }
    let mut found = of_modes(&all);
    if let Some((_, accuracy)) = &refined {
        short(&mut found, accuracy);
        let worst = accuracy.quantities.values().filter_map(|estimate| estimate.total);
        found.put("largest_error", worst.reduce(f64::max));
    }
    found.warn(&known::at_rest(case, &System::new(case)?));
    // what is told of is warned of
    all.modes = lowest(&all.modes)
        .into_iter()
        .map(|place| all.modes[place].clone())
        .collect();
    found.warn(&all.warnings("the start"));
    Ok(found)
}

/// What modes tell: the lowest that swing.
pub fn of_modes(all: &modes::Modes) -> Found {
    let mut found = Found::finished();
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
        found.put(format!("{name}.frequency_bound_hz"), mode.error / std::f64::consts::TAU);
        found.put(format!("{name}.frequency_hz.error"), mode.mesh_error());
        found.put(format!("{name}.damping_ratio"), mode.damping_ratio());
        found.put(format!("{name}.damping_ratio_bound"), mode.error / size);
        found.put(format!("{name}.damping_ratio.error"), mode.rate_error());
        found.put(format!("{name}.growth_per_s"), mode.s.re);
        let strong = mode.damping_ratio().map(|ratio| f64::from(u8::from(ratio > STRONG)));
        found.put(format!("{name}.strongly_damped"), strong);
    }
    found
}
