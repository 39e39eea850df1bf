//! Faults of a text that is not JSON: description, place and remedy.

use std::ops::Range;

use super::common_mistakes::{self, Slip};
use super::{MOST_FAULTS, Parser};
use crate::case::wording::short;
use crate::error::{Code, Violation};

impl Parser<'_> {
    /// Reports a mistake and continues after it; the value there is unknown.
    pub(super) fn slip(&mut self, start: usize, slip: Slip) -> Option<()> {
        self.at = start + slip.bytes;
        let fault = self.fault(start..self.at, slip.what).hint(slip.hint);
        self.report(fault);
        Some(())
    }

    /// Reports a text that is directly followed by a word: its closing quote is missing, and the quote that ends it begins another text.
    pub(super) fn ends_before_a_word(&mut self, start: usize) -> Option<()> {
        let text = &self.text[start..self.at];
        if !self.text[self.at..].starts_with(char::is_alphanumeric) || !text.contains([':', ',', '}', ']']) {
            return Some(());
        }
        let fault = self.fault(
            start..self.at,
            "a text without its closing quote: the quote that ends it begins another text",
        );
        let end = text.find([':', ',', '}', ']']).unwrap_or(text.len());
        let hint = format!("write {}\"", short(text[..end].trim_end()));
        self.fail(fault.hint(hint))
    }

    /// Reports a text that is not closed in its line.
    pub(super) fn unclosed<T>(&mut self, start: usize, end: usize) -> Option<T> {
        let line = self.text[start..end]
            .lines()
            .next()
            .map_or(0, |line| line.trim_end().len());
        let text = &self.text[start..start + line];
        let hint = match common_mistakes::closed_otherwise(text) {
            Some(quote) => format!("it ends with {quote}; write a straight double quote in its place"),
            None => "end it with a double quote".to_owned(),
        };
        let fault = self.fault(start..start + line, "text without a closing quote in its line");
        self.fail(fault.hint(hint))
    }

    pub(super) fn unexpected<T>(&mut self, wanted: &str) -> Option<T> {
        let rest = &self.text[self.at..];
        if let Some(slip) = common_mistakes::quoted(rest) {
            self.slip(self.at, slip);
            return None;
        }
        let name = rest.len() - rest.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_').len();
        if name > 0 && wanted.starts_with("a key") && !rest.starts_with(|c: char| c.is_ascii_digit()) {
            let what = format!("the key {} without quotes", short(&rest[..name]));
            let hint = format!("write \"{}\"", short(&rest[..name]));
            let fault = self.fault(self.at..self.at + name, what);
            return self.fail(fault.hint(hint));
        }
        let fault = self.fault(self.here(), format!("expected {wanted}, found {}", self.found()));
        let fault = match self.peek() {
            Some(b'/') | Some(b'#') => {
                fault.hint("JSON has no comments; write a member whose key begins with //, such as \"// why\": \"...\"")
            }
            Some(b'\'') => fault.hint("text needs double quotes"),
            Some(b';') => fault.hint("separate members and entries by `,`"),
            Some(b) if b.is_ascii_digit() && self.is_behind_decimal_comma() => {
                let hint = common_mistakes::loosely(self.around());
                fault.hint(hint.unwrap_or_else(|| "write decimals with a point".into()))
            }
            _ => fault,
        };
        self.fail(fault)
    }

    /// True if the current position directly follows a digit and a comma: `0,3`.
    pub(super) fn is_behind_decimal_comma(&self) -> bool {
        matches!(self.text.as_bytes()[..self.at], [.., digit, b','] if digit.is_ascii_digit())
    }

    /// Digits, commas and points around the current position.
    fn around(&self) -> &str {
        let of_number = |c: char| c.is_ascii_digit() || "+-.,eE".contains(c);
        let begin = self.text[..self.at].trim_end_matches(of_number).len();
        let rest = &self.text[self.at..];
        let behind = rest.len() - rest.trim_start_matches(of_number).len();
        self.text[begin..self.at + behind].trim_end_matches(',')
    }

    /// Reports a missing comma at the end of the last member, not in the line of the next one.
    pub(super) fn missing_comma<T>(&mut self) -> Option<T> {
        self.missing(",")
    }

    /// Reports a sign that is missing after the last value that was read.
    pub(super) fn missing<T>(&mut self, sign: &str) -> Option<T> {
        let end = self.text[..self.at].trim_end().len();
        let name = if sign == "," { "comma" } else { "colon" };
        let fault = self.fault(end..end, format!("a {name} is missing before {}", self.found()));
        self.fail(fault.hint(format!("write `{sign}` here")))
    }

    pub(super) fn trailing_comma<T>(&mut self) -> Option<T> {
        let comma = self.text[..self.at].rfind(',').unwrap_or(self.at);
        let fault = self.fault(comma..comma + 1, format!("a comma before {}", self.found()));
        self.fail(fault.hint("remove the comma"))
    }

    /// Reports that the text ends inside the value that starts at `start`.
    pub(super) fn ends_early<T>(&mut self, start: usize, wanted: &str) -> Option<T> {
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

    pub(super) fn fault(&self, span: Range<usize>, what: impl Into<String>) -> Violation {
        Violation {
            span: Some(span),
            ..Violation::new(Code::Text, self.pointer.clone(), what)
        }
    }

    pub(super) fn report(&mut self, fault: Violation) {
        if self.faults.len() < MOST_FAULTS {
            self.faults.push(fault);
        }
    }

    pub(super) fn fail<T>(&mut self, fault: Violation) -> Option<T> {
        self.faults.push(fault);
        None
    }

    pub(super) fn here(&self) -> Range<usize> {
        let length = self.text[self.at..].chars().next().map_or(0, char::len_utf8);
        self.at..self.at + length
    }

    pub(super) fn found(&self) -> String {
        match self.text[self.at..].chars().next() {
            Some(c) if c.is_control() => format!("the control character U+{:04X}", u32::from(c)),
            Some(c) => format!("`{c}`"),
            None => "the end".to_owned(),
        }
    }

    pub(super) fn line(&self, at: usize) -> usize {
        1 + self.text.as_bytes()[..at].iter().filter(|b| **b == b'\n').count()
    }
}
