//! Case texts with deleted, doubled and exchanged tokens, and random bytes: always an answer, never a panic.

use std::path::Path;

use slcbeam::case;
use slcbeam::error::Error;

use crate::chance::Random;

/// Characters of JSON-like text.
const ALPHABET: &[u8] = b"{}[]:,\"\\0123456789.eE+-truefalsn \n";

/// Unusual tokens to insert.
const ODD: [&str; 16] = [
    "null",
    "true",
    "-1",
    "0",
    "1e308",
    "-1e-308",
    "1e999",
    "NaN",
    "{}",
    "[]",
    "\"\"",
    "\"free\"",
    "{\"sine\": 3}",
    ",",
    ":",
    "}",
];

/// Splits JSON text into tokens: brackets, colons, commas, texts, words, spaces.
fn tokens(text: &str) -> Vec<&str> {
    let bytes = text.as_bytes();
    let (mut all, mut at) = (vec![], 0);
    while at < bytes.len() {
        let from = at;
        at += 1;
        match bytes[from] {
            b'"' => {
                while at < bytes.len() && bytes[at] != b'"' {
                    at += if bytes[at] == b'\\' { 2 } else { 1 };
                }
                at = (at + 1).min(bytes.len());
            }
            b'{' | b'}' | b'[' | b']' | b':' | b',' => {}
            first => {
                let space = first.is_ascii_whitespace();
                while at < bytes.len() && !b"{}[]:,\"".contains(&bytes[at]) && bytes[at].is_ascii_whitespace() == space
                {
                    at += 1;
                }
            }
        }
        all.push(&text[from..at]);
    }
    all
}

fn shipped() -> Vec<String> {
    let mut files: Vec<_> = ["cases", "cases/hard"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).expect("the folder of cases"))
        .map(|entry| entry.expect("an entry").path())
        .filter(|p| p.extension().is_some_and(|e| e == "json") && p.file_stem().is_some_and(|s| s != "schema"))
        .collect();
    files.sort();
    files
        .iter()
        .map(|p| std::fs::read_to_string(p).expect("a case"))
        .collect()
}

/// True if the text is a valid case; faults must have a message and a place.
fn read(text: &str) -> bool {
    match case::parse(text, Path::new("x.json"), Path::new("cases"), &[]) {
        Ok(_) => true,
        Err(Error::Case(fault)) => {
            assert!(!fault.violations.is_empty(), "refused without a reason: {text}");
            assert!(
                fault.violations.iter().all(|v| v.span.is_some()),
                "a fault without a place: {text}"
            );
            assert!(!case::render(&fault, false, 80).is_empty());
            false
        }
        Err(_) => false,
    }
}

/// Goal: one to four tokens of every shipped case are deleted, doubled, swapped or replaced, 2000 times.
#[test]
fn mutated_cases_are_read_or_refused() {
    let texts = shipped();
    let mut r = Random(7);
    let (mut sound, count) = (0, 2000);
    for _ in 0..count {
        let text = &texts[r.below(texts.len())];
        let mut parts: Vec<String> = tokens(text).into_iter().map(str::to_owned).collect();
        assert_eq!(parts.concat(), *text);
        for _ in 0..=r.below(4) {
            let at = r.below(parts.len());
            match r.below(5) {
                0 => {
                    parts.remove(at);
                }
                1 => parts.insert(at, parts[at].clone()),
                2 => parts[at] = ODD[r.below(ODD.len())].to_owned(),
                3 => {
                    let other = r.below(parts.len());
                    parts.swap(at, other);
                }
                _ => parts[at] = format!("{}e{}", r.between(-9.0, 9.0), r.below(40) as i32 - 20),
            }
        }
        sound += usize::from(read(&parts.concat()));
    }
    println!("mutated cases: {count}, still valid {sound}, refused {}", count - sound);
}

/// Goal: random bytes that form valid text, and random printable text.
#[test]
fn random_bytes_are_refused() {
    let mut r = Random(11);
    for length in 0..2000 {
        let bytes: Vec<u8> = (0..length % 300).map(|_| (r.bits() >> 40) as u8).collect();
        let text = if length % 2 == 0 {
            String::from_utf8_lossy(&bytes).into_owned()
        } else {
            bytes
                .iter()
                .map(|b| char::from(ALPHABET[usize::from(*b) % ALPHABET.len()]))
                .collect()
        };
        assert!(!read(&text), "random text became a case: {text}");
    }
}
