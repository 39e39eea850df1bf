//! `slcbeam periodic`: the steady cycle of a driven case, a self-oscillation, or cycles along a parameter.

use std::process::ExitCode;

use super::arguments::PeriodicArguments;
use super::uncertain;
use super::{interrupt, journal, progress_line, resources, terminal};
use crate::case::parameter::Parameter;
use crate::case::{Case, amounts};
use crate::error::{Error, Result, usage};
use crate::output::Labels;
use crate::output::columns::warnings;
use crate::output::floquet as stability;
use crate::output::folder::SUMMARY;
use crate::output::kind::FolderKind;
use crate::output::numbers::counted;
use crate::output::periodic as files;
use crate::output::recorder::{Finished, FolderRecorder};
use crate::output::report;
use crate::output::summary;
use crate::results;
use crate::results::cycles::CycleResult;
use crate::results::run::Bands;
use crate::run::floquet;
use crate::run::periodic::{PeriodicScene, Settled, record, scene, sensitivity, settle, subharmonic};
use crate::run::record::Control;
use crate::run::summary::Status;
use crate::study::analysis::AnalysisKind;
use crate::study::evaluations::Evaluations;
use crate::study::refine::{self, meshes::Meshes};
use crate::study::stability::{PathRequest, along, backbone};

/// Number of reported multipliers.
const COUNT: usize = 6;
/// Largest number of values of a sweep.
const MOST_VALUES: usize = 10_000;

/// Finds the cycle or the cycles, writes the folder, prints the text.
pub fn periodic(asked: &PeriodicArguments) -> Result<ExitCode> {
    let alone = "--uncertain applies to one cycle, not to --sweep. For samples of cycles, use slcbeam sweep CASE \
                 --command periodic --vary POINTER=normal:MEAN:SD --design sobol:64";
    asked.uncertain.refuse(asked.sweep.is_some(), alone)?;
    match &asked.sweep {
        Some(_) if asked.periods != 1 => usage("--periods applies to one cycle, not to --sweep"),
        Some(text) => sweep(asked, text),
        None => one(asked),
    }
}

fn load(asked: &PeriodicArguments, more: Option<String>) -> Result<Case> {
    let case = resources::load_varied(&asked.case.case, [&asked.case.sets, more.as_slice()], 0)?;
    scene::system(&case)?;
    Ok(case)
}

fn one(asked: &PeriodicArguments) -> Result<ExitCode> {
    let case = load(asked, None)?;
    let beside = asked.periods != 1 || asked.accuracy.is_some();
    let alone = "--uncertain cannot be combined with --periods or --accuracy";
    asked.uncertain.refuse(beside, alone)?;
    let uncertain = asked
        .uncertain
        .begin(&asked.case, &case, AnalysisKind::Periodic, asked.result.quiet)?;
    let parameters = Parameter::all(&case, &asked.sensitivities)?;
    if !parameters.is_empty() {
        sensitivity::allowed(&case, &PeriodicScene::new(&case, None)?, &parameters)?;
    }
    let result = asked.result.place.claim(&case, FolderKind::Cycle)?;
    let out = result.dir().to_path_buf();
    let stop = asked.result.wall.stop();
    let bar = progress_line::line(asked.result.quiet);
    bar.set_message("searching for the cycle");
    let accuracy = asked.accuracy.map(progress_line::accuracy).transpose()?;
    let mut of = |case: &Case| refine::numbers::of_cycle(case, asked.periods, &stop);
    let asked_for = refine::if_asked(&case, accuracy, true, &mut of);
    let asked_for = interrupt::before_a_cycle(asked_for, &stop)?;
    let case = asked_for.as_ref().map_or(&case, |(chosen, _)| chosen);
    let found = subharmonic::find_until(case, asked.periods, &stop);
    let (scene, cycle, periods) = interrupt::before_a_cycle(found, &stop)?;
    let periods = (asked.periods > 1).then_some(periods);
    let mut settled = settle(case, scene, cycle)?;
    let found = floquet::multipliers(&settled.scene, &mut settled.cycle, COUNT);
    let (case, scene) = (&settled.case, &settled.scene);
    let labels = Labels {
        case_name: case.name.clone(),
        case: case.written(),
        frequency_hz: Some(1.0 / scene.drive.period),
        ..Labels::from_case(case)
    };
    let mut recorder = FolderRecorder::new(result, labels, Box::new(|_| Control::Continue));
    let mut outcome = match parameters.is_empty() {
        true => record::record(case, scene, &settled.cycle, &mut recorder)?,
        false => sensitivity::differentiate(&mut settled, &parameters, &mut recorder)?,
    };
    let Settled {
        case, cycle, refined, ..
    } = settled;
    outcome.summary.accuracy = asked_for.map(|(_, accuracy)| accuracy);
    let short = outcome.summary.accuracy.as_ref().and_then(refine::warning);
    let ended = outcome.summary.status == Status::Finished;
    let meshes = if outcome.summary.accuracy.is_none() && ended {
        bar.set_message("repeating on other meshes");
        let mut here = refine::numbers::of_summary(&case, &outcome.summary)?;
        here.extend(refine::numbers::of_stability(&found));
        let mut of = |case: &Case| refine::numbers::of_cycle_and_multipliers(case, asked.periods, COUNT, &stop);
        Some(refine::meshes::judge(&case, &here, &mut of)?)
    } else {
        None
    };
    bar.finish_and_clear();
    let by_mesh = meshes.as_ref().and_then(Meshes::warning);
    outcome.summary.warnings.extend(by_mesh.into_iter().chain(short));
    let finished = recorder.finish(&outcome.summary);
    let mut document = CycleResult {
        case: case.name.clone(),
        cycle: cycle.search,
        periods,
        floquet: found,
        bands: Bands::new(),
        warnings: outcome.summary.warnings.clone(),
        refined,
        accuracy: outcome.summary.accuracy.clone(),
        meshes,
    };
    let finished = finished.and_then(|finished| {
        outcome.summary.tables_crc32.clone_from(&finished.tables_crc32);
        finished
            .folder()
            .write(files::CYCLE, results::text(&document).as_bytes())?;
        Ok(finished)
    });
    let uncertainty = match ended {
        true => uncertain::compute(uncertain.as_ref(), finished.as_ref().ok().map(Finished::folder))?,
        false => None,
    };
    document.bands = uncertain::bands(uncertainty.as_ref());
    outcome.summary.bands.clone_from(&document.bands);
    let text = || results::text(&document);
    let written = finished.and_then(|finished| {
        let summed = || summary::to_json(&outcome.summary);
        let with_bands: [(&str, &dyn Fn() -> String); 2] = [(SUMMARY, &summed), (files::CYCLE, &text)];
        uncertain::write(uncertainty.as_ref(), finished.folder(), &with_bands)?;
        report::write(&out, None)?;
        finished.close().map(|_| ())
    });
    let words = || {
        let figures = files::figures(&outcome.summary, document.floquet.period_s, &|name| {
            document.error(name)
        });
        let (search, words) = (files::search(&document.cycle), stability::describe(&document));
        let slopes = files::slopes(&outcome.summary);
        let spread = uncertain::below(uncertainty.as_ref());
        format!("{words}\n{figures}{slopes}{search}{spread}")
    };
    super::print_result(asked.json, &out, written, text, words)?;
    Ok(terminal::exit_code(outcome.fault.as_ref()))
}

fn sweep(asked: &PeriodicArguments, text: &str) -> Result<ExitCode> {
    let (pointer, values, logarithmic) = parse(text)?;
    let cases = values
        .into_iter()
        .map(|value| Ok((value, load(asked, Some(format!("{pointer}={value}")))?)))
        .collect::<Result<Vec<_>>>()?;
    let Some((_, first)) = cases.first() else {
        return usage(format!("--sweep {text}: no values"));
    };
    let mut folder = asked.result.place.claim(first, FolderKind::Sweep)?;
    let first = first.clone();
    let evaluations = Evaluations::default();
    let resonance = asked.resonance.as_deref().unwrap_or_default();
    let settings = format!("{:?} {text} {resonance}", asked.case.sets);
    journal::begin(&evaluations, &folder, ("periodic --sweep", &first, &settings))?;
    let stop = asked.result.wall.stop();
    let bar = progress_line::line(asked.result.quiet);
    let request = PathRequest {
        pointer: &pointer,
        logarithmic,
        cases: &cases,
        case_at: &|value| {
            resources::load_varied(&asked.case.case, [&asked.case.sets, &[format!("{pointer}={value}")]], 0)
        },
    };
    let report = |done: usize| {
        bar.set_message(format!("{done} of {}", counted(cases.len() as u64, "cycle")));
        bar.tick();
    };
    let found = match &asked.resonance {
        Some(frequency) => backbone(&request, frequency, &evaluations, &stop, &report),
        None => along(&request, &evaluations, &stop, &report),
    };
    bar.finish_and_clear();
    let stopped = stop.raised();
    let found = journal::outcome(found, &folder, stopped)?;
    let written = files::write(&mut folder, &found).and(report::complete(&folder, &first));
    let written = journal::end(&evaluations, &folder, stopped, written);
    let words = || files::describe(&found) + &warnings(&found.warnings);
    super::print_result(asked.json, folder.dir(), written, || results::text(&found), words)?;
    Ok(ExitCode::from(if found.members.is_empty() { 4 } else { 0 }))
}

/// Pointer and values of a sweep, and true if they are spaced logarithmically.
fn parse(text: &str) -> Result<(String, Vec<f64>, bool)> {
    let wrong = || {
        Error::Usage(format!(
            "--sweep {text}: expected a pointer, an ascending or descending range and a number of values, such as \
             /network/permeability_factor=0.01:1:25:log; at most {MOST_VALUES} values, and log for values > 0 only"
        ))
    };
    let (pointer, rest) = text.rsplit_once('=').ok_or_else(wrong)?;
    if let Some(said) = amounts::rewritten("--sweep", pointer, rest) {
        return usage(format!("--sweep '{text}': {said}"));
    }
    let (rest, logarithmic) = rest.strip_suffix(":log").map_or((rest, false), |rest| (rest, true));
    let (range, count) = rest.rsplit_once(':').ok_or_else(wrong)?;
    let (from, to) = progress_line::either_way(range).ok_or_else(wrong)?;
    let count: usize = count.trim().parse().map_err(|_| wrong())?;
    if !(2..=MOST_VALUES).contains(&count) || (logarithmic && from.min(to) <= 0.0) {
        return Err(wrong());
    }
    Ok((
        pointer.into(),
        progress_line::spread(from, to, count, logarithmic),
        logarithmic,
    ))
}
