//! What lines, markers and shades mean.

use super::{FRONT, LEFT, Sheet, TOP, WIDTH, cross, draw_marker};
use crate::output::numbers::significant;
use crate::output::plot::canvas::{Anchor, Canvas, FAINT_INK, Stroke, Words};
use crate::study::accuracy::Scheme;

/// Size of the words.
const SMALL: f64 = 11.0;

/// Draws it; `balances`: whether there are points of balance.
pub fn draw(sheet: &Sheet, canvas: &mut Canvas, balances: bool) {
    let left = LEFT + WIDTH + 22.0;
    let mut y = TOP + 8.0;
    let words = Words::new(SMALL, Anchor::Left);
    for line in sheet.data.lines.iter().filter(|l| !l.markers.is_empty()) {
        canvas.line(&[(left, y), (left + 30.0, y)], sheet.stroke(line));
        draw_marker(canvas, (left + 15.0, y), line.scheme, sheet.colour(line.cells), true);
        let cells = if line.cells == 1 { "cell" } else { "cells" };
        canvas.text(
            (left + 38.0, y),
            &format!("{} {cells}, {}", line.cells, line.scheme),
            words,
        );
        y += 18.0;
    }
    y += 10.0;
    canvas.line(&[(left + 3.0, y), (left + 25.0, y)], Stroke::solid(FRONT, 9.0));
    canvas.text((left + 38.0, y), "no run is cheaper and", words);
    canvas.text((left + 38.0, y + 14.0), "more accurate; rtol", words);
    canvas.text((left + 38.0, y + 28.0), "beside it", words);
    y += 50.0;
    if balances {
        cross(canvas, (left + 15.0, y));
        canvas.text((left + 38.0, y), "error in time equals", words);
        canvas.text((left + 38.0, y + 14.0), "error in space", words);
        y += 36.0;
    }
    if sheet.data.lines.iter().flat_map(|l| &l.markers).any(|m| !m.judged) {
        draw_marker(canvas, (left + 15.0, y), Scheme::ida(2), FAINT_INK, false);
        canvas.text((left + 38.0, y), "reference not ten", words);
        canvas.text((left + 38.0, y + 14.0), "times better", words);
        y += 36.0;
    }
    let faint = words.coloured(FAINT_INK);
    let own = format!("reference's own error {}", significant(sheet.data.own, 1));
    canvas.text((left, y), &own, faint);
    if sheet.data.repeats > 1 {
        let timing = format!("time: least of {} runs;", sheet.data.repeats);
        canvas.text((left, y + 16.0), &timing, faint);
        canvas.text((left, y + 30.0), "whisker: to the median", faint);
    }
}
