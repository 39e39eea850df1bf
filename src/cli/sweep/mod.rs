//! `slcbeam sweep`: many designs, one table.

pub mod progress;
mod source;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};
use std::time::Instant;

use super::arguments::{Script, SweepArguments};
use super::{interrupt, run, terminal};
use crate::case::{Case, is_below};
use crate::error::{Error, Result, usage};
use crate::output::folder::ResultFolder;
use crate::output::kind::FolderKind;
use crate::output::report;
use crate::output::sweep::script::{Jobs, Scheduler, script};
use crate::output::sweep::{self as files, FOLDERS, JOURNAL, JournalSummary, text};
use crate::results;
use crate::results::sweep::SweepPlan;
use crate::run::dynamics::Outcome;
use crate::run::summary::Status;
use crate::study::analysis::{self, AnalysisKind, AnalysisOutcome, AnalysisRequest};
use crate::study::sweep::{SweepRow, pool};
use crate::study::target::ReachedSetting;
use progress::Counter;
use source::DesignSource;

/// Largest number of designs that are checked before the first is computed.
const CHECKED: usize = 10_000;

/// Every how many designs one is examined for growing waves, which takes longer than a short run.
const WAVES_EVERY: usize = 16;

/// Largest number of threads.
const MOST_AT_ONCE: usize = 1024;

/// Computes missing designs, writes the table, prints the number of designs of each kind.
pub fn sweep(asked: &SweepArguments) -> Result<ExitCode> {
    let source = DesignSource::read(asked)?;
    let plan = &source.plan;
    if asked.keep_folders && plan.command != AnalysisKind::Run {
        let what = "--keep-folders keeps the folders of runs only; --keep-cases keeps the case of every design, with \
                    which the command can be repeated";
        return usage(what);
    }
    let jobs = jobs(asked.jobs)?;
    if asked.shards == 0 {
        return usage("--shards: 1 or more");
    }
    if let Some(scheduler) = asked.script {
        return print_script(asked, plan, scheduler);
    }
    let mut folder = claim(asked, &source)?;
    let before = files::plan(&folder)?.filter(|_| !asked.restart);
    if let Some(there) = &before
        && let Some(why) = plan.difference(there)
    {
        return usage(format!(
            "{} contains another sweep: {why}; name another folder with --out, or begin again with --restart",
            folder.dir().display()
        ));
    }
    let journal = folder.path(JOURNAL);
    let done = match &before {
        Some(_) => JournalSummary::read(&journal, plan)?,
        None => JournalSummary::read(&PathBuf::new(), plan)?,
    };
    if let Some(damage) = done.damage() {
        terminal::print_line(&format!("slcbeam: {damage}. Designs without a row are computed again."));
    }
    let left: Vec<usize> = (0..plan.designs)
        .filter(|n| plan.has(*n) && !(done.has(*n) && (done.finished(*n) || !asked.retry)))
        .collect();
    let flag = asked.result.wall.flag();
    check(&source, &left, jobs, asked.result.quiet, &flag)?;
    if before.is_none() {
        files::begin(&mut folder, plan, &source.first.written())?;
    } else if !asked.result.quiet && done.count() > 0 {
        terminal::print_line(&format!(
            "slcbeam: already computed: {}; continuing with {}",
            text::several(done.count()),
            left.len()
        ));
    }
    let stopped = compute_all(asked, &source, &folder, &done, &left, jobs, &flag)?;
    if asked.keep_cases && !stopped {
        keep_others(&source, &folder, &done)?;
    }
    let survey = JournalSummary::read(&journal, plan)?;
    let summary = files::summarize(plan, &survey)?;
    let written = files::write(&folder, plan, &survey, &summary, asked.lean);
    let written = written.and_then(|()| match asked.lean {
        true => Ok(()),
        false => report::write(folder.dir(), None).map(|_| ()),
    });
    let words = || text::describe(&summary, &survey).unwrap_or_default();
    super::print_result(asked.json, folder.dir(), written, || results::text(&summary), words)?;
    if stopped {
        let missing = summary.missing;
        terminal::print_line(&format!(
            "slcbeam: interrupted; {} left to compute. The same command continues with them",
            text::several(missing)
        ));
    }
    let finished = survey.statuses.get(&Status::Finished).is_some_and(|n| *n > 0);
    // a shard may have no designs
    let none = summary.rows == 0 && summary.missing == 0;
    Ok(ExitCode::from(if finished || stopped || none { 0 } else { 4 }))
}

/// Number of designs computed at once: the requested number, or the number of cores.
///
/// # Errors
/// [`Error::Usage`]: zero, or too many.
pub fn jobs(asked: Option<usize>) -> Result<usize> {
    let jobs = asked.unwrap_or_else(pool::cores);
    match (1..=MOST_AT_ONCE).contains(&jobs) {
        true => Ok(jobs),
        false => usage(format!("--jobs {jobs}: from 1 to {MOST_AT_ONCE}")),
    }
}

/// Checks that no value of `--set` is set again for every case; `why` names the source of the second value at a pointer.
///
/// # Errors
/// [`Error::Usage`] with the first such value.
pub fn overridden(sets: &[String], again: &[String], why: impl Fn(&str) -> String) -> Result<()> {
    for set in sets {
        let pointer = set.split_once('=').map_or(set.as_str(), |(pointer, _)| pointer);
        if let Some(other) = again.iter().find(|other| is_below(pointer, other)) {
            let what = format!(
                "--set {set}: it would have no effect, because {}; leave one of them out",
                why(other)
            );
            return usage(what);
        }
    }
    Ok(())
}

fn claim(asked: &SweepArguments, source: &DesignSource) -> Result<ResultFolder> {
    let mut place = asked.result.place.clone();
    if let (None, Some(shard)) = (&place.out, asked.shard) {
        let dir = place.folder(&source.first.name, FolderKind::Designs);
        let dir = PathBuf::from(format!("{}-{}-of-{}", dir.display(), shard.index, shard.of));
        place.out = Some(dir);
    }
    place.claim(&source.first, FolderKind::Designs)
}

/// Checks designs before the first is computed: all of them, or an evenly spread selection that is checked in a short time.
fn check(source: &DesignSource, left: &[usize], jobs: usize, quiet: bool, flag: &AtomicBool) -> Result<()> {
    let every = left.len().div_ceil(CHECKED).max(1);
    let some: Vec<usize> = left.iter().copied().step_by(every).collect();
    let mut counter = Counter::new(quiet, "checked", some.len());
    let look = |number| source.check(number, jobs.min(left.len()));
    let mut faults = faults(&some, jobs, flag, &look, &mut |faulty| counter.one(faulty))?;
    drop(counter);
    let more = faults.len().saturating_sub(1);
    match faults.pop_first() {
        None => Ok(()),
        Some((number, fault)) => {
            source.name_design(number, more);
            Err(fault)
        }
    }
}

/// Faults that `look` finds in cases, by their numbers, until interrupted; `seen` receives true for each faulty case, false for others.
///
/// # Errors
/// Only those of the pool.
pub fn faults(
    numbers: &[usize],
    jobs: usize,
    flag: &AtomicBool,
    look: &(dyn Fn(usize) -> Result<()> + Sync),
    seen: &mut (dyn FnMut(bool) + Send),
) -> Result<BTreeMap<usize, Error>> {
    let mut faults = BTreeMap::new();
    pool::each(
        numbers,
        jobs,
        &|number| (!interrupt::raised(flag)).then(|| (number, look(number).err())),
        &mut |(number, fault)| {
            seen(fault.is_some());
            fault.map(|fault| faults.insert(number, fault));
            Ok(())
        },
    )?;
    Ok(faults)
}

/// Computes designs and stores their rows; true if it was interrupted.
fn compute_all(
    asked: &SweepArguments,
    source: &DesignSource,
    folder: &ResultFolder,
    done: &JournalSummary,
    left: &[usize],
    jobs: usize,
    flag: &Arc<AtomicBool>,
) -> Result<bool> {
    let plan = &source.plan;
    let stop = || interrupt::raised(flag);
    let mut ask = AnalysisRequest {
        what: &plan.command,
        accuracy: plan.accuracy,
        from: None,
        meshes: plan.mesh_errors,
        waves: true,
    };
    // searches begin with the setting of the first design, whichever designs are left
    let searches = ask.accuracy.is_some() && *ask.what == AnalysisKind::Run && !left.is_empty();
    if searches && let Ok(case) = source.case(&source.designs.design(0)) {
        let first = analysis::run(&case, ask, &stop)
            .ok()
            .and_then(|outcome| outcome.summary.accuracy);
        ask.from = first.as_ref().map(ReachedSetting::found);
    }
    let mut journal = done.go_on(folder)?;
    let mut counter = Counter::new(asked.result.quiet, "done", left.len());
    let unkept: Mutex<Option<Error>> = Mutex::new(None);
    let work = |number: usize| {
        let ask = AnalysisRequest {
            waves: number.is_multiple_of(WAVES_EVERY),
            ..ask
        };
        let begin = Instant::now();
        if stop() {
            return None;
        }
        let design = source.designs.design(number);
        let found = match source.case(&design) {
            Err(error) => AnalysisOutcome::failed(&error),
            Ok(case) => {
                let keep = Keep {
                    asked,
                    plan,
                    folder,
                    number,
                    flag,
                };
                if let Err(error) = keep.case(&case) {
                    unkept
                        .lock()
                        .unwrap_or_else(std::sync::PoisonError::into_inner)
                        .get_or_insert(error);
                    return None;
                }
                analysis::found(&case, ask, &stop, &|case| keep.run(case, ask, &stop))?
            }
        };
        Some(SweepRow::new(design, found, begin.elapsed().as_secs_f64()))
    };
    pool::each(left, jobs, &work, &mut |row: SweepRow| {
        if let Some(error) = unkept.lock().unwrap_or_else(std::sync::PoisonError::into_inner).take() {
            return Err(error);
        }
        if let Err(error) = journal.append(&row) {
            // the disk has the other rows
            super::print(&format!("{}\n", serde_json::to_string(&row).unwrap_or_default()))?;
            return Err(error);
        }
        counter.one(row.found.status != Status::Finished);
        Ok(())
    })?;
    match unkept.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        Some(error) => Err(error),
        None => Ok(stop()),
    }
}

/// Stores the cases of designs that were computed before cases were requested.
fn keep_others(source: &DesignSource, folder: &ResultFolder, done: &JournalSummary) -> Result<()> {
    let plan = &source.plan;
    for number in (0..plan.designs).filter(|number| done.has(*number)) {
        let name = files::numbered(plan, number);
        if !folder.path(files::CASES).join(format!("{name}.json")).exists() {
            let case = source.case(&source.designs.design(number))?;
            files::keep_case(folder, &name, &case.written())?;
        }
    }
    Ok(())
}

/// Files that are kept of a design in addition to its row.
struct Keep<'a> {
    asked: &'a SweepArguments,
    plan: &'a SweepPlan,
    folder: &'a ResultFolder,
    number: usize,
    flag: &'a Arc<AtomicBool>,
}

impl Keep<'_> {
    /// Stores the case, on request.
    fn case(&self, case: &Case) -> Result<()> {
        if !self.asked.keep_cases {
            return Ok(());
        }
        files::keep_case(self.folder, &files::numbered(self.plan, self.number), &case.written())
    }

    /// Runs the case, and keeps its folder on request.
    fn run(&self, case: &Case, ask: AnalysisRequest, stop: &dyn Fn() -> bool) -> Result<Outcome> {
        if !self.asked.keep_folders {
            return analysis::run(case, ask, stop);
        }
        let dir = self.folder.path(FOLDERS).join(files::numbered(self.plan, self.number));
        run::into(case, ask, &dir, self.asked.lean, self.flag)
    }
}

fn print_script(asked: &SweepArguments, plan: &SweepPlan, scheduler: Script) -> Result<ExitCode> {
    if asked.cases.iter().any(|path| path.as_os_str() == "-") {
        return usage("--script: jobs read the case themselves; name its file in place of -");
    }
    let program = std::env::current_exe().unwrap_or_else(|_| "slcbeam".into());
    let out = asked.result.place.folder(&plan.case, FolderKind::Designs);
    let files = asked.cases.iter().chain(&asked.designs);
    for path in files.chain([&program, &out]) {
        if path.to_str().is_none_or(|name| name.contains(char::is_control)) {
            return usage(format!(
                "--script: {:?} cannot be named in a script: it contains control characters or is not UTF-8. Rename \
                 it.",
                path.display()
            ));
        }
    }
    let scheduler = match scheduler {
        Script::Slurm => Scheduler::Slurm,
        Script::Parallel => Scheduler::Parallel,
    };
    let more = [
        (asked.lean, "--lean"),
        (asked.keep_cases, "--keep-cases"),
        (asked.keep_folders, "--keep-folders"),
    ];
    let more: Vec<&str> = more
        .into_iter()
        .filter(|(asked, _)| *asked)
        .map(|(_, word)| word)
        .collect();
    let jobs = Jobs {
        shards: asked.shards,
        at_once: asked.jobs,
        program: &program,
        out: &out,
        more: &more,
        lean: asked.lean,
    };
    super::print(&script(plan, scheduler, &jobs))?;
    Ok(ExitCode::SUCCESS)
}
