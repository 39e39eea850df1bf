//! The coarsest mesh: constrained Delaunay refinement (Ruppert) between the planned vertices, by the crate spade.

use super::plan::{Domain, Fineness, plan};
use super::{Mesh, edge};
use crate::error::Error;
use crate::geometry::outline::inside;
use crate::input::Point;
use spade::{AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation};
use std::collections::HashMap;

/// Triangles smaller than this part of the square of the domain's size would be slivers of a flat corner.
const FLAT: f64 = 1e-12;

impl<T: Copy> Mesh<T> {
    /// Meshes a domain; `part` says what lies at a point, none: nothing.
    pub fn new(domain: &Domain, fineness: &Fineness, part: &dyn Fn(Point) -> Option<T>) -> Result<Self, Error> {
        let failed = |what: &str| Error::Mesh(what.to_owned());
        let (pieces, largest) = plan(domain, fineness);
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
        let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
        let mut handles = Vec::with_capacity(points.len());
        for p in &points {
            handles.push(cdt.insert(Point2::new(p[0] / largest, p[1] / largest)).map_err(|e| failed(&e.to_string()))?);
        }
        for &(a, b) in &edges {
            if !cdt.can_add_constraint(handles[a], handles[b]) {
                return Err(failed("two outlines cross"));
            }
            cdt.add_constraint(handles[a], handles[b]);
        }
        // Outlines stay as planned: faces of a period must keep the same vertices.
        let wanted = RefinementParameters::<f64>::new()
            .keep_constraint_edges()
            .with_angle_limit(AngleLimit::from_deg(26.0))
            .with_max_allowed_area(0.5)
            .with_max_additional_vertices(40_000);
        cdt.refine(wanted);
        for vertex in cdt.vertices().skip(points.len()) {
            points.push([vertex.position().x * largest, vertex.position().y * largest]);
        }
        let outer = domain.outlines[0].chords();
        let mut mesh = Self { points, triangles: Vec::new(), parts: Vec::new(), curves };
        for face in cdt.inner_faces() {
            let corners = face.vertices().map(|v| v.fix().index());
            let [a, b, c] = corners.map(|k| mesh.points[k]);
            let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
            let centroid = [(a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0];
            if area < FLAT * largest * largest || !inside(&outer, centroid) {
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

    /// The mesh with its mirror image below the mid-plane; `other` names the part that mirrors one.
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
