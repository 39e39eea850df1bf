//! Quantities at places named in the case.

use super::Observable;
use super::evaluate::StateView;
use crate::case::schema::{Beam, Case, Probe as Written};
use crate::case::spans;
use crate::discrete::angle_unwrapping::{first_angle, rotation, tip_angle};
use crate::discrete::residual::bending::segment_curvature;
use crate::discrete::{BeamMesh, MeshSections, System};

/// A place of the beam, on a mesh.
///
/// Values of nodes and of cells are interpolated linearly, those of cells extrapolated to the ends of smooth parts: the error is second
/// order in the cell length. Curvatures beside a jump of the section are those of the probe's side; at a jump, those behind it.
#[derive(Clone, Debug)]
pub struct MeshProbe {
    /// First part of its column names.
    pub name: String,
    /// Place `θ/l_s`.
    pub at: f64,
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
}

/// One row of the table: last part of the column name, unit, description, need of bladders, evaluation.
type Entry = (
    &'static str,
    &'static str,
    &'static str,
    bool,
    fn(&MeshProbe, &StateView) -> f64,
);

/// Quantities recorded at each probe.
#[rustfmt::skip]
const TABLE: [Entry; 13] = [
    ("u1", "m", "transverse displacement", false, |p, look| p.of_nodes(|i| look.w.motion.u[i].x)),
    ("u3", "m", "axial displacement", false, |p, look| p.of_nodes(|i| look.w.motion.u[i].z)),
    ("angle", "rad", "slope angle phi, counted over full turns", false, MeshProbe::angle),
    ("curvature", "1/m", "curvature", false, MeshProbe::curvature),
    ("strain_upper", "1", "strain lambda - 1 + kappa h_s/2 of the upper surface", false, |p, look| p.surface(look, 0)),
    ("strain_lower", "1", "strain lambda - 1 - kappa h_s/2 of the lower surface", false, |p, look| p.surface(look, 1)),
    ("stress_upper", "Pa", "stress along the beam of the solid at the upper surface, without viscous damping", false, |p, look| p.stress(look, 0)),
    ("stress_lower", "Pa", "stress along the beam of the solid at the lower surface, without viscous damping", false, |p, look| p.stress(look, 1)),
    ("normal_force", "N", "normal force without viscous damping", false, |p, look| { let n = look.w.normals(); p.of_cells(|c| n[c]) }),
    ("moment", "N m", "bending moment without viscous damping", false, |p, look| { let m = look.w.moments(); p.of_nodes(|i| m[i]) }),
    ("shear_force", "N", "shear force", false, |p, look| p.of_cells(|c| look.w.shears()[c])),
    ("pressure_upper", "Pa", "mean pressure of the upper bladder", true, |p, look| p.pressure(look, 0)),
    ("pressure_lower", "Pa", "mean pressure of the lower bladder", true, |p, look| p.pressure(look, 1)),
];

/// A column of the history: one number per output time.
#[derive(Clone, Debug, PartialEq)]
pub struct HistoryColumn {
    /// Name without unit, snake case: `tip_u1`.
    pub name: String,
    /// Unit: `m`; `1` when dimensionless.
    pub unit: &'static str,
    /// Description in one sentence.
    pub about: String,
}

impl HistoryColumn {
    /// Name with unit, for keys of equilibria: `tip_u1_m`. The summary of a run uses [`key`].
    pub fn key(&self) -> String {
        let unit = match self.unit {
            "1" => return self.name.clone(),
            "Pa" => "pa",
            "J" => "j",
            "W" => "w",
            other => other,
        };
        format!("{}_{unit}", self.name)
    }
}

impl From<Observable> for HistoryColumn {
    fn from(one: Observable) -> Self {
        Self {
            name: one.name().into(),
            unit: one.unit(),
            about: one.about().into(),
        }
    }
}

/// Name with unit, for keys of probes and ports in the summary: `middle_u1_m`, `port_inlet_flow_m3_s`.
pub fn key(name: &str, unit: &str) -> String {
    match unit {
        "1" => name.into(),
        unit => format!(
            "{name}_{}",
            unit.to_lowercase()
                .replace("1/", "per_")
                .replace([' ', '/'], "_")
                .replace('^', "")
        ),
    }
}

/// True if the name of a column is that of a stress of the solid. It has the unit of fluid pressures but another order
/// of magnitude.
pub fn is_stress(name: &str) -> bool {
    name.ends_with("_stress_upper") || name.ends_with("_stress_lower")
}

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
    let of = move |probe| {
        TABLE
            .into_iter()
            .filter(move |entry| wet || !entry.3)
            .filter(move |entry| linear || !entry.0.starts_with("stress"))
            .map(move |e| (probe, e))
    };
    system.probes.iter().flat_map(of)
}

impl MeshProbe {
    /// Probes of a case.
    pub fn all(case: &Case, mesh: &BeamMesh, sections: &MeshSections) -> Vec<Self> {
        let segments = spans::segments(case);
        let parts = 2 * mesh.cells_per_segment;
        let within = match case.probes.is_empty() {
            true => vec![],
            false => spans::within(case, &segments, parts),
        };
        let probe = |probe: &Written| {
            let mut one = Self::new(&probe.name, probe.at, mesh, sections);
            let surfaces = |beam: &Beam| [0.5, -0.5].map(|side| side * beam.height_m - beam.line_height());
            let (node, share) = one.node;
            if let Some(beams @ [_, ..]) = within.get(one.segment).map(|beams| &beams[..]) {
                let place = 2.0 * ((node - one.segment * mesh.cells_per_segment) as f64 + share);
                let before = (place as usize).min(parts - 1);
                let pair = [&beams[before], &beams[before + 1]];
                let share = place - before as f64;
                let between = |[a, b]: [f64; 2]| a + share * (b - a);
                let sides = pair.map(surfaces);
                one.surfaces = [0, 1].map(|side| between([sides[0][side], sides[1][side]]));
                one.young_modulus = between(pair.map(|beam| beam.young_modulus_pa));
                return one;
            }
            let beam = segments.get(one.segment).map_or(&case.beam, |values| &values.beam);
            one.surfaces = surfaces(beam);
            one.young_modulus = beam.young_modulus_pa;
            one
        };
        case.probes.iter().map(probe).collect()
    }

    fn new(name: &str, at: f64, mesh: &BeamMesh, sections: &MeshSections) -> Self {
        let place = mesh.place(at);
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
            node: (node, within),
            cell,
            strained,
            segment: node / mesh.cells_per_segment,
            jumps: [jump(node, 1), jump(node + 1, 0)],
            surfaces: [0.0; 2],
            young_modulus: 0.0,
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
        let (kappa, mesh) = (&look.w.shape.kappa, &look.system.mesh);
        let (node, share) = self.node;
        let turns = look.tip_angle() - tip_angle(look.system, look.now, &look.w);
        // from the midpoint of the first cell to that of the cell
        let passed = rotation(look.system, &look.w, node);
        let rest = match (node, share) {
            (0, share) if share < 0.5 => (share - 0.5) * kappa[0],
            (_, share) if share < 0.5 => (share - 0.5) * kappa[node],
            _ => (share - 0.5) * kappa[node + 1],
        };
        first_angle(look.system, look.now, &look.w) - (passed + mesh.lengths[node] * rest) + turns
    }

    fn curvature(&self, look: &StateView) -> f64 {
        self.of_nodes(|i| self.node_curvature(look, i))
    }

    /// Curvature of a node beside the probe, on the probe's side of a jump of the section: `M/EI + α_p + κ_0`.
    fn node_curvature(&self, look: &StateView, node: usize) -> f64 {
        let (system, w) = (look.system, &look.w);
        let own = self.jumps[node - self.node.0];
        // a nonlinear law has no such EI
        let linear = system.sections.laws.is_empty() && w.forces.nonlinear_moment.is_empty();
        let Some(stiffness) = own.filter(|_| linear) else {
            return w.curvature()[node];
        };
        let right = usize::from(node == self.node.0);
        match system.sections.offset_border(node) {
            Some(border) => w.shape.side_curvature[border][right],
            None if !system.sections.offset.is_empty() => w.curvature()[node],
            None => {
                let free = segment_curvature(system, w, self.segment) + look.now.rest_curvature(node);
                w.linear_moments()[node] / stiffness + free
            }
        }
    }

    /// `λ - 1 + κ (±h_s/2 - z_r)`, κ relative to the rest curvature.
    fn surface(&self, look: &StateView, side: usize) -> f64 {
        let shape = &look.w.shape;
        between(self.strained, |c| shape.strain[c])
            + self.surfaces[side] * self.of_nodes(|i| self.node_curvature(look, i) - look.now.rest_curvature(i))
    }

    /// Stress of a fibre at a surface: Young's modulus E times its strain, plus the stress of the Maxwell branches, which, like strain,
    /// is linear over the section:
    ///
    /// ```text
    /// σ = E (λ - 1 ± κ h_s/2 + N_r/EA ± M_r h_s/(2 EI))        N_r, M_r: forces of the branches
    /// ```
    fn stress(&self, look: &StateView, side: usize) -> f64 {
        let (sections, forces) = (&look.system.sections, &look.w.forces);
        let normal = |c: usize| {
            forces
                .relaxing_normal
                .get(c)
                .map_or(0.0, |force| force / sections.axial[c])
        };
        let own = |i: usize| self.jumps[i - self.node.0].unwrap_or(sections.bending[i]);
        let moment = |i: usize| forces.relaxing_moment.get(i).map_or(0.0, |moment| moment / own(i));
        let relaxing = between(self.strained, normal) + self.surfaces[side] * self.of_nodes(moment);
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
