//! `slcbeam fit`: numbers of a case from measured data.

use std::process::ExitCode;

use super::arguments::{FitArguments, FittedThrough, parse_all};
use super::{interrupt, journal, progress_line, resources, sweep};
use crate::error::{Result, usage};
use crate::output::fit as files;
use crate::output::kind::FolderKind;
use crate::output::numbers::{counted, significant};
use crate::output::report;
use crate::results;
use crate::study::data::{DataTable, Match};
use crate::study::fit::abscissa::DrivenNumber;
use crate::study::fit::problem::{FitProblem, FitRequest};
use crate::study::fit::{self as study, robust::LossFunction};
use crate::study::search_bounds::ParameterBounds;

/// Reads, fits, writes the folder, prints.
pub fn fit(asked: &FitArguments) -> Result<ExitCode> {
    let case = resources::load_with(&asked.case.case, &asked.case.sets, asked.vary.len())?;
    let table = DataTable::read(&asked.data)?;
    let wanted = wanted(asked)?;
    let driven: Vec<String> = wanted.drives.iter().map(|drive| drive.pointer.clone()).collect();
    sweep::overridden(&asked.case.sets, &driven, |drive| format!("every row sets {drive}"))?;
    let problem = FitProblem::new(&case, &table, &wanted)?;
    let flag = asked.result.wall.flag();
    let stop = || interrupt::raised(&flag);
    let mut folder = asked.result.place.claim(&case, FolderKind::Fit)?;
    let settings = format!(
        "{} {:?}",
        table.crc32,
        FitRequest {
            jobs: 0,
            ..wanted.clone()
        }
    );
    journal::begin(&problem.evaluations, &folder, ("fit", &case, &settings))?;
    let bar = progress_line::line(asked.result.quiet);
    let show = |count: usize, squares: f64| {
        bar.set_message(format!(
            "{}, sum of squares {}",
            counted(count as u64, "simulation"),
            significant(squares, 5)
        ));
        bar.tick();
    };
    let name = asked.data.display().to_string();
    let found = study::fit(&problem, &wanted, (&name, table.crc32), &stop, &show);
    bar.finish_and_clear();
    let mut found = journal::outcome(found, &folder, stop())?;
    found.fit.left_alone = study::left_alone(&table, &wanted);
    let written = files::write(&mut folder, &problem, &found);
    let written = written.and_then(|()| report::write(folder.dir(), None).map(|_| ()));
    let written = journal::end(&problem.evaluations, &folder, found.fit.interrupted, written);
    let (text, words) = (|| results::text(&found.fit), || files::describe(&found.fit));
    super::print_result(asked.json, folder.dir(), written, text, words)
}

fn wanted(asked: &FitArguments) -> Result<FitRequest> {
    let drives = parse_all(&asked.drive, DrivenNumber::parse)?;
    match asked.command {
        Some(FittedThrough::Equilibrium) if drives.is_empty() => {
            let what = "--command equilibrium needs --drive COLUMN=POINTER: the number of the case that every row sets";
            return usage(what);
        }
        Some(FittedThrough::Run) if !drives.is_empty() => {
            let what = "--drive: rows of a run are instants of one case; use --drive with --command equilibrium only";
            return usage(what);
        }
        Some(FittedThrough::Response) if asked.input.is_none() => {
            let what =
                "--command response needs --input POINTER: the signal of the case over which outputs were measured";
            return usage(what);
        }
        Some(FittedThrough::Run | FittedThrough::Equilibrium) if asked.input.is_some() => {
            return usage("--input is an option of --command response only");
        }
        _ => {}
    }
    Ok(FitRequest {
        spans: parse_all(&asked.vary, ParameterBounds::parse)?,
        matches: parse_all(&asked.matches, Match::parse)?,
        time: asked.time.clone(),
        drives,
        input: asked.input.clone(),
        noise: parse_all(&asked.noise, noise)?,
        loss: asked.robust.map_or(LossFunction::Squares, LossFunction::from),
        starts: asked.starts as usize,
        jobs: sweep::jobs(asked.jobs)?,
    })
}

fn noise(text: &str) -> Result<(String, f64)> {
    let parts = text
        .rsplit_once('=')
        .map(|(name, sigma)| (name.trim(), sigma.trim().parse::<f64>()));
    match parts {
        Some((name, Ok(sigma))) if !name.is_empty() => Ok((name.into(), sigma)),
        _ => usage(format!(
            "--noise '{text}': expected a column and a standard deviation above 0, such as angle_deg=0.2"
        )),
    }
}
