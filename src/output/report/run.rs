//! Page of a run, or of a cycle of `periodic`.

use std::{io, thread};

use serde_json::{Value, json};

use super::history::ReportHistory;
use super::{FolderKind, Page, Place, cycles, energy_balance, facts, frames, inputs, per_cycle};
use crate::discrete::quantities::Interest;
use crate::error::Result;
use crate::model::characteristic;
use crate::numerics::threads::begin;
use crate::output::bands;
use crate::output::envelope::HistorySource as Recorded;
use crate::output::error_band;
use crate::output::folder::{CASE, ENVELOPE, ERRORS, FIELDS, HISTORY, SUMMARY};
use crate::output::numbers::{counted, duration, error_percent, percent, quantity, significant, trimmed, with_error};
use crate::output::periodic::CYCLE;
use crate::output::summary;
use crate::results::cycles::CycleResult;
use crate::results::run::{Quantity, Status, Summary};

/// Displacements below this [m] are round-off.
const ROUND_OFF: f64 = 1e-14;

/// Data of the page.
pub fn data(place: &Place) -> Result<Page> {
    let there = place.path(SUMMARY).is_file();
    let found = there.then(|| summary::found(place.dir)).transpose()?;
    if let (Some(found), None) = (&found, place.history) {
        for name in [HISTORY, ENVELOPE, ERRORS] {
            summary::verify_table(place.dir, name, &found.result)?;
        }
    }
    let band = error_band::read(place.dir)?;
    let (summary, head) = found.map(|found| (found.result, found.head)).unzip();
    let case = place.case.as_ref();
    let name = summary.as_ref().map(|s| &s.case).or(case.map(|c| &c.name));
    let frequency = case.and_then(characteristic::forcing_period).map(f64::recip);
    let fields = place.path(FIELDS);
    // reads the fields in a thread
    let (motion, recorded) = thread::scope(|scope| {
        let motion = begin(scope, || frames::read(&fields, frequency));
        let recorded = ReportHistory::read(Recorded::new(place.dir, place.history)).map(|history| {
            let columns = history.json(beside(place, &history, frequency), &band);
            (history, columns)
        });
        (motion.join(), recorded)
    });
    let (history, columns) = recorded?;
    let name = name.map_or("unnamed", String::as_str);
    let numbers = summary.as_ref().map(|s| facts::characteristic(&s.characteristic));
    let mut page = place.page_with(FolderKind::Run, name, head.as_ref(), numbers);
    let mut notes: Vec<String> = vec![];
    let motion = match motion {
        Ok(motion) => motion,
        Err(e) if e.kind() == io::ErrorKind::NotFound => Value::Null,
        // A folder with damaged arrays still has a useful history.
        Err(e) => {
            notes.push(format!(
                "{FIELDS} cannot be read ({e}), so nothing over space is shown."
            ));
            Value::Null
        }
    };
    page.put("motion", motion);
    page.put("history", columns);
    match &summary {
        Some(summary) => fill(&mut page, summary, &history),
        None => {
            let why =
                "The run was interrupted before it could write its summary; shown is what was recorded until then.";
            page.put("status", json!({"word": "interrupted", "tone": "bad", "reason": why}));
        }
    }
    page.warnings.extend(notes);
    if place.path(CYCLE).is_file() {
        let cycle = place.result::<CycleResult>(CYCLE)?.result;
        page.fill(json!({
            "label": "Steady cycle", "answer": cycles::answer(&cycle), "sections": cycles::of_cycle(&cycle),
            "command": format!("slcbeam periodic {CASE}"),
        }));
    } else {
        let answer = summary.as_ref().and_then(answer);
        page.fill(json!({"label": "Run", "answer": answer, "command": format!("slcbeam run {CASE}")}));
    }
    Ok(page)
}

/// Columns beside those of the history: inputs, and the figures over the preceding period of a driven run. A cycle has no inputs: it counts
/// time from the start of a period, the case does not.
fn beside(place: &Place, history: &ReportHistory, frequency: Option<f64>) -> Vec<Value> {
    let case = place.case.as_ref().filter(|_| !place.path(CYCLE).is_file());
    let inputs = case.map_or_else(Vec::new, |case| {
        inputs::columns(case, history.times(), history.joined())
    });
    let cycles = frequency.map_or_else(Vec::new, |f| per_cycle::columns(history, 1.0 / f));
    inputs.into_iter().chain(cycles).collect()
}

fn fill(page: &mut Page, summary: &Summary, history: &ReportHistory) {
    let (word, tone) = match summary.status {
        Status::Finished => ("finished", "good"),
        Status::Stopped => ("stopped early", "fair"),
        Status::OutOfRange => ("left the model's range", "bad"),
        Status::Failed => ("failed", "bad"),
    };
    page.warnings.clone_from(&summary.warnings);
    page.fill(json!({
        "status": {"word": word, "tone": tone, "reason": summary.reason}, "facts": facts_line(summary), "tiles": tiles(summary),
        "ledger": energy_balance::to_json(summary, history), "effects": facts::effects(summary), "work": facts::work(summary),
        "remarks": remarks(summary),
    }));
}

/// Facts in one line under the title.
fn facts_line(summary: &Summary) -> Vec<String> {
    let simulated = trimmed(&quantity(summary.time_s, "s", 4));
    vec![
        format!("{simulated} simulated in {}", duration(summary.wall_s.known())),
        counted(summary.unknowns as u64, "unknown"),
        counted(summary.solver.steps, "step"),
    ]
}

/// Replaces round-off by zero.
fn settled(x: f64) -> f64 {
    if x.abs() < ROUND_OFF { 0.0 } else { x }
}

/// Time of the largest value, and the value at the end; angles in degrees.
fn when_and_end(found: Option<&Quantity>, unit: &str) -> String {
    let Some(found) = found else {
        return String::new();
    };
    let degrees = |x: f64| format!("{}°", trimmed(&significant(settled(x).to_degrees(), 3)));
    let angle = unit == "rad";
    let largest = found.largest().filter(|_| angle).map(|x| format!(", {}", degrees(x)));
    let at = found.max_abs_at_s.map(|t| format!(", at {}", time(t)));
    let end = found.last.map(|x| match angle {
        true => format!("; {} at the end", degrees(x)),
        false => format!("; {} at the end", quantity(settled(x), unit, 3)),
    });
    [largest, at, end].into_iter().flatten().collect()
}

fn time(t: f64) -> String {
    trimmed(&quantity(t, "s", 3))
}

/// Sentence about the displacement of the tip.
fn answer(summary: &Summary) -> Option<String> {
    let beams: Vec<String> = summary
        .beams()
        .take(MOST_BEAMS)
        .filter_map(|beam| of_beam(summary, beam))
        .collect();
    if !beams.is_empty() {
        return Some(beams.join(" "));
    }
    let one = Interest::TipU1;
    let found = summary.quantity(one.name())?;
    let (last, largest) = (settled(found.last?), settled(found.largest()?));
    let at = found.max_abs_at_s.map(|t| format!(", at t = {}", time(t)));
    Some(format!(
        "Final tip deflection u₁ = {}; largest {}{}.",
        quantity(last, "m", 3),
        quantity(largest, "m", 3),
        at.unwrap_or_default()
    ))
}

/// Sentence about the displacement of the tip of a beam of a structure.
fn of_beam(summary: &Summary, beam: &str) -> Option<String> {
    let [u1, u3] = ["u1", "u3"].map(|axis| summary.probes.get(&format!("{beam}.tip_{axis}_m")));
    let (u1, u3) = (u1?, u3?);
    let shown = |value: Option<f64>| Some(quantity(settled(value?), "m", 3));
    Some(format!(
        "Tip of {beam} at the end: u₁ {}, u₃ {}; largest {}, {}.",
        shown(u1.last)?,
        shown(u3.last)?,
        shown(u1.largest())?,
        shown(u3.largest())?
    ))
}

/// Largest number of beams of a structure whose tips are in sentence and tiles.
const MOST_BEAMS: usize = 4;

/// Text of a tile, and of its band.
type Shown = (String, Option<String>);

/// A figure of a quantity in a unit (`%` for a fraction) with its error; `figures` lists the candidates for its name.
fn figure(summary: &Summary, (name, figures): (&str, &[&str]), value: f64, unit: &str) -> Shown {
    let formatted = |x: f64, digits: usize| match (unit, digits) {
        ("%", 3) => percent(x),
        ("%", _) => format!("{} %", significant(100.0 * x, digits)),
        _ => quantity(x, unit, digits),
    };
    let with = |error: f64| match unit {
        "%" => with_error(100.0 * value, 100.0 * error, "1") + " %",
        _ => with_error(value, error, unit),
    };
    let band = bands::find(&summary.bands, name, figures, value);
    let error = figures.iter().find_map(|figure| summary.error(name, figure));
    let text = error.map_or_else(|| formatted(value, 3), with);
    (text, band.map(|band| bands::beside(band, value, &formatted)))
}

/// Names of the largest value of a quantity, and of an energy at the end; over the period for a cycle.
const LARGEST: [&str; 3] = ["extreme", "max_abs", "window_max_abs"];
const AT_THE_END: [&str; 2] = ["final", "window"];

fn tiles(summary: &Summary) -> Vec<Value> {
    let largest = |name: &str| summary.quantity(name)?.largest();
    let mut all = vec![];
    let mut tile = |label: &str, shown: Option<Shown>, note: &str| {
        if let Some((text, band)) = shown {
            all.push(json!({"label": label, "value": text, "note": note, "band": band}));
        }
    };
    let last = |name: &str, unit: &str| {
        let value = summary.quantity(name)?.last?;
        Some(figure(summary, (name, &AT_THE_END), value, unit))
    };
    let most = |name: &str, unit: &str| {
        let value = settled(largest(name)?);
        Some(figure(summary, (name, &LARGEST), value, unit))
    };
    let tip = [
        (Interest::TipU1, "Tip, across", "largest deflection u₁"),
        (Interest::TipU3, "Tip, along", "largest displacement u₃"),
        (Interest::TipAngle, "Turn of the tip", "largest slope angle"),
    ];
    let beams: Vec<&str> = summary.beams().take(MOST_BEAMS).collect();
    for beam in &beams {
        for (symbol, key, unit) in [("u₁", "u1_m", "m"), ("u₃", "u3_m", "m")] {
            let name = format!("{beam}.tip_{key}");
            let found = summary.probes.get(&name);
            let value = found.and_then(Quantity::largest).map(settled);
            let shown = value.map(|value| figure(summary, (&name, &LARGEST), value, unit));
            let when = when_and_end(found, unit);
            let note = format!("largest displacement {symbol} in the axes of {beam}{when}");
            tile(&format!("Tip of {beam}, {symbol}"), shown, &note);
        }
    }
    for (one, label, words) in tip.into_iter().filter(|_| beams.is_empty()) {
        let value = most(one.name(), one.unit());
        let when = when_and_end(summary.quantity(one.name()), one.unit());
        tile(label, value, &format!("{words}{when}"));
    }
    if let Some(step) = summary.step_response.get(Interest::TipU1.name()) {
        let settles = step
            .settling_time_5_percent_s
            .map_or(String::new(), |t| format!("; within 5 % after {}", quantity(t, "s", 3)));
        let rises = step.rise_time_s.map(|t| (quantity(t, "s", 3), None));
        let way = format!("of u₁ at the tip, from 10 to 90 % of its way{settles}");
        tile("Rise time", rises, &way);
    }
    let window = summary
        .quantity("max_pressure_pa")
        .and_then(|q| q.window_extreme.or(q.window_max_abs));
    let window = window.map_or("gauge, in any bladder".into(), |p| {
        format!("in any bladder; {} in the last part", quantity(p, "Pa", 3))
    });
    tile("Largest pressure", most("max_pressure_pa", "Pa"), &window);
    let put_in = last("input_energy_j", "J");
    tile("Energy put in", put_in, "by loads, driven ends and ports");
    tile("Harvested", last("harvested_energy_j", "J"), "by the turbines");
    let power = |name: &str| summary.quantity(name)?.window_power_w;
    let harvested = power("harvested_energy_j").map(|p| {
        let mean = figure(summary, ("harvested_power_w", &["mean"]), p, "W");
        match mean.1 {
            None => figure(summary, ("harvested_energy_j", &["window_power_w"]), p, "W"),
            Some(_) => mean,
        }
    });
    let put_in = power("input_energy_j").map_or_else(|| "unknown".into(), |p| quantity(p, "W", 3));
    let note = format!("mean over the last part; put in: {put_in}");
    tile("Power harvested", harvested, &note);
    let efficiency = summary.quantity("efficiency");
    let absent = efficiency.is_some_and(|q| q.final_absent.is_some());
    let without = match absent {
        true => "no value: the energy put in is below the numerical error",
        false => "harvested over put in",
    };
    let window = efficiency.and_then(|q| q.window).map_or(without.into(), |e| {
        format!("{without}; {} in the last part", percent(e))
    });
    tile("Efficiency", last("efficiency", "%"), &window);
    let open = summary.balances.energy_residual_relative;
    let open = open.is_finite().then(|| (percent(open), None));
    let note = "of the largest energy: the error of the integration";
    tile("Unaccounted energy", open, note);
    all
}

/// Further facts of a summary: growth, accuracy, derivatives.
fn remarks(summary: &Summary) -> Vec<Value> {
    let mut all = vec![];
    if let Some(growth) = &summary.growth {
        all.push(json!({"title": "The response grows", "text": format!(
            "The largest deflection grows at about {} per second; at the end it is {} times what it was after a quarter of the run.",
            significant(growth.rate_per_s, 3), significant(growth.factor, 3)
        )}));
    }
    if let Some(found) = &summary.accuracy {
        let errors = found
            .quantities
            .iter()
            .filter_map(|(name, e)| Some(format!("{name} {}", error_percent(e.total?))));
        all.push(json!({"title": if found.reached { "The accuracy asked for is reached" } else { "The accuracy asked for is not reached" },
            "text": format!(
                "Asked for were {}; the errors are {}. Used were {} and a tolerance of {}.",
                error_percent(found.asked), errors.collect::<Vec<_>>().join(", "), found.cells(), significant(found.rtol, 2)
            )}));
    }
    for (pointer, s) in &summary.sensitivities {
        let parts = s.quantities.iter().filter_map(|(name, slope)| {
            let ratio = slope.max_abs? * s.value / summary.quantity(name)?.max_abs?;
            ratio
                .is_finite()
                .then(|| format!("{name} by {} %", significant(ratio, 3)))
        });
        all.push(json!({"title": format!("One per cent more of {pointer}"),
            "text": format!("changes the largest values of {}.", parts.collect::<Vec<_>>().join(", "))}));
    }
    all
}
