//! Lines, rectangles and words onto plotters' SVG backend, in points with a tenth of a point resolution.
//!
//! The backend knows whole pixels only; drawing ten times as large under a view box makes curves smooth.

use plotters::prelude::{BLACK, Color, DrawingBackend, IntoFont, RGBColor, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, FontTransform, ShapeStyle, TextStyle};

/// Pixels of the backend a point.
const FINE: f64 = 10.0;
/// The backend divides font sizes by this.
const FONT_SCALE: f64 = 1.24;
/// Found in browsers and in what turns SVG into PDF.
const FONT: &str = "Helvetica Neue, Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";

/// Colour of words.
pub const INK: RGBColor = RGBColor(0x22, 0x26, 0x2b);
/// Colour of words that matter less.
pub const FAINT_INK: RGBColor = RGBColor(0x5f, 0x66, 0x6e);

/// How a line looks.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Colour.
    pub colour: RGBColor,
    /// Width in points.
    pub width: f64,
    /// Lengths of dash and gap in points.
    pub dash: Option<(f64, f64)>,
}

impl Stroke {
    /// An unbroken line.
    pub fn solid(colour: RGBColor, width: f64) -> Self {
        Self {
            colour,
            width,
            dash: None,
        }
    }
}

/// Which point of a text is given.
#[derive(Clone, Copy, Debug)]
pub enum Anchor {
    /// Left end, vertical middle.
    Left,
    /// Middle.
    Centre,
    /// Right end, vertical middle.
    Right,
}

/// How words look.
#[derive(Clone, Copy, Debug)]
pub struct Words {
    /// Size in points.
    pub size: f64,
    /// Colour.
    pub colour: RGBColor,
    /// Which point is given.
    pub anchor: Anchor,
    /// Whether bold.
    pub bold: bool,
    /// Whether read from below.
    pub upright: bool,
}

impl Words {
    /// Plain words.
    pub fn new(size: f64, anchor: Anchor) -> Self {
        Self {
            size,
            colour: INK,
            anchor,
            bold: false,
            upright: false,
        }
    }

    /// In another colour.
    pub fn coloured(self, colour: RGBColor) -> Self {
        Self { colour, ..self }
    }
}

/// A sheet to draw on; the origin is the upper left corner.
pub struct Canvas<'a> {
    backend: SVGBackend<'a>,
}

/// Draws a picture of the given size in points and returns the SVG text.
pub fn picture(width: f64, height: f64, draw: impl FnOnce(&mut Canvas)) -> String {
    let mut text = String::new();
    let fine = (fine(width) as u32, fine(height) as u32);
    {
        let mut canvas = Canvas {
            backend: SVGBackend::with_string(&mut text, fine),
        };
        canvas.rectangle((0.0, 0.0), (width, height), RGBColor(255, 255, 255));
        draw(&mut canvas);
        settle(canvas.backend.present());
    }
    // What all elements share stands once, at the root; the size there is in points.
    let large = format!("<svg width=\"{}\" height=\"{}\"", fine.0, fine.1);
    let family = format!(" font-family=\"{FONT}\"");
    let shared = format!(
        "<svg width=\"{width}\" height=\"{height}\"{family} stroke-linejoin=\"round\" stroke-linecap=\"round\""
    );
    text.replace(&family, "")
        .replace(" opacity=\"1\"", "")
        .replacen(&large, &shared, 1)
}

impl Canvas<'_> {
    /// A line through points; broken where a coordinate is not finite.
    pub fn line(&mut self, points: &[(f64, f64)], stroke: Stroke) {
        for piece in points.split(|p| !(p.0.is_finite() && p.1.is_finite())) {
            match stroke.dash {
                None => self.unbroken(piece, stroke),
                Some(dash) => dashes(piece, dash).iter().for_each(|d| self.unbroken(d, stroke)),
            }
        }
    }

    fn unbroken(&mut self, points: &[(f64, f64)], stroke: Stroke) {
        if points.len() < 2 {
            return;
        }
        let mut fine: Vec<(i32, i32)> = points.iter().map(|&p| fine_point(p)).collect();
        fine.dedup();
        if fine.len() == 1 {
            fine.push(fine[0]);
        }
        let style = ShapeStyle {
            color: stroke.colour.to_rgba(),
            filled: false,
            stroke_width: fine_width(stroke.width),
        };
        settle(self.backend.draw_path(fine, &style));
    }

    /// A filled rectangle between two corners.
    pub fn rectangle(&mut self, a: (f64, f64), b: (f64, f64), colour: RGBColor) {
        let style = ShapeStyle {
            color: colour.to_rgba(),
            filled: true,
            stroke_width: 0,
        };
        settle(self.backend.draw_rect(fine_point(a), fine_point(b), &style, true));
    }

    /// A filled polygon.
    pub fn polygon(&mut self, points: &[(f64, f64)], colour: RGBColor) {
        let style = ShapeStyle {
            color: colour.to_rgba(),
            filled: true,
            stroke_width: 0,
        };
        let fine: Vec<(i32, i32)> = points.iter().map(|&p| fine_point(p)).collect();
        settle(self.backend.fill_polygon(fine, &style));
    }

    /// The outline of a rectangle.
    pub fn frame(&mut self, a: (f64, f64), b: (f64, f64), stroke: Stroke) {
        self.line(&[a, (b.0, a.1), b, (a.0, b.1), a], stroke);
    }

    /// Words at a point.
    pub fn text(&mut self, at: (f64, f64), text: &str, words: Words) {
        let transform = if words.upright {
            FontTransform::Rotate270
        } else {
            FontTransform::None
        };
        let weight = if words.bold { FontStyle::Bold } else { FontStyle::Normal };
        let font = (FONT, words.size * FINE * FONT_SCALE)
            .into_font()
            .style(weight)
            .transform(transform);
        let anchor = match words.anchor {
            Anchor::Left => HPos::Left,
            Anchor::Centre => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        let style = TextStyle {
            font,
            color: BLACK.to_backend_color(),
            pos: Pos::new(anchor, VPos::Center),
        }
        .color(&words.colour);
        // Half an ex below the point centres small letters; capitals and digits want a little more.
        let lower = 0.09 * words.size;
        let at = if words.upright {
            (at.0 + lower, at.1)
        } else {
            (at.0, at.1 + lower)
        };
        settle(self.backend.draw_text(text, &style, fine_point(at)));
    }
}

/// Writing into a string does not fail.
fn settle<T, E>(drawn: Result<T, E>) {
    debug_assert!(drawn.is_ok());
}

fn fine(x: f64) -> f64 {
    (x * FINE).round()
}

fn fine_point(p: (f64, f64)) -> (i32, i32) {
    (fine(p.0) as i32, fine(p.1) as i32)
}

fn fine_width(width: f64) -> u32 {
    fine(width).max(1.0) as u32
}

/// Cuts a line into dashes of equal length.
fn dashes(points: &[(f64, f64)], (dash, gap): (f64, f64)) -> Vec<Vec<(f64, f64)>> {
    let mut pieces = Vec::new();
    let mut piece: Vec<(f64, f64)> = points.first().copied().into_iter().collect();
    let (mut left, mut drawing) = (dash, true);
    for pair in points.windows(2) {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        let length = (x1 - x0).hypot(y1 - y0);
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let at = (x0 + (x1 - x0) * done / length, y0 + (y1 - y0) * done / length);
            if drawing {
                piece.push(at);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![at];
            }
            drawing = !drawing;
            left = if drawing { dash } else { gap };
        }
        left -= length - done;
        if drawing {
            piece.push((x1, y1));
        }
    }
    if piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}
