//! Draws a picture: grids, series, axes, legends and color scales of its panels.

use super::canvas::{Canvas, Drawing, FAINT_INK, INK, LineStyle, TextAnchor, TextStyle};
use super::colour::Colour;
use super::labels::LabelRoom;
use super::layout::{MARGIN, PlacedPanel, SAMPLE, lay, width_of};
use super::picture::{Glyph, Picture, PictureSeries, SeriesKind};
use super::style::PictureStyle;

const GRID: Colour = Colour(0xe4, 0xe7, 0xea);
const ZERO: Colour = Colour(0xa9, 0xaf, 0xb6);
const FRAME: LineStyle = LineStyle {
    colour: Colour(0x6b, 0x72, 0x7a),
    width: 0.8,
    dash: None,
};
const PAPER: Colour = Colour(0xff, 0xff, 0xff);

impl Picture {
    /// The SVG text; `None` if there is nothing to draw.
    pub fn svg(&self) -> Option<String> {
        self.drawing(&PictureStyle::screen()).map(|drawing| drawing.svg())
    }

    /// Width and height of the sheet, in units of the layout.
    pub fn size(&self, style: &PictureStyle) -> (f64, f64) {
        lay(self, style).1
    }

    /// The drawing in a style; `None` if there is nothing to draw.
    pub fn drawing(&self, style: &PictureStyle) -> Option<Drawing> {
        self.rows.iter().flatten().next()?;
        let (rows, size, about) = lay(self, style);
        Some(Drawing::new(style, size, |canvas| {
            let bold = TextStyle {
                bold: true,
                ..TextStyle::new(16.0, TextAnchor::Left)
            };
            canvas.text((MARGIN, 20.0), &self.title, bold);
            for (k, line) in about.iter().enumerate() {
                let words = TextStyle::new(style.normal, TextAnchor::Left).coloured(FAINT_INK);
                canvas.text((MARGIN, 40.0 + 16.0 * k as f64), line, words);
            }
            rows.iter().flatten().for_each(|laid| laid.draw(canvas));
        }))
    }
}

impl PlacedPanel<'_> {
    fn draw(&self, canvas: &mut Canvas) {
        let (series, bare) = (&self.panel.series, self.panel.bare);
        let below = |one: &&PictureSeries| matches!(one.kind, SeriesKind::Area(..) | SeriesKind::Shade(..));
        let longest = series.iter().filter_map(|one| match &one.kind {
            SeriesKind::Label(.., text, words) => Some((width_of(text, words.size), words.size)),
            _ => None,
        });
        let room = longest.reduce(|a, b| (a.0.max(b.0), a.1.max(b.1))).unwrap_or_default();
        let mut labels = LabelRoom::new(room);
        series
            .iter()
            .filter(below)
            .for_each(|one| self.one(canvas, one, &mut labels));
        if !bare && !self.style.paper {
            self.grid(canvas);
        }
        let others = series.iter().filter(|one| !below(one));
        others.for_each(|one| self.one(canvas, one, &mut labels));
        if !bare {
            self.axes(canvas);
        }
        let (text, words) = &self.panel.heading;
        canvas.text((self.left, self.top - 11.0), text, *words);
        for entry in &self.legend {
            let (x, y) = (self.left + entry.at.0, self.top + entry.at.1);
            entry.series.iter().for_each(|one| sample(canvas, (x, y), one));
            let words = TextStyle::new(self.style.small, TextAnchor::Left);
            for (k, line) in entry.text.lines().enumerate() {
                canvas.text((x + SAMPLE, y + 14.0 * k as f64), line, words);
            }
        }
        self.bar(canvas);
    }

    fn one(&self, canvas: &mut Canvas, one: &PictureSeries, labels: &mut LabelRoom) {
        match &one.link {
            Some((words, id)) => canvas.thing(words, id, |canvas| self.shape(canvas, &one.kind, labels)),
            None => self.shape(canvas, &one.kind, labels),
        }
    }

    fn shape(&self, canvas: &mut Canvas, kind: &SeriesKind, labels: &mut LabelRoom) {
        let placed = |points: &[(f64, f64)]| points.iter().map(|p| self.at(*p)).collect::<Vec<_>>();
        match kind {
            SeriesKind::Line(points, stroke) => canvas.line(&placed(points), *stroke),
            SeriesKind::Area(points, colour) => canvas.polygon(&placed(points), *colour),
            SeriesKind::Shade(points, colour) => {
                // the lower limit of an error can be zero, which no logarithmic axis contains
                let within = |(x, y): (f64, f64)| (x, y.clamp(self.top, self.bottom()));
                let inside: Vec<_> = placed(points).into_iter().map(within).collect();
                canvas.shade(&inside, *colour);
            }
            SeriesKind::Marks(points, glyph, colour) => {
                let within = |p: &(f64, f64)| p.0.is_finite() && p.1.is_finite();
                let all = placed(points).into_iter().filter(within);
                all.for_each(|at| glyph.draw(canvas, at, *colour));
            }
            SeriesKind::Cell(corners, colour) => {
                let [a, b] = corners.map(|p| self.at(p));
                let inside = |(x, y): (f64, f64)| (x.clamp(self.left, self.right()), y.clamp(self.top, self.bottom()));
                let low = inside((a.0.min(b.0), a.1.min(b.1)));
                // slightly larger, so that no hairline shows between cells
                let high = inside((a.0.max(b.0) + 0.4, a.1.max(b.1) + 0.4));
                canvas.rectangle(low, high, *colour);
            }
            SeriesKind::Label(at, off, text, words) => {
                let at = self.at(*at);
                let at = (at.0 + off.0, at.1 + off.1);
                if at.0.is_finite() && at.1.is_finite() && labels.claim(at) {
                    canvas.text(at, text, *words);
                }
            }
        }
    }

    fn grid(&self, canvas: &mut Canvas) {
        for (x, _) in &self.x.ticks {
            let at = self.place(self.x.share(*x), 0.0).0;
            canvas.line(&[(at, self.top), (at, self.bottom())], LineStyle::solid(GRID, 0.7));
        }
        for (y, _) in &self.y.ticks {
            let at = self.place(0.0, self.y.share(*y)).1;
            let zero = *y == 0.0 && !self.y.logarithmic && self.panel.y.labels.is_none();
            let colour = if zero { ZERO } else { GRID };
            canvas.line(&[(self.left, at), (self.right(), at)], LineStyle::solid(colour, 0.7));
        }
    }

    /// Frame, ticks and names.
    fn axes(&self, canvas: &mut Canvas) {
        let (left, bottom) = (self.left, self.bottom());
        let outwards = if self.style.paper { -1.0 } else { 1.0 };
        canvas.frame((left, self.top), (self.right(), bottom), FRAME);
        let mut room = LabelRoom::new((0.0, self.style.small));
        for (y, label) in &self.y.ticks {
            let at = self.place(0.0, self.y.share(*y)).1;
            canvas.line(&[(left - 4.0 * outwards, at), (left, at)], FRAME);
            if self.labelled[1] && room.claim((left, at)) {
                canvas.text(
                    (left - 7.0, at),
                    label,
                    TextStyle::new(self.style.small, TextAnchor::Right),
                );
            }
        }
        let words = TextStyle::new(self.style.normal, TextAnchor::Centre);
        let upright = TextStyle { upright: true, ..words };
        if self.labelled[1] {
            let at = (left - self.beside(), self.top + 0.5 * self.panel.size.1);
            canvas.text(at, &self.name(), upright);
        }
        let groups = &self.panel.x.groups;
        let down = if groups.is_empty() { 0.0 } else { 16.0 };
        let small = TextStyle::new(self.style.small, TextAnchor::Centre);
        let longest = |all: &[(f64, String)]| {
            all.iter()
                .map(|(_, text)| width_of(text, self.style.small))
                .fold(4.0, f64::max)
        };
        let mut room = LabelRoom::new((0.85 * longest(groups), self.style.small));
        for (x, label) in groups {
            let at = (self.at((*x, 0.0)).0, bottom + 13.0);
            if room.claim(at) {
                canvas.text(at, label, small);
            }
        }
        // space ticks by the longest label
        let mut room = LabelRoom::new((4.0 + longest(&self.x.ticks), self.style.small));
        for (x, label) in &self.x.ticks {
            let at = self.place(self.x.share(*x), 0.0).0;
            canvas.line(&[(at, bottom), (at, bottom + 4.0 * outwards)], FRAME);
            if self.labelled[0] && room.claim((at, bottom)) {
                canvas.text((at, bottom + 13.0 + down), label, small);
            }
        }
        if self.labelled[0] {
            let at = (left + 0.5 * self.panel.size.0, bottom + 31.0 + down);
            canvas.text(at, &self.x.named(&self.panel.x.name), words);
        }
    }

    fn bar(&self, canvas: &mut Canvas) {
        let Some(bar) = &self.panel.bar else { return };
        let scale = bar.axis.scale([].into_iter());
        let (left, right) = (self.right() + 24.0, self.right() + 39.0);
        let height = self.panel.size.1 / bar.colours.len() as f64;
        for (k, colour) in bar.colours.iter().enumerate() {
            let bottom = self.bottom() - k as f64 * height;
            let top = (bottom - height - 0.5).max(self.top);
            canvas.rectangle((left, top), (right, bottom), *colour);
        }
        canvas.frame((left, self.top), (right, self.bottom()), FRAME);
        for (x, label) in &scale.ticks {
            let at = self.bottom() - self.panel.size.1 * scale.share(*x);
            canvas.line(&[(right, at), (right + 4.0, at)], FRAME);
            canvas.text(
                (right + 7.0, at),
                label,
                TextStyle::new(self.style.small, TextAnchor::Left),
            );
        }
        let words = TextStyle::new(self.style.small, TextAnchor::Left);
        canvas.text((left - 4.0, self.top - 12.0), scale.named(&bar.axis.name).trim(), words);
        if let Some((colour, text)) = &bar.besides {
            let at = self.bottom() + 18.0;
            canvas.rectangle((left, at - 5.0), (right, at + 5.0), *colour);
            canvas.text((right + 7.0, at), text, words.coloured(FAINT_INK));
        }
    }
}

/// The sample of a series in a legend.
fn sample(canvas: &mut Canvas, (x, y): (f64, f64), one: &PictureSeries) {
    match &one.kind {
        SeriesKind::Line(_, stroke) if stroke.width > 0.0 => canvas.line(&[(x, y), (x + 24.0, y)], *stroke),
        SeriesKind::Marks(_, glyph, colour) => glyph.draw(canvas, (x + 12.0, y), *colour),
        SeriesKind::Area(_, colour) | SeriesKind::Cell(_, colour) => {
            canvas.rectangle((x + 5.0, y - 5.0), (x + 19.0, y + 5.0), *colour);
        }
        SeriesKind::Shade(_, colour) => {
            canvas.shade(
                &[(x, y - 5.0), (x + 24.0, y - 5.0), (x + 24.0, y + 5.0), (x, y + 5.0)],
                *colour,
            );
        }
        SeriesKind::Line(..) | SeriesKind::Label(..) => {}
    }
}

impl Glyph {
    fn draw(self, canvas: &mut Canvas, (x, y): (f64, f64), colour: Colour) {
        match self {
            Self::Ring(r, width) => canvas.ring((x, y), r, LineStyle::solid(colour, width)),
            Self::Square(r) => canvas.rectangle((x - r, y - r), (x + r, y + r), colour),
            Self::Box(r) => canvas.frame((x - r, y - r), (x + r, y + r), LineStyle::solid(colour, 1.2)),
            Self::Cross(r) => {
                let stroke = LineStyle::solid(INK, 1.3);
                canvas.line(&[(x - r, y - r), (x + r, y + r)], stroke);
                canvas.line(&[(x - r, y + r), (x + r, y - r)], stroke);
            }
            Self::Polygon(r, corners, turn, filled) => {
                let corner = |r: f64, k: usize| {
                    let angle = k as f64 * std::f64::consts::TAU / corners as f64 + turn;
                    (x + r * angle.cos(), y + r * angle.sin())
                };
                let shape = |r: f64| (0..corners).map(|k| corner(r, k)).collect::<Vec<_>>();
                canvas.polygon(&shape(r), colour);
                if !filled {
                    canvas.polygon(&shape(r - 1.4), PAPER);
                }
            }
        }
    }
}
