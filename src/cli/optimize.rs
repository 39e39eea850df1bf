//! `slcbeam optimize`: the numbers of a case with which a figure is largest or least.

use std::process::ExitCode;

use super::arguments::OptimizeArguments;
use super::{interrupt, line, size, sweep};
use crate::case::Case;
use crate::error::{Error, Result};
use crate::output::kind::Kind;
use crate::output::numbers::significant;
use crate::output::optimum as files;
use crate::output::report;
use crate::results;
use crate::study::optimize as study;
use crate::study::optimize::Candidate;
use crate::study::optimize::problem::{Asked, Goal, Limit, Problem};
use crate::study::optimize::wiring::{Alternative, choices, combinations, crossovers};
use crate::study::span::Span;

/// Searches, writes the folder, prints.
pub fn optimize(asked: &OptimizeArguments) -> Result<ExitCode> {
    let case = size::load_with(&asked.case.case, &asked.case.sets, asked.vary.len())?;
    let wanted = wanted(asked)?;
    let candidates = candidates(asked, &case, &wanted)?;
    let problem = &candidates[0].problem;
    let mut folder = asked.place.claim(&case, Kind::Optimum)?;
    let flag = interrupt::flag();
    let bar = line::line(asked.quiet);
    let tell = |count: usize, best: Option<f64>| {
        let best = best.map_or("none within the limits yet".into(), |best| {
            format!("best {} {}", problem.goal.figure, significant(best, 5))
        });
        bar.set_message(format!("{count} designs, {best}"));
        bar.tick();
    };
    let found = study::optimise(&candidates, &wanted, &|| interrupt::raised(&flag), &tell)?;
    bar.finish_and_clear();
    files::write(&mut folder, &candidates[found.chosen].problem, &found)?;
    report::write(folder.dir(), None)?;
    let optimum = &found.optimum;
    let (text, words) = (|| results::text(optimum), || files::words(optimum));
    super::tell(asked.json, folder.dir(), text, words)?;
    Ok(ExitCode::SUCCESS)
}

/// The case with each of what is to be chosen from, the case itself where there is nothing.
fn candidates(asked: &OptimizeArguments, case: &Case, wanted: &Asked) -> Result<Vec<Candidate>> {
    let mut sets = asked
        .choose
        .iter()
        .map(|text| choices(text))
        .collect::<Result<Vec<_>>>()?;
    sets.extend(asked.crossovers.map(|most| crossovers(case, most)).transpose()?);
    if wanted.spans.is_empty() && sets.is_empty() {
        let what = "nothing to seek: --vary POINTER=LOW:HIGH, such as /network/permeability_factor=0.01:1, or --choose, --crossovers";
        return Err(Error::Usage(what.into()));
    }
    let mut all = combinations(sets)?;
    if all.is_empty() {
        all.push(Alternative::default());
    }
    if let Some(one) = all.first() {
        apart(one, wanted)?;
    }
    let candidate = |alternative: Alternative| {
        let problem = match alternative.sets.is_empty() {
            true => Problem::new(case, wanted)?,
            false => {
                let sets = [&asked.case.sets[..], &alternative.sets].concat();
                Problem::new(&size::load_with(&asked.case.case, &sets, asked.vary.len())?, wanted)?
            }
        };
        Ok(Candidate { alternative, problem })
    };
    all.into_iter().map(candidate).collect()
}

/// What is chosen and what is sought are different parts of the case.
fn apart(one: &Alternative, wanted: &Asked) -> Result<()> {
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
            return Err(Error::Usage(format!(
                "{a} and {b}: --vary, --choose and --crossovers must be of different parts of the case"
            )));
        }
    }
    Ok(())
}

fn wanted(asked: &OptimizeArguments) -> Result<Asked> {
    let figure = asked.maximize.as_ref().or(asked.minimize.as_ref());
    Ok(Asked {
        what: asked.command.into(),
        spans: asked.vary.iter().map(|text| Span::parse(text)).collect::<Result<_>>()?,
        goal: Goal {
            figure: figure.cloned().unwrap_or_default(),
            largest: asked.maximize.is_some(),
        },
        limits: asked
            .subject_to
            .iter()
            .map(|text| Limit::parse(text))
            .collect::<Result<_>>()?,
        starts: asked.starts as usize,
        jobs: sweep::jobs(asked.jobs)?,
    })
}
