//! Flags that are no numbers, and readers that are gone.

use std::path::Path;
use std::process::Command;

use crate::program::{CASE, run, stderr};

/// The program's exit code with its streams redirected by a shell.
fn redirected(arguments: &str, streams: &str) -> Option<i32> {
    let script = format!("exec {} {arguments} {streams}", env!("CARGO_BIN_EXE_slcbeam"));
    Command::new("bash")
        .args(["-c", &script])
        .status()
        .expect("it starts")
        .code()
}

/// Nobody reads what is told: the work goes on, and the exit code says how it ended.
#[test]
fn streams_that_nobody_reads_stop_nothing() {
    let folder = tempfile::tempdir().expect("a place");
    let out = folder.path().join("x");
    let short = "--set /time/end_s=0.01 --set /time/window_s=0.01";
    for streams in ["2>&-", "2>/dev/full", "2> >(exec 0<&-; sleep 0.1)"] {
        let ran = redirected(&format!("run {CASE} {short} --out {}", out.display()), streams);
        assert_eq!(ran, Some(0), "{streams}");
        assert_eq!(redirected("check no-such-file.json", streams), Some(2), "{streams}");
        assert_eq!(
            redirected(&format!("check {CASE} --set /beam/length_m=-1"), streams),
            Some(3),
            "{streams}"
        );
        assert_eq!(redirected("run --no-such-flag", streams), Some(2), "{streams}");
        assert_eq!(
            redirected(
                &format!("modes {CASE} --count 2 --out {}/m", folder.path().display()),
                streams
            ),
            Some(0)
        );
    }
    // a reader that has had enough is no fault; a full disk is one
    assert_eq!(
        redirected(&format!("check {CASE}"), "| head -1 >/dev/null; exit ${PIPESTATUS[0]}"),
        Some(0)
    );
    assert_eq!(redirected(&format!("check {CASE}"), ">/dev/full 2>/dev/null"), Some(5));
}

/// A limit on the size of files is a fault of writing, with the file's name.
#[test]
fn a_limit_on_sizes_is_told() {
    let folder = tempfile::tempdir().expect("a place");
    let program = env!("CARGO_BIN_EXE_slcbeam");
    let script = format!(
        "ulimit -f 100; exec {program} run {CASE} --quiet --out {}",
        folder.path().join("x").display()
    );
    let output = Command::new("bash").args(["-c", &script]).output().expect("it starts");
    assert_eq!(output.status.code(), Some(5), "{}", stderr(&output));
    assert!(stderr(&output).contains("cannot write"), "{}", stderr(&output));
}

#[test]
fn a_wall_time_is_a_number() {
    let folder = tempfile::tempdir().expect("a place");
    for wrong in ["nan", "inf", "-1", "soon", "1e400", ""] {
        let output = run(&folder.path().join("x"), &[&format!("--max-wall={wrong}")]);
        assert_eq!(output.status.code(), Some(2), "{wrong}: {}", stderr(&output));
        assert!(stderr(&output).contains("--max-wall"), "{}", stderr(&output));
    }
}

/// More rows or checkpoints than anyone reads, of a case that a schema takes.
#[test]
fn intervals_have_an_end() {
    for set in [
        "/time/output_interval_s=1e-12",
        "/time/checkpoint_interval_s=1e-300",
        "/time/checkpoint_interval_s=1e-9",
    ] {
        let output = run(Path::new("/nowhere"), &["--set", set]);
        assert_eq!(output.status.code(), Some(3), "{set}: {}", stderr(&output));
        assert!(stderr(&output).contains("E019"), "{set}: {}", stderr(&output));
    }
}
