//! Kills and failing disks at the system calls by which a run ends.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use crate::program::{arguments, run, same, stderr};

/// Calls that change what is on the disk, or bring it there.
const CALLS: &str = "openat,write,rename,unlink,unlinkat,rmdir,fsync,fdatasync,ftruncate,mkdir,flock,chmod,fchmod";

/// The short run under `strace` with more of its arguments; `None` where tracing is not permitted.
fn traced(out: &Path, log: &Path, strace: &[&str], more: &[&str]) -> Option<Output> {
    let output = Command::new("strace")
        .args(["-f", "-qq", "-e", &format!("trace={CALLS}"), "-o"])
        .arg(log)
        .args(strace)
        .arg(env!("CARGO_BIN_EXE_slcbeam"))
        .args(arguments())
        .args(more)
        .arg("--out")
        .arg(out)
        .stdin(Stdio::null())
        .output()
        .ok()?;
    fs::metadata(log).ok().filter(|log| log.len() > 0).map(|_| output)
}

/// Every call of the finishing phase: its name and which of this name in the whole run it is.
fn calls_of_finishing(log: &str) -> Vec<(String, usize)> {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut all = vec![];
    for line in log.lines() {
        // "1234  openat(..." ; calls that are resumed were counted when they began
        let Some((_, call)) = line.split_once(' ') else {
            continue;
        };
        let Some((name, rest)) = call.trim_start().split_once('(') else {
            continue;
        };
        if !CALLS.split(',').any(|c| c == name) {
            continue;
        }
        let count = counts.entry(name).or_default();
        *count += 1;
        all.push((name.to_string(), *count, rest.to_string()));
    }
    let last = all
        .iter()
        .rposition(|(name, _, rest)| name == "rename" && rest.contains("/checkpoint.json\")"))
        .expect("a checkpoint");
    all.into_iter()
        .skip(last + 1)
        .map(|(name, count, _)| (name, count))
        .collect()
}

/// Strikes at every `stride`-th call from `first` on, then resumes: the end is the same.
fn strike(first: usize, stride: usize, faults: &[&str]) {
    let folder = tempfile::tempdir().expect("a place");
    let (whole, log) = (folder.path().join("whole"), folder.path().join("log"));
    let Some(output) = traced(&whole, &log, &[], &[]) else {
        println!("skipped: system calls cannot be traced here");
        return;
    };
    if !output.status.success() {
        println!(
            "skipped: system calls cannot be traced here ({})",
            stderr(&output).trim()
        );
        return;
    }
    let calls = calls_of_finishing(&fs::read_to_string(&log).expect("a log"));
    assert!(calls.len() > 30, "{} calls", calls.len());
    let (mut struck, mut lost) = (0, vec![]);
    for fault in faults {
        for (name, count) in calls.iter().skip(first).step_by(stride) {
            let out = folder.path().join("x");
            let _ = fs::remove_dir_all(&out);
            let inject = format!("inject={name}:{fault}:when={count}");
            let output = traced(&out, &log, &["-e", &inject], &[]).expect("it is traced");
            struck += 1;
            let told = if output.status.success() {
                String::new()
            } else {
                let again = run(&out, &["--resume"]);
                if again.status.success() {
                    String::new()
                } else {
                    stderr(&again)
                }
            };
            if !told.is_empty() {
                lost.push(format!("{inject}: {told}"));
            } else if let Err(why) = same(&whole, &out) {
                lost.push(format!("{inject}: {why}"));
            }
        }
    }
    println!(
        "{struck} strikes at {} calls of finishing, {} lost",
        calls.len(),
        lost.len()
    );
    assert!(lost.is_empty(), "{} of {struck} lost:\n{}", lost.len(), lost.join("\n"));
}

#[test]
fn a_kill_while_finishing_loses_nothing() {
    strike(0, 7, &["signal=KILL"]);
}

#[test]
fn a_failing_disk_while_finishing_loses_nothing() {
    strike(3, 19, &["error=ENOSPC", "error=EIO", "error=EROFS"]);
}

#[test]
#[ignore = "minutes"]
fn a_strike_at_every_call_of_finishing_loses_nothing() {
    strike(0, 1, &["signal=KILL", "error=ENOSPC", "error=EIO", "error=EROFS"]);
}
