//! Flows through valves as they shut.

use crate::case::schema::Case;
use crate::discrete::{State, System};
use crate::model::hammer;

/// Observes the flow through each valve as it shuts, in the order of [`hammer::closings`].
pub struct ValveFlows {
    /// Number of the link of the mesh; when the valve begins to fall, and when it is shut [s].
    closings: Vec<(Option<usize>, [f64; 2])>,
}

impl ValveFlows {
    /// Of the valves of a case.
    pub fn new(case: &Case, system: &System) -> Self {
        let links = system.fluid.as_ref().map_or(&[][..], |fluid| &fluid.links);
        let of = |closing: hammer::Closing| {
            let link = links.iter().position(|link| link.number == Some(closing.link));
            (link, closing.times)
        };
        Self {
            closings: hammer::closings(case, &system.model).into_iter().map(of).collect(),
        }
    }

    /// Adds a state at a time [s]: `flows` are the last ones before each valve begins to shut, from then on the largest ones [m^3/s].
    pub fn add(&self, t: f64, w: State, flows: &mut Vec<f64>) {
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
