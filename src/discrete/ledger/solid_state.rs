//! Energies and momenta of the beams.

use std::ops::Range;

use super::StoredEnergies;
use crate::case::schema::Effect;
use crate::discrete::residual::bending::elastic_curvature;
use crate::discrete::residual::{eccentric, fourth_order};
use crate::discrete::{System, TimeData, Workspace};
use crate::model::Kinematics;
use crate::numerics::Planar;

/// Axial velocity of a node's mass: its own, or without axial inertia that of the frame, `[E27]`.
pub(super) fn carried(system: &System, now: &TimeData, w: &Workspace<f64>, node: usize) -> f64 {
    if system.layout.lines[1].v.is_some() {
        return w.motion.v[node].z;
    }
    now.carried(1, system.mesh.share(node)).rate
}

/// True if sections rotate finitely but have the rotary inertia of `[E27]`.
pub(super) fn turned_across(system: &System) -> bool {
    let finite = system.model.kinematics == Kinematics::FiniteRotation;
    finite && system.turns_with_its_line() && system.layout.lines[1].v.is_none()
}

/// Rate of rotation for rotary inertia: `φ_t`, without axial inertia `x'_t`.
pub(super) fn turning_rate(system: &System, w: &Workspace<f64>, c: usize) -> f64 {
    if turned_across(system) {
        (w.motion.v[c + 1].x - w.motion.v[c].x) / system.mesh.lengths[c]
    } else {
        w.shape.angle_rate[c]
    }
}

/// Kinetic and elastic energies; the energy of shear is included in that of bending.
pub fn energies(system: &System, now: &TimeData, w: &Workspace<f64>) -> StoredEnergies {
    let mesh = &system.mesh;
    let sheared = system.model.effects.has(Effect::Shear);
    let mut e = energies_between(system, now, w, 0..mesh.nodes, 0..mesh.cells);
    if system.layout.inertia {
        for body in &system.bodies {
            let [kinetic, rotary] = body.energies(system, w);
            e.kinetic += kinetic;
            e.rotary += rotary;
        }
        e.rotary += system.joints.energies(now, w)[1];
    }
    if mesh.fourth && sheared {
        let (sections, shape) = (&system.sections, &w.shape);
        e.bending += fourth_order::energy_of_cells(system, &sections.shear, &shape.sections.shear);
        if system.model.effects.has(Effect::RotaryInertia) {
            e.rotary += fourth_order::energy_of_cells(system, &sections.rotary, &shape.angle_rate);
        }
    }
    e
}

/// Kinetic and elastic energies of some nodes and cells, without bodies that turn and, on a mesh of fourth order, without those of sections
/// that shear.
pub fn energies_between(
    system: &System,
    now: &TimeData,
    w: &Workspace<f64>,
    nodes: Range<usize>,
    cells: Range<usize>,
) -> StoredEnergies {
    let mesh = &system.mesh;
    let sheared = system.model.effects.has(Effect::Shear);
    let mut e = StoredEnergies::default();
    for i in nodes {
        let length = mesh.node_lengths[i];
        if system.layout.inertia {
            let along = carried(system, now, w, i);
            e.kinetic += 0.5 * system.masses[i] * (w.motion.v[i].x * w.motion.v[i].x + along * along);
        }
        e.bending += if mesh.fourth {
            fourth_order::of_bending(system, now, w, i)
        } else if let Some(energy) = eccentric::side_energy(system, w, i) {
            energy
        } else if let Some(law) = system.sections.laws.get(i) {
            length * law.at(elastic_curvature(system, now, w, i)).energy
        } else {
            0.5 * length * w.forces.moment[i] * w.forces.moment[i] / system.sections.bending[i]
        };
    }
    for c in cells {
        let h = mesh.lengths[c];
        if system.model.effects.has(Effect::AxialStretch) {
            e.axial += if mesh.is_gap(c) {
                0.0
            } else if mesh.fourth {
                fourth_order::of_stretch(system, w, c)
            } else {
                0.5 * h * w.forces.normal[c] * w.forces.normal[c] / system.sections.axial[c]
            };
        }
        if mesh.fourth && sheared {
            continue;
        }
        if let Some(shear) = w.shape.sections.shear.get(c) {
            e.bending += 0.5 * h * system.sections.shear[c] * shear * shear;
        }
        if system.model.effects.has(Effect::RotaryInertia) {
            e.rotary += 0.5 * h * spin(system, w, c) * turning_rate(system, w, c);
        }
    }
    e
}

/// Angular momentum of a cell's rotation per length: `m y11 φ_t`, published `m y11 λ² φ_t`.
fn spin(system: &System, w: &Workspace<f64>, c: usize) -> f64 {
    let factor = if system.model.published() && system.layout.lines[1].v.is_some() {
        w.shape.stretch[c] * w.shape.stretch[c]
    } else {
        1.0
    };
    system.sections.rotary[c] * factor * turning_rate(system, w, c)
}

/// Moment arms (x, z) of a node's momentum and force about the origin, i.e. its position, and their rates. A small
/// rotation ε moves a node by (ε θ, -ε g u1), whatever u3 is; the potential of `[E26]` is invariant under this motion.
pub fn arms(system: &System, w: &Workspace<f64>, i: usize) -> (Planar<f64>, Planar<f64>) {
    let at = Planar {
        x: 0.0,
        z: system.mesh.node_coordinate(i),
    };
    let (u, v) = (w.motion.u[i], w.motion.v[i]);
    if system.model.structure.is_some() {
        return (system.position(w, i), system.in_axes_of_case(i, v));
    }
    match system.model.kinematics {
        Kinematics::Bar | Kinematics::FiniteRotation => (at + u, v),
        Kinematics::SmallRotation => (Planar { x: u.x, ..at }, Planar { x: v.x, z: 0.0 }),
        Kinematics::Linear => (at, Planar::default()),
    }
}

/// Momentum and angular momentum about the origin.
pub fn momenta(system: &System, now: &TimeData, w: &Workspace<f64>) -> (Planar<f64>, f64) {
    let mesh = &system.mesh;
    let (mut momentum, mut angular) = (Planar::default(), 0.0);
    if !system.layout.inertia {
        return (momentum, angular);
    }
    for i in 0..mesh.nodes {
        let along = carried(system, now, w, i);
        let mass = system.masses[i];
        let own = Planar {
            z: along,
            ..w.motion.v[i]
        } * mass;
        let own = system.in_axes_of_case(i, own);
        momentum += own;
        angular += arms(system, w, i).0.cross(own);
    }
    for body in &system.bodies {
        let (own, about) = body.momenta(system, w);
        let own = system.in_axes_of_case(body.node, own);
        momentum += own;
        angular += body.at_place(|i| arms(system, w, i).0).cross(own) + about;
    }
    let joints = system.joints.angles.iter().zip(&w.shape.joints.rate);
    angular += joints.map(|(joint, rate)| joint.inertia * rate).sum::<f64>();
    if system.model.effects.has(Effect::RotaryInertia) {
        let arm = |c: usize| if turned_across(system) { w.shape.d3[c].z } else { 1.0 };
        let cells = (0..mesh.cells).map(|c| mesh.lengths[c] * arm(c) * spin(system, w, c));
        angular += cells.sum::<f64>();
    }
    (momentum, angular)
}
