//! A strict JSON reader that keeps places, goes on after numbers that are none, and says in words what is wrong.

use std::collections::HashMap;
use std::ops::Range;

use super::locate::{Kind, Member, Node, child};
use super::wording::short;
use crate::error::{Code, Violation};

/// Deepest nesting that is read; a case needs about ten.
pub(super) const DEEPEST: usize = 100;
/// Violations after which nothing more is collected.
const MOST_FAULTS: usize = 100;

/// Reads one JSON value. Violations that leave the structure readable (numbers that are not finite, keys given twice)
/// come with a value, others without. Members whose key begins with `//` are remarks and left out.
pub fn parse(text: &str) -> (Option<Node>, Vec<Violation>) {
    let mut parser = Parser {
        text,
        at: 0,
        pointer: String::new(),
        depth: 0,
        faults: vec![],
    };
    let node = parser.document();
    (node, parser.faults)
}

/// Members whose key begins so are remarks: nobody reads them.
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
    fn document(&mut self) -> Option<Node> {
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
        if self.peek().is_some() {
            let what = format!("{} after the end of the JSON value", self.found());
            let fault = self.fault(self.here(), what);
            return self.fail(fault);
        }
        Some(node)
    }

    fn value(&mut self) -> Option<Node> {
        let start = self.at;
        let kind = match self.peek() {
            Some(b'{') => self.nested(Self::object)?,
            Some(b'[') => self.nested(Self::array)?,
            Some(b'"') => Kind::String(self.string()?),
            Some(b) if b.is_ascii_alphanumeric() || b"+-.".contains(&b) => self.word()?,
            Some(_) => return self.unexpected("a value"),
            None => return self.ends_early(start, "a value"),
        };
        Some(Node {
            span: start..self.at,
            kind,
        })
    }

    fn nested(&mut self, read: fn(&mut Self, usize) -> Option<Kind>) -> Option<Kind> {
        let start = self.at;
        if self.depth == DEEPEST {
            let fault = self.fault(self.here(), format!("more than {DEEPEST} brackets inside each other"));
            return self.fail(fault);
        }
        self.depth += 1;
        self.at += 1;
        let kind = read(self, start)?;
        self.depth -= 1;
        Some(kind)
    }

    fn object(&mut self, start: usize) -> Option<Kind> {
        let mut members: Vec<Member> = vec![];
        let mut known = HashMap::new();
        self.space();
        if self.peek() == Some(b'}') {
            self.at += 1;
            return Some(Kind::Object(members));
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
                Some(_) => return self.unexpected("`:`"),
                None => return self.ends_early(start, "`:`"),
            }
            self.space();
            let value = match self.peek() {
                None => return self.ends_early(start, "a value"),
                Some(_) => self.value()?,
            };
            self.pointer.truncate(length);
            if first == key_start && !is_remark(&key) {
                members.push(Member { key, key_span, value });
            }
            if self.closes(b'}', start, "`,` or `}`")? {
                return Some(Kind::Object(members));
            }
        }
    }

    fn array(&mut self, start: usize) -> Option<Kind> {
        let mut items = vec![];
        self.space();
        if self.peek() == Some(b']') {
            self.at += 1;
            return Some(Kind::Array(items));
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
                return Some(Kind::Array(items));
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
                    let fault = self.fault(start..end, "text that is not closed in its line");
                    return self.fail(fault.hint("end it with a double quote"));
                }
                Some(_) => end += 1,
                None => {
                    self.at = self.text.len();
                    return self.ends_early(start, "`\"`");
                }
            }
        }
        self.at = end + 1;
        match serde_json::from_str(&self.text[start..self.at]) {
            Ok(text) => Some(text),
            Err(_) => {
                let fault = self.fault(start..self.at, "text with an escape that JSON does not know");
                self.fail(fault.hint("a backslash itself is written `\\\\`"))
            }
        }
    }

    fn word(&mut self) -> Option<Kind> {
        let start = self.at;
        let rest = &self.text.as_bytes()[start..];
        let length = rest
            .iter()
            .take_while(|b| b.is_ascii_alphanumeric() || b"+-._".contains(b))
            .count();
        self.at += length;
        let word = &self.text[start..self.at];
        match word {
            "true" => return Some(Kind::Bool(true)),
            "false" => return Some(Kind::Bool(false)),
            "null" => return Some(Kind::Null),
            _ => {}
        }
        if let Ok(number) = serde_json::from_str(word) {
            return Some(Kind::Number(number));
        }
        if self.at == self.text.len() && self.depth > 0 {
            return self.ends_early(start, "the rest of it");
        }
        let fault = match word.parse::<f64>() {
            Ok(number) if number.is_finite() => self
                .fault(
                    start..self.at,
                    format!("{} is not how JSON writes a number", short(word)),
                )
                .hint(format!("write {number:?}")),
            Ok(_) => self
                .fault(start..self.at, format!("{} is not a finite number", short(word)))
                .allowed("finite numbers of magnitude up to 1.797e308"),
            Err(_) => {
                let fault = self.fault(start..self.at, format!("`{}` is not a JSON value", short(word)));
                let number = word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
                return self.fail(fault.hint(match number {
                    true => "a number has no unit behind it; the key names it",
                    false => "text needs double quotes",
                }));
            }
        };
        self.report(fault);
        Some(Kind::Null)
    }

    fn unexpected<T>(&mut self, wanted: &str) -> Option<T> {
        let fault = self.fault(self.here(), format!("expected {wanted}, found {}", self.found()));
        let fault = match self.peek() {
            Some(b'/') | Some(b'#') => {
                fault.hint("JSON has no comments; write a member whose key begins with //, such as \"// why\": \"...\"")
            }
            Some(b'\'') => fault.hint("text needs double quotes"),
            Some(b) if b.is_ascii_digit() && self.is_behind_decimal_comma() => {
                fault.hint("decimals stand behind a point")
            }
            _ => fault,
        };
        self.fail(fault)
    }

    /// Whether what is here stands at once behind a digit and a comma: `0,3`.
    fn is_behind_decimal_comma(&self) -> bool {
        matches!(self.text.as_bytes()[..self.at], [.., digit, b','] if digit.is_ascii_digit())
    }

    /// The next member follows without one: told behind the last, where it belongs, not in the line below.
    fn missing_comma<T>(&mut self) -> Option<T> {
        let end = self.text[..self.at].trim_end().len();
        let fault = self.fault(end..end, format!("a comma is missing before {}", self.found()));
        self.fail(fault.hint("write `,` here"))
    }

    fn trailing_comma<T>(&mut self) -> Option<T> {
        let comma = self.text[..self.at].rfind(',').unwrap_or(self.at);
        let fault = self.fault(comma..comma + 1, format!("a comma before {}", self.found()));
        self.fail(fault.hint("remove the comma"))
    }

    /// The text breaks off inside what starts at `start`.
    fn ends_early<T>(&mut self, start: usize, wanted: &str) -> Option<T> {
        let end = self.text.trim_end().len();
        let inside = match self.text.as_bytes().get(start) {
            Some(b'{') => format!("the object that opens in line {}", self.line(start)),
            Some(b'[') => format!("the array that opens in line {}", self.line(start)),
            Some(b'"') => format!("the text that starts in line {}", self.line(start)),
            _ => format!("the value that starts in line {}", self.line(start)),
        };
        let fault = self.fault(end..end, format!("the text ends inside {inside}: expected {wanted}"));
        self.fail(fault.hint("the file is cut off, or a closing bracket or quote is missing"))
    }

    fn fault(&self, span: Range<usize>, what: impl Into<String>) -> Violation {
        Violation {
            span: Some(span),
            ..Violation::new(Code::Text, self.pointer.clone(), what)
        }
    }

    fn report(&mut self, fault: Violation) {
        if self.faults.len() < MOST_FAULTS {
            self.faults.push(fault);
        }
    }

    fn fail<T>(&mut self, fault: Violation) -> Option<T> {
        self.faults.push(fault);
        None
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn space(&mut self) {
        let rest = &self.text.as_bytes()[self.at..];
        self.at += rest.iter().take_while(|b| b" \t\r\n".contains(b)).count();
    }

    fn here(&self) -> Range<usize> {
        let length = self.text[self.at..].chars().next().map_or(0, char::len_utf8);
        self.at..self.at + length
    }

    fn found(&self) -> String {
        match self.text[self.at..].chars().next() {
            Some(c) if c.is_control() => format!("the control character U+{:04X}", u32::from(c)),
            Some(c) => format!("`{c}`"),
            None => "the end".to_owned(),
        }
    }

    fn line(&self, at: usize) -> usize {
        1 + self.text.as_bytes()[..at].iter().filter(|b| **b == b'\n').count()
    }
}
