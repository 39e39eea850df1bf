//! Joins shards to one table, and lists missing designs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::{JOURNAL, JournalSummary, PLAN};
use crate::error::{Result, usage};
use crate::output::folder::{ResultFolder, result};
use crate::output::kind::FolderKind;
use crate::output::numbers::significant;
use crate::results::sweep::{Shard, SweepPlan};
use crate::run::summary::Status;
use crate::study::analysis::AnalysisOutcome;

/// A folder with a part of a sweep.
#[derive(Clone, Debug)]
pub struct SweepPart {
    /// Path of the folder.
    pub dir: PathBuf,
    /// Plan of the part.
    pub plan: SweepPlan,
}

/// A part that is missing or incomplete.
#[derive(Clone, Debug, PartialEq)]
pub struct MissingShard {
    /// The shard; `None` if the sweep has no shards.
    pub shard: Option<Shard>,
    /// Its folder, if given.
    pub dir: Option<PathBuf>,
    /// Number of missing designs.
    pub designs: usize,
    /// The first of them.
    pub first: usize,
    /// Command that computes them.
    pub command: String,
}

/// Reads the plans of folders.
///
/// # Errors
/// [`Error::Usage`] if they are parts of different sweeps, with the difference.
pub fn read(dirs: &[PathBuf]) -> Result<Vec<SweepPart>> {
    let mut all: Vec<SweepPart> = vec![];
    for dir in dirs {
        let path = dir.join(PLAN);
        FolderKind::wanted("merge", dir, &[FolderKind::Designs])?;
        let plan = result::<SweepPlan>(&path)?.result;
        if let Some(first) = all.first()
            && let Some(why) = plan.whole().difference(&first.plan.whole())
        {
            return usage(format!(
                "{} and {} are parts of different sweeps: {} (here the first, there the second)",
                dir.display(),
                first.dir.display(),
                why
            ));
        }
        all.push(SweepPart { dir: dir.clone(), plan });
    }
    Ok(all)
}

/// Copies the rows of all parts into the journal of a folder that is none of theirs, each design once. Existing rows stay, except
/// unfinished ones for which a part has a finished row. Returns the rows present, and descriptions of damaged rows.
///
/// # Errors
/// A file cannot be read or written. [`Error::Usage`] if two rows of one design finished with different figures; nothing is written then.
pub fn join(parts: &[SweepPart], folder: &ResultFolder, plan: &SweepPlan) -> Result<(JournalSummary, Vec<String>)> {
    let path = folder.path(JOURNAL);
    let mut there = JournalSummary::read(&path, plan)?;
    let surveys = parts
        .iter()
        .map(|part| JournalSummary::read(&part.dir.join(JOURNAL), &part.plan))
        .collect::<Result<Vec<_>>>()?;
    let damage = [&there]
        .into_iter()
        .chain(&surveys)
        .filter_map(JournalSummary::damage)
        .collect();
    let dirs = parts.iter().map(|part| part.dir.as_path());
    agree(
        &[(folder.dir(), &there)]
            .into_iter()
            .chain(dirs.zip(&surveys))
            .collect::<Vec<_>>(),
    )?;
    for own in &surveys {
        let mut journal = there.go_on(folder)?;
        let mut failed = None;
        own.each(|row| {
            let better = row.found.status == Status::Finished && !there.finished(row.number);
            if failed.is_none() && (better || !there.has(row.number)) {
                failed = journal.put(&row).err();
            }
            Ok(())
        })?;
        failed.map_or_else(|| journal.secure(), Err)?;
        there = JournalSummary::read(&path, plan)?;
    }
    Ok((there, damage))
}

/// Rejects folders if a design finished in two of them with different figures.
fn agree(all: &[(&Path, &JournalSummary)]) -> Result<()> {
    let twice = |number: usize| all.iter().filter(|(_, survey)| survey.finished(number)).count() > 1;
    let mut known: BTreeMap<usize, (usize, AnalysisOutcome)> = BTreeMap::new();
    for (place, (dir, survey)) in all.iter().enumerate() {
        let mut conflict = None;
        survey.each(|row| {
            if conflict.is_some() || !survey.finished(row.number) || !twice(row.number) {
                return Ok(());
            }
            if let Some((first, found)) = known.get(&row.number) {
                conflict = found.conflict(&row.found).map(|what| (row.number, *first, what));
            } else {
                known.insert(row.number, (place, row.found));
            }
            Ok(())
        })?;
        if let Some((number, first, (name, [a, b]))) = conflict {
            let text = |x: f64| {
                if x.is_nan() {
                    "missing".into()
                } else {
                    significant(x, 7)
                }
            };
            return usage(format!(
                "design {number} is there twice, and its rows differ: {name} is {} in {} and {} in {}; merge only one of them, or compute one \
                 again",
                text(a),
                all[first].0.display(),
                text(b),
                dir.display()
            ));
        }
    }
    Ok(())
}

/// Missing designs, by shard.
pub fn lost(parts: &[SweepPart], plan: &SweepPlan, there: &JournalSummary, out: &Path) -> Vec<MissingShard> {
    let of = parts.first().and_then(|part| part.plan.shard).map(|shard| shard.of);
    let even = of.filter(|of| {
        parts
            .iter()
            .all(|part| part.plan.shard.is_some_and(|shard| shard.of == *of))
    });
    let shards: Vec<Option<Shard>> = match even {
        Some(of) => (1..=of).map(|index| Some(Shard { index, of })).collect(),
        None => vec![None],
    };
    let mut all = vec![];
    for shard in shards {
        let own = SweepPlan { shard, ..plan.clone() };
        let missing: Vec<usize> = (0..plan.designs).filter(|n| own.has(*n) && !there.has(*n)).collect();
        let Some(first) = missing.first() else { continue };
        let given = parts
            .iter()
            .find(|part| part.plan.shard == shard)
            .map(|part| part.dir.clone());
        let dir = given.clone().unwrap_or_else(|| match shard {
            Some(shard) => beside(parts, shard).unwrap_or_else(|| {
                let name = format!("{}-{}-of-{}", out.display(), shard.index, shard.of);
                PathBuf::from(name)
            }),
            None => out.to_path_buf(),
        });
        let dir = dir.display().to_string();
        let words = shard.map(Shard::describe);
        let mut more = words.as_deref().map_or(vec![], |words| vec!["--shard", words]);
        more.extend(["--out", &dir]);
        all.push(MissingShard {
            shard,
            dir: given,
            designs: missing.len(),
            first: *first,
            command: own.command_line(&more),
        });
    }
    all
}

/// Probable folder of a shard, from the names of the others.
fn beside(parts: &[SweepPart], shard: Shard) -> Option<PathBuf> {
    let part = parts.first()?;
    let name = sibling(part.dir.file_name()?.to_str()?, part.plan.shard?, shard.index)?;
    Some(part.dir.with_file_name(name))
}

/// Name of another shard's folder, if the name of this one ends with its number.
fn sibling(name: &str, own: Shard, other: usize) -> Option<String> {
    let behind = format!("-of-{}", own.of);
    let (name, behind) = name.strip_suffix(&behind).map_or((name, ""), |name| (name, &behind));
    let stem = name.strip_suffix(&own.index.to_string())?;
    // a folder 12 does not have the number 2
    let whole = !stem.ends_with(|c: char| c.is_ascii_digit());
    whole.then(|| format!("{stem}{other}{behind}"))
}

#[cfg(test)]
mod tests {
    use super::{Shard, sibling};

    #[test]
    fn folders_of_shards_are_named_alike() {
        let two = Shard { index: 2, of: 12 };
        for (name, other) in [
            ("part-2", Some("part-7")),
            ("case-sweep-2-of-12", Some("case-sweep-7-of-12")),
            ("part-12", None),
            ("second", None),
        ] {
            assert_eq!(sibling(name, two, 7).as_deref(), other);
        }
    }
}
