//! A drawing as SVG.

use std::fmt::{self, Write as _};

use super::canvas::{Drawing, DrawnShape, LineStyle, TextAnchor, TextStyle};
use super::colour::Colour;
use super::style::Rise;
use super::style::runs;
use crate::error::visible;

impl Drawing {
    /// The SVG text.
    pub fn svg(&self) -> String {
        let mut out = SvgText {
            text: String::new(),
            digits: self.style.digits,
            typeset: self.style.typeset,
        };
        let ((width, height), font) = (self.size, escaped(&self.style.font).replace('"', "&quot;"));
        let [w, h] = match self.style.millimetres {
            true => [width, height].map(|x| format!("{}mm", out.round(x / super::style::POINTS_PER_MM))),
            false => [width, height].map(|x| x.to_string()),
        };
        let [width, height] = [width, height].map(|x| if self.style.millimetres { out.round(x) } else { x });
        out.put(format_args!(
            "<svg width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {width} {height}\" xmlns=\"http://www.w3.org/2000/svg\" \
             font-family=\"{font}\" stroke-linejoin=\"round\" stroke-linecap=\"{}\">",
            self.style.cap()
        ));
        self.shapes.iter().for_each(|shape| out.shape(shape));
        out.put(format_args!("</svg>"));
        out.text
    }
}

/// SVG text under construction, with coordinates of some decimals.
struct SvgText {
    text: String,
    digits: i32,
    typeset: bool,
}

impl SvgText {
    /// Writes an element.
    fn put(&mut self, element: fmt::Arguments) {
        // writing to a string cannot fail
        let _ = writeln!(self.text, "{element}");
    }

    fn shape(&mut self, shape: &DrawnShape) {
        match shape {
            DrawnShape::Line(points, stroke) => self.line(points, *stroke),
            DrawnShape::Polygon(points, colour, opacity) => {
                let mut points = self.fine(points);
                points.dedup();
                let opacity = match *opacity < 1.0 {
                    true => format!(" fill-opacity=\"{opacity}\""),
                    false => String::new(),
                };
                self.put(format_args!(
                    "<polygon fill=\"{colour}\"{opacity} points=\"{}\"/>",
                    listed(&points)
                ));
            }
            DrawnShape::Rectangle(a, b, colour) => self.rectangle(*a, *b, *colour),
            DrawnShape::Ring((x, y), radius, stroke) => {
                let ([x, y, radius], colour) = ([*x, *y, *radius].map(|x| self.round(x)), stroke.colour);
                let width = self.width(*stroke);
                self.put(format_args!(
                    "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
                ));
            }
            DrawnShape::Text(at, text, words) => self.text(*at, text, *words),
            DrawnShape::LinkStart(words, id) => {
                self.put(format_args!("<a href=\"#{id}\"><title>{}</title>", escaped(words)));
            }
            DrawnShape::LinkEnd => self.put(format_args!("</a>")),
        }
    }

    fn line(&mut self, points: &[(f64, f64)], stroke: LineStyle) {
        let (colour, width) = (stroke.colour, self.round(stroke.width).max(self.step()));
        let dash = stroke.dash.map(|(dash, gap)| {
            let [dash, gap] = [dash, gap].map(|x| if self.digits > 1 { self.round(x) } else { x });
            format!(" stroke-dasharray=\"{dash} {gap}\"")
        });
        let dash = dash.unwrap_or_default();
        let mut points = self.fine(points);
        points.dedup();
        if points.len() == 1 {
            points.push(points[0]);
        }
        self.put(format_args!(
            "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"{dash} points=\"{}\"/>",
            listed(&points)
        ));
    }

    fn rectangle(&mut self, a: (f64, f64), b: (f64, f64), colour: Colour) {
        let [x, y, right, bottom] = [a.0, a.1, b.0, b.1].map(|x| self.round(x));
        let [width, height] = [right - x, bottom - y].map(|x| self.round(x));
        self.put(format_args!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{colour}\"/>"
        ));
    }

    fn text(&mut self, at: (f64, f64), text: &str, words: TextStyle) {
        let anchor = match words.anchor {
            TextAnchor::Left => "start",
            TextAnchor::Centre => "middle",
            TextAnchor::Right => "end",
        };
        // Half an ex below the point centers lowercase letters; capitals and digits need slightly more.
        let lower = 0.09 * words.size;
        let (x, y) = match words.upright {
            true => (at.0 + lower, at.1),
            false => (at.0, at.1 + lower),
        };
        let [x, y] = [x, y].map(|x| self.round(x));
        let turned = match words.upright {
            true => format!(" transform=\"rotate(270, {x}, {y})\""),
            false => String::new(),
        };
        let weight = if words.bold { " font-weight=\"bold\"" } else { "" };
        let (size, colour) = (words.size, words.colour);
        let size = if self.typeset { self.round(size) } else { size };
        let text = match self.typeset {
            true => self.typeset(text, size),
            false => escaped(text),
        };
        self.put(format_args!(
            "<text x=\"{x}\" y=\"{y}\" dy=\"0.5ex\" text-anchor=\"{anchor}\" font-size=\"{size}\" fill=\"{colour}\"{weight}{turned}>{text}</text>"
        ));
    }

    /// Text with raised and lowered digits as smaller ones of the same font, for fonts without such signs.
    fn typeset(&self, text: &str, size: f64) -> String {
        let mut out = String::new();
        let mut level = 0.0;
        for (part, rise) in runs(text) {
            let shift = self.round(level - rise.height() * size);
            level = rise.height() * size;
            let part = escaped(&part);
            match rise {
                Rise::None if shift == 0.0 => out += &part,
                Rise::None => {
                    let _ = write!(out, "<tspan dy=\"{shift}\">{part}</tspan>");
                }
                _ => {
                    let small = self.round(rise.size() * size);
                    let _ = write!(out, "<tspan dy=\"{shift}\" font-size=\"{small}\">{part}</tspan>");
                }
            }
        }
        out
    }

    fn width(&self, stroke: LineStyle) -> f64 {
        if self.digits > 1 {
            self.round(stroke.width)
        } else {
            stroke.width
        }
    }

    /// Resolution [pt].
    fn step(&self) -> f64 {
        10_f64.powi(-self.digits)
    }

    /// Rounds to the resolution of the picture.
    fn round(&self, x: f64) -> f64 {
        let per_point = 10_f64.powi(self.digits);
        f64::from((per_point * x).round() as i32) / per_point
    }

    fn fine(&self, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
        points.iter().map(|p| (self.round(p.0), self.round(p.1))).collect()
    }
}

/// Escapes text for an element.
fn escaped(text: &str) -> String {
    visible(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
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
