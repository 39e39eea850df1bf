//! Tables as people read them.

use textwrap::core::display_width;

/// A line a row, columns two blanks apart and as wide as their widest cell; cells stand on the right except in the columns of `left`.
/// An empty first column indents.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: columns stand below each other whatever the cells hold, and nothing stands behind the last.
    #[test]
    fn cells_stand_below_each_other() {
        let lines = [["", "name", "size"], ["", "a", "12.5 µm"], ["", "双 u₁", "3"]].map(|l| l.map(String::from));
        let text = aligned(&lines, &[1]);
        assert_eq!(text, "  name      size\n  a      12.5 µm\n  双 u₁        3\n");
        assert_eq!(aligned::<Vec<String>>(&[], &[]), "");
        assert_eq!(
            aligned(&[vec!["a".into()], vec!["b".into(), "c".into()]], &[]),
            "a\nb  c\n"
        );
    }
}
