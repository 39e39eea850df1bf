//! State of equilibrium.

use crate::dae::{BeamDae, Dae as _, Seeds, StaticBeam};
use crate::discrete::extrema::MonitoredValues;
use crate::discrete::fluid_mesh::{MeshFlow, MeshLink};
use crate::discrete::ledger;
use crate::discrete::quantities::{Observable, ObservableRow, StateView, probes, stations};
use crate::discrete::residual::{nonlinear, relaxation};
use crate::discrete::{System, TimeData, Workspace, injected_volume};
use crate::run::range::Limits;
use crate::run::record::HistoryColumn;
use crate::spectral;

/// An equilibrium under a load factor.
#[derive(Clone, Debug)]
pub struct EquilibriumState {
    /// Stage of the path, from 0.
    pub stage: usize,
    /// Share of the stage.
    pub share: f64,
    /// Scaled unknowns of the static system.
    pub y: Vec<f64>,
    /// Values of the state, in the order of [`columns`].
    pub row: Vec<f64>,
    /// Displacements u1 of the nodes [m].
    pub u1: Vec<f64>,
    /// Displacements u3 of the nodes [m].
    pub u3: Vec<f64>,
    /// Stability, if determined.
    pub stability: Option<EquilibriumStability>,
}

/// `[E42]` Stability of an equilibrium: the signs of the eigenvalues μ of its static tangent relative to the mass of the nodes,
///
/// ```text
/// ∂F/∂y x = μ D x        D the mass of each node at its momentum, 0 elsewhere
/// ```
///
/// Each negative eigenvalue is an unstable direction (divergence). √μ is the angular frequency of a soft motion if the network has
/// time to follow. Flutter under follower loads needs inertia: `slcbeam modes`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquilibriumStability {
    /// Number of negative eigenvalues.
    pub unstable: usize,
    /// Eigenvalue of least magnitude [1/s^2], if computed.
    pub softest: Option<f64>,
}

/// Quantities of a history that an equilibrium has too.
fn at_rest(system: &System) -> Vec<Observable> {
    Observable::recorded(system)
        .into_iter()
        .filter(|one| one.at_rest())
        .collect()
}

/// Columns of the row of a [`State`], the load factor first.
pub fn columns(system: &System) -> Vec<HistoryColumn> {
    let share = HistoryColumn {
        name: "load_factor".into(),
        unit: "1",
        about: "load factor".into(),
    };
    let all = at_rest(system).into_iter().map(HistoryColumn::from);
    let all = all.chain(stations::columns(system, true));
    let all = all.chain(probes::columns(system));
    std::iter::once(share).chain(all).collect()
}

impl EquilibriumState {
    /// Load factor: number of earlier stages plus the share of this one.
    pub fn load_factor(&self) -> f64 {
        self.stage as f64 + self.share
    }

    /// Reads a state from the unknowns, followed by the share of the stage.
    pub fn read(statics: &mut StaticBeam, x: &[f64], stage: usize) -> Self {
        let (y, share) = (&x[..x.len() - 1], x[x.len() - 1]);
        let zeros = vec![0.0; y.len()];
        let (system, now, w) = statics.beam().evaluate(share, y, &zeros);
        let look = StateView::new(system, now, w, ledger::energies(system, now, w));
        let others = [stations::columns(system, true).len(), probes::columns(system).count()];
        let mut read = ObservableRow::new(at_rest(system), others);
        read.take(share, &look, &[], 0.0);
        let row = std::iter::once(stage as f64 + share)
            .chain(read.values().iter().copied())
            .collect();
        let [u1, u3] = [0, 1].map(|axis| w.motion.u.iter().map(|u| u[axis]).collect());
        statics.beam().keep_turns();
        Self {
            stage,
            share,
            y: y.to_vec(),
            row,
            u1,
            u3,
            stability: None,
        }
    }
}

/// Describes the limit that a state exceeds, if any, and returns the glance at the state.
pub fn within(statics: &mut StaticBeam, x: &[f64], limits: &Limits, factor: f64) -> (Option<String>, MonitoredValues) {
    let (y, share) = (&x[..x.len() - 1], x[x.len() - 1]);
    let (system, now, w) = statics.beam().evaluate(share, y, &vec![0.0; y.len()]);
    let glance = MonitoredValues::new(system, now, share, w);
    let beyond = limits.beyond_at(&glance, &format!("load factor {factor:.4}"));
    (beyond, glance)
}

impl EquilibriumStability {
    /// Stability of a state with scaled unknowns `y` under a load factor; `None` if the eigenvalues were not found.
    pub fn assess(statics: &mut StaticBeam, share: f64, y: &[f64]) -> Option<Self> {
        let mut values = vec![0.0; statics.pattern().entries()];
        statics
            .jacobian(share, y, &[], Seeds::Step { cj: 0.0 }, &mut values)
            .ok()?;
        let system = statics.system();
        let found = spectral::lowest(statics.pattern(), &values, &system.nodal_masses()).ok()?;
        Some(Self {
            unstable: found.iter().filter(|mu| mu.re < 0.0).count(),
            softest: found.first().map(|mu| mu.re),
        })
    }
}

/// Scaled unknowns of another system of the same case in the state `from` of a beam in equilibrium under the loads at `share`.
/// Displacements, areas, junction and turbine pressures are those of `from`. Other algebraic unknowns are guesses, velocities zero.
pub fn restate(from: &mut BeamDae, share: f64, y: &[f64], to: &System, now: &TimeData) -> Vec<f64> {
    let zeros = vec![0.0; y.len()];
    let (before, _, w) = from.evaluate(share, y, &zeros);
    let mut z = vec![0.0; to.layout.len];
    displacements(&w, to, now, &mut z);
    z[to.layout.turning.angle.clone()].copy_from_slice(&w.shape.sections.angle);
    let angles = to.joints.unknowns(&w.shape.joints.angle);
    z[to.layout.joints.angle.clone()]
        .iter_mut()
        .zip(angles)
        .for_each(|(z, angle)| *z = angle);
    relaxation::settle(to, now, &w, &mut z);
    fluid(&w, to, &mut z);
    flows(before, &w, to, &mut z);
    injected_volume::count_from(to, now, &mut z);
    for (z, scale) in z.iter_mut().zip(&to.layout.scales) {
        *z /= scale;
    }
    z
}

fn displacements(w: &Workspace<f64>, to: &System, now: &TimeData, z: &mut [f64]) {
    let l = &to.layout;
    for (axis, line) in l.lines.iter().enumerate() {
        for (node, unknown, _) in line.unknowns() {
            z[unknown] = w.motion.u[node][axis] - now.carried(axis, to.mesh.share(node)).value;
        }
    }
}

fn fluid(w: &Workspace<f64>, to: &System, z: &mut [f64]) {
    let (Some(wet), Some(fluid)) = (&to.model.wet, &to.fluid) else {
        return;
    };
    let (means, l) = (&to.layout.coupling, &to.layout.network);
    if wet.takes_moments {
        z[means.mean_moment.clone()].copy_from_slice(&w.coupling.mean_moment);
    }
    if wet.takes_forces {
        z[means.mean_force.clone()].copy_from_slice(&w.coupling.mean_force);
    }
    for (bladder, unknown) in means.excess() {
        z[unknown] = nonlinear::excess_area(wet, w, bladder);
    }
    let cells = w.fluid.area.len().checked_div(2 * wet.per_row).unwrap_or(1);
    // as many cells as before, or one for all cells of a bladder
    let merged = cells / fluid.cells_per_bladder;
    let mut unknown = l.area.start;
    for &bladder in &fluid.flowing {
        for areas in w.fluid.area[bladder * cells..(bladder + 1) * cells].chunks(merged) {
            z[unknown] = areas.iter().sum::<f64>() / merged as f64;
            unknown += 1;
        }
    }
    for (k, &junction) in fluid.junctions.iter().enumerate() {
        z[l.junction.start + k] = w.fluid.junction.get(junction).map_or(0.0, |&p| wet.potential(p));
    }
    for (one, &volume) in fluid.accumulators.iter().zip(&w.fluid.accumulated) {
        z[l.junction.start + one.junction] = volume;
    }
    for (k, drop) in w.fluid.bridge.iter().take(fluid.bridges.len()).enumerate() {
        z[l.bridge.start + k] = *drop;
    }
    for (k, lumped) in wet.lumped.iter().enumerate() {
        let of_lumped = || lumped.bladders.iter().flat_map(|&b| b * cells..(b + 1) * cells);
        if let Some(unknown) = l.lumped_pressure[k] {
            z[unknown] = of_lumped().map(|c| w.fluid.pressure[c]).sum::<f64>() / of_lumped().count() as f64;
        }
        if let Some(unknown) = l.lumped_volume[k] {
            z[unknown] = of_lumped().map(|c| w.fluid.area[c]).sum::<f64>() * wet.bladder_length / cells as f64;
        }
    }
}

/// Steady flows that are unknowns, and the friction branches that follow them: of tubes, and of faces between the same cells.
fn flows(before: &System, w: &Workspace<f64>, to: &System, z: &mut [f64]) {
    let (Some(from), Some(fluid)) = (&before.fluid, &to.fluid) else {
        return;
    };
    let l = &to.layout.network;
    let same = |a: &MeshLink, b: &MeshLink| match a.number {
        Some(_) => a.number == b.number,
        None => b.number.is_none() && (a.from, a.to) == (b.from, b.to),
    };
    for link in &fluid.links {
        let Some(MeshFlow { number, branch, law }) = link.flow else {
            continue;
        };
        let known = from.links.iter().position(|other| same(link, other));
        let known = known.filter(|_| from.cells_per_bladder == fluid.cells_per_bladder || link.number.is_some());
        let Some(k) = known else { continue };
        let flow = w.fluid.flow[k];
        let moving = w.fluid.root_of_density(k).map_or(flow, |root| flow / root);
        z[l.flow.start + number] = moving;
        for (at, _) in law.ladders(branch).into_iter().flatten() {
            z[l.branch.start + at.start..l.branch.start + at.end].fill(moving);
        }
    }
}
