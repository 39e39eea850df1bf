//! Check valves and relief valves, which open under a pressure drop.

use crate::case::schema::CheckValve as Written;
use crate::numerics::{Scalar, ramp};

/// `[E7]` A valve that opens at its cracking pressure `p_c ≥ 0`, over a pressure range w:
///
/// ```text
/// q(Δ) = G_r Δ + (G_f - G_r) s(Δ - p_c)        s(x) = 0 below 0,  x²/(2w) up to w,  x - w/2 beyond
/// ```
///
/// The slope is continuous, between `G_r` and `G_f`. The valve dissipates: `q(0) = 0` and `q Δ ≥ 0`. The law is
/// piecewise linear or quadratic, so its inverse and its series with a resistance have closed forms. A relief valve is
/// a check valve with a high cracking pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckValveLaw {
    /// `p_c` [Pa].
    pub cracking_pressure: f64,
    /// `G_f` [m^3/(s Pa)].
    pub forward: f64,
    /// `G_r` [m^3/(s Pa)].
    pub reverse: f64,
    /// `w` [Pa].
    pub width: f64,
}

impl From<&Written> for CheckValveLaw {
    fn from(written: &Written) -> Self {
        Self {
            cracking_pressure: written.cracking_pressure_pa,
            forward: written.forward_conductance_m3_s_pa,
            reverse: written.reverse_conductance_m3_s_pa,
            width: written.smoothing_pa,
        }
    }
}

impl CheckValveLaw {
    /// Flow under a pressure drop.
    #[inline]
    pub fn flow<T: Scalar>(&self, drop: T) -> T {
        drop.lift(|drop| self.at(drop))
    }

    /// Flow under the pressure drop over the valve and a resistance [Pa s/m^3] in series.
    #[inline]
    pub fn flow_behind<T: Scalar>(&self, resistance: f64, drop: T) -> T {
        drop.lift(|drop| self.behind(resistance, drop))
    }

    /// Flow and its slope under the pressure drop over the valve and a resistance [Pa s/m^3] in series.
    pub fn flow_and_slope(&self, resistance: f64, drop: f64) -> (f64, f64) {
        self.behind(resistance, drop)
    }

    /// Pressure drop at a flow.
    #[inline]
    pub fn drop<T: Scalar>(&self, flow: T) -> T {
        flow.lift(|flow| {
            let drop = self.drop_of(flow);
            (drop, 1.0 / self.at(drop).1)
        })
    }

    /// True if the valve is shut at a flow, except for leakage.
    pub fn is_shut(&self, flow: f64) -> bool {
        flow <= self.reverse * self.cracking_pressure
    }

    fn behind(&self, resistance: f64, drop: f64) -> (f64, f64) {
        let (flow, slope) = self.at(self.share(resistance, drop));
        (flow, slope / (1.0 + resistance * slope))
    }

    /// Flow and its slope.
    fn at(&self, drop: f64) -> (f64, f64) {
        let more = self.forward - self.reverse;
        let (open, share) = ramp(drop - self.cracking_pressure, self.width);
        (self.reverse * drop + more * open, self.reverse + more * share)
    }

    /// Pressure drop over the valve in series with a resistance R: the root of `x + R q(x) = Δ`.
    fn share(&self, resistance: f64, drop: f64) -> f64 {
        self.root(1.0, resistance, drop)
    }

    /// Root of `q(x) = q`.
    fn drop_of(&self, flow: f64) -> f64 {
        self.root(0.0, 1.0, flow)
    }

    /// Root of `a x + b q(x) = c`, piecewise.
    fn root(&self, a: f64, b: f64, c: f64) -> f64 {
        let (shut, begin) = (a + b * self.reverse, self.cracking_pressure);
        let over = c - shut * begin;
        if over <= 0.0 {
            return c / shut;
        }
        // shut x + half x² = over, x measured from the cracking pressure
        let half = 0.5 * b * (self.forward - self.reverse) / self.width;
        let x = 2.0 * over / (shut + (shut * shut + 4.0 * half * over).sqrt());
        if x < self.width {
            return begin + x;
        }
        let open = a + b * self.forward;
        begin + (over + half * self.width * self.width) / open
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::Dual;

    const VALVES: [CheckValveLaw; 3] = [
        CheckValveLaw {
            cracking_pressure: 0.0,
            forward: 1e-9,
            reverse: 1e-15,
            width: 10.0,
        },
        CheckValveLaw {
            cracking_pressure: 2e3,
            forward: 3e-10,
            reverse: 1e-12,
            width: 500.0,
        },
        CheckValveLaw {
            cracking_pressure: 1.0,
            forward: 1e-9,
            reverse: 1e-9,
            width: 1.0,
        },
    ];
    const DROPS: [f64; 12] = [-1e6, -3e3, -1.0, 0.0, 1e-9, 0.5, 5.0, 10.0, 2e3, 2.2e3, 2.5e3, 1e6];

    /// Goal: the drops over valve and resistance add up, and the inverse is exact, in all pieces and at their
    /// boundaries.
    #[test]
    fn roots_are_roots() {
        for valve in VALVES {
            for drop in DROPS {
                let flow = valve.flow(drop);
                assert!(flow * drop >= 0.0);
                let back: f64 = valve.drop(flow);
                assert!(
                    (back - drop).abs() <= 1e-9 * (drop.abs() + 1.0),
                    "{valve:?} {drop}: {back}"
                );
                for resistance in [0.0, 1e6, 1e9, 1e13] {
                    let q: f64 = valve.flow_behind(resistance, drop);
                    let left = drop - resistance * q;
                    let off = valve.flow(left) - q;
                    // rounding error of the flow from that of the larger drop
                    let noise = 1e-14 * (drop.abs() + resistance * q.abs()) * valve.forward;
                    assert!(
                        off.abs() <= noise + 1e-12 * q.abs(),
                        "{valve:?} {drop} {resistance}: {off:e} of {q:e}"
                    );
                }
            }
        }
    }

    /// Goal: slopes are derivatives, away from the piece boundaries, where they are continuous.
    #[test]
    fn slopes_are_derivatives() {
        for valve in VALVES {
            for drop in DROPS.into_iter().filter(|drop| drop.abs() > 1e-6) {
                let h = 1e-6 * drop;
                let along = |function: &dyn Fn(Dual<1>) -> Dual<1>, at: f64| {
                    function(Dual {
                        value: at,
                        derivative: [1.0],
                    })
                    .derivative[0]
                };
                let flow = |x: f64| -> f64 { valve.flow_behind(1e9, x) };
                let slope = along(&|x| valve.flow_behind(1e9, x), drop);
                let difference = (flow(drop + h) - flow(drop - h)) / (2.0 * h);
                assert!(
                    (slope / difference - 1.0).abs() < 1e-2,
                    "{valve:?} {drop}: {slope:e} {difference:e}"
                );
                let q = valve.flow(drop);
                let product = along(&|q| valve.drop(q), q) * along(&|x| valve.flow(x), drop);
                assert!((product - 1.0).abs() < 1e-6, "{valve:?} {drop}: {product}");
            }
        }
    }
}
