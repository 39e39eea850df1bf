//! Strains of the beam caused by pressure.

use super::AreaLaw;
use crate::case::schema::{Beam, Bladders, Coupling as Choice};
use crate::numerics::Scalar;

/// `[E3]` Stretch and curvature caused by pressure (A.22-A.26). `p_u` and `p_d` are mean pressures of upper and lower
/// bladder:
///
/// ```text
/// published    λ_p =  φ_b ζ' (p_u + p_d)/E              α_p = -φ_b ψ' (p_d - p_u)/E
/// reciprocal   λ_p =  φ_b l_b Σ_R A_N'(N) p_R           α_p =  φ_b l_b Σ_R (R A_M)'(M) p_R
/// ```
///
/// with the areas of each row's own law.
///
/// The reciprocal law and the areas derive from one potential g*(N, M, p), which conserves energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CouplingLaw {
    /// The paper's coefficients.
    Published {
        /// `φ_b ζ'/E` [1/Pa].
        stretch_per_pressure: f64,
        /// `φ_b ψ'/E` [1/(m Pa)].
        curvature_per_pressure: f64,
    },
    /// From the potential.
    Reciprocal {
        /// `φ_b l_b` [1].
        length_ratio: f64,
    },
}

impl CouplingLaw {
    /// Coupling of bladders in a beam.
    pub fn new(beam: &Beam, bladders: &Bladders) -> Self {
        let density = bladders.per_row as f64 / beam.length_m;
        match &bladders.coupling {
            Choice::Published(c) => Self::Published {
                stretch_per_pressure: density * c.length_per_pressure_m / beam.young_modulus_pa,
                curvature_per_pressure: density * c.slope_per_pressure_rad / beam.young_modulus_pa,
            },
            Choice::Reciprocal | Choice::ReciprocalKinked => Self::Reciprocal {
                length_ratio: density * bladders.length_m,
            },
        }
    }

    /// The law without curvature or stretch by pressure; only the published form has coefficients to omit.
    pub fn without(self, curvature: bool, stretch: bool) -> Self {
        match self {
            Self::Published {
                stretch_per_pressure,
                curvature_per_pressure,
            } => Self::Published {
                stretch_per_pressure: if stretch { 0.0 } else { stretch_per_pressure },
                curvature_per_pressure: if curvature { 0.0 } else { curvature_per_pressure },
            },
            Self::Reciprocal { .. } => self,
        }
    }

    /// `λ_p` [1].
    #[inline]
    pub fn stretch<T: Scalar>(&self, laws: &[AreaLaw; 2], force: T, upper: T, lower: T) -> T {
        match *self {
            Self::Published {
                stretch_per_pressure, ..
            } => (upper + lower) * stretch_per_pressure,
            Self::Reciprocal { length_ratio } => {
                // of equal rows exactly the slope times the sum of the pressures
                let [above, below] = [0, 1].map(|row| laws[row].force_slope(force));
                ((above + below) * 0.5 * (upper + lower) + (above - below) * 0.5 * (upper - lower)) * length_ratio
            }
        }
    }

    /// `α_p` [1/m].
    #[inline]
    pub fn curvature<T: Scalar>(&self, laws: &[AreaLaw; 2], moment: T, upper: T, lower: T) -> T {
        match *self {
            Self::Published {
                curvature_per_pressure, ..
            } => (upper - lower) * curvature_per_pressure,
            Self::Reciprocal { length_ratio } => {
                (laws[0].moment_slope(moment, 1.0) * upper + laws[1].moment_slope(moment, -1.0) * lower) * length_ratio
            }
        }
    }
}
