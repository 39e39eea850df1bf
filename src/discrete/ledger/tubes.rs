//! Energy of the fluid in tubes in which it does not creep, [E51].

use crate::discrete::fluid_mesh::MeshFlow;
use crate::discrete::{System, Workspace};
use crate::model::network::tube::BRANCHES;

/// What losses and the memory of friction dissipate in a tube, [E51].
pub fn dissipation(flow: &MeshFlow, q: f64, w: &Workspace<f64>) -> f64 {
    let slips = slips(flow, q, w).map(|(resistance, slip, ..)| resistance * slip * slip);
    q * flow.tube.loss(q) + slips.sum::<f64>()
}

/// Of each branch of a tube's friction: resistance, `q - j`, rate, and `j`.
fn slips(flow: &MeshFlow, q: f64, w: &Workspace<f64>) -> impl Iterator<Item = (f64, f64, f64, f64)> {
    let own = flow
        .branch
        .map_or(&[][..], |first| &w.fluid.branch[first..first + BRANCHES]);
    let laws = flow.tube.branches();
    laws.zip(own)
        .map(move |((resistance, rate), &j)| (resistance, q - j, rate, j))
}

/// Kinetic energy of the fluid in tubes: `Σ I q²/2`, and what the branches of friction store, [E51].
pub fn kinetic(system: &System, w: &Workspace<f64>) -> f64 {
    let Some(fluid) = &system.fluid else { return 0.0 };
    let flows = fluid.links.iter().zip(&w.fluid.flow);
    let flows = flows.filter_map(|(link, &q)| Some((link.flow?, q)));
    let each = flows.map(|(flow, q)| {
        let branches = slips(&flow, q, w).map(|(resistance, _, rate, j)| resistance / rate * j * j);
        0.5 * (flow.tube.inertance * q * q + branches.sum::<f64>())
    });
    each.sum()
}
