//! Removes unbounded largest flows: those of ports whose pressure jumps at the open end of a bladder.

use std::collections::BTreeMap;

use super::schedule::SAME;
use super::summary::Quantity;
use crate::case::schema::Case;
use crate::discrete::System;
use crate::discrete::quantities::stations;
use crate::discrete::resolution::{self, JumpIntoBladder};
use crate::error::Code;
use crate::error::numbers::quantity;

/// Removes largest flows that grow without limit under mesh refinement from the figures of ports. `reached` is the time [s] at
/// which the run ended. Returns a warning for each.
pub fn leave_out(case: &Case, system: &System, reached: f64, ports: &mut BTreeMap<String, Quantity>) -> Vec<String> {
    let window_start = case.time.end_s - case.time.window() * (1.0 + SAME);
    let names: Vec<String> = stations::of_fluid(system).map(|(_, name)| name).collect();
    let jumps = resolution::jumps_into_bladders(case, &system.model).into_iter();
    let left_out = |jump: JumpIntoBladder| {
        let [first, last] = jump.times;
        // each port has its pressure, then its flow
        let name = names.get(2 * jump.port + 1)?;
        let flow = ports
            .get_mut(name)
            .filter(|flow| first <= reached && flow.max_abs.is_some())?;
        *flow = Quantity {
            max_abs: None,
            max_abs_at_s: None,
            extreme: None,
            ..*flow
        };
        if last >= window_start {
            // the integral of the squared flow has no limit either
            *flow = Quantity {
                window_max_abs: None,
                window_extreme: None,
                window_rms: None,
                ..*flow
            };
        }
        Some(Code::Unresolved.warning(format!(
            "mesh: the largest flow of the port \"{}\" is omitted: its pressure jumps at {}. The flow into the \
             bladder behind it then grows without limit as the mesh is refined (as 1/t^(1/2) after the jump). Give \
             its pressure as a ramp, or connect it by a tube.",
            jump.name,
            quantity(first, "s", 3),
        )))
    };
    jumps.filter_map(left_out).collect()
}
