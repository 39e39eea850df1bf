//! Pictures of many designs: curves along one number, a map over two, all numbers beside each other.

use super::canvas::{Anchor, Canvas, FAINT_INK, Stroke, Words, picture};
use super::colour::{Colour, PALETTE, of_time};
use super::extent;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;
use crate::output::numbers::{count, quantity};
use crate::study::sweep::exchanged::Exchange;

/// One number of every design.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbers {
    /// What it is.
    pub name: String,
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
    /// Designs that there are; the first of them are drawn.
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

    /// What stands below the title.
    fn about(&self, what: &str) -> String {
        match self.designs.len() {
            all if all == self.of => what.into(),
            some => format!("{what}; the first {} of {}", count(some as u64), count(self.of as u64)),
        }
    }
}

const LEFT: f64 = 100.0;
const TOP: f64 = 78.0;
const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 170.0;
const GAP: f64 = 36.0;
/// Side of a map, and what lies between two.
const SIDE: f64 = 320.0;
const BETWEEN: f64 = 74.0;
/// Half the side of a cell where designs are no grid.
const DOT: f64 = 4.0;
/// Designs whose numbers stand beside their rings at most.
const NUMBERED: usize = 40;
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
        Some(Scale::logarithmic((lo, hi), margin, multiples, count))
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
                &data.about("a ring a design, its number beside it"),
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
                for ((point, curve), number) in points.iter().zip(&data.curve).zip(&data.designs) {
                    if !(point.0.is_finite() && point.1.is_finite()) {
                        continue;
                    }
                    let at = panel.at(*point);
                    canvas.ring(at, 3.0, Stroke::solid(PALETTE[curve % PALETTE.len()], 1.3));
                    if k == 0 && points.len() <= NUMBERED {
                        let words = Words::new(9.0, Anchor::Centre).coloured(FAINT_INK);
                        canvas.text((at.0, at.1 - 9.0), &number.to_string(), words);
                    }
                }
                let last = k + 1 == data.figures.len();
                panel.axes(canvas, last.then_some(x.name.as_str()), "");
                name(canvas, place, &figure.name);
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

/// Every figure over the first two varied numbers, as colours; `None` when there is nothing to draw.
pub fn over_two(data: &Drawn) -> Option<String> {
    let [x, y, ..] = &data.varied[..] else { return None };
    let (mut across, mut up) = (x.scale(7)?, y.scale(7)?);
    let (columns, lines) = (x.places(), y.places());
    // cells touch where the designs are a grid, and are small where they are not
    let grid = (columns.len() * lines.len()) as f64 <= 1.5 * data.designs.len() as f64;
    for (scale, places) in [(&mut across, &columns), (&mut up, &lines)] {
        let (lo, hi) = (*places.first()?, *places.last()?);
        let margin = 0.04 * if hi > lo { hi - lo } else { 1.0 };
        (scale.lo, scale.hi) = match &edges(places)[..] {
            [first, .., last] if grid => (*first, *last),
            _ => (lo - margin, hi + margin),
        };
        let range = scale.lo..=scale.hi;
        scale.ticks.retain(|(at, _)| range.contains(at));
    }
    let rows = data.figures.len() as f64;
    (rows > 0.0).then(|| {
        picture(LEFT + SIDE + 150.0, TOP + rows * (SIDE + BETWEEN), |canvas| {
            title(canvas, 16.0, &data.case, &data.about("a cell a design"));
            for (k, figure) in data.figures.iter().enumerate() {
                let Some((low, high)) = extent(figure.values.iter().copied()) else {
                    continue;
                };
                let place = Place::new(LEFT, TOP + k as f64 * (SIDE + BETWEEN), SIDE, SIDE);
                let panel = Panel::new(place, across.clone(), up.clone());
                for ((a, b), value) in x.on_axis().into_iter().zip(y.on_axis()).zip(&figure.values) {
                    if !(a.is_finite() && b.is_finite() && value.is_finite()) {
                        continue;
                    }
                    let (left, right) = around(&columns, a);
                    let (low_edge, high_edge) = around(&lines, b);
                    let at = panel.at((a, b));
                    let (from, to) = match grid {
                        true => (panel.at((left, high_edge)), panel.at((right, low_edge))),
                        false => ((at.0 - DOT, at.1 - DOT), (at.0 + DOT, at.1 + DOT)),
                    };
                    // a little more, so that no hairline shows between cells
                    let most = if grid { 0.0 } else { DOT };
                    let to = (
                        (to.0 + 0.4).min(place.right() + most),
                        (to.1 + 0.4).min(place.bottom() + most),
                    );
                    canvas.rectangle(from, to, shade(*value, low, high));
                }
                panel.axes(canvas, Some(&x.name), &y.name);
                name(canvas, place, &figure.name);
                bar(canvas, place, figure, low, high);
            }
        })
    })
}

/// Between places in their order: half way to the neighbours, and as far beyond the first and the last.
fn edges(places: &[f64]) -> Vec<f64> {
    let [first, .., last] = places else {
        return places.iter().flat_map(|at| [at - 0.5, at + 0.5]).collect();
    };
    let within: Vec<f64> = places.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let ends = within.first().zip(within.last());
    let (before, after) = ends.map_or((*first, *last), |(a, b)| (2.0 * first - a, 2.0 * last - b));
    [before].into_iter().chain(within).chain([after]).collect()
}

/// The edges on both sides of a place.
fn around(places: &[f64], at: f64) -> (f64, f64) {
    let edges = edges(places);
    let k = places
        .partition_point(|place| *place < at)
        .min(places.len().saturating_sub(1));
    (edges[k], edges[k + 1])
}

fn shade(value: f64, low: f64, high: f64) -> Colour {
    of_time(if high > low { (value - low) / (high - low) } else { 0.5 })
}

fn bar(canvas: &mut Canvas, beside: Place, figure: &Numbers, low: f64, high: f64) {
    const PIECES: usize = 64;
    let (left, height) = (beside.right() + 24.0, beside.height / PIECES as f64);
    for k in 0..PIECES {
        let bottom = beside.bottom() - k as f64 * height;
        let share = (k as f64 + 0.5) / PIECES as f64;
        canvas.rectangle((left, bottom - height - 0.4), (left + 14.0, bottom), of_time(share));
    }
    for share in [0.0, 0.5, 1.0] {
        let at = (left + 20.0, beside.bottom() - beside.height * share);
        let value = quantity(low + share * (high - low), &figure.unit, 3);
        canvas.text(at, &value, Words::new(11.0, Anchor::Left));
    }
}

/// A line a design through all numbers, coloured by the last of them; `None` when there is nothing to draw.
pub fn beside(data: &Drawn) -> Option<String> {
    let all: Vec<&Numbers> = data.varied.iter().chain(&data.figures).collect();
    let last = data.figures.last()?;
    let (low, high) = extent(last.values.iter().copied())?;
    let ranges: Vec<(f64, f64)> = all
        .iter()
        .map(|one| extent(one.on_axis().into_iter()).unwrap_or((0.0, 1.0)))
        .collect();
    const STEP: f64 = 120.0;
    const LENGTH: f64 = 300.0;
    let width = 140.0 + STEP * (all.len() - 1) as f64;
    Some(picture(width, TOP + LENGTH + 90.0, |canvas| {
        title(
            canvas,
            16.0,
            &data.case,
            &data.about("a line a design, from what is varied to what came out"),
        );
        let at = |k: usize, value: f64| {
            let (lo, hi) = ranges[k];
            let share = if hi > lo { (value - lo) / (hi - lo) } else { 0.5 };
            (70.0 + STEP * k as f64, TOP + LENGTH * (1.0 - share) + 14.0)
        };
        for (n, value) in last.values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            let points: Vec<_> = all
                .iter()
                .enumerate()
                .map(|(k, one)| at(k, one.shown(one.values[n])))
                .collect();
            canvas.line(&points, Stroke::solid(shade(*value, low, high), 1.0));
        }
        for (k, one) in all.iter().enumerate() {
            let (lo, hi) = ranges[k];
            let raised = |x: f64| if one.logarithmic { 10_f64.powf(x) } else { x };
            let ends = [at(k, lo.min(hi)), at(k, hi.max(lo))];
            let (bottom, top) = if hi > lo {
                (ends[0].1, ends[1].1)
            } else {
                (TOP + LENGTH + 14.0, TOP + 14.0)
            };
            canvas.line(&[(ends[0].0, bottom), (ends[0].0, top)], Stroke::solid(FAINT_INK, 1.0));
            let unit = if one.unit.is_empty() { "1" } else { &one.unit };
            let small = Words::new(10.0, Anchor::Centre);
            canvas.text((ends[0].0, top - 9.0), &quantity(raised(hi), unit, 3), small);
            canvas.text((ends[0].0, bottom + 11.0), &quantity(raised(lo), unit, 3), small);
            let short: String = one
                .name
                .rsplit('/')
                .next()
                .unwrap_or(&one.name)
                .chars()
                .take(28)
                .collect();
            let lower = if k.is_multiple_of(2) { 30.0 } else { 46.0 };
            canvas.text((ends[0].0, bottom + lower), &short, small.coloured(FAINT_INK));
        }
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: a picture says how many designs it leaves out; without a figure that differs there is none.
    #[test]
    fn pictures_say_what_they_leave_out() {
        let numbers = |name: &str, values: [f64; 2]| Numbers {
            name: name.into(),
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
        for picture in [along(&data), over_two(&data), beside(&data)] {
            let picture = picture.expect("a picture");
            assert!(
                picture.contains("the first 2 of 5") && !picture.contains("NaN"),
                "{picture}"
            );
        }
        assert_eq!(edges(&[11.0, 12.3, 14.0]), [10.35, 11.65, 13.15, 14.85]);
        assert_eq!(around(&[0.0, 1.0, 3.0], 1.0), (0.5, 2.0));
        data.of = 2;
        assert!(!along(&data).expect("a picture").contains("of 2"));
        data.figures.clear();
        assert_eq!((along(&data), over_two(&data), beside(&data)), (None, None, None));
    }
}
