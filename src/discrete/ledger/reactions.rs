//! Reactions of driven ends by two methods, whose difference is a mesh error.

use crate::case::schema::Effect;
use crate::discrete::residual::rotating_frame;
use crate::discrete::{CompleteState, MeshedAttachment, MeshedBody, System, TimeData};
use crate::model::Kinematics;

/// Sums of squares over driven ends and directions: of the reactions, and of the differences between both methods [N^2]. The first sum
/// includes the end's moment over the length of the beam, because forces may be mere rounding errors beside it.
///
/// The first method is the momentum balance of the end's half cell, which satisfies the balance of momentum on every mesh. The second
/// method is the section force at the end, extrapolated from the two nearest cells.
pub fn compared(system: &System, now: &TimeData, w: CompleteState) -> [f64; 2] {
    let (mesh, section, l) = (&system.mesh, &system.model.section, &system.layout);
    let mut squares = [0.0; 2];
    // an attachment between the two cells would let the section force jump
    let inner = |a: &MeshedAttachment| {
        let near = |node: usize| (1..=2).contains(&node) || (1..=2).contains(&(mesh.cells - node));
        a.weights
            .into_iter()
            .enumerate()
            .any(|(k, weight)| weight > 0.0 && near(a.node + k))
    };
    let turned = |body: &MeshedBody| body.cells().any(|(cell, _)| cell < 2 || cell + 2 >= mesh.cells);
    if mesh.cells < 2
        || system.model.structure.is_some()
        || !system.touching.is_empty()
        || system.attached.iter().any(inner)
        || system.bodies.iter().any(turned)
    {
        return squares;
    }
    // distance of the end beyond the nearest cell relative to the distance of the two cells, by masses of nodes
    let beyond = system.lengths[0] / system.lengths[1];
    for (node, near, next) in [(0, 0, 1), (mesh.nodes - 1, mesh.cells - 1, mesh.cells - 2)] {
        let end = &now.ends[usize::from(node > 0)];
        let outward = if node > 0 { 1.0 } else { -1.0 };
        let length = mesh.node_lengths[node];
        if end.slope.is_some() && end.u[0].is_some() {
            squares[0] += (w.forces.moment[node] / system.model.length).powi(2);
        }
        let (bends, stretches) = (
            system.model.kinematics != Kinematics::Bar,
            system.model.effects.has(Effect::AxialStretch),
        );
        for (axis, moves) in [bends, stretches].into_iter().enumerate() {
            if end.u[axis].is_none() || !moves {
                continue;
            }
            let inertia = if l.inertia { system.sections.mass[node] } else { 0.0 };
            let carried = (w.motion.a[node] * inertia + w.motion.v[node] * section.drag) * system.lengths[node];
            let mut half_cell = carried - now.force[node] * length;
            if let Some(force) = rotating_frame::force(system, now, &w, node) {
                half_cell -= force * (system.sections.mass[node] * system.lengths[node] / system.masses[node]);
            }
            let n = &w.forces.section;
            let reaction = half_cell[axis] + outward * n[near][axis];
            let difference = reaction - outward * (n[near][axis] + beyond * (n[near][axis] - n[next][axis]));
            squares[0] += reaction * reaction;
            squares[1] += difference * difference;
        }
    }
    squares
}
