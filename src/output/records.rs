//! Words and numbers as the text of a CSV file.

use super::numbers::shortest;

/// Headings, then rows of as many cells. A cell is quoted where it would not read back as it is.
pub fn text<C: AsRef<[u8]>>(
    headings: impl IntoIterator<Item = C>,
    rows: impl IntoIterator<Item = Vec<String>>,
) -> String {
    // rows are written as they come, and memory takes everything: nothing here fails
    let mut out = csv::WriterBuilder::new().flexible(true).from_writer(vec![]);
    let _ = out.write_record(headings);
    for row in rows {
        let _ = out.write_record(row);
    }
    String::from_utf8(out.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// A number; empty when unknown or not finite.
pub fn number(x: Option<f64>) -> String {
    x.filter(|x| x.is_finite()).map_or_else(String::new, shortest)
}
