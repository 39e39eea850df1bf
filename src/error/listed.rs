//! Lists of names in messages, limited in number and length.

use super::visible;

/// Largest number of names listed.
const NAMES: usize = 20;
/// Largest number of characters shown of a name.
const CHARACTERS: usize = 60;

/// Joins the first names with commas and appends the number of those left out. Each name is formatted by [`shown`].
pub fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names = names.into_iter();
    let first: Vec<String> = names.by_ref().take(NAMES).map(shown).collect();
    let more = match names.count() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    first.join(", ") + &more
}

/// Escapes the hidden characters of a name and truncates a long name.
pub fn shown(name: &str) -> String {
    match name.char_indices().nth(CHARACTERS) {
        Some((end, _)) => format!("{}...", visible(&name[..end])),
        None => visible(name).into_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: a message stays short, whatever the number and length of names.
    #[test]
    fn lists_and_names_are_bounded() {
        assert_eq!(listed(["a", "b"]), "a, b");
        let many: Vec<String> = (0..10_000).map(|k| format!("{k}{}", "ä".repeat(1000))).collect();
        let text = listed(many.iter().map(String::as_str));
        assert!(
            text.chars().count() < 1400 && text.ends_with(" and 9980 more"),
            "{text}"
        );
    }
}
