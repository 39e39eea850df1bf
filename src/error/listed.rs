//! Names of others in a message: as many as are read.

use super::visible;

/// Names that are listed at most.
const NAMES: usize = 20;
/// Characters of a name that are shown.
const CHARACTERS: usize = 60;

/// The first names of a list with commas between, each made visible and cut where it is long, and how many more there are.
pub fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names = names.into_iter();
    let first: Vec<String> = names.by_ref().take(NAMES).map(shown).collect();
    let more = match names.count() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    first.join(", ") + &more
}

/// A name made visible, and cut where it is long.
pub fn shown(name: &str) -> String {
    match name.char_indices().nth(CHARACTERS) {
        Some((end, _)) => format!("{}...", visible(&name[..end])),
        None => visible(name).into_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: a message stays short however many names there are, and however long they are.
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
