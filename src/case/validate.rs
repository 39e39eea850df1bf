//! Validation of the structure: the JSON value against the generated JSON Schema, with all faults at once.
//!
//! Supports only the keywords that the generator writes (`$ref`, `type`, `properties`, `required`, `additionalProperties: false`,
//! `oneOf`/`anyOf`, `if`/`else` about `required`, `const`, `enum`, `items`, `minItems`, `maxItems`, bounds of numbers). Of several
//! branches, the type of the value and its single key select the one that the user meant, so that a message is about that branch.

use serde_json::{Map, Value};

use super::amounts;
use super::counts;
use super::faults::Violations;
use super::locate::child;
use super::numbers;
use super::synonyms;
use super::unit_mistakes;
use super::unknown::{self, KeyMeaning};
use super::wording::{found, found_text, nearest, quoted, short};
use super::wrong_kind;
use crate::error::{Code, Violation};

/// Compares a value with a schema. `own` is the part that the user wrote: a wrong key may mean one that only a preset supplies.
pub fn validate(value: &Value, own: &Value, schema: &Value, faults: &mut Violations) {
    let root = schema;
    Walk { root, own, faults }.check(value, schema, "");
}

struct Walk<'a> {
    root: &'a Value,
    own: &'a Value,
    faults: &'a mut Violations,
}

impl<'a> Walk<'a> {
    fn check(&mut self, value: &Value, schema: &'a Value, pointer: &str) {
        let mut branches = vec![];
        self.branches(schema, &mut branches);
        let Some(branch) = self.choose(value, schema, &branches, pointer) else {
            return;
        };
        match value {
            Value::Object(members) => self.object(members, branch, pointer),
            Value::Array(items) => self.array(items, branch, pointer),
            Value::Number(number) => {
                if let Some(fault) = numbers::fault(number, branch, pointer) {
                    self.faults.push(fault);
                }
            }
            Value::String(text) if branch.get("minLength").is_some() && text.is_empty() => {
                self.faults
                    .push(Violation::new(Code::Range, pointer, "empty text").allowed("at least one character"));
            }
            _ => {}
        }
    }

    /// Collects the alternatives of a schema, with references and nested choices resolved.
    fn branches(&self, schema: &'a Value, out: &mut Vec<&'a Value>) {
        if let Some(name) = schema.get("$ref").and_then(Value::as_str) {
            if let Some(target) = self.root.pointer(name.trim_start_matches('#')) {
                self.branches(target, out);
            }
            return;
        }
        match schema
            .get("anyOf")
            .or_else(|| schema.get("oneOf"))
            .and_then(Value::as_array)
        {
            Some(several) => several.iter().for_each(|one| self.branches(one, out)),
            None => out.push(schema),
        }
    }

    /// Returns the alternative that the user meant; none, with a fault, if there is no such alternative.
    fn choose(&mut self, value: &Value, schema: &Value, branches: &[&'a Value], pointer: &str) -> Option<&'a Value> {
        let fitting: Vec<&'a Value> = branches.iter().copied().filter(|b| type_fits(value, b)).collect();
        match value {
            Value::String(text) => {
                let other = || wrong_kind::hint(pointer, value, schema, branches);
                self.choose_word(text, &fitting, branches, pointer, other)
            }
            // without alternatives, an object is not named by its form, however few keys it has
            Value::Object(members) if branches.len() > 1 && fitting.iter().any(|b| tag(b).is_some()) => {
                self.choose_tag(members, &fitting, branches, pointer)
            }
            _ => match fitting.first() {
                Some(branch) => Some(*branch),
                None => {
                    let fault = Violation::new(Code::Kind, pointer, format!("found {}", found(value)));
                    let fault = fault.allowed(kinds(branches));
                    let hint = wrong_kind::hint(pointer, value, schema, branches);
                    self.faults.push(Violation { hint, ..fault });
                    None
                }
            },
        }
    }

    fn choose_word(
        &mut self,
        text: &str,
        fitting: &[&'a Value],
        all: &[&'a Value],
        pointer: &str,
        other: impl FnOnce() -> Option<String>,
    ) -> Option<&'a Value> {
        let words: Vec<&str> = fitting.iter().flat_map(|b| allowed_words(b)).collect();
        if let Some(branch) = fitting
            .iter()
            .find(|b| words_free(b) || allowed_words(b).any(|w| w == text))
        {
            return Some(branch);
        }
        let mut fault = Violation::new(Code::Kind, pointer, format!("found {}", found_text(text)));
        let tags: Vec<&str> = all.iter().filter_map(|b| tag(b)).collect();
        if tags.contains(&text) {
            fault.what = format!("\"{text}\" requires values besides its name");
            fault.hint = Some(format!("write {{\"{text}\": ...}}"));
        } else if !words.is_empty() {
            fault.code = Code::Name;
            fault.what = format!("unknown name \"{}\"", short(text));
            fault.hint = called_otherwise(text, &words, &tags);
            // a similar name that the remedy does not mean would mislead
            let meant = |near: &String| fault.hint.as_ref().is_none_or(|hint| hint.contains(near.as_str()));
            fault.nearest = nearest(text, words.iter().chain(&tags).copied()).filter(meant);
        }
        if fault.code == Code::Kind && fault.hint.is_none() {
            fault.hint = other();
        }
        if numeric(all) {
            fault.hint = match text.trim().parse::<f64>() {
                Ok(number) if number.is_finite() => Some(format!("numbers have no quotes: write {}", text.trim())),
                _ => amounts::remedy(pointer, text).or(fault.hint),
            };
        }
        self.faults.push(fault.allowed(kinds(all)));
        None
    }

    fn choose_tag(
        &mut self,
        members: &Map<String, Value>,
        fitting: &[&'a Value],
        all: &[&'a Value],
        pointer: &str,
    ) -> Option<&'a Value> {
        let known = |key: &str| fitting.iter().find(|b| tag(b) == Some(key)).copied();
        let mut keys = members.keys();
        let single = keys.next().filter(|_| keys.next().is_none());
        if let Some(branch) = single.and_then(|key| known(key)) {
            return Some(branch);
        }
        let allowed = kinds(all);
        let Some(key) = single else {
            let what = match members.len() {
                0 => "an empty object".to_owned(),
                count => format!("{count} keys, but exactly one key names the form"),
            };
            self.faults
                .push_at_key(Violation::new(Code::Kind, pointer, what).allowed(allowed));
            // Values under known names are checked nevertheless.
            for (key, value) in members {
                if let Some(inner) = known(key).and_then(|b| b.pointer("/properties")?.get(key)) {
                    self.check(value, inner, &child(pointer, key));
                }
            }
            return None;
        };
        let what = format!("unknown name \"{}\"", short(key));
        let fault = Violation::new(Code::Name, child(pointer, key), what).allowed(allowed);
        let word = all.iter().flat_map(|b| allowed_words(b)).any(|word| word == key);
        let tags = fitting.iter().filter_map(|b| tag(b));
        let slip = members
            .get(key)
            .and_then(|value| unit_mistakes::unit(key, value, tags.clone()));
        let (nearest, hint) = match slip {
            _ if word => (None, Some(format!("write \"{key}\" without braces"))),
            Some((meant, hint)) => (Some(meant), Some(hint)),
            None => match synonyms::instead(key) {
                Some(hint) => (None, Some(hint.to_owned())),
                None => (nearest(key, tags), None),
            },
        };
        self.faults.push_at_key(Violation { nearest, hint, ..fault });
        None
    }

    fn object(&mut self, members: &Map<String, Value>, schema: &'a Value, pointer: &str) {
        let Some(properties) = schema.get("properties").and_then(Value::as_object) else {
            return;
        };
        let closed = schema.get("additionalProperties") == Some(&Value::Bool(false));
        let mut misspelt = vec![];
        for (key, value) in members {
            match properties.get(key) {
                Some(inner) => self.check(value, inner, &child(pointer, key)),
                None if closed => misspelt.extend(self.unknown_key(key, value, properties, pointer)),
                None => {}
            }
        }
        let required = schema.get("required").and_then(Value::as_array).into_iter().flatten();
        let unless = schema.pointer("/if/required").and_then(Value::as_array);
        let named = unless.is_some_and(|keys| {
            keys.iter()
                .all(|key| key.as_str().is_some_and(|k| members.contains_key(k)))
        });
        let otherwise = schema.pointer("/else/required").and_then(Value::as_array);
        let required = required.chain(otherwise.filter(|_| !named).into_iter().flatten());
        for key in required.filter_map(Value::as_str) {
            if !members.contains_key(key) && !misspelt.iter().any(|meant| meant == key) {
                let fault = Violation::new(Code::Missing, pointer, format!("the key \"{key}\" is missing"));
                let meaning = properties.get(key).and_then(|p| p.get("description")?.as_str());
                let hint = meaning.map(|text| format!("{key}: {text}"));
                self.faults.push_at_key(Violation { hint, ..fault });
            }
        }
    }

    /// Reports an unknown key, and returns the keys of which one was probably meant.
    fn unknown_key(&mut self, key: &str, value: &Value, properties: &Map<String, Value>, pointer: &str) -> Vec<String> {
        let full = self.faults.is_full();
        let known = unknown::KnownKeys {
            properties,
            written: self.own.pointer(pointer),
            pointer,
        };
        let meant = if full {
            KeyMeaning::default()
        } else {
            known.meant(key, value)
        };
        let at = child(pointer, key);
        for name in &meant.keys {
            self.faults.doubt(child(pointer, name));
        }
        if !meant.keys.is_empty() {
            self.faults.slip(&at);
        }
        let fault = Violation::new(Code::Key, at, format!("unknown key \"{}\"", short(key)));
        if full {
            self.faults.push_unknown_key(fault);
            return vec![];
        }
        let names: Vec<&str> = properties.keys().map(String::as_str).collect();
        let allowed = if names.is_empty() {
            "no keys at all".to_owned()
        } else {
            names.join(", ")
        };
        self.faults.push_unknown_key(Violation {
            nearest: meant.nearest,
            hint: meant.hint,
            ..fault.allowed(allowed)
        });
        meant.keys
    }

    fn array(&mut self, items: &[Value], schema: &'a Value, pointer: &str) {
        let bound = |key| schema.get(key).and_then(Value::as_u64);
        let count = items.len() as u64;
        if let Some(max) = bound("maxItems").filter(|max| count > *max && *max >= counts::MANY) {
            self.faults.push_overfull(counts::overfull(pointer, count, max));
            return;
        }
        if let Some(inner) = schema.get("items") {
            for (i, item) in items.iter().enumerate() {
                self.check(item, inner, &child(pointer, i));
            }
        }
        let allowed = match (bound("minItems"), bound("maxItems")) {
            (Some(min), Some(max)) if min == max && count != min => format!("exactly {min}"),
            (Some(min), _) if count < min => format!("at least {min}"),
            (_, Some(max)) if count > max => format!("at most {max}"),
            _ => return,
        };
        let what = format!("an array of {count} {}", if count == 1 { "entry" } else { "entries" });
        self.faults
            .push(Violation::new(Code::Count, pointer, what).allowed(allowed));
    }
}

/// Remedies for names that other programs use.
fn called_otherwise(text: &str, words: &[&str], tags: &[&str]) -> Option<String> {
    match text {
        "open" | "vent" | "vented" if tags.contains(&"pressure_pa") => {
            Some("an open end is {\"pressure_pa\": 0}".into())
        }
        "closed" | "plugged" if words.contains(&"sealed") => Some("it is called \"sealed\"".into()),
        "fixed" | "built-in" | "encastre" if words.contains(&"clamped") => Some("it is called \"clamped\"".into()),
        "bottom" | "below" | "down" if words.contains(&"lower") => Some("the row below is called \"lower\"".into()),
        "top" | "above" | "up" if words.contains(&"upper") => Some("the row above is called \"upper\"".into()),
        "step" | "heaviside" if tags.contains(&"ramp") => {
            Some("a step is a ramp without duration: {\"ramp\": {\"to\": 1, \"start_s\": 0, \"duration_s\": 0}}".into())
        }
        "hinged" | "simply supported" if words.contains(&"pinned") => Some("it is called \"pinned\"".into()),
        "none" | "off" | "uncoupled" if words.contains(&"reciprocal") => Some(
            "to uncouple the beam, switch these effects off: \"effects\": {\"pressure_to_curvature\": \"off\", \
             \"pressure_to_stretch\": \"off\", \"moment_to_area\": \"off\", \"force_to_area\": \"off\"}"
                .into(),
        ),
        _ => None,
    }
}

/// The single key of an alternative such as `{"sine": ...}`.
fn tag(branch: &Value) -> Option<&str> {
    let properties = branch.get("properties")?.as_object()?;
    let required = branch.get("required")?.as_array()?;
    let (name, _) = properties.iter().next()?;
    (properties.len() == 1 && required.len() == 1 && required[0] == name.as_str()).then_some(name)
}

/// The words a branch for texts allows.
fn allowed_words(branch: &Value) -> impl Iterator<Item = &str> {
    let several = branch.get("enum").and_then(Value::as_array).into_iter().flatten();
    several.chain(branch.get("const")).filter_map(Value::as_str)
}

/// True if one of the alternatives is a number.
fn numeric(branches: &[&Value]) -> bool {
    let kinds = branches.iter().filter_map(|branch| branch.get("type")?.as_str());
    kinds.into_iter().any(|kind| kind == "number" || kind == "integer")
}

fn words_free(branch: &Value) -> bool {
    branch.get("enum").is_none() && branch.get("const").is_none()
}

fn type_fits(value: &Value, branch: &Value) -> bool {
    match (value, branch.get("type").and_then(Value::as_str)) {
        (_, None) => true,
        (Value::Object(_), Some(kind)) => kind == "object",
        (Value::Array(_), Some(kind)) => kind == "array",
        (Value::String(_), Some(kind)) => kind == "string",
        (Value::Number(_), Some(kind)) => kind == "number" || kind == "integer",
        (Value::Bool(_), Some(kind)) => kind == "boolean",
        (Value::Null, Some(kind)) => kind == "null",
    }
}

/// Description of the allowed values.
fn kinds(branches: &[&Value]) -> String {
    let words: Vec<&str> = branches.iter().flat_map(|b| allowed_words(b)).collect();
    let form = |branch| if branches.len() > 1 { tag(branch) } else { None };
    let tags: Vec<&str> = branches.iter().filter_map(|b| form(b)).collect();
    let mut kinds = vec![];
    for branch in branches {
        let kind = match branch.get("type").and_then(Value::as_str) {
            Some("number") => "a number",
            Some("integer") => "a whole number",
            Some("boolean") => "true or false",
            Some("array") => "an array",
            Some("string") if words_free(branch) => "a text",
            Some("object") if form(branch).is_none() => "an object",
            _ => continue,
        };
        kinds.push(kind.to_owned());
    }
    if !words.is_empty() {
        kinds.push(quoted(&words));
    }
    if !tags.is_empty() {
        kinds.push(format!("an object with one of {}", quoted(&tags)));
    }
    kinds.join(" or ")
}
