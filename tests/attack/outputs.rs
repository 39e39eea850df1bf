//! Results that are damaged, or made to harm whoever reads them; outputs that never end, and those that are left out.

mod damaged;
mod going;

use std::path::Path;
use std::process::Output;

use crate::program::{MEMORY, PATIENCE, answer, bounded, stderr};

/// The program with bounded memory and time.
fn told(arguments: &[&str]) -> Output {
    answer(bounded(MEMORY).args(arguments), PATIENCE).unwrap_or_else(|| panic!("no answer: {arguments:?}"))
}

/// That it neither panicked nor was aborted; its exit code.
fn answered(output: &Output, what: &str) -> i32 {
    let error = stderr(output);
    let code = output.status.code();
    assert!(
        !error.contains("panicked") && code.is_some_and(|code| code < 100),
        "{what}: {code:?} {error}"
    );
    code.unwrap_or_default()
}

/// `export`, `report` and `compare` of a folder, beside a sound one; the codes of the three.
fn read_by_all(dir: &Path, sound: &Path, what: &str) -> [i32; 3] {
    let path = |p: &Path| p.display().to_string();
    let (dir, sound) = (path(dir), path(sound));
    let out = format!("{dir}-exported");
    let commands: [&[&str]; 3] = [
        &["export", &dir, "--out", &out],
        &["report", &dir],
        &["compare", &dir, &sound],
    ];
    commands.map(|command| answered(&told(command), what))
}
