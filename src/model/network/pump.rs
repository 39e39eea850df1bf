//! Pumps: the pressure that they add, over their flow.

use crate::case::schema::Pump;
use crate::functions::signals::Signal;
use crate::functions::{Interpolation, PiecewiseCurve};
use crate::numerics::Scalar;

/// `[E87]` Pressure that a pump adds in the direction of its tube, and its power, an input:
///
/// ```text
/// linear   p_pump(t) - R_pump q      power p_pump q, of which R_pump q² is lost
/// curve    f(t) P(q)                 power f P q
/// ```
///
/// P consists of monotone cubics through the given points and of straight lines beyond them. The flow through such a pump is an unknown,
/// with the equation [E51] of its tube.
#[derive(Clone, Debug, PartialEq)]
pub struct PumpLaw {
    /// `p_pump`, pressure at zero flow [Pa], or the factor f of the curve.
    pub pressure: Signal,
    /// `R_pump`, decrease of the pressure per flow [Pa s/m^3].
    pub resistance: f64,
    /// `P(q)`; none for a linear pump.
    pub curve: Option<PumpCharacteristic>,
}

/// Pressure of a pump over its flow.
#[derive(Clone, Debug, PartialEq)]
pub struct PumpCharacteristic(PiecewiseCurve);

impl PumpLaw {
    /// Law of a checked pump.
    pub(super) fn new(written: &Pump) -> Self {
        let signal = written
            .signal()
            .map_or(Signal::Constant(0.0), |(_, signal)| signal.clone());
        let curve = written
            .curve
            .as_ref()
            .and_then(|curve| PiecewiseCurve::through(&curve.flow_m3_s, &curve.pressure_pa, Interpolation::Monotone));
        Self {
            pressure: signal,
            resistance: written.resistance_pa_s_m3,
            curve: curve.map(PumpCharacteristic),
        }
    }

    /// Largest pressure between the points of its curve, for a value of its signal [Pa].
    pub fn largest(&self, signal: f64) -> f64 {
        self.curve.as_ref().map_or(signal, |curve| signal * curve.0.largest())
    }

    /// Largest increase of its pressure per flow until `end` [s], in [Pa s/m^3]; 0 for a falling curve.
    pub fn steepest_rise(&self, end: f64) -> f64 {
        let Some(curve) = &self.curve else { return 0.0 };
        let (factor, rates) = (self.pressure.range(0.0, end), curve.0.rates());
        let rises = rates.map(|rate| (factor.low * rate).max(factor.high * rate));
        rises.into_iter().fold(0.0, f64::max)
    }
}

impl PumpCharacteristic {
    /// `P(q)` [Pa].
    #[inline]
    pub fn pressure<T: Scalar>(&self, flow: T) -> T {
        flow.lift(|q| {
            let [first, last] = self.0.ends().unwrap_or_default();
            let within = q.clamp(first, last);
            let jet = self.0.at(within);
            (jet.value + jet.rate * (q - within), jet.rate)
        })
    }
}
