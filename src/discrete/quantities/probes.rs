//! Quantities at places named in the case.

use NeededPart::{Beam, Bladders, Structure};

pub use super::column::{HistoryColumn, is_stress, key, tip_of_beam};
use super::evaluate::StateView;
use crate::case::schema::{Case, Probe as Written, ROUNDING};
use crate::case::spans;
use crate::discrete::angle_unwrapping::{first_angle, rotation, tip_angle};
use crate::discrete::readings::line;
use crate::discrete::residual::bending::segment_curvature;
use crate::discrete::{BeamMesh, MeshSections, System};
use crate::model::Kinematics;
use crate::numerics::Planar;

/// A place of the beam, on a mesh.
///
/// Displacements are interpolated with the curvature of the cell, other values of nodes and of cells linearly, those of cells extrapolated
/// to the ends of smooth parts: the error is second order in the cell length. Curvatures beside a jump of the section are those of the
/// probe's side; at a jump, those behind it.
#[derive(Clone, Debug)]
pub struct MeshProbe {
    /// First part of its column names.
    pub name: String,
    /// Place `θ/l_s`; in a structure along the whole beam.
    pub at: f64,
    /// True if only its motion is recorded.
    motion_only: bool,
    /// Node before it, and the fraction of the distance to the next.
    node: (usize, f64),
    /// Cell whose midpoint is before it, and the fraction of the distance to the next midpoint; below 0 or above 1 at
    /// the ends.
    cell: (usize, f64),
    /// The same of two cells that no jump of the section separates, if there are two.
    strained: (usize, f64),
    /// Segment of the probe.
    segment: usize,
    /// EI of the probe's side at both nodes, if the section jumps there [N m^2].
    jumps: [Option<f64>; 2],
    /// Heights of the upper and the lower surface above the beam's line [m].
    surfaces: [f64; 2],
    /// Young's modulus of the solid [Pa].
    young_modulus: f64,
    /// EI [N m^2].
    bending: f64,
}

/// Cases in which a quantity exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NeededPart {
    Beam,
    Bladders,
    Structure,
}

/// One row of the table: last part of the column name, unit, description, needed part of the case, evaluation.
type Entry = (
    &'static str,
    &'static str,
    &'static str,
    NeededPart,
    fn(&MeshProbe, &StateView) -> f64,
);

/// Quantities recorded at each probe.
#[rustfmt::skip]
const TABLE: [Entry; 15] = [
    ("u1", "m", "transverse displacement", Beam, |p, look| p.displacement(look).x),
    ("u3", "m", "axial displacement", Beam, |p, look| p.displacement(look).z),
    ("angle", "rad", "slope angle phi, counted over full turns", Beam, MeshProbe::angle),
    ("x", "m", "position x in the axes of the case", Structure, |p, look| p.position(look).x),
    ("z", "m", "position z in the axes of the case", Structure, |p, look| p.position(look).z),
    ("curvature", "1/m", "curvature", Beam, MeshProbe::curvature),
    ("strain_upper", "1", "strain lambda - 1 + kappa h_s/2 of the upper surface", Beam, |p, look| p.surface(look, 0)),
    ("strain_lower", "1", "strain lambda - 1 - kappa h_s/2 of the lower surface", Beam, |p, look| p.surface(look, 1)),
    ("stress_upper", "Pa", "stress along the beam of the solid at the upper surface, without viscous damping", Beam, |p, look| p.stress(look, 0)),
    ("stress_lower", "Pa", "stress along the beam of the solid at the lower surface, without viscous damping", Beam, |p, look| p.stress(look, 1)),
    ("normal_force", "N", "normal force without viscous damping", Beam, |p, look| { let n = look.w.normals(); p.of_cells(|c| n[c]) }),
    ("moment", "N m", "bending moment without viscous damping", Beam, |p, look| { let m = look.w.moments(); p.of_nodes(|i| m[i]) }),
    ("shear_force", "N", "shear force", Beam, |p, look| p.of_cells(|c| look.w.shears()[c])),
    ("pressure_upper", "Pa", "mean pressure of the upper bladder", Bladders, |p, look| p.pressure(look, 0)),
    ("pressure_lower", "Pa", "mean pressure of the lower bladder", Bladders, |p, look| p.pressure(look, 1)),
];

/// Quantities of motion.
const MOTION: [&str; 5] = ["u1", "u3", "angle", "x", "z"];

/// Columns of all probes of a system, one probe after the other.
pub fn columns(system: &System) -> impl Iterator<Item = HistoryColumn> + '_ {
    entries(system).map(|(probe, (name, unit, about, ..))| HistoryColumn {
        name: format!("{}_{name}", probe.name),
        unit,
        about: format!("{about} at {} of the length", probe.at),
    })
}

/// Values of the columns in a state.
pub fn values<'a>(look: &'a StateView) -> impl Iterator<Item = f64> + 'a {
    entries(look.system).map(|(probe, entry)| (entry.4)(probe, look))
}

fn entries(system: &System) -> impl Iterator<Item = (&MeshProbe, Entry)> {
    let wet = system.has_bladders();
    // a moment-curvature law does not determine the stress of fibres
    let linear = system.sections.laws.is_empty();
    let placed = system.model.structure.is_some();
    let recorded = move |probe: &MeshProbe, entry: &Entry| {
        let there = match entry.3 {
            Beam => true,
            Bladders => wet,
            Structure => placed,
        };
        there && (linear || !entry.0.starts_with("stress")) && (!probe.motion_only || MOTION.contains(&entry.0))
    };
    let all = system.probes.iter();
    all.flat_map(move |probe| {
        let own = TABLE.into_iter().filter(move |entry| recorded(probe, entry));
        own.map(move |entry| (probe, entry))
    })
}

impl MeshProbe {
    /// Moves it to a mesh in which its first node and its first segment have other numbers.
    pub(in crate::discrete) fn shift(&mut self, nodes: usize, segments: usize) {
        self.node.0 += nodes;
        self.cell.0 += nodes;
        self.strained.0 += nodes;
        self.segment += segments;
    }

    /// Probes of a case.
    pub fn all(case: &Case, mesh: &BeamMesh, sections: &MeshSections) -> Vec<Self> {
        if case.probes.is_empty() {
            return vec![];
        }
        let probe = |probe: &Written| Self::new(&probe.name, probe.at, mesh, sections);
        let mut all: Vec<Self> = case.probes.iter().map(probe).collect();
        let k = mesh.cells_per_segment;
        let place = |one: &Self| {
            (
                one.segment,
                ((one.node.0 - one.segment * k) as f64 + one.node.1) / k as f64,
            )
        };
        let solids = spans::solids(case, &all.iter().map(place).collect::<Vec<_>>());
        for (one, solid) in all.iter_mut().zip(solids) {
            one.surfaces = [0.5, -0.5].map(|side| side * solid.height_m - solid.line_height());
            one.young_modulus = solid.young_modulus_pa;
            one.bending = solid.young_modulus_pa * solid.second_moment();
        }
        all
    }

    /// The tip of a beam of a structure.
    pub(in crate::discrete) fn at_tip(beam: &str, mesh: &BeamMesh, sections: &MeshSections) -> Self {
        Self {
            motion_only: true,
            ..Self::new(&format!("{beam}.tip"), 1.0, mesh, sections)
        }
    }

    fn new(name: &str, at: f64, mesh: &BeamMesh, sections: &MeshSections) -> Self {
        let place = mesh.place(at);
        // a place at a node is there in spite of rounding
        let place = match place.round() {
            node if (place - node).abs() <= ROUNDING * mesh.cells as f64 => node,
            _ => place,
        };
        let node = (place as usize).min(mesh.cells - 1);
        let jump = |node: usize, side: usize| {
            let both = sections.bending_beside[node];
            (both[0] != both[1]).then_some(both[side])
        };
        let cell = mesh.between_midpoints(place);
        let within = place - node as f64;
        let strained = match mesh.at_part_ends(node) {
            [true, true] if mesh.cells > 1 => (node, 0.0),
            [true, _] if cell.0 < node => (node, within - 0.5),
            [_, true] if cell.0 == node && node + 1 < mesh.cells => (node - 1, within + 0.5),
            _ => cell,
        };
        Self {
            name: name.into(),
            at,
            motion_only: false,
            node: (node, within),
            cell,
            strained,
            segment: node / mesh.cells_per_segment,
            jumps: [jump(node, 1), jump(node + 1, 0)],
            surfaces: [0.0; 2],
            young_modulus: 0.0,
            bending: 0.0,
        }
    }

    fn of_nodes(&self, value: impl Fn(usize) -> f64) -> f64 {
        let (node, share) = self.node;
        (1.0 - share) * value(node) + share * value(node + 1)
    }

    fn of_cells(&self, value: impl Fn(usize) -> f64) -> f64 {
        between(self.cell, value)
    }

    /// Angle along the chain of midpoints, `φ_{c+1} = φ_c - h κ_{c+1}`, with the full turns of the tip's angle.
    fn angle(&self, look: &StateView) -> f64 {
        let mesh = &look.system.mesh;
        let kappa = |node: usize| match self.jumps[node - self.node.0] {
            Some(_) => self.node_curvature(look, node),
            None => look.w.shape.kappa[node],
        };
        let (node, share) = self.node;
        let beam = mesh.beam_of_node(node);
        let turns = match beam == look.system.first_tip() {
            true => look.tip_angle() - tip_angle(look.system, look.now, &look.w, beam),
            false => 0.0,
        };
        // from the midpoint of the first cell to that of the cell
        let passed = rotation(look.system, &look.w, node);
        let by = share - 0.5;
        let rest = match () {
            // from the mean angle of the cell, with a linear curvature
            () if mesh.fourth => {
                let [before, behind] = [node, node + 1].map(|i| self.node_curvature(look, i));
                by * 0.5 * (before + behind) + (0.5 * by * by - 1.0 / 24.0) * (behind - before)
            }
            () if share < 0.5 => by * kappa(node),
            () => by * kappa(node + 1),
        };
        first_angle(look.system, look.now, &look.w, beam) - (passed + mesh.lengths[node] * rest) + turns
    }

    /// Displacement, with the curvature of the cell: `r'' = λ κ e_n`, cubic between the nodes.
    fn displacement(&self, look: &StateView) -> Planar<f64> {
        let (system, w) = (look.system, &look.w);
        let (node, share) = self.node;
        let [before, behind] = [node, node + 1].map(|i| w.motion.u[i]);
        let within = share * (1.0 - share);
        let straight = before * (1.0 - share) + behind * share;
        if within == 0.0 || system.model.kinematics == Kinematics::Bar {
            return straight;
        }
        let kappa = [node, node + 1].map(|i| self.node_curvature(look, i));
        let bent = ((2.0 - share) * kappa[0] + (1.0 + share) * kappa[1]) / 3.0;
        let length = system.mesh.lengths[node];
        straight - line(system, w, node).normal() * (0.5 * within * length * length * bent)
    }

    /// Position in the axes of the case [m].
    fn position(&self, look: &StateView) -> Planar<f64> {
        let (node, share) = self.node;
        let at = |node: usize| look.system.rest_position(node);
        at(node) * (1.0 - share) + at(node + 1) * share + look.system.in_axes_of_case(node, self.displacement(look))
    }

    /// `M/EI + α_p + κ_0` of the place: M is continuous where EI and α_p jump, and smooth in a taper.
    fn curvature(&self, look: &StateView) -> f64 {
        let (system, w) = (look.system, &look.w);
        if !self.follows_moment(look) {
            return self.of_nodes(|i| w.curvature()[i]);
        }
        let free = segment_curvature(system, w, self.segment) + self.of_nodes(|i| look.now.rest_curvature(i));
        self.of_nodes(|i| self.own_moment(look, i)) / self.bending + free
    }

    /// True if the moments of both nodes determine curvature: the law is linear, and neutral axes beside the node have their own moments.
    fn follows_moment(&self, look: &StateView) -> bool {
        let (system, w) = (look.system, &look.w);
        let linear = system.sections.laws.is_empty() && w.forces.nonlinear_moment.is_empty();
        let (node, _) = self.node;
        let known = |i: usize, jump: Option<f64>| {
            jump.is_none() || system.sections.offset.is_empty() || system.sections.offset_border(i).is_some()
        };
        linear && !system.model.published() && known(node, self.jumps[0]) && known(node + 1, self.jumps[1])
    }

    /// `EI (κ - α_p - κ_0)` of a node beside the probe, on its side.
    fn own_moment(&self, look: &StateView, node: usize) -> f64 {
        let side = usize::from(node == self.node.0);
        match look.system.sections.offset_border(node) {
            Some(border) => look.w.forces.side_moment[border][side],
            None => look.w.linear_moments()[node],
        }
    }

    /// Curvature of a node beside the probe, on the probe's side of a jump of the section.
    fn node_curvature(&self, look: &StateView, node: usize) -> f64 {
        let (system, w) = (look.system, &look.w);
        match self.jumps[node - self.node.0].filter(|_| self.follows_moment(look)) {
            None => w.curvature()[node],
            Some(stiffness) => {
                let free = segment_curvature(system, w, self.segment) + look.now.rest_curvature(node);
                self.own_moment(look, node) / stiffness + free
            }
        }
    }

    /// `λ - 1 + κ (±h_s/2 - z_r)`, κ relative to the rest curvature.
    fn surface(&self, look: &StateView, side: usize) -> f64 {
        let shape = &look.w.shape;
        let rest = self.of_nodes(|i| look.now.rest_curvature(i));
        between(self.strained, |c| shape.strain[c]) + self.surfaces[side] * (self.curvature(look) - rest)
    }

    /// Stress of a fibre at a surface: Young's modulus E times its strain, plus the stress of the Maxwell branches, which, like strain,
    /// is linear over the section:
    ///
    /// ```text
    /// σ = E (λ - 1 ± κ h_s/2 + N_r/EA ± M_r h_s/(2 EI))        N_r, M_r: forces of the branches
    /// ```
    fn stress(&self, look: &StateView, side: usize) -> f64 {
        let (sections, forces) = (&look.system.sections, &look.w.forces);
        let part = |forces: &[f64], k: usize| forces.get(k).copied().unwrap_or(0.0);
        let normal = |c: usize| part(&forces.relaxing_normal, c) / sections.axial[c];
        let moment = self.of_nodes(|i| part(&forces.relaxing_moment, i));
        let relaxing = between(self.strained, normal) + self.surfaces[side] * moment / self.bending;
        self.young_modulus * (self.surface(look, side) + relaxing)
    }

    fn pressure(&self, look: &StateView, row: usize) -> f64 {
        let wet = look.system.model.wet.as_ref();
        wet.map_or(0.0, |wet| {
            look.system.pressure_of_fluid(&look.w, wet.pair(self.segment)[row])
        })
    }
}

/// Value between a cell and the next.
fn between((cell, share): (usize, f64), value: impl Fn(usize) -> f64) -> f64 {
    match share {
        0.0 => value(cell),
        share => (1.0 - share) * value(cell) + share * value(cell + 1),
    }
}

#[cfg(test)]
mod tests {
    use super::TABLE;
    use crate::discrete::quantities::Observable;

    /// Goal: only a probe named "tip", which is not allowed in cases, would have column names that already exist.
    #[test]
    fn names_of_columns_are_their_own() {
        let ends = |name: &str| {
            TABLE
                .iter()
                .find_map(|entry| name.strip_suffix(&format!("_{}", entry.0)).map(String::from))
        };
        let taken: Vec<String> = Observable::ALL.iter().filter_map(|one| ends(one.name())).collect();
        assert!(!taken.is_empty() && taken.iter().all(|name| name == "tip"), "{taken:?}");
    }
}
