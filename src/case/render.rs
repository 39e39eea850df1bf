//! Violations as text: description, line with a caret, allowed values, nearest name, and hint.

use std::fmt::Write;
use std::ops::Range;

use textwrap::{Options, WordSplitter};

use super::places::{LineColumns, floor};
use crate::error::{CaseError, Violation, is_hidden, visible};

/// Largest number of violations shown in full.
const SHOWN: usize = 50;

/// Applies escape sequences, if enabled.
struct Paint(bool);

impl Paint {
    fn bold_red(&self, text: &str) -> String {
        self.wrap("1;31", text)
    }
    fn blue(&self, text: &str) -> String {
        self.wrap("34", text)
    }
    fn bold(&self, text: &str) -> String {
        self.wrap("1", text)
    }
    fn wrap(&self, code: &str, text: &str) -> String {
        if self.0 {
            format!("\x1b[{code}m{text}\x1b[0m")
        } else {
            text.to_owned()
        }
    }
}

/// Formats all faults of a case for a terminal of `width` columns.
pub fn render(fault: &CaseError, colour: bool, width: usize) -> String {
    let paint = Paint(colour);
    let width = width.clamp(40, 400);
    let mut out = String::new();
    let mut places = LineColumns::new(&fault.text);
    for violation in fault.violations.iter().take(SHOWN) {
        one(fault, violation, &mut places, &paint, width, &mut out);
    }
    let count = fault.violations.len();
    if count > SHOWN {
        let _ = writeln!(out, "and {} more", count - SHOWN);
    }
    let _ = writeln!(
        out,
        "{count} {} in {}",
        if count == 1 { "fault" } else { "faults" },
        named(fault)
    );
    if let Some(first) = fault.violations.first() {
        let _ = writeln!(out, "more about the first: slcbeam explain {}", first.code.id());
    }
    out
}

/// Readable name of the source of the text.
fn named(fault: &CaseError) -> String {
    match fault.path.to_str() {
        Some("-") => "standard input".into(),
        _ => visible(&fault.path.display().to_string()).into_owned(),
    }
}

fn one(
    fault: &CaseError,
    violation: &Violation,
    places: &mut LineColumns,
    paint: &Paint,
    width: usize,
    out: &mut String,
) {
    let label = format!("fault[{}]:", violation.code.id());
    let _ = writeln!(
        out,
        "{} {}",
        paint.bold_red(&label),
        paint.bold(&visible(&violation.what))
    );
    let text = violation.set.as_deref().unwrap_or(&fault.text);
    let span = violation.span.clone().filter(|span| span.end <= text.len());
    let excerpt = span.filter(|_| !text.is_empty()).map(|span| match &violation.set {
        Some(set) => Excerpt::cut(&mut LineColumns::new(set), span, width),
        None => Excerpt::cut(places, span, width),
    });
    let name = match &violation.set {
        Some(_) => violation.option.to_owned(),
        None => named(fault),
    };
    let at = if violation.pointer.is_empty() {
        String::new()
    } else {
        format!(" at {}", visible(&clipped(&violation.pointer, width)))
    };
    let margin = excerpt.as_ref().map_or(1, |e| e.line.to_string().len());
    let bar = paint.blue("|");
    match &excerpt {
        Some(e) => {
            let place = match violation.set {
                Some(_) => name,
                None => format!("{name}:{}:{}", e.line, e.column),
            };
            let _ = writeln!(out, "{:margin$}{} {place}{at}", "", paint.blue("-->"));
            let _ = writeln!(out, "{} {bar} {}", paint.blue(&format!("{:>margin$}", e.line)), e.text);
            let carets = "^".repeat(e.carets);
            let _ = writeln!(
                out,
                "{:margin$} {bar} {:indent$}{}",
                "",
                "",
                paint.bold_red(&carets),
                indent = e.indent
            );
        }
        None => {
            let _ = writeln!(out, " {} {name}{at}", paint.blue("-->"));
        }
    }
    let meant = violation
        .nearest
        .as_ref()
        .map(|name| format!("did you mean \"{name}\"?"));
    let notes = [
        ("allowed", &violation.allowed),
        ("nearest", &meant),
        ("hint", &violation.hint),
    ];
    for (label, note) in notes {
        let Some(note) = note else { continue };
        let head = format!("{:margin$} = {label}: ", "");
        let below = " ".repeat(head.len());
        let lines = Options::new(width)
            .initial_indent(&head)
            .subsequent_indent(&below)
            .break_words(false)
            .word_splitter(WordSplitter::NoHyphenation);
        let words: Vec<_> = note.split_whitespace().collect();
        let _ = writeln!(out, "{}", textwrap::fill(&visible(&words.join(" ")), lines));
    }
    out.push('\n');
}

/// Shortens a pointer that is longer than `width`.
fn clipped(pointer: &str, width: usize) -> String {
    let count = pointer.chars().count();
    if count <= width {
        return pointer.to_owned();
    }
    let end: String = pointer.chars().skip(count - width / 2).collect();
    format!("...{end}")
}

/// Part of a line with the columns to mark.
struct Excerpt {
    line: usize,
    column: usize,
    text: String,
    indent: usize,
    carets: usize,
}

impl Excerpt {
    /// The line around `span`, cut to the width, with `...` at the cuts.
    fn cut(places: &mut LineColumns, span: Range<usize>, width: usize) -> Self {
        let text = places.text();
        let start = floor(text, span.start);
        let (line, column) = places.line_and_column(start);
        let line_start = text[..start].rfind('\n').map_or(0, |i| i + 1);
        let room = width.saturating_sub(line.to_string().len() + 3);
        // Only the surroundings of the fault are read: a line may have megabytes.
        let reach = 4 * room;
        let from = floor(text, line_start.max(start.saturating_sub(reach)));
        let to = floor(text, text.len().min(start + reach));
        let left: Vec<char> = text[from..start].chars().map(plain).collect();
        let right: Vec<char> = text[start..to]
            .chars()
            .take_while(|c| *c != '\n' && *c != '\r')
            .map(plain)
            .collect();
        let wanted = text[start..floor(text, span.end.min(to)).max(start)]
            .lines()
            .next()
            .unwrap_or("")
            .chars()
            .count();

        let keep_left = if left.len() + right.len() <= room {
            left.len()
        } else {
            left.len().min(room / 2)
        };
        let cut_left = from > line_start || keep_left < left.len();
        let keep_right = right.len().min(room - keep_left);
        let cut_right = keep_right < right.len() || (to < text.len() && right.len() == text[start..to].chars().count());
        let mut shown: Vec<char> = left[left.len() - keep_left..]
            .iter()
            .chain(&right[..keep_right])
            .copied()
            .collect();
        let last = shown.len();
        if cut_left && keep_left >= 3 {
            shown[..3].fill('.');
        }
        if cut_right && keep_right >= 4 {
            shown[last - 3..].fill('.');
        }
        let carets = wanted.clamp(1, keep_right.max(1));
        let text: String = shown.into_iter().collect();
        Self {
            line,
            column,
            text: text.trim_end().to_owned(),
            indent: keep_left,
            carets,
        }
    }
}

/// Replaces tabs, control characters and direction marks, so that each has one column.
fn plain(c: char) -> char {
    if c == '\t' {
        ' '
    } else if is_hidden(c) {
        '\u{fffd}'
    } else {
        c
    }
}
