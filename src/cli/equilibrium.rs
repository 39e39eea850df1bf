//! `slcbeam equilibrium`: the path of equilibria from rest to the full load.

use std::process::ExitCode;
use std::time::Instant;

use super::arguments::EquilibriumArguments;
use super::uncertain;
use super::{interrupt, progress_line, resources, terminal};
use crate::case::parameter::Parameter;
use crate::case::{Case, inherited};
use crate::error::{Error, Result, usage};
use crate::output::equilibrium as files;
use crate::output::kind::FolderKind;
use crate::output::uncertainty as spread;
use crate::results::run::Bands;
use crate::run::equilibrium::{self, EquilibriumOptions};
use crate::run::record::Control;
use crate::run::{early_warnings, slow_fluid};
use crate::study::analysis::AnalysisKind;
use crate::study::refine::{self, meshes::Meshes};

/// Follows the path, writes the folder, prints the table.
pub fn equilibrium(asked: &EquilibriumArguments) -> Result<ExitCode> {
    let case = &resources::load(&asked.case)?;
    let at_s = asked.at.unwrap_or(case.time.end_s);
    let options = options(asked, case, at_s)?;
    let system = equilibrium::system(case, at_s)?;
    let parameters = Parameter::all(case, &asked.sensitivity)?;
    let usual = at_s == case.time.end_s
        && options
            == EquilibriumOptions {
                points: options.points,
                ..EquilibriumOptions::at(at_s)
            };
    let alone = "--uncertain applies to the equilibrium under the loads at the end of the run: it cannot be combined with \
                 --at, --via, --load-factor, --keep-branch or --accuracy. For the loads of another instant, use --set \
                 /time/end_s=SECONDS";
    asked.uncertain.refuse(!usual || asked.accuracy.is_some(), alone)?;
    let uncertain = asked
        .uncertain
        .begin(&asked.case, case, AnalysisKind::Equilibrium, asked.result.quiet)?;
    let mut folder = asked.result.place.claim(case, FolderKind::Equilibrium)?;
    let stop = asked.result.wall.flag();
    let begin = Instant::now();
    let accuracy = asked.accuracy.map(progress_line::accuracy).transpose()?;
    let mut of = |case: &Case| refine::numbers::of_equilibrium(case, &options);
    let found = refine::if_asked(case, accuracy, false, &mut of)?;
    let case = found.as_ref().map_or(case, |(chosen, _)| chosen);
    let accuracy = found.as_ref().map(|(_, accuracy)| accuracy);
    let bar = progress_line::line(asked.result.quiet);
    let path = equilibrium::follow(case, &options, &mut |state| {
        bar.set_message(options.place(state.stage, &format!("{:.4}", state.share)));
        bar.tick();
        if interrupt::raised(&stop) {
            Control::Stop("interrupted".into())
        } else {
            Control::Continue
        }
    })?;
    bar.finish_and_clear();
    let columns = equilibrium::columns(&system);
    let meshes = if path.fault.is_none() && accuracy.is_none() {
        let here = refine::numbers::of_path(case, &columns, &path)?;
        Some(refine::meshes::judge(case, &here, &mut of)?.with_effects(case, &here, &mut of)?)
    } else {
        None
    };
    let mut warnings = early_warnings::at_rest(case, &system);
    warnings.extend(early_warnings::instant(case, asked.at));
    warnings.extend(inherited::varied(case, asked.sensitivity.iter().map(String::as_str)));
    warnings.extend(slow_fluid::warning(case, &system, at_s));
    warnings.extend(path.warnings());
    warnings.extend(meshes.as_ref().and_then(Meshes::warning));
    warnings.extend(accuracy.and_then(refine::warning));
    let sensitivities = match path.states.last() {
        Some(_) if path.fault.is_none() => equilibrium::differentiate(case, &options, &path, &parameters)?,
        _ => vec![],
    };
    let stages = options.resolved(case)?;
    let mut found = files::LoadPath {
        case,
        options: &stages,
        path: &path,
        columns: &columns,
        wall_s: begin.elapsed().as_secs_f64(),
        warnings: &warnings,
        sensitivities: &sensitivities,
        accuracy,
        meshes: meshes.as_ref(),
        bands: Bands::new(),
    };
    let (mut uncertainty, mut written) = (None, Ok(()));
    if !path.states.is_empty() {
        written = files::write(&mut folder, &found);
        if path.fault.is_none() {
            uncertainty = uncertain::compute(uncertain.as_ref(), Some(&folder))?;
            found.bands = uncertain::bands(uncertainty.as_ref());
        }
        let json = || files::json(&found);
        let place = (&folder, case);
        written = uncertain::complete(uncertainty.as_ref(), place, written, &[(files::JSON, &json)]);
    }
    let (text, words) = (
        || files::json(&found),
        || files::describe(&found) + &uncertainty.as_ref().map_or(String::new(), spread::describe),
    );
    if asked.json || !path.states.is_empty() {
        super::print_result(asked.json, folder.dir(), written, text, words)?;
    }
    match path.fault {
        None => Ok(ExitCode::SUCCESS),
        Some(fault) => {
            let error = Error::Solver(Box::new(fault));
            terminal::report(&error);
            let part = interrupt::late() && !path.states.is_empty();
            Ok(ExitCode::from(if part { 0 } else { error.exit_code() }))
        }
    }
}

fn options(asked: &EquilibriumArguments, case: &Case, at_s: f64) -> Result<EquilibriumOptions> {
    if !(asked.load_factor.is_finite() && asked.load_factor != 0.0 && at_s.is_finite()) {
        return usage("--load-factor must be a number other than 0, and --at a number of seconds");
    }
    if asked.points == 0 {
        return usage("--points must be at least 1");
    }
    Ok(EquilibriumOptions {
        at_s,
        via_s: asked
            .via
            .as_deref()
            .map_or(Ok(vec![]), |text| via(text, case.time.end_s))?,
        valves_s: vec![],
        share: asked.load_factor,
        points: Some(asked.points),
        branches: !asked.keep_branch,
    })
}

/// Instants of the stages before the last one.
fn via(text: &str, end: f64) -> Result<Vec<f64>> {
    let instant = |part: &str| part.trim().parse().ok().filter(|t: &f64| t.is_finite() && *t <= end);
    let all: Option<Vec<f64>> = text.split(',').map(instant).collect();
    all.ok_or_else(|| {
        Error::Usage(format!(
            "--via {text}: expected one or more instants in seconds, separated by commas, none after the end of the \
             run at {end} s"
        ))
    })
}
