//! `slcbeam explain`: meaning of a message, a key, an effect, a column or a symbol.
//!
//! ```text
//! pages  descriptions of words, symbols and columns in the documentation
//! ```

mod pages;

use std::fmt::Write as _;
use std::process::ExitCode;

use clap::Args;
use serde_json::json;

use crate::case::{KeyDescription, meanings, nearest, synonyms};
use crate::error::{Code, Error, Result};

/// Largest number of keys listed for a word.
const MOST: usize = 12;

/// `explain`.
#[derive(Debug, Args)]
pub struct ExplainArguments {
    /// Number of a message, or name of a key, an effect, a column of a result, a word or symbol of the glossary [default: list all numbers]
    pub what: Vec<String>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

/// Prints the section of a message or the meaning of a name; without a name, all message numbers with their headings.
pub fn explain(asked: &ExplainArguments) -> Result<ExitCode> {
    let what = asked.what.join(" ");
    if what.is_empty() {
        let all = Code::ALL.iter();
        let value = || {
            all.clone()
                .map(|c| json!({"code": c.id(), "title": c.title()}))
                .collect()
        };
        let text = || {
            all.clone()
                .fold(String::new(), |text, c| text + c.id() + "  " + c.title() + "\n")
        };
        return super::answer(asked.json, value, text);
    }
    let what = what.as_str();
    if let Some(code) = Code::find(what) {
        let value = || json!({"code": code.id(), "title": code.title(), "text": code.text()});
        let text = || format!("{} {}\n\n{}\n", code.id(), code.title(), code.text().replace("**", ""));
        return super::answer(asked.json, value, text);
    }
    // a heading in the form of a table, a pointer in the form of a case
    let name = what.split(" [").next().unwrap_or(what);
    let name = name.rsplit('/').next().unwrap_or(name);
    let all = meanings();
    let named = |name: &str| all.iter().filter(|m| m.name == name).collect::<Vec<_>>();
    let mut found = named(name);
    if found.is_empty() {
        // a turbine is listed under turbines
        found = named(&format!("{name}s"));
    }
    if found.is_empty() {
        // so is the type Turbine of the schema
        let snake = snake(name);
        found = named(&snake);
        found.extend(named(&format!("{snake}s")));
    }
    let entries = pages::find(name);
    let elsewhere = synonyms::elsewhere(name);
    let mut text = String::new();
    if found.is_empty() && entries.is_empty() {
        let (how, others) = likely(&all, name);
        if others.is_empty() && elsewhere.is_empty() {
            return Err(unknown(&all, what, name));
        }
        if !others.is_empty() {
            let _ = writeln!(text, "{name} is not a key; {how}");
        }
        found = others;
    }
    for place in &elsewhere {
        let _ = writeln!(text, "{name}: {place}");
    }
    for one in &entries {
        let _ = writeln!(text, "{} ({}): {}", one.name, one.kind, one.meaning);
    }
    // a word may be a key and also mean others: flow is an effect, and a port has flow_m3_s
    let known = found.len();
    let also = synonyms::keys_meant_by(name).into_iter().flat_map(named).take(MOST);
    let also: Vec<&KeyDescription> = also.filter(|m| !found.contains(m)).collect();
    found.extend(also);
    for (k, m) in found.iter().enumerate() {
        if k == known && k > 0 {
            let _ = writeln!(text, "also related:");
        }
        let _ = writeln!(text, "{}: {}", m.place, m.meaning);
        for inner in inside(&all, m) {
            let _ = writeln!(text, "  {}: {}", inner.place, inner.meaning);
        }
    }
    let row = |m: &KeyDescription| json!({"key": m.place, "meaning": m.meaning});
    let keys = found.iter().map(|m| {
        let mut entry = row(m);
        entry["keys"] = inside(&all, m).map(row).collect();
        entry
    });
    let others = entries.iter().map(|one| {
        let mut row = json!({"meaning": one.meaning});
        row[one.kind] = one.name.as_str().into();
        row
    });
    let places = elsewhere.iter().map(|place| json!({"word": name, "meaning": place}));
    super::answer(asked.json, || keys.chain(others).chain(places).collect(), || text)
}

/// Converts the name of a type to that of a key: check_valve for CheckValve; empty if it is not the name of a type.
fn snake(name: &str) -> String {
    if !name.starts_with(char::is_uppercase) || !name.chars().all(char::is_alphanumeric) || name.len() < 3 {
        return String::new();
    }
    name.char_indices().fold(String::new(), |mut all, (k, c)| {
        if k > 0 && c.is_uppercase() {
            all.push('_');
        }
        all.extend(c.to_lowercase());
        all
    })
}

/// Keys that a word may mean, and the reason: synonyms, keys with the word in their name, or keys with the word in their description.
fn likely<'m>(all: &'m [KeyDescription], word: &str) -> (&'static str, Vec<&'m KeyDescription>) {
    let keys = synonyms::keys_meant_by(word);
    let meant = keys.iter().flat_map(|key| all.iter().filter(move |m| m.name == *key));
    let meant: Vec<&KeyDescription> = meant.take(MOST).collect();
    if !meant.is_empty() {
        return ("related:", meant);
    }
    let word = word.to_lowercase();
    let part = |m: &&KeyDescription| word.len() > 2 && m.name.split('_').any(|part| part == word);
    let parts: Vec<&KeyDescription> = all.iter().filter(part).take(MOST).collect();
    if !parts.is_empty() {
        return ("keys with this word in their names:", parts);
    }
    let has_word = |m: &&KeyDescription| {
        let text = m.meaning.to_lowercase();
        let mut words = text.split(|c: char| !c.is_alphanumeric());
        word.len() > 3 && words.any(|one| one == word)
    };
    (
        "keys with this word in their descriptions:",
        all.iter().filter(has_word).take(MOST).collect(),
    )
}

fn unknown(all: &[KeyDescription], what: &str, name: &str) -> Error {
    let known = all
        .iter()
        .map(|m| m.name.as_str())
        .chain(pages::names())
        .chain(Code::ALL.iter().map(|c| c.id()));
    let meant = nearest(name, known).map_or_else(String::new, |n| format!("; did you mean {n}?"));
    Error::Usage(format!(
        "explain {what}: neither the number of a message (slcbeam explain lists them), nor a key of a case, nor a column or figure of a \
         result, nor a word or symbol of docs/glossary.md{meant}"
    ))
}

/// Keys and words of the value at a key, one level down.
fn inside<'m>(all: &'m [KeyDescription], of: &'m KeyDescription) -> impl Iterator<Item = &'m KeyDescription> {
    all.iter().filter(|m| {
        of.objects.iter().any(|object| {
            m.place.strip_prefix(object.as_str()).is_some_and(|rest| {
                rest.starts_with(" \"") || rest.strip_prefix('/').is_some_and(|key| !key.contains('/'))
            })
        })
    })
}
