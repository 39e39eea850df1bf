//! `--set POINTER=JSON`: values from the command line, inserted into a case before it is checked.

use serde_json::{Map, Value};

use super::amounts;
use super::faults::SetValue;
use super::locate::{child, tokens};
use super::parse::{DEEPEST, common_mistakes, parse_below};
use super::unknown;
use super::wording::short;
use crate::error::{Error, Result, Violation};

/// Inserts the arguments into `value`, in order; `null` removes a member.
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
            "a JSON pointer starts with `/`: {}",
            unknown::whole(pointer)
        )));
    }
    if pointer.matches('/').count() > DEEPEST {
        return Err(usage(format!("a pointer of more than {DEEPEST} parts")));
    }
    let (node, faults) = parse_below(json, pointer);
    let node = match (node, faults.first()) {
        (Some(node), None) => node,
        (_, fault) => return Err(usage(unreadable(pointer, json, fault))),
    };
    let new = node.to_value();
    let json_at = pointer.len() + 1;
    // an absent value is inserted as null, so that an invalid name is reported
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

/// Description of a value that is not JSON, and its remedy.
fn unreadable(pointer: &str, json: &str, fault: Option<&Violation>) -> String {
    let why = fault.map_or("not JSON", |f| f.what.as_str());
    match amounts::at(pointer, json) {
        Some(amounts::UnitContext::Number(number, _)) => {
            return format!(
                "{why}; {} is {number} here: --set '{pointer}={number}'",
                short(json.trim())
            );
        }
        Some(amounts::UnitContext::Not(what)) => return format!("{why}; {what}"),
        None => {}
    }
    match &common_mistakes::loose(json.trim())[..] {
        [one] => {
            let rule = match *one == json.trim().replacen(',', ".", 1) {
                true => "write decimals with a point",
                false => "write digits without separators, and decimals with a point",
            };
            return format!("{rule}: --set '{pointer}={one}'");
        }
        [one, other] => {
            let json = json.trim();
            return format!("{json} is ambiguous: --set '{pointer}={one}' or --set '{pointer}={other}'");
        }
        _ => {}
    }
    if let Some((_, joined)) = common_mistakes::grouped(json).filter(|(bytes, _)| *bytes == json.len()) {
        return format!("{why}; write digits without separators: --set '{pointer}={joined}'");
    }
    // a word without quotes is a text; other faults have their own remedy
    let text = "text needs double quotes";
    match fault
        .and_then(|fault| fault.hint.as_deref())
        .filter(|hint| *hint != text)
    {
        Some(hint) => format!("{why}; {hint}"),
        None => format!(
            "{why}; a text needs double quotes inside single ones: --set '{pointer}={}'",
            Value::from(json)
        ),
    }
}

/// Removes the member or item at a pointer.
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

/// Inserts a value. Creates missing objects on the way, and an array if `-` follows. Returns the pointer with `-` replaced by an index.
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
                let Some(index) = index.filter(|i| *i < count || token == "-") else {
                    let there = match count {
                        0 => "an empty array".to_owned(),
                        1 => "an array of 1 entry, index 0".to_owned(),
                        _ => format!("an array of {count} entries, indices 0 to {}", count - 1),
                    };
                    return Err(format!(
                        "{here} is {there}; `{token}` is not an index of it. {here}/- adds an entry"
                    ));
                };
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
