//! Jobs that compute the shards of a sweep, for a scheduler.

use std::path::Path;

use crate::results::sweep::Plan;
use crate::study::sweep::plan::quoted;

/// Who starts the jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheduler {
    /// A job array of Slurm.
    Slurm,
    /// GNU parallel, on this machine or others.
    Parallel,
}

/// The script for so many shards; `program` is what computes them, results go into folders named like `out`.
pub fn script(
    plan: &Plan,
    scheduler: Scheduler,
    shards: usize,
    jobs: Option<usize>,
    program: &Path,
    out: &Path,
) -> String {
    let program = quoted(&program.display().to_string());
    let options: Vec<String> = plan.options().iter().map(|word| quoted(word)).collect();
    let options = options.join(" ");
    let out = quoted(&out.display().to_string());
    let merge = format!("\"$slcbeam\" merge {out}-shard-* --out {out}");
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
