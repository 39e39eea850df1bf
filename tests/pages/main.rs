//! The pages: every command on them runs, every link leads somewhere.
//!
//! Commands run in the order of their page, in an empty folder with the cases. Long ones are shortened: sweeps have three points.

#[path = "../common/files.rs"]
mod files;
mod writing;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use slcbeam::discrete::quantities::{BeamField, Interest, Observable};

fn pages() -> Vec<PathBuf> {
    let mut all = files::files("docs", &["md"]);
    all.extend(["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "cases/README.md"].map(PathBuf::from));
    all.sort();
    all
}

/// Commands of a page: lines of shell blocks, lines behind `$ ` in transcripts, and backquoted commands with a shipped case.
fn commands(page: &str) -> Vec<String> {
    let mut found = vec![];
    let mut block: Option<&str> = None;
    let (mut rest, mut prose) = (String::new(), String::new());
    let collect = |prose: &mut String, found: &mut Vec<String>| {
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
            collect(&mut prose, &mut found);
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
    collect(&mut prose, &mut found);
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
        "scripts/",
        "sudo apt-get",
        "tar ",
        "podman",
        "cargo",
        "export",
        "git",
        "pip",
        "python",
        "cd ",
        "#",
    ]
    .iter()
    .any(|w| begins(w))
    {
        return None;
    }
    let mut line = line.clone();
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
    if line.contains("--about-cycle") {
        line = with(&with(&line, "--points", "2"), "--to", "30.5");
        line += " --set /mesh/cells_per_segment=1 --set /mesh/cells_per_bladder=1";
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
    // FMUs are written here, and not simulated: a file that the program takes for their library
    let library = folder.path().join(slcbeam::output::fmu::LIBRARY);
    fs::write(&library, slcbeam::output::fmu::MARK).unwrap();
    let others = std::env::var("PATH").unwrap_or_default();
    let path = format!("{}:{others}", program.parent().unwrap().display());
    let script = format!("set -euo pipefail\n{}\n", lines.join("\n"));
    let output = Command::new("bash")
        .args(["-xc", &script])
        .current_dir(folder.path())
        .env("PATH", path)
        .env("ROOT", &root)
        .env("SLCBEAM_FMU_LIBRARY", &library)
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
                    // a page at a time each: the lock is not held while one runs
                    let failed = run(page);
                    failures.lock().unwrap().extend(failed);
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
        "sweep",
        "merge",
        "fit",
        "sense",
        "optimize",
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

/// Goal: what histories, arrays and summaries hold is told by name, and columns by unit.
#[test]
fn every_quantity_is_told() {
    let page = fs::read_to_string("docs/data.md").unwrap();
    let columns = Observable::ALL
        .iter()
        .map(|one| format!("`{} [{}]`", one.name(), one.unit()));
    let names = BeamField::ALL.into_iter().map(BeamField::name);
    let names = names.chain(Interest::ALL.iter().map(|one| one.name()));
    let all = columns.chain(names.map(|name| format!("`{name}`")));
    let missing: Vec<String> = all.filter(|told| !page.contains(told)).collect();
    assert!(missing.is_empty(), "not in docs/data.md: {}", missing.join(", "));
}

/// Everything that may cite a page.
fn texts() -> Vec<PathBuf> {
    let mut all = vec![];
    let mut todo = ["src", "tests", "docs", "cases", "scripts", "benches/peers/src"]
        .map(PathBuf::from)
        .to_vec();
    while let Some(dir) = todo.pop() {
        for path in fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                todo.push(path);
            } else {
                all.push(path);
            }
        }
    }
    all.extend(pages().into_iter().filter(|page| page.parent() == Some(Path::new(""))));
    all.sort();
    all
}

/// A text without what marks its comments, in one line.
fn unbroken(text: &str) -> String {
    let words = |line: &str| line.trim_start().trim_start_matches(['/', '!', '#']).trim().to_owned();
    text.lines().map(words).collect::<Vec<_>>().join(" ")
}

/// Numbers of sections at the beginning of a text: `4, 5 and 7`.
fn numbers(mut text: &str) -> Vec<String> {
    let mut all = vec![];
    loop {
        let number: String = text.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
        let after = &text[number.len()..];
        // a section of 0.1 m is no section
        if !number.starts_with(|c: char| ('1'..='9').contains(&c)) || after.starts_with(|c: char| c.is_alphanumeric()) {
            return all;
        }
        all.push(number.trim_end_matches('.').to_owned());
        match [", ", " and "].iter().find_map(|between| after.strip_prefix(between)) {
            Some(rest) => text = rest,
            None => return all,
        }
    }
}

/// Pages that a text names, each with the sections named behind it: `docs/model.md` section 4. What stands behind `section` alone is
/// of no page.
fn citations(text: &str) -> Vec<(Option<String>, Vec<String>)> {
    let mut all = vec![];
    for (at, _) in text.match_indices(".md") {
        let rest = &text[at + 3..];
        let begin = text[..at]
            .rfind(|c: char| !(c.is_alphanumeric() || "_-/.".contains(c)))
            .map_or(0, |k| k + 1);
        if begin == at || rest.starts_with(|c: char| c.is_alphanumeric()) {
            continue;
        }
        let behind = rest.trim_start_matches(['`', ')', ',', ' ']);
        let section = behind.strip_prefix("sections ").or(behind.strip_prefix("section "));
        all.push((
            Some(text[begin..at + 3].trim_start_matches('/').to_owned()),
            numbers(section.unwrap_or(behind)),
        ));
    }
    for (at, word) in text.match_indices("ection ") {
        let before = text[..at].trim_end_matches(['s', 'S', '`', ')', ',', ' ', '[']);
        if !before.ends_with(".md") && !before.ends_with("paper (") {
            all.push((None, numbers(&text[at + word.len()..])));
        }
    }
    all
}

/// Pages that source, tests and pages name are there, with the sections named.
#[test]
fn cited_pages_and_sections_exist() {
    let mut missing = vec![];
    let mut found = 0;
    for path in texts() {
        let Ok(text) = fs::read_to_string(&path) else { continue };
        for (page, sections) in citations(&unbroken(&text)) {
            let own = path.extension().is_some_and(|e| e == "md").then(|| path.clone());
            let at = match &page {
                Some(page) => [Path::new(""), Path::new("docs"), path.parent().unwrap()]
                    .map(|folder| folder.join(page))
                    .into_iter()
                    .find(|there| there.is_file()),
                None => own,
            };
            let text = at.as_ref().map(|at| fs::read_to_string(at).unwrap());
            let there = |section: &String| {
                text.iter()
                    .flat_map(|t| t.lines())
                    .any(|l| l.trim_start_matches('#').starts_with(&format!(" {section}. ")) && l.starts_with('#'))
            };
            let name = page.unwrap_or_else(|| "this page".into());
            if at.is_none() && name != "this page" {
                missing.push(format!("{}: {name}", path.display()));
            }
            for section in &sections {
                found += 1;
                if !there(section) {
                    missing.push(format!("{}: {name} section {section}", path.display()));
                }
            }
        }
    }
    assert!(found > 20, "{found} sections");
    assert!(missing.is_empty(), "{missing:#?}");
}
