//! The case as rows of a table; descriptions of the schema explain each number.

use serde_json::{Value, json};

use crate::case::schema_of_resolved;
use crate::output::numbers::{quantity, significant, trimmed};

/// Largest length of the text of a value.
const LONGEST: usize = 400;

/// Rows `{group, key, pointer, value, about}` of a case's text; empty if it is not JSON.
pub fn rows(text: &str) -> Vec<Value> {
    let Ok(case) = serde_json::from_str::<Value>(text) else {
        return vec![];
    };
    let schema = Schema::new(schema_of_resolved());
    let mut out = vec![];
    if let Value::Object(all) = &case {
        for (key, value) in all {
            if !matches!(key.as_str(), "$schema" | "name" | "about") {
                walk(value, schema.property(key), key, &format!("/{key}"), &mut out);
            }
        }
    }
    out
}

fn walk(value: &Value, schema: Option<Schema>, group: &str, pointer: &str, out: &mut Vec<Value>) {
    let about = schema.map_or(String::new(), Schema::described);
    if let (Value::Object(all), Some(schema)) = (value, schema)
        && !all.is_empty()
        && depth(value) <= 3
    {
        for (key, inner) in all {
            walk(inner, schema.property(key), group, &format!("{pointer}/{key}"), out);
        }
        return;
    }
    let (words, unit) = split_unit(&about);
    out.push(json!({
        "group": group, "pointer": pointer, "value": shown(value, &unit), "about": words,
    }));
}

/// Depth of nested objects and arrays in a value.
fn depth(value: &Value) -> usize {
    match value {
        Value::Object(all) => 1 + all.values().map(depth).max().unwrap_or(0),
        Value::Array(all) => 1 + all.iter().map(depth).max().unwrap_or(0),
        _ => 0,
    }
}

fn shown(value: &Value, unit: &str) -> String {
    match value {
        Value::Number(x) => match x.as_f64() {
            Some(x) => number(x, unit),
            None => x.to_string(),
        },
        Value::String(text) => text.clone(),
        Value::Bool(yes) => if *yes { "yes" } else { "no" }.into(),
        Value::Null => "–".into(),
        other => {
            let text = other.to_string().replace(',', ", ");
            match text.char_indices().nth(LONGEST) {
                Some((at, _)) => format!("{} …", &text[..at]),
                None => text,
            }
        }
    }
}

/// A number without trailing zeros behind the decimal point: `20`, `1.55·10⁻¹²`, `100 mm`.
fn number(x: f64, unit: &str) -> String {
    let text = match unit {
        "" | "1" => significant(x, 6),
        unit => quantity(x, unit, 6),
    };
    let at = text.find(['·', ' ']).unwrap_or(text.len());
    let (digits, rest) = text.split_at(at);
    format!("{}{rest}", trimmed(digits))
}

/// A part of a schema, with the descriptions of keys.
#[derive(Clone, Copy)]
struct Schema<'a> {
    part: &'a Value,
    definitions: &'a Value,
}

impl<'a> Schema<'a> {
    fn new(whole: &'a Value) -> Self {
        Self {
            part: whole,
            definitions: &whole["$defs"],
        }
    }

    /// Follows a reference.
    fn resolved(self) -> Self {
        let name = self.part["$ref"].as_str().and_then(|r| r.strip_prefix("#/$defs/"));
        let part = name.and_then(|name| self.definitions.get(name)).unwrap_or(self.part);
        Self { part, ..self }
    }

    /// Schema of a key, in the object itself or in one of its alternatives.
    fn property(self, key: &str) -> Option<Self> {
        let own = self.resolved();
        if let Some(part) = own.part["properties"].get(key) {
            return Some(Self { part, ..own });
        }
        let alternatives = ["anyOf", "oneOf", "allOf"]
            .into_iter()
            .filter_map(|of| own.part[of].as_array());
        alternatives
            .flatten()
            .find_map(|part| Self { part, ..own }.property(key))
    }

    fn described(self) -> String {
        let text = |one: Self| one.part["description"].as_str();
        text(self)
            .or(text(self.resolved()))
            .unwrap_or_default()
            .replace('`', "")
    }
}

/// Splits `Length [m].` into text and unit.
fn split_unit(about: &str) -> (String, String) {
    let Some((before, rest)) = about.split_once(" [") else {
        return (about.into(), String::new());
    };
    match rest.split_once(']') {
        Some((unit, after)) if unit.len() < 16 => (format!("{before}{after}"), unit.into()),
        _ => (about.into(), String::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_a_case_have_words_and_units() {
        let rows =
            rows(r#"{"name": "x", "beam": {"length_m": 0.1, "young_modulus_pa": 2e6}, "ends": {"root": "clamped"}}"#);
        let row = |pointer: &str| rows.iter().find(|r| r["pointer"] == pointer).expect(pointer);
        assert_eq!(row("/beam/length_m")["value"], "100 mm");
        assert!(!row("/beam/length_m")["about"].as_str().expect("text").is_empty());
        assert_eq!(row("/beam/young_modulus_pa")["value"], "2 MPa");
        assert_eq!(row("/ends/root")["value"], "clamped");
    }
}
