//! Descriptions of all keys, from the schema.

use serde_json::Value;

use super::schema_json;

/// One key of a case, or one word that is a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyDescription {
    /// The key.
    pub name: String,
    /// Object and key, such as `Bladders/length_m`; `/name` for keys of the case itself.
    pub place: String,
    /// Description with unit, symbol and default.
    pub meaning: String,
    /// Objects that the value may be, by the names that begin the places of their keys.
    pub objects: Vec<String>,
}

/// All keys, in the order of the schema.
pub fn meanings() -> Vec<KeyDescription> {
    let schema = &*schema_json::CASE;
    let mut all = vec![];
    walk(schema, "", &mut all);
    for (name, part) in schema["$defs"].as_object().into_iter().flatten() {
        walk(part, name, &mut all);
    }
    all
}

fn walk(part: &Value, place: &str, all: &mut Vec<KeyDescription>) {
    let text = |value: &Value| value["description"].as_str().unwrap_or_default().to_owned();
    for (name, inner) in part["properties"].as_object().into_iter().flatten() {
        let place = format!("{place}/{name}");
        // A form such as {"sine": ...} is described beside its only key.
        let mut meaning = match text(inner) {
            own if own.is_empty() => text(part),
            own => own,
        };
        if let Some(default) = inner.get("default").filter(|d| d.is_number() || d.is_string()) {
            meaning += &format!(" Default: {default}.");
        }
        all.push(KeyDescription {
            name: name.clone(),
            place: place.clone(),
            meaning,
            objects: objects(inner),
        });
        walk(inner, &place, all);
    }
    for branch in ["oneOf", "anyOf"].iter().filter_map(|k| part[k].as_array()).flatten() {
        if let Some(word) = branch["const"].as_str() {
            all.push(KeyDescription {
                name: word.to_owned(),
                place: format!("{place} \"{word}\""),
                meaning: text(branch),
                objects: vec![],
            });
        }
        walk(branch, place, all);
    }
}

/// Definitions that a value, or its entries, may be.
fn objects(inner: &Value) -> Vec<String> {
    let alternatives = inner["anyOf"].as_array().into_iter().flatten();
    [inner, &inner["items"]]
        .into_iter()
        .chain(alternatives)
        .filter_map(|one| one["$ref"].as_str()?.rsplit('/').next().map(str::to_owned))
        .collect()
}
