//! `history.svg`: what the beam does over time, one panel a quantity.

use super::canvas::{Stroke, picture};
use super::colour::PALETTE;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;
use super::{Curve, extent};
use crate::discrete::quantities::{Group, Observable};

/// Curves over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// Name of the case.
    pub case: String,
    /// Curves; those shown are taken by name.
    pub curves: Vec<Curve>,
}

/// Groups that are drawn: the quantities of the first one by one, of pressures and powers those of a unit in one panel.
const GROUPS: [Group; 3] = [Group::Tip, Group::Pressure, Group::Power];

/// Whether a quantity belongs into this picture.
pub fn belongs(one: Observable) -> bool {
    GROUPS.contains(&one.group())
}

/// The smallest half range of a unit that is worth showing.
fn floor(unit: &str) -> f64 {
    match unit {
        "m" => 1e-8,
        "rad" => 1e-7,
        "Pa" => 1e-3,
        _ => 1e-12,
    }
}

/// What stands beside the axis of a panel.
fn name(curves: &[&Curve]) -> &'static str {
    match curves[0].of() {
        Some(one) if one.group() == Group::Pressure => "max, min p",
        Some(one) => one.label(),
        None => "",
    }
}

const LEFT: f64 = 78.0;
const TOP: f64 = 62.0;
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 112.0;
const GAP: f64 = 16.0;
const SHEET: f64 = 748.0;

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &History) -> Option<String> {
    let shown = panels(data);
    let all = shown.iter().flatten();
    let (from, to) = extent(all.flat_map(|c| c.points.iter().map(|p| p.0)))?;
    let x = Scale::exact(from, to, "s", 10);
    let bottom = TOP + shown.len() as f64 * (HEIGHT + GAP) - GAP;
    Some(picture(SHEET, bottom + 48.0, |canvas| {
        title(
            canvas,
            LEFT,
            &format!("{} · history", data.case),
            "quantities over the whole run",
        );
        for (k, curves) in shown.iter().enumerate() {
            let top = TOP + k as f64 * (HEIGHT + GAP);
            let place = Place::new(LEFT, top, WIDTH, HEIGHT);
            let values = curves.iter().flat_map(|c| c.points.iter().map(|p| p.1));
            let y = Scale::around(extent(values), floor(&curves[0].unit), &curves[0].unit, 4);
            let panel = Panel { place, x: x.clone(), y };
            panel.grid(canvas);
            for (c, curve) in curves.iter().enumerate() {
                // The second curve of a panel in the palette's other half.
                let colour = PALETTE[(k + 5 * c) % PALETTE.len()];
                panel.curve(canvas, curve.points.iter().copied(), Stroke::solid(colour, 1.2));
            }
            panel.axes(canvas, (k + 1 == shown.len()).then_some("time t"), name(curves));
        }
    }))
}

/// Curves panel by panel; what is zero throughout is left out, unless it is motion or pressure.
fn panels(data: &History) -> Vec<Vec<&Curve>> {
    let mut panels: Vec<Vec<&Curve>> = vec![];
    for (one, curve) in data.curves.iter().filter_map(|c| Some((c.of()?, c))) {
        let group = one.group();
        if curve.points.is_empty() || group == Group::Power && curve.max_abs() == 0.0 {
            continue;
        }
        let joins = |panel: &&mut Vec<&Curve>| {
            let first = panel[0].of();
            group != Group::Tip && first.is_some_and(|first| first.group() == group && first.unit() == one.unit())
        };
        match panels.iter_mut().find(joins) {
            Some(panel) => panel.push(curve),
            None => panels.push(vec![curve]),
        }
    }
    panels
}
