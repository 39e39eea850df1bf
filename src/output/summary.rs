//! `summary.json`, there and back. What is not finite is written as null, or left out of maps.

use std::io;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use super::folder::{ResultFolder, SUMMARY, fault, text_of};
use crate::error::Result;
use crate::run::summary::{Quantity, Summary};

/// The text of `summary.json`.
pub fn to_json(summary: &Summary) -> String {
    let mut summary = summary.clone();
    // serde_json turns what is not finite into null; where a key can be left out, it is.
    summary.balances.energy_j.retain(|_, x| x.is_finite());
    summary.characteristic.retain(|_, x| x.is_finite());
    let derivatives = summary
        .sensitivities
        .values_mut()
        .flat_map(|s| s.quantities.values_mut());
    for q in summary.quantities.values_mut().chain(derivatives) {
        *q = Quantity {
            last: finite(q.last),
            max_abs: finite(q.max_abs),
            window_max_abs: finite(q.window_max_abs),
            window_rms: finite(q.window_rms),
            window: finite(q.window),
            final_error: finite(q.final_error),
            window_error: finite(q.window_error),
        };
    }
    let mut text = serde_json::to_string_pretty(&summary).unwrap_or_default();
    text.push('\n');
    text
}

/// Writes `summary.json` and returns its path.
pub fn write(folder: &ResultFolder, summary: &Summary) -> Result<PathBuf> {
    folder.write(SUMMARY, to_json(summary).as_bytes())
}

/// Reads the summary of a result folder; nulls come back as NaN.
pub fn read(dir: &Path) -> Result<Summary> {
    let path = dir.join(SUMMARY);
    let text = text_of(&path)?;
    from_json(&text).map_err(|e| fault("read", &path, io::Error::from(e)))
}

fn from_json(text: &str) -> serde_json::Result<Summary> {
    let mut value: Value = serde_json::from_str(text)?;
    let mut nulls = Vec::new();
    if let Some(Value::Object(balances)) = value.get_mut("balances") {
        nulls = zero_nulls(balances);
    }
    let mut summary: Summary = serde_json::from_value(value)?;
    let balances = &mut summary.balances;
    for key in nulls {
        match key.as_str() {
            "energy_residual_relative" => balances.energy_residual_relative = f64::NAN,
            "volume_residual_relative" => balances.volume_residual_relative = f64::NAN,
            "port_flow_residual_relative" => balances.port_flow_residual_relative = f64::NAN,
            "reaction_difference_relative" => balances.reaction_difference_relative = f64::NAN,
            "momentum_residual_relative" => balances.momentum_residual_relative = f64::NAN,
            "angular_momentum_residual_relative" => balances.angular_momentum_residual_relative = f64::NAN,
            _ => {}
        }
    }
    Ok(summary)
}

fn finite(x: Option<f64>) -> Option<f64> {
    x.filter(|x| x.is_finite())
}

/// Puts zeros for nulls and tells where they were.
fn zero_nulls(map: &mut Map<String, Value>) -> Vec<String> {
    let mut keys = Vec::new();
    for (key, value) in map.iter_mut().filter(|(_, v)| v.is_null()) {
        *value = Value::from(0.0);
        keys.push(key.clone());
    }
    keys
}
