//! Volume of a deformed bladder over its rest length, with derivatives.
//!
//! ```text
//! a = (1 + g0) A + g1 S,     A = boundary integral of (z dx - x dz)/2,    S = boundary integral of z x dx     [F4]
//! ```
//!
//! The integrals follow the deformed wall counter-clockwise. A is its area, S the area's first moment about the
//! mid-plane. For small strains this is [L2].

use crate::element::{GAUSS, shapes};

/// Value and derivatives with respect to the six coordinates of an edge (z, x of first, middle, last), then g0, g1.
pub struct Edge {
    /// Contribution of the edge to a.
    pub value: f64,
    /// Gradient.
    pub gradient: [f64; 8],
    /// Hessian.
    pub hessian: [[f64; 8]; 8],
}

/// Contribution of an edge to [F4] at deformed positions of its first, middle and last node.
pub fn edge(nodes: [[f64; 2]; 3], g0: f64, g1: f64) -> Edge {
    let mut out = Edge {
        value: 0.0,
        gradient: [0.0; 8],
        hessian: [[0.0; 8]; 8],
    };
    for [t, w] in GAUSS {
        let (s, ds) = shapes(t, 0.0);
        let (n, d) = ([s[0], s[3], s[1]], [ds[0][0], ds[3][0], ds[1][0]]);
        let sum = |c: &[f64; 3], k: usize| (0..3).map(|i| c[i] * nodes[i][k]).sum::<f64>();
        let (z, x, zt, xt) = (sum(&n, 0), sum(&n, 1), sum(&d, 0), sum(&d, 1));
        let (area, first) = ((z * xt - x * zt) / 2.0, z * x * xt);
        let l = 1.0 + g0;
        out.value += w * (l * area + g1 * first);
        out.gradient[6] += w * area;
        out.gradient[7] += w * first;
        for i in 0..3 {
            // Derivatives of area and first moment with respect to z_i and x_i.
            let a = [(n[i] * xt - x * d[i]) / 2.0, (z * d[i] - n[i] * zt) / 2.0];
            let f = [n[i] * x * xt, z * (n[i] * xt + x * d[i])];
            for k in 0..2 {
                out.gradient[2 * i + k] += w * (l * a[k] + g1 * f[k]);
                for (row, v) in [(6, a[k]), (7, f[k])] {
                    out.hessian[2 * i + k][row] += w * v;
                    out.hessian[row][2 * i + k] += w * v;
                }
            }
            for j in 0..3 {
                let az = (n[i] * d[j] - d[i] * n[j]) / 2.0;
                let fz = n[i] * (n[j] * xt + x * d[j]);
                out.hessian[2 * i][2 * j + 1] += w * (l * az + g1 * fz);
                out.hessian[2 * j + 1][2 * i] += w * (l * az + g1 * fz);
                out.hessian[2 * i + 1][2 * j + 1] += w * g1 * z * (n[i] * d[j] + d[i] * n[j]);
            }
        }
    }
    out
}
