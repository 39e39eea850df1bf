//! `slcbeam modes`: frequencies, damping, shapes and stability of small motions.

use std::process::ExitCode;

use super::arguments::ModesArguments;
use super::floquet;
use super::uncertain;
use super::{progress_line, resources, terminal};
use crate::case::parameter::Parameter;
use crate::case::{Case, inherited};
use crate::discrete::System;
use crate::error::{Result, usage};
use crate::output::kind::FolderKind;
use crate::output::modes::{self as files, Report};
use crate::results::modes::LinearisedState;
use crate::results::run::Bands;
use crate::run::early_warnings;
use crate::run::equilibrium;
use crate::run::modes::{self, ModeFilter, ModeOptions, sort};
use crate::study::analysis::AnalysisKind;
use crate::study::refine;

/// Finds the modes, writes the folder, prints the table and the conclusions.
pub fn modes(asked: &ModesArguments) -> Result<ExitCode> {
    if let Some(parameters) = &asked.map.map {
        let alone = "--uncertain applies to single modes, not to a --map. For a point of the map, use slcbeam floquet CASE \
                     --set .. --uncertain ..";
        asked.uncertain.refuse(true, alone)?;
        let case = floquet::load(&asked.case)?;
        return floquet::map(&case, (&asked.map, parameters), &asked.result, asked.json);
    }
    let plan = plan(asked)?;
    let kind = asked.kind.map(ModeFilter::from);
    let case = resources::load(&asked.case)?;
    let system = System::new(&case)?;
    let own = (asked.at, asked.near, asked.accuracy) == (None, None, None);
    let alone = "--uncertain applies to the lowest oscillating modes about the start: it cannot be combined with --at, \
                 --near or --accuracy";
    asked.uncertain.refuse(!own, alone)?;
    let uncertain = asked
        .uncertain
        .begin(&asked.case, &case, AnalysisKind::Modes, asked.result.quiet)?;
    let mut folder = asked.result.place.claim(&case, FolderKind::Modes)?;
    asked.result.wall.flag();
    if !asked.result.quiet {
        terminal::print_line(&format!("modes of {}", case.name));
    }
    let accuracy = asked.accuracy.map(progress_line::accuracy).transpose()?;
    let mut of = |case: &Case| refine::numbers::of_modes(case, asked.at, &plan);
    let refined = refine::if_asked(&case, accuracy, false, &mut of)?;
    let (case, system) = match &refined {
        Some((chosen, _)) => (chosen, System::new(chosen)?),
        None => (&case, system),
    };
    let (about, state) = match asked.at {
        Some(at) => (modes::at_equilibrium(case, at)?, LinearisedState::Equilibrium),
        None => (modes::linearise(case, 0.0, None)?, LinearisedState::Start),
    };
    let mut known = early_warnings::at_rest(case, &system);
    known.extend(early_warnings::instant(case, asked.at));
    known.extend(inherited::varied(case, asked.sensitivity.iter().map(String::as_str)));
    if let Some(at) = asked.at {
        known.extend(equilibrium::trapped(case, &equilibrium::EquilibriumOptions::at(at))?);
    }
    let parameters = Parameter::all(case, &asked.sensitivity)?;
    let (mut found, wider) = sort::of_sort(about, &plan, kind)?;
    refine::meshes::judge_modes(case, asked.at, &wider, &mut found)?;
    sort::arrange(&mut found.modes, kind, &plan);
    let sensitivities = modes::differentiate(case, asked.at, &found.about, &found.modes, &parameters)?;
    let report = Report {
        case: &case.name,
        plan: &plan,
        sort: kind,
        found: &found,
        state,
        sensitivities: &sensitivities,
        accuracy: refined.as_ref().map(|(_, accuracy)| accuracy),
        known: &known,
        bands: &Bands::new(),
    };
    let written = files::write(&mut folder, &report);
    let uncertainty = uncertain::compute(uncertain.as_ref(), Some(&folder))?;
    let bands = &uncertain::bands(uncertainty.as_ref());
    let report = Report { bands, ..report };
    let json = || files::json(&report);
    let place = (&folder, case);
    let written = uncertain::complete(uncertainty.as_ref(), place, written, &[(files::JSON, &json)]);
    let words = || {
        let spread = uncertain::below(uncertainty.as_ref());
        format!("{}\n{}\n{spread}", files::table(&report), report.sentences())
    };
    super::print_result(asked.json, folder.dir(), written, json, words)
}

/// Largest number of modes: a longer spectrum answers no question, and its shapes fill the memory.
const MOST: usize = 1000;

fn plan(asked: &ModesArguments) -> Result<ModeOptions> {
    if !(1..=MOST).contains(&asked.count) {
        return usage(format!("--count {}: expected from 1 to {MOST} modes", asked.count));
    }
    let near_hz = asked.near.unwrap_or(0.0);
    if !(near_hz.is_finite() && near_hz >= 0.0) {
        return usage(format!("--near {near_hz}: expected a frequency of 0 Hz or more"));
    }
    if let Some(at) = asked.at.filter(|at| !(at.is_finite() && *at >= 0.0)) {
        return usage(format!("--at {at}: expected a time of 0 s or more"));
    }
    Ok(ModeOptions {
        count: asked.count,
        near_hz,
        limits: true,
    })
}
