//! The JSON Schema of a case, generated from [`super::schema`].

use std::sync::LazyLock;

use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform};
use serde_json::{Map, Value, json};

use super::presets::SECTIONS;
use super::schema::Case;
use super::schema_words;

/// JSON Schema (draft 2020-12) of a case file, with descriptions and defaults. With a preset, the keys that it supplies are optional. Every
/// object may have members whose key begins with `//`, as remarks.
pub fn schema_json() -> Value {
    let mut schema = CASE.clone();
    let nothing = Map::new();
    let definitions = CASE["$defs"].as_object().unwrap_or(&nothing);
    let mut parts: Vec<(String, Value)> = vec![];
    for section in SECTIONS {
        let reference = schema["properties"][section]["$ref"].take();
        let name = reference
            .as_str()
            .and_then(|r| r.rsplit('/').next())
            .unwrap_or_default();
        relaxed(name, definitions, &mut parts);
        let partly = json!({"anyOf": [{"$ref": format!("#/$defs/{name}{PARTLY}")}, {"type": "null"}]});
        schema["then"]["properties"][section] = partly;
        schema["else"]["properties"][section] = json!({"$ref": reference});
        if let Some(own) = schema["properties"][section].as_object_mut() {
            own.shift_remove("$ref");
        }
    }
    let (from_preset, needed): (Vec<Value>, Vec<Value>) = schema["required"]
        .as_array()
        .cloned()
        .unwrap_or_default()
        .into_iter()
        .partition(|key| SECTIONS.iter().any(|s| key == s));
    let needed: Vec<Value> = needed.into_iter().filter(|key| key != "ends").collect();
    schema["required"] = needed.into();
    schema["anyOf"] = json!([{"required": ["ends"]}, {"required": ["beams"]}]);
    schema["if"] = json!({"anyOf": [{"required": ["preset"]}, {"required": ["section"]}]});
    schema["else"]["required"] = from_preset.into();
    for (name, part) in parts {
        schema["$defs"][name] = part;
    }
    // a named fluid supplies its numbers
    if let Some(fluid) = schema["$defs"]["Fluid"].as_object_mut()
        && let Some(required) = fluid.shift_remove("required")
    {
        fluid.insert("if".into(), json!({"required": ["preset"]}));
        fluid.insert("else".into(), json!({"required": required}));
    }
    for (_, definition) in schema["$defs"].as_object_mut().into_iter().flatten() {
        // null: computed from the cross-section
        if let Some(kind) = definition.pointer_mut("/properties/permeability_m4/type") {
            *kind = json!(["number", "null"]);
        }
        // bladders of a named beam, "left:3"
        for pointer in ["/properties/bladder/type", "/properties/bladders/items/type"] {
            if let Some(kind) = definition.pointer_mut(pointer).filter(|kind| !kind.is_null()) {
                let mut kinds = kind.as_array().cloned().unwrap_or_else(|| vec![kind.clone()]);
                kinds.push("string".into());
                *kind = kinds.into();
            }
        }
    }
    schema_words::complete(&mut schema, PARTLY);
    remarks(&mut schema);
    schema
}

/// Ending of the names of definitions whose missing keys a preset supplies.
const PARTLY: &str = "OverPreset";

/// Adds the definition without required keys, and those of the objects in it.
fn relaxed(name: &str, definitions: &Map<String, Value>, parts: &mut Vec<(String, Value)>) {
    let Some(definition) = definitions.get(name) else {
        return;
    };
    let mut part = definition.clone();
    if let Some(part) = part.as_object_mut() {
        part.shift_remove("required");
    }
    for (_, inner) in part["properties"].as_object_mut().into_iter().flatten() {
        let Some(reference) = inner["$ref"].as_str().map(str::to_owned) else {
            continue;
        };
        let name = reference.rsplit('/').next().unwrap_or_default();
        if definitions.get(name).is_some_and(|d| d.get("properties").is_some()) {
            inner["$ref"] = format!("{reference}{PARTLY}").into();
            relaxed(name, definitions, parts);
        }
    }
    parts.push((format!("{name}{PARTLY}"), part));
}

/// Permits remarks in every object.
fn remarks(schema: &mut Value) {
    match schema {
        Value::Object(members) => {
            if members.get("additionalProperties") == Some(&Value::Bool(false)) {
                members.insert("patternProperties".into(), json!({"^//": true}));
            }
            members.values_mut().for_each(remarks);
        }
        Value::Array(items) => items.iter_mut().for_each(remarks),
        _ => {}
    }
}

/// Schema of a file with a section: a case with its own one, a case with that of a span, or the section alone.
pub(super) fn section(of_case: bool, of_span: bool) -> Value {
    let section = json!({"$ref": "#/$defs/Section"});
    let holder = |section: &Value| json!({"type": "object", "properties": {"section": section}});
    let mut schema = match (of_case, of_span) {
        (_, true) => json!({"type": "object", "properties": {"spans": {"type": "array", "items": holder(&section)}}}),
        (true, false) => holder(&section),
        (false, false) => section,
    };
    schema["$defs"] = CASE["$defs"].clone();
    schema
}

/// Schema of a case whose preset is filled in and whose remarks are removed.
pub fn schema_of_resolved() -> &'static Value {
    &CASE
}

/// Schema of a case whose preset is filled in, generated once.
pub(super) static CASE: LazyLock<Value> = LazyLock::new(|| {
    let settings = SchemaSettings::draft2020_12();
    let mut schema = settings.into_generator().into_root_schema_for::<Case>();
    RecursiveTransform(tidy).transform(&mut schema);
    let mut rest = std::mem::take(schema.ensure_object());
    let head = ["$schema", "title", "description"];
    let mut ordered: serde_json::Map<_, _> = head
        .into_iter()
        .filter_map(|key| rest.shift_remove_entry(key))
        .collect();
    ordered.extend(rest);
    Value::Object(ordered)
});

/// Removes `null` for absent keys, which serde would accept but a case does not, and formats, which only repeat Rust's types.
fn tidy(schema: &mut schemars::Schema) {
    let Some(object) = schema.as_object_mut() else {
        return;
    };
    object.remove("format");
    object.remove("writeOnly");
    if let Some(Value::String(text)) = object.get_mut("description") {
        *text = text.replace('\n', " ");
    }
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|kind| kind != "null");
        if let [one] = types.as_slice() {
            let one = one.clone();
            object.insert("type".to_owned(), one);
        }
    }
    if let Some(Value::Array(branches)) = object.get_mut("anyOf") {
        branches.retain(|branch| branch.get("type") != Some(&Value::from("null")));
        if let [Value::Object(only)] = branches.as_slice() {
            let only = only.clone();
            object.remove("anyOf");
            object.extend(only);
        }
    }
}
