//! Strict JSON reader that stores places, continues after invalid numbers, and describes every mistake.
//!
//! ```text
//! diagnostics      faults of a text
//! common_mistakes  common mistakes and their intended meaning
//! ```

pub(super) mod common_mistakes;
mod diagnostics;

use std::collections::HashMap;

use super::locate::{JsonKind, JsonMember, JsonNode, child};
use super::wording::short;
use crate::error::Violation;

/// Deepest nesting that is read; a case needs about ten.
pub(super) const DEEPEST: usize = 100;
/// Number of violations after which no more are collected.
const MOST_FAULTS: usize = 100;

/// Reads one JSON value. Violations that leave the structure readable (numbers that are not finite, keys given twice) are returned with a
/// value, others without. Members whose key begins with `//` are remarks and are omitted.
pub fn parse(text: &str) -> (Option<JsonNode>, Vec<Violation>) {
    parse_below(text, "")
}

/// Reads one JSON value as `parse`; `pointer` is its place in a case.
pub fn parse_below(text: &str, pointer: &str) -> (Option<JsonNode>, Vec<Violation>) {
    let mut parser = Parser {
        text,
        at: 0,
        pointer: pointer.to_owned(),
        depth: 0,
        faults: vec![],
    };
    let node = parser.document();
    (node, parser.faults)
}

/// True if a member is a remark, which is not read.
fn is_remark(key: &str) -> bool {
    key.starts_with("//")
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    pointer: String,
    depth: usize,
    faults: Vec<Violation>,
}

impl Parser<'_> {
    fn document(&mut self) -> Option<JsonNode> {
        if self.text.starts_with('\u{feff}') {
            let fault = self.fault(
                0..3,
                "the file starts with a byte order mark, which JSON does not allow",
            );
            self.report(fault.hint("save it as UTF-8 without BOM"));
            self.at = 3;
        }
        self.space();
        if self.peek().is_none() {
            let fault = self.fault(self.at..self.at, "the file is empty");
            return self.fail(fault.hint("a case is a JSON object, `{ ... }`"));
        }
        let node = self.value()?;
        self.space();
        match self.peek() {
            None => Some(node),
            Some(b'}' | b']') => {
                let what = format!("{} without an opening bracket", self.found());
                let fault = self.fault(self.here(), what);
                self.fail(fault.hint("remove it, or one before it"))
            }
            Some(b',' | b'"') if matches!(node.kind, JsonKind::Object(_)) => {
                let what = "`}` closes the whole object, but more text follows";
                let fault = self.fault(node.span.end - 1..node.span.end, what);
                self.fail(fault.hint("remove it, or one before it"))
            }
            Some(_) => {
                let what = format!("{} after the end of the JSON value", self.found());
                let fault = self.fault(self.here(), what);
                self.fail(fault)
            }
        }
    }

    fn value(&mut self) -> Option<JsonNode> {
        let start = self.at;
        let kind = match self.peek() {
            Some(b'{') => self.nested(Self::object)?,
            Some(b'[') => self.nested(Self::array)?,
            Some(b'"') => {
                let text = self.string()?;
                self.ends_before_a_word(start)?;
                JsonKind::String(text)
            }
            Some(b) if b.is_ascii_alphanumeric() || b"+-.".contains(&b) || self.is_minus() => self.word()?,
            Some(_) => return self.unexpected("a value"),
            None => return self.ends_early(start, "a value"),
        };
        Some(JsonNode {
            span: start..self.at,
            kind,
        })
    }

    fn nested(&mut self, read: fn(&mut Self, usize) -> Option<JsonKind>) -> Option<JsonKind> {
        let start = self.at;
        if self.depth == DEEPEST {
            let fault = self.fault(self.here(), format!("brackets nested more than {DEEPEST} deep"));
            return self.fail(fault);
        }
        self.depth += 1;
        self.at += 1;
        let kind = read(self, start)?;
        self.depth -= 1;
        Some(kind)
    }

    fn object(&mut self, start: usize) -> Option<JsonKind> {
        let mut members: Vec<JsonMember> = vec![];
        let mut known = HashMap::new();
        self.space();
        if self.peek() == Some(b'}') {
            self.at += 1;
            return Some(JsonKind::Object(members));
        }
        loop {
            let key_start = self.at;
            match self.peek() {
                Some(b'"') => {}
                Some(b'}') => return self.trailing_comma(),
                Some(_) => return self.unexpected("a key in double quotes"),
                None => return self.ends_early(start, "a key"),
            }
            let key = self.string()?;
            self.ends_before_a_word(key_start)?;
            let key_span = key_start..self.at;
            let length = self.pointer.len();
            self.pointer = child(&self.pointer, &key);
            let first = *known.entry(key.clone()).or_insert(key_start);
            if first != key_start && !is_remark(&key) && self.faults.len() < MOST_FAULTS {
                let what = format!(
                    "key \"{}\" given twice, first in line {}",
                    short(&key),
                    self.line(first)
                );
                let fault = self.fault(key_span.clone(), what);
                self.report(fault.hint("keep one of them"));
            }
            self.space();
            match self.peek() {
                Some(b':') => self.at += 1,
                Some(b',' | b'}') => return self.unexpected("`:`"),
                Some(b'=') => {
                    let fault = self.fault(self.here(), "`=` between a key and its value");
                    return self.fail(fault.hint("write `:` in its place"));
                }
                Some(_) => return self.missing(":"),
                None => return self.ends_early(start, "`:`"),
            }
            self.space();
            let value = match self.peek() {
                None => return self.ends_early(start, "a value"),
                Some(_) => self.value()?,
            };
            self.pointer.truncate(length);
            if first == key_start && !is_remark(&key) {
                members.push(JsonMember { key, key_span, value });
            }
            if self.closes(b'}', start, "`,` or `}`")? {
                return Some(JsonKind::Object(members));
            }
        }
    }

    fn array(&mut self, start: usize) -> Option<JsonKind> {
        let mut items = vec![];
        self.space();
        if self.peek() == Some(b']') {
            self.at += 1;
            return Some(JsonKind::Array(items));
        }
        loop {
            match self.peek() {
                Some(b']') => return self.trailing_comma(),
                None => return self.ends_early(start, "a value"),
                Some(_) => {}
            }
            let length = self.pointer.len();
            self.pointer = child(&self.pointer, items.len());
            items.push(self.value()?);
            self.pointer.truncate(length);
            if self.closes(b']', start, "`,` or `]`")? {
                return Some(JsonKind::Array(items));
            }
        }
    }

    /// After a member: true at the closing bracket, false at a comma.
    fn closes(&mut self, bracket: u8, start: usize, wanted: &str) -> Option<bool> {
        self.space();
        let closes = match self.peek() {
            Some(b) if b == bracket => true,
            Some(b',') => false,
            Some(b'"') => return self.missing_comma(),
            Some(b) if bracket == b']' && (b.is_ascii_digit() || b"-{[".contains(&b)) => return self.missing_comma(),
            Some(_) => return self.unexpected(wanted),
            None => return self.ends_early(start, wanted),
        };
        self.at += 1;
        self.space();
        Some(closes)
    }

    fn string(&mut self) -> Option<String> {
        let start = self.at;
        let bytes = self.text.as_bytes();
        let mut end = start + 1;
        loop {
            match bytes.get(end) {
                Some(b'"') => break,
                Some(b'\\') => end += 2,
                Some(b) if *b < 0x20 => {
                    return self.unclosed(start, end);
                }
                Some(_) => end += 1,
                None => return self.unclosed(start, self.text.trim_end().len().max(start + 1)),
            }
        }
        self.at = end + 1;
        match serde_json::from_str(&self.text[start..self.at]) {
            Ok(text) => Some(text),
            Err(_) => {
                let fault = self.fault(start..self.at, "text with an escape that JSON does not have");
                self.fail(fault.hint("a backslash itself is written `\\\\`"))
            }
        }
    }

    fn word(&mut self) -> Option<JsonKind> {
        let start = self.at;
        let of_word = |c: char| c.is_ascii_alphanumeric() || "+-._".contains(c) || common_mistakes::MINUS.contains(&c);
        let rest = &self.text[start..];
        self.at += rest.find(|c| !of_word(c)).unwrap_or(rest.len());
        let word = &self.text[start..self.at];
        match word {
            "true" => return Some(JsonKind::Bool(true)),
            "false" => return Some(JsonKind::Bool(false)),
            "null" => return Some(JsonKind::Null),
            _ => {}
        }
        let number = serde_json::from_str(word).ok();
        let like = number.is_some() || word.ends_with(|c: char| c.is_ascii_digit());
        if let Some(slip) = common_mistakes::behind_number(word, rest, &self.pointer).filter(|_| like) {
            return self.slip(start, slip).map(|()| JsonKind::Null);
        }
        if let Some(number) = number {
            return Some(JsonKind::Number(number));
        }
        if self.at == self.text.len() && self.depth > 0 {
            return self.ends_early(start, "the rest of it");
        }
        let fault = match word.replace(common_mistakes::MINUS, "-").parse::<f64>() {
            Ok(number) if number.is_finite() => self
                .fault(start..self.at, format!("{} is not a JSON number", short(word)))
                .hint(match word.contains(common_mistakes::MINUS) {
                    true => format!("write {number:?}, with the minus sign of the keyboard"),
                    false => format!("write {number:?}"),
                }),
            Ok(_) => self
                .fault(start..self.at, format!("{} is not a finite number", short(word)))
                .allowed("finite numbers of magnitude up to 1.797e308"),
            Err(_) => {
                let whole = common_mistakes::with_following_words(rest, word.len());
                self.at = start + whole.len();
                self.fault(start..self.at, format!("`{}` is not a JSON value", short(whole)))
                    .hint(common_mistakes::word(whole, &self.pointer))
            }
        };
        self.report(fault);
        Some(JsonKind::Null)
    }

    fn is_minus(&self) -> bool {
        self.text[self.at..].starts_with(common_mistakes::MINUS)
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn space(&mut self) {
        let rest = &self.text.as_bytes()[self.at..];
        self.at += rest.iter().take_while(|b| b" \t\r\n".contains(b)).count();
    }
}
