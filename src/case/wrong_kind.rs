//! Remedies for values of the wrong kind.

use serde_json::{Value, json};

use super::wording::{nearest, quoted};
use super::{schema_words, unknown};

/// Longest example in a remedy [bytes].
const LONGEST: usize = 160;

/// Largest number of bladders in a written-out range.
const MOST: i64 = 40;

/// Parts of a case whose values are uniform along the beam unless a span has others.
const UNIFORM: [&str; 5] = ["beam", "bladders", "fluid", "section", "tubes"];

/// Remedy for a value in place of one number.
fn one_number(pointer: &str) -> String {
    let part = pointer.split('/').nth(1).unwrap_or_default();
    match UNIFORM.contains(&part) {
        true => {
            "expected one number: values that vary along the beam are in /spans, as {\"linear\": [0.02, 0.012]} over a \
                 span; a load varies by its \"profile\""
                .to_owned()
        }
        false => "expected one number, without brackets".to_owned(),
    }
}

/// Remedy for a value of a kind that its place does not allow; `schema` describes the allowed values, `pointer` the place.
pub fn hint(pointer: &str, value: &Value, schema: &Value, branches: &[&Value]) -> Option<String> {
    let key = pointer.rsplit('/').next().unwrap_or_default();
    let kinds = |wanted: &str| branches.iter().any(|branch| branch["type"] == wanted);
    let words: Vec<&str> = branches
        .iter()
        .flat_map(|branch| {
            branch["enum"]
                .as_array()
                .into_iter()
                .flatten()
                .chain(branch.get("const"))
        })
        .filter_map(Value::as_str)
        .collect();
    match value {
        Value::Null => return Some("leave the key out".to_owned()),
        Value::Bool(on) => {
            let word = if *on { "on" } else { "off" };
            if words.contains(&word) {
                return Some(format!("write \"{word}\""));
            }
        }
        Value::String(text) if kinds("boolean") => {
            let meant = match text.to_lowercase().as_str() {
                "true" | "yes" | "on" => Some("true"),
                "false" | "no" | "off" => Some("false"),
                _ => None,
            };
            if let Some(word) = meant {
                return Some(format!("write {word}, without quotes"));
            }
        }
        Value::String(text) if kinds("integer") && text.contains(':') => {
            return Some(format!(
                "{text} is not a bladder: write NAME:3 with the name of a beam in /beams and one of its segments, -3 for the lower row"
            ));
        }
        Value::Array(items) if kinds("number") => {
            if let [one] = &items[..]
                && one.is_number()
            {
                return Some(format!("a single number has no brackets: write {one}"));
            }
            if items.len() > 1 && kinds("object") {
                return Some(
                    "values in time are a table: {\"table\": {\"times_s\": [..], \"values\": [..]}}".to_owned(),
                );
            }
            if items.len() > 1 {
                return Some(one_number(pointer));
            }
        }
        Value::Object(_) if kinds("number") && !kinds("object") && !kinds("array") => return Some(one_number(pointer)),
        _ => {}
    }
    let array = branches.iter().find(|branch| branch["type"] == "array");
    if let Some(items) = array.map(|array| &array["items"]) {
        let whole = items["type"] == "integer";
        match value {
            Value::Number(_) if whole || items["type"] == "number" => return Some(format!("write [{value}]")),
            Value::String(text) if whole => {
                if let Some(list) = listed(text) {
                    return Some(format!("write {list}"));
                }
            }
            Value::Object(_) => return Some("write it between brackets, [{ ... }]: there may be several".to_owned()),
            _ => {}
        }
    }
    let object = branches.iter().find(|branch| branch["type"] == "object")?;
    let preset = &object["properties"]["preset"];
    if let (Value::String(text), true) = (value, preset.is_object()) {
        let names = unknown::resolved(preset);
        let names = names["oneOf"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(|one| one["const"].as_str());
        return Some(match nearest(text, names.clone()) {
            Some(name) => format!("write {{\"preset\": \"{name}\"}}"),
            None => {
                let names: Vec<&str> = names.collect();
                format!("one by name is {{\"preset\": NAME}}, with one of {}", quoted(&names))
            }
        });
    }
    let example = example(key, schema)?;
    let text = example.to_string();
    (text.len() <= LONGEST).then(|| format!("such as {}", spaced(&text)))
}

/// Example of an allowed object.
fn example(key: &str, schema: &Value) -> Option<Value> {
    if key == "gravity" {
        return Some(json!({"x_m_s2": -9.81}));
    }
    let name = schema["$ref"].as_str()?.rsplit('/').next()?;
    schema_words::example_of(name).filter(|example| example.is_object())
}

/// The whole numbers of a text such as `1-10`, `1..10` or `1, 2, 3`, as JSON.
fn listed(text: &str) -> Option<String> {
    let number = |part: &str| part.trim().parse::<i64>().ok();
    let range = ["..", ":", " to ", "-"].iter().find_map(|sign| {
        // a minus sign may belong to a number
        let at = 1 + text.get(1..)?.find(sign)?;
        Some((number(&text[..at])?, number(&text[at + sign.len()..])?))
    });
    let all: Vec<i64> = match range {
        Some((from, to)) if from <= to && to - from < MOST => (from..=to).collect(),
        Some((from, to)) if from > to && from - to < MOST => (to..=from).rev().collect(),
        Some(_) => return None,
        None => text
            .split([',', ' ', ';'])
            .filter(|part| !part.is_empty())
            .map(number)
            .collect::<Option<_>>()?,
    };
    let all: Vec<String> = all.iter().map(i64::to_string).collect();
    (!all.is_empty()).then(|| format!("[{}]", all.join(", ")))
}

/// JSON with spaces after colons and commas; the texts in examples contain neither.
fn spaced(text: &str) -> String {
    text.replace(':', ": ").replace(',', ", ")
}

#[cfg(test)]
mod tests {
    use super::listed;

    #[test]
    fn ranges_are_written_out() {
        assert_eq!(listed("1-3").as_deref(), Some("[1, 2, 3]"));
        assert_eq!(listed("-1--3").as_deref(), Some("[-1, -2, -3]"));
        assert_eq!(listed("1, 4").as_deref(), Some("[1, 4]"));
        assert_eq!(listed("3..1").as_deref(), Some("[3, 2, 1]"));
        for text in ["", "all", "1-1000000", "é-3"] {
            assert_eq!(listed(text), None, "{text}");
        }
    }
}
