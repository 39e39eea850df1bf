//! Text and numbers as CSV.

use super::numbers::shortest;

/// First characters that make a spreadsheet evaluate a cell as a formula.
const FORMULAS: [char; 4] = ['=', '+', '-', '@'];

/// A text cell that no spreadsheet evaluates: an apostrophe precedes text that begins like a formula and is not a number.
pub fn cell(text: String) -> String {
    match text.starts_with(FORMULAS) && text.parse::<f64>().is_err() {
        true => format!("'{text}"),
        false => text,
    }
}

/// CSV text of headings and rows. Cells are quoted if necessary, and no text is a formula.
pub fn text<C: AsRef<[u8]>>(
    headings: impl IntoIterator<Item = C>,
    rows: impl IntoIterator<Item = Vec<String>>,
) -> String {
    // rows may differ in length, and memory accepts all text: nothing here fails
    let mut out = csv::WriterBuilder::new().flexible(true).from_writer(vec![]);
    let _ = out.write_record(headings);
    for row in rows {
        let _ = out.write_record(row.into_iter().map(cell));
    }
    String::from_utf8(out.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// Text of a number; empty if unknown or not finite.
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
