//! Conditions of one end: their form in a case, and the meaning of each name.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error as _, MapAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::schema::{End, EndConditions};
use crate::functions::Signal;

/// Name of each form of an end, its description, and its permitted keys.
const FORMS: [(&str, &str, &[&str]); 5] = [
    (
        "free",
        "Nothing held; loads may act.",
        &[
            "force_x_n",
            "force_z_n",
            "moment_n_m",
            "follower_normal_n",
            "follower_shear_n",
        ],
    ),
    (
        "clamped",
        "u1, u3 and slope held or driven.",
        &["u1_m", "u3_m", "slope_rad"],
    ),
    (
        "pinned",
        "u1 and u3 held or driven, free to turn.",
        &["u1_m", "u3_m", "moment_n_m"],
    ),
    (
        "guided",
        "Slope held or driven, free to move across; along, u3 is held or driven unless `force_z_n` is given.",
        &["slope_rad", "force_x_n", "u3_m", "force_z_n"],
    ),
    (
        "conditions",
        "Exactly one of each pair {u1_m, force_x_n}, {slope_rad, moment_n_m}, {u3_m, force_z_n}, or follower forces instead of dead ones.",
        &[
            "u1_m",
            "force_x_n",
            "slope_rad",
            "moment_n_m",
            "u3_m",
            "force_z_n",
            "follower_normal_n",
            "follower_shear_n",
        ],
    ),
];

/// Forms that may stand alone as a string: all but `conditions`.
const ALONE: usize = 4;

/// Conditions of one end, with every pair decided.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedEnd {
    /// u1 or the force in x.
    pub transverse: Translation,
    /// Slope or moment.
    pub rotation: Rotation,
    /// u3 or the force in z.
    pub axial: Translation,
    /// Forces that turn with the end.
    pub follower: Option<Follower>,
}

/// One direction of an end.
#[derive(Clone, Debug, PartialEq)]
pub enum Translation {
    /// Displacement [m].
    Displacement(Signal),
    /// Dead force on the end [N].
    Force(Signal),
}

/// Rotation of an end.
#[derive(Clone, Debug, PartialEq)]
pub enum Rotation {
    /// Slope angle phi [rad].
    Slope(Signal),
    /// Bending moment M in the section [N m].
    Moment(Signal),
}

/// Section forces that turn with the end's angle (A.53, A.54).
#[derive(Clone, Debug, PartialEq)]
pub struct Follower {
    /// `N` along `e_t` [N].
    pub normal: Signal,
    /// `V` along `e_n` [N].
    pub shear: Signal,
}

impl ResolvedEnd {
    /// A free end without loads.
    pub const FREE: Self = Self {
        transverse: Translation::Force(Signal::Constant(0.0)),
        rotation: Rotation::Moment(Signal::Constant(0.0)),
        axial: Translation::Force(Signal::Constant(0.0)),
        follower: None,
    };
}

impl End {
    /// Name of the form, and its given conditions.
    pub fn form(&self) -> (&'static str, &EndConditions) {
        match self {
            Self::Free(given) => ("free", given),
            Self::Clamped(given) => ("clamped", given),
            Self::Pinned(given) => ("pinned", given),
            Self::Guided(given) => ("guided", given),
            Self::Conditions(given) => ("conditions", given),
        }
    }

    /// Given conditions of the form.
    pub fn given_mut(&mut self) -> &mut EndConditions {
        match self {
            Self::Free(given)
            | Self::Clamped(given)
            | Self::Pinned(given)
            | Self::Guided(given)
            | Self::Conditions(given) => given,
        }
    }

    fn from_form(name: &str, given: EndConditions) -> Option<Self> {
        Some(match name {
            "free" => Self::Free(given),
            "clamped" => Self::Clamped(given),
            "pinned" => Self::Pinned(given),
            "guided" => Self::Guided(given),
            "conditions" => Self::Conditions(given),
            _ => return None,
        })
    }

    /// Decides every pair; open conditions are zero motion or zero load.
    pub fn resolve(&self) -> ResolvedEnd {
        let (form, given) = self.form();
        let or_zero = |signal: &Option<Signal>| signal.clone().unwrap_or(Signal::Constant(0.0));
        let (holds_x, holds_slope, holds_z) = match form {
            "clamped" => (true, true, true),
            "pinned" => (true, false, true),
            "guided" => (false, true, given.force_z_n.is_none()),
            _ => (given.u1_m.is_some(), given.slope_rad.is_some(), given.u3_m.is_some()),
        };
        let translation = |holds, displacement, force| match holds {
            true => Translation::Displacement(or_zero(displacement)),
            false => Translation::Force(or_zero(force)),
        };
        let follows = given.follower_normal_n.is_some() || given.follower_shear_n.is_some();
        ResolvedEnd {
            transverse: translation(holds_x, &given.u1_m, &given.force_x_n),
            rotation: match holds_slope {
                true => Rotation::Slope(or_zero(&given.slope_rad)),
                false => Rotation::Moment(or_zero(&given.moment_n_m)),
            },
            axial: translation(holds_z, &given.u3_m, &given.force_z_n),
            follower: follows.then(|| Follower {
                normal: or_zero(&given.follower_normal_n),
                shear: or_zero(&given.follower_shear_n),
            }),
        }
    }
}

impl EndConditions {
    /// Given conditions by key, in the order of the structure.
    pub fn given(&self) -> impl Iterator<Item = (&'static str, &Signal)> {
        [
            ("u1_m", &self.u1_m),
            ("force_x_n", &self.force_x_n),
            ("slope_rad", &self.slope_rad),
            ("moment_n_m", &self.moment_n_m),
            ("u3_m", &self.u3_m),
            ("force_z_n", &self.force_z_n),
            ("follower_normal_n", &self.follower_normal_n),
            ("follower_shear_n", &self.follower_shear_n),
        ]
        .into_iter()
        .filter_map(|(key, signal)| Some((key, signal.as_ref()?)))
    }
}

impl Serialize for End {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (form, given) = self.form();
        if given.given().next().is_none() && form != "conditions" {
            serializer.serialize_str(form)
        } else {
            serializer.serialize_newtype_variant("End", 0, form, given)
        }
    }
}

impl<'de> Deserialize<'de> for End {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(EndReader)
    }
}

struct EndReader;

impl<'de> Visitor<'de> for EndReader {
    type Value = End;

    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("\"free\", \"clamped\", \"pinned\", \"guided\" or an object with one of them or \"conditions\"")
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<End, E> {
        let alone = FORMS[..ALONE].iter().any(|form| form.0 == name);
        let end = alone.then(|| End::from_form(name, EndConditions::default())).flatten();
        end.ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(name), &self))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<End, A::Error> {
        let named = std::collections::BTreeMap::<String, EndConditions>::deserialize(MapAccessDeserializer::new(map))?;
        let mut forms = named.into_iter();
        let (Some((name, given)), None) = (forms.next(), forms.next()) else {
            return Err(A::Error::custom("exactly one form of end must be given"));
        };
        let Some((_, _, keys)) = FORMS.iter().find(|form| form.0 == name) else {
            return Err(A::Error::custom(format!("unknown form of end `{name}`")));
        };
        if let Some((key, _)) = given.given().find(|(key, _)| !keys.contains(key)) {
            return Err(A::Error::custom(format!(
                "`{name}` accepts {}, not {key}",
                keys.join(", ")
            )));
        }
        End::from_form(&name, given).ok_or_else(|| A::Error::custom("unknown form of end"))
    }
}

impl JsonSchema for End {
    fn schema_name() -> Cow<'static, str> {
        "End".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let all = EndConditions::json_schema(generator);
        let property = |key: &str| {
            all.get("properties")
                .and_then(|p| p.get(key))
                .cloned()
                .unwrap_or_default()
        };
        let object = |(name, description, keys): &(&str, &str, &[&str])| {
            let properties: serde_json::Map<_, _> = keys.iter().map(|key| ((*key).to_owned(), property(key))).collect();
            let given = json_schema!({ "type": "object", "properties": properties, "additionalProperties": false });
            json_schema!({
                "type": "object", "description": description, "properties": { *name: given },
                "required": [name], "additionalProperties": false
            })
        };
        let names: Vec<_> = FORMS[..ALONE].iter().map(|form| form.0).collect();
        let mut branches = vec![json_schema!({
            "type": "string", "enum": names, "description": "With zero motion and load."
        })];
        branches.extend(FORMS.iter().map(object));
        json_schema!({ "description": "Condition of one end, by its usual name or condition by condition.", "anyOf": branches })
    }
}
