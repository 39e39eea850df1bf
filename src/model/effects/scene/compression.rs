//! What compression of the fluid stores over what walls store.

use super::Scene;
use super::tubes::FASTEST;
use crate::model::{Compression, Wet};

impl Scene<'_> {
    /// The larger share of compression in storage, of bladders and where tubes end.
    pub fn compression_of_fluid(&self) -> f64 {
        self.wet.map_or(0.0, |wet| {
            self.compression_in_bladders(wet)
                .max(self.compression_where_tubes_end(wet))
        })
    }

    /// `A_0 r'/(r a_p)`, at most: what compression stores over what the walls of bladders do; over the whole run where it changes the
    /// stiffness of what vibrates.
    fn compression_in_bladders(&self, wet: &Wet) -> f64 {
        // whether or not the whole model has it, which takes inertia in tubes instead
        let fluid = self.case.fluid.as_ref();
        let compression = fluid.and_then(|fluid| Compression::new(fluid, wet.area_at_rest));
        let stored = compression.map_or(0.0, |compression| compression.compliance(-self.scales.pressure));
        let share = stored / wet.area.per_pressure;
        let [bent, stretched] = self.stiffness_of_fluid(wet);
        share * (1.0 + self.at_once(bent * self.bending + stretched * self.axial) * self.case.time.end_s)
    }

    /// Share of compression in what stores at a vessel or where tubes with inertia alone meet, at most, times the departure from rest that the
    /// scene causes at the frequency of the fluid there, `1/√(I C)`; in a vessel also its own fluid over its walls, at any frequency.
    fn compression_where_tubes_end(&self, wet: &Wet) -> f64 {
        let fluid = self.case.fluid.as_ref();
        let Some(compression) = fluid.and_then(|fluid| Compression::new(fluid, 1.0)) else {
            return 0.0;
        };
        let softness = compression.compliance(-self.scales.pressure);
        let ends = wet.network.tube_ends().into_iter();
        ends.map(|end| {
            let walls = end.vessel.map_or(0.0, |law| self.stiffest(&law));
            let held = end.vessel.map_or(0.0, |law| law.volume_at_rest()) * softness;
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
