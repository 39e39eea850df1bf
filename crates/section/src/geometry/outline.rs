//! Closed counter-clockwise outlines, with queries for checks and mesher.

use super::curve::Curve;
use crate::input::{Bladder, Point, RegionShape, Shape};
use std::f64::consts::{FRAC_PI_2, PI};

/// A closed chain of curves, counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Curves in order; each begins at the end of the previous one.
    pub curves: Vec<Curve>,
}

impl Outline {
    /// Polygon through these corners, oriented counter-clockwise.
    pub fn polygon(points: &[Point]) -> Self {
        let mut points = points.to_vec();
        if signed_area(&points) < 0.0 {
            points.reverse();
        }
        let next = points.iter().cycle().skip(1);
        Self {
            curves: points
                .iter()
                .zip(next)
                .map(|(&from, &to)| Curve::Line { from, to })
                .collect(),
        }
    }

    /// A rectangle between two corners.
    pub fn rectangle(along: [f64; 2], high: [f64; 2]) -> Self {
        Self::polygon(&[
            [along[0], high[0]],
            [along[1], high[0]],
            [along[1], high[1]],
            [along[0], high[1]],
        ])
    }

    /// An ellipse about a center, in four quarters.
    pub fn ellipse(center: Point, radii: [f64; 2]) -> Self {
        let quarter = |k: usize| Curve::Arc {
            center,
            radii,
            from: k as f64 * FRAC_PI_2,
            to: (k + 1) as f64 * FRAC_PI_2,
        };
        Self {
            curves: (0..4).map(quarter).collect(),
        }
    }

    /// A shape with its origin at `origin`.
    pub fn shape(shape: &Shape, origin: Point) -> Self {
        let [z, x] = origin;
        match shape {
            Shape::Circle { radius_m: r } => Self::ellipse(origin, [*r, *r]),
            Shape::Ellipse { along_m, high_m } => Self::ellipse(origin, [along_m / 2.0, high_m / 2.0]),
            Shape::RoundedRectangle {
                along_m,
                high_m,
                fillet_m,
            } => rounded(origin, along_m / 2.0, high_m / 2.0, *fillet_m),
            Shape::Polygon { points_m } => {
                Self::polygon(&points_m.iter().map(|p| [z + p[0], x + p[1]]).collect::<Vec<_>>())
            }
        }
    }

    /// Outline of a bladder in its cell.
    pub fn bladder(bladder: &Bladder) -> Self {
        Self::shape(&bladder.shape, [0.0, bladder.center_m])
    }

    /// Outline of a region in a cell of the given pitch.
    pub fn region(shape: &RegionShape, pitch: f64) -> Self {
        match shape {
            RegionShape::Layer { high_m } => Self::rectangle([-pitch / 2.0, pitch / 2.0], *high_m),
            RegionShape::Rectangle { along_m, high_m } => Self::rectangle(*along_m, *high_m),
            RegionShape::Circle { center_m, radius_m } => Self::ellipse(*center_m, [*radius_m; 2]),
            RegionShape::Polygon { points_m } => Self::polygon(points_m),
        }
    }

    /// Mirror image about the mid-plane, oriented counter-clockwise.
    pub fn mirrored(&self) -> Self {
        let back = |c: &Curve| match c.mirrored() {
            Curve::Line { from, to } => Curve::Line { from: to, to: from },
            Curve::Arc {
                center,
                radii,
                from,
                to,
            } => Curve::Arc {
                center,
                radii,
                from: to,
                to: from,
            },
        };
        Self {
            curves: self.curves.iter().rev().map(back).collect(),
        }
    }

    /// Corners of an inscribed polygon, accurate enough for inside-outside tests.
    pub fn chords(&self) -> Vec<Point> {
        let points = |c: &Curve| {
            let (c, n) = (*c, c.chords());
            (0..n).map(move |k| c.at(k as f64 / n as f64))
        };
        self.curves.iter().flat_map(points).collect()
    }

    /// Corners with the turning angle of the outline [rad], positive to the left; omits smooth joints.
    pub fn corners(&self) -> Vec<(Point, f64)> {
        let n = self.curves.len();
        let turn = |k: usize| {
            let (a, b) = (self.curves[(k + n - 1) % n].slope(1.0), self.curves[k].slope(0.0));
            (
                self.curves[k].at(0.0),
                (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]),
            )
        };
        (0..n).map(turn).filter(|(_, angle)| angle.abs() > 0.05 * PI).collect()
    }
}

/// Part of a half side below which the straight rest between two fillets is too short for a mesh: both fillets then meet.
const STRAIGHT: f64 = 0.01;

fn rounded(origin: Point, a: f64, b: f64, fillet: f64) -> Outline {
    let [z, x] = origin;
    if fillet == 0.0 {
        return Outline::rectangle([z - a, z + a], [x - b, x + b]);
    }
    let radii = [a, b].map(|half| if half - fillet < STRAIGHT * half { half } else { fillet });
    let mut curves = Vec::with_capacity(8);
    let signs = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    for (k, [sz, sx]) in signs.into_iter().enumerate() {
        let center = [z + sz * (a - radii[0]), x + sx * (b - radii[1])];
        let from = k as f64 * FRAC_PI_2;
        curves.push(Curve::Arc {
            center,
            radii,
            from,
            to: from + FRAC_PI_2,
        });
    }
    let arcs = curves.clone();
    let longest = a.max(b);
    let mut all = Vec::with_capacity(8);
    for (k, arc) in arcs.iter().enumerate() {
        all.push(*arc);
        let (from, to) = (arc.at(1.0), arcs[(k + 1) % 4].at(0.0));
        if (from[0] - to[0]).hypot(from[1] - to[1]) > 1e-9 * longest {
            all.push(Curve::Line { from, to });
        }
    }
    Outline { curves: all }
}

/// Area of a polygon, positive if counter-clockwise.
pub fn signed_area(points: &[Point]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points
        .iter()
        .zip(next)
        .map(|(a, b)| (a[0] * b[1] - a[1] * b[0]) / 2.0)
        .sum()
}

/// True if a point is inside a polygon.
pub fn inside(polygon: &[Point], p: Point) -> bool {
    let next = polygon.iter().cycle().skip(1);
    let crosses = |(a, b): (&Point, &Point)| {
        (a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    };
    polygon.iter().zip(next).filter(|&pair| crosses(pair)).count() % 2 == 1
}

/// Distance between a point and a segment.
pub fn distance(p: Point, a: Point, b: Point) -> f64 {
    let d = [b[0] - a[0], b[1] - a[1]];
    let t = ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
    let t = t.clamp(0.0, 1.0);
    (p[0] - a[0] - t * d[0]).hypot(p[1] - a[1] - t * d[1])
}
