//! Laplacian matrix and unit source load of a quadratic triangle.

use super::sites;
use crate::input::Point;

/// Integrals of grad N_i . grad N_j and of N_i. None if the element is folded.
pub fn matrix(nodes: &[Point; 6]) -> Option<([[f64; 6]; 6], [f64; 6])> {
    let (mut k, mut f) = ([[0.0; 6]; 6], [0.0; 6]);
    for site in sites(nodes)? {
        for i in 0..6 {
            f[i] += site.weight * site.shapes[i];
            for j in 0..6 {
                let (a, b) = (site.slopes[i], site.slopes[j]);
                k[i][j] += site.weight * (a[0] * b[0] + a[1] * b[1]);
            }
        }
    }
    Some((k, f))
}
