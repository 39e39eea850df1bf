//! `sweep.svg`: cycles along a parameter, a panel a quantity; open rings: cycles that are not stable.

use super::canvas::{Stroke, picture};
use super::colour::Colour;
use super::extent;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;

/// A quantity along the parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// What it is.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Values, one a cycle.
    pub values: Vec<f64>,
}

/// All that is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycles {
    /// Name of the case.
    pub case: String,
    /// The parameter.
    pub parameter_name: String,
    /// Its unit.
    pub parameter_unit: String,
    /// Whether its axis is logarithmic.
    pub logarithmic: bool,
    /// Its values.
    pub parameter: Vec<f64>,
    /// Whether each cycle is stable.
    pub stable: Vec<bool>,
    /// Panels from top to bottom.
    pub quantities: Vec<Quantity>,
}

const LEFT: f64 = 96.0;
const TOP: f64 = 64.0;
const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 170.0;
const GAP: f64 = 26.0;
const LINE: Colour = Colour(0x00, 0x72, 0xb2);
const WARNING: Colour = Colour(0xd5, 0x5e, 0x00);

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &Cycles) -> Option<String> {
    let on_axis = |x: f64| if data.logarithmic { x.log10() } else { x };
    let xs: Vec<f64> = data.parameter.iter().map(|&x| on_axis(x)).collect();
    let (lo, hi) = extent(xs.iter().copied())?;
    let margin = 0.03 * (hi - lo).max(1e-12);
    let x = if data.logarithmic {
        Scale::logarithmic((lo, hi), margin, &[1.0, 2.0, 5.0], (&data.parameter_unit, 7))
    } else {
        Scale::exact(lo - margin, hi + margin, &data.parameter_unit, 7)
    };
    let count = data.quantities.len() as f64;
    let height = TOP + count * HEIGHT + (count - 1.0) * GAP + 52.0;
    Some(picture(LEFT + WIDTH + 30.0, height, |canvas| {
        let about = "one cycle a value, found by shooting; orange rings: cycles that are not stable";
        title(canvas, 16.0, &format!("{} · steady cycles", data.case), about);
        for (k, quantity) in data.quantities.iter().enumerate() {
            let panel = Panel {
                place: Place::new(LEFT, TOP + k as f64 * (HEIGHT + GAP), WIDTH, HEIGHT),
                x: x.clone(),
                y: Scale::around(
                    extent(quantity.values.iter().copied().chain([0.0])),
                    0.0,
                    &quantity.unit,
                    5,
                ),
            };
            panel.grid(canvas);
            let points = xs.iter().copied().zip(quantity.values.iter().copied());
            panel.curve(canvas, points.clone(), Stroke::solid(LINE, 1.4));
            for (point, stable) in points.zip(&data.stable) {
                let colour = if *stable { LINE } else { WARNING };
                canvas.ring(panel.at(point), 3.4, Stroke::solid(colour, 1.4));
            }
            let last = k + 1 == data.quantities.len();
            panel.axes(canvas, last.then_some(data.parameter_name.as_str()), &quantity.name);
        }
    }))
}
