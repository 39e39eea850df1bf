//! Beam with a discretization error of fourth order.

use super::arcs;
use super::bending::elastic_curvature;
use crate::case::schema::Effect;
use crate::discrete::{BeamMesh, System, TimeData, Workspace};
use crate::error::{Code, Violation};
use crate::model::loads::LoadKind;
use crate::model::{Kinematics, Model};
use crate::numerics::Scalar;

/// `[E77]` `κ` at nodes and `λ` in cells are means, over the hat function of a node and over the cell. The elastic energy that their
/// squares miss is that of their differences,
///
/// ```text
/// E = EI/2 Σ h_i e_i² + EI h/2 Σ_c g_c (e_{c+1} - e_c)²      e_i = κ_i - α_p - κ_0      g = 1/6, 1/4 beside a slope that is given
///   + EA/2 Σ h e_c² + EA h/2 Σ_i g_i (e_i+ - e_i-)²          e_c = λ_c - 1 - λ_p        g = 1/12, 1/8 beside an end
/// ```
///
/// With loads and masses as in [E78], the error of the Lagrangian is of order `h^4`, also at ends. Forces and moments are its
/// derivatives,
///
/// ```text
/// M_i = EI [e_i - (h/h_i) (g_i (e_{i+1} - e_i) - g_{i-1} (e_i - e_{i-1}))]      N_c likewise
/// ```
///
/// so that balances and reciprocity remain exact. At a node M is then `M - h² M''/12`, whose mean over a segment is that of M. Jumps of
/// pressure between segments are contained in `α_p` and `λ_p`, across which e is smooth. At an end with given moment, e follows from it.
/// The curvature that determines the end's angle is the mean `κ_n = α_p + κ_0 + (2 M_n/EI + e_{n-1})/3`; its part of the energy is
/// `h_n M_n (κ_n - α_p - κ_0)/2`.
pub fn moments<T: Scalar>(mesh: &BeamMesh, now: &TimeData, moment: &mut [T]) {
    let last = mesh.nodes - 1;
    let [held_at_root, held_at_tip] = [0, 1].map(|end: usize| now.ends[end].slope.is_some());
    let weight = |c: usize| {
        let held = (c == 0 && held_at_root) || (c + 1 == last && held_at_tip);
        if held { 0.25 } else { 1.0 / 6.0 }
    };
    let mut before = (moment[1] - moment[0]) * weight(0);
    if held_at_root {
        moment[0] -= before * 2.0;
    }
    for c in 1..last {
        let step = (moment[c + 1] - moment[c]) * weight(c);
        moment[c] += before - step;
        before = step;
    }
    if held_at_tip {
        moment[last] += before * 2.0;
    }
}

/// Same correction for values of cells: normal forces, and with shear V and the rotary inertia of sections.
pub fn of_cells<T: Scalar>(values: &mut [T]) {
    let last = values.len() - 1;
    let mut before = T::zero();
    for c in 0..last {
        let step = (values[c + 1] - values[c]) * cell_weight(c, last);
        values[c] += before - step;
        before = step;
    }
    values[last] += before;
}

/// Weight `g` of the node behind cell `c`, for cells up to `last`.
#[inline]
pub fn cell_weight(c: usize, last: usize) -> f64 {
    if c == 0 || c + 1 == last { 0.125 } else { 1.0 / 12.0 }
}

/// Sum over cells of the mean squares of a function with these cell means: `Σ x_c² + Σ_i g_i (x_i+ - x_i-)²`.
pub fn squares(means: &[f64]) -> f64 {
    let last = means.len() - 1;
    let apart = means.windows(2).enumerate();
    let within = apart.map(|(c, pair)| cell_weight(c, last) * (pair[1] - pair[0]).powi(2));
    means.iter().map(|x| x * x).sum::<f64>() + within.sum::<f64>()
}

/// `[E79]` In a bent cell the line between the ends is longer than their distance:
///
/// ```text
/// λ_c gains λ_c h²/24 mean(κ²)      for small rotations   e gains g h²/24 mean(κ²)      mean(κ²) = (κ_c² + κ_{c+1}²)/2
/// ```
///
/// In the cell at an end with given moment, only the other node counts, because κ of the end is not an unknown. The conjugate effect of N
/// is a moment, `M_i gains (h/h_i) h²/24 κ_i Σ_c N_c λ_c` over the adjacent cells.
pub fn arcs<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    if !bends_its_cells(system) || !system.model.effects.has(Effect::AxialStretch) {
        return;
    }
    if system.model.effects.has(Effect::Shear) {
        arcs::strains(system, now, w);
        return;
    }
    let finite = system.model.kinematics == Kinematics::FiniteRotation;
    for c in 0..system.mesh.cells {
        let mut longer = arc(system, now, &w.shape.kappa, c);
        if finite {
            longer = longer * w.shape.stretch[c];
        }
        w.shape.strain[c] += longer;
    }
}

/// True if [`arcs`] applies to this beam: it bends, and its stretch depends on bending.
pub fn bends_its_cells(system: &System) -> bool {
    let tension = matches!(
        system.model.kinematics,
        Kinematics::SmallRotation | Kinematics::FiniteRotation
    );
    system.mesh.fourth && tension && !system.model.published()
}

/// Excess of the length of a cell's line over the distance of its ends, relative to it.
#[inline]
pub fn arc<T: Scalar>(system: &System, now: &TimeData, kappa: &[T], cell: usize) -> T {
    let [left, right] = shares(system, now, cell);
    (kappa[cell].squared() * left + kappa[cell + 1].squared() * right)
        * (system.mesh.shortest * system.mesh.shortest / 48.0)
}

/// Relative excess as in [`arc`] for small rotations, with or without shear, and its rate [1/s].
pub fn small_arc(system: &System, now: &TimeData, w: &Workspace<f64>, cell: usize) -> [f64; 2] {
    if system.model.effects.has(Effect::Shear) {
        return [
            arcs::of_line(system, &w.shape, cell),
            arcs::rate_of_line(system, w, cell),
        ];
    }
    let [left, right] = shares(system, now, cell);
    let of = |node: usize| 2.0 * w.shape.kappa[node] * w.shape.kappa_rate[node];
    let rate = (left * of(cell) + right * of(cell + 1)) * (system.mesh.shortest * system.mesh.shortest / 48.0);
    [arc(system, now, &w.shape.kappa, cell), rate]
}

/// Weights of the squares at a cell's two nodes.
#[inline]
pub fn shares(system: &System, now: &TimeData, cell: usize) -> [f64; 2] {
    if cell == 0 && now.ends[0].slope.is_none() {
        [0.0, 2.0]
    } else if cell + 1 == system.mesh.cells && now.ends[1].slope.is_none() {
        [2.0, 0.0]
    } else {
        [1.0; 2]
    }
}

/// Moments by N that are conjugate to [`arcs`], without shear.
pub fn arc_moments<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    if !bends_its_cells(system) || system.model.effects.has(Effect::Shear) {
        return;
    }
    let mesh = &system.mesh;
    let finite = system.model.kinematics == Kinematics::FiniteRotation;
    w.forces.arc_moment.fill(T::zero());
    for c in 0..mesh.cells {
        let mut force = w.forces.normal[c] * (mesh.shortest * mesh.shortest / 24.0);
        if finite {
            force = force * w.shape.stretch[c];
        }
        for (node, share) in [c, c + 1].into_iter().zip(shares(system, now, c)) {
            let moment = w.shape.kappa[node] * force * (share * mesh.shortest / mesh.node_lengths[node]);
            w.forces.arc_moment[node] += moment;
        }
    }
}

/// Elastic curvature of the node beside an end, from moments before the correction by [`moments`].
pub fn beside<T: Scalar>(system: &System, w: &Workspace<T>, node: usize) -> T {
    w.forces.moment[neighbour(system, node)] * (1.0 / system.sections.bending[node])
}

/// Index of the node beside an end.
pub fn neighbour(system: &System, node: usize) -> usize {
    if node == 0 { 1 } else { system.mesh.nodes - 2 }
}

/// Bending energy at a node [J].
pub fn of_bending(system: &System, now: &TimeData, w: &Workspace<f64>, node: usize) -> f64 {
    0.5 * system.mesh.node_lengths[node] * w.forces.moment[node] * elastic_curvature(system, now, w, node)
}

/// Elastic stretch `e_c = λ_c - 1 - λ_p` of a cell.
pub fn elastic_stretch(system: &System, w: &Workspace<f64>, cell: usize) -> f64 {
    let pressed = system.fluid.is_some() && system.model.effects.has(Effect::PressureToStretch);
    let free = if pressed {
        w.coupling.pressure_stretch[cell / system.mesh.cells_per_segment]
    } else {
        0.0
    };
    w.shape.strain[cell] - free
}

/// Stretch energy in a cell [J].
pub fn of_stretch(system: &System, w: &Workspace<f64>, cell: usize) -> f64 {
    0.5 * system.mesh.shortest * w.forces.normal[cell] * elastic_stretch(system, w, cell)
}

/// Error if a model does not allow fourth order.
pub fn refusal(model: &Model, mesh: &BeamMesh) -> Option<Violation> {
    let what = if !mesh.fourth {
        return None;
    } else if !mesh.uniform || model.sections.iter().any(|section| *section != model.section) {
        "a beam with spans needs a mesh of second order"
    } else if model.section.offset != 0.0 {
        "a neutral axis beside the beam's line needs a mesh of second order"
    } else if !model.relaxation.is_empty() {
        "a viscoelastic solid needs a mesh of second order"
    } else if !model.bending.is_empty() {
        "a moment-curvature law needs a mesh of second order"
    } else if model.strain_energy().is_some() {
        "a section at finite strain needs a mesh of second order"
    } else if model
        .loads
        .iter()
        .any(|load| matches!(load.kind, LoadKind::Normal | LoadKind::Tangential))
    {
        "loads that turn with the beam need a mesh of second order"
    } else if !model.attachments.is_empty() || !model.contacts.is_empty() {
        "a mesh of fourth order does not resolve the point forces of attachments and walls"
    } else {
        return None;
    };
    Some(Violation::new(Code::Together, "/mesh/order", what).hint("omit \"order\", and use more cells"))
}
