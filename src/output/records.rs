//! Words and numbers as the text of a CSV file.

use super::numbers::shortest;

/// First characters by which a spreadsheet takes a cell for a formula.
const FORMULAS: [char; 4] = ['=', '+', '-', '@'];

/// A cell of text that no spreadsheet evaluates: an apostrophe stands before it where it begins like a formula and is no number.
pub fn cell(text: String) -> String {
    match text.starts_with(FORMULAS) && text.parse::<f64>().is_err() {
        true => format!("'{text}"),
        false => text,
    }
}

/// Headings, then rows of as many cells. A cell is quoted where it would not read back as it is, and no text of it is a formula.
pub fn text<C: AsRef<[u8]>>(
    headings: impl IntoIterator<Item = C>,
    rows: impl IntoIterator<Item = Vec<String>>,
) -> String {
    // rows are written as they come, and memory takes everything: nothing here fails
    let mut out = csv::WriterBuilder::new().flexible(true).from_writer(vec![]);
    let _ = out.write_record(headings);
    for row in rows {
        let _ = out.write_record(row.into_iter().map(cell));
    }
    String::from_utf8(out.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// A number; empty when unknown or not finite.
pub fn number(x: Option<f64>) -> String {
    x.filter(|x| x.is_finite()).map_or_else(String::new, shortest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_is_a_formula() {
        let row = ["=1+1", "+x", "-cmd", "@a", "-1.5e-3", "+2", "plain", "a,b"]
            .map(String::from)
            .to_vec();
        assert_eq!(
            text(["first"], [row]),
            "first\n'=1+1,'+x,'-cmd,'@a,-1.5e-3,+2,plain,\"a,b\"\n"
        );
    }
}
