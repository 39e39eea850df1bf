//! Draws a picture as SVG: lays out its panels, then their grids, series, axes, legends and colour scales.

use super::canvas::{Anchor, Canvas, FAINT_INK, INK, Stroke, Words, picture};
use super::colour::Colour;
use super::extent;
use super::labels::LabelRoom;
use super::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries, SeriesKind};
use super::ticks::Scale;

const GRID: Colour = Colour(0xe4, 0xe7, 0xea);
const ZERO: Colour = Colour(0xa9, 0xaf, 0xb6);
const FRAME: Stroke = Stroke {
    colour: Colour(0x6b, 0x72, 0x7a),
    width: 0.8,
    dash: None,
};
const PAPER: Colour = Colour(0xff, 0xff, 0xff);
/// Size of tick labels and legends [pt].
const SMALL: f64 = 11.0;
/// Size of axis names [pt].
const NORMAL: f64 = 12.5;
/// Width of a letter over the size of its text.
const LETTER: f64 = 0.53;
/// Least width of a sheet [pt].
const LEAST: f64 = 560.0;
/// Margin of a sheet [pt].
const MARGIN: f64 = 16.0;
/// Room of a colour scale [pt].
const BAR: f64 = 96.0;
/// Room of the sample of a legend [pt].
const SAMPLE: f64 = 32.0;

/// Estimated width of a text [pt].
fn width_of(text: &str, size: f64) -> f64 {
    let longest = text.lines().map(|line| line.chars().count()).max();
    LETTER * size * longest.unwrap_or(0) as f64
}

/// A panel with its scales and its place on the sheet.
struct Laid<'a> {
    panel: &'a Panel,
    x: Scale,
    y: Scale,
    /// True if labels and name of the axis are shown.
    labelled: [bool; 2],
    left: f64,
    top: f64,
    legend: Vec<Entry<'a>>,
}

/// An entry of a legend: its text and the series whose samples stand before it.
struct Entry<'a> {
    text: &'a str,
    series: Vec<&'a PictureSeries>,
    /// Offset from the frame's corner.
    at: (f64, f64),
}

/// Largest room of the panels above each other.
fn widest<'a>(rows: &[Vec<Laid<'a>>], column: usize, of: fn(&Laid<'a>) -> f64) -> f64 {
    rows.iter()
        .filter_map(|row| row.get(column))
        .map(of)
        .fold(0.0, f64::max)
}

impl Picture {
    /// The SVG text; `None` if there is nothing to draw.
    pub fn svg(&self) -> Option<String> {
        let mut rows = self.laid();
        rows.iter().flatten().next()?;
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let before: Vec<f64> = (0..columns).map(|k| widest(&rows, k, Laid::before)).collect();
        let behind: Vec<f64> = (0..columns).map(|k| widest(&rows, k, Laid::behind)).collect();
        let mut width = match self.title.is_empty() {
            true => 0.0,
            false => LEAST.max(width_of(&self.title, 18.0) + MARGIN),
        };
        for row in &mut rows {
            let mut left = 0.0;
            for (k, laid) in row.iter_mut().enumerate() {
                laid.left = left + before[k];
                left = laid.left + laid.panel.size.0 + behind[k];
            }
            width = width.max(left);
        }
        let letters = ((width - 2.0 * MARGIN) / (0.5 * NORMAL)).max(1.0) as usize;
        let about = textwrap::wrap(&self.about, letters);
        let mut top = match self.title.is_empty() {
            true => 0.0,
            false => 46.0 + 16.0 * about.len() as f64,
        };
        let mut named = vec![];
        for row in &mut rows {
            let above = row.iter_mut().map(|laid| laid.entries(&mut named, width));
            let above = above.fold(0.0, f64::max);
            let below = row.iter().map(Laid::below).fold(0.0, f64::max);
            let height = row.iter().map(|laid| laid.panel.size.1).fold(0.0, f64::max);
            for laid in row.iter_mut() {
                laid.top = top + above;
            }
            top += above + height + below;
        }
        Some(picture(width.ceil(), top.ceil(), |canvas| {
            let bold = Words {
                bold: true,
                ..Words::new(16.0, Anchor::Left)
            };
            canvas.text((MARGIN, 20.0), &self.title, bold);
            for (k, line) in about.iter().enumerate() {
                let words = Words::new(NORMAL, Anchor::Left).coloured(FAINT_INK);
                canvas.text((MARGIN, 40.0 + 16.0 * k as f64), line, words);
            }
            rows.iter().flatten().for_each(|laid| laid.draw(canvas));
        }))
    }

    /// Panels with their scales; those above each other share the range of an axis that has one name and unit.
    fn laid(&self) -> Vec<Vec<Laid<'_>>> {
        let alike = |k: usize, x: &PictureAxis| {
            let all = self.rows.iter().filter_map(move |row| row.get(k));
            let of = |panel: &Panel| (panel.x.name.clone(), panel.x.unit.clone());
            let own = (x.name.clone(), x.unit.clone());
            all.filter(move |panel| of(panel) == own)
                .flat_map(|panel| panel.series.iter().flat_map(|one| one.points()).map(|p| p.0))
        };
        let mut rows: Vec<Vec<Laid>> = self.rows.iter().map(|_| vec![]).collect();
        for (row, panels) in rows.iter_mut().zip(&self.rows) {
            for (k, panel) in panels.iter().enumerate() {
                let values = panel.series.iter().flat_map(|one| one.points()).map(|p| p.1);
                row.push(Laid {
                    panel,
                    x: panel.x.scale(alike(k, &panel.x)),
                    y: panel.y.scale(values),
                    labelled: [true; 2],
                    left: 0.0,
                    top: 0.0,
                    legend: vec![],
                });
            }
        }
        let same = |a: (&Scale, &PictureAxis), b: (&Scale, &PictureAxis)| a.0 == b.0 && a.1.name == b.1.name;
        for r in 0..rows.len() {
            for k in 0..rows[r].len() {
                let (row, below) = (&rows[r], rows.get(r + 1).and_then(|row| row.get(k)));
                let own = &row[k];
                let x = below.is_none_or(|next| !same((&own.x, &own.panel.x), (&next.x, &next.panel.x)));
                let before = k.checked_sub(1).map(|before| &row[before]);
                let y = before.is_none_or(|next| !same((&own.y, &own.panel.y), (&next.y, &next.panel.y)));
                rows[r][k].labelled = [x, y].map(|shown| shown && !own.panel.bare);
            }
        }
        rows
    }
}

impl PictureAxis {
    /// Least and largest value shown of a linear axis with these values.
    pub fn limits(&self, values: impl Iterator<Item = f64>) -> (f64, f64) {
        let scale = self.scale(values);
        (scale.lo, scale.hi)
    }

    /// The scale of values.
    fn scale(&self, values: impl Iterator<Item = f64>) -> Scale {
        let unit = if self.unit.is_empty() { "1" } else { &self.unit };
        let values = values.chain(self.with.iter().copied());
        let shown = |x: f64| if self.logarithmic { x.log10() } else { x };
        let (found, margin) = match self.range {
            Some((lo, hi)) => (Some((shown(lo), shown(hi))), 0.0),
            None => (extent(values.map(shown)), 1.0),
        };
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

impl<'a> Laid<'a> {
    fn right(&self) -> f64 {
        self.left + self.panel.size.0
    }

    fn bottom(&self) -> f64 {
        self.top + self.panel.size.1
    }

    /// Point on the sheet of shares of both axes.
    fn place(&self, x: f64, y: f64) -> (f64, f64) {
        (self.left + self.panel.size.0 * x, self.bottom() - self.panel.size.1 * y)
    }

    /// Point on the sheet of a pair of values.
    fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        self.place(self.x.share_of(x), self.y.share_of(y))
    }

    /// Distance of the name of the vertical axis from the frame.
    fn beside(&self) -> f64 {
        let labels = self.y.ticks.iter().map(|(_, label)| width_of(label, SMALL));
        (20.0 + 1.1 * labels.fold(0.0, f64::max)).max(52.0)
    }

    /// Name of the vertical axis with its unit.
    fn name(&self) -> String {
        self.y.named(&self.panel.y.name).trim().into()
    }

    /// Room left of the frame.
    fn before(&self) -> f64 {
        match self.labelled[1] {
            _ if self.panel.bare => 0.0,
            true => self.beside() + if self.name().is_empty() { 4.0 } else { 14.0 },
            false => MARGIN,
        }
    }

    /// Room right of the frame.
    fn behind(&self) -> f64 {
        let names = self.panel.series.iter().map(|one| width_of(&one.name, SMALL));
        let bar = self.panel.bar.as_ref().map_or(0.0, |_| BAR);
        let legend = names.fold(0.0, f64::max);
        bar + match self.panel.legend_beside && legend > 0.0 {
            _ if self.panel.bare => 0.0,
            true => 18.0 + SAMPLE + legend + MARGIN,
            false => 24.0,
        }
    }

    /// Room below the frame.
    fn below(&self) -> f64 {
        let groups = if self.panel.x.groups.is_empty() { 0.0 } else { 16.0 };
        match (self.panel.bare, self.labelled[0]) {
            (true, _) => 0.0,
            (false, true) => 48.0 + groups,
            (false, false) => 14.0,
        }
    }

    /// Places the entries of the legend, without those of earlier panels; the room above the frame.
    fn entries(&mut self, named: &mut Vec<&'a str>, width: f64) -> f64 {
        let new = |one: &&PictureSeries| !one.name.is_empty() && !named.contains(&&*one.name);
        for one in self.panel.series.iter().filter(new) {
            match self.legend.iter_mut().find(|entry| entry.text == one.name) {
                Some(entry) => entry.series.push(one),
                None => self.legend.push(Entry {
                    text: &one.name,
                    series: vec![one],
                    at: (0.0, 0.0),
                }),
            }
        }
        named.extend(self.legend.iter().map(|entry| entry.text));
        let heading: f64 = if self.panel.heading.0.is_empty() { 0.0 } else { 20.0 };
        let bar = self.panel.bar.as_ref().map_or(0.0, |_| 20.0);
        let besides = if self.panel.bar.is_some() { BAR } else { 0.0 };
        if self.panel.legend_beside {
            let mut down = 8.0_f64;
            for entry in &mut self.legend {
                entry.at = (self.panel.size.0 + besides + 18.0, down);
                down += 5.0 + 14.0 * entry.text.lines().count() as f64;
            }
            return heading.max(bar);
        }
        let (mut across, mut lines) = (0.0, 0.0);
        for entry in &mut self.legend {
            let wide = SAMPLE + width_of(entry.text, SMALL) + 14.0;
            if across > 0.0 && self.left + across + wide > width {
                (across, lines) = (0.0, lines + 1.0);
            }
            entry.at = (across, 18.0 * lines);
            across += wide;
        }
        let rows = if self.legend.is_empty() { 0.0 } else { lines + 1.0 };
        let above = (heading + 18.0 * rows + if rows > 0.0 { 4.0 } else { 0.0 }).max(bar);
        for entry in &mut self.legend {
            entry.at.1 += 9.0 - above;
        }
        above
    }

    fn draw(&self, canvas: &mut Canvas) {
        let (series, bare) = (&self.panel.series, self.panel.bare);
        let below = |one: &&PictureSeries| matches!(one.kind, SeriesKind::Area(..));
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
        if !bare {
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
            let words = Words::new(SMALL, Anchor::Left);
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
            SeriesKind::Marks(points, glyph, colour) => {
                let within = |p: &(f64, f64)| p.0.is_finite() && p.1.is_finite();
                let all = placed(points).into_iter().filter(within);
                all.for_each(|at| glyph.draw(canvas, at, *colour));
            }
            SeriesKind::Cell(corners, colour) => {
                let [a, b] = corners.map(|p| self.at(p));
                let inside = |(x, y): (f64, f64)| (x.clamp(self.left, self.right()), y.clamp(self.top, self.bottom()));
                let low = inside((a.0.min(b.0), a.1.min(b.1)));
                // a little more, so that no hairline shows between cells
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
            canvas.line(&[(at, self.top), (at, self.bottom())], Stroke::solid(GRID, 0.7));
        }
        for (y, _) in &self.y.ticks {
            let at = self.place(0.0, self.y.share(*y)).1;
            let zero = *y == 0.0 && !self.y.logarithmic && self.panel.y.labels.is_none();
            let colour = if zero { ZERO } else { GRID };
            canvas.line(&[(self.left, at), (self.right(), at)], Stroke::solid(colour, 0.7));
        }
    }

    /// Frame, ticks and names.
    fn axes(&self, canvas: &mut Canvas) {
        let (left, bottom) = (self.left, self.bottom());
        canvas.frame((left, self.top), (self.right(), bottom), FRAME);
        let mut room = LabelRoom::new((0.0, SMALL));
        for (y, label) in &self.y.ticks {
            let at = self.place(0.0, self.y.share(*y)).1;
            canvas.line(&[(left - 4.0, at), (left, at)], FRAME);
            if self.labelled[1] && room.claim((left, at)) {
                canvas.text((left - 7.0, at), label, Words::new(SMALL, Anchor::Right));
            }
        }
        let words = Words::new(NORMAL, Anchor::Centre);
        let upright = Words { upright: true, ..words };
        if self.labelled[1] {
            let at = (left - self.beside(), self.top + 0.5 * self.panel.size.1);
            canvas.text(at, &self.name(), upright);
        }
        let groups = &self.panel.x.groups;
        let down = if groups.is_empty() { 0.0 } else { 16.0 };
        let small = Words::new(SMALL, Anchor::Centre);
        let longest = |all: &[(f64, String)]| all.iter().map(|(_, text)| width_of(text, SMALL)).fold(4.0, f64::max);
        let mut room = LabelRoom::new((0.85 * longest(groups), SMALL));
        for (x, label) in groups {
            let at = (self.at((*x, 0.0)).0, bottom + 13.0);
            if room.claim(at) {
                canvas.text(at, label, small);
            }
        }
        // labels of one axis are about as long as the longest
        let mut room = LabelRoom::new((4.0 + longest(&self.x.ticks), SMALL));
        for (x, label) in &self.x.ticks {
            let at = self.place(self.x.share(*x), 0.0).0;
            canvas.line(&[(at, bottom), (at, bottom + 4.0)], FRAME);
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
            canvas.text((right + 7.0, at), label, Words::new(SMALL, Anchor::Left));
        }
        let words = Words::new(SMALL, Anchor::Left);
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
        SeriesKind::Line(..) | SeriesKind::Label(..) => {}
    }
}

impl Glyph {
    fn draw(self, canvas: &mut Canvas, (x, y): (f64, f64), colour: Colour) {
        match self {
            Self::Ring(r, width) => canvas.ring((x, y), r, Stroke::solid(colour, width)),
            Self::Square(r) => canvas.rectangle((x - r, y - r), (x + r, y + r), colour),
            Self::Box(r) => canvas.frame((x - r, y - r), (x + r, y + r), Stroke::solid(colour, 1.2)),
            Self::Cross(r) => {
                let stroke = Stroke::solid(INK, 1.3);
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
