//! Every command with cases, texts and flags that chance has changed: an answer, in words, within bounds of time and memory.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::chance::Random;
use crate::program::{MEMORY, PATIENCE, answer, bounded};

/// Exit codes that a command has.
const CODES: [i32; 5] = [0, 2, 3, 4, 5];

/// A trial: the case's text, the arguments, and whether the case has a key that none has.
struct Trial {
    text: Vec<u8>,
    arguments: Vec<String>,
    foreign: bool,
}

fn cases() -> Vec<PathBuf> {
    let mut all: Vec<PathBuf> = ["cases", "cases/hard"]
        .iter()
        .flat_map(|dir| fs::read_dir(dir).expect("cases"))
        .map(|e| e.expect("a case").path())
        .filter(|p| p.extension().is_some_and(|e| e == "json") && !p.ends_with("schema.json"))
        .collect();
    all.sort();
    all
}

/// Pointers of all values below one.
fn pointers(value: &Value, here: &str, all: &mut Vec<String>) {
    all.push(here.to_string());
    match value {
        Value::Object(members) => {
            for (key, inner) in members {
                let key = key.replace('~', "~0").replace('/', "~1");
                pointers(inner, &format!("{here}/{key}"), all);
            }
        }
        Value::Array(items) => {
            for (k, inner) in items.iter().enumerate() {
                pointers(inner, &format!("{here}/{k}"), all);
            }
        }
        _ => {}
    }
}

/// Values that break what expects others.
fn odd(r: &mut Random) -> Value {
    let texts = [
        "0",
        "-1",
        "1e308",
        "-1e308",
        "1e-308",
        "5e-324",
        "1e15",
        "18446744073709551615",
        "0.5",
        "null",
        "true",
        "\"\"",
        "[]",
        "{}",
        "\"\\u001b[31m\"",
        "\"auto\"",
        "[[[[]]]]",
        "{\"sine\":{}}",
        "{\"ramp\":{\"to\":1e300,\"duration_s\":1e-300}}",
        "{\"sum\":[]}",
        "{\"table\":{\"times_s\":[0,0],\"values\":[1,2]}}",
        "{\"table\":{\"csv\":\"/dev/zero\"}}",
        "[1,2,3,-1,99999]",
        "100000",
        "1e-9",
        "1e9",
    ];
    serde_json::from_str(r.choose::<&str>(&texts)).expect("JSON")
}

fn trial(seed: u64, cases: &[PathBuf]) -> Trial {
    let r = &mut Random(seed);
    let text = fs::read_to_string(&cases[r.below(cases.len())]).expect("a case");
    let mut value: Value = serde_json::from_str(&text).expect("JSON");
    let mut foreign = false;
    for _ in 0..1 + r.below(3) {
        let mut all = vec![];
        pointers(&value, "", &mut all);
        let pointer = all[r.below(all.len())].clone();
        let Some(place) = value.pointer_mut(&pointer) else {
            continue;
        };
        match r.below(8) {
            0 => {
                if let (Value::Object(members), true) = (&mut *place, pointer.is_empty() || pointer == "/beam") {
                    members.insert("n\u{f6}t_a_key".into(), odd(r));
                    foreign = true;
                }
            }
            1 => {
                if let Value::Array(items) = place
                    && let Some(first) = items.first().cloned()
                {
                    items.extend(std::iter::repeat_n(first, r.below(50)));
                }
            }
            2 | 3 => {
                if let Some(number) = place.as_f64() {
                    let factor = 10f64.powi(r.below(25) as i32 - 12);
                    *place = serde_json::json!(if r.below(4) == 0 { -number } else { number * factor });
                }
            }
            4 if !pointer.is_empty() => *place = Value::Null,
            _ if pointer.is_empty() => {}
            _ => *place = odd(r),
        }
    }
    // a member that was put in may have been written over with its parent
    foreign &= value.to_string().contains("n\u{f6}t_a_key");
    let mut text = value.to_string().into_bytes();
    if r.below(10) == 0 {
        foreign = false;
        for _ in 0..1 + r.below(4) {
            let k = r.below(text.len());
            match r.below(3) {
                0 => text.truncate(k.max(1)),
                1 => text[k] = r.bits() as u8,
                _ => text.insert(k, b"{}[],:\"\\\x00\x1b-e9"[r.below(13)]),
            }
        }
    }
    let commands: [&[&str]; 12] = [
        &["check"],
        &["check"],
        &["check", "--json"],
        &["run", "--quiet", "--max-wall", "1"],
        &["run", "--quiet", "--max-wall", "1", "--json"],
        &["run", "--max-wall", "1", "--accuracy", "0.1"],
        &["run", "--quiet", "--max-wall", "1", "--resume"],
        &["equilibrium", "--quiet"],
        &["modes", "--quiet", "--count", "2"],
        &["mapping"],
        &["effects", "--quiet", "--budget", "1s", "--repeats", "0"],
        &["study", "--quiet", "--budget", "1s"],
    ];
    let mut arguments: Vec<String> = r.choose(&commands).iter().map(ToString::to_string).collect();
    let flags: [&[&str]; 9] = [
        &[],
        &[],
        &[],
        &["--set", "/solver/rtol=1e-4"],
        &["--set", "/nonsense=1"],
        &["--set", "/loads/-={\"force_x_n_m\":{\"signal\":1}}"],
        &["--set", "/time/end_s=1e9"],
        &["--set", "x"],
        &["--no-such-flag"],
    ];
    arguments.extend(r.choose(&flags).iter().map(ToString::to_string));
    Trial {
        text,
        arguments,
        foreign,
    }
}

/// Runs a trial; what is wrong with it.
fn judge(trial: &Trial, dir: &Path) -> Option<String> {
    let case = dir.join("fuzz.json");
    fs::write(&case, &trial.text).expect("a case");
    let out = dir.join("out");
    let writes = !["check", "mapping"].contains(&trial.arguments[0].as_str());
    let mut command = bounded(MEMORY);
    command.arg(&trial.arguments[0]).arg(&case).args(&trial.arguments[1..]);
    if writes {
        command.arg("--out").arg(&out);
    }
    let Some(answer) = answer(&mut command, PATIENCE) else {
        return Some(format!("no answer in {PATIENCE:?}"));
    };
    let [told, err] = [&answer.stdout, &answer.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    let code = answer.status.code();
    let wrong = if err.contains("panicked at") || err.contains("memory allocation of") {
        Some("it panics".to_string())
    } else if !code.is_some_and(|code| CODES.contains(&code)) {
        Some(format!("it ends with {}", answer.status))
    } else if code != Some(0) && err.trim().is_empty() && told.trim().is_empty() {
        Some("it fails without a word".into())
    } else if code == Some(0) && trial.foreign {
        Some("a key that none is is taken".into())
    } else if told.contains("NaN,") || told.contains(": NaN") {
        Some("its JSON has NaN".into())
    } else {
        None
    };
    if out.exists() && !trial.arguments.contains(&"--resume".to_string()) {
        let _ = fs::remove_dir_all(&out);
    }
    wrong.map(|wrong| format!("{wrong}: {}", err.lines().take(3).collect::<Vec<_>>().join(" | ")))
}

/// Trials from a seed on, on all cores; what is wrong is told with its case kept.
fn fuzz(first: u64, count: u64) {
    let folder = tempfile::tempdir().expect("a place");
    let cases = cases();
    let next = std::sync::atomic::AtomicU64::new(first);
    let wrong = std::sync::Mutex::new(vec![]);
    std::thread::scope(|scope| {
        for worker in 0..2 {
            let dir = folder.path().join(worker.to_string());
            fs::create_dir(&dir).expect("a folder");
            let (next, wrong, cases) = (&next, &wrong, &cases);
            scope.spawn(move || {
                loop {
                    let seed = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    if seed >= first + count {
                        return;
                    }
                    let trial = trial(seed, cases);
                    if let Some(what) = judge(&trial, &dir) {
                        let kept = std::env::temp_dir().join(format!("slcbeam-fuzz-{seed}.json"));
                        let _ = fs::write(&kept, &trial.text);
                        let told = format!("seed {seed}, {} {}: {what}", trial.arguments.join(" "), kept.display());
                        println!("{told}");
                        wrong.lock().expect("a list").push(told);
                    }
                }
            });
        }
    });
    let wrong = wrong.into_inner().expect("a list");
    println!("{count} trials, {} wrong", wrong.len());
    assert!(wrong.is_empty(), "{} of {count}:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn whatever_is_asked_is_answered() {
    fuzz(1, 200);
}

#[test]
#[ignore = "half an hour"]
fn whatever_is_asked_is_answered_ten_thousand_times() {
    fuzz(1, 10_000);
}
