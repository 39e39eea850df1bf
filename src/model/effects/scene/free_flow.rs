//! Free flow: stored pressure released at the start, and flow through a network.

use super::EffectScene;
use crate::model::network::{AccumulatorLaw, NetworkNode, PressurePort};
use crate::model::{ResolvedNetwork, Wet};

/// Storage of a network component, and its through flow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circuit {
    /// Smallest compliance of its bladders and vessels [m^3/Pa]; 0 without any.
    pub least: f64,
    /// Largest compliance [m^3/Pa].
    pub most: f64,
    /// True if bladders do not bound the flows: vessels, pumps or ports of different pressures also drive them.
    pub through: bool,
}

impl Circuit {
    /// Circuit of a tube between two ports.
    pub const BETWEEN_PORTS: Self = Self {
        least: 0.0,
        most: 0.0,
        through: true,
    };
}

impl EffectScene<'_> {
    /// True if the run begins with unbalanced pressure in bladders or accumulators. If `bladders` is true, only
    /// accumulators joined to bladders count.
    pub(super) fn begins_pressed(&self, bladders: bool) -> bool {
        if self.case.start.equilibrium.is_some() {
            return false;
        }
        let joined =
            |n: &ResolvedNetwork, junction: usize| n.component_of_bladder.contains(&n.component_of_junction[junction]);
        let charged = |n: &ResolvedNetwork| {
            let mut vessels = n.accumulators.iter().filter(|one| one.start_pressure != 0.0);
            vessels.any(|one| !bladders || joined(n, one.junction))
        };
        !self.case.start.pressures.is_empty() || self.network().is_some_and(charged)
    }

    /// Upper bound of the deviation of flow from a slow change, for angular frequencies of `ω` [1/s] or more, relative
    /// to its drive. 1 if stored pressure is released.
    pub(super) fn departure_of_flow(&self, omega: f64) -> f64 {
        let signals = self
            .inertia_ratio_of(self.of_network.iter(), omega)
            .max(self.inertia_ratio(omega));
        if self.begins_pressed(false) {
            signals.max(1.0)
        } else {
            signals
        }
    }

    /// Smallest compliance of a vessel's walls at the scene's pressures [m^3/Pa].
    pub(super) fn stiffest(&self, law: &AccumulatorLaw) -> f64 {
        law.compliance(self.scales.pressure).min(law.compliance(0.0))
    }

    /// Returns the circuits of all network components.
    pub(super) fn circuits(&self, wet: &Wet) -> Vec<Circuit> {
        let network = &wet.network;
        let none = Circuit {
            least: f64::INFINITY,
            most: 0.0,
            through: false,
        };
        let mut all = vec![none; network.components];
        let mut take = |component: usize, [least, most]: [f64; 2]| {
            let own = &mut all[component];
            (own.least, own.most) = (own.least.min(least), own.most.max(most));
        };
        let bladder = wet.area[0].per_pressure * wet.bladder_length;
        for &component in &network.component_of_bladder {
            take(component, [bladder; 2]);
        }
        let pressure = self.scales.pressure;
        for one in &network.accumulators {
            let at = [pressure, 0.0, -pressure].map(|p| wet.vessel_compliance(&one.law, p));
            let known = || at.into_iter().filter(|c| c.is_finite() && *c > 0.0);
            let sizes = [known().fold(f64::INFINITY, f64::min), known().fold(0.0, f64::max)];
            take(network.component_of_junction[one.junction], sizes);
        }
        let mut reached: Vec<Option<&PressurePort>> = vec![None; network.components];
        for link in &network.links {
            for (here, other) in [(link.from, link.to), (link.to, link.from)] {
                let Some(component) = network.component_of(here) else {
                    continue;
                };
                all[component].through |= link.pump.is_some() || link.head != 0.0;
                if let NetworkNode::Port(port) = other {
                    let port = &network.ports[port];
                    let before = reached[component].get_or_insert(port);
                    all[component].through |= before.pressure != port.pressure;
                }
            }
        }
        for one in &network.accumulators {
            all[network.component_of_junction[one.junction]].through = true;
        }
        for own in all.iter_mut().filter(|own| own.least.is_infinite()) {
            own.least = 0.0;
        }
        all
    }
}
