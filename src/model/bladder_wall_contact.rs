//! Contact between the walls of a bladder.

use super::{AreaLaw, Compression};
use crate::case::schema::Closing as Written;
use crate::numerics::Scalar;

/// Share of the touching area below which the law is linear. Only trial states of the solver reach it.
const SHUT: f64 = 1e-3;

/// `[E71]` Walls touch where the cross-section is below the share ε of its value at rest. Their contact pressure grows
/// as the area shrinks:
///
/// ```text
/// p_c = P (ε/x - 1)²  for x = (A_0 + a1)/A_0 < ε, else 0        p = (a1 - R A_M - A_N)/a_p - p_c
/// E gains Σ Δs A_0 P [ε²/x - x + 2 ε ln(x/ε)]
/// ```
///
/// `p + p_c` strains the walls and, through them, the beam. p_c and the contact energy grow without bound as x
/// approaches 0. The area therefore stays positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallClosing {
    /// `ε`.
    below: f64,
    /// `P` [Pa].
    stiffness: f64,
}

impl WallClosing {
    /// Contact law of a case's bladders.
    pub fn new(written: &Written) -> Self {
        Self {
            below: written.below,
            stiffness: written.stiffness_pa,
        }
    }

    /// Area of a bladder below which its walls touch [m^2].
    pub fn touching(&self, law: &AreaLaw) -> f64 {
        self.below * law.at_rest
    }

    /// `p_c` [Pa] and its derivative with respect to the area change [Pa/m^2].
    pub fn at(&self, law: &AreaLaw, area: f64) -> (f64, f64) {
        let x = 1.0 + area / law.at_rest;
        if x >= self.below {
            return (0.0, 0.0);
        }
        let held = x.max(SHUT * self.below);
        let over = self.below / held - 1.0;
        let slope = -2.0 * self.stiffness * over * self.below / (held * held);
        let pressure = self.stiffness * over * over + slope * (x - held);
        (pressure, slope / law.at_rest)
    }

    /// `p_c` at an area change [Pa].
    #[inline(never)] // so that its constants are not made where no walls meet
    pub fn pressure<T: Scalar>(&self, law: &AreaLaw, area: T) -> T {
        area.lift(|area| self.at(law, area))
    }

    /// Contact energy of a cell per length [J/m].
    pub fn energy(&self, law: &AreaLaw, area: f64) -> f64 {
        let (x, e) = (1.0 + area / law.at_rest, self.below);
        if x >= e {
            return 0.0;
        }
        law.at_rest * self.stiffness * (e * e / x - x + 2.0 * e * (x / e).ln())
    }

    /// Area change at a fluid pressure; `imposed` is the part caused by bending and force.
    #[inline]
    pub fn swelling<T: Scalar>(&self, law: &AreaLaw, pressure: T, imposed: T) -> T {
        let a_p = law.per_pressure;
        pressure.lift_with(imposed, |pressure, imposed| {
            let area = self.root(law, a_p * pressure + imposed, |area| {
                let (contact, slope) = self.at(law, area);
                (area - a_p * (pressure + contact) - imposed, 1.0 - a_p * slope)
            });
            let stiffness = 1.0 / (1.0 - a_p * self.at(law, area).1);
            (area, [a_p * stiffness, stiffness])
        })
    }

    /// Area change of a cell with the content `content` of compressible fluid, [E54].
    #[inline]
    pub fn swelling_of<T: Scalar>(&self, law: &AreaLaw, fluid: &Compression, content: T, imposed: T) -> T {
        content.lift_with(imposed, |content, imposed| {
            let open = law.per_pressure * fluid.pressure(law, content, imposed) + imposed;
            let area = self.root(law, open, |area| {
                let (missing, [by_area, _]) = self.missing(law, fluid, area, imposed);
                (missing - content, by_area)
            });
            let (_, [by_area, by_imposed]) = self.missing(law, fluid, area, imposed);
            (area, [1.0 / by_area, -by_imposed / by_area])
        })
    }

    /// `r(p) (A_0 + a1) - A_0` and its derivatives with respect to area change and imposed area.
    pub fn missing(&self, law: &AreaLaw, fluid: &Compression, area: f64, imposed: f64) -> (f64, [f64; 2]) {
        let (contact, slope) = self.at(law, area);
        let (density, by_pressure) = fluid.density((area - imposed) / law.per_pressure - contact);
        let (all, soft) = (law.at_rest + area, 1.0 / law.per_pressure);
        let by_pressure = by_pressure * all;
        (
            density * all - law.at_rest,
            [density + by_pressure * (soft - slope), -by_pressure * soft],
        )
    }

    /// Root of an increasing function by Newton's iteration with bisection. `open` is the root where walls do not
    /// touch.
    fn root(&self, law: &AreaLaw, open: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
        let (mut low, mut high) = (-law.at_rest, law.at_rest * (self.below - 1.0));
        if open >= high {
            return open;
        }
        low = low.min(open);
        let mut area = open.max(0.5 * (high - law.at_rest));
        for _ in 0..100 {
            let (value, slope) = f(area);
            if value > 0.0 {
                high = area;
            } else {
                low = area;
            }
            let newton = area - value / slope;
            let next = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            if (next - area).abs() <= 1e-15 * law.at_rest {
                return next;
            }
            area = next;
        }
        area
    }
}
