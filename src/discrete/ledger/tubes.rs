//! Energy of the fluid in tubes and along bladders if flow is not creeping, [E51] [E74].

use std::ops::Range;

use crate::discrete::fluid_mesh::{MeshFlow, MeshLink};
use crate::discrete::{System, Workspace};
use crate::model::network::Ladder;

/// Opening below which the dissipation of a valve is computed from its pressure drop, because its flow is too small.
const NEARLY_SHUT: f64 = 0.01;

/// Dissipation of creeping flow in a check valve, in the friction memory of bladders, and in the rest of a link [W]. Arguments:
/// conductance without the valve [m^3/(s Pa)], flow [m^3/s], and total dissipation outside the half cells [W].
pub fn creeping(link: &MeshLink, [conductance, q, lost]: [f64; 3]) -> [f64; 3] {
    if link.check_valve.is_none() {
        return [0.0, 0.0, lost];
    }
    let rest = if conductance > 0.0 {
        q * q * (1.0 / conductance - link.half_cells)
    } else {
        0.0
    };
    [lost - rest, 0.0, rest]
}

/// Dissipation as in [`creeping`], for a tube with its flow as an unknown, [E51]. Arguments: resistance R/o at the tube's opening
/// [Pa s/m^3], flow at mean density [m^3/s], and remaining driving pressure [Pa]; k is the index of the link.
pub fn dissipation(
    link: &MeshLink,
    flow: &MeshFlow,
    [resistance, q, driven]: [f64; 3],
    k: usize,
    w: &Workspace<f64>,
) -> [f64; 3] {
    let moving = w.fluid.moving[flow.number];
    let slipping = |(at, ladder): (Range<usize>, Ladder)| {
        let branches = ladder.branches().zip(&w.fluid.branch[at]);
        let each = branches.map(|((resistance, _), j)| resistance * (moving - j) * (moving - j));
        w.fluid.at_mean_density(k, each.sum())
    };
    let ladders = flow.law.ladders(flow.branch);
    let [slips, in_bladders] = ladders.map(|ladder| ladder.map_or(0.0, slipping));
    let lost = w.fluid.at_mean_density(k, flow.law.loss(w.fluid.flow[k]));
    let left = driven - q * (link.half_cells + link.of_pump);
    let nearly_shut = NEARLY_SHUT * resistance > link.resistance;
    let (in_valve, steady) = match &link.check_valve {
        None if nearly_shut => (0.0, left * left / resistance),
        None => (0.0, q * q * resistance),
        // for backward leakage, the pressure drop follows more accurately from the rest of the link
        Some(valve) if valve.is_shut(q) => {
            let steady = if nearly_shut { 0.0 } else { q * q * resistance };
            (q * left - steady, steady)
        }
        Some(valve) => {
            let drop: f64 = valve.drop(q);
            let steady = if nearly_shut {
                (left - drop) * (left - drop) / resistance
            } else {
                q * q * resistance
            };
            (q * drop, steady)
        }
    };
    [in_valve, in_bladders, q * q * link.of_pump + steady + q * lost + slips]
}

/// Kinetic energy of the fluid in tubes and along bladders: `Σ I y²/2`, y = q without compression, and the energy of the friction
/// branches, [E51] [E66].
pub fn kinetic(system: &System, w: &Workspace<f64>) -> f64 {
    let Some(fluid) = &system.fluid else { return 0.0 };
    let each = fluid.links.iter().filter_map(|link| link.flow).map(|flow| {
        let moving = w.fluid.moving[flow.number];
        let ladders = flow.law.ladders(flow.branch).into_iter().flatten();
        let branches = ladders.flat_map(|(at, ladder)| ladder.branches().zip(&w.fluid.branch[at]));
        let stored = branches.map(|((resistance, rate), j)| resistance / rate * j * j);
        0.5 * (flow.law.inertance * moving * moving + stored.sum::<f64>())
    });
    each.sum()
}
