//! Tangents of the characteristics of valves, for derivatives by loads.

use super::residual::fluid::{driving, over_bridge};
use super::residual::rows::driven;
use super::{System, TimeData, Workspace};
use crate::model::network::CheckValveLaw;
use crate::numerics::Scalar;

/// Pressure drops [Pa] at which valves are replaced by their tangents; if empty, valves follow their characteristics.
///
/// A valve opens over a pressure range that may be far below the pressures in the network. Differences over a change of the loads average
/// its slope over that change; differences with its tangent give its slope.
#[derive(Clone, Debug, Default)]
pub struct ValveTangents {
    /// For each link: resistance before its valve [Pa s/m^3], and drop over both.
    links: Vec<[f64; 2]>,
    /// For each bridge: drops over its two pairs of valves.
    bridges: Vec<[f64; 2]>,
}

impl ValveTangents {
    /// Tangents at the evaluated state; empty without such valves.
    pub fn new(system: &System, now: &TimeData, w: &Workspace<f64>) -> Self {
        let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
            return Self::default();
        };
        if !Self::needed(system) {
            return Self::default();
        }
        let mut links = vec![[0.0; 2]; fluid.links.len()];
        for (k, link) in fluid
            .links
            .iter()
            .enumerate()
            .filter(|(_, link)| link.check_valve.is_some())
        {
            let resistance = 1.0 / now.conductance[k];
            links[k] = match link.flow {
                None => [resistance, driving(link, now, w, k)],
                Some(flow) => {
                    let along = flow.law.resistance_along_a_step(now.cj);
                    let moving = w.fluid.moving[flow.number];
                    let volume = w.fluid.root_of_density(k).map_or(moving, |root| moving / root);
                    [resistance + along, driven(link, now, w, k) + volume * along]
                }
            };
        }
        let bridges = (0..fluid.bridges.len()).map(|k| over_bridge(wet, fluid, k, now, w).0.into());
        Self {
            links,
            bridges: bridges.collect(),
        }
    }

    /// True if a system has check valves.
    pub fn needed(system: &System) -> bool {
        let fluid = system.fluid.as_ref();
        fluid
            .is_some_and(|fluid| !fluid.bridges.is_empty() || fluid.links.iter().any(|link| link.check_valve.is_some()))
    }

    /// Flow through the valve of a link in series with a resistance, for the drop over both.
    #[inline]
    pub fn behind<T: Scalar>(&self, link: usize, valve: &CheckValveLaw, resistance: f64, drop: T) -> T {
        match self.links.get(link) {
            None => valve.flow_behind(resistance, drop),
            Some(&[resistance, at]) => drop.lift(|drop| along(valve.flow_and_slope(resistance, at), drop - at)),
        }
    }

    /// Flows through the two pairs of valves of a bridge, for their drops.
    #[inline]
    pub fn through<T: Scalar>(&self, bridge: usize, valve: &CheckValveLaw, (forward, backward): (T, T)) -> (T, T) {
        match self.bridges.get(bridge) {
            None => (valve.flow(forward), valve.flow(backward)),
            Some(&at) => {
                let [one, other] = at.map(|at| move |drop| along(valve.flow_and_slope(0.0, at), drop - at));
                (forward.lift(one), backward.lift(other))
            }
        }
    }
}

/// Value and slope of a tangent at a distance from its point of contact.
fn along((value, slope): (f64, f64), by: f64) -> (f64, f64) {
    (value + slope * by, slope)
}
