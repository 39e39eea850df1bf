//! Content of network vessels with compressible or incompressible fluid.

use super::Wet;
use super::network::{AccumulatorElement, AccumulatorLaw};
use crate::numerics::Scalar;

/// Error of Poiseuille's profile in a mode above which unsteady friction is included.
const MEMORY: f64 = 1e-3;

/// `[E67]` A vessel with the wall law V(p), [E60], and the fluid volume V_0 at ambient pressure. Its content c is
/// counted beyond V_0 at ambient density, like the content of cells, [E54]:
///
/// ```text
/// c = r(p) (V_0 + V(p)) - V_0      dc/dt = Σ q      E = E_walls(V) + (V_0 + V) (r h - p)      dE = h dc
/// ```
///
/// Incompressible fluid has `c = V`.
impl Wet {
    /// Pressure at a content.
    #[inline]
    pub fn vessel_pressure<T: Scalar>(&self, law: &AccumulatorLaw, content: T) -> T {
        match &self.compression {
            None => law.pressure(content),
            Some(compression) => compression.in_vessel(law, content),
        }
    }

    /// Content at a pressure [m^3].
    pub fn vessel_content(&self, law: &AccumulatorLaw, pressure: f64) -> f64 {
        match &self.compression {
            None => law.volume(pressure),
            Some(compression) => {
                let at_rest = law.volume_at_rest();
                compression.density(pressure).0 * (at_rest + law.volume(pressure)) - at_rest
            }
        }
    }

    /// Compliance at a pressure [m^3/Pa].
    pub fn vessel_compliance(&self, law: &AccumulatorLaw, pressure: f64) -> f64 {
        match &self.compression {
            None => law.compliance(pressure),
            Some(compression) => {
                let (density, slope) = compression.density(pressure);
                slope * (law.volume_at_rest() + law.volume(pressure)) + density * law.compliance(pressure)
            }
        }
    }

    /// True if fluid in a tube oscillates against a vessel too fast for Poiseuille's profile: `Wo⁴/1152` above
    /// [`MEMORY`], `Wo² = r²/(ν √(I C))`.
    pub(super) fn swings_fast(&self) -> bool {
        let fast = |one: &AccumulatorElement| {
            let compliance = self.vessel_compliance(&one.law, 0.0);
            self.network
                .tubes_at(one.junction)
                .filter_map(|link| link.tube)
                .any(|tube| {
                    let womersley_squared = 1.0 / (tube.viscous_rate * (tube.law.inertance * compliance).sqrt());
                    womersley_squared * womersley_squared / 1152.0 > MEMORY
                })
        };
        self.network.accumulators.iter().any(fast)
    }

    /// Energy of the walls and of the compressed content, at a content and a pressure [J].
    pub fn vessel_energy(&self, law: &AccumulatorLaw, content: f64, pressure: f64) -> [f64; 2] {
        let Some(compression) = &self.compression else {
            return [law.energy(content), 0.0];
        };
        let (volume, density) = (law.volume(pressure), compression.density(pressure).0);
        let of_fluid = density * compression.enthalpy(pressure) - pressure;
        [law.energy(volume), (law.volume_at_rest() + volume) * of_fluid]
    }
}
