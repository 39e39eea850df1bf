//! One cell of a section, deformed by one of its loads, drawn over the undeformed cell.

use slcbeam_section::picture::Picture;

use super::canvas::{FAINT_INK, INK, LineStyle};
use super::colour::{Colour, PALETTE};
use super::picture::{self, Panel, PictureAxis, PictureSeries};

/// Height of the cell [pt].
const HEIGHT: f64 = 200.0;
/// Largest displacement drawn, relative to the height of the cell. It also sets the margin.
const SHOWN: f64 = 0.12;
/// Sides of triangles.
const SIDES: LineStyle = LineStyle {
    colour: Colour(0xff, 0xff, 0xff),
    width: 0.3,
    dash: None,
};

/// Draws the cell under a unit load with this index, and returns the magnification of the displacements with the picture; `None` if the
/// load does not move the cell.
pub fn draw(cell: &Picture, load: usize) -> Option<(f64, String)> {
    let displacements = cell.displacements_m.get(load)?;
    let [along, high] = [0, 1].map(|k| cell.nodes_m.iter().map(|p| p[k].abs()).fold(0.0, f64::max));
    let largest = displacements.iter().map(|u| u[0].hypot(u[1])).fold(0.0, f64::max);
    let factor = round(SHOWN * 2.0 * high / largest)?;
    let at = |k: usize, factor: f64| {
        let (p, u) = (cell.nodes_m[k], displacements[k]);
        (p[0] + factor * u[0], p[1] + factor * u[1])
    };
    let mut series = vec![];
    for (triangle, material) in cell.triangles.iter().zip(&cell.materials) {
        let [a, b, c, ab, bc, ca] = triangle.map(|k| at(k, factor));
        let sides = [a, ab, b, bc, c, ca, a];
        series.push(PictureSeries::area(sides, fill(*material)));
        series.push(PictureSeries::line(sides, SIDES));
    }
    for (factor, stroke) in [
        (0.0, LineStyle::solid(FAINT_INK, 0.5)),
        (factor, LineStyle::solid(INK, 1.2)),
    ] {
        let edges = cell.outline.iter().map(|edge| edge.map(|k| at(k, factor)));
        series.extend(edges.map(|edge| PictureSeries::line(edge, stroke)));
    }
    let margin = 2.4 * SHOWN * high;
    let [x, y] = [along + margin, high + margin].map(|half| PictureAxis::default().between(-half, half));
    let scale = HEIGHT / (2.0 * high);
    let size = (2.0 * scale * (along + margin), 2.0 * scale * (high + margin));
    let panel = Panel {
        bare: true,
        ..Panel::new(size, x, y, series)
    };
    Some((factor, picture::Picture::stacked(String::new(), "", [panel]).svg()?))
}

/// Light color of a material.
fn fill(material: usize) -> Colour {
    let Colour(r, g, b) = PALETTE[(5 + material) % PALETTE.len()];
    let light = |x: u8| 255 - (255 - x) / 2;
    Colour(light(r), light(g), light(b))
}

/// Rounds down to 1, 2 or 5 times a power of ten.
fn round(x: f64) -> Option<f64> {
    let power = 10_f64.powf(x.log10().floor());
    let most = [5.0, 2.0, 1.0].into_iter().find(|m| m * power <= x * (1.0 + 1e-9));
    most.map(|m| m * power).filter(|x| x.is_finite() && *x > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_round() {
        assert_eq!(
            [0.34, 1.0, 4.9, 5.0, 7.1e6].map(round),
            [0.2, 1.0, 2.0, 5.0, 5e6].map(Some)
        );
        assert_eq!([0.0, f64::INFINITY, f64::NAN].map(round), [None; 3]);
    }
}
