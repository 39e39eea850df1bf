//! Common mistakes in JSON texts, and their intended meaning: numbers, words and quotes.

use crate::case::amounts;
use crate::case::unit_mistakes::number_of;
use crate::case::wording::short;

/// Typographic minus signs and dashes.
pub const MINUS: [char; 2] = ['−', '–'];

/// Typographic quotes, each with its closing quotes.
const QUOTES: [(char, &str); 8] = [
    ('“', "”“\""),
    ('”', "”“\""),
    ('„', "“”\""),
    ('«', "»\""),
    ('»', "«\""),
    ('‘', "’‘"),
    ('’', "’‘"),
    ('‚', "‘’"),
];

/// Spaces and quotes that separate the digit groups of long numbers.
const BETWEEN: [char; 6] = [' ', '\u{a0}', '\u{2009}', '\u{202f}', '\'', '’'];

/// A mistake at the beginning of a text, and its remedy.
pub struct Slip {
    /// Length of the faulty text [bytes].
    pub bytes: usize,
    /// Description of the mistake.
    pub what: String,
    /// Remedy.
    pub hint: String,
}

/// First line of a text, up to the end of a value.
fn value(text: &str) -> &str {
    let end = text.find([',', '}', ']', '{', '[', ':', '\n', '\r', '\t']);
    text[..end.unwrap_or(text.len())].trim_end()
}

/// A word of at least `least` bytes, with the words after it in the same value.
pub fn with_following_words(text: &str, least: usize) -> &str {
    let whole = value(text);
    if whole.len() < least { &text[..least] } else { whole }
}

/// Detects a number followed by characters that no number has: a unit, more digits, an operation. `text` begins with the number.
pub fn behind_number(number: &str, text: &str, pointer: &str) -> Option<Slip> {
    let whole = value(text);
    let rest = whole.get(number.len()..)?;
    let behind = rest.trim_start().chars().next()?;
    let slip = |bytes: usize, what: String, hint: String| Some(Slip { bytes, what, hint });
    let last = pointer.rsplit('/').next().filter(|part| !part.is_empty());
    if let Some((bytes, joined)) = grouped(whole) {
        return slip(
            bytes,
            format!("{} is not a JSON number", short(&whole[..bytes])),
            match last.is_some_and(|part| part.bytes().all(|b| b.is_ascii_digit())) {
                true => format!("write commas between numbers, or {joined}, without separators between digits"),
                false => format!("write {joined}, without separators between digits"),
            },
        );
    }
    if "/*".contains(behind) && !rest.trim_start().starts_with("//") && !rest.trim_start().starts_with("/*") {
        let operand = rest.trim_start()[1..].trim();
        let what = format!("`{}`: JSON has no arithmetic", short(whole));
        let result = match (number.parse::<f64>(), operand.parse::<f64>()) {
            (Ok(a), Ok(b)) if behind == '/' && b != 0.0 => Some(a / b),
            (Ok(a), Ok(b)) if behind == '*' => Some(a * b),
            _ => None,
        };
        let hint = result.map_or("write the result".into(), |x| format!("write {}", number_of(x)));
        return slip(whole.len(), what, hint);
    }
    let unit = behind.is_alphabetic() || "%°".contains(behind);
    unit.then(|| {
        let hint = amounts::remedy(pointer, whole);
        let hint = hint.unwrap_or_else(|| "write the number without a unit; the key names the unit".into());
        Slip {
            bytes: whole.len(),
            what: format!("`{}` is not a JSON value", short(whole)),
            hint,
        }
    })
}

/// Reads a number whose digits are in groups of three: its length [bytes], and the number without separators.
pub fn grouped(text: &str) -> Option<(usize, String)> {
    let sign = text.len() - text.trim_start_matches(['-', '+']).len();
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let first = digits(&text[sign..]);
    if !(1..=3).contains(&first) {
        return None;
    }
    let mut end = sign + first;
    let mut joined = text[..end].to_owned();
    while let Some(between) = text[end..].chars().next().filter(|c| BETWEEN.contains(c) || *c == '_') {
        let start = end + between.len_utf8();
        if digits(&text[start..]) != 3 {
            break;
        }
        joined += &text[start..start + 3];
        end = start + 3;
    }
    if joined.len() == sign + first {
        return None;
    }
    // decimals after the groups
    if text[end..].starts_with('.') {
        let decimals = 1 + digits(&text[end + 1..]);
        joined += &text[end..end + decimals];
        end += decimals;
    }
    Some((end, joined.trim_start_matches('+').to_owned()))
}

/// Possible values of a number with commas or several points: `1,5`, `60,000`, `1,234,567`, `60.000,5`. There are two if a comma may
/// separate decimals or thousands.
pub fn loose(text: &str) -> Vec<String> {
    let unsigned = text.trim_start_matches(['-', '+']);
    let sign = if text.starts_with('-') { "-" } else { "" };
    let groups = |text: &str, between: char| {
        let mut parts = text.split(between);
        let first = parts.next().unwrap_or_default();
        let three = |part: &str| part.len() == 3 && part.bytes().all(|b| b.is_ascii_digit());
        let whole = (1..=3).contains(&first.len()) && first.bytes().all(|b| b.is_ascii_digit());
        (whole && text.contains(between) && parts.all(three)).then(|| text.replace(between, ""))
    };
    let number = |text: String| {
        text.parse::<f64>()
            .is_ok_and(f64::is_finite)
            .then(|| format!("{sign}{text}"))
    };
    let readings: Vec<Option<String>> = match unsigned.rsplit_once([',', '.']) {
        // one sign separates decimals, another thousands
        Some((before, decimals)) if before.contains([',', '.']) && !decimals.is_empty() => {
            let last = unsigned.as_bytes()[before.len()] as char;
            let other = if last == ',' { '.' } else { ',' };
            match before.contains(last) {
                true => vec![groups(unsigned, last)],
                false => vec![groups(before, other).map(|joined| format!("{joined}.{decimals}"))],
            }
        }
        Some(_) if unsigned.contains(',') => {
            let decimal = unsigned.replacen(',', ".", 1);
            let leads = !unsigned.starts_with("0,");
            vec![Some(decimal), groups(unsigned, ',').filter(|_| leads)]
        }
        _ => vec![],
    };
    readings.into_iter().flatten().filter_map(number).collect()
}

/// Remedy for a number as [`loose`] reads it.
pub fn loosely(text: &str) -> Option<String> {
    match &loose(text)[..] {
        [one] => Some(match *one == text.replacen(',', ".", 1) {
            true => format!("write {one}, with a decimal point"),
            false => format!("write {one}, without separators between digits"),
        }),
        [one, other] => Some(format!(
            "{text} is ambiguous: {one} or {other}. Write the intended number"
        )),
        _ => None,
    }
}

/// Remedy for a word that is not a JSON value.
pub fn word(word: &str, pointer: &str) -> String {
    if let Some((_, joined)) = grouped(word).filter(|(bytes, _)| *bytes == word.len()) {
        return format!("write {joined}, without separators between digits");
    }
    if let Some(hint) = amounts::remedy(pointer, word) {
        return hint;
    }
    match word.to_lowercase().as_str() {
        "true" => "write true, in small letters".into(),
        "false" => "write false, in small letters".into(),
        "none" | "null" | "nil" | "undefined" => "write null, or leave the key out".into(),
        _ if word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) => {
            "write the number without a unit; the key names the unit".into()
        }
        _ => "text needs double quotes".into(),
    }
}

/// Detects a text between quotes that are not JSON quotes.
pub fn quoted(text: &str) -> Option<Slip> {
    let open = text.chars().next()?;
    let (_, closing) = QUOTES.iter().find(|(quote, _)| *quote == open)?;
    let line = text.lines().next().unwrap_or(text);
    let inner = &line[open.len_utf8()..];
    let close = inner.find(|c| closing.contains(c));
    let text = &inner[..close.unwrap_or(0)];
    let last = close
        .and_then(|at| inner[at..].chars().next())
        .map_or(0, char::len_utf8);
    Some(Slip {
        bytes: open.len_utf8() + text.len() + last,
        what: format!("`{open}` is not a JSON double quote"),
        hint: match close {
            Some(_) => format!("write \"{}\" in straight quotes", short(text)),
            None => "write straight quotes, \"".into(),
        },
    })
}

/// First quote in a text that is not a JSON quote and seems to close it.
pub fn closed_otherwise(text: &str) -> Option<char> {
    text.chars().find(|c| QUOTES.iter().any(|(quote, _)| quote == c))
}

#[cfg(test)]
mod tests {
    use super::{behind_number, grouped, loose};

    #[test]
    fn groups_of_digits_are_numbers() {
        for (text, bytes, joined) in [
            ("60 000", 6, "60000"),
            ("-1 234 567.5", 12, "-1234567.5"),
            ("60_000", 6, "60000"),
            ("60\u{202f}000 ", 8, "60000"),
        ] {
            assert_eq!(grouped(text), Some((bytes, joined.to_owned())), "{text}");
        }
        for text in ["60", "60 00", "6000 000", "", "-", "60,000"] {
            assert_eq!(grouped(text), None, "{text}");
        }
    }

    #[test]
    fn commas_have_the_readings_that_they_may_have() {
        for (text, readings) in [
            ("1,5", &["1.5"][..]),
            ("1,5e6", &["1.5e6"]),
            ("0,125", &["0.125"]),
            ("60,000", &["60.000", "60000"]),
            ("-60,000", &["-60.000", "-60000"]),
            ("1,234,567", &["1234567"]),
            ("2.000.000", &["2000000"]),
            ("60.000,5", &["60000.5"]),
            ("60,000.5", &["60000.5"]),
            ("60000", &[]),
            ("1.5", &[]),
            ("1,2,3", &[]),
            ("1,x", &[]),
        ] {
            assert_eq!(loose(text), readings, "{text}");
        }
    }

    #[test]
    fn text_behind_a_number_is_reported() {
        for (number, text, bytes, hint) in [
            ("1", "1/10, 2", 4, "write 0.1"),
            ("2", "2 * 1e-3}", 8, "write 0.002"),
            (
                "60",
                "60 kPa}",
                6,
                "60 kPa is 60000 here: write the number alone, the key has the unit",
            ),
        ] {
            let slip = behind_number(number, text, "/a/pressure_pa").expect(text);
            assert_eq!((slip.bytes, slip.hint.as_str()), (bytes, hint), "{text}");
        }
        // several numbers of an array may be intended
        let slip = behind_number("100", "100 200]", "/a/values/0").expect("a slip");
        assert!(slip.hint.contains("commas between numbers"), "{}", slip.hint);
        for (number, text) in [
            ("1", "1, 2"),
            ("1", "1"),
            ("1", "1 // a remark"),
            ("1", "1 /* a remark */"),
        ] {
            assert!(behind_number(number, text, "").is_none(), "{text}");
        }
    }
}
