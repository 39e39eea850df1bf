//! The case as rows of a table: what each number is, by the descriptions of its schema.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::{Value, json};

use crate::case::schema_json;
use crate::output::numbers::{quantity, significant, trimmed};

/// Longest text of a value.
const LONGEST: usize = 400;

/// Rows `{group, key, pointer, value, about}` of a case's text; none when it is no JSON.
pub fn rows(text: &str) -> Vec<Value> {
    let Ok(case) = serde_json::from_str::<Value>(text) else {
        return vec![];
    };
    // The program's own schema is one.
    let schema: Schema = serde_json::from_value(schema_json()).unwrap_or_default();
    let mut out = vec![];
    if let Value::Object(all) = &case {
        for (key, value) in all {
            if !matches!(key.as_str(), "$schema" | "name" | "about") {
                let own = schema.property(&schema, key);
                walk(value, own, &schema, key, &format!("/{key}"), &mut out);
            }
        }
    }
    out
}

fn walk(value: &Value, schema: Option<&Schema>, root: &Schema, group: &str, pointer: &str, out: &mut Vec<Value>) {
    let about = schema.map_or(String::new(), |s| s.described(root));
    if let Value::Object(all) = value
        && !all.is_empty()
        && depth(value) <= 3
        && schema.is_some()
    {
        for (key, inner) in all {
            let own = schema.and_then(|s| s.property(root, key));
            walk(inner, own, root, group, &format!("{pointer}/{key}"), out);
        }
        return;
    }
    let (words, unit) = split_unit(&about);
    out.push(json!({
        "group": group, "pointer": pointer, "value": shown(value, &unit), "about": words,
    }));
}

/// Levels of objects and arrays in a value.
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

/// A number without the zeros behind its point: `20`, `1.55·10⁻¹²`, `100 mm`.
fn number(x: f64, unit: &str) -> String {
    let text = match unit {
        "" | "1" => significant(x, 6),
        unit => quantity(x, unit, 6),
    };
    let at = text.find(['·', ' ']).unwrap_or(text.len());
    let (digits, rest) = text.split_at(at);
    format!("{}{rest}", trimmed(digits))
}

/// What of a schema says what keys mean.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Schema {
    #[serde(rename = "$ref")]
    reference: Option<String>,
    #[serde(rename = "$defs")]
    definitions: BTreeMap<String, Schema>,
    description: Option<String>,
    properties: BTreeMap<String, Schema>,
    #[serde(rename = "else")]
    otherwise: Option<Box<Schema>>,
    any_of: Vec<Schema>,
    one_of: Vec<Schema>,
    all_of: Vec<Schema>,
}

impl Schema {
    /// The schema behind a reference.
    fn resolved<'a>(&'a self, root: &'a Self) -> &'a Self {
        let name = self.reference.as_ref().and_then(|r| r.strip_prefix("#/$defs/"));
        name.and_then(|name| root.definitions.get(name)).unwrap_or(self)
    }

    /// Schema of a key, in the object itself or in one of its alternatives.
    fn property<'a>(&'a self, root: &'a Self, key: &str) -> Option<&'a Self> {
        let schema = self.resolved(root);
        // A resolved case names no preset: what holds without one comes first.
        let whole = schema.otherwise.as_ref().and_then(|s| s.properties.get(key));
        if let Some(own) = whole.or_else(|| schema.properties.get(key)) {
            return Some(own);
        }
        let mut branches = [&schema.any_of, &schema.one_of, &schema.all_of].into_iter().flatten();
        branches.find_map(|branch| branch.property(root, key))
    }

    fn described(&self, root: &Self) -> String {
        let own = self.description.as_ref().or(self.resolved(root).description.as_ref());
        own.map_or(String::new(), |text| text.replace('`', ""))
    }
}

/// `Length [m].` into words and unit.
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
