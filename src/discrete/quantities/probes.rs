//! Quantities at places named in the case.

use super::Observable;
use super::evaluate::StateView;
use crate::case::schema::{Case, Probe as Written};
use crate::case::spans;
use crate::discrete::angle_unwrapping::{first_angle, rotation, tip_angle};
use crate::discrete::{BeamMesh, System};

/// A place of the beam, on a mesh.
///
/// Values of nodes and of cells are interpolated linearly, those of cells extrapolated to the ends: the error is second order in the cell
/// length.
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
    /// Segment of the probe.
    segment: usize,
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
    ("curvature", "1/m", "curvature", false, |p, look| { let kappa = look.w.curvature(); p.of_nodes(|i| kappa[i]) }),
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
    pub fn all(case: &Case, mesh: &BeamMesh) -> Vec<Self> {
        let segments = spans::segments(case);
        let probe = |probe: &Written| {
            let mut one = Self::new(&probe.name, probe.at, mesh);
            let beam = segments.get(one.segment).map_or(&case.beam, |values| &values.beam);
            one.surfaces = [0.5, -0.5].map(|side| side * beam.height_m - beam.line_height());
            one.young_modulus = beam.young_modulus_pa;
            one
        };
        case.probes.iter().map(probe).collect()
    }

    fn new(name: &str, at: f64, mesh: &BeamMesh) -> Self {
        let place = mesh.place(at);
        let node = (place as usize).min(mesh.cells - 1);
        Self {
            name: name.into(),
            at,
            node: (node, place - node as f64),
            cell: mesh.between_midpoints(place),
            segment: node / mesh.cells_per_segment,
            surfaces: [0.0; 2],
            young_modulus: 0.0,
        }
    }

    fn of_nodes(&self, value: impl Fn(usize) -> f64) -> f64 {
        let (node, share) = self.node;
        (1.0 - share) * value(node) + share * value(node + 1)
    }

    fn of_cells(&self, value: impl Fn(usize) -> f64) -> f64 {
        match self.cell {
            (cell, 0.0) => value(cell),
            (cell, share) => (1.0 - share) * value(cell) + share * value(cell + 1),
        }
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

    /// `λ - 1 + κ (±h_s/2 - z_r)`, κ relative to the rest curvature.
    fn surface(&self, look: &StateView, side: usize) -> f64 {
        let shape = &look.w.shape;
        self.of_cells(|c| shape.strain[c])
            + self.surfaces[side] * self.of_nodes(|i| look.w.curvature()[i] - look.now.rest_curvature(i))
    }

    /// Stress of a fibre at a surface: Young's modulus E times its strain, plus the stress of the Maxwell branches, which, like strain,
    /// is linear over the section:
    ///
    /// ```text
    /// σ = E (λ - 1 ± κ h_s/2 + N_r/EA ± M_r h_s/(2 EI))        N_r, M_r: forces of the branches
    /// ```
    fn stress(&self, look: &StateView, side: usize) -> f64 {
        let (sections, forces) = (&look.system.sections, &look.w.forces);
        let part =
            |forces: &[f64], stiffness: &[f64], k: usize| forces.get(k).map_or(0.0, |force| force / stiffness[k]);
        let normal = |c: usize| part(&forces.relaxing_normal, &sections.axial, c);
        let moment = |i: usize| part(&forces.relaxing_moment, &sections.bending, i);
        let relaxing = self.of_cells(normal) + self.surfaces[side] * self.of_nodes(moment);
        self.young_modulus * (self.surface(look, side) + relaxing)
    }

    fn pressure(&self, look: &StateView, row: usize) -> f64 {
        let wet = look.system.model.wet.as_ref();
        wet.map_or(0.0, |wet| {
            look.system.pressure_of_fluid(&look.w, wet.pair(self.segment)[row])
        })
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
