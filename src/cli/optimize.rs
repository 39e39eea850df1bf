//! `slcbeam optimize`: the numbers of a case that maximize or minimize a figure.

use std::process::ExitCode;

use super::arguments::{OptimizeArguments, parse_all};
use super::{interrupt, journal, progress_line, resources, sweep};
use crate::case::Case;
use crate::error::{Result, usage};
use crate::output::kind::FolderKind;
use crate::output::numbers::significant;
use crate::output::optimum as files;
use crate::output::report;
use crate::output::sweep::text::several;
use crate::results;
use crate::study::evaluations::Evaluations;
use crate::study::optimize as study;
use crate::study::optimize::Candidate;
use crate::study::optimize::problem::{FigureLimit, Goal, OptimizationProblem, OptimizationRequest};
use crate::study::optimize::wiring::{Alternative, choices, combinations, crossings};
use crate::study::search_bounds::ParameterBounds;

/// Exit code if no design satisfies the limits: that of a computation without the requested result.
const NOTHING_HOLDS: u8 = 4;

/// Searches, writes the folder, prints.
pub fn optimize(asked: &OptimizeArguments) -> Result<ExitCode> {
    let case = resources::load_with(&asked.case.case, &asked.case.sets, asked.vary.len())?;
    let wanted = wanted(asked)?;
    let evaluations = Evaluations::default();
    let candidate = |alternative: Alternative| {
        let evaluations = evaluations.scoped(&alternative.sets.join(" "));
        let problem = problem(asked, &case, &wanted, &alternative)?;
        let problem = OptimizationProblem { evaluations, ..problem };
        Ok(Candidate { alternative, problem })
    };
    let alternatives = alternatives(asked, &case, &wanted)?;
    let candidates: Vec<Candidate> = alternatives.into_iter().map(candidate).collect::<Result<_>>()?;
    let figure = &candidates[0].problem.goal.figure;
    let mut folder = asked.result.place.claim(&case, FolderKind::Optimum)?;
    let settings = format!(
        "{:?} {:?} {:?}",
        asked.choose,
        asked.crossovers,
        OptimizationRequest {
            jobs: 0,
            ..wanted.clone()
        }
    );
    journal::begin(&evaluations, &folder, ("optimize", &case, &settings))?;
    let flag = asked.result.wall.flag();
    let bar = progress_line::line(asked.result.quiet);
    let show = |count: usize, best: Option<f64>| {
        let best = best.map_or("none within the limits yet".into(), |best| {
            format!("best {figure} {}", significant(best, 5))
        });
        bar.set_message(format!("{}, {best}", several(count)));
        bar.tick();
    };
    let stop = || interrupt::raised(&flag);
    let found = study::optimise(&candidates, &wanted, &stop, &show);
    bar.finish_and_clear();
    let stopped = stop();
    let found = journal::outcome(found, &folder, stopped)?;
    let written = files::write(&mut folder, &found.problem, &found);
    let written = written.and_then(|()| report::write(folder.dir(), None).map(|_| ()));
    let written = journal::end(&evaluations, &folder, stopped, written);
    let optimum = &found.optimum;
    let (text, words) = (|| results::text(optimum), || files::describe(optimum));
    super::print_result(asked.json, folder.dir(), written, text, words)?;
    Ok(match optimum.beyond_limits() {
        true => ExitCode::from(NOTHING_HOLDS),
        false => ExitCode::SUCCESS,
    })
}

/// All alternatives to choose from; the case itself if there are none.
fn alternatives(asked: &OptimizeArguments, case: &Case, wanted: &OptimizationRequest) -> Result<Vec<Alternative>> {
    let lists = asked.choose.iter().map(|text| choices(text));
    let wirings = asked.crossovers.map(|most| crossings(case, most));
    let sets: Vec<_> = lists.chain(wirings).collect::<Result<_>>()?;
    if wanted.spans.is_empty() && sets.is_empty() {
        let what = "no number to vary: give --vary POINTER=LOW:HIGH, such as /network/permeability_factor=0.01:1, or \
                    --choose, --crossovers";
        return usage(what);
    }
    let mut all = combinations(sets)?;
    if all.is_empty() {
        all.push(Alternative::default());
    }
    apart(&all[0], wanted)?;
    Ok(all)
}

/// Search problem of the case with an alternative.
fn problem(
    asked: &OptimizeArguments,
    case: &Case,
    wanted: &OptimizationRequest,
    alternative: &Alternative,
) -> Result<OptimizationProblem> {
    if alternative.sets.is_empty() {
        return OptimizationProblem::new(case, wanted);
    }
    let with = resources::load_varied(
        &asked.case.case,
        [&asked.case.sets, &alternative.sets],
        asked.vary.len(),
    );
    OptimizationProblem::new(&with.map_err(|error| error.by("--choose", &alternative.sets))?, wanted)
}

/// Checks that chosen and varied values are in different parts of the case.
fn apart(one: &Alternative, wanted: &OptimizationRequest) -> Result<()> {
    let chosen: Vec<&str> = one
        .sets
        .iter()
        .filter_map(|set| set.split_once('='))
        .map(|set| set.0)
        .collect();
    let sought: Vec<&str> = wanted.spans.iter().map(|span| span.pointer.as_str()).collect();
    let within = |a: &str, b: &str| a == b || a.strip_prefix(b).is_some_and(|rest| rest.starts_with('/'));
    for (k, a) in chosen.iter().enumerate() {
        if let Some(b) = chosen[..k].iter().chain(&sought).find(|b| within(a, b) || within(b, a)) {
            return usage(format!(
                "{a} and {b}: --vary, --choose and --crossovers must be of different parts of the case"
            ));
        }
    }
    Ok(())
}

fn wanted(asked: &OptimizeArguments) -> Result<OptimizationRequest> {
    let figure = asked.maximize.as_ref().or(asked.minimize.as_ref());
    Ok(OptimizationRequest {
        what: asked.analysis.analysis()?,
        spans: parse_all(&asked.vary, ParameterBounds::parse)?,
        goal: Goal {
            figure: figure.cloned().unwrap_or_default(),
            largest: asked.maximize.is_some(),
        },
        limits: parse_all(&asked.subject_to, FigureLimit::parse)?,
        starts: asked.starts as usize,
        jobs: sweep::jobs(asked.jobs)?,
    })
}
