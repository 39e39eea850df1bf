//! Reactions of driven ends, told in two ways that a mesh makes differ.

use crate::case::schema::Effect;
use crate::discrete::{System, TimeData, Workspace};
use crate::model::Kinematics;

/// Squares of reactions and of what they differ by [N^2], added over driven ends and directions; with the reactions stand the end's
/// moment over the length of the beam, beside which forces may be nothing but round-off.
///
/// One is what the momentum of the end's half cell leaves over, which closes the balance of momentum whatever the mesh; the
/// other the force of the section at the end, extrapolated from the two nearest cells.
pub fn compared(system: &System, now: &TimeData, w: &Workspace<f64>) -> [f64; 2] {
    let (mesh, section, l) = (&system.mesh, &system.model.section, &system.layout);
    let mut squares = [0.0; 2];
    if mesh.cells < 2 {
        return squares;
    }
    for (node, near, next) in [(0, 0, 1), (mesh.nodes - 1, mesh.cells - 1, mesh.cells - 2)] {
        let end = &now.ends[usize::from(node > 0)];
        let outward = if node > 0 { 1.0 } else { -1.0 };
        let length = mesh.node_length(node);
        let half_cell = |acceleration: f64, load: f64, velocity: f64| {
            let inertia = if l.inertia {
                section.mass_per_length * acceleration
            } else {
                0.0
            };
            length * (inertia - load + section.drag * velocity)
        };
        let compare = |n: &[f64], of_half_cell: f64, squares: &mut [f64; 2]| {
            let reaction = of_half_cell + outward * n[near];
            let difference = reaction - outward * (1.5 * n[near] - 0.5 * n[next]);
            squares[0] += reaction * reaction;
            squares[1] += difference * difference;
        };
        if end.slope.is_some() && end.u1.is_some() {
            squares[0] += (w.moment[node] / system.model.length).powi(2);
        }
        if end.u1.is_some() && system.model.kinematics != Kinematics::Bar {
            compare(
                &w.sx,
                half_cell(w.a1[node], now.force_x[node], w.v1[node]),
                &mut squares,
            );
        }
        if end.u3.is_some() && system.model.effects.has(Effect::AxialStretch) {
            compare(
                &w.sz,
                half_cell(w.a3[node], now.force_z[node], w.v3[node]),
                &mut squares,
            );
        }
    }
    squares
}
