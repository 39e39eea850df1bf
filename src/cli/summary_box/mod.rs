//! The box at the end of a run, with the most important results.

mod errors;
mod warnings;

use std::borrow::Cow;
use std::path::Path;

use textwrap::core::display_width;
use textwrap::{Options, WordSplitter};

use crate::discrete::quantities::Interest;
use crate::error::visible;
use crate::output::numbers::{change, count, counted, duration, percent, quantity, significant, trimmed, with_error};
use crate::output::{accuracy, bands};
use crate::run::sensitivity::figures::FigureSensitivity;
use crate::run::summary::{Quantity, Status, Summary};
use errors::{errors, figure};

/// Largest number of lines of a plain entry. Warnings and reasons of failures are printed in full, because their advice is at the end.
const LINES: usize = 2;
/// Largest number of beams of a structure whose tips are shown.
const BEAMS: usize = 4;
/// Smallest share of the wall time that is shown.
const LEAST_SHARE: f64 = 0.005;
/// Separator of the parts of an entry; it stays on the line of the part before it.
const BETWEEN: &str = "\u{a0}· ";
/// Width of the names of entries.
const NAME: usize = 11;
/// Quantities whose largest values have bands and slopes, with their symbols.
const SHOWN: [(Interest, &str); 3] = [
    (Interest::TipU1, "u₁"),
    (Interest::TipU3, "u₃"),
    (Interest::MaxPressure, "p"),
];

/// Color of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tone {
    Plain,
    Good,
    Warning,
    Bad,
}

impl Tone {
    fn paint(self, text: &str, colour: bool) -> String {
        let code = match self {
            _ if !colour => return text.to_string(),
            Self::Plain => return text.to_string(),
            Self::Good => "32",
            Self::Warning => "33",
            Self::Bad => "1;31",
        };
        format!("\u{1b}[{code}m{text}\u{1b}[0m")
    }
}

struct Row {
    name: &'static str,
    text: String,
    tone: Tone,
}

/// Renders the box, `width` columns wide (at least 40), with a newline at the end; colored if `colour` is set. `page` is true if the folder
/// has a page.
pub fn render(summary: &Summary, dir: &Path, page: bool, colour: bool, width: usize) -> String {
    let width = width.clamp(40, 100);
    let (status, tone) = match summary.status {
        Status::Finished => ("finished", Tone::Good),
        Status::Stopped => ("stopped", Tone::Warning),
        Status::OutOfRange => ("OUT OF RANGE", Tone::Bad),
        Status::Failed => ("FAILED", Tone::Bad),
    };
    let room = width - status.len() - 9;
    let case = start(&visible(&summary.case), room);
    let rule = "─".repeat((width - status.len() - 8).saturating_sub(display_width(&case)));
    let mut out = format!("╭─ {case} {rule} {} ─╮\n", tone.paint(status, colour));
    for row in rows(summary, tone) {
        push_row(&mut out, &row, width, colour);
    }
    let what = if page { "report.html and data" } else { "data" };
    let files = visible(&format!("{what} in {}", dir.display())).into_owned();
    let length = display_width(&files);
    if length + 6 <= width {
        out.push_str(&format!("╰─ {files} {}╯\n", "─".repeat(width - length - 5)));
    } else {
        // A path stays whole, so that it can be copied.
        out.push_str(&format!("╰{}╯\n{files}\n", "─".repeat(width - 2)));
    }
    out.replace('\u{a0}', " ")
}

fn rows(summary: &Summary, tone: Tone) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut add = |name, text: Option<String>, tone| {
        if let Some(text) = text.filter(|t| !t.is_empty()) {
            let text = visible(&text).into_owned();
            rows.push(Row { name, text, tone });
        }
    };
    add("why", summary.reason.clone(), tone);
    let (shown, others) = warnings::divide(&summary.warnings);
    for warning in shown {
        add("warning", Some(warning.into()), Tone::Warning);
    }
    add("", others, Tone::Warning);
    let beams: Vec<&str> = summary.beams().collect();
    if beams.is_empty() {
        let [end, largest] = tip(summary, None);
        let below = if end.is_some() { "" } else { "tip" };
        add("tip", end, Tone::Plain);
        add(below, largest, Tone::Plain);
    }
    for (k, beam) in beams.iter().take(BEAMS).enumerate() {
        for (j, text) in tip(summary, Some(beam)).into_iter().enumerate() {
            add(if k + j == 0 { "tips" } else { "" }, text, Tone::Plain);
        }
    }
    if beams.len() > BEAMS {
        let more = counted((beams.len() - BEAMS) as u64, "more beam");
        add("", Some(format!("{more} in summary.json")), Tone::Plain);
    }
    add("pressure", pressure(summary), Tone::Plain);
    add("step", step(summary), Tone::Plain);
    add("energy", energy(summary), Tone::Plain);
    add("uncertain", uncertain(summary), Tone::Plain);
    add("sensitivity", sensitivities(summary), Tone::Plain);
    add("accuracy", accuracy(summary), Tone::Plain);
    add("errors", errors(summary), Tone::Plain);
    add("balances", Some(balances(summary)), Tone::Plain);
    add("integrator", Some(integrator(summary)), Tone::Plain);
    add("time", Some(times(summary)), Tone::Plain);
    let ended_well = !matches!(summary.status, Status::Failed | Status::OutOfRange);
    add("spent on", spent(summary).filter(|_| ended_well), Tone::Plain);
    rows
}

/// Step response of the tip's deflection, if requested.
fn step(summary: &Summary) -> Option<String> {
    let name = Interest::TipU1.name();
    let found = summary.step_response.get(name)?;
    let time = |t: Option<f64>| Some(quantity(t?, "s", 3));
    let parts = [
        time(found.rise_time_s).map(|t| format!("u₁ rises in {t}")),
        time(found.settling_time_5_percent_s).map(|t| format!("within 5 % after {t}")),
        time(found.settling_time_2_percent_s).map(|t| format!("2 % after {t}")),
        found
            .overshoot_percent
            .map(|p| format!("overshoot {} %", significant(p, 3))),
        found.reason.as_ref().map(|reason| format!("u₁: {reason}")),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    Some(parts.join(BETWEEN))
}

/// Bands of the largest figures due to uncertain numbers, beside their numerical errors.
fn uncertain(summary: &Summary) -> Option<String> {
    let of = |(one, word): (Interest, &str)| {
        let value = get(summary, one)?.largest()?;
        let figures = ["extreme", "max_abs", "window_max_abs"];
        let band = bands::find(&summary.bands, one.name(), &figures, value)?;
        let text = hold(format!("{word} {}", bands::short(band, one.unit())?));
        // a narrow box may break the line between the ends of a band
        Some(text.replace("…\u{a0}", "… ").replace("\u{a0}(", " ("))
    };
    let shown: Vec<String> = SHOWN.into_iter().filter_map(of).collect();
    (!shown.is_empty()).then(|| format!("largest, 95 %: {}", shown.join(BETWEEN)))
}

/// Change of the largest deflections and the largest pressure when each number grows by one percent.
fn sensitivities(summary: &Summary) -> Option<String> {
    let of = |(pointer, s): (&String, &FigureSensitivity)| -> String {
        let relative = |one: Interest, word: &str| {
            let of = |all: &std::collections::BTreeMap<String, Quantity>| all.get(one.name())?.max_abs;
            let (value, slope) = (of(&summary.quantities)?, of(&s.quantities)?);
            Some(format!("{word} {}", change(slope * s.value / value)?))
        };
        let shown: Vec<String> = SHOWN
            .into_iter()
            .filter_map(|(one, word)| relative(one, word))
            .collect();
        format!("{pointer} +1 %: largest {}", shown.join(", "))
    };
    Some(summary.sensitivities.iter().map(of).collect::<Vec<_>>().join(BETWEEN))
}

fn push_row(out: &mut String, row: &Row, width: usize, colour: bool) {
    let room = width - NAME - 5;
    let mut lines = lines(&row.text, room);
    if row.tone == Tone::Plain && lines.len() > LINES {
        lines.truncate(LINES);
        if let Some(last) = lines.last_mut() {
            *last = format!("{} …", start(last, room - 2)).into();
        }
    }
    for (k, line) in lines.iter().enumerate() {
        let name = format!("{:<NAME$}", if k == 0 { row.name } else { "" });
        let name = if colour && row.tone == Tone::Plain {
            format!("\u{1b}[2m{name}\u{1b}[0m")
        } else {
            row.tone.paint(&name, colour)
        };
        let pad = " ".repeat(room.saturating_sub(display_width(line)));
        out.push_str(&format!("│ {name} {}{pad} │\n", row.tone.paint(line, colour)));
    }
}

/// Lines of at most `room` columns, broken between words where that is possible.
fn lines(text: &str, room: usize) -> Vec<Cow<'_, str>> {
    textwrap::wrap(text, Options::new(room).word_splitter(WordSplitter::NoHyphenation))
}

/// First of the lines of at most `room` columns.
fn start(text: &str, room: usize) -> String {
    lines(text, room).into_iter().next().unwrap_or_default().into_owned()
}

/// Joins numbers and units by non-breaking spaces, because wrapping breaks at any other space.
fn hold(text: String) -> String {
    text.replace(' ', "\u{a0}")
}

fn get(summary: &Summary, one: Interest) -> Option<&Quantity> {
    summary.quantities.get(one.name())
}

/// Displacements of the tip at the end, and the largest ones with their times; in a structure of a beam, along its axes.
fn tip(summary: &Summary, beam: Option<&str>) -> [Option<String>; 2] {
    let joined = |words: &str, text: &dyn Fn(&str, &Quantity) -> Option<String>| {
        let tip = [("u₁", Interest::TipU1), ("u₃", Interest::TipU3)];
        let one = |(symbol, one): (&str, Interest)| {
            let (name, found) = match beam {
                None => (one.name().to_owned(), get(summary, one)?),
                Some(beam) => {
                    let name = format!("{beam}.{}", one.name());
                    let found = summary.probes.get(&name)?;
                    (name, found)
                }
            };
            Some(hold(format!("{symbol} {}", text(&name, found)?)))
        };
        let parts: Vec<String> = tip.into_iter().filter_map(one).collect();
        let of = beam.map_or(String::new(), |beam| format!("{beam} "));
        (!parts.is_empty()).then(|| format!("{of}{words}: {}", parts.join(BETWEEN)))
    };
    let last = |name: &str, q: &Quantity| Some(figure(summary, (name, "final"), q.last?, "m"));
    let largest = |name: &str, q: &Quantity| {
        let at = q.max_abs_at_s.map(|t| format!(" at {}", trimmed(&quantity(t, "s", 3))));
        Some(figure(summary, (name, "max_abs"), q.largest()?, "m") + &at.unwrap_or_default())
    };
    [joined("at the end", &last), joined("largest", &largest)]
}

fn pressure(summary: &Summary) -> Option<String> {
    let pressure = get(summary, Interest::MaxPressure)?;
    let name = Interest::MaxPressure.name();
    let largest = figure(summary, (name, "max_abs"), pressure.largest()?, "Pa");
    let window = pressure
        .window_extreme
        .or(pressure.window_max_abs)
        .map(|p| figure(summary, (name, "window_max_abs"), p, "Pa"));
    let window = window.map_or(String::new(), |p| format!("{BETWEEN}in the window {p}"));
    Some(format!("largest in the fluid: {largest}{window}"))
}

fn energy(summary: &Summary) -> Option<String> {
    let last = |one: Interest| get(summary, one)?.last;
    // a quantity that is zero has zero power
    let power = |one: Interest| {
        let quantity = get(summary, one)?;
        let power = quantity.window_power_w.filter(|_| quantity.last != Some(0.0))?;
        let power = figure(summary, (one.name(), "window_power_w"), power, "W");
        Some(format!(" ({power} in the window)"))
    };
    let energy = |one: Interest| Some(figure(summary, (one.name(), "final"), last(one)?, "J"));
    let share = |kind: &str, value: f64| {
        let error = summary.error(Interest::Efficiency.name(), kind);
        hold(error.map_or_else(
            || percent(value),
            |error| with_error(100.0 * value, 100.0 * error, "1") + " %",
        ))
    };
    let with_power = |one: Interest| power(one).unwrap_or_default();
    let efficiency = get(summary, Interest::Efficiency);
    let undetermined = efficiency.is_some_and(|q| q.final_absent.is_some());
    let parts = [
        energy(Interest::InputEnergy).map(|e| format!("put in {e}{}", with_power(Interest::InputEnergy))),
        energy(Interest::HarvestedEnergy).map(|e| format!("harvested {e}{}", with_power(Interest::HarvestedEnergy))),
        last(Interest::Efficiency).map(|e| hold(format!("efficiency {}", share("final", e)))),
        undetermined.then(|| "no efficiency (below numerical error)".into()),
        efficiency
            .and_then(|q| q.window)
            .map(|e| hold(format!("in the window {}", share("window", e)))),
    ];
    Some(parts.into_iter().flatten().collect::<Vec<_>>().join(BETWEEN))
}

/// Requested accuracy, the setting that reached it, and the largest errors.
fn accuracy(summary: &Summary) -> Option<String> {
    let found = summary.accuracy.as_ref()?;
    let errors = accuracy::largest(found).join(BETWEEN);
    Some(format!(
        "{} with {}{BETWEEN}largest errors: {errors}",
        accuracy::reached(found),
        accuracy::setting(found)
    ))
}

fn balances(summary: &Summary) -> String {
    let b = &summary.balances;
    let open = |what: &str, x: f64| hold(format!("{what} {}", significant(x, 2)));
    let parts = [
        ("energy", b.energy_residual_relative),
        ("volume", b.volume_residual_relative),
        ("port flow", b.port_flow_residual_relative),
        ("momentum", b.momentum_residual_relative),
        ("angular momentum", b.angular_momentum_residual_relative),
    ];
    // Exactly zero if a balance does not apply; energy always does.
    let shown = parts.into_iter().filter(|(what, x)| *what == "energy" || *x != 0.0);
    let shown: Vec<_> = shown.map(|(what, x)| open(what, x)).collect();
    format!("relative residuals: {}", shown.join(BETWEEN))
}

fn integrator(summary: &Summary) -> String {
    let c = &summary.solver;
    let mostly = c
        .steps_by_order
        .iter()
        .enumerate()
        .max_by_key(|(_, n)| **n)
        .filter(|(_, n)| **n > 0);
    let mostly = mostly.map_or(String::new(), |(k, _)| format!(", mostly of order {}", k + 1));
    let failed = c.error_test_failures + c.newton_failures;
    let parts = [
        counted(c.steps, "step") + &mostly,
        format!("{} rejected", count(failed)),
        counted(summary.unknowns as u64, "unknown"),
    ];
    parts.map(hold).join(BETWEEN)
}

fn times(summary: &Summary) -> String {
    let (simulated, wall) = (summary.time_s, summary.wall_s.total);
    let simulated_text = hold(trimmed(&quantity(simulated, "s", 4)));
    let ratio = if simulated > 0.0 && wall > 0.0 {
        format!("{BETWEEN}{} per simulated second", hold(duration(wall / simulated)))
    } else {
        String::new()
    };
    format!("{simulated_text} simulated in {}{ratio}", hold(duration(wall)))
}

fn spent(summary: &Summary) -> Option<String> {
    let w = &summary.wall_s;
    if w.total <= 0.0 {
        return None;
    }
    let shares = [
        ("set-up", w.start_up + w.set_up + w.consistent_start),
        ("earlier runs", w.pilots),
        ("residual", w.residual),
        ("Jacobian", w.jacobian),
        ("linear solver", w.linear_solver),
        ("rest of steps", w.steps),
        ("monitoring", w.watching),
        ("error bars", w.companion),
        ("samples", w.samples),
        ("output", w.output + w.pictures + w.report + w.files),
    ];
    let share = |(name, s): (&str, f64)| hold(format!("{name} {:.0} %", 100.0 * s / w.total));
    let large = shares.into_iter().filter(|(_, s)| *s >= LEAST_SHARE * w.total);
    Some(large.map(share).collect::<Vec<_>>().join(BETWEEN))
}
