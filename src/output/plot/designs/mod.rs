//! Pictures of many designs: curves along one number, maps over two.

mod map;

use std::slice;

use super::canvas::{FAINT_INK, LineStyle, TextAnchor, TextStyle};
use super::colour::PALETTE;
use super::extent;
use super::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries};
use crate::output::numbers::{count, quantity};
use crate::study::sweep::exchanged::Exchange;

pub use map::over_two;

/// One number of every design.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignNumbers {
    /// Name in files: a JSON pointer or a figure.
    pub name: String,
    /// Name beside an axis, without unit.
    pub label: String,
    /// Unit.
    pub unit: String,
    /// True if its axis is logarithmic.
    pub logarithmic: bool,
    /// Values; not finite if absent.
    pub values: Vec<f64>,
}

/// Data of the pictures. Each list of numbers has one entry per drawn design.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// Name of the case.
    pub case: String,
    /// Numbers of the drawn designs.
    pub designs: Vec<usize>,
    /// Varied numbers.
    pub varied: Vec<DesignNumbers>,
    /// Figures.
    pub figures: Vec<DesignNumbers>,
    /// Index of the curve of each design.
    pub curve: Vec<usize>,
    /// Names of the curves.
    pub curves: Vec<String>,
    /// True if the designs of a curve are joined by lines.
    pub joined: bool,
    /// Neighboring designs whose modes are not joined.
    pub apart: Vec<Exchange>,
    /// Number of all designs. Of very many only a part is drawn, spread over all.
    pub of: usize,
}

impl Drawn {
    /// True if a figure belongs to one mode in the first of two designs and to another mode in the second.
    fn parted(&self, figure: &str, designs: [usize; 2]) -> bool {
        let mode = figure.split_once('.').and_then(|(name, _)| name.strip_prefix("mode_"));
        let mode: Option<usize> = mode.and_then(|number| number.parse().ok());
        let between = |found: &Exchange| found.designs == designs || found.designs == [designs[1], designs[0]];
        let mut all = self.apart.iter().filter(|found| between(found));
        mode.is_some_and(|mode| all.any(|found| found.all.contains(&mode)))
    }

    /// Links the series of a design to its row, and shows its numbers under the pointer, if there are few designs.
    fn linked(&self, n: usize, figures: &[DesignNumbers], series: PictureSeries) -> PictureSeries {
        let said = |one: &DesignNumbers| {
            let unit = if one.unit.is_empty() { "1" } else { &one.unit };
            format!("{} {}", one.label, quantity(one.values[n], unit, 4))
        };
        let link = (self.designs.len() * self.figures.len() <= SAID).then(|| {
            let all: Vec<String> = self.varied.iter().chain(figures).map(said).collect();
            let number = self.designs[n];
            (
                format!("design {number}: {}", all.join(", ")),
                format!("design-{number}"),
            )
        });
        PictureSeries { link, ..series }
    }

    /// Text below the title.
    fn about(&self, what: &str) -> String {
        match self.designs.len() {
            all if all == self.of => what.into(),
            some => format!(
                "{what}; {} of {}, spread over them",
                count(some as u64),
                count(self.of as u64)
            ),
        }
    }
}

/// Largest number of points with text under the pointer. A text has some 300 bytes, and a page does not embed pictures that are too large.
const SAID: usize = 1000;
/// Largest number of curves named in the legend.
const LISTED: usize = 8;

impl DesignNumbers {
    fn shown(&self, x: f64) -> f64 {
        if self.logarithmic { x.log10() } else { x }
    }

    /// Value at a position on the axis.
    fn raised(&self, at: f64) -> f64 {
        if self.logarithmic { 10_f64.powf(at) } else { at }
    }

    fn on_axis(&self) -> Vec<f64> {
        self.values.iter().map(|&x| self.shown(x)).collect()
    }

    /// Positions of the values on the axis, each once, ascending.
    fn places(&self) -> Vec<f64> {
        let mut all = self.on_axis();
        all.retain(|at| at.is_finite());
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// The axis; `None` if there is no value.
    fn axis(&self, name: &str, ticks: usize) -> Option<PictureAxis> {
        extent(self.on_axis().into_iter())?;
        let axis = PictureAxis::new(name, &*self.unit, ticks).logarithmic(self.logarithmic);
        Some(axis.with(&self.values))
    }
}

/// Draws one panel per figure along the first varied number; `None` if there is nothing to draw.
pub fn along(data: &Drawn) -> Option<String> {
    let along = data.varied.first()?;
    let x = along.axis(&along.label, 7)?;
    let panels = data.figures.iter().enumerate().filter_map(|(k, figure)| {
        let mut series = curves(data, along, figure);
        let points = along.values.iter().zip(&figure.values).zip(&data.curve).enumerate();
        for (n, ((x, y), curve)) in points.filter(|(_, ((x, y), _))| x.is_finite() && y.is_finite()) {
            let ring = PictureSeries::marks([(*x, *y)], Glyph::Ring(3.0, 1.3), PALETTE[curve % PALETTE.len()]);
            series.push(data.linked(n, slice::from_ref(figure), ring));
            if k == 0 {
                let words = TextStyle::new(9.0, TextAnchor::Centre).coloured(FAINT_INK);
                let number = data.designs[n].to_string();
                series.push(PictureSeries::label((*x, *y), (0.0, -9.0), number, words));
            }
        }
        Some(Panel::new((560.0, 170.0), x.clone(), figure.axis("", 5)?, series).headed(&*figure.label))
    });
    let about = data.about("a ring a design, its number above it where there is room");
    Picture::stacked(data.case.clone(), about, panels).svg()
}

/// Lines through the designs of each curve, interrupted where modes are not joined. Several curves have names.
fn curves(data: &Drawn, along: &DesignNumbers, figure: &DesignNumbers) -> Vec<PictureSeries> {
    let mut series = vec![];
    for (curve, name) in data.curves.iter().enumerate() {
        let stroke = LineStyle::solid(PALETTE[curve % PALETTE.len()], 1.2);
        if data.curves.len() > 1 && curve <= LISTED {
            series.push(match curve < LISTED {
                true => PictureSeries::line([], stroke).named(&**name),
                false => PictureSeries::note(format!("and {} more", data.curves.len() - LISTED)),
            });
        }
        let mut own: Vec<usize> = (0..data.designs.len())
            .filter(|n| data.curve[*n] == curve && data.joined)
            .collect();
        own.sort_by(|a, b| along.values[*a].total_cmp(&along.values[*b]));
        let parted = |a: &usize, b: &usize| data.parted(&figure.name, [data.designs[*a], data.designs[*b]]);
        let pieces = own.chunk_by(|a, b| !parted(a, b));
        let points = |piece: &[usize]| {
            piece
                .iter()
                .map(|n| (along.values[*n], figure.values[*n]))
                .collect::<Vec<_>>()
        };
        series.extend(pieces.map(|piece| PictureSeries::line(points(piece), stroke)));
    }
    series
}

#[cfg(test)]
mod tests {
    use super::map::{around, edges};
    use super::*;

    /// Goal: a picture states how many designs it omits; without a figure there is no picture.
    #[test]
    fn pictures_say_what_they_leave_out() {
        let numbers = |name: &str, values: [f64; 2]| DesignNumbers {
            name: name.into(),
            label: name.into(),
            unit: "m".into(),
            logarithmic: name == "/b",
            values: values.to_vec(),
        };
        let mut data = Drawn {
            case: "case".into(),
            designs: vec![0, 1],
            varied: vec![numbers("/a", [1.0, 2.0]), numbers("/b", [1e-3, 1e2])],
            figures: vec![numbers("tip", [0.5, f64::NAN])],
            curve: vec![0, 0],
            curves: vec![String::new()],
            joined: true,
            apart: vec![],
            of: 5,
        };
        for picture in [along(&data), over_two(&data)] {
            let picture = picture.expect("a picture");
            assert!(
                picture.contains("2 of 5, spread over them") && !picture.contains("NaN"),
                "{picture}"
            );
            assert!(
                picture.contains("<a href=\"#design-0\"><title>design 0: /a 1.000 m, /b 1.000 mm, tip 500.0 mm"),
                "{picture}"
            );
        }
        assert_eq!(edges(&[11.0, 12.3, 14.0]), [10.35, 11.65, 13.15, 14.85]);
        assert_eq!(around(&[0.0, 1.0, 3.0], 1.0), (0.5, 2.0));
        // so many links would be too large for a page
        let many = Drawn {
            designs: (0..=SAID).collect(),
            varied: data
                .varied
                .iter()
                .map(|one| DesignNumbers {
                    values: vec![1.0; SAID + 1],
                    ..one.clone()
                })
                .collect(),
            figures: data
                .figures
                .iter()
                .map(|one| DesignNumbers {
                    values: vec![0.5; SAID + 1],
                    ..one.clone()
                })
                .collect(),
            curve: vec![0; SAID + 1],
            ..data.clone()
        };
        for picture in [along(&many), over_two(&many)] {
            let picture = picture.expect("a picture");
            assert!(!picture.contains("<a ") && picture.len() < 400_000, "{}", picture.len());
        }
        data.of = 2;
        assert!(!along(&data).expect("a picture").contains("of 2"));
        data.figures.clear();
        assert_eq!((along(&data), over_two(&data)), (None, None));
    }
}
