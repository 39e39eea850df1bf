//! Fourth-order strains of cells whose sections shear.

use super::fourth_order::{arc, bends_its_cells, shares};
use crate::case::schema::Effect;
use crate::discrete::workspace::BeamShape;
use crate::discrete::{BeamMesh, System, TimeData, Workspace};
use crate::model::Kinematics;
use crate::numerics::{Planar, Scalar};

/// [E79] for [E63]: θ, ε and γ of a cell are means. Its end points give `(λ, γ) = (d3·e_t, d3·e_n)`, λ = 1 + ε, for a constant θ.
/// Sections that rotate within the cell increase both,
///
/// ```text
/// (λ, γ)_c gains (λ, γ)_c h²/24 mean(κ²) + h/24 Σ_i κ_i (Δγ_i, -Δλ_i)        Δ from the cell before node i to that behind, i the cell's nodes
/// small rotations   e gains g h²/24 mean(u1''²)      h u1''_i = Δu1'_i         γ is the mean
/// ```
///
/// with an error of order `h^4`: in the mean of r' = λ e_t + γ e_n, the term `h²/12 θ' (γ', -λ')` is the variation of λ and γ while
/// sections rotate. A node at an end of a smooth part, and one between segments whose stretches by pressure differ, has no Δ; that of the
/// cell's other node is used. Forces and moments are derivatives of the energy: those of [E79] with `N λ + V γ`, and
///
/// ```text
/// (N, V) of the cell behind node i gains κ_i h/24 (-ΣV, ΣN), of that before it the opposite, ΣN and ΣV over both
/// M_i gains (ΣN Δγ_i - ΣV Δλ_i) h/24
/// ```
///
/// where forces on nodes and moments on sections are work-conjugate to λ and γ of the end points.
pub fn strains<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    if system.model.kinematics != Kinematics::FiniteRotation {
        for c in 0..system.mesh.cells {
            let longer = of_line(system, &w.shape, c);
            w.shape.strain[c] += longer;
        }
        return;
    }
    let cells = system.mesh.cells;
    for c in 0..cells {
        let longer = arc(system, now, &w.shape.kappa, c);
        let e_t = w.shape.sections.normal[c];
        let line = Planar::new(w.shape.d3[c].dot(e_t.normal()), w.shape.d3[c].dot(e_t));
        w.shape.sections.line[c] = line;
        w.shape.sections.shear[c] += line.x * longer;
        w.shape.strain[c] += line.z * longer;
    }
    for node in 1..cells {
        let change = change(system, &w.shape, node);
        for (cell, share) in beside(system, node) {
            w.shape.sections.shear[cell] -= change.z * share;
            w.shape.strain[cell] += change.x * share;
        }
    }
}

/// `(Δγ, Δλ) κ h/24` of a node.
#[inline]
fn change<T: Scalar>(system: &System, shape: &BeamShape<T>, node: usize) -> Planar<T> {
    let line = &shape.sections.line;
    (line[node] - line[node - 1]).times(shape.kappa[node] * (system.mesh.lengths[node] / 24.0))
}

/// Cells adjacent to an inner node, with its weight in each.
#[inline]
fn beside(system: &System, node: usize) -> [(usize, f64); 2] {
    let weight = |node: usize, other: usize| match (smooth(system, node), smooth(system, other)) {
        (false, _) => 0.0,
        (true, true) => 1.0,
        (true, false) => 2.0,
    };
    [(node - 1, weight(node, node - 1)), (node, weight(node, node + 1))]
}

/// True if λ and γ are smooth at a node.
fn smooth(system: &System, node: usize) -> bool {
    let mesh = &system.mesh;
    let pressed = system.fluid.is_some() && system.model.effects.has(Effect::PressureToStretch);
    mesh.is_within_part(node) && !(pressed && node.is_multiple_of(mesh.cells_per_segment))
}

/// Forces conjugate to [`strains`]: adds the effect of the elastic N and V to the moments of nodes and to the section
/// forces of cells.
pub fn forces<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    if !bends_its_cells(system) {
        return;
    }
    let (shape, forces) = (&w.shape, &mut w.forces);
    let mesh = &system.mesh;
    if system.model.kinematics != Kinematics::FiniteRotation {
        forces.arc_section.fill(Planar::zero());
        for node in 1..mesh.cells {
            let mut both = T::zero();
            for cell in [node - 1, node] {
                both += forces.normal[cell] * line_share(mesh, cell, node);
            }
            let force = both * (shape.d3[node].x - shape.d3[node - 1].x) * (1.0 / 24.0);
            forces.arc_section[node].x += force;
            forces.arc_section[node - 1].x -= force;
        }
        return;
    }
    forces.arc_moment.fill(T::zero());
    for c in 0..mesh.cells {
        let (line, force) = (shape.sections.line[c], Planar::new(forces.shear[c], forces.normal[c]));
        let length = mesh.lengths[c];
        let both = line.dot(force) * (length * length / 24.0);
        for (node, share) in [c, c + 1].into_iter().zip(shares(system, now, c)) {
            forces.arc_moment[node] += shape.kappa[node] * both * (share * length / mesh.node_lengths[node]);
        }
        forces.arc_section[c] = force.times(arc(system, now, &shape.kappa, c));
    }
    for node in 1..mesh.cells {
        let per_node = mesh.lengths[node] / 24.0;
        let mut both = Planar::zero();
        for (cell, share) in beside(system, node) {
            both += Planar::new(forces.shear[cell], forces.normal[cell]) * share;
        }
        let handed = Planar::new(both.z, -both.x).times(shape.kappa[node] * per_node);
        forces.arc_section[node] += handed;
        forces.arc_section[node - 1] -= handed;
        let line = shape.sections.line[node] - shape.sections.line[node - 1];
        forces.arc_moment[node] += (both.z * line.x - both.x * line.z) * per_node;
    }
}

/// Excess of the length of a cell's line over the distance of its ends, relative to it, for small rotations.
#[inline]
pub fn of_line<T: Scalar>(system: &System, shape: &BeamShape<T>, cell: usize) -> T {
    let mut sum = T::zero();
    for node in [cell, cell + 1] {
        let share = line_share(&system.mesh, cell, node);
        if share > 0.0 {
            sum += (shape.d3[node].x - shape.d3[node - 1].x).squared() * (share / 48.0);
        }
    }
    sum
}

/// Rate of this relative excess [1/s].
pub fn rate_of_line(system: &System, w: &Workspace<f64>, cell: usize) -> f64 {
    let turned = |c: usize| (w.motion.v[c + 1].x - w.motion.v[c].x) / system.mesh.lengths[c];
    let of = |node: usize| {
        let share = line_share(&system.mesh, cell, node);
        if share == 0.0 {
            return 0.0;
        }
        (w.shape.d3[node].x - w.shape.d3[node - 1].x) * (turned(node) - turned(node - 1)) * (share / 24.0)
    };
    of(cell) + of(cell + 1)
}

/// Weight of a node in [`of_line`]; zero at an end of a smooth part, where `u1''` of the cell is unknown.
#[inline]
fn line_share(mesh: &BeamMesh, cell: usize, node: usize) -> f64 {
    if !mesh.is_within_part(node) {
        0.0
    } else if mesh.at_part_ends(cell) != [false; 2] {
        2.0
    } else {
        1.0
    }
}
