//! Text tables for readers.

use textwrap::core::display_width;

/// Splits a text into trimmed cells at `|`: `name | size`.
pub fn cells<const N: usize>(row: &str) -> [&str; N] {
    let mut cells = row.split('|').map(str::trim);
    [(); N].map(|()| cells.next().unwrap_or_default())
}

/// Texts with a separator between them.
pub fn joined(texts: impl IntoIterator<Item = String>, between: &str) -> String {
    texts.into_iter().collect::<Vec<_>>().join(between)
}

/// Texts in brackets behind a space; empty without texts.
pub fn bracketed(texts: impl IntoIterator<Item = String>, between: &str) -> String {
    match joined(texts, between) {
        all if all.is_empty() => all,
        all => format!(" ({all})"),
    }
}

/// Text about a number of things; empty for none.
pub fn if_any(count: usize, text: impl FnOnce(usize) -> String) -> String {
    if count == 0 { String::new() } else { text(count) }
}

/// Warnings, one per line.
pub fn warnings<'a>(all: impl IntoIterator<Item = &'a String>) -> String {
    all.into_iter().map(|warning| format!("warning: {warning}\n")).collect()
}

/// Table under headings separated by ` | `: `name | <words`. Cells are right-aligned, or left-aligned in columns whose heading begins with
/// `<`.
pub fn table<L: AsRef<[String]>>(headings: &str, rows: impl IntoIterator<Item = L>) -> String {
    let headings: Vec<&str> = headings.split(" | ").map(str::trim).collect();
    let left: Vec<usize> = (0..headings.len()).filter(|k| headings[*k].starts_with('<')).collect();
    let mut lines = vec![
        headings
            .iter()
            .map(|text| text.trim_start_matches('<').to_owned())
            .collect(),
    ];
    lines.extend(rows.into_iter().map(|row| row.as_ref().to_vec()));
    aligned(&lines, &left)
}

/// One line per row; columns are as wide as their widest cell, with two spaces between. Cells are right-aligned, or left-aligned in the
/// columns of `left`. An empty first column indents.
pub fn aligned<L: AsRef<[String]>>(lines: &[L], left: &[usize]) -> String {
    let mut widths = vec![];
    for line in lines {
        for (k, cell) in line.as_ref().iter().enumerate() {
            widths.resize(widths.len().max(k + 1), 0);
            widths[k] = display_width(cell).max(widths[k]);
        }
    }
    let mut text = String::new();
    for line in lines {
        let cells = line.as_ref().iter().zip(&widths).enumerate().map(|(k, (cell, width))| {
            let room = " ".repeat(width - display_width(cell));
            match left.contains(&k) {
                true => format!("{cell}{room}"),
                false => format!("{room}{cell}"),
            }
        });
        text += cells.collect::<Vec<_>>().join("  ").trim_end();
        text.push('\n');
    }
    text
}
