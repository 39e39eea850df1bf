//! Monitored values of a run, which may have extrema between two samples, each with its rate.

use serde::{Deserialize, Serialize};

use super::angle_unwrapping::tip_angle;
use super::quantities::evaluate;
use super::workspace::Motion;
use super::{CompleteState, FluidMesh, System, TimeData, Workspace, beam_contacts, contact_points, crossing, ledger};
use crate::discrete::residual::bending::{elastic_curvature, relative_stiffness};
use crate::discrete::residual::solid::node_stretch;
use crate::discrete::residual::{nonlinear, relaxation};
use crate::model::{Kinematics, Wet};
use crate::numerics::Planar;

/// A value and its rate in time.
pub type Moving = [f64; 2];

/// Monitored values with their rates at an instant, signed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MonitoredValues {
    /// Time [s].
    pub t: f64,
    /// Values, in the order of [`MonitoredQuantity`].
    pub moving: [Moving; MonitoredQuantity::COUNT],
    /// Node of the largest strain.
    pub strained: usize,
    /// Tube of the largest Reynolds number.
    pub tube: usize,
    /// Tube of the largest Mach number.
    pub fast: usize,
    /// Lowest pressure in junctions, accumulators and at pumped ports [Pa].
    pub thinnest: f64,
    /// Location of this pressure: index of a junction, or, after these, of a port that prescribes flow or volume.
    #[serde(default)]
    pub thinnest_at: usize,
    /// Bladder with the lowest pressure.
    #[serde(default)]
    pub lowest: usize,
    /// Self-crossing of the beam: both places along the undeformed beam [m].
    #[serde(default)]
    pub crossing: Option<[f64; 2]>,
    /// Largest `|u1 - u1(root)|` [m].
    pub deflection: f64,
    /// Largest displacement of a node relative to the root [m].
    pub moved: f64,
    /// Largest elastic curvature over the end of the node's moment-curvature table, and its node.
    #[serde(default)]
    pub bent: (f64, usize),
}

/// Names of the values in a [`MonitoredValues`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MonitoredQuantity {
    /// `u1` of the tip [m].
    Tip1,
    /// `u3` of the tip [m].
    Tip3,
    /// Slope angle of the tip [rad].
    Angle,
    /// `u1` at the middle [m].
    Middle1,
    /// `u1` of largest magnitude [m].
    Largest1,
    /// `u3` of largest magnitude [m].
    Largest3,
    /// Highest pressure of a cell [Pa].
    High,
    /// Lowest pressure of a cell [Pa].
    Low,
    /// Smallest cross-section of a bladder relative to that at rest.
    Opening,
    /// Largest area change of a bladder [m^2].
    Swelling,
    /// Largest strain of a fibre, `|λ - 1| + |κ| h_s/2`.
    Strain,
    /// Largest flow through a tube over its radius [m^2/s]; times `2 ρ_0/(π μ)` its Reynolds number.
    Flow,
    /// Largest `p_u + p_d` of a segment [Pa].
    Pressed,
    /// Largest distance of a section from the origin in its strain ellipsoid, relative to the limit of its energy at
    /// finite strain.
    Outermost,
    /// Largest `|q| √r'/(r A)` of a tube, r the density over `ρ_0` at its minimum [m/(s Pa^(1/2))]. Times `√ρ_0` it is the Mach number.
    Mach,
    /// Largest depth behind the face of an obstacle [m].
    Depth,
}

impl MonitoredQuantity {
    /// Number of monitored values.
    pub const COUNT: usize = 16;
}

impl MonitoredValues {
    /// A value and its rate.
    pub fn value_and_rate(&self, which: MonitoredQuantity) -> Moving {
        self.moving[which as usize]
    }

    /// Evaluates the monitored values of a state.
    pub fn new(system: &System, now: &TimeData, t: f64, w: CompleteState) -> Self {
        let w = &*w;
        let mut g = Self { t, ..Self::default() };
        let beam = system.first_tip();
        let last = system.mesh.beams[beam].nodes.end - 1;
        let mut set = |which: MonitoredQuantity, moving: Moving| g.moving[which as usize] = moving;
        set(MonitoredQuantity::Tip1, [w.motion.u[last].x, w.motion.v[last].x]);
        set(MonitoredQuantity::Tip3, [w.motion.u[last].z, w.motion.v[last].z]);
        set(
            MonitoredQuantity::Angle,
            [tip_angle(system, now, w, beam), tip_angle_rate(system, now, w)],
        );
        let (a, b) = (last / 2, last.div_ceil(2));
        set(
            MonitoredQuantity::Middle1,
            [
                0.5 * (w.motion.u[a].x + w.motion.u[b].x),
                0.5 * (w.motion.v[a].x + w.motion.v[b].x),
            ],
        );
        // the axes of several beams differ: sizes only
        let sized = |[value, rate]: Moving| match system.model.structure.is_some() {
            true => [value.abs(), rate * value.signum()],
            false => [value, rate],
        };
        set(MonitoredQuantity::Largest1, sized(largest(system, &w.motion, 0)));
        set(MonitoredQuantity::Largest3, sized(largest(system, &w.motion, 1)));
        (g.deflection, g.moved) = moved(system, w);
        let (strain, node) = evaluate::largest_strain(system, now, w);
        g.strained = node;
        g.moving[MonitoredQuantity::Strain as usize] = [strain, strain_rate(system, now, node, w)];
        g.moving[MonitoredQuantity::Outermost as usize] = nonlinear::outermost(system, w);
        let between = beam_contacts::deepest(system, w);
        g.moving[MonitoredQuantity::Depth as usize] = match contact_points::deepest(system, w) {
            [depth, _] if depth < between => [between, 0.0],
            deepest => deepest,
        };
        (g.thinnest, g.thinnest_at) = evaluate::thinnest(system, now, w);
        g.crossing = crossing::first(system, w);
        g.bent = bent(system, now, w);
        g.fluid(system, now, w);
        g
    }

    fn fluid(&mut self, system: &System, now: &TimeData, w: &Workspace<f64>) {
        self.moving[MonitoredQuantity::Opening as usize] = [1.0, 0.0];
        let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
            return;
        };
        if fluid.cells > 0 {
            self.bladders(system, wet, fluid, w);
        } else if !w.fluid.junction.is_empty() {
            // without rates, extrema are those at the steps
            let (low, high) = extremes(&w.fluid.junction, |_| true);
            self.lowest = low;
            self.moving[MonitoredQuantity::High as usize] = [w.fluid.junction[high], 0.0];
            self.moving[MonitoredQuantity::Low as usize] = [w.fluid.junction[low], 0.0];
        }
        if let Some((flow, tube)) = evaluate::largest_flow(system, now, w) {
            self.moving[MonitoredQuantity::Flow as usize] = flow;
            self.tube = tube;
        }
        if let Some((fast, tube)) = evaluate::largest_mach(system, now, w) {
            self.moving[MonitoredQuantity::Mach as usize] = fast;
            self.fast = tube;
        }
    }

    fn bladders(&mut self, system: &System, wet: &Wet, fluid: &FluidMesh, w: &Workspace<f64>) {
        let mut set = |which: MonitoredQuantity, moving: Moving| self.moving[which as usize] = moving;
        let rate = |cell: usize| ledger::pressure_rate(wet, fluid, w, cell);
        let there = |cell: usize| system.has_cell(cell);
        let (low, high) = extremes(&w.fluid.pressure, there);
        self.lowest = low / fluid.cells_per_bladder;
        set(MonitoredQuantity::High, [w.fluid.pressure[high], rate(high)]);
        set(MonitoredQuantity::Low, [w.fluid.pressure[low], rate(low)]);
        let areas = w.fluid.area_changes();
        let area_rate = |cell: usize| ledger::area_rate(wet, fluid, w, cell);
        let (_, most) = extremes(areas, there);
        let least = system.most_closed(areas);
        let at_rest = system.area_at_rest(least);
        set(
            MonitoredQuantity::Opening,
            [1.0 + areas[least] / at_rest, area_rate(least) / at_rest],
        );
        set(MonitoredQuantity::Swelling, [areas[most], area_rate(most)]);
        let pressed = (0..wet.per_row)
            .map(|j| (wet.pair(j).map(|b| w.fluid.mean_pressure[b]).iter().sum::<f64>(), j))
            .reduce(|a, b| if b.0 > a.0 { b } else { a });
        if let Some((sum, j)) = pressed {
            let mean = |bladder: usize| {
                let cells = fluid.cells_of(bladder);
                let count = cells.len() as f64;
                cells.map(rate).sum::<f64>() / count
            };
            set(MonitoredQuantity::Pressed, [sum, wet.pair(j).map(mean).iter().sum()]);
        }
    }
}

/// Indices of the smallest and the largest value, of those that count.
fn extremes(values: &[f64], counts: impl Fn(usize) -> bool) -> (usize, usize) {
    let first = (0..values.len()).find(|i| counts(*i)).unwrap_or(0);
    let (mut low, mut high) = (first, first);
    for (i, &value) in values.iter().enumerate().filter(|(i, _)| counts(*i)) {
        if value < values[low] {
            low = i;
        }
        if value > values[high] {
            high = i;
        }
    }
    (low, high)
}

/// Displacement of largest magnitude, with its rate, from the parabola through the largest nodal value and its neighbors. The parabola
/// reduces differences between meshes of different size.
fn largest(system: &System, motion: &Motion<f64>, axis: usize) -> Moving {
    let mut most = 0;
    for (i, u) in motion.u.iter().enumerate() {
        if u[axis].abs() > motion.u[most][axis].abs() {
            most = i;
        }
    }
    if system.mesh.end_at(most).is_some() {
        return [motion.u[most][axis], motion.v[most][axis]];
    }
    let parabola = |field: &[Planar<f64>]| {
        let [a, b, c] = [most - 1, most, most + 1].map(|node| field[node][axis]);
        [b, 0.5 * (c - a), a - 2.0 * b + c]
    };
    let (u, v) = (parabola(&motion.u), parabola(&motion.v));
    let top = if u[2] == 0.0 {
        0.0
    } else {
        (-u[1] / u[2]).clamp(-0.5, 0.5)
    };
    [u, v].map(|[value, slope, bent]| value + top * (slope + 0.5 * top * bent))
}

/// Largest transverse deflection and largest displacement of a node relative to the root [m].
fn moved(system: &System, w: &Workspace<f64>) -> (f64, f64) {
    let (mut across, mut squared) = (0.0_f64, 0.0_f64);
    for beam in &system.mesh.beams {
        for u in &w.motion.u[beam.nodes.clone()] {
            let way = *u - w.motion.u[beam.nodes.start];
            across = across.max(way.x.abs());
            squared = squared.max(way.squared());
        }
    }
    (across, squared.sqrt())
}

/// Largest elastic curvature over the end of the node's moment-curvature table, and its node.
fn bent(system: &System, now: &TimeData, w: &Workspace<f64>) -> (f64, usize) {
    let laws = system.sections.laws.iter().enumerate();
    let shares = laws.map(|(node, law)| (law.share(elastic_curvature(system, now, w, node)), node));
    shares.fold((0.0, 0), |most, one| if one.0 > most.0 { one } else { most })
}

/// Rate of the tip's angle [rad/s], from its last cell and half a cell of the end's curvature.
fn tip_angle_rate(system: &System, now: &TimeData, w: &Workspace<f64>) -> f64 {
    let beam = system.first_tip();
    let tip = system.mesh.beams[beam].ends()[1];
    let end = &now.ends[2 * beam + 1];
    let last = tip.node;
    if system.model.kinematics == Kinematics::Bar {
        return 0.0;
    }
    let curvature_rate = match end.turns() {
        true => w.shape.kappa_rate[last],
        false => {
            let given = end.moment.rate / system.sections.bending[last];
            let bent = relative_stiffness(system, now, w, last);
            let alpha_rate = given + bent * now.rest_curvature_rate(last);
            relaxation::curvature_rate(system, now, w, last, alpha_rate, bent)
        }
    };
    w.shape.angle_rate[tip.cell] - 0.5 * system.mesh.lengths[tip.cell] * curvature_rate
}

/// Rate of the largest fibre strain at its node [1/s].
fn strain_rate(system: &System, now: &TimeData, node: usize, w: &Workspace<f64>) -> f64 {
    let [a, b] = system.mesh.cells_beside(node);
    let stretch_rate = 0.5 * (w.shape.stretch_rate[a] + w.shape.stretch_rate[b]);
    (node_stretch(&system.mesh, w, node) - 1.0).signum() * stretch_rate
        + (w.shape.kappa[node] - now.rest_curvature(node)).signum()
            * (w.shape.kappa_rate[node] - now.rest_curvature_rate(node))
            * system.sections.fiber_of_curvature[node]
}
