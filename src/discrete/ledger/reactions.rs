//! Reactions of driven ends, told in two ways that a mesh makes differ.

use crate::case::schema::Effect;
use crate::discrete::{Attached, Body, State, System, TimeData};
use crate::model::Kinematics;

/// Squares of reactions and of what they differ by [N^2], added over driven ends and directions; with the reactions stand the end's
/// moment over the length of the beam, beside which forces may be nothing but round-off.
///
/// One is what the momentum of the end's half cell leaves over, which closes the balance of momentum whatever the mesh; the
/// other the force of the section at the end, extrapolated from the two nearest cells.
pub fn compared(system: &System, now: &TimeData, w: State) -> [f64; 2] {
    let (mesh, section, l) = (&system.mesh, &system.model.section, &system.layout);
    let mut squares = [0.0; 2];
    // between the cells that are compared the force would jump
    let inner = |a: &Attached| {
        let near = |node: usize| (1..=2).contains(&node) || (1..=2).contains(&(mesh.cells - node));
        a.weights
            .into_iter()
            .enumerate()
            .any(|(k, weight)| weight > 0.0 && near(a.node + k))
    };
    let turned = |body: &Body| body.cells().any(|(cell, _)| cell < 2 || cell + 2 >= mesh.cells);
    if mesh.cells < 2
        || !system.touching.is_empty()
        || system.attached.iter().any(inner)
        || system.bodies.iter().any(turned)
    {
        return squares;
    }
    // the end lies beyond the nearest cell by this share of what lies between the two, by masses of nodes
    let beyond = system.lengths[0] / system.lengths[1];
    for (node, near, next) in [(0, 0, 1), (mesh.nodes - 1, mesh.cells - 1, mesh.cells - 2)] {
        let end = &now.ends[usize::from(node > 0)];
        let outward = if node > 0 { 1.0 } else { -1.0 };
        let length = mesh.node_length(node);
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
            let inertia = if l.inertia { section.mass_per_length } else { 0.0 };
            let carried = (w.motion.a[node] * inertia + w.motion.v[node] * section.drag) * system.lengths[node];
            let half_cell = carried - now.force[node] * length;
            let n = &w.forces.section;
            let reaction = half_cell[axis] + outward * n[near][axis];
            let difference = reaction - outward * (n[near][axis] + beyond * (n[near][axis] - n[next][axis]));
            squares[0] += reaction * reaction;
            squares[1] += difference * difference;
        }
    }
    squares
}
