//! `slcbeam merge`: shards of a sweep joined into one table.

use std::process::ExitCode;

use super::arguments::MergeArguments;
use super::{compare, terminal};
use crate::case::{self, CaseText};
use crate::error::{Result, usage};
use crate::output::folder::{CASE, ResultFolder, text_of};
use crate::output::kind::FolderKind;
use crate::output::report;
use crate::output::sweep::{self as files, shards, text};
use crate::results;
use crate::results::sweep::SweepPlan;

/// Exit code if designs are missing.
const INCOMPLETE: u8 = 5;

/// Joins shards, writes the table of the designs found, and names the missing ones.
pub fn merge(asked: &MergeArguments) -> Result<ExitCode> {
    let all = shards::read(&asked.parts)?;
    let Some(first) = all.first() else {
        return usage("no folders");
    };
    let plan = first.plan.whole();
    let dir = asked.place.folder(&plan.case, FolderKind::Designs);
    if let Some(part) = asked.parts.iter().find(|part| compare::same(part, &dir)) {
        return usage(format!(
            "--out {}: {} is one of the shards, whose rows would be overwritten; name another folder",
            dir.display(),
            part.display()
        ));
    }
    let mut folder = ResultFolder::claim(&dir, FolderKind::Designs, asked.place.force)?;
    match files::plan(&folder)? {
        Some(there) if asked.place.force && plan.difference(&there).is_some() => start(&mut folder, asked, &plan)?,
        Some(there) => {
            if let Some(why) = plan.difference(&there) {
                return usage(format!(
                    "{} contains another sweep: {why}; name another folder with --out, or use this one with --force",
                    dir.display()
                ));
            }
        }
        None => start(&mut folder, asked, &plan)?,
    }
    let (survey, damage) = shards::join(&all, &folder, &plan)?;
    for one in damage {
        terminal::print_line(&format!("slcbeam: {one}."));
    }
    let summary = files::summarize(&plan, &survey)?;
    let written = files::write(&folder, &plan, &survey, &summary, asked.lean);
    let written = written.and_then(|()| match asked.lean {
        true => Ok(()),
        false => report::write(&dir, None).map(|_| ()),
    });
    let words = || text::describe(&summary, &survey).unwrap_or_default();
    super::print_result(asked.json, &dir, written, || results::text(&summary), words)?;
    let lost = shards::lost(&all, &plan, &survey, &dir);
    for one in &lost {
        let what = match (one.shard, &one.dir) {
            (None, _) => "the sweep".into(),
            (Some(shard), None) => format!("shard {} (no folder given)", shard.describe()),
            (Some(shard), Some(dir)) => format!("shard {} in {}", shard.describe(), dir.display()),
        };
        terminal::print_line(&format!(
            "slcbeam: {what} lacks {}, the first of them {}; to compute them:\n  {}",
            text::several(one.designs),
            one.first,
            one.command
        ));
    }
    Ok(ExitCode::from(if lost.is_empty() { 0 } else { INCOMPLETE }))
}

fn start(folder: &mut ResultFolder, asked: &MergeArguments, plan: &SweepPlan) -> Result<()> {
    let case = asked.parts.iter().map(|dir| dir.join(CASE)).find(|path| path.exists());
    let written = match case {
        None => CaseText::default(),
        // a case of another version of the program may no longer be valid
        Some(path) => match case::load(&path, &[]) {
            Ok(case) => case.written(),
            Err(_) => CaseText {
                json: text_of(&path)?,
                tables: vec![],
            },
        },
    };
    files::begin(folder, plan, &written)
}
