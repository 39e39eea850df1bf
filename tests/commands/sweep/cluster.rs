//! Shards on the scheduler that clusters have, with this host as its only node.

use std::fs;
use std::process::Command;

use tempfile::TempDir;

use super::common::{AREA, CASE, SHORT, path, say, table, well};

/// Goal: the job script of Slurm works as it is written: its array computes all shards, a shard that is lost is named when they are joined, the
/// array computes it again alone, and the table is then that of one sweep.
#[test]
fn a_job_array_computes_the_table() {
    let dir = TempDir::new().expect("a folder");
    let case = fs::canonicalize(CASE).expect("a case").display().to_string();
    let vary = format!("{AREA}=log:1e-10:1e-9:5");
    let (whole, parts) = (path(&dir, "whole"), path(&dir, "parts"));
    let asked = [&["sweep", &case, "--vary", &vary, "--lean", "--quiet"], &SHORT[..]].concat();
    well(&say(&[&asked[..], &["--out", &whole]].concat()));
    let script = say(&[&asked[..], &["--script", "slurm", "--shards", "3", "--out", &parts]].concat());
    well(&script);
    fs::write(path(&dir, "job.sh"), &script.out).expect("written");
    let steps = "sbatch --quiet --wait job.sh
        rm -r parts-shard-2
        \"$SLCBEAM\" merge parts-shard-* --out parts && exit 1
        sbatch --quiet --wait --array=2 job.sh
        \"$SLCBEAM\" merge parts-shard-* --out parts";
    let node = fs::canonicalize("tests/commands/sweep/one-node.sh").expect("a script");
    let said = Command::new("timeout")
        .args(["120", "bash"])
        .arg(node)
        .args([&path(&dir, "slurm"), "bash", "-c", steps])
        .env("SLCBEAM", env!("CARGO_BIN_EXE_slcbeam"))
        .current_dir(dir.path())
        .output()
        .expect("a shell");
    let text = String::from_utf8_lossy(&said.stderr);
    assert!(
        said.status.success(),
        "{text}\n`scripts/install slurm-wlm munge` installs what is needed, `scripts/test` does so by itself"
    );
    assert!(text.contains("--shard 2/3"), "{text}");
    assert_eq!(table(&parts), table(&whole));
}
