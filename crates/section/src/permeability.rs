//! Permeability of a straight channel: creeping flow along it, equation (A.12).
//!
//! ```text
//! -lap w = 1 in the cross-section,  w = 0 on its walls,  q1 = integral of w;   flow = -(q1 / mu) dp/ds      [Q1]
//! ```
//!
//! w is twice differentiable except at reentrant corners. Quadratic elements give q1, the energy of w, with fourth
//! order.

use crate::element::poisson;
use crate::error::Error;
use crate::estimate::{Estimate, SHARP, SMOOTH, estimate};
use crate::geometry::outline::Outline;
use crate::input::{Point, Shape};
use crate::mesh::{Domain, Fineness, Mesh};
use crate::sparse::Factor;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Cross-section of a channel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Channel {
    /// Interior of one outline.
    Open(Shape),
    /// Region between two concentric circles.
    Annulus {
        /// Inner radius [m].
        inner_m: f64,
        /// Outer radius [m].
        outer_m: f64,
    },
}

/// Outer boundary, and the inner one of an annulus.
fn outlines(channel: &Channel) -> Vec<Outline> {
    match channel {
        Channel::Open(shape) => vec![Outline::shape(shape, [0.0; 2])],
        Channel::Annulus { inner_m, outer_m } => {
            [outer_m, inner_m].map(|r| Outline::ellipse([0.0; 2], [*r; 2])).to_vec()
        }
    }
}

/// q1 [m^4] of a channel on `levels` meshes, each with four times as many triangles as the previous one.
pub fn levels(channel: &Channel, levels: usize) -> Result<Vec<f64>, Error> {
    let domain = Domain {
        outlines: outlines(channel),
        half_pitch: None,
        mirrored: false,
    };
    let holes: Vec<Vec<Point>> = domain.outlines[1..].iter().map(Outline::chords).collect();
    let part = |p: Point| (!holes.iter().any(|h| crate::geometry::outline::inside(h, p))).then_some(());
    let mut mesh = Mesh::new(&domain, &Fineness::default(), &part)?;
    let mut values = Vec::with_capacity(levels);
    for level in 0..levels {
        if level > 0 {
            mesh = mesh.refined();
        }
        let q = mesh.quadratic();
        values.push(flow(&q.nodes, &q.triangles, &|nodes| poisson::matrix(nodes))?);
    }
    Ok(values)
}

/// q1 [m^4] of a channel with its estimated error.
pub fn permeability(channel: &Channel) -> Result<Estimate, Error> {
    Ok(estimate(
        &levels(channel, 3)?,
        if outlines(channel).iter().all(|o| o.corners().is_empty()) {
            SMOOTH
        } else {
            SHARP
        },
    ))
}

type Element<'a> = &'a dyn Fn(&[Point; 6]) -> Option<([[f64; 6]; 6], [f64; 6])>;

/// Solves [Q1] on these triangles, with w = 0 on edges of a single triangle.
pub(crate) fn flow(nodes: &[Point], triangles: &[[usize; 6]], element: Element) -> Result<f64, Error> {
    let mut seen: HashMap<usize, (usize, [usize; 3])> = HashMap::new();
    for t in triangles {
        for k in 0..3 {
            seen.entry(t[3 + k]).or_insert((0, [t[k], t[3 + k], t[(k + 1) % 3]])).0 += 1;
        }
    }
    let mut number = vec![usize::MAX; nodes.len()];
    const WALL: usize = usize::MAX - 1;
    for (count, edge) in seen.values() {
        if *count == 1 {
            edge.iter().for_each(|&k| number[k] = WALL);
        }
    }
    let mut n = 0;
    for &k in triangles.iter().flatten() {
        if number[k] == usize::MAX {
            number[k] = n;
            n += 1;
        }
    }
    let mut entries = Vec::with_capacity(triangles.len() * 21);
    let mut load = vec![0.0; n];
    for t in triangles {
        let corners = t.map(|k| nodes[k]);
        let (k, f) = element(&corners).ok_or_else(crate::cell::folded)?;
        for i in 0..6 {
            let row = number[t[i]];
            if row == WALL {
                continue;
            }
            load[row] += f[i];
            for j in 0..6 {
                let col = number[t[j]];
                if col != WALL && row >= col {
                    entries.push((row, col, k[i][j]));
                }
            }
        }
    }
    let w = Factor::new(n, &entries)?.solve(std::slice::from_ref(&load));
    Ok(crate::dense::dot(&w[0], &load))
}
