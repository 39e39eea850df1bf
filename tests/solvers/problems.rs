//! Small systems with known answers, and Jacobians by central differences on a dense pattern.

use slcbeam::dae::{Dae, EvaluationError, Seeds};
use slcbeam::sparse::Pattern;

/// A residual `F(t, y, y')` as a plain function.
pub type Residual = fn(f64, &[f64], &[f64], &mut [f64]) -> Result<(), EvaluationError>;

/// A system given by its residual alone.
pub struct Plain {
    differential: Vec<bool>,
    pattern: Pattern,
    residual: Residual,
}

impl Plain {
    /// System with a dense pattern.
    pub fn new(differential: &[bool], residual: Residual) -> Self {
        let n = differential.len();
        let pattern = Pattern::from_columns(&vec![(0..n).collect(); n]);
        Self {
            differential: differential.to_vec(),
            pattern,
            residual,
        }
    }
}

impl Dae for Plain {
    fn len(&self) -> usize {
        self.differential.len()
    }

    fn differential(&self) -> &[bool] {
        &self.differential
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], residual: &mut [f64]) -> Result<(), EvaluationError> {
        (self.residual)(t, y, yp, residual)
    }

    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        seeds: Seeds<'_>,
        values: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let n = self.len();
        values.fill(0.0);
        let (mut y, mut yp) = (y.to_vec(), yp.to_vec());
        let (mut plus, mut minus) = (vec![0.0; n], vec![0.0; n]);
        for j in 0..n {
            let (y_seed, yp_seed) = match seeds {
                Seeds::Step { cj } => (1.0, cj),
                Seeds::Columns { y, yp } => (y[j], yp[j]),
            };
            for (seed, rates) in [(y_seed, false), (yp_seed, true)] {
                if seed == 0.0 {
                    continue;
                }
                let at = if rates { yp[j] } else { y[j] };
                // cube root of the rounding error: optimal for central differences
                let h = 6e-6 * at.abs().max(1e-6);
                for (shift, out) in [(h, &mut plus), (-h, &mut minus)] {
                    if rates {
                        yp[j] = at + shift
                    } else {
                        y[j] = at + shift
                    }
                    (self.residual)(t, &y, &yp, out)?;
                }
                if rates {
                    yp[j] = at
                } else {
                    y[j] = at
                }
                for i in 0..n {
                    values[j * n + i] += seed * (plus[i] - minus[i]) / (2.0 * h);
                }
            }
        }
        Ok(())
    }

    fn name(&self, unknown: usize) -> String {
        format!("y{}", unknown + 1)
    }
}

/// Robertson's reaction with the conservation of mass as its third equation; starts at (1, 0, 0).
pub fn robertson() -> Plain {
    Plain::new(&[true, true, false], |_, y, yp, f| {
        f[0] = yp[0] + 0.04 * y[0] - 1e4 * y[1] * y[2];
        f[1] = yp[1] - 0.04 * y[0] + 1e4 * y[1] * y[2] + 3e7 * y[1] * y[1];
        f[2] = y[0] + y[1] + y[2] - 1.0;
        Ok(())
    })
}

/// Transistor amplifier (IVP test set; Rentrop, Roche & Steinebach), index 1.
///
/// Unknowns: the voltages of the capacitors 1, 3 and 5 (u1 - u2, u4 - u5, u7 - u8) and of the grounded ones 2 and 4
/// (u3, u6) are differential; u2, u5 and u8 are algebraic. Order: u1-u2, u2, u3, u4-u5, u5, u6, u7-u8, u8.
/// Equations are times 1e4, so that currents are of order one.
pub fn transistor() -> Plain {
    Plain::new(&[true, false, true, true, false, true, true, false], |t, z, zp, f| {
        let (ub, uf, alpha, beta, r0, r) = (6.0, 0.026, 0.99, 1e-6, 1000.0, 9000.0);
        let ue = 0.1 * (200.0 * std::f64::consts::PI * t).sin();
        let u = transistor_voltages(z);
        let g = |x: f64| beta * ((x / uf).exp() - 1.0);
        let c = |k: f64| k * 1e-6;
        f[0] = c(1.0) * zp[0] + (u[0] - ue) / r0;
        f[1] = -c(1.0) * zp[0] + u[1] / r + (u[1] - ub) / r + (1.0 - alpha) * g(u[1] - u[2]);
        f[2] = c(2.0) * zp[2] + u[2] / r - g(u[1] - u[2]);
        f[3] = c(3.0) * zp[3] + (u[3] - ub) / r + alpha * g(u[1] - u[2]);
        f[4] = -c(3.0) * zp[3] + u[4] / r + (u[4] - ub) / r + (1.0 - alpha) * g(u[4] - u[5]);
        f[5] = c(4.0) * zp[5] + u[5] / r - g(u[4] - u[5]);
        f[6] = c(5.0) * zp[6] + (u[6] - ub) / r + alpha * g(u[4] - u[5]);
        f[7] = -c(5.0) * zp[6] + u[7] / r;
        f.iter_mut().for_each(|f| *f *= 1e4);
        Ok(())
    })
}

/// Node voltages u1..u8 from the unknowns of [`transistor`].
pub fn transistor_voltages(z: &[f64]) -> [f64; 8] {
    [z[0] + z[1], z[1], z[2], z[3] + z[4], z[4], z[5], z[6] + z[7], z[7]]
}

/// Voltages of [`transistor`] at t = 0.2, published with the IVP test set.
pub const TRANSISTOR: [f64; 8] = [
    -0.5562145012262709e-2,
    3.006522471903042,
    2.849958788608128,
    2.926422536206241,
    2.704617865010554,
    2.761837778393145,
    4.770927631616772,
    1.236995868091548,
];

/// Unknowns of [`transistor`] at t = 0 and the rates of the differential ones: u = (0, 3, 3, 6, 3, 3, 6, 0).
pub fn transistor_start() -> ([f64; 8], [f64; 8]) {
    let rate = |k: f64, current: f64| current / (k * 1e-6);
    let leak = 3.0 / 9000.0;
    let y = [-3.0, 3.0, 3.0, 3.0, 3.0, 3.0, 6.0, 0.0];
    let yp = [0.0, 0.0, -rate(2.0, leak), 0.0, 0.0, -rate(4.0, leak), 0.0, 0.0];
    (y, yp)
}

/// Number of angles of [`beam`].
const ANGLES: usize = 40;

/// Beam (Hairer & Wanner, IVP test set): 40 angles and their rates; starts at rest, y = 0 and y' = 0.
pub fn beam() -> Plain {
    Plain::new(&[true; 2 * ANGLES], |t, y, yp, f| {
        let (th, rate) = y.split_at(ANGLES);
        let n = ANGLES as f64;
        let force = if t < std::f64::consts::PI {
            1.5 * t.sin().powi(2)
        } else {
            0.0
        };
        let (fx, fy) = (-force, force);
        // v, and the tridiagonal C as its diagonal and the cosine to the left
        let mut v = [0.0; ANGLES];
        let mut diagonal = [2.0; ANGLES];
        let mut cosine = [0.0; ANGLES];
        let mut sine = [0.0; ANGLES];
        (diagonal[0], diagonal[ANGLES - 1]) = (1.0, 3.0);
        for l in 0..ANGLES {
            let left = if l == 0 { -th[0] } else { th[l - 1] };
            let right = if l + 1 == ANGLES { th[l] } else { th[l + 1] };
            v[l] = n.powi(4) * (left - 2.0 * th[l] + right) + n.powi(2) * (th[l].cos() * fy - th[l].sin() * fx);
            if l > 0 {
                (sine[l], cosine[l]) = (th[l] - th[l - 1]).sin_cos();
            }
        }
        // u from C u = D v + rate²
        let mut u = [0.0; ANGLES];
        for l in 0..ANGLES {
            let left = if l > 0 { -sine[l] * v[l - 1] } else { 0.0 };
            let right = if l + 1 < ANGLES { sine[l + 1] * v[l + 1] } else { 0.0 };
            u[l] = left + right + rate[l] * rate[l];
        }
        let mut pivot = diagonal;
        for l in 1..ANGLES {
            let factor = -cosine[l] / pivot[l - 1];
            pivot[l] += factor * cosine[l];
            u[l] -= factor * u[l - 1];
        }
        u[ANGLES - 1] /= pivot[ANGLES - 1];
        for l in (0..ANGLES - 1).rev() {
            u[l] = (u[l] + cosine[l + 1] * u[l + 1]) / pivot[l];
        }
        for l in 0..ANGLES {
            let mut acceleration = diagonal[l] * v[l];
            if l > 0 {
                acceleration += -cosine[l] * v[l - 1] - sine[l] * u[l - 1];
            }
            if l + 1 < ANGLES {
                acceleration += -cosine[l + 1] * v[l + 1] + sine[l + 1] * u[l + 1];
            }
            f[l] = yp[l] - rate[l];
            f[ANGLES + l] = yp[ANGLES + l] - acceleration;
        }
        Ok(())
    })
}
