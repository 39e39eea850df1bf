//! Comparison: a thick-walled tube across the beam. Lame's solution in plane strain and with closed ends.
//!
//! The cell is as long as the tube's diameter, so each face of the period is a single node. The cell's stretch is free.
//! This prevents rotation of the tube without loading it.

use super::{Comparison, material};
use crate::cell::respond::walls;
use crate::cell::{Cell, Kind, Part, Response};
use crate::dense::{dot, solve};
use crate::error::Error;
use crate::geometry::outline::{Outline, inside};
use crate::mesh::{Domain, Fineness, Mesh};
use std::f64::consts::PI;

const INNER: f64 = 2e-3;
const OUTER: f64 = 5e-3;

/// Compares tubes up to a Poisson's ratio of 0.4999.
pub fn compare() -> Result<Vec<Comparison>, Error> {
    let mut rows = Vec::new();
    for nu in [0.3, 0.49, 0.4999] {
        rows.extend(tube(nu)?);
    }
    Ok(rows)
}

fn tube(nu: f64) -> Result<Vec<Comparison>, Error> {
    let young = 2e6;
    let solid = material(young, nu);
    let rings = [OUTER, INNER].map(|r| Outline::ellipse([0.0; 2], [r; 2]));
    let bore = rings[1].chords();
    let domain = Domain {
        outlines: rings.to_vec(),
        half_pitch: None,
        mirrored: false,
    };
    let part = |p| {
        Some(if inside(&bore, p) {
            Part::Upper(0)
        } else {
            Part::Solid(0)
        })
    };
    let mut mesh = Mesh::new(&domain, &Fineness::default(), &part)?;
    let mut computed = [const { Vec::new() }; 4];
    for level in 0..3 {
        if level > 0 {
            mesh = mesh.refined();
        }
        let cell = Cell {
            mesh: mesh.quadratic(),
            materials: vec![solid],
            size: [2.0 * OUTER, 2.0 * OUTER],
        };
        let response = Response::new(&cell, Kind::Hollow)?;
        let (s, t, r) = (
            &response.stiffness,
            &response.area_by_strain[0],
            response.area_by_pressure[0][0],
        );
        computed[0].push(r + t[0] * t[0] / s[0][0]);
        // Outside: the whole boundary of the solid, less its inner boundary.
        let mut outside = walls(&cell, &response.independent, response.unknowns, |p| {
            matches!(p, Part::Solid(_))
        });
        outside.iter_mut().zip(&response.sides[4]).for_each(|(o, i)| *o += i);
        // The fixed node moves with the faces: see the stretch below. Its force is the reaction, zero in sum.
        outside[0] = 0.0;
        outside[1] = 0.0;
        let macroscopic = OUTER * OUTER * PI - dot(&outside, &response.fields[0]);
        computed[1].push(-dot(&outside, &response.fields[4]) - macroscopic * t[0] / s[0][0]);
        let q = solve([[s[0][0], s[0][2]], [s[2][0], s[2][2]]], [t[0], t[2]]).ok_or(Error::Singular)?;
        computed[2].push(r + t[0] * q[0] + t[2] * q[1]);
        computed[3].push(q[1]);
    }
    let (a, b) = (INNER * INNER, OUTER * OUTER);
    let bore = 2.0 * PI * a * (1.0 + nu) / young / (b - a);
    let axial = (1.0 - 2.0 * nu) / young * a / (b - a);
    // With closed ends, plane strain plus the axial strain: the bore narrows by nu times it.
    let closed = bore * ((1.0 - 2.0 * nu) * a + b) + PI * a * (1.0 - 2.0 * nu) * axial;
    let exact = [
        bore * ((1.0 - 2.0 * nu) * a + b),
        -bore * 2.0 * (1.0 - nu) * b,
        closed,
        axial,
    ];
    let names = [
        "area of a tube's bore per inner pressure [m^2/Pa]",
        "area of a tube's bore per outer pressure [m^2/Pa]",
        "volume of a closed tube per length and pressure [m^2/Pa]",
        "axial strain of a closed tube per pressure [1/Pa]",
    ];
    let row = |((name, exact), computed): ((&str, f64), Vec<f64>)| {
        let row = Comparison::new(format!("{name}, nu {nu}"), "Lame", exact, computed);
        // Cancellation loses the factor 1 - 2 nu: 1e-16 over 2e-4, times the condition number of the cell, 1e6 at nu
        // 0.4999.
        let lost = nu > 0.499 && name.starts_with("axial strain");
        if lost { row.within(1e-6) } else { row }
    };
    Ok(names.into_iter().zip(exact).zip(computed).map(row).collect())
}
