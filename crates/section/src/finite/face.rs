//! Motion of the two faces of the period: one shape, carried along a circular arc.
//!
//! ```text
//! phi(c, x) = Q(kappa c) s(x) + r,     c = -+ pitch/2                                            [F3]
//! Q(a) s = (cos a s_z + sin a s_x, -sin a s_z + cos a s_x)
//! r = (1 + e) (sin(kappa c)/kappa, -(1 - cos(kappa c))/kappa)
//! ```
//!
//! s = (0, x) + w is the shape of the face in its own frame. w is equal on both faces: the jump is a rigid rotation by
//! kappa pitch and a translation. Positive kappa stretches the +x fibre.

/// Position of a face's node with its derivatives.
pub struct Carried {
    /// phi.
    pub place: [f64; 2],
    /// Q: derivative of phi by s, `[row][column]`.
    pub by_shape: [[f64; 2]; 2],
    /// Derivative of phi by e.
    pub by_stretch: [f64; 2],
    /// Derivative of phi by kappa.
    pub by_curvature: [f64; 2],
    /// Derivative of `by_shape` by kappa.
    pub shape_curvature: [[f64; 2]; 2],
    /// Mixed derivative of phi by e and kappa.
    pub stretch_curvature: [f64; 2],
    /// Second derivative of phi by kappa.
    pub curvature_twice: [f64; 2],
}

/// sin(t)/t and (1 - cos t)/t by Taylor series, each with two derivatives: (value, first, second).
fn arc(t: f64) -> [[f64; 3]; 2] {
    let mut out = [[0.0; 3]; 2];
    // sin t/t = sum (-1)^k t^2k/(2k+1)!, (1 - cos t)/t = sum (-1)^k t^(2k+1)/(2k+2)!; 16 terms are exact to rounding up
    // to a full circle.
    let mut factorial = 1.0;
    for k in 0..16 {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        for (which, n) in [(0, 2 * k), (1, 2 * k + 1)] {
            factorial *= f64::from(n + 1);
            let c = sign / factorial;
            let nf = f64::from(n);
            out[which][0] += c * t.powi(n);
            if n >= 1 {
                out[which][1] += c * nf * t.powi(n - 1);
            }
            if n >= 2 {
                out[which][2] += c * nf * (nf - 1.0) * t.powi(n - 2);
            }
        }
    }
    out
}

/// Carries a shape s to the face at c.
pub fn carry(s: [f64; 2], c: f64, e: f64, kappa: f64) -> Carried {
    let (sin, cos) = (kappa * c).sin_cos();
    let q = [[cos, sin], [-sin, cos]];
    let turned = [[-sin * c, cos * c], [-cos * c, -sin * c]];
    let times = |m: &[[f64; 2]; 2]| [m[0][0] * s[0] + m[0][1] * s[1], m[1][0] * s[0] + m[1][1] * s[1]];
    let [[s0, s1, s2], [c0, c1, c2]] = arc(kappa * c);
    let (qs, q1s) = (times(&q), times(&turned));
    let (r, r1, r2) = (
        [c * s0, -c * c0],
        [c * c * s1, -c * c * c1],
        [c * c * c * s2, -c * c * c * c2],
    );
    let l = 1.0 + e;
    Carried {
        place: [qs[0] + l * r[0], qs[1] + l * r[1]],
        by_shape: q,
        by_stretch: r,
        by_curvature: [q1s[0] + l * r1[0], q1s[1] + l * r1[1]],
        shape_curvature: turned,
        stretch_curvature: r1,
        curvature_twice: [-c * c * qs[0] + l * r2[0], -c * c * qs[1] + l * r2[1]],
    }
}
