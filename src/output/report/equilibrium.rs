//! The page of `equilibrium`: the path of states under growing loads.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::{Kind, Place, pack, sheet};
use crate::error::Result;
use crate::output::equilibrium::{CSV, JSON, SHAPES};
use crate::output::folder::CASE;
use crate::output::numbers::{count, duration, quantity, significant, trimmed};

/// States whose shapes the page holds, at most.
const MOST_STATES: usize = 240;
/// Nodes of a shape at most.
const MOST_NODES: usize = 401;

/// Everything the page shows.
pub fn data(place: &Place) -> Result<Map<String, Value>> {
    let found = place.json(JSON)?;
    let text = |pointer: &str| found.pointer(pointer).and_then(Value::as_str).unwrap_or("").to_string();
    let number = |pointer: &str| found.pointer(pointer).and_then(Value::as_f64);
    let mut all = place.head(Kind::Equilibrium, &text("/case"));
    let mut put = |key: &str, value: Value| all.insert(key.into(), value);
    let failed = text("/status") == "failed";
    put("label", "Static equilibrium".into());
    put(
        "status",
        json!({"word": text("/status"), "tone": if failed { "bad" } else { "good" }, "reason": found.get("reason")}),
    );
    put("warnings", found.get("warnings").cloned().unwrap_or_default());
    let (share, at) = (
        number("/load_factor").unwrap_or(0.0),
        number("/loads_at_s").unwrap_or(0.0),
    );
    put("answer", answer(&found, share, at).into());
    put(
        "facts",
        json!([
            format!("{} states", count(number("/states").unwrap_or(0.0) as u64)),
            format!(
                "{} Newton steps",
                count(number("/solver/newton_iterations").unwrap_or(0.0) as u64)
            ),
            format!("found in {}", duration(number("/wall_s/total").unwrap_or(f64::NAN))),
        ]),
    );
    let tile = |label: &str, pointer: &str, unit: &str, note: &str| {
        let value = number(pointer)?;
        Some(json!({"label": label, "value": quantity(value, unit, 3), "note": note}))
    };
    let tiles = [
        tile("Share of the loads", "/load_factor", "1", "at the end of the path"),
        tile(
            "Tip, across",
            "/quantities/tip_u1_m",
            "m",
            "deflection u₁ in the last state",
        ),
        tile(
            "Tip, along",
            "/quantities/tip_u3_m",
            "m",
            "displacement u₃ in the last state",
        ),
        tile(
            "Turn of the tip",
            "/quantities/tip_angle_rad",
            "rad",
            "slope angle in the last state",
        ),
        tile(
            "Largest pressure",
            "/quantities/max_pressure_pa",
            "Pa",
            "gauge, in the last state",
        ),
    ];
    put("tiles", tiles.into_iter().flatten().collect::<Vec<_>>().into());
    put("events", found.get("events").cloned().unwrap_or_default());
    put("derivatives", found.get("sensitivities").cloned().unwrap_or_default());
    put("path", sheet::read(&place.path(CSV), |_| true));
    put("shapes", shapes(&place.path(SHAPES)));
    let command = format!("slcbeam equilibrium {CASE} --at {at} --load-factor {share}");
    put("command", command.into());
    Ok(all)
}

fn answer(found: &Value, share: f64, at: f64) -> String {
    let loads = format!(
        "{} % of the loads at t = {} s",
        trimmed(&significant(100.0 * share, 4)),
        trimmed(&significant(at, 4))
    );
    let stability = match found.pointer("/stability/unstable_modes").and_then(Value::as_u64) {
        None => "whether it is stable is not known".to_string(),
        Some(0) => "it is stable".to_string(),
        Some(1) => "it is unstable in one way".to_string(),
        Some(n) => format!("it is unstable in {n} ways"),
    };
    let events = found.get("events").and_then(Value::as_array).map_or(0, Vec::len);
    let way = match events {
        0 => "On the way there nothing gives way.".to_string(),
        1 => "On the way there one thing happens, told below.".to_string(),
        n => format!("On the way there {n} things happen, told below."),
    };
    format!("Under {loads} the beam rests in the state shown; {stability}. {way}")
}

/// Positions of the nodes of some states, the last among them.
fn shapes(path: &Path) -> Value {
    let read = || -> csv::Result<Vec<Vec<f64>>> {
        let mut reader = csv::Reader::from_path(path)?;
        let rows = reader
            .records()
            .map(|r| Ok(r?.iter().map(|x| x.parse().unwrap_or(f64::NAN)).collect()));
        rows.collect()
    };
    let Ok(rows) = read() else { return Value::Null };
    let states = rows.first().map_or(0, |r: &Vec<f64>| r.len().saturating_sub(1) / 2);
    if states == 0 {
        return Value::Null;
    }
    let step = states.div_ceil(MOST_STATES);
    let mut kept: Vec<usize> = (0..states).rev().step_by(step).collect();
    kept.reverse();
    let stride = rows.len().div_ceil(MOST_NODES);
    let last = rows.len() - 1;
    let nodes: Vec<usize> = (0..rows.len()).filter(|k| k % stride == 0 || *k == last).collect();
    let along = |offset: usize| {
        let pairs = kept.iter().flat_map(|s| nodes.iter().map(move |k| (s, k)));
        pack::numbers(pairs.map(|(s, k)| rows[*k][1 + 2 * s + offset]))
    };
    json!({
        "states": kept, "theta": pack::numbers(nodes.iter().map(|&k| rows[k][0])), "x": along(0), "z": along(1),
    })
}
