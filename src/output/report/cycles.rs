//! The pages of `floquet`, of its map, of `periodic --sweep`; and what a cycle's run adds to its page.

use serde_json::{Map, Value, json};

use super::{Kind, MOST_ROWS, Place, capital};
use crate::error::Result;
use crate::output::folder::CASE;
use crate::output::numbers::{count, significant};

/// Rows of a table, and what stands over it.
fn multipliers(found: &Value) -> Value {
    let all = found
        .pointer("/floquet/multipliers")
        .and_then(Value::as_array)
        .cloned()
        .unwrap_or_default();
    let row = |m: &Value| {
        let part = match m.get("part") {
            Some(Value::String(part)) if part == "along" => "motion along".to_string(),
            Some(Value::String(part)) => part.clone(),
            Some(other) => other
                .get("bending")
                .map_or(other.to_string(), |k| format!("bending mode {k}")),
            None => String::new(),
        };
        let at = |key: &str| m.get(key).cloned().unwrap_or_default();
        json!([
            at("re"),
            at("im"),
            at("modulus"),
            at("growth_per_s"),
            at("frequency_hz"),
            part,
            at("share")
        ])
    };
    json!({
        "title": "Multipliers",
        "about": "A small disturbance of the cycle is multiplied by these numbers in every period. It dies away where the modulus is \
                  below 1 and grows where it is above.",
        "headings": ["real part", "imaginary part", "modulus", "growth [1/s]", "frequency [Hz]", "mostly", "share of energy"],
        "rows": all.iter().map(row).collect::<Vec<_>>(), "file": null,
    })
}

fn verdict(found: &Value) -> (String, bool) {
    let words = found
        .pointer("/floquet/verdict/words")
        .and_then(Value::as_str)
        .unwrap_or("");
    let unstable = found.pointer("/floquet/verdict/stability").and_then(Value::as_str) == Some("unstable");
    (capital(words), !unstable)
}

fn search(found: &Value) -> String {
    let number = |pointer: &str| found.pointer(pointer).and_then(Value::as_f64).unwrap_or(0.0);
    format!(
        "The cycle of {} s was found in {} Newton steps over {} periods, with {} steps a period.",
        significant(number("/floquet/period_s"), 4),
        count(number("/cycle/newton_steps") as u64),
        count(number("/cycle/periods") as u64),
        count(number("/cycle/steps_per_period") as u64),
    )
}

/// Whether a cycle is stable, and how it was found.
pub fn answer(found: &Value) -> String {
    format!("{}. {}", verdict(found).0, search(found))
}

/// What `cycle.json` adds to the page of a cycle's run.
pub fn of_cycle(found: &Value) -> Vec<Value> {
    vec![json!({"title": "Stability of the cycle", "text": answer(found), "table": multipliers(found)})]
}

/// `floquet`.
pub fn floquet(place: &Place) -> Result<Map<String, Value>> {
    let found = place.json("floquet.json")?;
    let mut all = head(place, Kind::Floquet, &found, "Stability of the steady cycle");
    let mut put = |key: &str, value: Value| all.insert(key.into(), value);
    let (_, stable) = verdict(&found);
    put(
        "status",
        json!({"word": if stable { "stable" } else { "unstable" }, "tone": if stable { "good" } else { "bad" }, "reason": null}),
    );
    put("answer", answer(&found).into());
    put(
        "figures",
        json!([{
            "title": "Multipliers in the complex plane",
            "picture": place.picture("floquet.svg"),
            "about": "Within the circle of radius 1 disturbances die away; a mark outside it is a disturbance that grows.",
        }]),
    );
    put("table", multipliers(&found));
    put("command", format!("slcbeam floquet {CASE}").into());
    Ok(all)
}

fn head(place: &Place, kind: Kind, found: &Value, label: &str) -> Map<String, Value> {
    let name = found.get("case").and_then(Value::as_str).unwrap_or("unnamed");
    let mut all = place.head(kind, name);
    all.insert("label".into(), label.into());
    all.insert(
        "warnings".into(),
        found
            .get("warnings")
            .filter(|w| w.is_array())
            .cloned()
            .unwrap_or(json!([])),
    );
    all
}

/// `floquet --map`.
pub fn map(place: &Place) -> Result<Map<String, Value>> {
    let found = place.json("map.json")?;
    let mut all = head(place, Kind::Map, &found, "Where shaking is stable");
    let mut put = |key: &str, value: Value| all.insert(key.into(), value);
    let list = |key: &str| -> Vec<f64> {
        let values = found.get(key).and_then(Value::as_array);
        values.into_iter().flatten().filter_map(Value::as_f64).collect()
    };
    let (frequencies, amplitudes) = (list("frequencies_hz"), list("amplitudes_m"));
    let sheets = found
        .get("sheets")
        .and_then(Value::as_array)
        .cloned()
        .unwrap_or_default();
    let mut rows = vec![];
    let mut answers = vec![];
    for sheet in &sheets {
        let factor = sheet.get("permeability_factor").cloned().unwrap_or_default();
        let (mut points, mut growing) = (0, 0);
        for (k, f) in frequencies.iter().enumerate() {
            for (i, a) in amplitudes.iter().enumerate() {
                let Some(point) = sheet.pointer(&format!("/points/{k}/{i}")) else {
                    continue;
                };
                let growth = point.get("growth_per_s").and_then(Value::as_f64);
                let words = point.get("words").and_then(Value::as_str).unwrap_or("");
                points += 1;
                growing += usize::from(growth.is_some_and(|g| g > 0.0) && !words.starts_with("neutral"));
                if rows.len() < MOST_ROWS {
                    rows.push(json!([factor, f, a, growth, words]));
                }
            }
        }
        let name = factor.as_f64().map_or("The dry beam".into(), |f| {
            format!("With permeabilities × {}", significant(f, 2))
        });
        answers.push(format!("{name} the motion grows at {growing} of {points} points."));
    }
    put("answer", answers.join(" ").into());
    put(
        "facts",
        json!([
            format!("{} frequencies", frequencies.len()),
            format!("{} amplitudes", amplitudes.len())
        ]),
    );
    put(
        "figures",
        json!([{
            "title": "Growth over frequency and amplitude",
            "picture": place.picture("map.svg"),
            "about": "Each cell is one frequency and one amplitude of shaking. Where the colour says growth, bending swings up by itself \
                      even though the beam is shaken along its axis only.",
        }]),
    );
    put(
        "table",
        json!({
            "title": "Every point", "about": "",
            "headings": ["permeability factor", "frequency [Hz]", "amplitude [m]", "growth [1/s]", "verdict"],
            "left_out": (frequencies.len() * amplitudes.len() * sheets.len()).saturating_sub(rows.len()), "rows": rows, "file": "map.csv",
        }),
    );
    let range = |v: &[f64]| format!("{}:{}", v.first().unwrap_or(&0.0), v.last().unwrap_or(&0.0));
    put(
        "command",
        format!(
            "slcbeam floquet {CASE} --map frequency,amplitude --range {},{} --points {},{}",
            range(&frequencies),
            range(&amplitudes),
            frequencies.len(),
            amplitudes.len()
        )
        .into(),
    );
    Ok(all)
}

/// `periodic --sweep`.
pub fn sweep(place: &Place) -> Result<Map<String, Value>> {
    let found = place.json("sweep.json")?;
    let mut all = head(place, Kind::Sweep, &found, "Steady cycles along a parameter");
    let mut put = |key: &str, value: Value| all.insert(key.into(), value);
    let pointer = found.get("pointer").and_then(Value::as_str).unwrap_or("").to_string();
    let members = found
        .get("members")
        .and_then(Value::as_array)
        .cloned()
        .unwrap_or_default();
    let missing = found.get("missing").and_then(Value::as_array).map_or(0, Vec::len);
    let number = |m: &Value, pointer: &str| m.pointer(pointer).and_then(Value::as_f64);
    let stability = |m: &Value| m.pointer("/floquet/verdict/stability").and_then(Value::as_str) == Some("unstable");
    let unstable = members.iter().filter(|m| stability(m)).count();
    let (low, high) = members
        .iter()
        .filter_map(|m| number(m, "/value"))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    put(
        "answer",
        format!(
            "{} steady cycles were found for {pointer} from {} to {}; {} of them unstable.{}",
            members.len(),
            significant(low, 3),
            significant(high, 3),
            unstable,
            if missing > 0 {
                format!(" For {missing} values none was found.")
            } else {
                String::new()
            }
        )
        .into(),
    );
    put(
        "figures",
        json!([{
            "title": "Along the parameter",
            "picture": place.picture("sweep.svg"),
            "about": "What the steady cycle does for each value of the parameter, each found from the one before, without its transient.",
        }]),
    );
    let row = |m: &Value| {
        let largest = |name: &str| number(m, &format!("/quantities/{name}/window_max_abs"));
        json!([
            number(m, "/value"),
            largest("tip_u1_m"),
            largest("tip_u3_m"),
            largest("max_pressure_pa"),
            number(m, "/floquet/verdict/growth_per_s"),
            m.pointer("/floquet/verdict/words"),
        ])
    };
    put(
        "table",
        json!({
            "title": "Every cycle", "about": "Largest values within the cycle, and how fast the slowest disturbance grows (below 0: dies away).",
            "headings": [pointer, "tip u₁ [m]", "tip u₃ [m]", "pressure [Pa]", "growth [1/s]", "verdict"],
            "left_out": members.len().saturating_sub(MOST_ROWS),
            "rows": members.iter().take(MOST_ROWS).map(row).collect::<Vec<_>>(), "file": "sweep.csv",
        }),
    );
    let logarithmic = if found.get("logarithmic").and_then(Value::as_bool) == Some(true) {
        ":log"
    } else {
        ""
    };
    put(
        "command",
        format!(
            "slcbeam periodic {CASE} --sweep {pointer}={low}:{high}:{}{logarithmic}",
            members.len() + missing
        )
        .into(),
    );
    Ok(all)
}
