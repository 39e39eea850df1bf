//! A picture as data: rows of panels, each with two axes and series. [`Picture::svg`] is the only place that draws one.

use super::canvas::{INK, LineStyle, TextAnchor, TextStyle};
use super::colour::Colour;
use super::extent;
use super::ticks::Scale;

/// A picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Title; a picture without title has no head.
    pub title: String,
    /// Line below the title.
    pub about: String,
    /// Panels from top to bottom, those of a row from left to right. Neighbors with equal axes show their labels once.
    pub rows: Vec<Vec<Panel>>,
}

/// A pair of axes with series.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Width and height of the frame [pt].
    pub size: (f64, f64),
    /// Heading above the frame.
    pub heading: (String, TextStyle),
    /// Horizontal axis.
    pub x: PictureAxis,
    /// Vertical axis.
    pub y: PictureAxis,
    /// Series in the order in which they are drawn; areas are drawn below the grid.
    pub series: Vec<PictureSeries>,
    /// Color scale beside the frame.
    pub bar: Option<ColourBar>,
    /// True if the legend is beside the frame instead of above it.
    pub legend_beside: bool,
    /// True if frame, grid and ticks are left out.
    pub bare: bool,
}

/// An axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureAxis {
    /// Name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Number of ticks at most.
    pub ticks: usize,
    /// Least and largest value; if absent, those of the series with a margin.
    pub range: Option<(f64, f64)>,
    /// Values that the axis contains in addition to those of the series.
    pub with: Vec<f64>,
    /// Smallest half range, for values that are zero except for rounding errors.
    pub floor: f64,
    /// True if the axis is logarithmic.
    pub logarithmic: bool,
    /// Labels in place of round numbers.
    pub labels: Option<Vec<(f64, String)>>,
    /// Labels between frame and ticks.
    pub groups: Vec<(f64, String)>,
}

/// Data drawn in one style, with an optional name in the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureSeries {
    /// Entry of the legend.
    pub name: String,
    /// Text shown under the pointer, and the element of the page to which it links.
    pub link: Option<(String, String)>,
    /// Shape.
    pub kind: SeriesKind,
}

/// Kinds of series; coordinates are values of both axes.
#[derive(Clone, Debug, PartialEq)]
pub enum SeriesKind {
    /// A line, broken where a coordinate is not finite.
    Line(Vec<(f64, f64)>, LineStyle),
    /// Symbols at points.
    Marks(Vec<(f64, f64)>, Glyph, Colour),
    /// A filled polygon below the grid.
    Area(Vec<(f64, f64)>, Colour),
    /// A translucent polygon below the grid.
    Shade(Vec<(f64, f64)>, Colour),
    /// A filled rectangle between two corners, clipped to the frame.
    Cell([(f64, f64); 2], Colour),
    /// Text at a distance [pt] from a point; omitted if it would overlap an earlier one.
    Label((f64, f64), (f64, f64), String, TextStyle),
}

/// A symbol with its radius [pt].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Glyph {
    /// Circle with a line width.
    Ring(f64, f64),
    /// Filled square.
    Square(f64),
    /// Outline of a square.
    Box(f64),
    /// Two crossing lines.
    Cross(f64),
    /// Polygon with a number of corners and an angle of the first one; filled or hollow.
    Polygon(f64, usize, f64, bool),
}

/// A color scale.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourBar {
    /// Colors from the least value to the largest.
    pub colours: Vec<Colour>,
    /// Name, unit and range of the values.
    pub axis: PictureAxis,
    /// An additional color with its meaning.
    pub besides: Option<(Colour, String)>,
}

impl Picture {
    /// Arranges panels in one column.
    pub fn stacked(title: String, about: impl Into<String>, panels: impl IntoIterator<Item = Panel>) -> Self {
        Self {
            title,
            about: about.into(),
            rows: panels.into_iter().map(|panel| vec![panel]).collect(),
        }
    }

    /// The picture with error bands named in its subtitle, if there are any.
    #[must_use]
    pub fn with_bands_named(mut self) -> Self {
        let mut series = self.rows.iter().flatten().flat_map(|panel| &panel.series);
        if series.any(|one| matches!(one.kind, SeriesKind::Shade(..))) {
            self.about += "; bands: estimated error";
        }
        self
    }
}

impl Panel {
    /// Creates a panel with axes and series; `size` is that of the frame [pt].
    pub fn new(size: (f64, f64), x: PictureAxis, y: PictureAxis, series: Vec<PictureSeries>) -> Self {
        Self {
            size,
            heading: (String::new(), TextStyle::new(12.0, TextAnchor::Left)),
            x,
            y,
            series,
            bar: None,
            legend_beside: false,
            bare: false,
        }
    }

    /// Adds a heading.
    pub fn headed(mut self, text: impl Into<String>) -> Self {
        self.heading.0 = text.into();
        self
    }
}

impl PictureAxis {
    /// Creates an axis whose range follows the values of the series.
    pub fn new(name: impl Into<String>, unit: impl Into<String>, ticks: usize) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            ticks,
            ..Self::default()
        }
    }

    /// Sets the range.
    pub fn between(self, lo: f64, hi: f64) -> Self {
        Self {
            range: Some((lo, hi)),
            ..self
        }
    }

    /// Adds values that the axis contains.
    pub fn with(self, values: &[f64]) -> Self {
        Self {
            with: values.to_vec(),
            ..self
        }
    }

    /// Sets the smallest half range.
    pub fn above(self, floor: f64) -> Self {
        Self { floor, ..self }
    }

    /// Selects a logarithmic or linear axis.
    pub fn logarithmic(self, logarithmic: bool) -> Self {
        Self { logarithmic, ..self }
    }
}

impl PictureAxis {
    /// Least and largest value shown of a linear axis with these values.
    pub fn limits(&self, values: impl Iterator<Item = f64>) -> (f64, f64) {
        let scale = self.scale(values);
        (scale.lo, scale.hi)
    }

    /// Scale for these values.
    pub fn scale(&self, values: impl Iterator<Item = f64>) -> Scale {
        let unit = if self.unit.is_empty() { "1" } else { &self.unit };
        let values = values.chain(self.with.iter().copied());
        let shown = |x: f64| if self.logarithmic { x.log10() } else { x };
        let (found, margin) = match self.range {
            Some((lo, hi)) => (Some((shown(lo), shown(hi))), 0.0),
            None => (extent(values.map(shown)), 1.0),
        };
        let found = found.filter(|(lo, hi)| lo.is_finite() && hi.is_finite());
        let mut scale = match (self.logarithmic, found) {
            (true, Some((lo, hi))) => {
                let margin = margin * (0.04 * (hi - lo)).max(0.05);
                let multiples: &[f64] = if hi - lo > 3.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
                Scale::logarithmic((lo, hi), margin, multiples, (unit, self.ticks))
            }
            (false, Some((lo, hi))) if self.range.is_some() => Scale::exact(lo, hi, unit, self.ticks),
            _ => Scale::around(found, self.floor, unit, self.ticks),
        };
        if let Some(labels) = &self.labels {
            let within = labels.iter().map(|(at, text)| (shown(*at), text.clone()));
            scale.ticks = within
                .filter(|(at, _)| (0.0..=1.0).contains(&scale.share(*at)))
                .collect();
            scale.unit.clear();
        }
        scale
    }
}

impl PictureSeries {
    fn new(kind: SeriesKind) -> Self {
        Self {
            name: String::new(),
            link: None,
            kind,
        }
    }

    /// A line.
    pub fn line(points: impl IntoIterator<Item = (f64, f64)>, stroke: LineStyle) -> Self {
        Self::new(SeriesKind::Line(points.into_iter().collect(), stroke))
    }

    /// Symbols.
    pub fn marks(points: impl IntoIterator<Item = (f64, f64)>, glyph: Glyph, colour: Colour) -> Self {
        Self::new(SeriesKind::Marks(points.into_iter().collect(), glyph, colour))
    }

    /// A polygon.
    pub fn area(points: impl IntoIterator<Item = (f64, f64)>, colour: Colour) -> Self {
        Self::new(SeriesKind::Area(points.into_iter().collect(), colour))
    }

    /// The band between two curves: `(x, low, high)`.
    pub fn band(points: &[(f64, f64, f64)], colour: Colour) -> Self {
        Self::new(SeriesKind::Area(outline(points), colour))
    }

    /// A translucent band between two curves: `(x, low, high)`.
    pub fn shade(points: &[(f64, f64, f64)], colour: Colour) -> Self {
        Self::new(SeriesKind::Shade(outline(points), colour))
    }

    /// A rectangle.
    pub fn cell(corners: [(f64, f64); 2], colour: Colour) -> Self {
        Self::new(SeriesKind::Cell(corners, colour))
    }

    /// Text.
    pub fn label(at: (f64, f64), off: (f64, f64), text: impl Into<String>, words: TextStyle) -> Self {
        Self::new(SeriesKind::Label(at, off, text.into(), words))
    }

    /// A legend entry without data.
    pub fn note(text: impl Into<String>) -> Self {
        Self::line([], LineStyle::solid(INK, 0.0)).named(text)
    }

    /// Adds a legend entry.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..self
        }
    }

    /// Points that determine the range of an axis.
    pub fn points(&self) -> &[(f64, f64)] {
        match &self.kind {
            SeriesKind::Line(points, _) | SeriesKind::Marks(points, ..) => points,
            SeriesKind::Area(points, _) | SeriesKind::Shade(points, _) => points,
            SeriesKind::Cell(corners, _) => corners,
            SeriesKind::Label(..) => &[],
        }
    }
}

/// Outline of a band: the lower curve, and the upper one backwards.
fn outline(points: &[(f64, f64, f64)]) -> Vec<(f64, f64)> {
    let low = points.iter().map(|p| (p.0, p.1));
    let high = points.iter().rev().map(|p| (p.0, p.2));
    low.chain(high).collect()
}

/// Ranges and height with equal scales across and along, for a width [pt].
pub fn equally_scaled(x: (f64, f64), y: (f64, f64), width: f64) -> ((f64, f64), (f64, f64), f64) {
    /// Largest height [pt].
    const MOST: f64 = 420.0;
    let [across, up] = [x, y].map(|(lo, hi)| 1.1 * (hi - lo));
    let per_point = (across / width).max(up / MOST);
    let height = (up / per_point).max(60.0);
    let about = |(lo, hi): (f64, f64), half: f64| (0.5 * (lo + hi) - half, 0.5 * (lo + hi) + half);
    (
        about(x, 0.5 * width * per_point),
        about(y, 0.5 * height * per_point),
        height,
    )
}
