//! Texts of the schema for readers and editors: a title for every alternative, a description for every key, an example for every object.

use std::sync::LazyLock;

use serde_json::{Map, Value, json};

/// An example for each definition, by its name.
static EXAMPLES: LazyLock<Map<String, Value>> =
    LazyLock::new(|| serde_json::from_str(include_str!("examples.json")).unwrap_or_default());

/// Completes a schema. `ending` is the ending of the names of definitions whose missing keys a preset supplies.
pub fn complete(schema: &mut Value, ending: &str) {
    for choice in ["then", "else"] {
        let texts = schema["properties"].clone();
        let sections = schema.get_mut(choice).map(members);
        for (key, section) in sections.into_iter().flatten() {
            describe(section, texts[key]["description"].as_str());
            alternatives(section);
        }
    }
    for (name, definition) in schema
        .get_mut("$defs")
        .and_then(Value::as_object_mut)
        .into_iter()
        .flatten()
    {
        alternatives(definition);
        branches(definition, name);
        // a complete example also serves the definition that a preset completes
        example(definition, name.trim_end_matches(ending));
    }
    example(schema, "Case");
}

/// The example for a definition.
pub fn example_of(name: &str) -> Option<Value> {
    EXAMPLES.get(name).cloned()
}

fn example(schema: &mut Value, name: &str) {
    if let Some(example) = EXAMPLES.get(name) {
        schema["examples"] = json!([example]);
    }
}

/// Adds an example to every alternative that is an object of one key: its own, such as `Signal/sum`, or that of the definition at the key.
fn branches(schema: &mut Value, name: &str) {
    let forms = schema.get_mut("oneOf").and_then(Value::as_array_mut);
    for branch in forms.into_iter().flatten() {
        let Some((key, form)) = members(branch).next() else {
            continue;
        };
        let of_form = form["$ref"].as_str().and_then(|at| at.rsplit('/').next());
        let own = EXAMPLES.get(&format!("{name}/{key}"));
        if let Some(example) = own.or_else(|| EXAMPLES.get(of_form?)) {
            let example = json!({key.as_str(): example});
            branch["examples"] = json!([example]);
        }
    }
}

fn describe(schema: &mut Value, text: Option<&str>) {
    if let (Some(own), Some(text)) = (schema.as_object_mut(), text) {
        own.entry("description").or_insert_with(|| text.into());
    }
}

/// Marks alternatives as exclusive and gives them titles. They are of different types, words, or objects with different keys. An editor can
/// thus identify the intended alternative by its title, and report the faults of that one.
fn alternatives(schema: &mut Value) {
    if let Some(Value::Array(branches)) = schema.as_object_mut().and_then(|own| own.shift_remove("anyOf")) {
        let inner = |branch: Value| match &branch["oneOf"] {
            Value::Array(forms) if branch.get("properties").is_none() => forms.clone(),
            _ => vec![branch],
        };
        let all: Vec<Value> = branches.into_iter().flat_map(inner).collect();
        schema["oneOf"] = all.into();
    }
    for branch in schema
        .get_mut("oneOf")
        .and_then(Value::as_array_mut)
        .into_iter()
        .flatten()
    {
        let text = branch["description"].as_str().map(str::to_owned);
        let single = members(branch).count() == 1;
        members(branch)
            .filter(|_| single)
            .for_each(|(_, form)| describe(form, text.as_deref()));
        if let (Some(title), Some(own)) = (title(branch), branch.as_object_mut()) {
            own.entry("title").or_insert(title.into());
        }
    }
    members(schema).for_each(|(_, property)| alternatives(property));
}

/// Keys of an object with their schemas.
fn members(schema: &mut Value) -> impl Iterator<Item = (&String, &mut Value)> {
    let properties = schema.get_mut("properties").and_then(Value::as_object_mut);
    properties.into_iter().flatten()
}

/// Title of an alternative: its word, its key, or its type.
fn title(branch: &Value) -> Option<String> {
    if let Some(word) = branch["const"].as_str() {
        return Some(format!("\"{word}\""));
    }
    if let Some(words) = branch["enum"].as_array() {
        let words: Vec<String> = words.iter().map(Value::to_string).collect();
        return Some(words.join(", "));
    }
    if let Some(properties) = branch["properties"].as_object() {
        let keys: Vec<&str> = properties.keys().map(String::as_str).collect();
        return Some(keys.join(", "));
    }
    if let Some(reference) = branch["$ref"].as_str() {
        return reference.rsplit('/').next().map(str::to_owned);
    }
    let kind = match branch["type"].as_str()? {
        "number" => "a number",
        "integer" => "a whole number",
        "array" => "a list",
        "string" => "a word",
        "object" => "an object",
        "boolean" => "true or false",
        "null" => "nothing",
        _ => return None,
    };
    Some(kind.into())
}
