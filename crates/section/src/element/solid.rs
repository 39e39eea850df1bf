//! Stiffness of a solid element under generalized plane strain, without volumetric locking.
//!
//! ```text
//! energy per width   W = integral of mu e:e + K/2 (P theta)^2          [S1]
//!                    e = eps - theta/3 I,  theta = tr eps
//! ```
//!
//! P projects the volume strain theta onto the linear functions of the element. This corresponds to a mixed form with
//! linear discontinuous pressure, eliminated in each element. Displacements are quadratic with a cubic bubble, which is
//! also eliminated. This element of Crouzeix and Raviart (1973) satisfies the inf-sup condition: it does not lock as nu
//! approaches 1/2, and its matrix stays positive definite.
//!
//! Strains eps = (zz, xx, gamma_zx, yy) are those of the nodal displacements (along, high), of the bubble, and of eight
//! uniform fields
//!
//! ```text
//! zz = e + kappa x,   yy = g0 + g1 x,   and the same four times z       [S2]
//! ```

use super::{Site, sites};
use crate::input::{Material, Point};

/// Rows: twelve nodal displacements (along and high alternate), then e, kappa, g0, g1 and the same times z.
pub const ROWS: usize = 20;
/// Rows with the two of the bubble.
const ALL: usize = ROWS + 2;

/// A symmetric matrix over the rows.
pub type Matrix = [[f64; ROWS]; ROWS];

/// Strains (zz, xx, gamma, yy) of every row at a quadrature point.
fn strains(site: &Site) -> [[f64; 4]; ALL] {
    let mut b = [[0.0; 4]; ALL];
    let mut put = |row: usize, [dz, dx]: [f64; 2]| {
        b[row] = [dz, 0.0, dx, 0.0];
        b[row + 1] = [0.0, dx, dz, 0.0];
    };
    for k in 0..6 {
        put(2 * k, site.slopes[k]);
    }
    put(ROWS, site.slopes[6]);
    let [z, x] = site.place;
    for (k, factor) in [1.0, z].into_iter().enumerate() {
        let at = 12 + 4 * k;
        b[at][0] = factor;
        b[at + 1][0] = factor * x;
        b[at + 2][3] = factor;
        b[at + 3][3] = factor * x;
    }
    b
}

/// Stiffness per unit of width [S1], without the bubble. None if the element is folded.
pub fn matrix(nodes: &[Point; 6], material: &Material) -> Option<Matrix> {
    let (mu, bulk) = (material.shear_modulus(), material.bulk_modulus());
    let sites = sites(nodes)?;
    let area: f64 = sites.iter().map(|s| s.weight).sum();
    let mut middle = [0.0; 2];
    for s in &sites {
        middle[0] += s.weight * s.place[0] / area;
        middle[1] += s.weight * s.place[1] / area;
    }
    let scale = area.sqrt();
    let mut k = [[0.0; ALL]; ALL];
    let mut mass = [[0.0; 3]; 3];
    let mut volume = [[0.0; 3]; ALL];
    for site in &sites {
        let b = strains(site);
        let linear = [
            1.0,
            (site.place[0] - middle[0]) / scale,
            (site.place[1] - middle[1]) / scale,
        ];
        for i in 0..3 {
            for j in 0..3 {
                mass[i][j] += site.weight * linear[i] * linear[j];
            }
        }
        for i in 0..ALL {
            let [zz, xx, gamma, yy] = b[i];
            let theta = zz + xx + yy;
            for (v, l) in volume[i].iter_mut().zip(linear) {
                *v += site.weight * l * theta;
            }
            // 2 mu times the deviator. gamma counts once, since it is its own conjugate.
            let w = 2.0 * mu * site.weight;
            let s = [
                w * (zz - theta / 3.0),
                w * (xx - theta / 3.0),
                w * gamma / 2.0,
                w * (yy - theta / 3.0),
            ];
            for j in 0..=i {
                k[i][j] += s[0] * b[j][0] + s[1] * b[j][1] + s[2] * b[j][2] + s[3] * b[j][3];
            }
        }
    }
    let inverse = inverse3(&mass);
    for i in 0..ALL {
        let p: [f64; 3] = std::array::from_fn(|a| (0..3).map(|c| inverse[a][c] * volume[i][c]).sum::<f64>() * bulk);
        for j in 0..=i {
            k[i][j] += p[0] * volume[j][0] + p[1] * volume[j][1] + p[2] * volume[j][2];
        }
    }
    for i in 0..ALL {
        for j in 0..i {
            k[j][i] = k[i][j];
        }
    }
    Some(without_bubble(&k))
}

/// Eliminates the bubble: k - k_b K_bb^-1 k_b^T.
fn without_bubble(k: &[[f64; ALL]; ALL]) -> Matrix {
    let (p, q) = (ROWS, ROWS + 1);
    let det = k[p][p] * k[q][q] - k[p][q] * k[p][q];
    let mut out = [[0.0; ROWS]; ROWS];
    for i in 0..ROWS {
        let u = (k[q][q] * k[i][p] - k[p][q] * k[i][q]) / det;
        let v = (k[p][p] * k[i][q] - k[p][q] * k[i][p]) / det;
        for j in 0..=i {
            out[i][j] = k[i][j] - u * k[j][p] - v * k[j][q];
            out[j][i] = out[i][j];
        }
    }
    out
}

/// Inverse of a symmetric 3 x 3 matrix.
pub fn inverse3(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let minor = |i: usize, j: usize| {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let det: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| minor(j, i) / det))
}
