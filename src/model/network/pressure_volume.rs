//! Pressure of a vessel over its volume, from points.

use crate::functions::{Interpolation, PiecewiseCurve};
use crate::numerics::Scalar;

/// Halvings of a piece of the curve in the search for a pressure.
const HALVINGS: usize = 200;

/// `[E102]` Vessel whose pressure P(V) may fall with its volume, as in a dome or a balloon that snaps:
///
/// ```text
/// p = P(V)      E = ∫ P dV from 0 to V
/// ```
///
/// P consists of monotone cubics through the given points and of straight lines beyond them. Extrema of P are points, so that a vessel
/// snaps at exactly the given pressures. A pressure between them belongs to several volumes; V is the unknown, [E60].
#[derive(Clone, Debug, PartialEq)]
pub struct PressureVolumeCurve {
    curve: PiecewiseCurve,
    /// Points: volume [m^3] and `∫ P dV` from the first point [J].
    works: Vec<[f64; 2]>,
    /// `∫ P dV` from the first point to zero volume [J].
    at_rest: f64,
}

impl PressureVolumeCurve {
    /// Curve through volumes [m^3], ascending, and pressures [Pa]; none if these are not the points of a curve.
    pub fn through(volumes: &[f64], pressures: &[f64]) -> Option<Self> {
        let curve =
            PiecewiseCurve::through(volumes, pressures, Interpolation::Monotone).filter(|_| volumes.len() > 1)?;
        let mut found = Self {
            curve,
            works: vec![[volumes[0], 0.0]],
            at_rest: 0.0,
        };
        for pair in volumes.windows(2) {
            let work = found.work(pair[1]);
            found.works.push([pair[1], work]);
        }
        found.at_rest = found.work(0.0);
        Some(found)
    }

    /// First and last volume of the points [m^3].
    fn ends(&self) -> [f64; 2] {
        self.curve.ends().unwrap_or_default()
    }

    /// Range of the volumes of the points [m^3].
    pub fn range(&self) -> f64 {
        let [first, last] = self.ends();
        last - first
    }

    /// `P(V)` [Pa].
    #[inline]
    pub fn pressure<T: Scalar>(&self, volume: T) -> T {
        volume.lift(|volume| self.at(volume))
    }

    /// Pressure and slope at a volume.
    fn at(&self, volume: f64) -> (f64, f64) {
        let [first, last] = self.ends();
        let within = volume.clamp(first, last);
        let jet = self.curve.at(within);
        (jet.value + jet.rate * (volume - within), jet.rate)
    }

    /// `∫ P dV` from the first point [J], exact: two Gauss points integrate a cubic. Only the points before the volume are used.
    fn work(&self, volume: f64) -> f64 {
        let before = self.works.partition_point(|[at, _]| *at <= volume).max(1) - 1;
        let [from, work] = self.works[before];
        let (middle, half) = (0.5 * (from + volume), 0.5 * (volume - from));
        let offset = half / 3.0_f64.sqrt();
        work + half * (self.at(middle - offset).0 + self.at(middle + offset).0)
    }

    /// Stored energy [J].
    pub fn energy(&self, volume: f64) -> f64 {
        self.work(volume) - self.at_rest
    }

    /// Smallest volume with a pressure [m^3]; NaN without one.
    pub fn volume(&self, pressure: f64) -> f64 {
        let below = |volume: f64| self.at(volume).0 < pressure;
        let [first, last] = self.ends();
        let straight = |end: f64| {
            let (value, slope) = self.at(end);
            if slope > 0.0 {
                end + (pressure - value) / slope
            } else {
                f64::NAN
            }
        };
        if !below(first) {
            return straight(first);
        }
        let Some(pair) = self.works.windows(2).find(|pair| !below(pair[1][0])) else {
            return straight(last);
        };
        let [mut low, mut high] = [pair[0][0], pair[1][0]];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            *(if below(middle) { &mut low } else { &mut high }) = middle;
        }
        high
    }

    /// Range of volume over range of pressure of the points, a mean compliance [m^3/Pa].
    pub fn mean_compliance(&self) -> f64 {
        let pressures = || self.works.iter().map(|[volume, _]| self.at(*volume).0);
        let range = pressures().fold(f64::MIN, f64::max) - pressures().fold(f64::MAX, f64::min);
        self.range() / range
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::Dual;

    /// Goal: the pressure is the derivative of the energy, its slope that of the pressure, energy is zero at zero volume, and the volume of
    /// a pressure is the smallest one, at points, between them and beyond them.
    #[test]
    fn energy_pressure_and_slope_agree() {
        let curve = PressureVolumeCurve::through(
            &[-1e-7, 0.0, 2e-7, 6e-7, 9e-7, 1.2e-6],
            &[-2e3, 0.0, 5e3, 1e3, 4e3, 9e3],
        )
        .unwrap();
        assert_eq!(curve.energy(0.0), 0.0);
        for volume in [-3e-7, -0.5e-7, 1e-7, 1.9e-7, 4e-7, 7e-7, 1.1e-6, 2e-6] {
            let h = 1e-10;
            let (pressure, slope) = curve.at(volume);
            let power = (curve.energy(volume + h) - curve.energy(volume - h)) / (2.0 * h);
            assert!(
                (power - pressure).abs() < 1e-4 * pressure.abs(),
                "{volume}: {power} {pressure}"
            );
            let difference = (curve.at(volume + h).0 - curve.at(volume - h).0) / (2.0 * h);
            assert!(
                (difference / slope - 1.0).abs() < 1e-4,
                "{volume}: {difference} {slope}"
            );
            let dual = curve.pressure(Dual {
                value: volume,
                derivative: [1.0],
            });
            assert_eq!((dual.value, dual.derivative[0]), (pressure, slope));
        }
        for (pressure, most) in [
            (-4e3, -1e-7),
            (-1e3, 0.0),
            (3e3, 2e-7),
            (5e3, 2e-7),
            (6e3, 1.2e-6),
            (2e4, 1.0),
        ] {
            let volume = curve.volume(pressure);
            assert!(volume <= most && (curve.at(volume).0 - pressure).abs() < 1e-9 * pressure.abs());
        }
    }
}
