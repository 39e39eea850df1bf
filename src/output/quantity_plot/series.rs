//! Curves of a panel as lines, symbols and error bands.

use super::{NamedCurve, QuantityPanel};
use crate::output::plot::extent;
use crate::output::plot::picture::{Glyph, PictureSeries};
use crate::output::plot::style::PictureStyle;

/// Part of the range of the curves below which an error band is narrower than its line.
const HIDDEN: f64 = 3e-3;
/// Symbol of a value without neighbors.
const ISOLATED: Glyph = Glyph::Ring(2.0, 1.2);

/// Bands, then curves or points.
pub(super) fn series(one: &QuantityPanel, style: &PictureStyle) -> Vec<PictureSeries> {
    let line = |k: usize| style.curve(k);
    let mut all: Vec<PictureSeries> = vec![];
    for (k, curve) in one.curves.iter().enumerate() {
        if is_seen(one, curve) {
            let pieces = pieces_of_band(one, curve).into_iter();
            all.extend(pieces.map(|piece| PictureSeries::shade(&piece, line(k).colour)));
        }
    }
    let several = one.curves.len() > 1;
    for (k, curve) in one.curves.iter().enumerate() {
        let points: Vec<_> = curve.points.iter().map(|p| shown(one, *p)).collect();
        let name = if several || !curve.label.is_empty() {
            curve.label.as_str()
        } else {
            ""
        };
        if one.marks {
            all.push(PictureSeries::marks(points, glyph(k, several), line(k).colour).named(name));
            continue;
        }
        let alone = isolated(&points);
        let lonely = alone.len() == points.iter().filter(|p| is_finite(p)).count();
        if !lonely {
            all.push(PictureSeries::line(points, line(k)).named(name));
        }
        if !alone.is_empty() {
            let marks = PictureSeries::marks(alone, ISOLATED, line(k).colour);
            all.push(if lonely { marks.named(name) } else { marks });
        }
    }
    all
}

fn is_finite(p: &(f64, f64)) -> bool {
    p.0.is_finite() && p.1.is_finite()
}

/// A point, or a break of the curve if an axis cannot show it.
fn shown(one: &QuantityPanel, (x, y): (f64, f64)) -> (f64, f64) {
    let [x_log, y_log] = one.logarithmic;
    match (!x_log || x > 0.0) && (!y_log || y > 0.0) {
        true => (x, y),
        false => (f64::NAN, f64::NAN),
    }
}

/// Points without neighbors, which no line shows.
fn isolated(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let pieces = points.split(|p| !is_finite(p));
    let alone = pieces.filter_map(|piece| {
        let first = piece.first()?;
        piece.iter().all(|p| p == first).then_some(piece)
    });
    alone.flatten().copied().collect()
}

/// True if the error band of a curve is wider than its line.
fn is_seen(one: &QuantityPanel, curve: &NamedCurve) -> bool {
    let logarithmic = one.logarithmic[1];
    let place = |y: f64| if logarithmic { y.log10() } else { y };
    let values = one
        .curves
        .iter()
        .flat_map(|curve| curve.points.iter().map(|p| place(p.1)));
    let (low, high) = extent(values).unwrap_or_default();
    let wide = |a: f64, b: f64| place(b) - place(a) > 2.0 * HIDDEN * (high - low);
    curve.band.iter().any(|(_, a, b)| match logarithmic {
        true => *b > 0.0 && (*a <= 0.0 || wide(*a, *b)),
        false => wide(*a, *b),
    })
}

/// Parts of an error band without missing values. On a logarithmic axis a limit below zero is zero, which is below the axis.
fn pieces_of_band(one: &QuantityPanel, curve: &NamedCurve) -> Vec<Vec<(f64, f64, f64)>> {
    let logarithmic = one.logarithmic[1];
    let there = |p: &(f64, f64, f64)| is_finite(&shown(one, (p.0, p.2))) && p.1.is_finite();
    let pieces = curve.band.split(|p| !there(p)).filter(|piece| piece.len() > 1);
    let cut = |p: &(f64, f64, f64)| (p.0, if logarithmic { p.1.max(0.0) } else { p.1 }, p.2);
    pieces.map(|piece| piece.iter().map(cut).collect()).collect()
}

/// Symbols of the groups of points.
fn glyph(k: usize, several: bool) -> Glyph {
    const TURN: f64 = -std::f64::consts::FRAC_PI_2;
    match k % 5 {
        _ if !several => Glyph::Ring(2.6, 1.1),
        0 => Glyph::Ring(2.6, 1.1),
        1 => Glyph::Square(2.2),
        2 => Glyph::Polygon(3.4, 3, TURN, true),
        3 => Glyph::Polygon(3.4, 4, TURN, false),
        _ => Glyph::Polygon(3.4, 3, -TURN, false),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::plot::picture::SeriesKind;

    fn panel(points: &[(f64, f64)], band: &[(f64, f64, f64)]) -> QuantityPanel {
        let axis = || ("x".to_string(), "1".to_string());
        let curve = NamedCurve {
            band: band.to_vec(),
            ..NamedCurve::new(String::new(), points.to_vec())
        };
        QuantityPanel {
            logarithmic: [false, true],
            ..QuantityPanel::curves(axis(), axis(), vec![curve])
        }
    }

    /// Goal: a lower limit below zero stays in the band, and a missing value splits band and curve.
    #[test]
    fn bands_reach_the_axis_and_have_gaps() {
        let gap = f64::NAN;
        let values = [1.0, 1e-3, 1.0, gap, 1.0, 2.0, 0.0, 3.0, 4.0];
        let points: Vec<_> = values.iter().enumerate().map(|(k, y)| (k as f64, *y)).collect();
        let band: Vec<_> = points.iter().map(|(x, y)| (*x, y - 2e-3, y + 2e-3)).collect();
        let drawn = series(&panel(&points, &band), &PictureStyle::paper(8.0));
        let shades: Vec<_> = drawn
            .iter()
            .filter_map(|one| match &one.kind {
                SeriesKind::Shade(points, _) => Some(points.len() / 2),
                _ => None,
            })
            .collect();
        assert_eq!(shades[0], 3, "the value with an error above itself is part of its band");
        assert!(drawn[0].points().contains(&(1.0, 0.0)));
        assert_eq!(shades.len(), 2);
    }

    /// Goal: values between gaps are symbols.
    #[test]
    fn isolated_values_are_symbols() {
        let gap = (f64::NAN, f64::NAN);
        let marks = |points: &[(f64, f64)]| {
            let drawn = series(&panel(points, &[]), &PictureStyle::paper(8.0));
            let marks = drawn.iter().filter(|one| matches!(one.kind, SeriesKind::Marks(..)));
            marks.flat_map(|one| one.points().to_vec()).collect::<Vec<_>>()
        };
        assert_eq!(marks(&[(1.0, 2.0)]), [(1.0, 2.0)]);
        assert_eq!(
            marks(&[(0.0, 1.0), (1.0, 1.0), gap, (3.0, 2.0), gap, (5.0, 1.0), (6.0, 1.0)]),
            [(3.0, 2.0)]
        );
        assert!(marks(&[(0.0, 1.0), (1.0, 1.0)]).is_empty());
    }
}
