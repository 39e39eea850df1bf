//! The JSON Schema of a case, generated from [`super::schema`].

use std::sync::LazyLock;

use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform};
use serde_json::Value;

use super::schema::Case;

/// JSON Schema (draft 2020-12) of a case, with descriptions and defaults.
pub fn schema_json() -> Value {
    CASE.clone()
}

/// The same, made once.
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

/// What serde would take but a case does not: `null` for an absent key. And formats, which only repeat Rust's types.
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
