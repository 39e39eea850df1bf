//! Energy of the fluid in tubes in which it does not creep, [E51].

use crate::discrete::fluid_mesh::{MeshFlow, MeshLink};
use crate::discrete::{System, Workspace};
use crate::model::network::tube::BRANCHES;

/// A valve that is open by less than this tells what it dissipates by the pressure drop over it: its flow is too small to.
const NEARLY_SHUT: f64 = 0.01;

/// What a check valve and the rest of a link dissipate where flow creeps, of its conductance without the valve [m^3/(s Pa)], flow
/// [m^3/s], and all that is lost outside half cells [W].
pub fn creeping(link: &MeshLink, [conductance, q, lost]: [f64; 3]) -> [f64; 2] {
    if link.check_valve.is_none() {
        return [0.0, lost];
    }
    let rest = if conductance > 0.0 {
        q * q * (1.0 / conductance - link.half_cells)
    } else {
        0.0
    };
    [lost - rest, rest]
}

/// The same of a tube in which flow is an unknown, [E51]: its resistance R/o at its opening [Pa s/m^3], flow at its mean density [m^3/s], and
/// what is left to drive it [Pa]; k its number among the links.
pub fn dissipation(
    link: &MeshLink,
    flow: &MeshFlow,
    [resistance, q, driven]: [f64; 3],
    k: usize,
    w: &Workspace<f64>,
) -> [f64; 2] {
    let slips: f64 = self::slips(flow, w).map(|(r, slip, ..)| r * slip * slip).sum();
    let slips = w.fluid.at_mean_density(k, slips);
    let lost = w.fluid.at_mean_density(k, flow.tube.loss(w.fluid.flow[k]));
    let left = driven - q * (link.half_cells + link.of_pump);
    let nearly_shut = NEARLY_SHUT * resistance > link.resistance;
    let (in_valve, steady) = match &link.check_valve {
        None if nearly_shut => (0.0, left * left / resistance),
        None => (0.0, q * q * resistance),
        // a flow that leaks back tells its pressure drop less well than the rest does
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
    [in_valve, q * q * link.of_pump + steady + q * lost + slips]
}

/// Of each branch of a tube's friction: resistance, `y - k` of [E66], rate, and `k`.
fn slips(flow: &MeshFlow, w: &Workspace<f64>) -> impl Iterator<Item = (f64, f64, f64, f64)> {
    let moving = w.fluid.moving[flow.number];
    let own = flow
        .branch
        .map_or(&[][..], |first| &w.fluid.branch[first..first + BRANCHES]);
    let laws = flow.tube.branches();
    laws.zip(own)
        .map(move |((resistance, rate), &j)| (resistance, moving - j, rate, j))
}

/// Kinetic energy of the fluid in tubes: `Σ I y²/2`, y = q without compression, and what the branches of friction store, [E51] [E66].
pub fn kinetic(system: &System, w: &Workspace<f64>) -> f64 {
    let Some(fluid) = &system.fluid else { return 0.0 };
    let each = fluid.links.iter().filter_map(|link| link.flow).map(|flow| {
        let moving = w.fluid.moving[flow.number];
        let branches = slips(&flow, w).map(|(resistance, _, rate, j)| resistance / rate * j * j);
        0.5 * (flow.tube.inertance * moving * moving + branches.sum::<f64>())
    });
    each.sum()
}
