//! Forms of `effects` and `max_order` in a case: a word, or a more precise value.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{MapAccess, Unexpected, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::schema::{EffectChoices, Effects, MaxOrder};

impl Serialize for Effects {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Auto => serializer.serialize_str("auto"),
            Self::Full => serializer.serialize_str("full"),
            Self::Chosen(choices) => choices.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Effects {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Effects;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("\"auto\", \"full\" or an object of named choices")
            }
            fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<Effects, E> {
                match word {
                    "auto" => Ok(Effects::Auto),
                    "full" => Ok(Effects::Full),
                    _ => Err(E::invalid_value(Unexpected::Str(word), &self)),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Effects, A::Error> {
                EffectChoices::deserialize(MapAccessDeserializer::new(map)).map(Effects::Chosen)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for Effects {
    fn schema_name() -> Cow<'static, str> {
        "Effects".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let choices = generator.subschema_for::<EffectChoices>();
        json_schema!({ "anyOf": [
            { "type": "string", "const": "auto", "description": "The program chooses and reports the reasons." },
            { "type": "string", "const": "full", "description": "Everything the case describes." },
            choices
        ]})
    }
}

impl Serialize for MaxOrder {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Auto => serializer.serialize_str("auto"),
            Self::Order(order) => serializer.serialize_u8(*order),
            Self::Forced(order) => Forced { forced: *order }.serialize(serializer),
        }
    }
}

/// Form of an order that skips the stability check.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Forced {
    forced: u8,
}

impl<'de> Deserialize<'de> for MaxOrder {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = MaxOrder;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("\"auto\", an order from 1 to 5, or {\"forced\": order}")
            }
            fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<MaxOrder, E> {
                match word {
                    "auto" => Ok(MaxOrder::Auto),
                    _ => Err(E::invalid_value(Unexpected::Str(word), &self)),
                }
            }
            fn visit_u64<E: serde::de::Error>(self, order: u64) -> Result<MaxOrder, E> {
                match u8::try_from(order) {
                    Ok(order @ 1..=5) => Ok(MaxOrder::Order(order)),
                    _ => Err(E::invalid_value(Unexpected::Unsigned(order), &self)),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<MaxOrder, A::Error> {
                let Forced { forced } = Forced::deserialize(MapAccessDeserializer::new(map))?;
                match forced {
                    1..=5 => Ok(MaxOrder::Forced(forced)),
                    _ => Err(serde::de::Error::invalid_value(
                        Unexpected::Unsigned(forced.into()),
                        &self,
                    )),
                }
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for MaxOrder {
    fn schema_name() -> Cow<'static, str> {
        "MaxOrder".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "description": "Highest BDF order.", "anyOf": [
            { "type": "string", "const": "auto",
              "description": "2 with undamped inertia, 5 without inertia; else from the damping ratios." },
            { "type": "integer", "minimum": 1, "maximum": 5,
              "description": "As given; 3 and 4 are refused where hardly damped waves make them unstable." },
            { "type": "object", "properties": { "forced": { "type": "integer", "minimum": 1, "maximum": 5 } },
              "required": ["forced"], "additionalProperties": false,
              "description": "As given, whatever the stability." }
        ]})
    }
}
