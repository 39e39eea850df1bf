//! Lines and columns of bytes.

/// Computes lines and columns of byte offsets in a text; offsets in ascending order need a single pass.
#[derive(Clone, Debug)]
pub struct LineColumns<'t> {
    text: &'t str,
    at: usize,
    line: usize,
    column: usize,
}

impl<'t> LineColumns<'t> {
    /// Starts at the beginning of a text.
    pub fn new(text: &'t str) -> Self {
        Self {
            text,
            at: 0,
            line: 1,
            column: 1,
        }
    }

    /// The text.
    pub(super) fn text(&self) -> &'t str {
        self.text
    }

    /// Line and column of a byte, from 1.
    pub fn line_and_column(&mut self, at: usize) -> (usize, usize) {
        let at = floor(self.text, at);
        if at < self.at {
            *self = Self::new(self.text);
        }
        let passed = &self.text[self.at..at];
        let last = match passed.rfind('\n') {
            Some(end) => {
                self.line += passed.bytes().filter(|b| *b == b'\n').count();
                self.column = 1;
                &passed[end + 1..]
            }
            None => passed,
        };
        self.column += last.chars().count();
        self.at = at;
        (self.line, self.column)
    }
}

/// The character boundary at or before a byte.
pub(super) fn floor(text: &str, mut at: usize) -> usize {
    at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}
