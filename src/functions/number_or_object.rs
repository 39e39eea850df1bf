//! JSON format of signals and profiles: a number for a constant, or an object with one named form. Implemented by hand,
//! because derived "untagged" enums lose the location and reason of an error.

/// Implements `Serialize`, `Deserialize` and `JsonSchema` for an enum with `Constant(f64)` and newtype variants. A
/// helper enum of the same variants reads the form `{"name": ...}`.
macro_rules! number_or_object {
    ($kind:ident, $named:ident, $expecting:literal, { $($variant:ident = $name:literal),+ $(,)? }) => {
        impl serde::Serialize for $kind {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                match self {
                    Self::Constant(value) => serializer.serialize_f64(*value),
                    $(Self::$variant(form) => serializer.serialize_newtype_variant(stringify!($kind), 0, $name, form),)+
                }
            }
        }

        impl<'de> serde::Deserialize<'de> for $kind {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Reader;
                impl<'de> serde::de::Visitor<'de> for Reader {
                    type Value = $kind;
                    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                        f.write_str($expecting)
                    }
                    fn visit_f64<E>(self, value: f64) -> Result<$kind, E> {
                        Ok($kind::Constant(value))
                    }
                    fn visit_i64<E>(self, value: i64) -> Result<$kind, E> {
                        Ok($kind::Constant(value as f64))
                    }
                    fn visit_u64<E>(self, value: u64) -> Result<$kind, E> {
                        Ok($kind::Constant(value as f64))
                    }
                    fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<$kind, A::Error> {
                        let named = <$named as serde::Deserialize>::deserialize(
                            serde::de::value::MapAccessDeserializer::new(map),
                        )?;
                        Ok(match named {
                            $($named::$variant(form) => $kind::$variant(form),)+
                        })
                    }
                }
                deserializer.deserialize_any(Reader)
            }
        }

        impl schemars::JsonSchema for $kind {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($kind).into()
            }
            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let named = <$named as schemars::JsonSchema>::json_schema(generator);
                schemars::json_schema!({
                    "anyOf": [{ "type": "number", "description": "The same always." }, named]
                })
            }
        }

        impl $kind {
            /// A constant.
            pub fn constant(value: f64) -> Self {
                Self::Constant(value)
            }

            /// The constant 1.
            pub fn one() -> Self {
                Self::Constant(1.0)
            }

            /// True if written as the number 1.
            pub fn is_one(&self) -> bool {
                *self == Self::Constant(1.0)
            }
        }
    };
}

pub(super) use number_or_object;
