//! Storage by compression of the fluid relative to storage by walls.

use super::EffectScene;
use super::tubes::FASTEST;
use crate::model::{Compression, Wet};

impl EffectScene<'_> {
    /// Largest share of compression in storage, of bladders and at tube ends.
    pub fn compression_of_fluid(&self) -> f64 {
        self.wet.map_or(0.0, |wet| {
            self.compression_in_bladders(wet)
                .max(self.compression_where_tubes_end(wet))
        })
    }

    /// Largest `A_0 r'/(r a_p)`: storage by compression over storage by bladder walls. Grows with the length of the run
    /// where it changes the stiffness of a vibration.
    fn compression_in_bladders(&self, wet: &Wet) -> f64 {
        // also where the full model omits compression
        let fluid = self.case.fluid.as_ref();
        let compression = fluid.and_then(Compression::new);
        let softness = compression.map_or(0.0, |compression| compression.compressibility(-self.scales.pressure));
        let bladders = (0..wet.storage.len()).filter(|bladder| wet.has(*bladder));
        let largest = bladders.map(|bladder| wet.area_of(bladder).at_rest / wet.area_of(bladder).per_pressure);
        let share = softness * largest.fold(0.0, f64::max);
        let [bent, stretched] = self.stiffness_of_fluid(wet);
        share * (1.0 + self.at_once(bent * self.bending + stretched * self.axial) * self.case.time.end_s)
    }

    /// Largest share of compression in the storage at a vessel, or at a junction of tubes with inertia. It is
    /// multiplied by the response of the flow there at its natural frequency `1/√(I C)`. For a vessel, the ratio of its
    /// fluid's storage to that of its walls counts at any frequency.
    fn compression_where_tubes_end(&self, wet: &Wet) -> f64 {
        let fluid = self.case.fluid.as_ref();
        let Some(compression) = fluid.and_then(Compression::new) else {
            return 0.0;
        };
        let softness = compression.compressibility(-self.scales.pressure);
        let ends = wet.network.tube_ends().into_iter();
        ends.map(|end| {
            let walls = end.vessel.as_ref().map_or(0.0, |law| self.stiffest(law));
            let held = end.vessel.as_ref().map_or(0.0, |law| law.volume_at_rest()) * softness;
            let stored = held + end.in_tubes * softness;
            let departure = match end.check_valve {
                true => 1.0,
                false => self
                    .departure_of_flow((end.inertance * stored).sqrt().recip().min(FASTEST))
                    .min(1.0),
            };
            let share = |part: f64| if part > 0.0 { part / (part + walls) } else { 0.0 };
            let at_rest = if walls > 0.0 { held / walls } else { 0.0 };
            at_rest.max(departure * share(stored))
        })
        .fold(0.0, f64::max)
    }
}
