//! Solid element at finite strain: force and stiffness from one energy.
//!
//! ```text
//! W = integral of mu shape(F) + K/2 (P theta)^2                                           [F2]
//! F = 1 + grad u in the plane,    F_yy = 1 + g0 + g1 X,   X: height at rest
//! ```
//!
//! P is the projection of [crate::element::solid]; for small strains the two elements are identical.

use super::law::Law;
use crate::element::sites;
use crate::element::solid::inverse3;
use crate::input::{Material, Point};

/// Unknowns: twelve nodal displacements (along, high), two of the bubble, g0, g1.
pub const ROWS: usize = 16;

/// Energy, force and stiffness of an element per unit of width.
pub struct Answer {
    /// W [F2].
    pub energy: f64,
    /// Derivative of W by the unknowns.
    pub force: [f64; ROWS],
    /// Second derivative.
    pub stiffness: [[f64; ROWS]; ROWS],
}

/// Evaluates an element at displacements u. None if it is folded.
pub fn answer(nodes: &[Point; 6], material: &Material, law: &Law, u: &[f64; ROWS]) -> Option<Answer> {
    let (mu, bulk) = (material.shear_modulus(), material.bulk_modulus());
    let sites = sites(nodes)?;
    let area: f64 = sites.iter().map(|s| s.weight).sum();
    let middle: [f64; 2] = std::array::from_fn(|k| sites.iter().map(|s| s.weight * s.place[k]).sum::<f64>() / area);
    let scale = area.sqrt();
    let mut out = Answer {
        energy: 0.0,
        force: [0.0; ROWS],
        stiffness: [[0.0; ROWS]; ROWS],
    };
    let mut mass = [[0.0; 3]; 3];
    let mut volume = [0.0; 3];
    let mut by_unknown = [[0.0; 3]; ROWS];
    let mut kept = Vec::with_capacity(7);
    for site in &sites {
        // Columns of dF/du: each unknown changes one or two of the five entries.
        let mut d = [[0.0; 5]; ROWS];
        for k in 0..7 {
            let [z, x] = site.slopes[k];
            d[2 * k][0] = z;
            d[2 * k][1] = x;
            d[2 * k + 1][2] = z;
            d[2 * k + 1][3] = x;
        }
        d[14][4] = 1.0;
        d[15][4] = site.place[1];
        let mut f = [1.0, 0.0, 0.0, 1.0, 1.0];
        for i in 0..ROWS {
            (0..5).for_each(|a| f[a] += d[i][a] * u[i]);
        }
        let [shape, theta] = law.at(f)?;
        let linear = [
            1.0,
            (site.place[0] - middle[0]) / scale,
            (site.place[1] - middle[1]) / scale,
        ];
        for a in 0..3 {
            volume[a] += site.weight * linear[a] * theta.v;
            for b in 0..3 {
                mass[a][b] += site.weight * linear[a] * linear[b];
            }
        }
        out.energy += site.weight * mu * shape.v;
        for i in 0..ROWS {
            let along = |g: &[f64; 5]| (0..5).map(|a| g[a] * d[i][a]).sum::<f64>();
            out.force[i] += site.weight * mu * along(&shape.g);
            let change = along(&theta.g);
            (0..3).for_each(|a| by_unknown[i][a] += site.weight * linear[a] * change);
        }
        kept.push((site.weight, linear, d, shape, theta));
    }
    let inverse = inverse3(&mass);
    let project = |v: &[f64; 3]| -> [f64; 3] {
        std::array::from_fn(|a| (0..3).map(|b| inverse[a][b] * v[b]).sum::<f64>() * bulk)
    };
    let pressure = project(&volume);
    out.energy += (0..3).map(|a| pressure[a] * volume[a]).sum::<f64>() / 2.0;
    for i in 0..ROWS {
        out.force[i] += (0..3).map(|a| pressure[a] * by_unknown[i][a]).sum::<f64>();
        let p = project(&by_unknown[i]);
        for j in 0..=i {
            out.stiffness[i][j] += (0..3).map(|a| p[a] * by_unknown[j][a]).sum::<f64>();
        }
    }
    for (weight, linear, d, shape, theta) in &kept {
        let p: f64 = (0..3).map(|a| pressure[a] * linear[a]).sum();
        let h: [[f64; 5]; 5] =
            std::array::from_fn(|a| std::array::from_fn(|b| weight * (mu * shape.h[a][b] + p * theta.h[a][b])));
        for i in 0..ROWS {
            let row: [f64; 5] = std::array::from_fn(|b| (0..5).map(|a| d[i][a] * h[a][b]).sum());
            for j in 0..=i {
                out.stiffness[i][j] += (0..5).map(|b| row[b] * d[j][b]).sum::<f64>();
            }
        }
    }
    for i in 0..ROWS {
        for j in 0..i {
            out.stiffness[j][i] = out.stiffness[i][j];
        }
    }
    Some(out)
}
