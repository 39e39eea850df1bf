//! The page of `equilibrium`: the path of states under growing loads.

use serde_json::{Value, json};

use super::placed::{self, thinned_nodes};
use super::{FolderKind, Page, Place, base64, csv_table};
use crate::error::Result;
use crate::output::bands;
use crate::output::equilibrium::{CSV, SHAPES};
use crate::output::folder::{CASE, open};
use crate::output::numbers::{counted, duration, quantity, significant, trimmed};
use crate::results::equilibrium::EquilibriumPath;
use crate::results::run::Status;

/// Largest number of states whose shapes are on the page.
const MOST_STATES: usize = 240;
/// Largest number of nodes of a shape.
const MOST_NODES: usize = 401;

/// Largest number of beams of a structure whose tips have tiles.
const MOST_BEAMS: usize = 4;

/// Figures of the last state: label, quantity, unit, note.
const TILES: [(&str, &str, &str, &str); 4] = [
    ("Tip, across", "tip_u1_m", "m", "deflection u₁ in the last state"),
    ("Tip, along", "tip_u3_m", "m", "displacement u₃ in the last state"),
    (
        "Turn of the tip",
        "tip_angle_rad",
        "rad",
        "slope angle in the last state",
    ),
    (
        "Largest pressure",
        "max_pressure_pa",
        "Pa",
        "gauge, in any bladder, in the last state",
    ),
];

/// Data of the page.
pub fn data(place: &Place) -> Result<Page> {
    let (found, mut page) =
        place.begun::<EquilibriumPath>(FolderKind::Equilibrium, |found| (&found.case, &found.warnings))?;
    let at = found.loads_at_s;
    // share of the loads of the last stage, if it was reached
    let share = found.load_factor.unwrap_or(0.0) - found.via_s.len() as f64;
    let tile = |label: &str, (name, value): (&str, Option<f64>), unit: &str, note: &str| {
        let value = value?;
        let least = if unit == "Pa" { 1e-9 } else { 1e-15 };
        let value = if value.abs() < least { 0.0 } else { value };
        let text = |x: f64, digits: usize| quantity(x, unit, digits);
        let band = found.bands.get(name).map(|band| bands::beside(band, value, &text));
        Some(json!({"label": label, "value": quantity(value, unit, 3), "note": note, "band": band}))
    };
    let last = |name: &str| {
        found
            .quantities
            .as_ref()
            .and_then(|all| all.named(name).copied().flatten())
    };
    let [label, note] = match found.via_s.len() {
        0 => ["Share of the loads", "at the end of the path"],
        _ => ["Load factor", "at the end of the path; every stage before counts 1"],
    };
    let first = tile(label, ("", found.load_factor), "1", note);
    let beams: Vec<&str> = place
        .case
        .iter()
        .flat_map(|case| &case.beams)
        .map(|beam| beam.name.as_str())
        .collect();
    let single = |(_, name, ..): &&(&str, &str, &str, &str)| beams.is_empty() || !name.starts_with("tip_");
    let others = TILES
        .iter()
        .filter(single)
        .map(|(label, name, unit, note)| tile(label, (name, last(name)), unit, note));
    let of_beams = beams.iter().take(MOST_BEAMS).flat_map(|beam| {
        [("u₁", "u1_m"), ("u₃", "u3_m")].map(|(symbol, key)| {
            let name = format!("{beam}.tip_{key}");
            let note = format!("displacement in the axes of {beam} in the last state");
            tile(&format!("Tip of {beam}, {symbol}"), (&name, last(&name)), "m", &note)
        })
    });
    let of_beams: Vec<_> = of_beams.collect();
    let tone = if found.status == Status::Failed { "bad" } else { "good" };
    page.fill(json!({
        "label": "Static equilibrium", "headlines": super::history::headlines(&beams),
        "status": {"word": found.status, "tone": tone, "reason": found.reason}, "answer": answer(&found, share, if beams.is_empty() { "beam" } else { "structure" }),
        "facts": [
            counted(found.states as u64, "state"),
            counted(found.solver.newton_iterations, "Newton step"),
            format!("found in {}", duration(found.wall_s.total)),
        ],
        "tiles": std::iter::once(first).chain(of_beams).chain(others).flatten().collect::<Vec<_>>(),
        "events": found.events, "derivatives": found.sensitivities,
        "path": csv_table::read(&place.path(CSV), |_| true), "shapes": shapes(place),
        "command": format!("slcbeam equilibrium {CASE}{} --at {at} --load-factor {share}", via(&found)),
    }));
    Ok(page)
}

/// Argument with the stages before the last one.
fn via(found: &EquilibriumPath) -> String {
    // stages of valves need no argument
    let asked = found.via_s.iter().filter(|_| found.valves_s.is_empty());
    let instants: Vec<String> = asked.map(f64::to_string).collect();
    match instants.as_slice() {
        [] => String::new(),
        _ => format!(" --via {}", instants.join(",")),
    }
}

fn answer(found: &EquilibriumPath, share: f64, thing: &str) -> String {
    let short = |x: f64| trimmed(&significant(x, 4));
    let loads = match found.via_s.last() {
        None => format!(
            "{} % of the loads at t = {} s",
            short(100.0 * share),
            short(found.loads_at_s)
        ),
        Some(_) if share < 0.0 => format!("{} of the stages of the loads", short(found.load_factor.unwrap_or(0.0))),
        Some(before) => format!(
            "{} % of the way from the loads at t = {} s to those at t = {} s",
            short(100.0 * share),
            short(*before),
            short(found.loads_at_s)
        ),
    };
    let stability = match found.stability.map(|s| s.unstable_modes) {
        None => "its stability is not known".to_string(),
        Some(0) => "it is stable".to_string(),
        Some(1) => "it is unstable (1 unstable mode)".to_string(),
        Some(n) => format!("it is unstable ({n} unstable modes)"),
    };
    let way = match found.events.len() {
        0 => "The path to it has no critical points.".to_string(),
        1 => "The path to it has one event, listed below.".to_string(),
        n => format!("The path to it has {n} events, listed below."),
    };
    format!("Under {loads} the {thing} rests in the state shown; {stability}. {way}")
}

/// Positions of the nodes in some of the states, the last among them.
fn shapes(place: &Place) -> Value {
    let read = || -> csv::Result<Vec<Vec<f64>>> {
        let mut reader = csv::Reader::from_reader(open(&place.path(SHAPES))?);
        // rows of a structure begin with the name of the beam
        let named = usize::from(reader.headers()?.get(0) == Some("beam"));
        let row = |r: csv::StringRecord| r.iter().skip(named).map(|x| x.parse().unwrap_or(f64::NAN)).collect();
        let rows = reader.records().map(|r| Ok(row(r?)));
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
    let placed = place.placed(rows.len());
    let nodes = thinned_nodes(rows.len(), placed.as_ref(), MOST_NODES);
    let along = |offset: usize| {
        let pairs = kept.iter().flat_map(|s| nodes.iter().map(move |k| (s, k)));
        base64::numbers(pairs.map(|(s, k)| rows[*k][1 + 2 * s + offset]))
    };
    let mut page = json!({
        "states": kept, "theta": base64::numbers(nodes.iter().map(|&k| rows[k][0])), "x": along(0), "z": along(1),
    });
    placed::add(&mut page, placed.as_ref(), &nodes);
    page
}
