//! Meshes of quadratic triangles on curved outlines, refined by halving every edge.

pub mod plan;
mod triangulate;

use crate::geometry::curve::Curve;
use crate::input::Point;
use std::collections::HashMap;

pub use plan::{Domain, Fineness};

/// Triangles between vertices; edges on arcs store their curve.
#[derive(Debug, Clone)]
pub struct Mesh<T> {
    /// Vertices `[along, high]`.
    pub points: Vec<Point>,
    /// Triangles, counter-clockwise.
    pub triangles: Vec<[usize; 3]>,
    /// Part of the domain that contains each triangle.
    pub parts: Vec<T>,
    curves: HashMap<(usize, usize), (Curve, f64, f64)>,
}

/// Quadratic triangles: three vertices, then the midpoints of edges 01, 12, 20.
#[derive(Debug, Clone)]
pub struct Quadratic<T> {
    /// Vertices, then midpoints of edges.
    pub nodes: Vec<Point>,
    /// Six nodes each.
    pub triangles: Vec<[usize; 6]>,
    /// Part of the domain that contains each triangle.
    pub parts: Vec<T>,
}

/// Points with midpoints of edges, the three midpoints of each triangle, and the midpoint of each edge.
type Middles = (Vec<Point>, Vec<[usize; 3]>, HashMap<(usize, usize), usize>);

/// Key of an edge: the smaller vertex first.
fn edge(a: usize, b: usize) -> (usize, usize) {
    (a.min(b), a.max(b))
}

impl<T: Copy> Mesh<T> {
    /// Midpoint of an edge on its curve.
    fn middle(&self, a: usize, b: usize) -> Point {
        match self.curves.get(&edge(a, b)) {
            Some((curve, from, to)) => curve.at((from + to) / 2.0),
            None => {
                let ([a0, a1], [b0, b1]) = (self.points[a], self.points[b]);
                [(a0 + b0) / 2.0, (a1 + b1) / 2.0]
            }
        }
    }

    /// Points with midpoints of edges, and the midpoints of each triangle and edge.
    fn middles(&self) -> Middles {
        let mut points = self.points.clone();
        let mut found: HashMap<(usize, usize), usize> = HashMap::with_capacity(2 * self.triangles.len());
        let mut of = |a: usize, b: usize| {
            *found.entry(edge(a, b)).or_insert_with(|| {
                points.push(self.middle(a, b));
                points.len() - 1
            })
        };
        let middles = self
            .triangles
            .iter()
            .map(|&[a, b, c]| [of(a, b), of(b, c), of(c, a)])
            .collect();
        (points, middles, found)
    }

    /// Divides every triangle into four, with new vertices on the curves.
    pub fn refined(&self) -> Self {
        let (points, middles, found) = self.middles();
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        let mut parts = Vec::with_capacity(4 * self.triangles.len());
        for ((&[a, b, c], &[ab, bc, ca]), &part) in self.triangles.iter().zip(&middles).zip(&self.parts) {
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
            parts.extend([part; 4]);
        }
        let mut curves = HashMap::with_capacity(2 * self.curves.len());
        for (&(a, b), &(curve, from, to)) in &self.curves {
            if let Some(&m) = found.get(&(a, b)) {
                let half = (from + to) / 2.0;
                // `from` belongs to the smaller vertex; a new vertex is always the larger.
                curves.insert(edge(a, m), (curve, from, half));
                curves.insert(edge(b, m), (curve, to, half));
            }
        }
        Self {
            points,
            triangles,
            parts,
            curves,
        }
    }

    /// Adds nodes at the midpoints of edges.
    pub fn quadratic(&self) -> Quadratic<T> {
        let (nodes, middles, _) = self.middles();
        let six = |(&[a, b, c], &[ab, bc, ca]): (&[usize; 3], &[usize; 3])| [a, b, c, ab, bc, ca];
        Quadratic {
            nodes,
            triangles: self.triangles.iter().zip(&middles).map(six).collect(),
            parts: self.parts.clone(),
        }
    }
}
