//! The page of `modes`: frequencies, damping and moving shapes.

use std::io;
use std::path::Path;

use serde_json::{Map, Value, json};

use super::{Kind, Place, pack, sheet};
use crate::error::Result;
use crate::output::folder::CASE;
use crate::output::modes::{ARRAYS, CSV, JSON, PICTURE};
use crate::output::npz::Npz;
use crate::output::numbers::count;

/// Columns of the table that a reader needs; the file has the rest.
const COLUMNS: [&str; 9] = [
    "mode [1]",
    "kind",
    "frequency [Hz]",
    "damping ratio [1]",
    "growth rate [1/s]",
    "time constant [s]",
    "undrained frequency [Hz]",
    "drained frequency [Hz]",
    "transverse share [1]",
];

/// Numbers of all shapes together.
const MOST_NUMBERS: usize = 420_000;

/// Everything the page shows.
pub fn data(place: &Place) -> Result<Map<String, Value>> {
    let found = place.json(JSON)?;
    let text = |key: &str| found.get(key).and_then(Value::as_str).unwrap_or("").to_string();
    let number = |key: &str| found.get(key).and_then(Value::as_f64).unwrap_or(0.0);
    let mut all = place.head(Kind::Modes, &text("case"));
    let mut put = |key: &str, value: Value| all.insert(key.into(), value);
    let stable = found.get("stable").and_then(Value::as_bool).unwrap_or(false);
    put("label", "Modes of small motions".into());
    put(
        "status",
        json!({"word": if stable { "stable" } else { "unstable" }, "tone": if stable { "good" } else { "bad" }, "reason": null}),
    );
    let warnings = found.get("warnings").and_then(Value::as_array);
    let mut warnings = warnings.cloned().unwrap_or_default();
    put(
        "answer",
        format!(
            "Small motions about {}, loads and valves held as at t = {} s: {}.",
            text("about"),
            number("at_s"),
            text("verdict")
        )
        .into(),
    );
    put(
        "facts",
        json!([
            format!("{} unknowns", count(number("unknowns") as u64)),
            format!("{} finite eigenvalues", count(number("finite_eigenvalues") as u64)),
        ]),
    );
    put("table", sheet::read(&place.path(CSV), |name| COLUMNS.contains(&name)));
    put("modes", found.get("modes").cloned().unwrap_or_default());
    let shapes = shapes(&place.path(ARRAYS));
    if let Some(e) = shapes.as_ref().err().filter(|e| e.kind() != io::ErrorKind::NotFound) {
        let told = format!("{ARRAYS} cannot be read ({e}), so no shapes are shown.");
        warnings.push(told.into());
    }
    put("warnings", warnings.into());
    put("shapes", shapes.unwrap_or_default());
    put("picture", json!(place.picture(PICTURE)));
    put(
        "passivity",
        found
            .get("passivity")
            .and_then(|p| p.get("words").or(Some(p)))
            .filter(|p| p.is_string())
            .cloned()
            .unwrap_or_default(),
    );
    let modes = found.get("modes").and_then(Value::as_array).map_or(12, Vec::len);
    let near = match number("near_hz") {
        0.0 => String::new(),
        near => format!(" --near {near}"),
    };
    let at = match text("about").starts_with("the equilibrium") {
        true => format!(" --at {}", number("at_s")),
        false => String::new(),
    };
    put(
        "command",
        format!("slcbeam modes {CASE}{at} --count {modes}{near}").into(),
    );
    Ok(all)
}

/// Amplitudes and phases, mode after mode; of many modes on a fine mesh the first ones.
fn shapes(path: &Path) -> io::Result<Value> {
    let mut npz = Npz::open(path)?;
    let mut read = |name: &str| -> io::Result<(Vec<usize>, Vec<f64>)> {
        let values = npz.read(name)?;
        let shape = npz.entry(name).map(|e| e.shape.clone()).unwrap_or_default();
        Ok((shape, values))
    };
    let mut all = Map::new();
    let (nodes, theta) = read("theta_m")?;
    all.insert("theta_m".into(), pack::numbers(theta));
    // A dry beam has no bladders.
    let bladders = read("pressure_amplitude_pa")
        .ok()
        .and_then(|(shape, _)| shape.get(1).copied());
    let most = MOST_NUMBERS / (4 * nodes.first().copied().unwrap_or(1) + 2 * bladders.unwrap_or(0)).max(1);
    let beam = ["u1_amplitude_m", "u1_phase_rad", "u3_amplitude_m", "u3_phase_rad"];
    let fluid = ["pressure_amplitude_pa", "pressure_phase_rad"];
    let wanted = beam.iter().chain(fluid.iter().filter(|_| bladders.is_some()));
    for name in wanted {
        let (shape, values) = read(name)?;
        let kept = most.max(1) * shape.get(1).copied().unwrap_or(1);
        all.insert((*name).into(), pack::numbers(values.into_iter().take(kept)));
    }
    all.insert("bladders".into(), json!(bladders));
    all.insert("most".into(), json!(most.max(1)));
    Ok(Value::Object(all))
}
