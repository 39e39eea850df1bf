//! Vertices of the mesh on outlines: mesh size, splitting, spacing.
//!
//! The mesh size at a point p is the minimum over sources i of s_i + g |p - p_i|. It is small at sharp corners, where
//! stress is singular, on arcs, and at thin walls, and grows with distance.

use crate::geometry::curve::Curve;
use crate::geometry::outline::{Outline, distance};
use crate::input::Point;

/// Domain of a mesh. The first outline bounds it, the others are inside.
#[derive(Debug, Clone)]
pub struct Domain {
    /// Outer boundary, then the outlines inside.
    pub outlines: Vec<Outline>,
    /// Half pitch; the faces z = -+ half pitch have equal vertices.
    pub half_pitch: Option<f64>,
    /// True if only the half above the mid-plane is given; the mesh is mirrored.
    pub mirrored: bool,
}

/// Fineness of the coarsest mesh.
#[derive(Debug, Clone, Copy)]
pub struct Fineness {
    /// Largest size relative to the smaller extent of the outer boundary.
    pub largest: f64,
    /// Size at a corner relative to the smaller extent of its outline.
    pub corner: f64,
    /// Size over the thickness of a wall.
    pub wall: f64,
    /// Largest angle of an arc between vertices [rad].
    pub arc: f64,
    /// Growth of the size with distance.
    pub growth: f64,
}

impl Default for Fineness {
    fn default() -> Self {
        Self {
            largest: 0.35,
            corner: 0.005,
            wall: 1.0,
            arc: 0.53,
            growth: 0.9,
        }
    }
}

/// A curve with the parameters of its vertices.
#[derive(Debug, Clone)]
pub struct Piece {
    /// The curve.
    pub curve: Curve,
    /// Parameters of its vertices in order, including both ends.
    pub at: Vec<f64>,
}

struct Source {
    at: Point,
    size: f64,
}

/// Extents of an outline along and high.
fn extents(outline: &Outline) -> [f64; 2] {
    let points = outline.chords();
    let extent = |k: usize| {
        let (low, high) = points
            .iter()
            .fold((f64::MAX, f64::MIN), |(l, h), p| (l.min(p[k]), h.max(p[k])));
        high - low
    };
    [extent(0), extent(1)]
}

fn smaller(outline: &Outline) -> f64 {
    let [a, b] = extents(outline);
    a.min(b)
}

/// Mesh size as a function of position.
pub struct Sizes {
    sources: Vec<Source>,
    growth: f64,
    half_pitch: Option<f64>,
    /// The largest size.
    pub largest: f64,
}

impl Sizes {
    /// Mesh size at a point; equal on both faces of a period.
    pub fn at(&self, p: Point) -> f64 {
        let one = |p: Point| {
            let near = |s: &Source| s.size + self.growth * (p[0] - s.at[0]).hypot(p[1] - s.at[1]);
            self.sources.iter().map(near).fold(self.largest, f64::min)
        };
        match self.half_pitch {
            Some(half) if (p[0].abs() - half).abs() < 1e-9 * half => one(p).min(one([-p[0], p[1]])),
            _ => one(p),
        }
    }
}

/// All pieces of a domain with their vertices, and the mesh size.
pub fn plan(domain: &Domain, fineness: &Fineness) -> (Vec<Piece>, Sizes) {
    let [a, b] = extents(&domain.outlines[0]);
    let outer = if domain.mirrored { a.min(2.0 * b) } else { a.min(b) };
    let largest = fineness.largest * outer;
    let sizes = Sizes {
        sources: sources(domain, fineness),
        growth: fineness.growth,
        half_pitch: domain.half_pitch,
        largest,
    };
    let pieces = split(domain)
        .into_iter()
        .map(|curve| march(curve, &|p| sizes.at(p), fineness.arc))
        .collect();
    (pieces, sizes)
}

/// Relative size at a corner: full refinement from a right angle on, less at blunter corners with weaker singularities.
fn blunt(corner: f64, turn: f64) -> f64 {
    let sharp = (turn.abs() / std::f64::consts::FRAC_PI_2).min(1.0);
    corner.powf(sharp) * 0.2_f64.powf(1.0 - sharp)
}

fn sources(domain: &Domain, fineness: &Fineness) -> Vec<Source> {
    let mut sources = Vec::new();
    let inner = &domain.outlines[1..];
    let chords: Vec<Vec<Point>> = domain.outlines.iter().map(Outline::chords).collect();
    let single = if inner.is_empty() { &domain.outlines[..] } else { inner };
    for outline in single {
        let length = smaller(outline);
        sources.extend(outline.corners().into_iter().map(|(at, turn)| Source {
            at,
            size: blunt(fineness.corner, turn) * length,
        }));
        for curve in &outline.curves {
            if let Curve::Arc { radii, .. } = curve {
                let size = fineness.arc * radii[0].min(radii[1]);
                sources.extend((0..=4).map(|k| Source {
                    at: curve.at(f64::from(k) / 4.0),
                    size,
                }));
            }
        }
    }
    for (i, outline) in domain.outlines.iter().enumerate() {
        for curve in &outline.curves {
            let n = 12;
            for at in (0..=n).map(|k| curve.at(f64::from(k) / f64::from(n))) {
                // Outlines with a common edge form one wall, not a gap.
                let gap = |other: &Vec<Point>| {
                    let next = other.iter().cycle().skip(1);
                    let all = other.iter().zip(next).map(|(a, b)| distance(at, *a, *b));
                    all.fold(f64::MAX, f64::min)
                };
                let others = chords
                    .iter()
                    .enumerate()
                    .filter(|(j, _)| *j != i)
                    .map(|(_, other)| gap(other));
                let thinnest = others.filter(|&d| d > 1e-6 * smaller(outline)).fold(f64::MAX, f64::min);
                if thinnest < f64::MAX {
                    sources.push(Source {
                        at,
                        size: fineness.wall * thinnest,
                    });
                }
            }
        }
    }
    sources
}

/// Curves of all outlines without duplicates; straight ones are split where another curve ends on them.
fn split(domain: &Domain) -> Vec<Curve> {
    let curves: Vec<Curve> = domain.outlines.iter().flat_map(|o| o.curves.iter().copied()).collect();
    let mut ends: Vec<Point> = curves.iter().flat_map(|c| [c.at(0.0), c.at(1.0)]).collect();
    let scale = smaller(&domain.outlines[0]);
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9 * scale;
    if let Some(half) = domain.half_pitch {
        // The mid-plane on the faces: there the finite-strain cell measures the stretch of the beam.
        ends.push([half, 0.0]);
        let faced: Vec<Point> = ends
            .iter()
            .filter(|p| near(p[0].abs(), half))
            .map(|p| [-p[0], p[1]])
            .collect();
        ends.extend(faced);
    }
    let mut all: Vec<Curve> = Vec::new();
    for curve in curves {
        let Curve::Line { from, to } = curve else {
            all.push(curve);
            continue;
        };
        // Bottom to top, left to right: both faces of a period, and both sides of a common edge, get equal vertices.
        let (from, to) = if (from[1], from[0]) < (to[1], to[0]) && !near(from[1], to[1])
            || near(from[1], to[1]) && from[0] < to[0]
        {
            (from, to)
        } else {
            (to, from)
        };
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let along = |p: &Point| {
            ((p[0] - from[0]) * (to[0] - from[0]) + (p[1] - from[1]) * (to[1] - from[1])) / (length * length)
        };
        let on = |p: &&Point| {
            let t = along(p);
            t * length > 1e-9 * scale && (1.0 - t) * length > 1e-9 * scale && distance(**p, from, to) < 1e-9 * scale
        };
        let mut stops: Vec<(f64, Point)> = ends.iter().filter(on).map(|p| (along(p), *p)).collect();
        stops.extend([(0.0, from), (1.0, to)]);
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        stops.dedup_by(|a, b| (a.0 - b.0).abs() * length < 1e-9 * scale);
        for pair in stops.windows(2) {
            let line = Curve::Line {
                from: pair[0].1,
                to: pair[1].1,
            };
            let same = |c: &Curve| {
                let close = |p: Point, q: Point| near(p[0], q[0]) && near(p[1], q[1]);
                matches!(c, Curve::Line { .. }) && close(c.at(0.0), line.at(0.0)) && close(c.at(1.0), line.at(1.0))
            };
            if !all.iter().any(same) {
                all.push(line);
            }
        }
    }
    all
}

/// Vertices at equal increments of the integral of ds / size.
fn march(curve: Curve, size: &dyn Fn(Point) -> f64, arc: f64) -> Piece {
    let n = 200;
    let mut sum = vec![0.0; n + 1];
    for k in 0..n {
        let t = (k as f64 + 0.5) / n as f64;
        let [a, b] = curve.slope(t);
        sum[k + 1] = sum[k] + a.hypot(b) / size(curve.at(t)) / n as f64;
    }
    let least = match curve {
        Curve::Line { .. } => 1,
        Curve::Arc { from, to, .. } => ((to - from).abs() / arc - 1e-9).ceil() as usize,
    };
    // An excess of a tenth of a step does not justify another step.
    let steps = ((sum[n] - 0.1).ceil() as usize).max(least).max(1);
    let place = |k: usize| {
        if k == 0 || k == steps {
            return if k == 0 { 0.0 } else { 1.0 };
        }
        let want = sum[n] * k as f64 / steps as f64;
        let i = sum.partition_point(|&s| s < want).clamp(1, n);
        (i as f64 - 1.0 + (want - sum[i - 1]) / (sum[i] - sum[i - 1])) / n as f64
    };
    Piece {
        curve,
        at: (0..=steps).map(place).collect(),
    }
}
