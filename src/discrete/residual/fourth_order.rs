//! Beam with a discretization error of fourth order.

use std::ops::Range;

use super::arcs;
use super::bending::elastic_curvature;
use crate::case::schema::Effect;
use crate::discrete::{BeamMesh, System, TimeData, Workspace};
use crate::error::{Code, Violation};
use crate::model::loads::LoadKind;
use crate::model::{Kinematics, Model, Section};
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
///
/// At a node b where sections or cell lengths jump, e jumps. The angle there is eliminated: both sides have the same moment, as two ends
/// with given moment, and their mean curvatures add up to that of the node. With the compliances `c = h/EI` of the cells beside b,
///
/// ```text
/// M_b = 3/2 EI_b e_b - (c_l M'_{b-1} + c_r M'_{b+1})/(2 (c_l + c_r))      M' = EI e
/// ```
///
/// In a taper, EI and EA are means as e is, and the differences in the energy are
///
/// ```text
/// EI (e_{c+1} - e_c)²  ->  [(EI_{c+1} + EI_c)/2 (e_{c+1} - e_c) + (EI_{c+1} - EI_c) (e_{c+1} + e_c)] (e_{c+1} - e_c)
/// ```
pub fn moments<T: Scalar>(system: &System, now: &TimeData, moment: &mut [T]) {
    let (mesh, smooth) = (&system.mesh, &system.sections.smooth);
    let ends = [0, 1].map(|end: usize| now.ends[end].slope.is_some());
    let mut borders = smooth.borders.iter();
    let mut first = moment[0];
    for part in &mesh.parts {
        let (start, end) = (part.start, part.end);
        let border = borders.next();
        let at_end = match border {
            None => moment[end],
            Some(border) => {
                let [own, before, behind] = *border;
                moment[end] * own + moment[end - 1] * before + moment[end + 1] * behind
            }
        };
        let (mut left, mut before) = (first, T::zero());
        for cell in part.clone() {
            let right = if cell + 1 == end { at_end } else { moment[cell + 1] };
            let held = (cell == 0 && ends[0]) || (cell + 1 == mesh.cells && ends[1]);
            let [to_left, to_right] = match smooth.steps.get(cell) {
                None => {
                    let step = (right - left) * if held { 0.25 } else { 1.0 / 6.0 };
                    [-step, step]
                }
                Some(steps) => steps.map(|[by_left, by_right]| left * by_left + right * by_right),
            };
            if cell > start {
                moment[cell] = left + (before + to_left);
            } else if held {
                moment[start] += to_left * 2.0;
            }
            (left, before) = (right, to_right);
        }
        if border.is_some() {
            moment[end] = at_end;
        } else if ends[1] {
            moment[end] += before * 2.0;
        }
        first = at_end;
    }
}

/// Same correction for values of cells, the products of strains and stiffnesses: normal forces, and with shear V and the rotary inertia of
/// sections.
pub fn of_cells<T: Scalar>(system: &System, stiffness: &[f64], values: &mut [T]) {
    for part in &system.mesh.parts {
        let mut before = T::zero();
        for c in part.start..part.end - 1 {
            let [to_left, to_right] = cell_steps(stiffness, part, c, values[c], values[c + 1]);
            values[c] += before + to_left;
            before = to_right;
        }
        values[part.end - 1] += before;
    }
}

/// Passes the corrections of values of cells by [`of_cells`] to `add`, with their cells.
pub fn each_step<T: Scalar>(
    system: &System,
    stiffness: &[f64],
    value: impl Fn(usize) -> T,
    mut add: impl FnMut(usize, T),
) {
    for part in &system.mesh.parts {
        for c in part.start..part.end - 1 {
            let [to_left, to_right] = cell_steps(stiffness, part, c, value(c), value(c + 1));
            add(c, to_left);
            add(c + 1, to_right);
        }
    }
}

/// Corrections of the values of cell `c` and of the next one in a smooth part.
#[inline]
fn cell_steps<T: Scalar>(stiffness: &[f64], part: &Range<usize>, c: usize, here: T, next: T) -> [T; 2] {
    let g = cell_weight(c, part);
    if stiffness[c] == stiffness[c + 1] {
        let step = (next - here) * g;
        return [-step, step];
    }
    let ratio = stiffness[c] / stiffness[c + 1];
    let half = 0.5 * g;
    [
        here * (half * (3.0 - 1.0 / ratio)) - next * (half * (1.0 + ratio)),
        next * (half * (3.0 - ratio)) - here * (half * (1.0 + 1.0 / ratio)),
    ]
}

/// Weight `g` of the node behind cell `c`, which is in a smooth part.
#[inline]
fn cell_weight(c: usize, part: &Range<usize>) -> f64 {
    match usize::from(c == part.start) + usize::from(c + 2 == part.end) {
        0 => 1.0 / 12.0,
        1 => 0.125,
        _ => 1.0 / 6.0,
    }
}

/// Energy of strains of cells with these stiffnesses, half the sum of their products with the results of [`of_cells`] [J].
pub fn energy_of_cells(system: &System, stiffness: &[f64], strains: &[f64]) -> f64 {
    let lengths = &system.mesh.lengths;
    let of_means = |c: usize| lengths[c] * stiffness[c] * strains[c] * strains[c];
    let mut twice: f64 = (0..strains.len()).map(of_means).sum();
    let force = |c: usize| stiffness[c] * strains[c];
    each_step(system, stiffness, force, |c, step| {
        twice += lengths[c] * step * strains[c]
    });
    0.5 * twice
}

/// `[E79]` In a bent cell the line between the ends is longer than their distance:
///
/// ```text
/// λ_c gains λ_c h²/24 mean(κ²)      for small rotations   e gains g h²/24 mean(κ²)      mean(κ²) = (κ_c² + κ_{c+1}²)/2
/// ```
///
/// In the cell at an end with given moment, and beside a jump of sections or cell lengths, only the other node counts, because κ of the cell
/// is not an unknown there. The conjugate effect of N is a moment, `M_i gains (h/h_i) h²/24 κ_i Σ_c N_c λ_c` over the adjacent cells.
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
    let length = system.mesh.lengths[cell];
    (kappa[cell].squared() * left + kappa[cell + 1].squared() * right) * (length * length / 48.0)
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
    let length = system.mesh.lengths[cell];
    let rate = (left * of(cell) + right * of(cell + 1)) * (length * length / 48.0);
    [arc(system, now, &w.shape.kappa, cell), rate]
}

/// Weights of the squares at a cell's two nodes.
#[inline]
pub fn shares(system: &System, now: &TimeData, cell: usize) -> [f64; 2] {
    let [before, behind] = system.mesh.at_part_ends(cell);
    if before && (cell > 0 || now.ends[0].slope.is_none()) {
        [0.0, 2.0]
    } else if behind && (cell + 1 < system.mesh.cells || now.ends[1].slope.is_none()) {
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
        let length = mesh.lengths[c];
        let mut force = w.forces.normal[c] * (length * length / 24.0);
        if finite {
            force = force * w.shape.stretch[c];
        }
        for (node, share) in [c, c + 1].into_iter().zip(shares(system, now, c)) {
            let moment = w.shape.kappa[node] * force * (share * length / mesh.node_lengths[node]);
            w.forces.arc_moment[node] += moment;
        }
    }
}

/// Mean elastic curvature of an end with a given moment, from it and the moment of the node beside the end before [`moments`].
pub fn of_end<T: Scalar>(system: &System, w: &Workspace<T>, node: usize, moment: T) -> T {
    let [own, other] = system.sections.smooth.end_weights[usize::from(node > 0)];
    let (ei, neighbour) = (&system.sections.bending, neighbour(system, node));
    moment * (own / ei[node]) + w.forces.moment[neighbour] * (other / ei[neighbour])
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
        w.coupling.pressure_stretch[system.mesh.segment_of(cell)]
    } else {
        0.0
    };
    w.shape.strain[cell] - free
}

/// Stretch energy in a cell [J].
pub fn of_stretch(system: &System, w: &Workspace<f64>, cell: usize) -> f64 {
    0.5 * system.mesh.lengths[cell] * w.forces.normal[cell] * elastic_stretch(system, w, cell)
}

/// Error if a model does not allow fourth order.
pub fn refusal(model: &Model, mesh: &BeamMesh) -> Option<Violation> {
    let eccentric = |section: &Section| section.offset != 0.0;
    let damping = |section: &Section| [section.axial_damping_time, section.bending_damping_time];
    let what = if !mesh.fourth {
        return None;
    } else if model.published() && mesh.parts.len() > 1 {
        "the published form of a beam with spans needs a mesh of second order"
    } else if model
        .sections
        .iter()
        .any(|section| damping(section) != damping(&model.sections[0]))
    {
        "spans with damping of their own need a mesh of second order"
    } else if eccentric(&model.section) || model.sections.iter().any(eccentric) {
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
