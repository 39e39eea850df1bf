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

/// A call of the program.
struct Call {
    name: String,
    /// What it is asked.
    rest: String,
    /// Which of this name it is in its thread, as `strace` counts.
    count: usize,
    /// Lines of the log at which it begins and ends.
    begins: usize,
    ends: usize,
}

/// All calls in the order in which they begin.
fn calls(log: &str) -> Vec<Call> {
    let mut counts: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    let mut under_way: BTreeMap<&str, usize> = BTreeMap::new();
    let mut all: Vec<Call> = vec![];
    for (k, line) in log.lines().enumerate() {
        // "1234  openat(..." ; "1234  <... openat resumed>..."
        let Some((thread, call)) = line.split_once(' ') else {
            continue;
        };
        if call.contains(" resumed>") {
            let begun = under_way.remove(thread).expect("it has begun");
            all[begun].ends = k;
            continue;
        }
        let Some((name, rest)) = call.trim_start().split_once('(') else {
            continue;
        };
        if !CALLS.split(',').any(|c| c == name) {
            continue;
        }
        let count = counts.entry((thread, name)).or_default();
        *count += 1;
        if rest.ends_with("<unfinished ...>") {
            under_way.insert(thread, all.len());
        }
        all.push(Call {
            name: name.into(),
            rest: rest.into(),
            count: *count,
            begins: k,
            ends: k,
        });
    }
    all
}

/// Every call of the finishing phase that can be struck: its name and which of this name in its thread it is, which no call of any thread was
/// before.
fn calls_of_finishing(log: &str) -> Vec<(String, usize)> {
    let all = calls(log);
    let last = all
        .iter()
        .rposition(|call| call.name == "rename" && call.rest.contains("/checkpoint.json\""))
        .expect("a checkpoint");
    let (before, finishing) = all.split_at(last + 1);
    let struck = |call: &&Call| before.iter().all(|b| b.name != call.name || b.count != call.count);
    let mut found = vec![];
    for call in finishing.iter().filter(struck) {
        let one = (call.name.clone(), call.count);
        if !found.contains(&one) {
            found.push(one);
        }
    }
    found
}

/// Without checkpoints the disk is waited for when the run has ended, by threads that wait for a file each: where it takes none of them, or the
/// program ends there, nothing says that the run has finished.
#[test]
fn a_disk_that_takes_nothing_makes_no_finished_run() {
    let folder = tempfile::tempdir().expect("a place");
    let log = folder.path().join("log");
    for call in ["fsync", "fdatasync"] {
        for fault in ["error=EIO", "error=ENOSPC", "signal=KILL"] {
            let out = folder.path().join(format!("{call}-{fault}"));
            let inject = format!("inject={call}:{fault}:when=1");
            let none = ["--set", "/time/checkpoint_interval_s=null"];
            let Some(output) = traced(&out, &log, &["-e", &inject], &none) else {
                println!("skipped: system calls cannot be traced here");
                return;
            };
            assert!(!output.status.success(), "{inject}");
            let told = fs::read_to_string(out.join("summary.json")).unwrap_or_default();
            assert!(!told.contains("\"status\": \"finished\""), "{inject}");
            assert!(!out.join("fields.npz").exists(), "{inject}");
            let raw = out.join("fields.part/t_fields_s.f64");
            assert!(
                fs::metadata(raw).is_ok_and(|raw| raw.len() > 0),
                "{inject}: raw arrays stay"
            );
        }
    }
}

/// Nothing takes its name, or goes, before what it relies on is on the disk itself.
#[test]
fn what_a_name_promises_is_on_the_disk() {
    let folder = tempfile::tempdir().expect("a place");
    let (out, log) = (folder.path().join("whole"), folder.path().join("log"));
    let told = traced(&out, &log, &["-y"], &[]).filter(|output| output.status.success());
    if told.is_none() {
        println!("skipped: system calls cannot be traced here");
        return;
    }
    let all = calls(&fs::read_to_string(&log).expect("a log"));
    let first = |name: &str, rest: &str| {
        let fits = |call: &&Call| call.name == name && call.rest.contains(rest);
        all.iter().find(fits).unwrap_or_else(|| panic!("no {name} of {rest}"))
    };
    // of a file by the end of its path, whose name is whole or still hidden
    let secured = |path: &str, after: usize, before: usize| {
        let own = |call: &&Call| matches!(&call.name[..], "fsync" | "fdatasync") && call.rest.contains(path);
        let between = |call: &&Call| call.begins > after && call.ends < before;
        let found = all.iter().filter(own).any(|call| between(&call));
        assert!(
            found,
            "{path} is not brought to the disk between lines {after} and {before}"
        );
    };
    let names = first("rename", "/summary.json\"").begins;
    for file in ["/.slcbeam.case>", "/case.json>", "/.fields.npz.", "/.summary.json."] {
        secured(file, 0, names);
    }
    let rows = all
        .iter()
        .rfind(|call| call.name == "write" && call.rest.contains("/history.csv>"));
    secured("/history.csv>", rows.expect("rows").ends, names);
    assert!(first("rename", "/fields.npz\"").ends < names);
    let gone = first("unlink", "/checkpoint.json\"").begins;
    secured("/whole>", names, gone);
    for file in [
        "deflection.svg",
        "pressure.svg",
        "history.svg",
        "energy.svg",
        "report.html",
    ] {
        let named = first("rename", &format!("/{file}\""));
        assert!(named.begins > names, "{file}");
        secured(&format!("/{file}>"), named.begins, gone);
        secured("/whole>", named.begins, gone);
    }
    let raw = first("unlinkat", ".f64\"").begins;
    secured("/whole>", gone, raw);
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
    assert!(calls.len() > 60, "{} calls", calls.len());
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
