//! `history.svg`: quantities over time, one panel per quantity.

use super::canvas::LineStyle;
use super::colour::PALETTE;
use super::picture::{Panel, Picture, PictureAxis, PictureSeries};
use super::{PlottedCurve, error_bands, times_of};
use crate::discrete::quantities::{Group, Observable};

/// Groups that are drawn: the first with one panel per quantity, pressures and powers with one panel per unit.
const GROUPS: [Group; 3] = [Group::Tip, Group::Pressure, Group::Power];

/// True if a quantity belongs in this picture.
pub fn belongs(one: Observable) -> bool {
    GROUPS.contains(&one.group())
}

/// Smallest half range of an axis in a unit.
fn floor(unit: &str) -> f64 {
    match unit {
        "m" => 1e-8,
        "rad" => 1e-7,
        "Pa" => 1e-3,
        _ => 1e-12,
    }
}

/// Name beside the vertical axis of a panel.
fn name(curves: &[&PlottedCurve]) -> &'static str {
    match curves[0].observable() {
        Some(one) if one.group() == Group::Pressure => "max, min p",
        Some(one) => one.label(),
        None => "",
    }
}

/// Draws curves, matched to quantities by name; `None` if there is nothing to draw.
pub fn draw(case: &str, curves: &[PlottedCurve]) -> Option<String> {
    let shown = panels(curves);
    let x = times_of(shown.iter().flatten().copied())?;
    let panels = shown.iter().enumerate().map(|(k, curves)| {
        // the second curve of a panel uses the other half of the palette
        let colour = |c: usize| PALETTE[(k + 5 * c) % PALETTE.len()];
        let line = |(c, curve): (usize, &&PlottedCurve)| {
            PictureSeries::line(curve.points.iter().copied(), LineStyle::solid(colour(c), 1.2))
        };
        let unit = &*curves[0].unit;
        let y = PictureAxis::new(name(curves), unit, 4).above(floor(unit));
        let coloured = curves.iter().enumerate().map(|(c, curve)| (*curve, colour(c)));
        let mut series = error_bands(coloured, floor(unit));
        series.extend(curves.iter().enumerate().map(line));
        Panel::new((640.0, 112.0), x.clone(), y, series)
    });
    Picture::stacked(format!("{case} · history"), "quantities over the whole run", panels)
        .with_bands_named()
        .svg()
}

/// Curves of each panel; omits powers that are zero throughout.
fn panels(curves: &[PlottedCurve]) -> Vec<Vec<&PlottedCurve>> {
    let mut panels: Vec<Vec<&PlottedCurve>> = vec![];
    for (one, curve) in curves.iter().filter_map(|c| Some((c.observable()?, c))) {
        let group = one.group();
        if curve.points.is_empty() || group == Group::Power && curve.max_abs() == 0.0 {
            continue;
        }
        let joins = |panel: &&mut Vec<&PlottedCurve>| {
            let first = panel[0].observable();
            group != Group::Tip && first.is_some_and(|first| first.group() == group && first.unit() == one.unit())
        };
        match panels.iter_mut().find(joins) {
            Some(panel) => panel.push(curve),
            None => panels.push(vec![curve]),
        }
    }
    panels
}
