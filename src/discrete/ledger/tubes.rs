//! Energy of the fluid in tubes in which it does not creep, [E51].

use crate::discrete::fluid_mesh::{MeshFlow, MeshLink};
use crate::discrete::{System, Workspace};
use crate::model::network::tube::BRANCHES;

/// A valve that is open by less than this tells what it dissipates by the pressure drop over it: its flow is too small to.
const NEARLY_SHUT: f64 = 0.01;

/// What a tube dissipates, [E51]: its resistance R/o at its opening [Pa s/m^3], flow [m^3/s], and pressure drop between its ends [Pa].
pub fn dissipation(link: &MeshLink, flow: &MeshFlow, [resistance, q, drop]: [f64; 3], w: &Workspace<f64>) -> f64 {
    let (mut slips, mut shear) = (0.0, 0.0);
    for (r, slip, ..) in self::slips(flow, q, w) {
        slips += r * slip * slip;
        shear += r * slip;
    }
    let loss = flow.tube.loss(q);
    let steady = if NEARLY_SHUT * resistance > link.resistance {
        let rate = if flow.tube.inertance > 0.0 {
            w.fluid.flow_rate[flow.number]
        } else {
            0.0
        };
        let over_valve = drop - flow.tube.inertance * rate - shear - loss;
        over_valve * over_valve / resistance
    } else {
        q * q * resistance
    };
    steady + q * loss + slips
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
