//! JSON with places: every value and key remembers its bytes in the text, so that a fault found later, by its
//! JSON pointer, can still be shown where it was written.

use std::ops::Range;

use serde_json::{Map, Number, Value};

/// A JSON value and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Bytes of the value.
    pub span: Range<usize>,
    /// What it is.
    pub kind: Kind,
}

/// The kinds of JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// `null`, and what stands in for a number that is none.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A finite number.
    Number(Number),
    /// A text.
    String(String),
    /// Values in order.
    Array(Vec<Node>),
    /// Members in order, no key twice.
    Object(Vec<Member>),
}

/// One member of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// The key.
    pub key: String,
    /// Its bytes, quotes included.
    pub key_span: Range<usize>,
    /// The value.
    pub value: Node,
}

/// Where a pointer leads.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The key, when the value is a member of an object.
    pub key: Option<Range<usize>>,
    /// The value.
    pub value: Range<usize>,
}

impl Node {
    /// The value without places.
    pub fn to_value(&self) -> Value {
        match &self.kind {
            Kind::Null => Value::Null,
            Kind::Bool(b) => Value::Bool(*b),
            Kind::Number(n) => Value::Number(n.clone()),
            Kind::String(s) => Value::String(s.clone()),
            Kind::Array(items) => items.iter().map(Node::to_value).collect(),
            Kind::Object(members) => {
                let members = members.iter().map(|m| (m.key.clone(), m.value.to_value()));
                Value::Object(members.collect::<Map<_, _>>())
            }
        }
    }

    /// Where the value at a JSON pointer stands.
    pub fn place(&self, pointer: &str) -> Option<Place> {
        let mut place = Place {
            key: None,
            value: self.span.clone(),
        };
        let mut node = self;
        for token in tokens(pointer) {
            let key;
            (node, key) = match &node.kind {
                Kind::Array(items) => (items.get(token.parse::<usize>().ok()?)?, None),
                Kind::Object(members) => {
                    let member = members.iter().find(|m| m.key == token)?;
                    (&member.value, Some(member.key_span.clone()))
                }
                _ => return None,
            };
            place = Place {
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

/// The pointer of a member or item of what `pointer` leads to.
pub fn child(pointer: &str, token: impl std::fmt::Display) -> String {
    format!("{pointer}/{}", token.to_string().replace('~', "~0").replace('/', "~1"))
}
