//! Building blocks of messages.

use serde_json::Value;

/// The most similar name, if similar enough to be what was meant.
pub fn nearest<'n>(name: &str, names: impl Iterator<Item = &'n str>) -> Option<String> {
    all_nearest(name, names).pop().map(|(_, known)| known.to_owned())
}

/// The most similar figure; `tip_x` means the displacement across the beam, `tip_z` that along it.
pub fn nearest_figure<'n>(name: &str, names: impl Iterator<Item = &'n str> + Clone) -> Option<String> {
    let parts = name.split('_').map(|part| match part {
        "x" => "u1",
        "z" => "u3",
        part => part,
    });
    let meant = parts.collect::<Vec<_>>().join("_");
    let mut others = names.clone().filter(|_| meant != name);
    let known = others.find(|known| *known == meant || known.starts_with(&format!("{meant}_")));
    known.map(str::to_owned).or_else(|| nearest(name, names))
}

/// The most similar names, each with its similarity, up to 1; several if they are equally similar.
pub fn all_nearest<'n>(name: &str, names: impl Iterator<Item = &'n str>) -> Vec<(f64, &'n str)> {
    let mut best = vec![];
    if name.len() > 100 {
        return best;
    }
    let name = name.to_lowercase();
    for known in names {
        let similarity = strsim::jaro_winkler(&name, known);
        let most = best.first().map_or(0.8, |(most, _)| *most);
        match similarity > most + 1e-9 {
            true => best = vec![(similarity, known)],
            false if !best.is_empty() && similarity > most - 1e-9 => best.push((similarity, known)),
            false => {}
        }
    }
    best
}

/// Shortens a user's text to at most 40 characters.
pub fn short(text: &str) -> String {
    let mut chars = text.chars();
    let start: String = chars.by_ref().take(40).collect();
    if chars.next().is_some() { start + "..." } else { start }
}

/// Describes a value found in place of another.
pub fn found(value: &Value) -> String {
    match value {
        Value::Null => "null".to_owned(),
        Value::Bool(b) => b.to_string(),
        Value::Number(n) => format!("the number {n}"),
        Value::String(s) => found_text(s),
        Value::Array(_) => "an array".to_owned(),
        Value::Object(_) => "an object".to_owned(),
    }
}

/// Describes a text found in place of another value.
pub fn found_text(text: &str) -> String {
    format!("the text \"{}\"", short(text))
}

/// Names in quotes.
pub fn quoted(names: &[&str]) -> String {
    names
        .iter()
        .map(|name| format!("\"{name}\""))
        .collect::<Vec<_>>()
        .join(", ")
}
