//! Curvature and section forces for output, at nodes and midpoints of cells, also where the equations contain means.

use std::borrow::Cow;
use std::ops::Range;

use super::residual::bending::pressure_curvature;
use super::residual::fourth_order;
use super::residual::solid::node_stretch;
use super::workspace::FluidState;
use super::{System, TimeData, Workspace};
use crate::case::schema::Effect;
use crate::model::Kinematics;
use crate::numerics::Planar;

/// Output values of a fourth-order beam, [E77]; empty otherwise, and for values that equal those of the equations.
#[derive(Clone, Debug, Default)]
pub struct FourthOrderReadings {
    curvature: Vec<f64>,
    moment: Vec<f64>,
    normal: Vec<f64>,
    shear: Vec<f64>,
}

impl FourthOrderReadings {
    /// Allocates the values of a system.
    pub fn new(system: &System) -> Self {
        let mesh = &system.mesh;
        let bends = system.model.kinematics != Kinematics::Bar;
        let of = |there: bool, len: usize| if there { vec![0.0; len] } else { vec![] };
        Self {
            curvature: of(mesh.fourth && bends, mesh.nodes),
            moment: of(mesh.fourth && bends, mesh.nodes),
            normal: of(mesh.fourth, mesh.cells),
            shear: of(mesh.fourth && bends, mesh.cells),
        }
    }
}

impl Workspace<f64> {
    /// Curvature at nodes [1/m].
    pub fn curvature(&self) -> &[f64] {
        own(&self.readings.curvature, &self.shape.kappa)
    }

    /// Moments of the linear law at nodes, `EI (κ - α_p - κ_0)` [N m].
    pub fn linear_moments(&self) -> &[f64] {
        own(&self.readings.moment, &self.forces.moment)
    }

    /// Moments M at nodes without damping [N m].
    pub fn moments(&self) -> Cow<'_, [f64]> {
        let forces = &self.forces;
        together(
            self.linear_moments(),
            &[&forces.nonlinear_moment, &forces.relaxing_moment, &forces.offset_moment],
        )
    }

    /// Normal forces N in cells without damping [N].
    pub fn normals(&self) -> Cow<'_, [f64]> {
        let forces = &self.forces;
        let normal = own(&self.readings.normal, &forces.normal);
        together(normal, &[&forces.nonlinear_normal, &forces.relaxing_normal])
    }

    /// Shear forces V in cells [N].
    pub fn shears(&self) -> &[f64] {
        own(&self.readings.shear, &self.forces.shear)
    }
}

fn own<'a>(read: &'a [f64], known: &'a [f64]) -> &'a [f64] {
    if read.is_empty() { known } else { read }
}

/// Sum of parts; all but the first may be empty.
fn together<'a>(part: &'a [f64], others: &[&[f64]]) -> Cow<'a, [f64]> {
    let mut sum = Cow::Borrowed(part);
    for other in others.iter().filter(|other| !other.is_empty()) {
        sum.to_mut().iter_mut().zip(*other).for_each(|(sum, more)| *sum += more);
    }
    sum
}

/// Computes the [`FourthOrderReadings`] of an evaluated state. At a node, M and its part by N, [E79], differ from the moment by the loads,
/// weighted by [E78]: with their part `M_b''` of M'', the sum is `M - h² M_b''/12`, next to an end `M - h² M_b''/8`, and M itself at the
/// ends of each smooth part. There, `M_b''` is that of the third node, which no end affects. Curvature follows from M, normal forces from
/// strains, as do shear forces if sections shear.
pub fn read(system: &System, now: &TimeData, w: &mut Workspace<f64>) {
    if !system.mesh.fourth {
        return;
    }
    let mut readings = std::mem::take(&mut w.readings);
    if system.model.kinematics != Kinematics::Bar {
        bending(system, now, w, &mut readings);
    }
    stretch(system, w, &mut readings.normal);
    w.readings = readings;
}

fn bending(system: &System, now: &TimeData, w: &Workspace<f64>, readings: &mut FourthOrderReadings) {
    let (mesh, moment) = (&system.mesh, &w.forces.moment);
    let last = mesh.cells;
    let arcs = &w.forces.arc_moment;
    let known = |node: usize| arcs.get(node).map_or(moment[node], |arc| moment[node] + arc);
    readings
        .moment
        .iter_mut()
        .enumerate()
        .for_each(|(node, moment)| *moment = known(node));
    // work of the change of the section force on the line of a cell, `h² M_b''`
    let by_load = |node: usize| {
        let force = w.forces.section[node] - w.forces.section[node - 1];
        let line = (line(system, w, node) + line(system, w, node - 1)) * 0.5;
        -mesh.lengths[node] * force.dot(line.normal())
    };
    for (part, weights) in mesh.parts.iter().zip(&mesh.weights) {
        let cells = part.len();
        let third = if cells < 6 { 1 } else { 3 };
        for i in 1..cells {
            let at = i.clamp(third, cells - third);
            let share = match [1, cells - 1].map(|beside| i == beside) {
                [false, false] => 1.0 / 12.0,
                [true, true] => 1.0 / 6.0,
                _ => 1.0 / 8.0,
            };
            readings.moment[part.start + i] += share * by_load(part.start + at) / weights[at];
        }
    }
    for i in 0..=last {
        let alpha = readings.moment[i] / system.sections.bending_at(i)
            + pressure_curvature(system, w, i)
            + now.rest_curvature(i);
        let published = system.model.published();
        readings.curvature[i] = alpha
            / if published {
                node_stretch(&system.mesh, w, i)
            } else {
                1.0
            };
    }
    if !w.shape.sections.angle.is_empty() {
        let (stiffness, viscosity) = (&system.sections.shear, &system.sections.shear_viscosity);
        for (c, shear) in readings.shear.iter_mut().enumerate() {
            let sections = &w.shape.sections;
            *shear = stiffness[c] * sections.shear[c] + viscosity[c] * sections.shear_rate[c];
        }
        return;
    }
    for c in 0..last {
        let read = readings.moment[c] - readings.moment[c + 1];
        let more = (read - (known(c) - known(c + 1))) * w.shape.per_stretch[c] / mesh.lengths[c];
        readings.shear[c] = w.forces.shear[c] + more;
    }
}

/// Vector between the ends of a cell, per length, against which section forces have their moment.
pub(super) fn line(system: &System, w: &Workspace<f64>, cell: usize) -> Planar<f64> {
    match system.model.kinematics {
        Kinematics::FiniteRotation => w.shape.d3[cell],
        Kinematics::SmallRotation => Planar::new(w.shape.d3[cell].x, 1.0),
        _ => Planar::new(0.0, 1.0),
    }
}

/// Excess of the strains of the first cells over those of the beam, in units of `N'h`, for N that becomes V by rotation: the remainder of
/// 1/8 and -1/24 after the rows of [E77]. Their g beside an end assumes that only loads, weighted by [E78], change N.
const TURNED: [f64; 4] = [0.108_514_123, -0.023_372_891, -0.001_678_098, -0.000_120_482];

fn stretch(system: &System, w: &Workspace<f64>, normal: &mut [f64]) {
    let parts = &system.mesh.parts;
    if system.model.effects.has(Effect::AxialStretch) {
        for (c, normal) in normal.iter_mut().enumerate() {
            *normal = system.sections.axial[c] * fourth_order::elastic_stretch(system, w, c);
        }
        if system.model.kinematics == Kinematics::FiniteRotation && w.shape.sections.angle.is_empty() {
            let (n, tangent) = (&w.forces.section, &w.shape.tangent);
            for &Range { start, end } in parts.iter().filter(|part| part.len() >= TURNED.len()) {
                let last = end - 1;
                let near = n[start + 1].dot(tangent[start + 1] - tangent[start]);
                let far = n[last - 1].dot(tangent[last] - tangent[last - 1]);
                for (c, share) in TURNED.into_iter().enumerate() {
                    normal[start + c] -= share * near;
                    normal[last - c] += share * far;
                }
            }
        }
        return;
    }
    // forces by statics are sums over nodes up to the middle of a cell; adds what the weights of nodes beside an end miss
    normal.copy_from_slice(&w.forces.normal);
    for (part, weights) in parts.iter().zip(&system.mesh.weights) {
        let (cells, forces) = (part.len(), &w.forces.normal[part.clone()]);
        let slope = |node: usize| (forces[node] - forces[node - 1]) / weights[node];
        let near = 3.min(cells / 2);
        let slopes = [slope(near), slope(cells - near)];
        let mut sum = 0.0;
        for (c, weight) in weights[..cells].iter().enumerate() {
            sum += weight;
            normal[part.start + c] += (c as f64 + 0.5 - sum) * slopes[usize::from(2 * c >= cells)];
        }
    }
}

impl FluidState<f64> {
    /// Pressures of cells; without bladders, of junctions [Pa].
    pub fn pressures(&self) -> &[f64] {
        match self.pressure.is_empty() {
            true => &self.junction,
            false => &self.pressure,
        }
    }

    /// Area changes of cells [m^2].
    pub fn area_changes(&self) -> &[f64] {
        match self.swelling.is_empty() {
            true => &self.area,
            false => &self.swelling,
        }
    }
}
