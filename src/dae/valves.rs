//! Check valves in tubes whose flow is an unknown: how steep they are, and whether a Jacobian still knows.

use crate::discrete::residual::rows::driven;
use crate::discrete::{System, TimeData, Workspace};

/// Slopes that differ by more than this factor are those of another state of a valve.
const ANOTHER: f64 = 10.0;

/// Slopes of the valves, `dq/dΔ` of [E7] behind all linear resistance of their tubes.
#[derive(Clone, Debug, Default)]
pub(super) struct Valves {
    /// Links with such a valve.
    links: Vec<usize>,
    /// Slopes that the last Jacobian was made with; empty before there was one.
    known: Vec<f64>,
}

impl Valves {
    /// Of a system.
    pub fn of(system: &System) -> Self {
        let links = system.fluid.iter().flat_map(|fluid| fluid.links.iter().enumerate());
        let inside = links.filter(|(_, link)| link.flow.is_some() && link.check_valve.is_some());
        let links: Vec<usize> = inside.map(|(k, _)| k).collect();
        let known = Vec::with_capacity(links.len());
        Self { links, known }
    }

    /// Whether there are any.
    pub fn any(&self) -> bool {
        !self.links.is_empty()
    }

    /// Notes the slopes of the state in the workspace, of which a Jacobian is made.
    pub fn note(&mut self, system: &System, now: &TimeData, w: &Workspace<f64>) {
        self.known.clear();
        for k in 0..self.links.len() {
            let slope = self.slope(self.links[k], system, now, w);
            self.known.push(slope);
        }
    }

    /// Whether one is another now than it was.
    pub fn changed(&self, system: &System, now: &TimeData, w: &Workspace<f64>) -> bool {
        self.links.iter().zip(&self.known).any(|(&link, known)| {
            let ratio = self.slope(link, system, now, w) / known;
            !(1.0 / ANOTHER..=ANOTHER).contains(&ratio)
        })
    }

    fn slope(&self, k: usize, system: &System, now: &TimeData, w: &Workspace<f64>) -> f64 {
        let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
            return 0.0;
        };
        let link = &fluid.links[k];
        let driven = driven(wet, link, now, w, k);
        let resistance = 1.0 / now.conductance[k];
        link.check_valve
            .map_or(0.0, |valve| valve.slope_behind(resistance, driven))
    }
}
