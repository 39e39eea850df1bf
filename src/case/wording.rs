//! Words of the messages.

use serde_json::Value;

/// The most similar name, if similar enough to be what was meant.
pub fn nearest<'n>(name: &str, names: impl Iterator<Item = &'n str>) -> Option<String> {
    if name.len() > 100 {
        return None;
    }
    let similarity = |known: &str| strsim::jaro_winkler(&name.to_lowercase(), known);
    let best = names
        .map(|known| (similarity(known), known))
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 > 0.8).then(|| best.1.to_owned())
}

/// At most 40 characters of what the user wrote.
pub fn short(text: &str) -> String {
    let mut chars = text.chars();
    let start: String = chars.by_ref().take(40).collect();
    if chars.next().is_some() { start + "..." } else { start }
}

/// What was found where something else should stand.
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

/// The same for a text.
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
