//! The house: what may import what, what must not be written, what every equation and every unsafe block needs.
//!
//! Each test reads the source as text and reports all offences at once, as `file:line: what`.

#[path = "common/files.rs"]
mod files;

use std::fs;
use std::path::{Path, PathBuf};

use files::files;

/// Rooms from top to bottom: a file imports from its own room and from rooms above it.
const ROOMS: [&str; 18] = [
    "error",
    "numerics",
    "functions",
    "sparse",
    "case",
    "model",
    "discrete",
    "dae",
    "integrate",
    "sundials",
    "onestep",
    "spectral",
    "run",
    "study",
    "results",
    "output",
    "cli",
    "main",
];

/// Rooms that call C.
const UNSAFE: [&str; 2] = ["sparse", "sundials"];

/// Folder of the library that C calls.
const FMU: &str = "crates/fmu/src";

/// Lines of a file beyond which it must be divided.
const LINES: usize = 400;

/// Longer files, each with the reason.
const LONG: [(&str, &str); 4] = [
    ("tests/architecture.rs", "the rules of the house, one test each"),
    (
        "tests/commands/cli.rs",
        "the command line from outside, one small run a test",
    ),
    ("tests/equations.rs", "the index of equations, and one test each"),
    (
        "tests/commands/output.rs",
        "one invented run serves all tests of a result folder",
    ),
];

/// A line of source.
struct Line {
    number: usize,
    text: String,
    /// Without its comment, if it has one.
    code: String,
    /// Within a `#[cfg(test)]` module, or a file of tests.
    test: bool,
}

/// Lines of a source file. Test modules stand at the end of a file, as they do here.
fn lines(path: &Path) -> Vec<Line> {
    let mut test = path.file_name().unwrap() == "tests.rs";
    let text = fs::read_to_string(path).unwrap();
    let all: Vec<&str> = text.lines().collect();
    let mut out = Vec::new();
    for (k, line) in all.iter().enumerate() {
        // `#[cfg(test)] mod tests;` names another file.
        test |= line.trim() == "#[cfg(test)]" && all.get(k + 1).is_some_and(|next| next.ends_with('{'));
        let comment = line.find("//").filter(|&at| !line[..at].contains('"'));
        out.push(Line {
            number: k + 1,
            text: (*line).to_string(),
            code: line[..comment.unwrap_or(line.len())].to_string(),
            test,
        });
    }
    out
}

/// Fails with all offences.
fn none(offences: Vec<String>) {
    assert!(offences.is_empty(), "\n{}\n", offences.join("\n"));
}

fn place(path: &Path, line: &Line, what: impl std::fmt::Display) -> String {
    format!("{}:{}: {what}", path.display(), line.number)
}

/// Room of a source file: its folder under `src`, or its name.
fn room(path: &Path) -> String {
    let below = path.strip_prefix("src").unwrap();
    below
        .iter()
        .next()
        .unwrap()
        .to_string_lossy()
        .trim_end_matches(".rs")
        .to_string()
}

/// Rooms named by `crate::` paths in a piece of code, groups such as `crate::{case, model::Wet}` included.
fn named_rooms(code: &str) -> Vec<String> {
    let word = |text: &str| {
        text.chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect::<String>()
    };
    let mut rooms = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        let Some(group) = rest.strip_prefix('{') else {
            rooms.push(word(rest));
            continue;
        };
        let mut depth = 0;
        let mut fresh = true;
        for (k, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => fresh = true,
                c if fresh && !c.is_whitespace() => {
                    rooms.push(word(&group[k..]));
                    fresh = false;
                }
                _ => {}
            }
        }
    }
    rooms
}

#[test]
fn groups_of_imports_are_understood() {
    assert_eq!(
        named_rooms("use crate::{case::{self, Signal}, model::Wet, dae};"),
        ["case", "model", "dae"]
    );
    assert_eq!(
        named_rooms("fn f(x: crate::error::Result<crate::run::X>)"),
        ["error", "run"]
    );
}

#[test]
fn rooms_import_from_above_only() {
    let rank = |room: &str| ROOMS.iter().position(|r| *r == room);
    let mut offences = Vec::new();
    for path in files("src", &["rs"]) {
        let own = room(&path);
        if own == "lib" {
            continue;
        }
        let lines = lines(&path);
        let Some(here) = rank(&own) else {
            offences.push(format!("{}: no room of the house", path.display()));
            continue;
        };
        let code: String = lines.iter().map(|l| format!("{}\n", l.code)).collect();
        for other in named_rooms(&code) {
            match rank(&other) {
                Some(there) if there <= here => {}
                Some(_) => offences.push(format!("{}: `{own}` imports from `{other}` below it", path.display())),
                None => offences.push(format!("{}: `crate::{other}` is no room", path.display())),
            }
        }
        for line in lines.iter().filter(|l| l.code.contains("super::super")) {
            offences.push(place(&path, line, "climbs with super::super; name the room"));
        }
    }
    none(offences);
}

#[test]
fn unsafe_code_stays_in_its_room_and_says_why_it_is_sound() {
    // A block needs a SAFETY comment close above it; a function of ours a Safety section. What C calls
    // (`unsafe extern "C" fn`) has SUNDIALS' contract, and blocks of its own.
    const ABOVE: usize = 4;
    let mut offences = Vec::new();
    for path in files("src", &["rs"]).into_iter().chain(files(FMU, &["rs"])) {
        let lines = lines(&path);
        let said = |at: usize, what: &str, lines: &[Line]| {
            lines[at.saturating_sub(ABOVE)..=at]
                .iter()
                .any(|l| l.text.contains(what))
        };
        for (k, line) in lines.iter().enumerate() {
            let code = line.code.replace("unsafe_code", "");
            if !code.contains("unsafe") {
                continue;
            }
            if !path.starts_with(FMU) && !UNSAFE.contains(&&*room(&path)) {
                offences.push(place(&path, line, "unsafe code outside of the rooms that call C"));
            }
            let block = code.contains("unsafe {") || code.contains("unsafe impl");
            if block && !line.test && !said(k, "SAFETY:", &lines) {
                offences.push(place(&path, line, "unsafe block without a SAFETY comment"));
            }
            if code.contains("unsafe fn") && !said(k, "# Safety", &lines) {
                offences.push(place(&path, line, "unsafe function without a Safety section"));
            }
        }
    }
    none(offences);
}

#[test]
fn modules_of_modules_are_in_their_folder() {
    let all = files("src", &["rs"]);
    let beside = |path: &&PathBuf| all.iter().any(|p| p.starts_with(path.with_extension("")));
    let offences = all.iter().filter(beside);
    none(
        offences
            .map(|path| {
                format!(
                    "{}: has modules of its own; make it {}/mod.rs",
                    path.display(),
                    path.with_extension("").display()
                )
            })
            .collect(),
    );
}

#[test]
fn nothing_is_left_undone() {
    let marks = [
        concat!("TO", "DO"),
        concat!("FIX", "ME"),
        concat!("XX", "X"),
        concat!("to", "do!"),
        concat!("unimpl", "emented!"),
        concat!("db", "g!("),
    ];
    let mut offences = Vec::new();
    for path in files("src", &["rs"])
        .into_iter()
        .chain(files("tests", &["rs"]))
        .chain([PathBuf::from("build.rs")])
    {
        for line in &lines(&path) {
            for mark in marks.iter().filter(|m| line.text.contains(**m)) {
                offences.push(place(&path, line, mark));
            }
        }
    }
    none(offences);
}

#[test]
fn only_the_command_line_prints() {
    let mut offences = Vec::new();
    for path in files("src", &["rs"]).into_iter().filter(|p| room(p) != "cli") {
        for line in lines(&path).iter().filter(|l| !l.test) {
            if ["println!", "print!(", "stdout()", "stderr()"]
                .iter()
                .any(|p| line.code.contains(p))
            {
                offences.push(place(&path, line, "prints"));
            }
        }
    }
    none(offences);
}

#[test]
fn results_are_read_as_their_types() {
    // A key that is looked for by hand may be missing without a word; types say where.
    let mut offences = Vec::new();
    for path in files("src/output", &["rs"]) {
        for line in lines(&path).iter().filter(|l| !l.test) {
            for way in [".get(\"", ".pointer("] {
                if line.code.contains(way) {
                    offences.push(place(
                        &path,
                        line,
                        format!("{way} of JSON; read it as a type of src/results"),
                    ));
                }
            }
        }
    }
    none(offences);
}

#[test]
fn expected_failures_do_not_panic() {
    let mut offences = Vec::new();
    for path in files("src", &["rs"]).into_iter().chain(files(FMU, &["rs"])) {
        for line in lines(&path).iter().filter(|l| !l.test) {
            for way in [".unwrap()", ".expect(", "panic!(", "unreachable!("] {
                if line.code.contains(way) {
                    offences.push(place(&path, line, format!("{way} outside tests")));
                }
            }
        }
    }
    none(offences);
}

#[test]
fn files_are_short() {
    let mut offences = Vec::new();
    let all: Vec<_> = files("src", &["rs"])
        .into_iter()
        .chain(files(FMU, &["rs"]))
        .chain(files("tests", &["rs"]))
        .chain(files("src/output/report/page", &["js", "css", "html"]))
        .collect();
    for path in &all {
        let length = fs::read_to_string(path).unwrap().lines().count();
        let allowed = LONG.iter().any(|(long, _)| Path::new(long) == path);
        if length > LINES && !allowed {
            offences.push(format!(
                "{}: {length} lines; divide it, or give a reason in {}",
                path.display(),
                file!()
            ));
        }
        // Some lines of grace: a file that hovers about the limit should not change the list with every edit.
        if length + 50 < LINES && allowed {
            offences.push(format!(
                "{}: {length} lines only; take it off the list in {}",
                path.display(),
                file!()
            ));
        }
    }
    for (long, _) in LONG
        .iter()
        .filter(|(long, _)| !all.iter().any(|p| p == Path::new(long)))
    {
        offences.push(format!("{long}: on the list, but not there"));
    }
    none(offences);
}

#[test]
fn public_items_are_documented_and_unsafe_is_denied() {
    // The compiler checks every item; here only that it is asked to, everywhere but in generated code.
    let manifest = fs::read_to_string("Cargo.toml").unwrap();
    assert!(manifest.contains("missing_docs = \"warn\"") && manifest.contains("unsafe_code = \"deny\""));
    for path in files("src", &["rs"]) {
        let silenced = lines(&path)
            .iter()
            .any(|l| l.code.trim_start().starts_with("missing_docs"))
            || lines(&path).iter().any(|l| l.code.contains("allow(missing_docs"));
        assert!(
            !silenced
                || UNSAFE
                    .iter()
                    .any(|room| path == Path::new("src").join(room).join("mod.rs")),
            "{} silences missing_docs",
            path.display()
        );
    }
}

/// Definitions of equation tags: doc lines that begin with `` `[E7]` ``.
fn definitions() -> Vec<(String, String)> {
    let mut found = Vec::new();
    for path in files("src", &["rs"]) {
        for line in &lines(&path) {
            let text = line.text.trim_start().trim_start_matches(['/', '!']).trim_start();
            if let Some(tag) = text.strip_prefix("`[E").and_then(|rest| rest.split_once("]`")) {
                found.push((format!("E{}", tag.0), place(&path, line, "")));
            }
        }
    }
    found
}

#[test]
fn every_equation_is_defined_once_and_stands_in_the_model() {
    let defined = definitions();
    let model = fs::read_to_string("docs/model.md").unwrap();
    let mut offences = Vec::new();
    let last = defined
        .iter()
        .filter_map(|(tag, _)| tag[1..].parse::<usize>().ok())
        .max();
    for k in 1..=last.unwrap_or(0) {
        let tag = format!("E{k}");
        let places: Vec<&str> = defined
            .iter()
            .filter(|(t, _)| *t == tag)
            .map(|(_, at)| at.as_str())
            .collect();
        if places.len() != 1 {
            offences.push(format!(
                "[{tag}] is defined {} times: {}",
                places.len(),
                places.join(" ")
            ));
        }
        if !model.contains(&format!("[{tag}]")) {
            offences.push(format!("[{tag}] is missing in docs/model.md"));
        }
    }
    // Mentions elsewhere name equations that exist.
    let known = |tag: &str| defined.iter().any(|(t, _)| t == tag);
    let texts = files("src", &["rs"])
        .into_iter()
        .chain(files("tests", &["rs"]))
        .chain(files("docs", &["md"]));
    for path in texts.chain([PathBuf::from("README.md")]) {
        for line in &lines(&path) {
            for (at, _) in line.text.match_indices("[E") {
                let tag: String = line.text[at + 1..].chars().take_while(|c| *c != ']').collect();
                // Numbers of three digits are those of messages.
                let number = (2..=3).contains(&tag.len()) && tag[1..].chars().all(|c| c.is_ascii_digit());
                if number && !known(&tag) {
                    offences.push(place(&path, line, format!("[{tag}] is no equation")));
                }
            }
        }
    }
    none(offences);
}

#[test]
fn packages_come_from_the_public_registry_and_nothing_else_names_one() {
    let lock = fs::read_to_string("Cargo.lock").unwrap();
    let public = "source = \"registry+https://github.com/rust-lang/crates.io-index\"";
    for line in lock.lines().filter(|l| l.starts_with("source = ")) {
        assert_eq!(line, public, "Cargo.lock");
    }
    let hosts = [
        concat!("index.", "crates.io"),
        concat!("static.", "crates.io"),
        concat!("artifact", "ory"),
        concat!("sparse+", "http"),
    ];
    let mut offences = Vec::new();
    for path in files(".", &[]) {
        // Binary files have no words.
        let Ok(text) = fs::read_to_string(&path) else { continue };
        for host in hosts.iter().filter(|h| text.contains(**h)) {
            offences.push(format!("{}: names {host}", path.display()));
        }
    }
    none(offences);
}
