//! What was found so far, a line a scene, so that a search goes on where it ended.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::sync::Mutex;

use std::time::Instant;

use serde_json::{Value, json};

use crate::judge::{self, Both, DEFAULT, KNOWN, NEEDLESS, Word};
use crate::run::each_seed;
use crate::scene::{self, Kind};

/// Where scenes that fail, and the tally, are written.
pub const FOLDER: &str = "target/adversary";
/// An accuracy is asked of every so many scenes: a search costs as much as the rest.
pub const EVERY: u64 = 4;

/// Runs scenes on two threads and returns the line of each; with `resume` those of earlier runs of this build are kept.
pub fn run(kind: Kind, first: u64, count: u64, resume: bool) -> Vec<Value> {
    fs::create_dir_all(FOLDER).expect("a folder for what is found");
    let file = format!("{FOLDER}/tally.jsonl");
    let build = build();
    let earlier = if resume {
        read(&file, &build, kind)
    } else {
        BTreeMap::new()
    };
    let seeds: Vec<u64> = (first..first + count)
        .filter(|seed| !earlier.contains_key(seed))
        .collect();
    let lines: Vec<Value> = earlier
        .into_iter()
        .filter(|(s, _)| (first..first + count).contains(s))
        .map(|(_, l)| l)
        .collect();
    let lines = Mutex::new(lines);
    each_seed(&seeds, |seed| {
        let line = one(kind, seed, &build);
        println!("{}", told(&line));
        let mut lines = lines.lock().expect("no thread panics while it writes");
        if resume {
            let mut file = OpenOptions::new()
                .create(true)
                .append(true)
                .open(&file)
                .expect("the tally");
            writeln!(file, "{line}").expect("the tally");
        }
        lines.push(line);
    });
    let mut lines = lines.into_inner().expect("no thread panics while it writes");
    lines.sort_by_key(|line| line["seed"].as_u64());
    lines
}

/// What was asked of a seed's scene.
pub fn asked(seed: u64) -> f64 {
    if (seed / 4).is_multiple_of(2) { 0.1 } else { 0.01 }
}

/// How well a reference is to be known, if that can be had.
pub fn close(kind: Kind, asked: f64, promised: bool) -> f64 {
    let judged = match kind {
        Kind::Sane => NEEDLESS,
        _ if promised => asked.min(DEFAULT),
        _ => DEFAULT,
    };
    KNOWN * judged
}

fn one(kind: Kind, seed: u64, build: &str) -> Value {
    let scene = scene::draw(seed, kind);
    let began = Instant::now();
    let Both {
        default,
        promise,
        asked,
        ratios,
    } = {
        let parts = [true, seed.is_multiple_of(EVERY)];
        judge::judge(&scene, asked(seed), parts, close(kind, asked(seed), parts[1]))
    };
    for (part, verdict) in [("default", &default), ("promise", &promise)] {
        if verdict.word == Word::Silent {
            write(&format!("{FOLDER}/{}-{part}.json", name(kind, seed)), &scene);
        }
    }
    json!({
        "build": build, "kind": format!("{kind:?}"), "seed": seed, "asked": asked, "ratios": ratios,
        "default": format!("{:?}", default.word), "default_why": default.why,
        "causes": default.causes.iter().map(|c| format!("{c:?}")).collect::<Vec<_>>(),
        "needless": default.needless.map(|codes| codes.iter().map(|c| c.id()).collect::<Vec<_>>()),
        "promise": format!("{:?}", promise.word), "promise_why": promise.why,
        "wall_s": (1e3 * began.elapsed().as_secs_f64()).round() / 1e3
    })
}

/// A scene's name.
pub fn name(kind: Kind, seed: u64) -> String {
    let of = match kind {
        Kind::Sane => "sane",
        Kind::Further => "further",
        Kind::Parts => "parts",
        Kind::Graph => "graph",
        Kind::Extreme => "scene",
    };
    format!("{of}-{seed}")
}

/// Writes a scene so that `slcbeam run` takes it.
pub fn write(path: &str, scene: &Value) {
    fs::write(Path::new(path), format!("{scene:#}\n")).expect("a scene that fails is written");
}

fn told(line: &Value) -> String {
    let text = |key: &str| line[key].as_str().unwrap_or_default().to_owned();
    let default = format!(
        "{:>5} {:>6.2} s default {:<8} {}",
        line["seed"],
        line["wall_s"].as_f64().unwrap_or_default(),
        text("default"),
        text("default_why")
    );
    if line["promise"] == "Skipped" {
        return default;
    }
    format!(
        "{default}\n      asked {:<4} {:<8} {}",
        line["asked"],
        text("promise"),
        text("promise_why")
    )
}

fn read(file: &str, build: &str, kind: Kind) -> BTreeMap<u64, Value> {
    let text = fs::read_to_string(file).unwrap_or_default();
    let lines = text.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let mine = lines.filter(|line| line["build"] == build && line["kind"] == format!("{kind:?}"));
    mine.filter_map(|line| Some((line["seed"].as_u64()?, line))).collect()
}

/// A number that another build does not have (FNV-1a of the program that runs).
fn build() -> String {
    let program = std::env::current_exe()
        .ok()
        .and_then(|path| fs::read(path).ok())
        .unwrap_or_default();
    let hash = program.iter().fold(0xCBF2_9CE4_8422_2325_u64, |h, b| {
        (h ^ u64::from(*b)).wrapping_mul(0x0100_0000_01B3)
    });
    format!("{hash:016x}")
}

/// The tally as a table.
pub fn table(lines: &[Value]) -> String {
    let words = [
        Word::Right,
        Word::Warned,
        Word::Ended,
        Word::Silent,
        Word::Unknown,
        Word::Refused,
        Word::Skipped,
    ];
    let mut table = format!(
        "| of {} | default settings | accuracy asked | seeds |\n|---|---|---|---|\n",
        lines.len()
    );
    for word in words {
        let seeds = |part: &str| -> Vec<u64> {
            let mine = lines.iter().filter(|line| line[part] == format!("{word:?}"));
            mine.filter_map(|line| line["seed"].as_u64()).collect()
        };
        let (a, b) = (seeds("default"), seeds("promise"));
        let some: BTreeSet<u64> = a.iter().chain(&b).copied().collect();
        let some: Vec<String> = some.iter().take(8).map(u64::to_string).collect();
        table += &format!(
            "| {} | {} | {} | {} |\n",
            words_of(word),
            a.len(),
            b.len(),
            some.join(", ")
        );
    }
    let needless = lines.iter().filter(|line| !line["needless"].is_null()).count();
    table += &format!("\n{needless} of {} warned needlessly.\n", lines.len());
    let ratios: Vec<f64> = lines
        .iter()
        .flat_map(|l| l["ratios"].as_array().into_iter().flatten())
        .filter_map(Value::as_f64)
        .collect();
    let share =
        |keep: &dyn Fn(f64) -> bool| ratios.iter().filter(|r| keep(**r)).count() as f64 / ratios.len().max(1) as f64;
    table += &format!(
        "Error within 5 times its estimate: {:.1} %, estimate within a factor of 5: {:.1} % of {} quantities.\n",
        100.0 * share(&|r| r <= 5.0),
        100.0 * share(&|r| (0.2..=5.0).contains(&r)),
        ratios.len()
    );
    table
}

fn words_of(word: Word) -> &'static str {
    match word {
        Word::Right => "right",
        Word::Warned => "off, and warned of",
        Word::Ended => "ended early, and said why",
        Word::Silent => "**silently wrong**",
        Word::Unknown => "not judged: reference not known well enough, or too long",
        Word::Refused => "refused by the check of the case",
        Word::Skipped => "no accuracy asked",
    }
}

/// Seeds that are silently wrong, and how.
pub fn silent(lines: &[Value]) -> Vec<(u64, String)> {
    let wrong = lines
        .iter()
        .filter(|l| [&l["default"], &l["promise"]].iter().any(|w| **w == "Silent"));
    wrong
        .filter_map(|line| Some((line["seed"].as_u64()?, told(line))))
        .collect()
}
