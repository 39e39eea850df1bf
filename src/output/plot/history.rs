//! `history.svg`: what the beam does over time, one panel a quantity.

use super::canvas::{Stroke, picture};
use super::colour::PALETTE;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;
use super::{Curve, extent};

/// Curves over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// Name of the case.
    pub case: String,
    /// Curves; those shown are taken by name.
    pub curves: Vec<Curve>,
}

/// A panel: columns drawn in it, its name, and the smallest half range that is worth showing.
struct Row {
    columns: &'static [&'static str],
    name: &'static str,
    floor: f64,
    /// Whether it is left out when it is zero throughout.
    optional: bool,
}

const fn row(columns: &'static [&'static str], name: &'static str, floor: f64, optional: bool) -> Row {
    Row {
        columns,
        name,
        floor,
        optional,
    }
}

const ROWS: [Row; 6] = [
    row(&["tip_u1"], "tip u₁", 1e-8, false),
    row(&["tip_u3"], "tip u₃", 1e-8, false),
    row(&["tip_angle"], "tip angle", 1e-7, false),
    row(&["max_pressure", "min_pressure"], "max, min p", 1e-3, false),
    row(&["turbine_power"], "turbine power", 1e-12, true),
    row(&["efficiency"], "efficiency", 1e-3, true),
];

/// Whether a column belongs into this picture.
pub fn belongs(name: &str) -> bool {
    ROWS.iter().any(|row| row.columns.contains(&name))
}

const LEFT: f64 = 78.0;
const TOP: f64 = 62.0;
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 112.0;
const GAP: f64 = 16.0;
const SHEET: f64 = 748.0;

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &History) -> Option<String> {
    let shown: Vec<(&Row, Vec<&Curve>)> = ROWS
        .iter()
        .map(|row| (row, curves(data, row)))
        .filter(|(_, curves)| !curves.is_empty())
        .collect();
    let all = shown.iter().flat_map(|(_, curves)| curves);
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
        for (k, (row, curves)) in shown.iter().enumerate() {
            let top = TOP + k as f64 * (HEIGHT + GAP);
            let place = Place {
                left: LEFT,
                top,
                width: WIDTH,
                height: HEIGHT,
            };
            let values = curves.iter().flat_map(|c| c.points.iter().map(|p| p.1));
            let y = Scale::around(extent(values), row.floor, &curves[0].unit, 4);
            let panel = Panel { place, x: x.clone(), y };
            panel.grid(canvas);
            for (c, curve) in curves.iter().enumerate() {
                // The second curve of a panel in the palette's other half.
                let colour = PALETTE[(k + 5 * c) % PALETTE.len()];
                panel.curve(canvas, curve.points.iter().copied(), Stroke::solid(colour, 1.2));
            }
            panel.axes(canvas, (k + 1 == shown.len()).then_some("time t"), row.name);
        }
    }))
}

fn curves<'a>(data: &'a History, row: &Row) -> Vec<&'a Curve> {
    let named = |name: &&str| data.curves.iter().find(|c| c.name == *name && !c.points.is_empty());
    let found = row.columns.iter().filter_map(named);
    found.filter(|c| !row.optional || c.max_abs() > 0.0).collect()
}
