//! `slcbeam optimize`: the numbers of a case with which a figure is largest or least.

use std::process::ExitCode;

use super::arguments::OptimizeArguments;
use super::{interrupt, line, size, sweep};
use crate::error::Result;
use crate::output::kind::Kind;
use crate::output::numbers::significant;
use crate::output::optimum as files;
use crate::output::report;
use crate::results;
use crate::study::optimize as study;
use crate::study::optimize::problem::{Asked, Goal, Limit, Problem};
use crate::study::span::Span;

/// Searches, writes the folder, prints.
pub fn optimize(asked: &OptimizeArguments) -> Result<ExitCode> {
    let case = size::load_with(&asked.case.case, &asked.case.sets, asked.vary.len())?;
    let wanted = wanted(asked)?;
    let problem = Problem::new(&case, &wanted)?;
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
    let found = study::optimise(&problem, &wanted, &|| interrupt::raised(&flag), &tell)?;
    bar.finish_and_clear();
    files::write(&mut folder, &problem, &found)?;
    report::write(folder.dir(), None)?;
    let optimum = &found.optimum;
    let (text, words) = (|| results::text(optimum), || files::words(optimum));
    super::tell(asked.json, folder.dir(), text, words)?;
    Ok(ExitCode::SUCCESS)
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
