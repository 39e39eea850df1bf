//! A progress line on a terminal; numbers of the command line.

use std::io::IsTerminal as _;
use std::path::PathBuf;

use clap::builder::{PathBufValueParser, TypedValueParser};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle};

use crate::case::amounts::{self, UnitContext};
use crate::error::{Result, usage};
use crate::study::refine;

/// Template of a moving line.
pub const PLAIN: &str = "{spinner} {wide_msg}";

/// The progress line; hidden if `quiet` is set or there is no terminal.
pub fn line(quiet: bool) -> ProgressBar {
    if quiet { ProgressBar::hidden() } else { styled(PLAIN) }
}

/// A progress bar with this template, on a terminal; it is cleared when its last owner drops it.
pub fn styled(template: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr()).with_finish(ProgressFinish::AndClear);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

/// Progress of a long computation: a bar on a terminal, lines elsewhere, nothing if quiet.
pub struct ProgressLine {
    /// The bar.
    pub bar: Option<ProgressBar>,
    /// True if lines are printed.
    pub lines: bool,
}

impl ProgressLine {
    /// Creates a display whose bar has this template.
    pub fn new(quiet: bool, template: &str) -> Self {
        let terminal = std::io::stderr().is_terminal();
        Self {
            bar: (terminal && !quiet).then(|| styled(template)),
            lines: !terminal && !quiet,
        }
    }
}

impl Drop for ProgressLine {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Parser of the name of a file or folder to write, which messages, pages and scripts show as it is.
pub fn output_path() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match path.to_string_lossy().contains(char::is_control) {
        true => Err("an output name must not contain control characters, such as line breaks and tabs"),
        false => Ok(path),
    })
}

/// Time span [s], limited to one that a clock can wait for, optionally with a unit.
pub fn duration(text: &str) -> std::result::Result<f64, String> {
    let seconds = instant(text)?;
    if seconds >= 0.0 {
        Ok(seconds.min(1e9))
    } else {
        Err("expected a number of seconds, 0 or more".into())
    }
}

/// A number in the unit of a key of a case, optionally with a unit.
fn number(key: &str, text: &str, wanted: &str) -> std::result::Result<f64, String> {
    let plain = match amounts::at(key, text) {
        Some(UnitContext::Number(number, _)) => number,
        Some(UnitContext::Not(why)) => return Err(format!("{wanted}; {why}")),
        None => text.trim().to_owned(),
    };
    let number = plain.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| wanted.to_owned())
}

/// An instant [s], optionally with a unit.
pub fn instant(text: &str) -> std::result::Result<f64, String> {
    number("/time/end_s", text, "expected a number of seconds")
}

/// A frequency [Hz], optionally with a unit.
pub fn frequency(text: &str) -> std::result::Result<f64, String> {
    number("/frequency_hz", text, "expected a frequency in Hz")
}

/// A fraction, as a number or in percent.
pub fn ratio(text: &str) -> std::result::Result<f64, String> {
    number("/solver/rtol", text, "expected a number such as 0.01, or 1%")
}

/// A whole number, 0 or more.
pub fn count(text: &str) -> std::result::Result<usize, String> {
    let read = |_| match text.trim().parse::<f64>() {
        Ok(number) if number.fract() == 0.0 && (0.0..1e15).contains(&number) => {
            format!("expected a whole number: {number}")
        }
        _ => "expected a whole number, 0 or more".to_owned(),
    };
    text.trim().parse().map_err(read)
}

/// `from:to` as two finite numbers, ascending.
pub fn range(text: &str) -> Option<(f64, f64)> {
    either_way(text).filter(|(from, to)| from < to)
}

/// `from:to` as two finite numbers that differ.
pub fn either_way(text: &str) -> Option<(f64, f64)> {
    let (from, to) = text.split_once(':')?;
    let (from, to): (f64, f64) = (from.trim().parse().ok()?, to.trim().parse().ok()?);
    (from.is_finite() && to.is_finite() && from != to).then_some((from, to))
}

/// `count` numbers from `from` to `to`, evenly spaced, linearly or logarithmically.
pub fn spread(from: f64, to: f64, count: usize, logarithmic: bool) -> Vec<f64> {
    let last = (count - 1).max(1) as f64;
    (0..count)
        .map(|k| {
            let share = k as f64 / last;
            match k {
                0 => from,
                _ if k + 1 == count => to,
                _ if logarithmic => from * (to / from).powf(share),
                _ => from + (to - from) * share,
            }
        })
        .collect()
}

/// Checks a requested accuracy.
pub fn accuracy(asked: f64) -> Result<f64> {
    if refine::sensible(asked) {
        return Ok(asked);
    }
    usage(format!(
        "--accuracy {asked}: expected a relative error from 1e-6 to 0.5, such as 0.01 for one per cent"
    ))
}
