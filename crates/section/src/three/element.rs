//! A prism over a quadratic triangle, with stiffness free of volumetric locking.
//!
//! Displacements are products of the triangle's six shape functions and three quadratic ones across the width, plus the
//! triangle's bubble times the middle one. The volume strain is projected onto the linear functions 1, z, x, y of the
//! element. The quadratic shapes control its mean by face fluxes, the bubble its slope. The energy is that of [S1].

use crate::element::sites;
use crate::input::{Material, Point};

/// Displacements (along, high, across) of eighteen nodes, the six of the lower plane first; then e and kappa.
pub const ROWS: usize = 56;
/// Rows with the three of the bubble.
const ALL: usize = ROWS + 3;

/// Three-point Gauss rule across the width: (t, weight, shapes, slopes) on [0, 1].
fn across() -> [(f64, f64, [f64; 3], [f64; 3]); 3] {
    crate::element::GAUSS.map(|[t, w]| {
        let shapes = [(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)];
        (t, w, shapes, [4.0 * t - 3.0, 4.0 - 8.0 * t, 4.0 * t - 1.0])
    })
}

/// Stiffness of a prism over a triangle: rows of the lower triangle of a `ROWS` by `ROWS` matrix. None if folded.
pub fn matrix(nodes: &[Point; 6], thickness: f64, material: &Material) -> Option<Vec<[f64; ROWS]>> {
    let (mu, bulk) = (material.shear_modulus(), material.bulk_modulus());
    let sites = sites(nodes)?;
    let area: f64 = sites.iter().map(|s| s.weight).sum();
    let middle: [f64; 2] = std::array::from_fn(|k| sites.iter().map(|s| s.weight * s.place[k]).sum::<f64>() / area);
    let scale = area.sqrt();
    let mut k = vec![[0.0; ALL]; ALL];
    let mut mass = [[0.0; 4]; 4];
    let mut volume = [[0.0; 4]; ALL];
    for site in &sites {
        for (t, w, n, d) in across() {
            let weight = site.weight * w * thickness;
            let mut b = [[0.0; 6]; ALL];
            // Strains zz, xx, yy, zx, xy, yz of a shape function with these slopes.
            let mut put = |row: usize, [z, x, y]: [f64; 3]| {
                b[row] = [z, 0.0, 0.0, x, 0.0, y];
                b[row + 1] = [0.0, x, 0.0, z, y, 0.0];
                b[row + 2] = [0.0, 0.0, y, 0.0, x, z];
            };
            let slope = |i: usize, j: usize| {
                [
                    site.slopes[i][0] * n[j],
                    site.slopes[i][1] * n[j],
                    site.shapes[i] * d[j] / thickness,
                ]
            };
            for j in 0..3 {
                for i in 0..6 {
                    put(3 * (6 * j + i), slope(i, j));
                }
            }
            put(ROWS, slope(6, 1));
            b[54][0] = 1.0;
            b[55][0] = site.place[1];
            let linear = [
                1.0,
                (site.place[0] - middle[0]) / scale,
                (site.place[1] - middle[1]) / scale,
                t - 0.5,
            ];
            for i in 0..4 {
                (0..4).for_each(|j| mass[i][j] += weight * linear[i] * linear[j]);
            }
            for i in 0..ALL {
                let s = &b[i];
                let theta = s[0] + s[1] + s[2];
                (0..4).for_each(|a| volume[i][a] += weight * linear[a] * theta);
                let (c, m) = (2.0 * mu * weight, theta / 3.0);
                let stress = [
                    c * (s[0] - m),
                    c * (s[1] - m),
                    c * (s[2] - m),
                    c * s[3] / 2.0,
                    c * s[4] / 2.0,
                    c * s[5] / 2.0,
                ];
                for j in 0..=i {
                    let o = &b[j];
                    k[i][j] += (0..6).map(|a| stress[a] * o[a]).sum::<f64>();
                }
            }
        }
    }
    for i in 0..ALL {
        let p = crate::dense::solve(mass, volume[i])?.map(|p| bulk * p);
        for j in 0..=i {
            k[i][j] += (0..4).map(|a| p[a] * volume[j][a]).sum::<f64>();
        }
    }
    // Eliminate the bubble: its rows are the last three, filled to the left of the diagonal.
    let block = std::array::from_fn(|a| std::array::from_fn(|b| k[ROWS + a.max(b)][ROWS + a.min(b)]));
    let inverse = crate::element::solid::inverse3(&block);
    let out = (0..ROWS).map(|i| {
        let mine: [f64; 3] = std::array::from_fn(|a| (0..3).map(|b| inverse[a][b] * k[ROWS + b][i]).sum());
        std::array::from_fn(|j| {
            if j <= i {
                k[i][j] - (0..3).map(|a| mine[a] * k[ROWS + a][j]).sum::<f64>()
            } else {
                0.0
            }
        })
    });
    Some(out.collect())
}
