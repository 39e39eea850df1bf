//! Change of one value of a case file; all other bytes stay unchanged.

use std::ops::Range;

use serde_json::Value;

use super::locate::JsonKind;
use super::parse::parse;

/// Returns the text with another value of a top-level key; a missing key is added after the last one. None if the text is not a JSON
/// object.
pub fn rewrite(text: &str, key: &str, value: &Value) -> Option<String> {
    let root = parse(text).0?;
    let JsonKind::Object(members) = &root.kind else {
        return None;
    };
    let value = spaced(value);
    // The span of a value may end with spaces.
    let bare = |span: &Range<usize>| span.start..span.start + text[span.clone()].trim_end().len();
    let (at, new) = if let Some(member) = members.iter().find(|m| m.key == key) {
        (bare(&member.value.span), value)
    } else if let Some(last) = members.last() {
        // On its own line with the indentation of the last key, if that key begins its line.
        let before = &text[..last.key_span.start];
        let line = &before[before.rfind('\n').map_or(0, |at| at + 1)..];
        let own_line = line.trim().is_empty() && before.contains('\n');
        let end = if before.trim_end_matches([' ', '\t']).ends_with("\r\n") {
            "\r\n"
        } else {
            "\n"
        };
        let gap = if own_line { format!("{end}{line}") } else { " ".into() };
        let behind = bare(&last.value.span).end;
        (behind..behind, format!(",{gap}\"{key}\": {value}"))
    } else {
        let end = root.span.end - 1;
        (end..end, format!("\"{key}\": {value}"))
    };
    Some([&text[..at.start], &new, &text[at.end..]].concat())
}

/// JSON in one line, with spaces after colons and commas.
pub fn spaced(value: &Value) -> String {
    match value {
        Value::Object(members) => {
            let members = members
                .iter()
                .map(|(key, value)| format!("{}: {}", Value::from(key.as_str()), spaced(value)));
            format!("{{{}}}", members.collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}
