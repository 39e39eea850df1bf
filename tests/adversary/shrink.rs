//! Makes a failing scene smaller, as long as it fails in the same way: fewer loads, plainer signals, rounder numbers.

use serde_json::{Map, Value, json};

use crate::digits::digits;

/// The smallest scene found that still fails, within so many tries.
pub fn shrink(scene: &Value, tries: usize, fails: impl Fn(&Value) -> bool) -> Value {
    let (mut best, mut left) = (scene.clone(), tries);
    'again: while left > 0 {
        for smaller in candidates(&best) {
            if left == 0 {
                break 'again;
            }
            if smaller == best {
                continue;
            }
            left -= 1;
            if fails(&smaller) {
                best = smaller;
                continue 'again;
            }
        }
        break;
    }
    best
}

/// Scenes that are a little smaller, the boldest first.
fn candidates(scene: &Value) -> Vec<Value> {
    let mut all = vec![];
    let without = |keys: &[&str]| {
        let mut smaller = scene.clone();
        if let Some(members) = smaller.as_object_mut() {
            keys.iter().for_each(|key| drop(members.shift_remove(*key)));
        }
        smaller
    };
    all.push(without(&["network", "fluid", "bladders", "tubes"]));
    for key in ["loads", "network", "start", "formulation", "mesh"] {
        all.push(without(&[key]));
    }
    let mut places = vec![];
    pointers(scene, String::new(), &mut places);
    for at in &places {
        if let Some(value) = scene.pointer(at) {
            all.extend(plainer(at, value).into_iter().map(|with| replaced(scene, at, with)));
        }
    }
    for at in &places {
        let parent = at.rsplit_once('/').map_or("", |(parent, _)| parent);
        if let Some(Value::Array(items)) = scene.pointer(parent).filter(|_| !parent.is_empty() && items_go(parent)) {
            let k: usize = at[parent.len() + 1..].parse().unwrap_or(0);
            let mut fewer = items.clone();
            fewer.remove(k);
            all.push(replaced(scene, parent, Value::Array(fewer)));
        }
    }
    for count in [0, 1] {
        let mut rounded = scene.clone();
        round(&mut rounded, count);
        all.push(rounded);
    }
    for at in &places {
        if let Some(number) = scene
            .pointer(at)
            .and_then(Value::as_f64)
            .filter(|n| *n != 0.0 && *n != 1.0)
        {
            all.push(replaced(scene, at, digits(number, 0)));
        }
    }
    all
}

/// Lists that may have fewer entries.
fn items_go(at: &str) -> bool {
    [
        "loads",
        "chains",
        "tubes",
        "ports",
        "turbines",
        "sum",
        "product",
        "coefficients",
    ]
    .iter()
    .any(|list| at.ends_with(list))
}

/// What might stand in the place of a value.
fn plainer(at: &str, value: &Value) -> Vec<Value> {
    let key = at.rsplit('/').next().unwrap_or_default();
    let mut all = vec![];
    match value {
        Value::Object(members) if members.len() == 1 => {
            let Some((form, inner)) = members.iter().next() else {
                return all;
            };
            match (form.as_str(), inner) {
                ("sum" | "product", Value::Array(parts)) => all.extend(parts.iter().cloned()),
                ("sine" | "sigmoid" | "ramp" | "polynomial" | "table" | "cosine", _) => {
                    all.extend([json!(0.0), json!(1.0)]);
                    let size = inner.get("amplitude").or(inner.get("to"));
                    all.extend(size.cloned());
                }
                ("free" | "clamped" | "pinned" | "guided", _) if key == "tip" || key == "root" => {
                    all.extend([json!("free"), json!("clamped"), json!(form)]);
                }
                ("published", _) if key == "coupling" => all.push(json!("reciprocal")),
                ("check_valves", _) => all.push(json!("ideal")),
                ("pressure_pa" | "flow_m3_s", _) => all.push(json!("sealed")),
                _ => {}
            }
        }
        Value::Object(members) if ["free", "clamped", "pinned", "guided"].contains(&key) => {
            for one in members.keys() {
                let mut fewer: Map<String, Value> = members.clone();
                fewer.shift_remove(one);
                all.push(Value::Object(fewer));
            }
        }
        Value::Object(_) if key == "conditions" => {}
        Value::String(word) if key == "coupling" && word != "reciprocal" => all.push(json!("reciprocal")),
        Value::Number(_) => match key {
            "phase_rad" | "ramp_cycles" | "from" | "start_s" | "drag_n_s_m2" | "axial_time_s" | "bending_time_s" => {
                all.push(json!(0.0));
            }
            "axial_stiffness_factor" | "bending_stiffness_factor" | "permeability_factor" => all.push(json!(1.0)),
            _ => {}
        },
        _ => {}
    }
    all.retain(|other| other != value);
    all
}

fn replaced(scene: &Value, at: &str, with: Value) -> Value {
    let mut other = scene.clone();
    if let Some(value) = other.pointer_mut(at) {
        *value = with;
    }
    other
}

/// Pointers of everything, outer ones first.
fn pointers(value: &Value, at: String, all: &mut Vec<String>) {
    match value {
        Value::Object(members) => {
            for (key, inner) in members {
                let below = format!("{at}/{key}");
                all.push(below.clone());
                pointers(inner, below, all);
            }
        }
        Value::Array(items) => {
            for (k, inner) in items.iter().enumerate() {
                let below = format!("{at}/{k}");
                all.push(below.clone());
                pointers(inner, below, all);
            }
        }
        _ => {}
    }
}

fn round(value: &mut Value, count: usize) {
    match value {
        Value::Object(members) => members.values_mut().for_each(|inner| round(inner, count)),
        Value::Array(items) => items.iter_mut().for_each(|inner| round(inner, count)),
        Value::Number(number) if number.is_f64() => {
            if let Some(number) = number.as_f64().filter(|n| *n != 0.0) {
                *value = digits(number, count);
            }
        }
        _ => {}
    }
}
