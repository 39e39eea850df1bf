//! Accumulators: vessels that store fluid under pressure.

use std::sync::Arc;

use super::{PressureVolumeCurve, ResolvedNetwork};
use crate::case::schema::{Accumulator as Written, AccumulatorKind};
use crate::numerics::Scalar;

/// `[E60]` An accumulator at a junction. Its volume V beyond that at ambient pressure replaces the junction's pressure
/// p as unknown:
///
/// ```text
/// dV/dt = Σ q
/// elastic   p = V/C                                    E = V²/(2C)
/// gas       p = p_0 ((1 - V/V_0)^-n - 1)               E = p_0 V_0 (((1 - V/V_0)^(1-n) - 1)/(n - 1) - V/V_0)
/// rigid     V = 0                                      E = 0
/// curve     p = P(V)                                   E = ∫ P dV, [E102]
/// ```
///
/// `V_0` is the gas volume at ambient pressure `p_0`; the gas obeys `p_abs V^n` = const. For `n = 1`,
/// `E = -p_0 V_0 (ln(1 - V/V_0) + V/V_0)`. E is the work `∫ p dV`: an accumulator dissipates nothing. For compressible
/// fluid see [`crate::model::Compression::in_vessel`]; a rigid tank stores only compressed fluid.
#[derive(Clone, Debug, PartialEq)]
pub struct AccumulatorElement {
    /// Name.
    pub name: String,
    /// Index of its junction.
    pub junction: usize,
    /// Gauge pressure at the start [Pa].
    pub start_pressure: f64,
    /// Law.
    pub law: AccumulatorLaw,
}

/// Pressure of an accumulator as a function of its volume.
#[derive(Clone, Debug, PartialEq)]
pub enum AccumulatorLaw {
    /// Elastic walls.
    Elastic {
        /// `C` [m^3/Pa].
        compliance: f64,
        /// Fluid volume at ambient pressure [m^3], used for compressible fluid.
        holds: f64,
    },
    /// A tank with rigid walls.
    Rigid {
        /// Fluid volume at ambient pressure [m^3].
        holds: f64,
    },
    /// Gas above the fluid.
    Gas {
        /// `V_0` [m^3].
        volume: f64,
        /// `p_0`, absolute [Pa].
        ambient: f64,
        /// `n`.
        exponent: f64,
        /// Fluid volume of tubes that end in it, at ambient pressure [m^3], used for compressible fluid.
        holds: f64,
    },
    /// Points of pressure over volume; the fluid is incompressible.
    Curve(Arc<PressureVolumeCurve>),
}

impl AccumulatorLaw {
    /// Law of a case's accumulator; `ambient` is the absolute ambient pressure [Pa].
    pub(super) fn new(written: &Written, ambient: f64) -> Self {
        match &written.kind {
            &AccumulatorKind::Elastic {
                compliance_m3_pa,
                volume_m3,
            } => Self::Elastic {
                compliance: compliance_m3_pa,
                holds: volume_m3,
            },
            AccumulatorKind::Tank { volume_m3 } => Self::Rigid { holds: *volume_m3 },
            &AccumulatorKind::Gas {
                volume_m3,
                polytropic_exponent,
            } => Self::Gas {
                volume: volume_m3,
                ambient,
                exponent: polytropic_exponent,
                holds: 0.0,
            },
            // the check of the case rejects points of no curve
            AccumulatorKind::Curve { volume_m3, pressure_pa } => {
                match PressureVolumeCurve::through(volume_m3, pressure_pa) {
                    Some(curve) => Self::Curve(Arc::new(curve)),
                    None => Self::Rigid { holds: 0.0 },
                }
            }
        }
    }

    /// Fluid volume at ambient pressure [m^3].
    pub fn volume_at_rest(&self) -> f64 {
        match *self {
            Self::Elastic { holds, .. } | Self::Rigid { holds } | Self::Gas { holds, .. } => holds,
            Self::Curve(_) => 0.0,
        }
    }

    /// Adds fluid volume at ambient pressure [m^3].
    pub fn holding(mut self, more: f64) -> Self {
        if let Self::Elastic { holds, .. } | Self::Rigid { holds } | Self::Gas { holds, .. } = &mut self {
            *holds += more;
        }
        self
    }

    /// Gauge pressure [Pa] at a volume [m^3]. NaN if no gas volume is left, and for a rigid tank.
    #[inline]
    pub fn pressure<T: Scalar>(&self, volume: T) -> T {
        match *self {
            Self::Elastic { compliance, .. } => volume * (1.0 / compliance),
            Self::Rigid { .. } => T::constant(f64::NAN),
            Self::Gas {
                volume: of_gas,
                ambient,
                exponent,
                ..
            } => volume.lift(|volume| {
                let left = 1.0 - volume / of_gas;
                if left <= 0.0 {
                    return (f64::NAN, f64::NAN);
                }
                let logarithm = (-volume / of_gas).ln_1p();
                let pressure = ambient * (-exponent * logarithm).exp_m1();
                (pressure, exponent * (pressure + ambient) / (of_gas * left))
            }),
            Self::Curve(ref curve) => curve.pressure(volume),
        }
    }

    /// Volume [m^3] at a gauge pressure [Pa]; of a curve the smallest.
    pub fn volume(&self, pressure: f64) -> f64 {
        match *self {
            Self::Elastic { compliance, .. } => compliance * pressure,
            Self::Rigid { .. } => 0.0,
            Self::Gas {
                volume,
                ambient,
                exponent,
                ..
            } => -volume * (-(pressure / ambient).ln_1p() / exponent).exp_m1(),
            Self::Curve(ref curve) => curve.volume(pressure),
        }
    }

    /// Compliance dV/dp [m^3/Pa] at a gauge pressure [Pa]; of a curve its mean.
    pub fn compliance(&self, pressure: f64) -> f64 {
        match *self {
            Self::Elastic { compliance, .. } => compliance,
            Self::Rigid { .. } => 0.0,
            Self::Gas {
                volume,
                ambient,
                exponent,
                ..
            } => (volume - self.volume(pressure)) / (exponent * (ambient + pressure)),
            Self::Curve(ref curve) => curve.mean_compliance(),
        }
    }

    /// Stored energy `∫ p dV` from ambient pressure [J].
    pub fn energy(&self, volume: f64) -> f64 {
        match *self {
            Self::Elastic { compliance, .. } => 0.5 * volume * volume / compliance,
            Self::Rigid { .. } => 0.0,
            Self::Gas {
                volume: of_gas,
                ambient,
                exponent,
                ..
            } => {
                let (share, logarithm) = (volume / of_gas, (-volume / of_gas).ln_1p());
                let worked = if exponent == 1.0 {
                    -logarithm
                } else {
                    ((1.0 - exponent) * logarithm).exp_m1() / (exponent - 1.0)
                };
                ambient * of_gas * (worked - share)
            }
            Self::Curve(ref curve) => curve.energy(volume),
        }
    }
}

impl ResolvedNetwork {
    /// Scale of volumes per pressure in a network without bladders [m^3/Pa]: the mean compliance of its accumulators. Without any, it is
    /// the largest conductance times a duration [s].
    pub(in crate::model) fn usual_compliance(&self, time: f64) -> f64 {
        let vessels = self.accumulators.iter().map(|one| one.law.compliance(0.0));
        let sum: f64 = vessels.filter(|compliance| *compliance > 0.0).sum();
        if sum > 0.0 {
            sum / self.accumulators.len() as f64
        } else {
            self.bladder_mobility * time
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::Dual;

    /// Goal: pressure, volume, compliance and energy are consistent.
    #[test]
    fn laws_agree_with_themselves() {
        let gas = |exponent| AccumulatorLaw::Gas {
            volume: 2e-6,
            ambient: 101_325.0,
            exponent,
            holds: 0.0,
        };
        let elastic = AccumulatorLaw::Elastic {
            compliance: 1e-12,
            holds: 0.0,
        };
        for law in [elastic, gas(1.0), gas(1.4)] {
            for pressure in [-9e4, -1e3, 0.0, 1.0, 1e4, 1e6] {
                let volume = law.volume(pressure);
                assert!((law.pressure(volume) - pressure).abs() <= 1e-9 * pressure.abs());
                let slope = law
                    .pressure(Dual {
                        value: volume,
                        derivative: [1.0],
                    })
                    .derivative[0];
                assert!((slope * law.compliance(pressure) - 1.0).abs() < 1e-12);
                let h = 1e-3 * law.compliance(pressure) * 1e3;
                let power = (law.energy(volume + h) - law.energy(volume - h)) / (2.0 * h);
                assert!(
                    (power - pressure).abs() <= 1e-5 * pressure.abs() + 1e-3,
                    "{law:?} {pressure}: {power}"
                );
            }
        }
    }
}
