//! `--set POINTER=JSON`: values from the command line put into a case before it is checked.

use serde_json::{Map, Value};

use super::faults::SetValue;
use super::locate::{child, tokens};
use super::parse::{DEEPEST, parse};
use super::wording::short;
use crate::error::{Error, Result};

/// Puts the arguments into `value`, in order; `null` removes a member.
pub fn apply(value: &mut Value, arguments: &[String]) -> Result<Vec<SetValue>> {
    arguments.iter().map(|argument| apply_one(value, argument)).collect()
}

fn apply_one(value: &mut Value, argument: &str) -> Result<SetValue> {
    let usage = |what: String| Error::Usage(format!("--set '{}': {what}", short(argument)));
    let Some((pointer, json)) = argument.split_once('=') else {
        return Err(usage(
            "expected POINTER=JSON, such as --set /solver/rtol=1e-7".to_owned(),
        ));
    };
    if !pointer.starts_with('/') {
        return Err(usage(format!(
            "a JSON pointer starts with `/`: /{}",
            pointer.replace('.', "/")
        )));
    }
    if pointer.matches('/').count() > DEEPEST {
        return Err(usage(format!("a pointer of more than {DEEPEST} parts")));
    }
    let (node, faults) = parse(json);
    let node = match (node, faults.first()) {
        (Some(node), None) => node,
        (_, fault) => {
            let why = fault.map_or("not JSON", |f| f.what.as_str());
            if let Some((number, behind)) = begun(json) {
                return Err(usage(match behind.starts_with(',') {
                    true => format!(
                        "decimals stand behind a point: --set '{pointer}={}'",
                        json.replacen(',', ".", 1)
                    ),
                    false => {
                        format!("{why}; a number has no unit behind it, the key names it: --set '{pointer}={number}'")
                    }
                }));
            }
            let text = Value::from(json);
            return Err(usage(format!(
                "{why}; a text needs double quotes inside single ones: --set '{pointer}={text}'"
            )));
        }
    };
    let new = node.to_value();
    let json_at = pointer.len() + 1;
    // what is not there is put there as null, so that a name that is none is told as such
    let (pointer, node) = if new.is_null() && value.pointer(pointer).is_some() {
        remove(value, pointer);
        (pointer.to_owned(), None)
    } else {
        (insert(value, pointer, new).map_err(usage)?, Some(node))
    };
    Ok(SetValue {
        argument: argument.to_owned(),
        pointer,
        json_at,
        node,
    })
}

/// The number that a text begins with, and what stands behind it: a unit, or decimals behind a comma.
fn begun(text: &str) -> Option<(&str, &str)> {
    let ends = (1..text.len()).rev().filter(|end| text.is_char_boundary(*end));
    let (number, behind) = ends
        .map(|end| text.split_at(end))
        .find(|(number, _)| serde_json::from_str::<f64>(number).is_ok())?;
    let unit = behind
        .trim_start()
        .starts_with(|c: char| c.is_alphabetic() || "%°".contains(c));
    let decimals = behind.strip_prefix(',').is_some_and(|rest| rest.parse::<u64>().is_ok());
    (unit || decimals).then_some((number.trim(), behind))
}

/// Takes out the member or item at a pointer.
pub fn remove(value: &mut Value, pointer: &str) {
    let Some((parent, _)) = pointer.rsplit_once('/') else {
        return;
    };
    let last = tokens(pointer).last().unwrap_or_default();
    match value.pointer_mut(parent) {
        Some(Value::Object(members)) => {
            members.shift_remove(&last);
        }
        Some(Value::Array(items)) => {
            if let Some(i) = last.parse().ok().filter(|i| *i < items.len()) {
                items.remove(i);
            }
        }
        _ => {}
    }
}

/// Makes the objects that are missing on the way, and an array where `-` follows; returns the pointer with `-` replaced by an index.
fn insert(value: &mut Value, pointer: &str, given: Value) -> std::result::Result<String, String> {
    let mut place = value;
    let mut here = String::new();
    let mut parts = tokens(pointer).collect::<Vec<_>>().into_iter().peekable();
    while let Some(token) = parts.next() {
        let absent = match parts.peek() {
            Some(next) if next == "-" => Value::Array(vec![]),
            _ => Value::Object(Map::new()),
        };
        match place {
            Value::Object(members) => {
                here = child(&here, &token);
                place = members.entry(token).or_insert(absent);
            }
            Value::Array(items) => {
                let count = items.len();
                let index = if token == "-" { Some(count) } else { token.parse().ok() };
                let Some(index) = index.filter(|i| *i <= count) else {
                    return Err(format!(
                        "{here} is an array of {count}; `{token}` is not one of its places (0 to {count}, or `-` to add)"
                    ));
                };
                // an array inside of what is not there is nobody's to guess
                if index == count && token != "-" && parts.clone().any(|part| part.parse::<usize>().is_ok()) {
                    let there = match count {
                        0 => "is empty".to_owned(),
                        1 => "has one item, 0".to_owned(),
                        _ => format!("has {count} items, 0 to {}", count - 1),
                    };
                    return Err(format!(
                        "{here} {there}; there is no {here}/{index} to set something in"
                    ));
                }
                if index == count {
                    items.push(absent);
                }
                here = child(&here, index);
                place = &mut items[index];
            }
            other => {
                let kind = short(&other.to_string());
                return Err(format!(
                    "{here} is {kind}, which has no member `{token}`; set {here} as a whole"
                ));
            }
        }
    }
    *place = given;
    Ok(here)
}
