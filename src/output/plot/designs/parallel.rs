//! A line a design through all numbers.

use super::{Drawn, Numbers, TOP};
use crate::output::numbers::quantity;
use crate::output::plot::canvas::{Anchor, FAINT_INK, Stroke, Words, picture};
use crate::output::plot::colour::of_value;
use crate::output::plot::extent;
use crate::output::plot::panel::title;

/// A line a design through all numbers, coloured by the last of them; `None` when there is nothing to draw.
pub fn beside(data: &Drawn) -> Option<String> {
    let all: Vec<&Numbers> = data.varied.iter().chain(&data.figures).collect();
    let last = data.figures.last()?;
    let (low, high) = extent(last.values.iter().copied())?;
    let ranges: Vec<(f64, f64)> = all
        .iter()
        .map(|one| extent(one.on_axis().into_iter()).unwrap_or((0.0, 1.0)))
        .collect();
    const STEP: f64 = 120.0;
    const LENGTH: f64 = 300.0;
    let width = 140.0 + STEP * (all.len() - 1) as f64;
    Some(picture(width, TOP + LENGTH + 90.0, |canvas| {
        title(
            canvas,
            16.0,
            &data.case,
            &data.about("a line a design, from what is varied to what came out"),
        );
        let at = |k: usize, value: f64| {
            let (lo, hi) = ranges[k];
            let share = if hi > lo { (value - lo) / (hi - lo) } else { 0.5 };
            (70.0 + STEP * k as f64, TOP + LENGTH * (1.0 - share) + 14.0)
        };
        for (n, value) in last.values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            let points: Vec<_> = all
                .iter()
                .enumerate()
                .map(|(k, one)| at(k, one.shown(one.values[n])))
                .collect();
            let stroke = Stroke::solid(of_value(*value, low, high), 1.0);
            data.thing(canvas, n, &data.figures, |canvas| canvas.line(&points, stroke));
        }
        for (k, one) in all.iter().enumerate() {
            let (lo, hi) = ranges[k];
            let raised = |x: f64| if one.logarithmic { 10_f64.powf(x) } else { x };
            let ends = [at(k, lo.min(hi)), at(k, hi.max(lo))];
            let (bottom, top) = if hi > lo {
                (ends[0].1, ends[1].1)
            } else {
                (TOP + LENGTH + 14.0, TOP + 14.0)
            };
            canvas.line(&[(ends[0].0, bottom), (ends[0].0, top)], Stroke::solid(FAINT_INK, 1.0));
            let unit = if one.unit.is_empty() { "1" } else { &one.unit };
            let small = Words::new(10.0, Anchor::Centre);
            canvas.text((ends[0].0, top - 9.0), &quantity(raised(hi), unit, 3), small);
            canvas.text((ends[0].0, bottom + 11.0), &quantity(raised(lo), unit, 3), small);
            for (line, text) in broken(&one.label).iter().enumerate() {
                let lower = 30.0 + 13.0 * line as f64;
                canvas.text((ends[0].0, bottom + lower), text, small.coloured(FAINT_INK));
            }
        }
    }))
}

/// A name in lines that fit below an axis, broken between its parts.
fn broken(name: &str) -> Vec<String> {
    const MOST: usize = 20;
    let mut lines: Vec<String> = vec![String::new()];
    for part in name.split_inclusive(' ') {
        match lines.last_mut() {
            Some(line) if line.len() + part.len() <= MOST || line.is_empty() => line.push_str(part),
            _ => lines.push(part.to_owned()),
        }
    }
    lines
}
