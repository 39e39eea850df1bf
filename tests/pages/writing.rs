//! Plain English: pages, comments and messages avoid habits that make readers stumble.

use std::collections::BTreeMap;
use std::fs;

use crate::files::files;
use crate::pages;

/// Longest line of prose on a page [characters], and longest sentence [words].
const LONGEST_LINE: usize = 100;
const LONGEST_SENTENCE: usize = 35;
/// Words that stand for a plainer verb: reports, prints, computes, contains.
const HABITS: [&str; 4] = ["tell", "tells", "told", "says"];
/// Beginnings of a comment that does not name its subject.
const BEGINNINGS: [&str; 4] = ["What ", "Whether ", "How ", "Where "];
/// Lines of the source that contain a habit for a reason: file and part of the line.
const EXCEPTIONS: &[(&str, &str)] = &[
    // a key of `sense.json`
    ("study/sense/sensed.rs", "rename = \"told\""),
];

/// Lines of prose of a page with their numbers; an empty line in place of code and tables.
fn prose(page: &str) -> Vec<(usize, &str)> {
    let mut block = false;
    let line = |(k, line): (usize, &'_ str)| {
        let fence = line.trim_start().starts_with("```");
        block ^= fence;
        let text = !(fence || block || line.trim_start().starts_with('|'));
        (k + 1, text)
    };
    let kinds: Vec<(usize, bool)> = page.lines().enumerate().map(line).collect();
    let lines = kinds.into_iter().zip(page.lines());
    lines
        .map(|((k, text), line)| (k, if text { line } else { "" }))
        .collect()
}

/// Sentences of a page; code counts as one word, the address of a link as none.
fn sentences(page: &str) -> Vec<String> {
    let mut paragraphs = vec![String::new()];
    for (_, line) in prose(page) {
        let text = line.trim_start();
        let item = ["- ", "* ", "> ", "#"].iter().any(|mark| text.starts_with(mark))
            || text
                .split_once(". ")
                .is_some_and(|(number, _)| number.parse::<u32>().is_ok());
        if text.is_empty() || item {
            paragraphs.push(String::new());
        }
        if let Some(paragraph) = paragraphs.last_mut() {
            *paragraph += " ";
            *paragraph += text;
        }
    }
    let without_code = |text: &String| {
        let parts = text.split('`').enumerate();
        parts
            .map(|(k, part)| if k % 2 == 0 { part } else { "x" })
            .collect::<String>()
    };
    let ends = ['.', '!', '?', ':', ';'];
    let mut all = vec![];
    for paragraph in paragraphs.iter().map(without_code) {
        let mut sentence: Vec<&str> = vec![];
        for word in paragraph.split_whitespace() {
            sentence.push(word);
            if word.ends_with(ends) {
                all.push(std::mem::take(&mut sentence).join(" "));
            }
        }
        all.push(sentence.join(" "));
    }
    all
}

fn describe(sentence: &str) -> usize {
    let word = |text: &&str| text.chars().any(|c| c.is_ascii_alphabetic());
    sentence.split_whitespace().filter(word).count()
}

fn habit(text: &str) -> Option<&str> {
    let mut words = text.split(|c: char| !(c.is_ascii_alphabetic() || c == '_'));
    words.find(|word| HABITS.contains(word))
}

/// Goal: pages have short lines and sentences, and plain verbs.
#[test]
fn pages_are_plain() {
    let mut found = vec![];
    for path in pages() {
        let (name, page) = (path.display(), fs::read_to_string(&path).unwrap());
        for (k, line) in prose(&page) {
            let length = line.chars().count();
            if length > LONGEST_LINE {
                found.push(format!("{name}:{k}: {length} characters"));
            }
            if let Some(word) = habit(line) {
                found.push(format!("{name}:{k}: {word}"));
            }
        }
        let long = sentences(&page).into_iter().filter(|s| describe(s) > LONGEST_SENTENCE);
        found.extend(long.map(|s| format!("{name}: {} words: {s}", describe(&s))));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Goal: comments name their subject; comments and messages have plain verbs.
#[test]
fn the_source_is_plain() {
    let mut found = vec![];
    for path in ["src", "crates"].iter().flat_map(|folder| files(folder, &["rs"])) {
        let name = path.display().to_string();
        for (k, line) in fs::read_to_string(&path).unwrap().lines().enumerate() {
            let comment = ["/// ", "//! ", "// "]
                .iter()
                .find_map(|mark| line.trim_start().strip_prefix(mark));
            let begins = comment.and_then(|text| BEGINNINGS.iter().find(|b| text.starts_with(**b)));
            let excepted = EXCEPTIONS
                .iter()
                .any(|(file, part)| name.ends_with(file) && line.contains(part));
            if let Some(word) = begins.copied().or(habit(line)).filter(|_| !excepted) {
                found.push(format!("{name}:{}: {word}", k + 1));
            }
        }
    }
    assert!(found.is_empty(), "{} lines\n{}", found.len(), found.join("\n"));
}

/// Goal: a reader who searches for a public type finds one; constructors and descriptions have names that can be searched for.
#[test]
fn names_are_unique() {
    let mut types: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut found = vec![];
    for path in files("src", &["rs"]) {
        let at = path.display().to_string();
        for line in fs::read_to_string(&path).unwrap().lines() {
            let words: Vec<&str> = line.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
            let name = |keyword| {
                let k = words.iter().position(|word| *word == keyword)?;
                words.get(k + 1).map(|name| (*name).to_owned())
            };
            let public = words.iter().find(|word| !word.is_empty()) == Some(&"pub");
            let kinds = ["struct", "enum", "trait"];
            if let Some(name) = kinds
                .into_iter()
                .find_map(name)
                .filter(|_| public && !line.contains("//"))
            {
                types.entry(name).or_default().push(at.clone());
            }
            if let Some(name) = name("fn").filter(|name| ["of", "words"].contains(&name.as_str())) {
                found.push(format!("{at}: fn {name}"));
            }
        }
    }
    let twice = types.iter().filter(|(_, at)| at.len() > 1);
    found.extend(twice.map(|(name, at)| format!("{name}: {}", at.join(", "))));
    assert!(found.is_empty(), "{} names\n{}", found.len(), found.join("\n"));
}
