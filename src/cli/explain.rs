//! `slcbeam explain`: what a message, a key or an effect means.

use std::fmt::Write as _;
use std::process::ExitCode;

use clap::Args;
use serde_json::{Value, json};

use crate::case::{Meaning, meanings, nearest};
use crate::error::{Code, Error, Result};

/// `explain`.
#[derive(Debug, Args)]
pub struct ExplainArguments {
    /// Number of a message, or name of a key or effect [default: list all numbers]
    pub what: Option<String>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

/// Prints the section of a message or the meaning of a key; without a name, all numbers with their headings.
pub fn explain(asked: &ExplainArguments) -> Result<ExitCode> {
    let Some(what) = &asked.what else {
        let all = Code::ALL.iter();
        return answer(
            asked,
            all.clone()
                .map(|c| json!({"code": c.id(), "title": c.title()}))
                .collect(),
            all.fold(String::new(), |text, c| text + c.id() + "  " + c.title() + "\n"),
        );
    };
    if let Some(code) = Code::find(what) {
        return answer(
            asked,
            json!({"code": code.id(), "title": code.title(), "text": code.text()}),
            format!("{} {}\n\n{}\n", code.id(), code.title(), code.text().replace("**", "")),
        );
    }
    let name = what.rsplit('/').next().unwrap_or(what);
    let all = meanings();
    let named = |name: &str| all.iter().filter(|m| m.name == name).collect::<Vec<_>>();
    let mut found = named(name);
    if found.is_empty() {
        // a turbine stands under turbines
        found = named(&format!("{name}s"));
    }
    if found.is_empty() {
        let known = all
            .iter()
            .map(|m| m.name.as_str())
            .chain(Code::ALL.iter().map(|c| c.id()));
        let meant = nearest(name, known).map_or_else(String::new, |n| format!("; did you mean {n}?"));
        return Err(Error::Usage(format!(
            "explain {what}: neither the number of a message (slcbeam explain lists them) nor a key of a case{meant}"
        )));
    }
    let mut text = String::new();
    for m in &found {
        let _ = writeln!(text, "{}: {}", m.place, m.meaning);
        for inner in inside(&all, m) {
            let _ = writeln!(text, "  {}: {}", inner.place, inner.meaning);
        }
    }
    let row = |m: &Meaning| json!({"key": m.place, "meaning": m.meaning});
    let rows = found.iter().map(|m| {
        let mut told = row(m);
        told["keys"] = inside(&all, m).map(row).collect();
        told
    });
    answer(asked, rows.collect(), text)
}

/// Keys and words of what stands at a key, one level down.
fn inside<'m>(all: &'m [Meaning], of: &'m Meaning) -> impl Iterator<Item = &'m Meaning> {
    all.iter().filter(|m| {
        of.objects.iter().any(|object| {
            m.place.strip_prefix(object.as_str()).is_some_and(|rest| {
                rest.starts_with(" \"") || rest.strip_prefix('/').is_some_and(|key| !key.contains('/'))
            })
        })
    })
}

fn answer(asked: &ExplainArguments, json: Value, text: String) -> Result<ExitCode> {
    super::print(&if asked.json { format!("{json:#}\n") } else { text })?;
    Ok(ExitCode::SUCCESS)
}
