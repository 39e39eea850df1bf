//! Picture of a comparison of two recordings.

use super::plot::canvas::LineStyle;
use super::plot::colour::PALETTE;
use super::plot::picture::{Panel, Picture, PictureAxis, PictureSeries};
use crate::discrete::quantities::{Observable, QuantityRole};
use crate::study::compare::interpolate::cubic;
use crate::study::compare::{Comparison, Recording};

/// A history is thinned to fewer than twice this number of rows.
const ROWS: usize = 1500;

/// SVG of the picture; `None` if the recordings share no headline quantity.
pub fn picture(a: &Recording, b: &Recording, comparison: &Comparison) -> Option<String> {
    let headlines = Observable::ALL
        .iter()
        .filter(|one| one.role() == QuantityRole::Headline);
    let shared = headlines.filter(|one| comparison.histories.iter().any(|d| d.name == one.name()));
    let panels = shared.filter_map(|one| pair(a, b, one.name())).flatten();
    let about = "below each quantity the first less the second";
    Picture::stacked("two runs over each other".into(), about, panels).svg()
}

/// Panels of one quantity: both curves, and their difference.
fn pair(a: &Recording, b: &Recording, name: &str) -> Option<[Panel; 2]> {
    let (of_a, of_b) = (a.column(name)?, b.column(name)?);
    let x = PictureAxis::new("time t", "s", 10).between(
        a.times.first()?.min(*b.times.first()?),
        a.times.last()?.max(*b.times.last()?),
    );
    let curve = |points: Vec<(f64, f64)>, colour: usize, width: f64| {
        let every = (points.len() / ROWS).max(1);
        PictureSeries::line(
            points.into_iter().step_by(every),
            LineStyle::solid(PALETTE[colour], width),
        )
    };
    let points = |times: &[f64], values: &[f64]| times.iter().copied().zip(values.iter().copied()).collect();
    let (first, last) = (b.times.first()?, b.times.last()?);
    let between = a
        .times
        .iter()
        .zip(&of_a.values)
        .filter(|(t, _)| (first..=last).contains(t));
    let difference = between.map(|(&t, x)| (t, x - cubic(&b.times, t).mean(|k| of_b.values[k])));
    let both = vec![
        curve(points(&a.times, &of_a.values), 0, 2.2).named(&*a.label),
        curve(points(&b.times, &of_b.values), 1, 1.1).named(&*b.label),
    ];
    let y = |name: &str, ticks: usize| PictureAxis::new(name, &*of_a.unit, ticks);
    let less = vec![curve(difference.collect(), 9, 1.0)];
    Some([
        Panel::new((650.0, 120.0), x.clone(), y(name, 4), both),
        Panel::new((650.0, 62.0), x, y("less", 3), less),
    ])
}
