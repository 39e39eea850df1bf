//! `energy.svg`: where energy is and where it went, and how well the ledger closes.

use super::canvas::{Anchor, Canvas, Stroke, Words, picture};
use super::colour::PALETTE;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;
use super::{Curve, extent};
use crate::discrete::quantities::{Group, Observable};

/// Entries of the ledger over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Energy {
    /// Name of the case.
    pub case: String,
    /// Entries [J]: stored energies, cumulative works, losses, and what is left over.
    pub curves: Vec<Curve>,
}

/// Entries smaller than this share of the largest are not drawn.
const NEGLIGIBLE: f64 = 1e-3;

const LEFT: f64 = 78.0;
const TOP: f64 = 62.0;
const WIDTH: f64 = 600.0;
const HEIGHT: f64 = 300.0;
const RESIDUAL_HEIGHT: f64 = 100.0;
const GAP: f64 = 18.0;
const SHEET: f64 = 880.0;

/// Whether a quantity belongs into this picture.
pub fn belongs(one: Observable) -> bool {
    one.unit() == "J"
}

fn is_stored(curve: &Curve) -> bool {
    curve.of().is_some_and(|one| one.group() == Group::Stored)
}

fn is_residual(curve: &Curve) -> bool {
    curve.of().is_some_and(|one| one.group() == Group::Open)
}

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &Energy) -> Option<String> {
    let lines = entries(data);
    let (from, to) = extent(lines.iter().flat_map(|c| c.points.iter().map(|p| p.0)))?;
    let x = Scale::exact(from, to, "s", 9);
    let largest = lines.iter().map(|c| c.max_abs()).fold(0.0, f64::max);
    let residual = data.curves.iter().find(|c| is_residual(c) && !c.points.is_empty());
    let last = TOP + HEIGHT;
    let bottom = if residual.is_some() {
        last + GAP + RESIDUAL_HEIGHT
    } else {
        last
    };
    Some(picture(SHEET, bottom + 48.0, |canvas| {
        let about = "stored energies (solid), cumulative works and losses (dashed)";
        title(canvas, LEFT, &format!("{} · energy", data.case), about);
        let place = Place::new(LEFT, TOP, WIDTH, HEIGHT);
        let y = Scale::around(
            extent(lines.iter().flat_map(|c| c.points.iter().map(|p| p.1))),
            1e-15,
            "J",
            7,
        );
        let panel = Panel { place, x: x.clone(), y };
        panel.grid(canvas);
        for (k, curve) in lines.iter().enumerate() {
            panel.curve(canvas, curve.points.iter().copied(), stroke(k, curve));
            legend(canvas, k, curve);
        }
        panel.axes(canvas, residual.is_none().then_some("time t"), "energy");
        if let Some(residual) = residual {
            let place = Place::new(LEFT, last + GAP, WIDTH, RESIDUAL_HEIGHT);
            draw_residual(canvas, place, x, residual, largest);
        }
    }))
}

/// Entries worth drawing: nothing negligible.
fn entries(data: &Energy) -> Vec<&Curve> {
    let all = data.curves.iter();
    let mut lines: Vec<_> = all.filter(|c| !is_residual(c) && !c.points.is_empty()).collect();
    let largest = lines.iter().map(|c| c.max_abs()).fold(0.0, f64::max);
    if largest > 0.0 {
        lines.retain(|c| c.max_abs() > NEGLIGIBLE * largest);
    }
    lines
}

fn stroke(k: usize, curve: &Curve) -> Stroke {
    let dash = (!is_stored(curve)).then_some((6.0, 3.5));
    Stroke {
        colour: PALETTE[k % PALETTE.len()],
        width: 1.5,
        dash,
    }
}

fn legend(canvas: &mut Canvas, k: usize, curve: &Curve) {
    let (left, y) = (LEFT + WIDTH + 18.0, TOP + 12.0 + 21.0 * k as f64);
    canvas.line(
        &[(left, y), (left + 26.0, y)],
        Stroke {
            width: 2.2,
            ..stroke(k, curve)
        },
    );
    let label = curve.of().map_or(curve.name.as_str(), |one| one.label());
    canvas.text((left + 33.0, y), label, Words::new(12.0, Anchor::Left));
}

fn draw_residual(canvas: &mut Canvas, place: Place, x: Scale, residual: &Curve, largest: f64) {
    let over = if largest > 0.0 { largest } else { 1.0 };
    let points = || residual.points.iter().map(|p| (p.0, p.1 / over));
    let y = Scale::around(extent(points().map(|p| p.1)), 1e-16, "1", 4);
    let panel = Panel { place, x, y };
    panel.grid(canvas);
    panel.curve(canvas, points(), Stroke::solid(PALETTE[9], 1.2));
    panel.axes(canvas, Some("time t"), "residual");
    let at = (place.right() + 18.0, place.top + 14.0);
    canvas.text(at, "what does not close,", Words::new(12.0, Anchor::Left));
    canvas.text(
        (at.0, at.1 + 17.0),
        "over the largest energy",
        Words::new(12.0, Anchor::Left),
    );
}
