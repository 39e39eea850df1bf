//! Meaning of a key that its object does not have.

use std::collections::{HashMap, VecDeque};
use std::sync::LazyLock;

use serde_json::{Map, Value};

use super::locate::child;
use super::units::{self, UnitSuffix};
use super::wording::all_nearest;
use super::{schema_json, synonyms, unit_mistakes};

/// Largest number of places of a key in a message.
const MOST: usize = 3;

/// Similarity from which on one name counts as a misspelling of another, even if other objects have a similar key.
const CLOSE: f64 = 0.93;

/// Deepest place of a key that is searched.
const DEEPEST: usize = 9;

/// Possible and written keys of an object.
pub struct KnownKeys<'a> {
    /// Possible keys, with their schemas.
    pub properties: &'a Map<String, Value>,
    /// The object as the user wrote it; a wrong key may mean one that only a preset supplies.
    pub written: Option<&'a Value>,
    /// Pointer of the object.
    pub pointer: &'a str,
}

/// Meaning of an unknown key.
#[derive(Default)]
pub struct KeyMeaning {
    /// Candidates among the keys of the same object.
    pub keys: Vec<String>,
    /// The candidate, if there is only one.
    pub nearest: Option<String>,
    /// Remedy.
    pub hint: Option<String>,
}

impl KeyMeaning {
    fn one(key: String, hint: Option<String>) -> Self {
        Self {
            keys: vec![key.clone()],
            nearest: Some(key),
            hint,
        }
    }

    fn elsewhere(hint: String) -> Self {
        Self {
            hint: Some(hint),
            ..Self::default()
        }
    }
}

impl<'a> KnownKeys<'a> {
    /// Finds the meaning of an unknown key: a key with another unit, a misspelling, a key of another object, or a synonym.
    pub fn meant(&self, key: &str, value: &Value) -> KeyMeaning {
        let absent = self.absent();
        // a further argument may also mean a key that is already present
        if let Some((meant, hint)) =
            unit_mistakes::unit(key, value, absent.clone()).or_else(|| unit_mistakes::unit(key, value, self.names()))
        {
            return KeyMeaning::one(meant, Some(hint));
        }
        let whole = |name: &&str| matches!(units::suffix(name, None), UnitSuffix::Known(stem, _) if stem == key);
        if let Some(one) = absent.clone().find(whole) {
            return KeyMeaning::one(one.to_owned(), None);
        }
        let lower = key.to_lowercase();
        let stem = match units::suffix(&lower, None) {
            UnitSuffix::Known(stem, _) | UnitSuffix::Unknown(stem, _) => stem,
            UnitSuffix::None => &lower,
        };
        if let Some(said) = [lower.as_str(), stem].into_iter().find_map(synonyms::instead) {
            return KeyMeaning::elsewhere(said.to_owned());
        }
        if let [across, along] = self.without_third_axis(&lower)[..] {
            return self.of_near(&[(1.0, across), (1.0, along)]);
        }
        let fits = |name: &&str| self.takes(name, value);
        let mut near = all_nearest(key, absent.clone().filter(fits));
        if near.is_empty() {
            near = all_nearest(key, self.names().filter(fits));
        }
        let close = near.first().is_some_and(|(similarity, _)| *similarity >= CLOSE);
        if let Some(inside) = self.inside(key).filter(|_| !close) {
            return KeyMeaning::elsewhere(belongs(&[inside.as_str()]));
        }
        let homes = self.homes(key);
        if close {
            let mut meant = self.of_near(&near);
            if !homes.is_empty() {
                meant.hint = meant.hint.or_else(|| Some(belongs(&homes)));
            }
            return meant;
        }
        if !homes.is_empty() {
            return KeyMeaning::elsewhere(belongs(&homes));
        }
        let called = |word: &str| match synonyms::of_whole(word) {
            none if none.is_empty() => synonyms::of_symbol(word),
            some => some,
        };
        let meant = match called(&lower) {
            none if none.is_empty() => called(stem),
            some => some,
        };
        let own: Vec<(f64, &str)> = absent
            .filter(|name| meant.contains(name))
            .map(|name| (1.0, name))
            .collect();
        if !own.is_empty() {
            return self.of_near(&own);
        }
        if !near.is_empty() {
            return self.of_near(&near);
        }
        let places: Vec<&str> = meant
            .iter()
            .filter_map(|key| self.homes(key).first().copied())
            .collect();
        match places.is_empty() {
            true => KeyMeaning::default(),
            false => KeyMeaning::elsewhere(format!("related keys: {}", places[..places.len().min(MOST)].join(", "))),
        }
    }

    fn names(&self) -> impl Iterator<Item = &'a str> + Clone {
        self.properties.keys().map(String::as_str)
    }

    fn absent(&self) -> impl Iterator<Item = &'a str> + Clone {
        let written = self.written;
        self.names()
            .filter(move |name| written.is_none_or(|members| members.get(*name).is_none()))
    }

    /// True if a value may be meant for a key: a number is never meant for a key that accepts only objects.
    fn takes(&self, name: &str, value: &Value) -> bool {
        let object = |schema: &Value| match schema["$ref"].as_str() {
            Some(name) => !takes_numbers(name),
            None => kind(schema) == "object",
        };
        !value.is_number() || !self.properties.get(name).is_some_and(object)
    }

    /// Keys for x and z in place of one for y, which a planar beam does not have.
    fn without_third_axis(&self, key: &str) -> Vec<&'a str> {
        let with = |axis: &str| {
            let parts = key.split('_').map(|part| if part == "y" { axis } else { part });
            parts.collect::<Vec<_>>().join("_")
        };
        let [x, z] = ["x", "z"].map(with);
        let known = |name: &&str| x != z && (*name == x || *name == z);
        self.names().filter(known).collect()
    }

    /// The nearest key; of several, all with their descriptions.
    fn of_near(&self, near: &[(f64, &str)]) -> KeyMeaning {
        let keys: Vec<String> = near.iter().map(|(_, key)| (*key).to_owned()).collect();
        if let [key] = &keys[..] {
            return KeyMeaning::one(key.clone(), None);
        }
        let descriptions = keys.iter().map(|key| {
            if let Some(direction) = direction(key) {
                return format!("\"{key}\" ({direction})");
            }
            let meaning = self.properties[key.as_str()]["description"]
                .as_str()
                .unwrap_or_default();
            let meaning = meaning.split(['.', ';']).next().unwrap_or_default();
            format!("\"{key}\" ({meaning})")
        });
        let hint = format!("either {}", descriptions.collect::<Vec<_>>().join(" or "));
        KeyMeaning {
            keys,
            nearest: None,
            hint: Some(hint),
        }
    }

    /// Pointer to a key in a value of this object, such as a kind of signal, or in the only variant of a value that has it.
    fn inside(&self, key: &str) -> Option<String> {
        let variants = |schema: &'a Value| {
            let schema = resolved(schema);
            let branches = ["oneOf", "anyOf"]
                .into_iter()
                .filter_map(|kind| schema[kind].as_array())
                .flatten();
            std::iter::once(schema).chain(branches)
        };
        let has = |schema: &'a Value| variants(schema).any(|one| one["properties"].get(key).is_some());
        let own = self.properties.iter().find(|(_, schema)| has(schema));
        let deeper = || {
            let members = self.properties.iter().flat_map(|(name, schema)| {
                let of_variant = |one: &'a Value| one["properties"].as_object().into_iter().flatten();
                let members = variants(schema).flat_map(of_variant);
                members
                    .filter(|(_, schema)| has(schema))
                    .map(move |(member, _)| (name, member))
            });
            let all: Vec<_> = members.take(2).collect();
            let [(name, member)] = all[..] else { return None };
            Some(child(&child(&child(self.pointer, name), member), key))
        };
        own.map(|(name, _)| child(&child(self.pointer, name), key))
            .or_else(deeper)
    }

    /// Pointers to a key in other objects.
    fn homes(&self, key: &str) -> Vec<&'static str> {
        let own = child(self.pointer, key);
        let all = HOMES.get(key).into_iter().flatten().map(String::as_str);
        all.filter(|home| *home != own).collect()
    }
}

/// Direction of a component, by the name of its key.
fn direction(key: &str) -> Option<&'static str> {
    key.split('_').find_map(|part| match part {
        "x" | "u1" => Some("x, across the beam at rest"),
        "z" | "u3" => Some("z, along the beam at rest"),
        _ => None,
    })
}

/// JSON pointer for a name without the initial `/`: a name with points as separators, or the places of a key.
pub fn whole(name: &str) -> String {
    let guess = name.trim_matches('/').replace('.', "/");
    let homes = HOMES.get(&guess).map(Vec::as_slice).unwrap_or_default();
    match homes {
        [] => format!("/{guess}"),
        _ => homes[..homes.len().min(MOST)].join(" or "),
    }
}

fn belongs(homes: &[&str]) -> String {
    let places = homes[..homes.len().min(MOST)].join(", ");
    match homes {
        [one] => {
            let around = one.rsplit_once('/').map_or("", |(around, _)| around);
            match around {
                "" => format!("it belongs to the case itself: {one}"),
                _ => format!("it belongs to {around}: {one}"),
            }
        }
        _ if homes.len() > MOST => format!("it belongs elsewhere: {places} and others"),
        _ => format!("it belongs elsewhere: {places}"),
    }
}

fn kind(schema: &Value) -> &str {
    schema["type"].as_str().unwrap_or_default()
}

pub(super) fn resolved<'s>(schema: &'s Value) -> &'s Value
where
    'static: 's,
{
    let name = schema["$ref"].as_str().unwrap_or_default();
    match name.is_empty() {
        true => schema,
        false => schema_json::CASE
            .pointer(name.trim_start_matches('#'))
            .unwrap_or(schema),
    }
}

/// True if a definition of the schema may be a number.
fn takes_numbers(name: &str) -> bool {
    let Some(schema) = schema_json::CASE.pointer(name.trim_start_matches('#')) else {
        return true;
    };
    let branches = ["anyOf", "oneOf"]
        .iter()
        .filter_map(|key| schema[*key].as_array())
        .flatten();
    let mut all = branches.chain([schema]);
    all.any(|one| ["number", "integer"].contains(&kind(resolved(one))))
}

/// Pointers of all keys, the shortest first; arrays by their first item.
static HOMES: LazyLock<HashMap<String, Vec<String>>> = LazyLock::new(|| {
    let mut homes: HashMap<String, Vec<String>> = HashMap::new();
    let mut queue = VecDeque::from([(&*schema_json::CASE, String::new(), vec![])]);
    while let Some((part, pointer, above)) = queue.pop_front() {
        let mut above: Vec<&str> = above;
        if let Some(name) = part["$ref"].as_str() {
            // a signal may contain a signal
            if above.contains(&name) {
                continue;
            }
            above.push(name);
        }
        let part = resolved(part);
        if pointer.matches('/').count() >= DEEPEST {
            continue;
        }
        for (key, inner) in part["properties"].as_object().into_iter().flatten() {
            let at = child(&pointer, key);
            let known = homes.entry(key.clone()).or_default();
            if !known.contains(&at) {
                known.push(at.clone());
            }
            queue.push_back((inner, at, above.clone()));
        }
        if part["items"].is_object() {
            queue.push_back((&part["items"], child(&pointer, 0), above.clone()));
        }
        for one in ["anyOf", "oneOf"]
            .iter()
            .filter_map(|key| part[*key].as_array())
            .flatten()
        {
            queue.push_back((one, pointer.clone(), above.clone()));
        }
    }
    homes
});
