//! Arrays as base64 of little-endian single precision: three digits more than a screen can show, a quarter of the size of text.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;

/// Numbers as one string.
pub fn numbers(values: impl IntoIterator<Item = f64>) -> Value {
    #[allow(clippy::cast_possible_truncation)]
    let bytes: Vec<u8> = values.into_iter().flat_map(|x| (x as f32).to_le_bytes()).collect();
    Value::String(STANDARD.encode(bytes))
}

/// Data URL of a picture.
pub fn svg(bytes: &[u8]) -> String {
    format!("data:image/svg+xml;base64,{}", STANDARD.encode(bytes))
}
