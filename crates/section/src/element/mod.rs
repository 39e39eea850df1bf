//! Quadratic triangle: shape functions, derivatives, quadrature, matrices.

pub mod poisson;
pub mod solid;

use crate::input::Point;

/// Radon's rule of degree 5 on the unit triangle: (xi, eta, weight); weights sum to 1/2.
pub const RADON: [[f64; 3]; 7] = {
    const A: f64 = 0.101_286_507_323_456_33;
    const B: f64 = 0.470_142_064_105_115_1;
    const WA: f64 = 0.062_969_590_272_413_58;
    const WB: f64 = 0.066_197_076_394_253_1;
    [
        [1.0 / 3.0, 1.0 / 3.0, 0.1125],
        [A, A, WA],
        [1.0 - 2.0 * A, A, WA],
        [A, 1.0 - 2.0 * A, WA],
        [B, B, WB],
        [1.0 - 2.0 * B, B, WB],
        [B, 1.0 - 2.0 * B, WB],
    ]
};

/// Three-point Gauss rule on [0, 1]: (t, weight).
pub const GAUSS: [[f64; 2]; 3] = {
    const D: f64 = 0.387_298_334_620_741_7;
    [[0.5 - D, 5.0 / 18.0], [0.5, 4.0 / 9.0], [0.5 + D, 5.0 / 18.0]]
};

/// Values at a quadrature point of an element. The seventh shape function is the bubble 27 L0 L1 L2.
#[derive(Debug, Clone, Copy)]
pub struct Site {
    /// Position `[along, high]` [m].
    pub place: Point,
    /// Weight times area [m^2].
    pub weight: f64,
    /// Six nodal shape functions and the bubble.
    pub shapes: [f64; 7],
    /// Their derivatives with respect to along and high [1/m].
    pub slopes: [[f64; 2]; 7],
}

/// Shape functions and their derivatives with respect to xi and eta.
pub fn shapes(xi: f64, eta: f64) -> ([f64; 7], [[f64; 2]; 7]) {
    let l = [1.0 - xi - eta, xi, eta];
    let dl = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
    let (mut n, mut dn) = ([0.0; 7], [[0.0; 2]; 7]);
    for i in 0..3 {
        let j = (i + 1) % 3;
        n[i] = l[i] * (2.0 * l[i] - 1.0);
        n[3 + i] = 4.0 * l[i] * l[j];
        for k in 0..2 {
            dn[i][k] = (4.0 * l[i] - 1.0) * dl[i][k];
            dn[3 + i][k] = 4.0 * (l[i] * dl[j][k] + l[j] * dl[i][k]);
        }
    }
    n[6] = 27.0 * l[0] * l[1] * l[2];
    for k in 0..2 {
        dn[6][k] = 27.0 * (dl[0][k] * l[1] * l[2] + l[0] * dl[1][k] * l[2] + l[0] * l[1] * dl[2][k]);
    }
    (n, dn)
}

/// The seven quadrature points of an element. None if it is folded.
pub fn sites(nodes: &[Point; 6]) -> Option<[Site; 7]> {
    let mut all = [Site {
        place: [0.0; 2],
        weight: 0.0,
        shapes: [0.0; 7],
        slopes: [[0.0; 2]; 7],
    }; 7];
    for (site, [xi, eta, w]) in all.iter_mut().zip(RADON) {
        let (n, dn) = shapes(xi, eta);
        let mut j = [[0.0; 2]; 2];
        let mut place = [0.0; 2];
        for (k, p) in nodes.iter().enumerate() {
            for a in 0..2 {
                place[a] += n[k] * p[a];
                j[a][0] += p[a] * dn[k][0];
                j[a][1] += p[a] * dn[k][1];
            }
        }
        let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        if det <= 0.0 {
            return None;
        }
        let inverse = [[j[1][1] / det, -j[0][1] / det], [-j[1][0] / det, j[0][0] / det]];
        let slope = |d: [f64; 2]| {
            [
                d[0] * inverse[0][0] + d[1] * inverse[1][0],
                d[0] * inverse[0][1] + d[1] * inverse[1][1],
            ]
        };
        *site = Site {
            place,
            weight: w * det,
            shapes: n,
            slopes: dn.map(slope),
        };
    }
    Some(all)
}
