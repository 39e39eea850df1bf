//! JSON with places: every value and key stores its byte range in the text. A fault that is found later, by its JSON pointer, can thus be
//! shown at its place.

use std::ops::Range;

use serde_json::{Map, Number, Value};

/// A JSON value and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct JsonNode {
    /// Byte range of the value.
    pub span: Range<usize>,
    /// Kind and content of the value.
    pub kind: JsonKind,
}

/// The kinds of JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum JsonKind {
    /// `null`, and the replacement of an invalid number.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A finite number.
    Number(Number),
    /// A text.
    String(String),
    /// Values in order.
    Array(Vec<JsonNode>),
    /// Members in order, no key twice.
    Object(Vec<JsonMember>),
}

/// One member of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct JsonMember {
    /// The key.
    pub key: String,
    /// Byte range of the key, with its quotes.
    pub key_span: Range<usize>,
    /// The value.
    pub value: JsonNode,
}

/// Place of a value.
#[derive(Clone, Debug, PartialEq)]
pub struct JsonPlace {
    /// Byte range of the key, if the value is a member of an object.
    pub key: Option<Range<usize>>,
    /// Byte range of the value.
    pub value: Range<usize>,
}

impl JsonNode {
    /// The value without places.
    pub fn to_value(&self) -> Value {
        match &self.kind {
            JsonKind::Null => Value::Null,
            JsonKind::Bool(b) => Value::Bool(*b),
            JsonKind::Number(n) => Value::Number(n.clone()),
            JsonKind::String(s) => Value::String(s.clone()),
            JsonKind::Array(items) => items.iter().map(JsonNode::to_value).collect(),
            JsonKind::Object(members) => {
                let members = members.iter().map(|m| (m.key.clone(), m.value.to_value()));
                Value::Object(members.collect::<Map<_, _>>())
            }
        }
    }

    /// Place of the value at a JSON pointer.
    pub fn place(&self, pointer: &str) -> Option<JsonPlace> {
        let mut place = JsonPlace {
            key: None,
            value: self.span.clone(),
        };
        let mut node = self;
        for token in tokens(pointer) {
            let key;
            (node, key) = match &node.kind {
                JsonKind::Array(items) => (items.get(token.parse::<usize>().ok()?)?, None),
                JsonKind::Object(members) => {
                    let member = members.iter().find(|m| m.key == token)?;
                    (&member.value, Some(member.key_span.clone()))
                }
                _ => return None,
            };
            place = JsonPlace {
                key,
                value: node.span.clone(),
            };
        }
        Some(place)
    }
}

/// The unescaped parts of a JSON pointer.
pub fn tokens(pointer: &str) -> impl Iterator<Item = String> {
    pointer
        .split('/')
        .skip(1)
        .map(|token| token.replace("~1", "/").replace("~0", "~"))
}

/// Pointer of a member or item of the value at `pointer`.
pub fn child(pointer: &str, token: impl std::fmt::Display) -> String {
    format!("{pointer}/{}", token.to_string().replace('~', "~0").replace('/', "~1"))
}
