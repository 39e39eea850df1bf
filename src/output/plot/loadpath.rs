//! `path.svg`: load factor over displacement, and the shapes on the way.

use super::canvas::{Anchor, Canvas, FAINT_INK, Stroke, Words, picture};
use super::colour::PALETTE;
use super::deflection::draw_over_time;
use super::labels::LabelRoom;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;
use super::{Curve, extent};

/// A path of equilibria.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadPath {
    /// Name of the case.
    pub case: String,
    /// What the loads are those of, in words.
    pub about: String,
    /// Share of the loads of each state.
    pub shares: Vec<f64>,
    /// Whether each state is stable; unknown counts as stable.
    pub stable: Vec<bool>,
    /// Quantities over the path: point k is `(share, value)` of state k.
    pub curves: Vec<Curve>,
    /// Remarkable points: load factor, and a letter that stands for what it is.
    pub marks: Vec<(usize, char)>,
    /// Shapes to be drawn: the state, `x` and `z` of the nodes [m].
    pub shapes: Vec<(usize, Vec<f64>, Vec<f64>)>,
}

const LEFT: f64 = 72.0;
const TOP: f64 = 66.0;
const WIDTH: f64 = 200.0;
const HEIGHT: f64 = 240.0;
const GAP: f64 = 78.0;

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &LoadPath) -> Option<String> {
    let curves: Vec<&Curve> = data.curves.iter().filter(|c| c.max_abs() > 0.0).collect();
    if data.shares.len() < 2 || curves.is_empty() {
        return None;
    }
    // room for the words of the shapes beside a single curve
    let columns = curves.len().max(2) as f64;
    let sheet = LEFT + columns * (WIDTH + GAP);
    let shapes = Shapes::of(data, sheet - LEFT - GAP);
    let bottom = TOP + HEIGHT + 40.0 + shapes.as_ref().map_or(0.0, |s| 50.0 + s.height);
    Some(picture(sheet, bottom + 30.0, |canvas| {
        title(canvas, LEFT, &format!("{} · equilibria", data.case), &data.about);
        for (k, curve) in curves.iter().enumerate() {
            let place = Place::new(LEFT + k as f64 * (WIDTH + GAP), TOP, WIDTH, HEIGHT);
            over_displacement(canvas, place, data, curve);
        }
        if let Some(shapes) = shapes {
            shapes.draw(canvas, data, TOP + HEIGHT + 80.0);
        }
    }))
}

/// Share of the loads over one quantity: unbroken where stable.
fn over_displacement(canvas: &mut Canvas, place: Place, data: &LoadPath, curve: &Curve) {
    let values = || curve.points.iter().map(|p| p.1);
    let panel = Panel::new(
        place,
        Scale::around(extent(values()), 0.0, &curve.unit, 4),
        Scale::around(extent(data.shares.iter().copied()), 0.0, "1", 6),
    );
    panel.grid(canvas);
    for (k, pair) in curve.points.windows(2).enumerate() {
        let mut stroke = Stroke::solid(PALETTE[0], 1.8);
        if !data.stable[k] || !data.stable[k + 1] {
            stroke = Stroke::dashed(PALETTE[1], 1.8, (3.0, 3.0));
        }
        panel.curve(canvas, pair.iter().map(|p| (p.1, p.0)), stroke);
    }
    for (share, value) in &curve.points {
        let (x, y) = panel.at((*value, *share));
        canvas.rectangle((x - 1.4, y - 1.4), (x + 1.4, y + 1.4), PALETTE[0]);
    }
    let mut letters = LabelRoom::new((11.0, 11.0));
    for &(state, letter) in &data.marks {
        let (share, value) = curve.points[state];
        let (x, y) = panel.at((value, share));
        canvas.frame((x - 4.0, y - 4.0), (x + 4.0, y + 4.0), Stroke::solid(PALETTE[3], 1.2));
        if letters.claim((x, y)) {
            canvas.text((x + 8.0, y - 8.0), &letter.to_string(), Words::new(11.0, Anchor::Left));
        }
    }
    panel.axes(canvas, Some(&curve.name), "load factor");
}

/// Shapes with equal scales along and across.
struct Shapes {
    z: Scale,
    x: Scale,
    width: f64,
    height: f64,
}

impl Shapes {
    fn of(data: &LoadPath, width: f64) -> Option<Self> {
        let (z_lo, z_hi) = extent(data.shapes.iter().flat_map(|s| s.2.iter().copied()))?;
        let (x_lo, x_hi) = extent(data.shapes.iter().flat_map(|s| s.1.iter().copied()))?;
        let (z_middle, x_middle) = (0.5 * (z_lo + z_hi), 0.5 * (x_lo + x_hi));
        // As large as width and 420 points of height allow.
        let per_point = (1.1 * (z_hi - z_lo) / width).max(1.1 * (x_hi - x_lo) / 420.0);
        let height = (1.1 * (x_hi - x_lo) / per_point).max(60.0);
        let (half_z, half_x) = (0.5 * width * per_point, 0.5 * height * per_point);
        Some(Self {
            z: Scale::exact(z_middle - half_z, z_middle + half_z, "m", 8),
            x: Scale::exact(
                x_middle - half_x,
                x_middle + half_x,
                "m",
                ((height / 34.0) as usize).max(3),
            ),
            width,
            height,
        })
    }

    fn draw(self, canvas: &mut Canvas, data: &LoadPath, top: f64) {
        let place = Place::new(LEFT, top, self.width, self.height);
        let panel = Panel::new(place, self.z, self.x);
        let order: Vec<f64> = data.shapes.iter().map(|s| s.0 as f64).collect();
        let curves = data
            .shapes
            .iter()
            .map(|(_, x, z)| z.iter().copied().zip(x.iter().copied()));
        draw_over_time(canvas, &panel, &order, curves);
        panel.axes(
            canvas,
            Some("shape: z = θ + u₃; blue at rest, red at the end of the path"),
            "x = u₁",
        );
        let faint = Words::new(11.0, Anchor::Left).coloured(FAINT_INK);
        let words = "squares: states; dashed: unstable; B bifurcation, L limit point";
        canvas.text((LEFT, top - 18.0), words, faint);
    }
}
