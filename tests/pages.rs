//! The pages: every command on them runs, every link leads somewhere.
//!
//! Source: README.md, docs, cases/README.md. Goal: what a reader types works. Commands run in the order of their page, in an empty
//! folder with the cases beside it; those that measure for minutes get seconds, maps four points, sweeps three.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn pages() -> Vec<PathBuf> {
    let markdown = |folder: &str| {
        fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|e| e == "md"))
            .collect::<Vec<_>>()
    };
    let mut all = vec![PathBuf::from("README.md"), PathBuf::from("cases/README.md")];
    for folder in ["docs", "docs/figures"] {
        all.extend(markdown(folder));
    }
    all.sort();
    all
}

/// Lines of a page that a reader types: those of shell blocks, those behind `$ ` in transcripts, and what stands in backquotes and
/// names a case that is there.
fn commands(page: &str) -> Vec<String> {
    let mut found = vec![];
    let mut block: Option<&str> = None;
    let (mut rest, mut prose) = (String::new(), String::new());
    let told = |prose: &mut String, found: &mut Vec<String>| {
        let text = std::mem::take(prose);
        let marked = text.split('`').skip(1).step_by(2);
        found.extend(
            marked
                .filter(|t| t.starts_with("slcbeam") && t.contains("cases/"))
                .map(str::to_owned),
        );
    };
    for line in page.lines() {
        let line = line.trim_end();
        if let Some(kind) = line.trim_start().strip_prefix("```") {
            told(&mut prose, &mut found);
            block = if block.is_some() { None } else { Some(kind) };
            continue;
        }
        let typed = match block {
            Some("sh") => Some(line.trim_start_matches("$ ")),
            Some(_) => line.strip_prefix("$ "),
            None => {
                prose += line;
                prose.push(' ');
                None
            }
        };
        let Some(typed) = typed else { continue };
        match typed.strip_suffix('\\') {
            Some(begun) => rest += begun,
            None => found.push(std::mem::take(&mut rest) + typed),
        }
    }
    told(&mut prose, &mut found);
    found.retain(|line| !line.trim().is_empty() && !placeholder(line));
    found
}

/// Whether a command stands for others: `slcbeam run CASE`.
fn placeholder(line: &str) -> bool {
    let capital = |word: &str| word.chars().all(|c| c.is_ascii_uppercase()) && !word.is_empty();
    line.contains("...") || line.split([' ', '=', '/']).any(capital)
}

/// The command as the test runs it; nothing for what installs, builds or tests.
fn shortened(line: &str) -> Option<String> {
    let line = line.split(" #").next().unwrap_or(line).trim_end();
    let line = line
        .replace("target/release/slcbeam", "slcbeam")
        .replace("scripts/run ", "slcbeam run ");
    let begins = |word: &str| line.trim_start().starts_with(word);
    if [
        "scripts/test",
        "scripts/bench",
        "scripts/figures",
        "scripts/install",
        "cargo",
        "export",
        "git",
        "cd ",
        "#",
    ]
    .iter()
    .any(|w| begins(w))
    {
        return None;
    }
    let mut line = line.replace("scripts/", "\"$ROOT\"/scripts/");
    if begins("slcbeam study") {
        // two seconds may be too few for a reference: 4
        line = with(&line, "--budget", "2s") + " || [ $? -eq 4 ]";
    }
    if begins("slcbeam effects") {
        line = with(&with(&line, "--budget", "8s"), "--repeats", "0");
    }
    if line.contains("--map") {
        line = with(&with(&line, "--points", "2,2"), "--permeability", "1");
    }
    // 0.01:1:25:log
    if let Some((_, range)) = line.split_once("--sweep ")
        && let Some(count) = range.split(' ').next().and_then(|r| r.split(':').nth(2))
    {
        line = line.replacen(&format!(":{count}"), ":3", 1);
    }
    Some(line)
}

/// The command with this value of an option.
fn with(line: &str, option: &str, value: &str) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    let at = words.iter().position(|w| *w == option);
    let kept = words
        .iter()
        .enumerate()
        .filter(|(i, _)| at.is_none_or(|at| *i != at && *i != at + 1));
    let kept: Vec<&str> = kept.map(|(_, w)| *w).collect();
    format!("{} {option} {value}", kept.join(" "))
}

/// Runs the commands of a page; what went wrong.
fn run(page: &Path) -> Option<String> {
    let lines: Vec<String> = commands(&fs::read_to_string(page).unwrap())
        .iter()
        .filter_map(|l| shortened(l))
        .collect();
    if lines.is_empty() {
        return None;
    }
    let root = std::env::current_dir().unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(root.join("cases"), folder.path().join("cases")).unwrap();
    let program = PathBuf::from(assert_cmd::cargo::cargo_bin!("slcbeam"));
    let others = std::env::var("PATH").unwrap_or_default();
    let path = format!("{}:{others}", program.parent().unwrap().display());
    let script = format!("set -euo pipefail\n{}\n", lines.join("\n"));
    let output = Command::new("bash")
        .args(["-xc", &script])
        .current_dir(folder.path())
        .env("PATH", path)
        .env("ROOT", &root)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let last: Vec<&str> = said.lines().rev().take(12).collect();
    (!output.status.success()).then(|| {
        format!(
            "{}: {}\n{}",
            page.display(),
            output.status,
            last.into_iter().rev().collect::<Vec<_>>().join("\n")
        )
    })
}

#[test]
fn every_command_runs() {
    let pages = pages();
    let next = std::sync::atomic::AtomicUsize::new(0);
    let failures = std::sync::Mutex::new(vec![]);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(page) = pages.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
                    failures.lock().unwrap().extend(run(page));
                }
            });
        }
    });
    let failures = failures.into_inner().unwrap();
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
}

/// Commands are found at all: a page that is written otherwise would be passed over in silence.
#[test]
fn commands_are_found() {
    let all: BTreeSet<String> = pages()
        .iter()
        .flat_map(|p| commands(&fs::read_to_string(p).unwrap()))
        .collect();
    for command in [
        "run",
        "check",
        "equilibrium",
        "modes",
        "study",
        "effects",
        "compare",
        "periodic",
        "new",
        "report",
        "export",
    ] {
        assert!(
            all.iter().any(|line| line.contains(&format!("slcbeam {command}"))),
            "no {command} on any page"
        );
    }
    assert!(all.len() > 50, "{all:#?}");
}

/// Tests that a page names are there: `cargo test --release --test target`.
#[test]
fn named_tests_exist() {
    for page in pages() {
        let text = fs::read_to_string(&page).unwrap();
        for name in text
            .split("--test ")
            .skip(1)
            .filter_map(|rest| rest.split([' ', '`', '\n', ')']).next())
        {
            let exists = [format!("tests/{name}.rs"), format!("tests/{name}/main.rs")]
                .iter()
                .any(|p| Path::new(p).exists());
            assert!(exists, "{}: no test {name}", page.display());
        }
    }
}

#[test]
fn every_link_leads_somewhere() {
    let mut broken = vec![];
    for page in pages() {
        let text = fs::read_to_string(&page).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() {
                page.clone()
            } else {
                page.parent().unwrap().join(file)
            };
            let heading = |text: &str| {
                text.lines()
                    .any(|l| l.starts_with('#') && slug(l.trim_start_matches(['#', ' '])) == anchor)
            };
            let there = !file.contains("://") && target.exists();
            if !file.contains("://")
                && (!there || (!anchor.is_empty() && !fs::read_to_string(&target).is_ok_and(|t| heading(&t))))
            {
                broken.push(format!("{}: {link}", page.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

/// The name by which a heading is linked to.
fn slug(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}
