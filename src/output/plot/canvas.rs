//! Collects lines, areas and text of a drawing, in points, for [`super::svg`] and [`super::pdf`].

use super::colour::Colour;
use super::style::{POINTS_PER_MM, PictureStyle};

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

/// A shape of a drawing, in points from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub enum DrawnShape {
    /// A line through points.
    Line(Vec<(f64, f64)>, LineStyle),
    /// A filled polygon with its opacity.
    Polygon(Vec<(f64, f64)>, Colour, f64),
    /// A filled rectangle between two corners, the upper left one first.
    Rectangle((f64, f64), (f64, f64), Colour),
    /// An open ring with center, radius and line.
    Ring((f64, f64), f64, LineStyle),
    /// Text at a point.
    Text((f64, f64), String, TextStyle),
    /// Start of an item with a text under the pointer, which links to an element of a page.
    LinkStart(String, String),
    /// End of an item.
    LinkEnd,
}

/// A drawing: all shapes in the order in which they are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Width and height [pt].
    pub size: (f64, f64),
    /// Shapes.
    pub shapes: Vec<DrawnShape>,
    /// Style of the picture.
    pub style: PictureStyle,
}

/// A drawing area; the origin is the upper left corner. Its unit of length is that of the layout.
pub struct Canvas {
    shapes: Vec<DrawnShape>,
    /// Points per unit of the layout.
    scale: f64,
}

impl Drawing {
    /// Draws a picture of the given size in units of the layout.
    pub fn new(style: &PictureStyle, (width, height): (f64, f64), draw: impl FnOnce(&mut Canvas)) -> Self {
        let mut canvas = Canvas {
            shapes: vec![],
            scale: style.scale,
        };
        canvas.rectangle((0.0, 0.0), (width, height), Colour(255, 255, 255));
        draw(&mut canvas);
        Self {
            size: (style.scale * width, style.scale * height),
            shapes: canvas.shapes,
            style: style.clone(),
        }
    }

    /// Width and height [mm].
    pub fn size_mm(&self) -> [f64; 2] {
        [self.size.0, self.size.1].map(|x| x / POINTS_PER_MM)
    }
}

impl Canvas {
    fn placed(&self, at: (f64, f64)) -> (f64, f64) {
        (self.scale * at.0, self.scale * at.1)
    }

    fn all_placed(&self, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
        points.iter().map(|p| self.placed(*p)).collect()
    }

    fn scaled(&self, stroke: LineStyle) -> LineStyle {
        LineStyle {
            width: self.scale * stroke.width,
            dash: stroke.dash.map(|(dash, gap)| (self.scale * dash, self.scale * gap)),
            ..stroke
        }
    }

    /// Draws a linked item: `words` are shown under the pointer, and the link leads to the element `id` of a page.
    pub fn thing(&mut self, words: &str, id: &str, draw: impl FnOnce(&mut Self)) {
        self.shapes.push(DrawnShape::LinkStart(words.into(), id.into()));
        draw(self);
        self.shapes.push(DrawnShape::LinkEnd);
    }

    /// A line through points; broken where a coordinate is not finite.
    pub fn line(&mut self, points: &[(f64, f64)], stroke: LineStyle) {
        let stroke = self.scaled(stroke);
        let pieces = points.split(|p| !(p.0.is_finite() && p.1.is_finite()));
        for piece in pieces.filter(|piece| piece.len() > 1) {
            self.shapes.push(DrawnShape::Line(self.all_placed(piece), stroke));
        }
    }

    /// A filled rectangle between two corners, the upper left one first.
    pub fn rectangle(&mut self, a: (f64, f64), b: (f64, f64), colour: Colour) {
        self.shapes
            .push(DrawnShape::Rectangle(self.placed(a), self.placed(b), colour));
    }

    /// A filled polygon.
    pub fn polygon(&mut self, points: &[(f64, f64)], colour: Colour) {
        self.shapes
            .push(DrawnShape::Polygon(self.all_placed(points), colour, 1.0));
    }

    /// A translucent polygon.
    pub fn shade(&mut self, points: &[(f64, f64)], colour: Colour) {
        self.shapes
            .push(DrawnShape::Polygon(self.all_placed(points), colour, 0.22));
    }

    /// The outline of a rectangle.
    pub fn frame(&mut self, a: (f64, f64), b: (f64, f64), stroke: LineStyle) {
        self.line(&[a, (b.0, a.1), b, (a.0, b.1), a], stroke);
    }

    /// An open ring about a point.
    pub fn ring(&mut self, centre: (f64, f64), radius: f64, stroke: LineStyle) {
        let ring = DrawnShape::Ring(self.placed(centre), self.scale * radius, self.scaled(stroke));
        self.shapes.push(ring);
    }

    /// Draws text at a point.
    pub fn text(&mut self, at: (f64, f64), text: &str, words: TextStyle) {
        if text.is_empty() {
            return;
        }
        let words = TextStyle {
            size: self.scale * words.size,
            ..words
        };
        self.shapes.push(DrawnShape::Text(self.placed(at), text.into(), words));
    }
}
