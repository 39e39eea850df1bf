//! Draws lines, rectangles and text as SVG, in points with a resolution of a tenth of a point.

use std::fmt::{self, Write as _};

use super::colour::Colour;
use crate::error::visible;

/// Fonts that exist in browsers and in converters from SVG to PDF.
const FONT: &str = "Helvetica Neue, Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";

/// Color of text.
pub const INK: Colour = Colour(0x22, 0x26, 0x2b);
/// Color of less important text.
pub const FAINT_INK: Colour = Colour(0x5f, 0x66, 0x6e);

/// Style of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineStyle {
    /// Color.
    pub colour: Colour,
    /// Width in points.
    pub width: f64,
    /// Lengths of dash and gap in points.
    pub dash: Option<(f64, f64)>,
}

impl LineStyle {
    /// An unbroken line.
    pub fn solid(colour: Colour, width: f64) -> Self {
        Self {
            colour,
            width,
            dash: None,
        }
    }

    /// A dashed line, with the lengths of dash and gap in points.
    pub fn dashed(colour: Colour, width: f64, dash: (f64, f64)) -> Self {
        Self {
            dash: Some(dash),
            ..Self::solid(colour, width)
        }
    }
}

/// Reference point of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TextAnchor {
    /// Left end, vertical middle.
    Left,
    /// Middle.
    Centre,
    /// Right end, vertical middle.
    Right,
}

/// Style of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextStyle {
    /// Size in points.
    pub size: f64,
    /// Color.
    pub colour: Colour,
    /// Reference point.
    pub anchor: TextAnchor,
    /// True for bold text.
    pub bold: bool,
    /// True for text that runs upwards.
    pub upright: bool,
}

impl TextStyle {
    /// Plain text.
    pub fn new(size: f64, anchor: TextAnchor) -> Self {
        Self {
            size,
            colour: INK,
            anchor,
            bold: false,
            upright: false,
        }
    }

    /// Sets the color.
    pub fn coloured(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }
}

/// A drawing area; the origin is the upper left corner.
pub struct Canvas {
    svg: String,
}

/// Draws a picture of the given size in points and returns the SVG text.
pub fn picture(width: f64, height: f64, draw: impl FnOnce(&mut Canvas)) -> String {
    let mut canvas = Canvas { svg: String::new() };
    canvas.put(format_args!(
        "<svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" xmlns=\"http://www.w3.org/2000/svg\" \
         font-family=\"{FONT}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">"
    ));
    canvas.rectangle((0.0, 0.0), (width, height), Colour(255, 255, 255));
    draw(&mut canvas);
    canvas.put(format_args!("</svg>"));
    canvas.svg
}

impl Canvas {
    /// Writes an element.
    fn put(&mut self, element: fmt::Arguments) {
        // writing to a string cannot fail
        let _ = writeln!(self.svg, "{element}");
    }

    /// Draws a linked item: `words` are shown under the pointer, and the link leads to the element `id` of a page.
    pub fn thing(&mut self, words: &str, id: &str, draw: impl FnOnce(&mut Self)) {
        self.put(format_args!("<a href=\"#{id}\"><title>{}</title>", escaped(words)));
        draw(self);
        self.put(format_args!("</a>"));
    }

    /// A line through points; broken where a coordinate is not finite.
    pub fn line(&mut self, points: &[(f64, f64)], stroke: LineStyle) {
        let (colour, width) = (stroke.colour, tenths(stroke.width).max(0.1));
        let dash = stroke
            .dash
            .map(|(dash, gap)| format!(" stroke-dasharray=\"{dash} {gap}\""));
        let dash = dash.unwrap_or_default();
        let pieces = points.split(|p| !(p.0.is_finite() && p.1.is_finite()));
        for piece in pieces.filter(|piece| piece.len() > 1) {
            let mut points: Vec<_> = piece.iter().map(|&p| fine(p)).collect();
            points.dedup();
            if points.len() == 1 {
                points.push(points[0]);
            }
            self.put(format_args!(
                "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"{dash} points=\"{}\"/>",
                listed(&points)
            ));
        }
    }

    /// A filled rectangle between two corners, the upper left one first.
    pub fn rectangle(&mut self, a: (f64, f64), b: (f64, f64), colour: Colour) {
        let ((x, y), b) = (fine(a), fine(b));
        let (width, height) = (tenths(b.0 - x), tenths(b.1 - y));
        self.put(format_args!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{colour}\"/>"
        ));
    }

    /// A filled polygon.
    pub fn polygon(&mut self, points: &[(f64, f64)], colour: Colour) {
        self.filled(points, format_args!("fill=\"{colour}\""));
    }

    /// A translucent polygon.
    pub fn shade(&mut self, points: &[(f64, f64)], colour: Colour) {
        self.filled(points, format_args!("fill=\"{colour}\" fill-opacity=\"0.22\""));
    }

    fn filled(&mut self, points: &[(f64, f64)], fill: fmt::Arguments) {
        let mut points: Vec<_> = points.iter().map(|&p| fine(p)).collect();
        points.dedup();
        self.put(format_args!("<polygon {fill} points=\"{}\"/>", listed(&points)));
    }

    /// The outline of a rectangle.
    pub fn frame(&mut self, a: (f64, f64), b: (f64, f64), stroke: LineStyle) {
        self.line(&[a, (b.0, a.1), b, (a.0, b.1), a], stroke);
    }

    /// An open ring about a point.
    pub fn ring(&mut self, centre: (f64, f64), radius: f64, stroke: LineStyle) {
        let ((x, y), radius, colour, width) = (fine(centre), tenths(radius), stroke.colour, stroke.width);
        self.put(format_args!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
        ));
    }

    /// Draws text at a point.
    pub fn text(&mut self, at: (f64, f64), text: &str, words: TextStyle) {
        if text.is_empty() {
            return;
        }
        let anchor = match words.anchor {
            TextAnchor::Left => "start",
            TextAnchor::Centre => "middle",
            TextAnchor::Right => "end",
        };
        // Half an ex below the point centers lowercase letters; capitals and digits need slightly more.
        let lower = 0.09 * words.size;
        let (x, y) = fine(match words.upright {
            true => (at.0 + lower, at.1),
            false => (at.0, at.1 + lower),
        });
        let turned = match words.upright {
            true => format!(" transform=\"rotate(270, {x}, {y})\""),
            false => String::new(),
        };
        let weight = if words.bold { " font-weight=\"bold\"" } else { "" };
        let text = escaped(text);
        self.put(format_args!(
            "<text x=\"{x}\" y=\"{y}\" dy=\"0.5ex\" text-anchor=\"{anchor}\" font-size=\"{}\" fill=\"{}\"{weight}{turned}>{text}</text>",
            words.size, words.colour
        ));
    }
}

/// Escapes text for an element.
fn escaped(text: &str) -> String {
    visible(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

/// Rounds to a tenth of a point, the resolution of a picture.
fn tenths(x: f64) -> f64 {
    f64::from((10.0 * x).round() as i32) / 10.0
}

fn fine(p: (f64, f64)) -> (f64, f64) {
    (tenths(p.0), tenths(p.1))
}

fn listed(points: &[(f64, f64)]) -> String {
    let mut text = String::with_capacity(12 * points.len());
    let mut buffer = zmij::Buffer::new();
    let mut put = |x: f64, end: char| {
        let number = buffer.format(x);
        text.push_str(number.strip_suffix(".0").unwrap_or(number));
        text.push(end);
    };
    for (x, y) in points {
        put(*x, ',');
        put(*y, ' ');
    }
    text.pop();
    text
}
