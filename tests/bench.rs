//! The benchmark of docs/performance.md runs: each peer once, coarsely. No time is judged.

use std::process::Command;

fn quick(more: &[&str]) -> String {
    let mut command = Command::new("scripts/bench");
    // the crate of the peers is no part of this workspace and has a folder of its own for what it builds
    for name in ["CARGO_TARGET_DIR", "CARGO_BUILD_TARGET_DIR"] {
        command.env_remove(name);
    }
    let answer = command.arg("--quick").args(more).output().expect("it starts");
    let text = String::from_utf8_lossy(&answer.stdout).into_owned();
    let words = String::from_utf8_lossy(&answer.stderr);
    assert!(answer.status.success(), "{text}\n{words}");
    text
}

/// Goal: what is compared in Rust and C still builds and runs, and comes to the same motion: 1e-4 of it at rtol 1e-6.
#[test]
#[ignore = "builds the peers, a crate of its own"]
fn integrators_and_large_systems_run() {
    let text = quick(&["--rust"]);
    for what in [
        "esdirk46",
        "diffsol-esdirk34-klu",
        "SUNDIALS in C, ida2",
        "peers, radau",
        "random:",
    ] {
        assert!(text.contains(what), "no {what} in\n{text}");
    }
}

/// Goal: the same with Python's peers, whose packages the script installs, equations equal to 1e-10.
#[test]
#[ignore = "installs Python packages"]
fn peers_in_python_run() {
    let text = quick(&[]);
    for what in [
        "equations in Python and in slcbeam agree",
        "scipy-radau",
        "elastica-10: ",
        "exudyn-4: ",
    ] {
        assert!(text.contains(what), "no {what} in\n{text}");
    }
}
