//! The coarsest mesh: a constrained Delaunay triangulation of the planned vertices by the crate spade, refined by
//! Ruppert's rule. The circumcenter of a triangle that is too large or too flat becomes a vertex. Outlines are not
//! split, since both faces of a period must have equal vertices. Circumcenters inside the diametral circle of an
//! outline edge are skipped instead.

use super::plan::{Domain, Fineness, Sizes, plan};
use super::{Mesh, edge};
use crate::error::Error;
use crate::geometry::outline::inside;
use crate::input::Point;
use spade::{ConstrainedDelaunayTriangulation, InsertionError, Point2, Triangulation};
use std::collections::HashMap;

/// Area over the square of the largest size below which a triangle is degenerate, between vertices of one straight
/// side.
const NOTHING: f64 = 1e-12;

/// Largest circumradius over the mesh size; equilateral triangles of this size have 0.58.
const LARGE: f64 = 0.65;
/// Largest circumradius over the shortest side: 1 for a smallest angle of 30 degrees, 1.15 for 26.
const FLAT: f64 = 1.15;
/// Largest number of refinement rounds; a dozen is usual.
const ROUNDS: usize = 60;

type Triangulated = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// Adds vertices until every triangle has the required size and shape, or its circumcenter is too close to an outline.
/// Coordinates in the triangulation are relative to the largest size.
fn fill(cdt: &mut Triangulated, outlines: &[[Point; 2]], sizes: &Sizes) -> Result<(), InsertionError> {
    let circles: Vec<(Point, f64)> = outlines
        .iter()
        .map(|[a, b]| {
            (
                [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0],
                (a[0] - b[0]).hypot(a[1] - b[1]) / 2.0,
            )
        })
        .collect();
    let (low, high) = outlines
        .iter()
        .flatten()
        .fold(([f64::MAX; 2], [f64::MIN; 2]), |(l, h), p| {
            ([l[0].min(p[0]), l[1].min(p[1])], [h[0].max(p[0]), h[1].max(p[1])])
        });
    for _ in 0..ROUNDS {
        let mut wanted: Vec<(f64, Point)> = Vec::new();
        for face in cdt.inner_faces() {
            let corners = face
                .vertices()
                .map(|v| [v.position().x * sizes.largest, v.position().y * sizes.largest]);
            let Some((center, radius)) = circumcircle(corners) else {
                continue;
            };
            let within = (0..2).all(|k| low[k] < center[k] && center[k] < high[k]);
            let shortest = (0..3)
                .map(|k| apart(corners[k], corners[(k + 1) % 3]))
                .fold(f64::MAX, f64::min);
            if within && (radius > LARGE * sizes.at(center) || radius > FLAT * shortest) {
                wanted.push((radius, center));
            }
        }
        wanted.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut added: Vec<Point> = Vec::new();
        for (radius, center) in wanted {
            let crowded = added.iter().any(|&p| apart(p, center) < radius);
            if crowded || circles.iter().any(|&(middle, r)| apart(middle, center) < r) {
                continue;
            }
            cdt.insert(Point2::new(center[0] / sizes.largest, center[1] / sizes.largest))?;
            added.push(center);
        }
        if added.is_empty() {
            break;
        }
    }
    Ok(())
}

fn apart(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Center and radius of the circle through three points; None if they are collinear.
fn circumcircle([a, b, c]: [Point; 3]) -> Option<(Point, f64)> {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let d = 2.0 * (u[0] * v[1] - u[1] * v[0]);
    let (uu, vv) = (u[0] * u[0] + u[1] * u[1], v[0] * v[0] + v[1] * v[1]);
    let center = [(v[1] * uu - u[1] * vv) / d, (u[0] * vv - v[0] * uu) / d];
    let radius = center[0].hypot(center[1]);
    radius
        .is_finite()
        .then_some(([a[0] + center[0], a[1] + center[1]], radius))
}

impl<T: Copy> Mesh<T> {
    /// Meshes a domain; `part` returns the part at a point, None outside.
    pub fn new(domain: &Domain, fineness: &Fineness, part: &dyn Fn(Point) -> Option<T>) -> Result<Self, Error> {
        let failed = |what: &str| Error::Mesh(what.to_owned());
        let (pieces, sizes) = plan(domain, fineness);
        let largest = sizes.largest;
        let mut points: Vec<Point> = Vec::new();
        let mut edges = Vec::new();
        let mut curves = HashMap::new();
        for piece in &pieces {
            let mut last = None;
            for &t in &piece.at {
                let p = piece.curve.at(t);
                let same = |q: &Point| (p[0] - q[0]).hypot(p[1] - q[1]) < 1e-7 * largest;
                let vertex = points.iter().position(same).unwrap_or_else(|| {
                    points.push(p);
                    points.len() - 1
                });
                if let Some((from, before)) = last {
                    edges.push((from, vertex));
                    let (a, b) = if from < vertex { (before, t) } else { (t, before) };
                    curves.insert(edge(from, vertex), (piece.curve, a, b));
                }
                last = Some((vertex, t));
            }
        }
        let mut cdt = Triangulated::new();
        let mut handles = Vec::with_capacity(points.len());
        for p in &points {
            handles.push(
                cdt.insert(Point2::new(p[0] / largest, p[1] / largest))
                    .map_err(|e| failed(&e.to_string()))?,
            );
        }
        for &(a, b) in &edges {
            if !cdt.can_add_constraint(handles[a], handles[b]) {
                return Err(failed("two outlines cross"));
            }
            cdt.add_constraint(handles[a], handles[b]);
        }
        let edges: Vec<[Point; 2]> = edges.iter().map(|&(a, b)| [points[a], points[b]]).collect();
        fill(&mut cdt, &edges, &sizes).map_err(|e| failed(&e.to_string()))?;
        for vertex in cdt.vertices().skip(points.len()) {
            points.push([vertex.position().x * largest, vertex.position().y * largest]);
        }
        let outer = domain.outlines[0].chords();
        let mut mesh = Self {
            points,
            triangles: Vec::new(),
            parts: Vec::new(),
            curves,
        };
        for face in cdt.inner_faces() {
            let corners = face.vertices().map(|v| v.fix().index());
            let [a, b, c] = corners.map(|k| mesh.points[k]);
            let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
            let centroid = [(a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0];
            if area < NOTHING * largest * largest || !inside(&outer, centroid) {
                continue;
            }
            if let Some(part) = part(centroid) {
                mesh.triangles.push(corners);
                mesh.parts.push(part);
            }
        }
        if mesh.triangles.is_empty() {
            return Err(failed("nothing lies inside the outline"));
        }
        Ok(mesh)
    }

    /// Adds the mirror image below the mid-plane; `other` returns the mirrored part.
    pub fn with_mirror(mut self, other: &dyn Fn(T) -> T) -> Self {
        let scale = self.points.iter().fold(0.0_f64, |m, p| m.max(p[1]));
        let mut image = Vec::with_capacity(self.points.len());
        for k in 0..self.points.len() {
            let p = self.points[k];
            if p[1].abs() < 1e-12 * scale {
                self.points[k][1] = 0.0;
                image.push(k);
            } else {
                image.push(self.points.len());
                self.points.push([p[0], -p[1]]);
            }
        }
        for k in 0..self.triangles.len() {
            let [a, b, c] = self.triangles[k];
            self.triangles.push([image[a], image[c], image[b]]);
            self.parts.push(other(self.parts[k]));
        }
        let curved: Vec<_> = self.curves.iter().map(|(&k, &v)| (k, v)).collect();
        for ((a, b), (curve, from, to)) in curved {
            let (ia, ib) = (image[a], image[b]);
            let (from, to) = if ia < ib { (from, to) } else { (to, from) };
            self.curves.insert(edge(ia, ib), (curve.mirrored(), from, to));
        }
        self
    }
}
