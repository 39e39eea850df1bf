//! `slcbeam floquet`: multipliers of the steady cycle, or a stability map over frequency and amplitude of shaking.

use std::process::ExitCode;

use super::arguments::{CaseArguments, FloquetArguments, MapArguments, ResultArguments};
use super::uncertain;
use super::{interrupt, journal, progress_line, resources};
use crate::case::Case;
use crate::error::{Error, Result, usage};
use crate::output::columns::warnings;
use crate::output::floquet as files;
use crate::output::kind::FolderKind;
use crate::output::numbers::counted;
use crate::output::report;
use crate::results;
use crate::results::cycles::CycleResult;
use crate::results::run::Bands;
use crate::run::early_warnings;
use crate::run::floquet;
use crate::run::periodic::scene::{self, fault};
use crate::run::periodic::{PeriodicScene, shoot};
use crate::study::analysis::AnalysisKind;
use crate::study::evaluations::Evaluations;
use crate::study::refine::{self, meshes::Meshes};
use crate::study::stability::tongue::{self, MapRange};

/// Largest number of points of a map.
const MOST_POINTS: usize = 100_000;

/// Finds cycle and multipliers, or the map; writes the folder, prints the text.
pub fn floquet(asked: &FloquetArguments) -> Result<ExitCode> {
    let case = &load(&asked.case)?;
    let alone = "--uncertain applies to one cycle, not to a --map. For a point of the map, use slcbeam floquet CASE --set \
                 .. --uncertain ..";
    asked.uncertain.refuse(asked.map.map.is_some(), alone)?;
    match &asked.map.map {
        Some(parameters) => map(case, (&asked.map, parameters), &asked.result, asked.json),
        None => one(asked, case),
    }
}

/// Reads a case that can have a cycle.
pub fn load(asked: &CaseArguments) -> Result<Case> {
    let case = resources::load(asked)?;
    scene::system(&case)?;
    Ok(case)
}

fn one(asked: &FloquetArguments, case: &Case) -> Result<ExitCode> {
    if asked.count == 0 {
        return usage("--count 0: expected at least 1");
    }
    let accuracy = asked.accuracy.map(progress_line::accuracy).transpose()?;
    let alone = "--uncertain cannot be combined with --accuracy or --period. After a run with --accuracy, floquet.json \
                 contains its mesh and tolerance";
    asked
        .uncertain
        .refuse(accuracy.is_some() || asked.period.is_some(), alone)?;
    let uncertain = asked
        .uncertain
        .begin(&asked.case, case, AnalysisKind::Floquet, asked.result.quiet)?;
    let mut folder = asked.result.place.claim(case, FolderKind::Floquet)?;
    let stop = asked.result.wall.stop();
    let mut of = |case: &Case| refine::numbers::of_multipliers(case, asked.period, asked.count, &stop);
    let refined = refine::if_asked(case, accuracy, true, &mut of);
    let refined = interrupt::before_a_cycle(refined, &stop)?;
    let case = refined.as_ref().map_or(case, |(chosen, _)| chosen);
    let scene = PeriodicScene::new(case, asked.period)?.heeding(&stop);
    scene.held(&case.name)?;
    let bar = progress_line::line(asked.result.quiet);
    bar.set_message("searching for the cycle");
    let mut cycle = interrupt::before_a_cycle(shoot(&scene, None).map_err(fault), &stop)?;
    bar.set_message("integrating disturbances over one period");
    let found = floquet::multipliers(&scene, &mut cycle, asked.count);
    bar.set_message("repeating on other meshes");
    let accuracy = refined.as_ref().map(|(_, accuracy)| accuracy.clone());
    let judge = || {
        let mut of = |case: &Case| refine::numbers::of_growth(case, asked.period, asked.count, &stop);
        refine::meshes::judge(case, &refine::numbers::of_stability(&found), &mut of)
    };
    let meshes = accuracy.is_none().then(judge).transpose()?;
    bar.finish_and_clear();
    let mut warnings = early_warnings::without_outputs(case, &scene::system(case)?);
    warnings.extend(scene.trapped.clone());
    warnings.extend(cycle.range(case, &scene));
    warnings.extend(meshes.as_ref().and_then(Meshes::warning));
    warnings.extend(accuracy.as_ref().and_then(refine::warning));
    let mut found = CycleResult {
        case: case.name.clone(),
        cycle: cycle.search,
        periods: None,
        floquet: found,
        bands: Bands::new(),
        warnings,
        refined: None,
        accuracy,
        meshes,
    };
    let written = files::write(&mut folder, &found);
    let uncertainty = uncertain::compute(uncertain.as_ref(), Some(&folder))?;
    found.bands = uncertain::bands(uncertainty.as_ref());
    let text = || results::text(&found);
    let with_bands: (&str, &dyn Fn() -> String) = (FolderKind::Floquet.sign(), &text);
    let written = uncertain::complete(uncertainty.as_ref(), (&folder, case), written, &[with_bands]);
    let words = || files::describe(&found) + &uncertain::below(uncertainty.as_ref());
    super::print_result(asked.json, folder.dir(), written, text, words)
}

/// Draws a map of a case over `parameters`; writes the folder, prints the text.
pub fn map(
    case: &Case,
    (asked, parameters): (&MapArguments, &str),
    result: &ResultArguments,
    json: bool,
) -> Result<ExitCode> {
    if parameters != "frequency,amplitude" {
        return usage(format!("--map {parameters}: a map is drawn over frequency,amplitude"));
    }
    let plan = plan(asked, tongue::shaking(case)?)?;
    let mut folder = result.place.claim(case, FolderKind::Map)?;
    let evaluations = Evaluations::default();
    journal::begin(&evaluations, &folder, ("map", case, &format!("{plan:?}")))?;
    let stop = result.wall.stop();
    let bar = progress_line::line(result.quiet);
    let found = tongue::map(case, &plan, &evaluations, &stop, &|done, count| {
        bar.set_message(format!("{done} of {}", counted(count as u64, "column")));
        bar.tick();
    });
    bar.finish_and_clear();
    let stopped = stop.raised();
    let found = journal::outcome(found, &folder, stopped)?;
    let written = files::write_map(&mut folder, &found).and(report::complete(&folder, case));
    let written = journal::end(&evaluations, &folder, stopped, written);
    let words = || files::map_words(&found) + &warnings(&found.warnings);
    super::print_result(json, folder.dir(), written, || results::text(&found), words)
}

/// Plan of the map, around the case's own frequency [Hz] and amplitude [m].
fn plan(asked: &MapArguments, own: (f64, f64)) -> Result<MapRange> {
    let both = |text: &str| {
        text.split_once(',')
            .map(|(a, b)| (a.trim().to_owned(), b.trim().to_owned()))
    };
    let counts = both(&asked.points).and_then(|(a, b)| Some((a.parse::<usize>().ok()?, b.parse::<usize>().ok()?)));
    let Some((columns, rows)) = counts.filter(|(a, b)| *a > 0 && *b > 0 && a.saturating_mul(*b) <= MOST_POINTS) else {
        return usage(format!(
            "--points {}: two counts such as 21,12, at most {MOST_POINTS} points in all",
            asked.points
        ));
    };
    let (frequency, amplitude) = match &asked.range {
        None => ((0.6 * own.0, 1.6 * own.0), (1.5 * own.1 / rows as f64, 1.5 * own.1)),
        Some(text) => both(text)
            .and_then(|(a, b)| Some((progress_line::range(&a)?, progress_line::range(&b)?)))
            .filter(|((f, _), (a, _))| *f > 0.0 && *a >= 0.0)
            .ok_or_else(|| {
                let what = "two ranges, Hz and m, such as 14:24,0:0.05, frequencies > 0, amplitudes >= 0";
                Error::Usage(format!("--range {text}: {what}"))
            })?,
    };
    if let Some(wrong) = asked.permeability.iter().find(|f| !(f.is_finite() && **f > 0.0)) {
        return usage(format!("--permeability {wrong}: factors > 0"));
    }
    Ok(MapRange {
        frequencies_hz: progress_line::spread(frequency.0, frequency.1, columns, false),
        amplitudes_m: progress_line::spread(amplitude.0, amplitude.1, rows, false),
        permeability_factors: asked.permeability.clone(),
    })
}
