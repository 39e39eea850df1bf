//! A frame with grid, ticks and curves; and the bar that says which colour is which time.

use super::canvas::{Anchor, Canvas, FAINT_INK, Stroke, Words};
use super::colour::{self, Colour};
use super::labels::LabelRoom;
use super::ticks::Scale;

const GRID: Colour = Colour(0xe4, 0xe7, 0xea);
const ZERO: Colour = Colour(0xa9, 0xaf, 0xb6);
const FRAME: Colour = Colour(0x6b, 0x72, 0x7a);
/// Size of tick labels.
const SMALL: f64 = 11.0;
/// Size of axis names.
pub const NORMAL: f64 = 12.5;

/// Place on the sheet, in points.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl Place {
    /// From its upper left corner, width and height.
    pub fn new(left: f64, top: f64, width: f64, height: f64) -> Self {
        Self {
            left,
            top,
            width,
            height,
        }
    }

    /// Right edge.
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    /// Lower edge.
    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// A pair of axes on the sheet.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Where.
    pub place: Place,
    /// Horizontal axis.
    pub x: Scale,
    /// Vertical axis.
    pub y: Scale,
}

impl Panel {
    /// Axes at a place.
    pub fn new(place: Place, x: Scale, y: Scale) -> Self {
        Self { place, x, y }
    }

    /// Point on the sheet of a pair of values.
    pub fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let p = self.place;
        (
            p.left + p.width * self.x.share(x),
            p.bottom() - p.height * self.y.share(y),
        )
    }

    /// Grid and the line of zero; before the curves.
    pub fn grid(&self, canvas: &mut Canvas) {
        let p = self.place;
        for (x, _) in &self.x.ticks {
            let at = self.at((*x, self.y.lo)).0;
            canvas.line(&[(at, p.top), (at, p.bottom())], Stroke::solid(GRID, 0.7));
        }
        for (y, _) in &self.y.ticks {
            let at = self.at((self.x.lo, *y)).1;
            let colour = if *y == 0.0 { ZERO } else { GRID };
            canvas.line(&[(p.left, at), (p.right(), at)], Stroke::solid(colour, 0.7));
        }
    }

    /// Frame, ticks and names; after the curves. No name of x, no labels below: for stacked panels.
    pub fn axes(&self, canvas: &mut Canvas, x_name: Option<&str>, y_name: &str) {
        let p = self.place;
        canvas.frame((p.left, p.top), (p.right(), p.bottom()), Stroke::solid(FRAME, 0.8));
        let mut above = LabelRoom::new((0.0, SMALL));
        for (y, label) in &self.y.ticks {
            let at = self.at((self.x.lo, *y)).1;
            canvas.line(&[(p.left - 4.0, at), (p.left, at)], Stroke::solid(FRAME, 0.8));
            if above.claim((p.left, at)) {
                canvas.text((p.left - 7.0, at), label, Words::new(SMALL, Anchor::Right));
            }
        }
        let words = Words {
            upright: true,
            ..Words::new(NORMAL, Anchor::Centre)
        };
        let longest = self.y.ticks.iter().map(|(_, label)| label.chars().count()).max();
        let beside = (20.0 + 6.4 * longest.unwrap_or(0) as f64).max(52.0);
        canvas.text((p.left - beside, p.top + 0.5 * p.height), &self.y.named(y_name), words);
        // labels of one axis are about as long as the longest
        let longest = self.x.ticks.iter().map(|(_, label)| label.chars().count()).max();
        let mut beside = LabelRoom::new((4.0 + 5.8 * longest.unwrap_or(0) as f64, SMALL));
        for (x, label) in &self.x.ticks {
            let at = self.at((*x, self.y.lo)).0;
            canvas.line(&[(at, p.bottom()), (at, p.bottom() + 4.0)], Stroke::solid(FRAME, 0.8));
            if x_name.is_some() && beside.claim((at, p.bottom())) {
                canvas.text((at, p.bottom() + 13.0), label, Words::new(SMALL, Anchor::Centre));
            }
        }
        if let Some(name) = x_name {
            let at = (p.left + 0.5 * p.width, p.bottom() + 31.0);
            canvas.text(at, &self.x.named(name), Words::new(NORMAL, Anchor::Centre));
        }
    }

    /// A curve of values.
    pub fn curve(&self, canvas: &mut Canvas, points: impl Iterator<Item = (f64, f64)>, stroke: Stroke) {
        let points: Vec<_> = points.map(|p| self.at(p)).collect();
        canvas.line(&points, stroke);
    }
}

/// Title and what it is of.
pub fn title(canvas: &mut Canvas, left: f64, title: &str, about: &str) {
    let bold = Words {
        bold: true,
        ..Words::new(16.0, Anchor::Left)
    };
    canvas.text((left, 20.0), title, bold);
    canvas.text(
        (left, 40.0),
        about,
        Words::new(NORMAL, Anchor::Left).coloured(FAINT_INK),
    );
}

/// The bar that says which colour is which time.
pub fn time_bar(canvas: &mut Canvas, place: Place, from: f64, to: f64) {
    let scale = Scale::exact(from, to, "s", 5);
    const PIECES: usize = 96;
    let height = place.height / PIECES as f64;
    for k in 0..PIECES {
        let colour = colour::of_time((k as f64 + 0.5) / PIECES as f64);
        let bottom = place.bottom() - k as f64 * height;
        // Half a point more, so that no hairline shows between pieces.
        let top = (bottom - height - 0.5).max(place.top);
        canvas.rectangle((place.left, top), (place.right(), bottom), colour);
    }
    canvas.frame(
        (place.left, place.top),
        (place.right(), place.bottom()),
        Stroke::solid(FRAME, 0.8),
    );
    for (t, label) in &scale.ticks {
        let at = place.bottom() - place.height * scale.share(*t);
        canvas.line(
            &[(place.right(), at), (place.right() + 4.0, at)],
            Stroke::solid(FRAME, 0.8),
        );
        canvas.text((place.right() + 7.0, at), label, Words::new(SMALL, Anchor::Left));
    }
    let at = (place.left - 4.0, place.top - 14.0);
    canvas.text(at, &scale.named("t"), Words::new(NORMAL, Anchor::Left));
}
