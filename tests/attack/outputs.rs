//! Results that are damaged, or made to harm whoever reads them; outputs that never end, and those that are left out.

mod damaged;
mod going;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use crate::program::{contents, stderr};

/// Address space of a program under attack [KiB].
const MOST_MEMORY: u64 = 4 << 20;
/// Time that it has to answer.
const PATIENCE: Duration = Duration::from_secs(20);

/// The program with bounded memory and time.
fn bounded(arguments: &[&str]) -> Output {
    let mut child = Command::new("sh")
        .args(["-c", &format!("ulimit -v {MOST_MEMORY}; exec \"$0\" \"$@\"")])
        .arg(env!("CARGO_BIN_EXE_slcbeam"))
        .args(arguments)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("it starts");
    let begin = Instant::now();
    while child.try_wait().expect("its state").is_none() {
        if begin.elapsed() > PATIENCE {
            child.kill().expect("it is killed");
            panic!("no answer within {PATIENCE:?}: {arguments:?}");
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    child.wait_with_output().expect("its end")
}

/// That it neither panicked nor was aborted; its exit code.
fn answered(output: &Output, what: &str) -> i32 {
    let told = stderr(output);
    let code = output.status.code();
    assert!(
        !told.contains("panicked") && code.is_some_and(|code| code < 100),
        "{what}: {code:?} {told}"
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
    commands.map(|command| answered(&bounded(command), what))
}

fn copied(from: &Path, to: &Path) {
    let _ = fs::remove_dir_all(to);
    fs::create_dir_all(to).expect("a folder");
    for (name, bytes) in contents(from) {
        fs::write(to.join(name), bytes).expect("a copy");
    }
}
