//! Flows through valves as they close.

use crate::case::schema::Case;
use crate::discrete::{CompleteState, System};
use crate::model::water_hammer;

/// Observes the flow through each valve as it closes, in the order of [`water_hammer::closings`].
pub struct ValveFlows {
    /// Index of the link in the mesh; times at which the valve begins to close and is closed [s].
    closings: Vec<(Option<usize>, [f64; 2])>,
}

impl ValveFlows {
    /// Creates the observer for the valves of a case.
    pub fn new(case: &Case, system: &System) -> Self {
        let links = system.fluid.as_ref().map_or(&[][..], |fluid| &fluid.links);
        let of = |closing: water_hammer::ValveClosing| {
            let link = links.iter().position(|link| link.number == Some(closing.link));
            (link, closing.times)
        };
        Self {
            closings: water_hammer::closings(case, &system.model)
                .into_iter()
                .map(of)
                .collect(),
        }
    }

    /// Adds a state at time `t` [s]. Each of `flows` [m^3/s] is the last flow before its valve begins to close, then the largest one.
    pub fn add(&self, t: f64, w: CompleteState, flows: &mut Vec<f64>) {
        flows.resize(self.closings.len(), 0.0);
        for ((link, [from, to]), flow) in self.closings.iter().zip(flows) {
            let now = link.map_or(0.0, |link| w.fluid.flow[link].abs());
            if t < *from {
                *flow = now;
            } else if t <= *to {
                *flow = flow.max(now);
            }
        }
    }
}
