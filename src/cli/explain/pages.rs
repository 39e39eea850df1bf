//! Descriptions of words, symbols and result columns in the documentation: rows of its tables.

use crate::discrete::quantities::{BeamField, Interest, Observable};
use crate::output::report::facts;

/// Page of words and symbols.
const GLOSSARY: &str = include_str!("../../../docs/glossary.md");
/// Pages on files of results, with their columns and keys.
const RESULTS: [(&str, &str); 2] = [
    ("docs/names.md", include_str!("../../../docs/names.md")),
    ("docs/data.md", include_str!("../../../docs/data.md")),
];
/// Greek letters of equations, by their spelled-out names.
const GREEK: &[(&str, &str)] = &[
    ("alpha", "α"),
    ("gamma", "γ"),
    ("delta", "Δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("phi", "φ"),
    ("psi", "ψ"),
    ("omega", "Ω"),
];

/// A name that is not a key of a case, and its meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// Kind: `symbol`, `word`, `column`, `figure`, `field`, `number`, `result`.
    pub kind: &'static str,
    /// Its name.
    pub name: String,
    /// Its meaning, with the unit and the place where it occurs.
    pub meaning: String,
}

impl Explanation {
    fn new(kind: &'static str, name: &str, meaning: String) -> Self {
        Self {
            kind,
            name: name.into(),
            meaning,
        }
    }
}

/// All meanings of a name; a figure is found by its quantity and its kind: `tip_u1_m.max_abs`.
pub fn find(name: &str) -> Vec<Explanation> {
    let mut found = exactly(name);
    if found.is_empty()
        && let Some((quantity, kind)) = name.rsplit_once('.')
    {
        found = exactly(quantity);
        found.extend(exactly(kind));
    }
    if found.is_empty() {
        // a column of a table in the form of a key, with its unit at the end
        let ends = ["_pa", "_j", "_w", "_m", "_m3", "_m^3", "_N", "_N m", "_rad"];
        // of a beam of a structure: `left.work_j`
        let own = name.split_once('.').map_or(name, |(_, own)| own);
        let without = ends.iter().filter_map(|end| own.strip_suffix(end));
        let mut without = without.chain(std::iter::once(own)).map(exactly);
        found = without.find(|all| !all.is_empty()).unwrap_or_default();
    }
    found.extend(rows(GLOSSARY).flat_map(|row| of_glossary(&row, name)));
    found
}

fn exactly(name: &str) -> Vec<Explanation> {
    let mut found = quantities(name);
    if found.is_empty()
        && let Some([unit, about]) = facts::meaning(name)
    {
        let what = format!("{about} [{unit}], a characteristic number: slcbeam check, summary.json");
        found.push(Explanation::new("number", name, what));
    }
    // rows of the first page have one name or few
    for (page, text) in RESULTS {
        if found.is_empty() {
            found = rows(text).filter_map(|row| of_results(page, &row, name)).collect();
        }
    }
    found
}

/// Exactly known names, for the search of the nearest.
pub fn names() -> Vec<&'static str> {
    let columns = Observable::ALL.iter().map(|one| one.name());
    let figures = Interest::ALL.iter().map(|one| one.name());
    columns
        .chain(figures)
        .chain(BeamField::ALL.iter().map(|field| field.name()))
        .collect()
}

fn quantities(name: &str) -> Vec<Explanation> {
    let column = Observable::named(name).map(|one| {
        let what = format!("{} [{}], a column of history.csv", one.about(), one.unit());
        Explanation::new("column", name, what)
    });
    let figure = Interest::named(name).map(|one| {
        let what = format!("{} [{}], under quantities in summary.json", one.describe(), one.unit());
        Explanation::new("figure", name, what)
    });
    let field = BeamField::named(name).map(|one| {
        let what = format!("{} [{}], an array of fields.npz", one.about(), one.unit());
        Explanation::new("field", name, what)
    });
    [column, figure, field].into_iter().flatten().collect()
}

/// Cells of the rows of all tables of a page, without headings and rules.
fn rows(page: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    let lines = page
        .lines()
        .filter(|line| line.starts_with("| ") && !line.contains("|--"));
    lines.map(|line| {
        let cells = line
            .strip_prefix('|')
            .and_then(|line| line.strip_suffix('|'))
            .unwrap_or(line);
        cells.split('|').map(str::trim).collect()
    })
}

/// Meanings of a name in a row of the glossary; a spelled-out Greek letter matches its symbol.
fn of_glossary(row: &[&str], name: &str) -> Vec<Explanation> {
    let Some(first) = row.first() else { return vec![] };
    let names: Vec<&str> = first.split([',', ';']).map(str::trim).collect();
    let letter = GREEK.iter().find(|(spelled, _)| name.eq_ignore_ascii_case(spelled));
    // alpha_p is α_p
    let written = name.split_once('_').and_then(|(first, rest)| {
        let (_, letter) = GREEK.iter().find(|(spelled, _)| first.eq_ignore_ascii_case(spelled))?;
        Some(format!("{letter}_{rest}"))
    });
    let name = written.as_deref().unwrap_or(name);
    let asked = |one: &str| match letter {
        None => one == name || one.contains(' ') && one.eq_ignore_ascii_case(name),
        Some((_, letter)) => one
            .strip_prefix(letter)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(['_', '\'', '*'])),
    };
    let places = names.iter().enumerate().filter(|(_, one)| asked(one));
    places
        .filter_map(|(place, one)| of_symbol(row, &names, place, one))
        .collect()
}

fn of_symbol(row: &[&str], names: &[&str], place: usize, name: &str) -> Option<Explanation> {
    match *row {
        [_, meaning] => Some(Explanation::new("word", name, meaning.into())),
        [_, meaning, unit, tag] => {
            // with as many parts as names, each part belongs to one name
            let part = |text: &str| {
                let parts: Vec<&str> = text.split([',', ';']).map(str::trim).collect();
                match parts.len() == names.len() {
                    true => parts[place].to_owned(),
                    false => text.to_owned(),
                }
            };
            let mut what = part(meaning);
            if !unit.is_empty() {
                what += &format!(" [{}]", part(unit));
            }
            if !tag.is_empty() {
                what += &format!(", {tag} in docs/model.md");
            }
            Some(Explanation::new("symbol", name, what))
        }
        _ => None,
    }
}

fn of_results(page: &str, row: &[&str], name: &str) -> Option<Explanation> {
    let [first, rest @ ..] = row else { return None };
    let quoted = first.split('`').skip(1).step_by(2);
    let own = quoted
        .map(|text| {
            text.split_once(" [")
                .map_or((text, ""), |(own, unit)| (own, unit.trim_end_matches(']')))
        })
        .find(|(own, _)| fits(own, name))?;
    let unit = if own.1.is_empty() {
        String::new()
    } else {
        format!(" [{}]", own.1)
    };
    let meaning = rest.join("; ").replace('`', "");
    Some(Explanation::new(
        "result",
        own.0,
        format!("{meaning}{unit}, see {page}"),
    ))
}

/// True if a name matches that of a row, in which words of capitals are placeholders for names and numbers.
fn fits(pattern: &str, name: &str) -> bool {
    let wild = pattern
        .split(['_', ' '])
        .find(|part| !part.is_empty() && part.chars().all(|c| c.is_ascii_uppercase()));
    let Some(wild) = wild else { return pattern == name };
    let Some((begin, end)) = pattern.split_once(wild) else {
        return false;
    };
    let middle = name.strip_prefix(begin).and_then(|rest| rest.strip_suffix(end));
    // a figure of a quantity is explained by its parts
    middle.is_some_and(|middle| !middle.is_empty() && !middle.contains('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_for_others() {
        assert!(fits("port_NAME_flow", "port_inlet_of_bladder_1_flow") && !fits("port_NAME_flow", "port_flow"));
        assert!(fits("max_pressure", "max_pressure") && !fits("max_pressure", "min_pressure"));
    }

    /// Goal: every name of the pages on results is explained.
    #[test]
    fn names_of_results_are_found() {
        for (page, text) in RESULTS {
            for row in rows(text) {
                for quoted in row[0].split('`').skip(1).step_by(2) {
                    let name = quoted.split(" [").next().unwrap_or_default();
                    let file = name.contains(['.', '/']) || name.contains("--");
                    assert!(file || !find(name).is_empty(), "{page}: {name}");
                }
            }
        }
    }

    /// Goal: every symbol and word of the glossary is explained.
    #[test]
    fn the_glossary_is_found() {
        let mut count = 0;
        for row in rows(GLOSSARY).filter(|row| !["word", "symbol"].contains(&row[0])) {
            let name = row[0].split([',', ';']).next().unwrap_or_default();
            assert!(!find(name).is_empty(), "{name}");
            count += 1;
        }
        assert!(count > 80, "{count}");
    }
}
