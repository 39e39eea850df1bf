//! Escapes hidden characters in foreign text: names, keys, headings and file names may contain control sequences of a terminal.

use std::borrow::Cow;
use std::fmt::Write as _;

/// True if a character is not displayed, but controls a terminal or the order of its neighbors. These are control characters (C0 and C1,
/// DEL), marks of writing direction, and tags.
pub fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}' | '\u{2029}')
        || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{e0000}'..='\u{e007f}')
}

/// Escapes hidden characters as `\u001b`, as in JSON, so that JSON text keeps its value. Line ends and tabs stay.
pub fn visible(text: &str) -> Cow<'_, str> {
    let hidden = |c: char| is_hidden(c) && c != '\n' && c != '\t';
    if !text.contains(hidden) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if hidden(c) {
            for unit in c.encode_utf16(&mut [0; 2]) {
                let _ = write!(out, "\\u{unit:04x}");
            }
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: no hidden character is left, visible text stays, and JSON text keeps its value.
    #[test]
    fn hidden_characters_are_written_out() {
        let text = "a\u{1b}]0;x\u{7}\r\u{85}\u{202e}ä\u{e0041}\tb\n";
        let shown = visible(text);
        assert_eq!(shown, "a\\u001b]0;x\\u0007\\u000d\\u0085\\u202eä\\udb40\\udc41\tb\n");
        assert!(matches!(visible("plain ä ₁ \n"), Cow::Borrowed(_)));
        let json = serde_json::Value::from("\u{7f}\u{202e}\u{e0041}").to_string();
        let back: String = serde_json::from_str(&visible(&json)).expect("still JSON");
        assert_eq!(back, "\u{7f}\u{202e}\u{e0041}");
    }
}
