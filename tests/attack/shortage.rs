//! Too little of everything: memory and threads.

use std::process::{Command, Output};

use super::program::stderr;

/// A run with a limit on the addresses of the process [kB].
fn limited(kilobytes: u32, arguments: &str) -> Output {
    let script = format!(
        "ulimit -v {kilobytes}; exec {} {arguments}",
        env!("CARGO_BIN_EXE_slcbeam")
    );
    Command::new("sh").args(["-c", &script]).output().expect("a shell")
}

/// Goal: where the system grants no thread, as stacks do not fit into the addresses of the process, the work is done without; no limit
/// ends in a panic.
#[test]
fn no_thread_and_little_memory_are_no_panic() {
    let dir = tempfile::tempdir().expect("a folder");
    let mut finished = 0;
    for kilobytes in (30_000..130_000).step_by(5_000) {
        let out = dir.path().join(kilobytes.to_string());
        let run = format!("run cases/bend-dry.json --quiet --out {}", out.display());
        let output = limited(kilobytes, &run);
        let told = stderr(&output);
        assert!(
            !told.contains("panicked") && !told.contains("failed to spawn"),
            "{kilobytes}: {told}"
        );
        match output.status.code() {
            Some(0) => finished += 1,
            Some(3 | 5) => assert!(!told.is_empty()),
            // the loader of the system needs some, too, and may end without a word or leave not one byte
            Some(127) => {}
            None if told.is_empty() => {}
            other => panic!("{kilobytes} kB end with {other:?}: {told}"),
        }
    }
    assert!(finished > 0);
}
