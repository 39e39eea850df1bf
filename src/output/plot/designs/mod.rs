//! Pictures of many designs: curves along one number, a map over two.

mod map;

use std::slice;

use super::canvas::{Anchor, Canvas, FAINT_INK, Stroke, Words, picture};
use super::colour::PALETTE;
use super::extent;
use super::labels::LabelRoom;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;
use crate::output::numbers::{count, quantity};
use crate::study::sweep::exchanged::Exchange;

pub use map::over_two;

/// One number of every design.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbers {
    /// Its name in files: a JSON pointer or a figure.
    pub name: String,
    /// Its name beside an axis, without unit.
    pub label: String,
    /// Its unit.
    pub unit: String,
    /// Whether its axis is logarithmic.
    pub logarithmic: bool,
    /// Values, not finite where there is none.
    pub values: Vec<f64>,
}

/// All that is shown; every list is as long as there are designs.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// Name of the case.
    pub case: String,
    /// Numbers of the designs.
    pub designs: Vec<usize>,
    /// What is varied.
    pub varied: Vec<Numbers>,
    /// What came out.
    pub figures: Vec<Numbers>,
    /// To which curve a design belongs.
    pub curve: Vec<usize>,
    /// What the curves are.
    pub curves: Vec<String>,
    /// Whether designs of a curve follow each other.
    pub joined: bool,
    /// Neighbours whose modes are not joined.
    pub apart: Vec<Exchange>,
    /// Designs that there are; of very many a part is drawn, spread over them.
    pub of: usize,
}

impl Drawn {
    /// Whether a figure is that of one mode in the first of two designs and of another in the second.
    fn parted(&self, figure: &str, designs: [usize; 2]) -> bool {
        let mode = figure.split_once('.').and_then(|(name, _)| name.strip_prefix("mode_"));
        let mode: Option<usize> = mode.and_then(|number| number.parse().ok());
        let between = |found: &Exchange| found.designs == designs || found.designs == [designs[1], designs[0]];
        let mut all = self.apart.iter().filter(|found| between(found));
        mode.is_some_and(|mode| all.any(|found| found.all.contains(&mode)))
    }

    /// Draws what stands for a design. Where there are few it says its numbers and leads to its row.
    fn thing(&self, canvas: &mut Canvas, n: usize, figures: &[Numbers], draw: impl FnOnce(&mut Canvas)) {
        if self.designs.len() * self.figures.len() > SAID {
            return draw(canvas);
        }
        let said = |one: &Numbers| {
            let unit = if one.unit.is_empty() { "1" } else { &one.unit };
            format!("{} {}", one.label, quantity(one.values[n], unit, 4))
        };
        let all: Vec<String> = self.varied.iter().chain(figures).map(said).collect();
        let number = self.designs[n];
        let words = format!("design {number}: {}", all.join(", "));
        canvas.thing(&words, &format!("design-{number}"), draw);
    }

    /// What stands below the title.
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

const LEFT: f64 = 100.0;
const TOP: f64 = 78.0;
const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 170.0;
const GAP: f64 = 36.0;
/// Width and height of the number of a design; numbers that would overlap one before them are left out.
const ROOM: (f64, f64) = (17.0, 10.0);
/// Points that say what they are at most: words are some 300 bytes each, and a page leaves pictures that are too large to their files.
const SAID: usize = 1000;
/// Curves told apart by colours.
const TOLD: usize = 8;

impl Numbers {
    fn shown(&self, x: f64) -> f64 {
        if self.logarithmic { x.log10() } else { x }
    }

    fn on_axis(&self) -> Vec<f64> {
        self.values.iter().map(|&x| self.shown(x)).collect()
    }

    /// Where values lie on the axis, each once, ascending.
    fn places(&self) -> Vec<f64> {
        let mut all = self.on_axis();
        all.retain(|at| at.is_finite());
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// The axis; none where there is no value.
    fn scale(&self, count: usize) -> Option<Scale> {
        let (lo, hi) = extent(self.on_axis().into_iter())?;
        let unit = if self.unit.is_empty() { "1" } else { &self.unit };
        if !self.logarithmic {
            return Some(Scale::around(Some((lo, hi)), 0.0, unit, count));
        }
        let margin = 0.04 * (hi - lo).max(0.1);
        let multiples: &[f64] = if hi - lo > 3.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        Some(Scale::logarithmic((lo, hi), margin, multiples, (unit, count)))
    }
}

/// A panel a figure along the first varied number; `None` when there is nothing to draw.
pub fn along(data: &Drawn) -> Option<String> {
    let x = data.varied.first()?;
    let scale = x.scale(7)?;
    let xs = x.on_axis();
    let panels = data.figures.len() as f64;
    let height = TOP + panels * HEIGHT + (panels - 1.0) * GAP + 52.0 + 18.0 * legend_rows(data);
    (panels > 0.0).then(|| {
        picture(LEFT + WIDTH + 30.0, height, |canvas| {
            title(
                canvas,
                16.0,
                &data.case,
                &data.about("a ring a design, its number above it where there is room"),
            );
            for (k, figure) in data.figures.iter().enumerate() {
                let place = Place::new(LEFT, TOP + k as f64 * (HEIGHT + GAP), WIDTH, HEIGHT);
                let Some(y) = figure.scale(5) else { continue };
                let panel = Panel::new(place, scale.clone(), y);
                panel.grid(canvas);
                let points: Vec<(f64, f64)> = xs.iter().copied().zip(figure.on_axis()).collect();
                for (curve, _) in data.curves.iter().enumerate() {
                    let colour = PALETTE[curve % PALETTE.len()];
                    let mut own: Vec<_> = data
                        .curve
                        .iter()
                        .zip(&points)
                        .zip(&data.designs)
                        .filter(|((c, _), _)| **c == curve)
                        .map(|((_, p), number)| (*p, *number))
                        .collect();
                    if data.joined {
                        own.sort_by(|a, b| a.0.0.total_cmp(&b.0.0));
                        for piece in own.chunk_by(|a, b| !data.parted(&figure.name, [a.1, b.1])) {
                            let points = piece.iter().map(|(point, _)| *point);
                            panel.curve(canvas, points, Stroke::solid(colour, 1.2));
                        }
                    }
                }
                let mut numbers = LabelRoom::new(ROOM);
                for (n, ((point, curve), number)) in points.iter().zip(&data.curve).zip(&data.designs).enumerate() {
                    if !(point.0.is_finite() && point.1.is_finite()) {
                        continue;
                    }
                    let at = panel.at(*point);
                    let stroke = Stroke::solid(PALETTE[curve % PALETTE.len()], 1.3);
                    data.thing(canvas, n, slice::from_ref(figure), |canvas| {
                        canvas.ring(at, 3.0, stroke)
                    });
                    if k == 0 && numbers.claim(at) {
                        let words = Words::new(9.0, Anchor::Centre).coloured(FAINT_INK);
                        canvas.text((at.0, at.1 - 9.0), &number.to_string(), words);
                    }
                }
                let last = k + 1 == data.figures.len();
                panel.axes(canvas, last.then_some(x.label.as_str()), "");
                name(canvas, place, &figure.label);
            }
            legend(canvas, data, height);
        })
    })
}

/// What a panel is of, above it: names of figures are too long to stand beside an axis.
fn name(canvas: &mut Canvas, place: Place, text: &str) {
    let words = Words::new(11.5, Anchor::Left);
    canvas.text((place.left, place.top - 11.0), text, words);
}

fn legend_rows(data: &Drawn) -> f64 {
    if data.curves.len() > 1 {
        data.curves.len().min(TOLD + 1) as f64
    } else {
        0.0
    }
}

fn legend(canvas: &mut Canvas, data: &Drawn, height: f64) {
    let rows = legend_rows(data);
    for k in 0..rows as usize {
        let y = height - 18.0 * (rows - k as f64) + 4.0;
        let text = match data.curves.get(k) {
            Some(text) if k < TOLD => text.clone(),
            _ => format!("and {} more", data.curves.len() - TOLD),
        };
        if k < TOLD {
            let colour = PALETTE[k % PALETTE.len()];
            canvas.line(&[(LEFT, y), (LEFT + 22.0, y)], Stroke::solid(colour, 1.8));
        }
        canvas.text((LEFT + 30.0, y), &text, Words::new(11.0, Anchor::Left));
    }
}

#[cfg(test)]
mod tests {
    use super::map::{around, edges};
    use super::*;

    /// Goal: a picture says how many designs it leaves out; without a figure that differs there is none.
    #[test]
    fn pictures_say_what_they_leave_out() {
        let numbers = |name: &str, values: [f64; 2]| Numbers {
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
        // so many would be more than a page takes
        let many = Drawn {
            designs: (0..=SAID).collect(),
            varied: data
                .varied
                .iter()
                .map(|one| Numbers {
                    values: vec![1.0; SAID + 1],
                    ..one.clone()
                })
                .collect(),
            figures: data
                .figures
                .iter()
                .map(|one| Numbers {
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
