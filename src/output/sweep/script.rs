//! Job scripts that compute the shards of a sweep.

use std::path::Path;

use crate::results::sweep::SweepPlan;
use crate::study::sweep::plan::quoted;

/// Scheduler that starts the jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheduler {
    /// A job array of Slurm.
    Slurm,
    /// GNU parallel, on this machine or others.
    Parallel,
}

/// Settings of the jobs besides the plan.
#[derive(Clone, Copy, Debug)]
pub struct Jobs<'a> {
    /// Number of shards.
    pub shards: usize,
    /// Number of designs at once in each shard, or of shards at once.
    pub at_once: Option<usize>,
    /// Program that computes the shards.
    pub program: &'a Path,
    /// Result folder; the folders of shards begin with its name.
    pub out: &'a Path,
    /// Options that do not change rows.
    pub more: &'a [&'a str],
    /// True for a lean result of the whole sweep.
    pub lean: bool,
}

/// Text of the script.
pub fn script(plan: &SweepPlan, scheduler: Scheduler, settings: &Jobs) -> String {
    let program = quoted(&settings.program.display().to_string());
    let more = settings.more.iter().map(|word| (*word).to_owned());
    let options: Vec<String> = plan
        .options()
        .into_iter()
        .chain(more)
        .map(|word| quoted(&word))
        .collect();
    let options = options.join(" ");
    let (out, shards, jobs) = (
        quoted(&settings.out.display().to_string()),
        settings.shards,
        settings.at_once,
    );
    let lean = if settings.lean { " --lean" } else { "" };
    let merge = format!("\"$slcbeam\" merge {out}-shard-*{lean} --out {out}");
    let sweep = |shard: &str, jobs: &str| {
        format!(
            "\"$slcbeam\" sweep {options} --quiet --jobs {jobs} \\\n    --shard \"{shard}/{shards}\" --out {out}-shard-\"{shard}\""
        )
    };
    match scheduler {
        Scheduler::Slurm => format!(
            "#!/bin/sh\n\
             # Shards of a sweep as a job array of Slurm: submit with sbatch, from the folder in which this was written.\n\
             #SBATCH --job-name=slcbeam-sweep\n\
             #SBATCH --array=1-{shards}\n\
             #SBATCH --ntasks=1\n\
             #SBATCH --cpus-per-task={}\n\
             set -eu\n\
             slcbeam=${{SLCBEAM:-{program}}}\n\
             {}\n\
             # When all have ended, and again after one that was lost:\n\
             #   slcbeam={program}; {merge}\n",
            jobs.unwrap_or(1),
            sweep("$SLURM_ARRAY_TASK_ID", "\"${SLURM_CPUS_PER_TASK:-1}\""),
        ),
        Scheduler::Parallel => format!(
            "#!/bin/sh\n\
             # Shards of a sweep by GNU parallel: run with sh, from the folder in which this was written. Started again it goes on.\n\
             set -eu\n\
             slcbeam=${{SLCBEAM:-{program}}}\n\
             if [ $# -eq 1 ]; then\n  exec {}\nfi\n\
             # a shard that fails is named by merge\n\
             parallel --quote {}sh \"$0\" ::: $(seq {shards}) || true\n\
             {merge}\n",
            sweep("$1", "1"),
            jobs.map_or(String::new(), |jobs| format!("--jobs {jobs} ")),
        ),
    }
}
