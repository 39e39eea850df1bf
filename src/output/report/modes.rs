//! The page of `modes`: frequencies, damping and moving shapes.

use std::io;
use std::path::Path;

use serde_json::{Map, Value, json};

use super::{FolderKind, Page, Place, base64, capital, csv_table, placed};
use crate::discrete::quantities::{FieldAxis, PlacedNodes};
use crate::error::Result;
use crate::output::bands;
use crate::output::folder::CASE;
use crate::output::modes::{ARRAYS, CSV, PICTURE};
use crate::output::npz::Npz;
use crate::output::numbers::{counted, significant};
use crate::results::modes::{LinearisedState, ModesRecord};

/// Columns of the page's table; the file contains the rest.
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

/// Largest number of values of all shapes.
const MOST_NUMBERS: usize = 420_000;

/// Data of the page.
pub fn data(place: &Place) -> Result<Page> {
    let (found, mut page) = place.begun::<ModesRecord>(FolderKind::Modes, |found| (&found.case, &found.warnings))?;
    let (word, tone) = if found.stable {
        ("stable", "good")
    } else {
        ("unstable", "bad")
    };
    let table = csv_table::read(&place.path(CSV), |name| COLUMNS.contains(&name));
    let shapes = shapes(&place.path(ARRAYS));
    if let Some(e) = shapes.as_ref().err().filter(|e| e.kind() != io::ErrorKind::NotFound) {
        let warning = format!("{ARRAYS} cannot be read ({e}), so no shapes are shown.");
        page.warnings.push(warning);
    }
    let near = Some(found.near_hz).filter(|near| *near != 0.0);
    let near = near.map_or(String::new(), |near| format!(" --near {near}"));
    // Older results do not store the state. At 0 s it is then taken as the start, later as an equilibrium.
    let at = match (found.state, found.at_s) {
        (Some(LinearisedState::Start), _) | (None, 0.0) => String::new(),
        (_, at) => format!(" --at {at}"),
    };
    let kind = found
        .of_kind
        .map_or(String::new(), |sort| format!(" --kind {}", sort.word()));
    let moving = found.modes.iter().filter(|mode| !mode.kind.stays()).count();
    page.fill(json!({
        "label": "Modes of small motions", "status": {"word": word, "tone": tone, "reason": null},
        "answer": format!("Small motions about {}, loads and valves held as at t = {} s: {}.", found.about, found.at_s, found.verdict),
        "facts": [
            counted(found.unknowns as u64, "unknown"),
            counted(found.finite_eigenvalues as u64, "finite eigenvalue"),
        ],
        "table": moving_alone(with_bands(table, &found), &found), "modes": found.modes,
        "shapes": shapes.unwrap_or_default(), "picture": place.picture(PICTURE),
        "passivity": found.coupling.map(|coupling| capital(&coupling.words)),
        "command": format!("slcbeam modes {CASE}{at} --count {moving}{near}{kind}"),
    }));
    Ok(page)
}

/// Removes the modes that do not move from the table.
fn moving_alone(mut table: Value, found: &ModesRecord) -> Value {
    if let Some(rows) = table["rows"].as_array_mut() {
        let mut kinds = found.modes.iter().map(|mode| mode.kind);
        rows.retain(|_| kinds.next().is_none_or(|kind| !kind.stays()));
    }
    table
}

/// Inserts uncertainty bands behind frequencies and growth rates, if there are any.
fn with_bands(mut table: Value, found: &ModesRecord) -> Value {
    if found.modes.iter().all(|mode| mode.bands.is_empty()) {
        return table;
    }
    for (heading, key) in [
        ("frequency [Hz]", "frequency_hz"),
        ("growth rate [1/s]", "growth_per_s"),
    ] {
        let Some(headings) = table["headings"].as_array_mut() else {
            continue;
        };
        let Some(place) = headings.iter().position(|own| own == heading).map(|k| k + 1) else {
            continue;
        };
        headings.insert(place, json!(format!("95 % of samples: {heading}")));
        for (row, mode) in table["rows"].as_array_mut().into_iter().flatten().zip(&found.modes) {
            let text = mode.bands.get(key).and_then(|band| bands::between(band, &significant));
            if let Some(row) = row.as_array_mut().filter(|row| row.len() >= place) {
                row.insert(place, json!(text));
            }
        }
    }
    table
}

/// Amplitudes and phases, mode after mode; of many modes on a fine mesh only the first.
fn shapes(path: &Path) -> io::Result<Value> {
    let mut npz = Npz::open(path)?;
    let mut read = |name: &str| -> io::Result<(Vec<usize>, Vec<f64>)> {
        let values = npz.read(name)?;
        let shape = npz.entry(name).map(|e| e.shape.clone()).unwrap_or_default();
        Ok((shape, values))
    };
    let mut all = Map::new();
    let (nodes, theta) = read("theta_m")?;
    let placed = PlacedNodes::from_axes(|axis| match axis {
        FieldAxis::Nodes => Some(theta.clone()),
        axis => read(axis.name()).ok().map(|(_, values)| values),
    });
    let chosen: Vec<usize> = (0..theta.len()).collect();
    all.insert("theta_m".into(), base64::numbers(theta));
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
        all.insert((*name).into(), base64::numbers(values.into_iter().take(kept)));
    }
    all.insert("bladders".into(), json!(bladders));
    all.insert("most".into(), json!(most.max(1)));
    let mut all = Value::Object(all);
    placed::add(&mut all, placed.as_ref(), &chosen);
    Ok(all)
}
