//! Area of one bladder as a function of pressure, bending moment and normal force.

use super::Section;
use crate::case::schema::{Bladders, Case, Coupling as CouplingChoice};
use crate::numerics::Scalar;

/// `[E2]` (A.15, A.16) in closed form, R = +1 for the upper row, -1 for the lower:
///
/// ```text
/// a1 = a_p p + R A_M(M) + A_N(N)
/// R A_M(M) = R am M - dm σ(M)    am = (aM+ + aM-)/2    dm = (aM+ - aM-)/2
///   A_N(N) =   an N - dn σ(N)    an = (aN+ + aN-)/2    dn = (aN+ - aN-)/2
/// σ(X) = √(X² + d²) - d                    smooths |X| over the width d
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLaw {
    /// `a_p` [m^2/Pa].
    pub per_pressure: f64,
    /// `1/a_p` [Pa/m^2].
    pub per_area: f64,
    /// `am` [m^2/(N m)].
    pub moment_mean: f64,
    /// `dm` [m^2/(N m)].
    pub moment_half_difference: f64,
    /// `an` [m^2/N].
    pub force_mean: f64,
    /// `dn` [m^2/N].
    pub force_half_difference: f64,
    /// Width of the kink in M [N m].
    pub moment_width: f64,
    /// Width of the kink in N [N].
    pub force_width: f64,
    /// `A_0`, cross-section at rest [m^2].
    pub at_rest: f64,
}

impl AreaLaw {
    /// Area law of the case's bladders. The half differences are zero without `asymmetry`, and with the reciprocal
    /// coupling, whose potential is convex only with mean slopes.
    pub fn new(case: &Case, bladders: &Bladders, section: &Section, asymmetry: bool) -> Self {
        let m = &bladders.area_per_moment_m2_per_n_m;
        let n = &bladders.area_per_force_m2_per_n;
        let kinked = asymmetry && bladders.coupling != CouplingChoice::Reciprocal;
        let half = if kinked { 0.5 } else { 0.0 };
        Self {
            per_pressure: bladders.area_per_pressure_m2_per_pa,
            per_area: 1.0 / bladders.area_per_pressure_m2_per_pa,
            moment_mean: 0.5 * (m.closing + m.opening),
            moment_half_difference: half * (m.closing - m.opening),
            force_mean: 0.5 * (n.compression + n.tension),
            force_half_difference: half * (n.compression - n.tension),
            moment_width: bladders.kink_width * section.bending_stiffness / case.beam.length_m,
            force_width: bladders.kink_width * section.axial_stiffness,
            at_rest: bladders.height_m * bladders.width_m,
        }
    }

    /// The law without the slopes by moment or by force.
    pub fn without(self, moment: bool, force: bool) -> Self {
        let mut law = self;
        if moment {
            (law.moment_mean, law.moment_half_difference) = (0.0, 0.0);
        }
        if force {
            (law.force_mean, law.force_half_difference) = (0.0, 0.0);
        }
        law
    }

    /// `A_N(N)` [m^2].
    #[inline]
    pub fn of_force<T: Scalar>(&self, force: T) -> T {
        force * self.force_mean - kink(force, self.force_width) * self.force_half_difference
    }

    /// `R A_M(M)` [m^2].
    #[inline]
    pub fn of_moment<T: Scalar>(&self, moment: T, row: f64) -> T {
        moment * (row * self.moment_mean) - kink(moment, self.moment_width) * self.moment_half_difference
    }

    /// `A_N'(N)` [m^2/N].
    #[inline]
    pub fn force_slope<T: Scalar>(&self, force: T) -> T {
        -(kink_slope(force, self.force_width) * self.force_half_difference) + self.force_mean
    }

    /// `(R A_M)'(M)` [m^2/(N m)].
    #[inline]
    pub fn moment_slope<T: Scalar>(&self, moment: T, row: f64) -> T {
        -(kink_slope(moment, self.moment_width) * self.moment_half_difference) + row * self.moment_mean
    }

    /// Pressure of a cell with area change `area`; `imposed` is the part caused by bending and force.
    #[inline]
    pub fn pressure<T: Scalar>(&self, area: T, imposed: T) -> T {
        (area - imposed) * self.per_area
    }
}

/// `x · C⁻¹ x` for the areas per pressure of both rows, `C = [a_p,u a_x; a_x a_p,d]`.
pub fn over_compliance(own: [f64; 2], other: f64, x: [f64; 2]) -> f64 {
    let [upper, lower] = own;
    (lower * x[0] * x[0] - 2.0 * other * x[0] * x[1] + upper * x[1] * x[1]) / (upper * lower - other * other)
}

/// `σ(X) = √(X² + d²) - d`.
#[inline]
pub fn kink<T: Scalar>(x: T, width: f64) -> T {
    (x.squared() + width * width).sqrt() - width
}

/// `σ'(X) = X/√(X² + d²)`.
#[inline]
pub fn kink_slope<T: Scalar>(x: T, width: f64) -> T {
    x / (x.squared() + width * width).sqrt()
}

/// `σ''(X) = d²/(X² + d²)^(3/2)`.
#[inline]
pub fn kink_curvature(x: f64, width: f64) -> f64 {
    let squared = x * x + width * width;
    width * width / (squared * squared.sqrt())
}
