//! Lays out a picture: scales and positions of its panels, room for labels, legends and color scales.

use super::picture::{Panel, Picture, PictureSeries};
use super::style::PictureStyle;
use super::ticks::Scale;

/// Width of a letter relative to the size of its text.
const LETTER: f64 = 0.53;
/// Smallest width of a sheet [pt].
const LEAST: f64 = 560.0;
/// Margin of a sheet [pt].
pub const MARGIN: f64 = 16.0;
/// Room for a color scale [pt].
const BAR: f64 = 96.0;
/// Room for the sample of a legend [pt].
pub const SAMPLE: f64 = 32.0;

/// Estimated width of a text [pt].
pub fn width_of(text: &str, size: f64) -> f64 {
    let longest = text.lines().map(|line| line.chars().count()).max();
    LETTER * size * longest.unwrap_or(0) as f64
}

/// A panel with its scales and its place on the sheet.
pub struct PlacedPanel<'a> {
    /// The panel.
    pub panel: &'a Panel,
    /// Style of the picture.
    pub style: &'a PictureStyle,
    /// Horizontal scale.
    pub x: Scale,
    /// Vertical scale.
    pub y: Scale,
    /// True if tick labels and name are shown, for each axis.
    pub labelled: [bool; 2],
    /// Left edge of the frame.
    pub left: f64,
    /// Upper edge of the frame.
    pub top: f64,
    /// Entries of the legend.
    pub legend: Vec<LegendEntry<'a>>,
}

/// An entry of a legend: its text, and the series whose samples precede it.
pub struct LegendEntry<'a> {
    /// Text.
    pub text: &'a str,
    /// Series whose samples precede the text.
    pub series: Vec<&'a PictureSeries>,
    /// Offset from the frame's corner.
    pub at: (f64, f64),
}

/// Largest room among the panels of a column.
fn widest<'a>(rows: &[Vec<PlacedPanel<'a>>], column: usize, of: fn(&PlacedPanel<'a>) -> f64) -> f64 {
    rows.iter()
        .filter_map(|row| row.get(column))
        .map(of)
        .fold(0.0, f64::max)
}

/// Places the panels of a picture. Also returns width and height of the sheet, and the lines below the title.
pub fn lay<'a>(picture: &'a Picture, style: &'a PictureStyle) -> (Vec<Vec<PlacedPanel<'a>>>, (f64, f64), Vec<String>) {
    let mut rows = scaled(picture, style);
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let before: Vec<f64> = (0..columns).map(|k| widest(&rows, k, PlacedPanel::before)).collect();
    let behind: Vec<f64> = (0..columns).map(|k| widest(&rows, k, PlacedPanel::behind)).collect();
    let mut width = match picture.title.is_empty() {
        true => 0.0,
        false => LEAST.max(width_of(&picture.title, 18.0) + MARGIN),
    };
    for row in &mut rows {
        let mut left = 0.0;
        for (k, laid) in row.iter_mut().enumerate() {
            laid.left = left + before[k];
            left = laid.left + laid.panel.size.0 + behind[k];
        }
        width = width.max(left);
    }
    let letters = ((width - 2.0 * MARGIN) / (0.5 * style.normal)).max(1.0) as usize;
    let about = textwrap::wrap(&picture.about, letters);
    let about: Vec<String> = about.into_iter().map(|line| line.into_owned()).collect();
    let mut top = match picture.title.is_empty() {
        // half of a tick label
        true if style.paper => 0.6 * style.small,
        true => 0.0,
        false => 46.0 + 16.0 * about.len() as f64,
    };
    let mut named = vec![];
    for row in &mut rows {
        let above = row.iter_mut().map(|laid| laid.entries(&mut named, width));
        let above = above.fold(0.0, f64::max);
        let below = row.iter().map(PlacedPanel::below).fold(0.0, f64::max);
        let height = row.iter().map(|laid| laid.panel.size.1).fold(0.0, f64::max);
        for laid in row.iter_mut() {
            laid.top = top + above;
        }
        top += above + height + below;
    }
    let size = match style.sheet {
        Some((width, height)) => (width / style.scale, height / style.scale),
        None => (width.ceil(), top.ceil()),
    };
    (rows, size, about)
}

/// Panels with their scales. In a column, panels whose horizontal axes have the same name and unit share one range. Of neighbors with equal
/// axes only one shows the labels.
fn scaled<'a>(picture: &'a Picture, style: &'a PictureStyle) -> Vec<Vec<PlacedPanel<'a>>> {
    let points = |panel: &'_ Panel| {
        panel
            .series
            .iter()
            .flat_map(|one| one.points().to_vec())
            .collect::<Vec<_>>()
    };
    let place = |(k, panel)| {
        let named = |panel: &Panel| (panel.x.name.clone(), panel.x.unit.clone());
        let column = picture.rows.iter().filter_map(|row| row.get(k));
        let alike = column.filter(|other| named(other) == named(panel));
        PlacedPanel {
            panel,
            style,
            x: panel.x.scale(alike.flat_map(points).map(|p| p.0)),
            y: panel.y.scale(points(panel).into_iter().map(|p| p.1)),
            labelled: [!panel.bare; 2],
            left: 0.0,
            top: 0.0,
            legend: vec![],
        }
    };
    let placed = picture
        .rows
        .iter()
        .map(|row| row.iter().enumerate().map(place).collect());
    let mut rows: Vec<Vec<PlacedPanel>> = placed.collect();
    for r in 0..rows.len() {
        for k in 0..rows[r].len() {
            let own = &rows[r][k];
            let below = rows.get(r + 1).and_then(|row| row.get(k));
            let before = k.checked_sub(1).map(|before| &rows[r][before]);
            let same_x = below.is_some_and(|next| own.x == next.x && own.panel.x.name == next.panel.x.name);
            let same_y = before.is_some_and(|next| own.y == next.y && own.panel.y.name == next.panel.y.name);
            let [x, y] = own.labelled;
            rows[r][k].labelled = [x && !same_x, y && !same_y];
        }
    }
    rows
}

impl<'a> PlacedPanel<'a> {
    /// Right edge of the frame.
    pub fn right(&self) -> f64 {
        self.left + self.panel.size.0
    }

    /// Lower edge of the frame.
    pub fn bottom(&self) -> f64 {
        self.top + self.panel.size.1
    }

    /// Point on the sheet for fractions of both axes.
    pub fn place(&self, x: f64, y: f64) -> (f64, f64) {
        (self.left + self.panel.size.0 * x, self.bottom() - self.panel.size.1 * y)
    }

    /// Point on the sheet of a pair of values.
    pub fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        self.place(self.x.share_of(x), self.y.share_of(y))
    }

    /// Distance of the name of the vertical axis from the frame.
    pub fn beside(&self) -> f64 {
        let labels = self.y.ticks.iter().map(|(_, label)| width_of(label, self.style.small));
        let least = if self.style.paper { 0.0 } else { 52.0 };
        (20.0 + 1.1 * labels.fold(0.0, f64::max)).max(least)
    }

    /// Name of the vertical axis with its unit.
    pub fn name(&self) -> String {
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
        let names = self
            .panel
            .series
            .iter()
            .map(|one| width_of(&one.name, self.style.small));
        let bar = self.panel.bar.as_ref().map_or(0.0, |_| BAR);
        let legend = names.fold(0.0, f64::max);
        bar + match self.panel.legend_beside && legend > 0.0 {
            _ if self.panel.bare => 0.0,
            true => 18.0 + SAMPLE + legend + MARGIN,
            false if self.style.paper => 14.0,
            false => 24.0,
        }
    }

    /// Room below the frame.
    fn below(&self) -> f64 {
        let groups = if self.panel.x.groups.is_empty() { 0.0 } else { 16.0 };
        match (self.panel.bare, self.labelled[0]) {
            (true, _) => 0.0,
            (false, true) if self.style.paper => 40.0 + groups,
            (false, true) => 48.0 + groups,
            (false, false) => 14.0,
        }
    }

    /// Places the entries of the legend, without those of earlier panels. Returns the room above the frame.
    fn entries(&mut self, named: &mut Vec<&'a str>, width: f64) -> f64 {
        let new = |one: &&PictureSeries| !one.name.is_empty() && !named.contains(&&*one.name);
        for one in self.panel.series.iter().filter(new) {
            match self.legend.iter_mut().find(|entry| entry.text == one.name) {
                Some(entry) => entry.series.push(one),
                None => self.legend.push(LegendEntry {
                    text: &one.name,
                    series: vec![one],
                    at: (0.0, 0.0),
                }),
            }
        }
        named.extend(self.legend.iter().map(|entry| entry.text));
        let heading: f64 = if self.panel.heading.0.is_empty() { 0.0 } else { 20.0 };
        let [bar, besides] = if self.panel.bar.is_some() {
            [20.0, BAR]
        } else {
            [0.0; 2]
        };
        let (mut across, mut down) = (0.0, 0.0);
        for entry in &mut self.legend {
            if self.panel.legend_beside {
                entry.at = (self.panel.size.0 + besides + 18.0, 8.0 + down);
                down += 5.0 + 14.0 * entry.text.lines().count() as f64;
                continue;
            }
            let wide = SAMPLE + width_of(entry.text, self.style.small) + 14.0;
            if across > 0.0 && self.left + across + wide > width {
                (across, down) = (0.0, down + 18.0);
            }
            entry.at = (across, down);
            across += wide;
        }
        if self.panel.legend_beside || self.legend.is_empty() {
            return heading.max(bar);
        }
        let above = (heading + down + 22.0).max(bar);
        self.legend.iter_mut().for_each(|entry| entry.at.1 += 9.0 - above);
        above
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::plot::canvas::LineStyle;
    use crate::output::plot::colour::PALETTE;
    use crate::output::plot::picture::PictureAxis;

    /// Goal: stacked panels share one range and one row of labels, and the legend has every name once.
    #[test]
    fn panels_share_axes_and_legend() {
        let panel = |end: f64| {
            let line = PictureSeries::line([(0.0, 1.0), (end, 2.0)], LineStyle::solid(PALETTE[0], 1.0));
            let axes = ["time", "size"].map(|name| PictureAxis::new(name, "m", 5));
            let [x, y] = axes;
            Panel::new(
                (200.0, 100.0),
                x,
                y,
                vec![line.clone().named("a line"), line.named("a line")],
            )
        };
        let picture = Picture::stacked("title".into(), "about", [panel(1.0), panel(3.0)]);
        let style = PictureStyle::screen();
        let (rows, ..) = lay(&picture, &style);
        let [above, below] = [&rows[0][0], &rows[1][0]];
        assert_eq!(above.x, below.x);
        assert_eq!((above.labelled, below.labelled), ([false, true], [true, true]));
        assert_eq!((above.legend.len(), below.legend.len()), (1, 0));
        let svg = picture.svg().expect("a picture");
        assert_eq!(
            (svg.matches("a line").count(), svg.matches(">time [m]<").count()),
            (1, 1)
        );
        assert_eq!(Picture::default().svg(), None);
    }
}
