//! `energy.svg`: stored energies, works and losses over time, and the residual of the energy balance.

use super::canvas::LineStyle;
use super::colour::PALETTE;
use super::picture::{Panel, Picture, PictureAxis, PictureSeries};
use super::{PlottedCurve, error_bands, times_of};
use crate::discrete::quantities::{Group, Observable};

/// Smallest half range of the axis [J].
const FLOOR: f64 = 1e-15;
/// Fraction of the largest entry below which an entry is not drawn.
const NEGLIGIBLE: f64 = 1e-3;

/// True if a quantity belongs in this picture.
pub fn belongs(one: Observable) -> bool {
    one.unit() == "J"
}

fn is_in(curve: &PlottedCurve, group: Group) -> bool {
    curve.observable().is_some_and(|one| one.group() == group)
}

/// Draws entries of the ledger [J], stored energies, cumulative works, losses and the residual; `None` if there is nothing to draw.
pub fn draw(case: &str, curves: &[PlottedCurve]) -> Option<String> {
    let (residuals, all): (Vec<_>, Vec<_>) = curves
        .iter()
        .filter(|curve| !curve.points.is_empty())
        .partition(|curve| is_in(curve, Group::Open));
    let largest = all.iter().map(|curve| curve.max_abs()).fold(0.0, f64::max);
    let counts = |curve: &&PlottedCurve| largest == 0.0 || curve.max_abs() > NEGLIGIBLE * largest;
    let lines: Vec<_> = all.into_iter().filter(counts).collect();
    let x = times_of(lines.iter().copied())?;
    let colour = |k: usize| PALETTE[k % PALETTE.len()];
    let entry = |(k, curve): (usize, &&PlottedCurve)| {
        let stroke = LineStyle {
            dash: (!is_in(curve, Group::Stored)).then_some((6.0, 3.5)),
            ..LineStyle::solid(colour(k), 1.5)
        };
        let label = curve.observable().map_or(curve.name.as_str(), |one| one.label());
        PictureSeries::line(curve.points.iter().copied(), stroke).named(label)
    };
    let panel = |height: f64, y: PictureAxis, series: Vec<PictureSeries>| Panel {
        legend_beside: true,
        ..Panel::new((600.0, height), x.clone(), y, series)
    };
    let y = PictureAxis::new("energy", "J", 7).above(FLOOR);
    let mut series = error_bands(lines.iter().enumerate().map(|(k, curve)| (*curve, colour(k))), FLOOR);
    series.extend(lines.iter().enumerate().map(entry));
    let energies = panel(300.0, y, series);
    let residual = residuals.first().map(|curve| {
        let over = if largest > 0.0 { largest } else { 1.0 };
        let points = curve.points.iter().map(|p| (p.0, p.1 / over));
        let line = PictureSeries::line(points, LineStyle::solid(PALETTE[9], 1.2));
        let y = PictureAxis::new("residual", "1", 4).above(1e-16);
        panel(
            100.0,
            y,
            vec![line.named("what does not close,\nover the largest energy")],
        )
    });
    Picture::stacked(
        format!("{case} · energy"),
        "stored energies (solid), cumulative works and losses (dashed)",
        [energies].into_iter().chain(residual),
    )
    .with_bands_named()
    .svg()
}
