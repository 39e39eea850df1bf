//! Finite-strain laws of a solid, split into shape and volume changes.
//!
//! ```text
//! energy  W = shape(F) + K/2 theta^2,   small strains: 2 mu e:e / 2 and theta = tr eps                     [F1]
//! neo-Hookean            shape = mu/2 (I1b - 3)                                         theta = J - 1
//! Mooney-Rivlin          shape = mu/2 ((1 - s)(I1b - 3) + s (I2b - 3))                  theta = J - 1
//! Yeoh                   shape = mu/2 ((I1b - 3) + a (I1b - 3)^2 + b (I1b - 3)^3)       theta = J - 1
//! Saint-Venant-Kirchhoff shape = mu (E:E - (tr E)^2/3)                                  theta = tr E
//! ```
//!
//! I1b = I1 J^(-2/3), I2b = I2 J^(-4/3), E = (F^T F - 1)/2. At small strain every law has the section's mu and K. The
//! last law is that of the paper's finite elements (A.4): linear, with geometric nonlinearity. It softens without bound
//! under compression.

use super::jet::Jet;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A law of the solid at finite strain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Law {
    /// Treloar's.
    NeoHookean,
    /// Mooney's and Rivlin's.
    MooneyRivlin {
        /// Part of the shear modulus in the second invariant, s.
        second: f64,
    },
    /// Yeoh's.
    Yeoh {
        /// Second coefficient over the first, a.
        second: f64,
        /// Third coefficient over the first, b.
        third: f64,
    },
    /// Linear between the second Piola-Kirchhoff stress and Green's strain.
    SaintVenantKirchhoff,
}

impl Law {
    /// Shape energy over mu, and theta, for a deformation gradient (zz, zx, xz, xx, yy). None unless J is positive.
    pub fn at(&self, f: [f64; 5]) -> Option<[Jet; 2]> {
        let [a, b, c, d, y] = std::array::from_fn(|k| Jet::variable(k, f[k]));
        let plane = a * d - b * c;
        let j = plane * y;
        if j.v <= 0.0 || y.v <= 0.0 {
            return None;
        }
        let t = a * a + b * b + c * c + d * d;
        let yy = y * y;
        let (one, i1) = (Jet::constant(1.0), t + yy);
        let i2 = || plane * plane + yy * t;
        let first = || i1 * j.power(-2.0 / 3.0) - one * 3.0;
        let shape = match self {
            Law::NeoHookean => first() * 0.5,
            Law::MooneyRivlin { second } => {
                first() * (0.5 * (1.0 - second)) + (i2() * j.power(-4.0 / 3.0) - one * 3.0) * (0.5 * second)
            }
            Law::Yeoh { second, third } => {
                let x = first();
                (x + x * x * *second + x * x * x * *third) * 0.5
            }
            Law::SaintVenantKirchhoff => {
                let trace = (i1 - one * 3.0) * 0.5;
                // 4 E:E = tr C^2 - 2 tr C + 3 and tr C^2 = I1^2 - 2 I2.
                let square = (i1 * i1 - i2() * 2.0 - i1 * 2.0 + one * 3.0) * 0.25;
                return Some([square - trace * trace * (1.0 / 3.0), trace]);
            }
        };
        Some([shape, j - one])
    }

    /// Energy density of a bar without lateral stress, and its first two derivatives by the axial stretch. None if no
    /// lateral stretch is in equilibrium.
    pub fn bar(&self, mu: f64, bulk: f64, stretch: f64) -> Option<[f64; 3]> {
        // Newton's iteration for the lateral stretch b, from the small-strain value.
        let nu = (3.0 * bulk - 2.0 * mu) / (2.0 * (3.0 * bulk + mu));
        let mut b = stretch.powf(-nu);
        for _ in 0..50 {
            let [shape, theta] = self.at([stretch, 0.0, 0.0, b, b])?;
            let w = shape * mu + theta * theta * (0.5 * bulk);
            let force = w.g[3] + w.g[4];
            let stiffness = w.h[3][3] + 2.0 * w.h[3][4] + w.h[4][4];
            let cross = w.h[0][3] + w.h[0][4];
            if force.abs() <= 1e-13 * stiffness {
                // the last correction of b to first order: at small stretches it is as large as the nonlinear part of the stress
                let rest = force / stiffness;
                let stress = w.g[0] - cross * rest;
                return Some([w.v - 0.5 * force * rest, stress, w.h[0][0] - cross * cross / stiffness]);
            }
            b -= force / stiffness;
            if b <= 0.0 {
                return None;
            }
        }
        None
    }
}
