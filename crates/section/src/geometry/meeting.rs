//! Intersections, distances and overlaps of outlines.

use super::outline::{Outline, distance, inside};
use crate::input::Point;

/// First two sides of a polygon that intersect or touch, other than adjacent sides at their corner.
pub(super) fn crossing(points: &[Point]) -> Option<(usize, usize)> {
    let n = points.len();
    let side = |i: usize| (points[i], points[(i + 1) % n]);
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    pairs.into_iter().find(|&(i, j)| {
        let ((a, b), (c, d)) = (side(i), side(j));
        if a == b || c == d {
            return true;
        }
        let neighbours = j == i + 1 || (i == 0 && j == n - 1);
        if neighbours {
            // Adjacent sides share a corner; they are at fault if one folds back onto the other.
            let (shared, p, q) = if j == i + 1 { (b, a, d) } else { (a, b, c) };
            let (u, v) = (
                [p[0] - shared[0], p[1] - shared[1]],
                [q[0] - shared[0], q[1] - shared[1]],
            );
            let (cross, along) = (u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
            return along > 0.0 && cross.abs() < 1e-9 * along;
        }
        cross(a, b, c, d)
            || [
                distance(a, c, d),
                distance(b, c, d),
                distance(c, a, b),
                distance(d, a, b),
            ]
            .contains(&0.0)
    })
}

/// True if two segments cross in their interiors.
pub(super) fn cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    let turn = |p: Point, q: Point, r: Point| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
}

pub(super) fn sides(points: &[Point]) -> impl Iterator<Item = (Point, Point)> + Clone {
    points.iter().copied().zip(points.iter().copied().cycle().skip(1))
}

/// Distance between the lines of two outlines; 0 if they cross.
pub(super) fn meeting_lines(a: &Outline, b: &Outline) -> f64 {
    let (a, b) = (a.chords(), b.chords());
    let mut least = f64::MAX;
    for (p, q) in sides(&a) {
        for (r, s) in sides(&b) {
            if cross(p, q, r, s) {
                return 0.0;
            }
            least = least
                .min(distance(p, r, s))
                .min(distance(q, r, s))
                .min(distance(r, p, q))
                .min(distance(s, p, q));
        }
    }
    least
}

/// Distance between two outlines; 0 if they cross or one contains the other.
pub(super) fn meeting(a: &Outline, b: &Outline) -> f64 {
    let (pa, pb) = (a.chords(), b.chords());
    if inside(&pa, pb[0]) || inside(&pb, pa[0]) {
        0.0
    } else {
        meeting_lines(a, b)
    }
}

/// True if two regions share more than a border.
pub(super) fn overlap(a: &Outline, b: &Outline, slack: f64) -> bool {
    let (pa, pb) = (a.chords(), b.chords());
    let deep = |p: Point, of: &[Point]| inside(of, p) && sides(of).all(|(q, r)| distance(p, q, r) > slack);
    let probes = |points: &[Point]| -> Vec<Point> {
        let middles = sides(points).map(|(p, q)| [(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0]);
        points.iter().copied().chain(middles).chain([within(points)]).collect()
    };
    let crossed = sides(&pa).any(|(p, q)| {
        sides(&pb).any(|(r, s)| {
            let near = [
                distance(p, r, s),
                distance(q, r, s),
                distance(r, p, q),
                distance(s, p, q),
            ]
            .into_iter()
            .fold(f64::MAX, f64::min);
            cross(p, q, r, s) && near > slack
        })
    });
    crossed || probes(&pa).into_iter().any(|p| deep(p, &pb)) || probes(&pb).into_iter().any(|p| deep(p, &pa))
}

/// A point inside a polygon: the middle of an interior stretch of a horizontal line between two distinct corner
/// heights.
pub(super) fn within(points: &[Point]) -> Point {
    let mut heights: Vec<f64> = points.iter().map(|p| p[1]).collect();
    heights.sort_by(f64::total_cmp);
    // No corner is on a line between two distinct heights.
    let gap = heights
        .windows(2)
        .max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    let x = gap.map_or(0.0, |g| (g[0] + g[1]) / 2.0);
    let hits = sides(points).filter(|(a, b)| (a[1] > x) != (b[1] > x));
    let mut at: Vec<f64> = hits
        .map(|(a, b)| a[0] + (x - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
        .collect();
    at.sort_by(f64::total_cmp);
    [at.chunks_exact(2).map(|c| (c[0] + c[1]) / 2.0).next().unwrap_or(0.0), x]
}
