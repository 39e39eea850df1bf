//! Stiffness and inertia of the beam's sections on a mesh.

use super::BeamMesh;
use super::smooth_parts::SmoothBending;
use crate::model::surroundings::AmbientSection;
use crate::model::{Model, NodeBending, Section};

/// `[E83]` Sections along the beam. A cell has the section of its midpoint, a node that of its place. At a node between two segments with
/// different sections the moment is continuous, so that compliances add, with those of their bladders:
///
/// ```text
/// 1/EI_i = s_l/EI_l + s_r/EI_r        α_p,i = s_l α_p,l + s_r α_p,r        m_i = s_l m_l + s_r m_r        s_l = h_l/(h_l + h_r)
/// ```
///
/// In a uniform beam all of them are equal. On a mesh of fourth order, stiffness and rotary inertia are means as strains are, over cells and
/// over the hat functions of nodes, and the shares in m are those of [E78].
#[derive(Clone, Debug)]
pub struct MeshSections {
    /// `EA` of each cell [N].
    pub axial: Vec<f64>,
    /// `EI` of each node [N m^2].
    pub bending: Vec<f64>,
    /// `EI` at the place of each node, where it is not that of `bending` [N m^2]; empty if it is everywhere.
    bending_at_place: Vec<f64>,
    /// `EI` on the left and on the right of each node [N m^2].
    pub bending_beside: Vec<[f64; 2]>,
    /// Moment-curvature laws of the nodes, [E91]; empty if all are linear.
    pub laws: Vec<NodeBending>,
    /// Distance of the farthest fiber from the beam's line at each node, the larger one between two segments [m].
    pub farthest_fiber: Vec<f64>,
    /// Largest strain over curvature at each node [m]: the distance of the farthest fiber, between two segments that of the side that
    /// bends more, times its share of the curvature.
    pub fiber_of_curvature: Vec<f64>,
    /// `d` of each cell, [E89] [m]; empty if all neutral axes are at the beam's line.
    pub offset: Vec<f64>,
    /// Nodes where d or EI jumps in a beam with `offset`, between parts of two or more cells; empty with moment-curvature laws.
    pub offset_borders: Vec<usize>,
    /// `EI` of each cell [N m^2].
    pub bending_of_cells: Vec<f64>,
    /// `kGA` of each cell [N]; infinite without shear.
    pub shear: Vec<f64>,
    /// `EA τ_a` of each cell [N s].
    pub axial_viscosity: Vec<f64>,
    /// `EI τ_b` of each node, between two segments `EI_i² Σ s τ_b/EI`, that of slow motions of both in series [N m^2 s].
    pub bending_viscosity: Vec<f64>,
    /// `kGA τ_b` of each cell [N s].
    pub shear_viscosity: Vec<f64>,
    /// `m y11` of each cell [kg m].
    pub rotary: Vec<f64>,
    /// Mass per length of each node [kg/m].
    pub mass: Vec<f64>,
    /// Ambient fluid at each node; empty without.
    pub ambient: Vec<AmbientSection>,
    /// Mass per length of each node less that of the displaced ambient fluid [kg/m].
    pub weighing: Vec<f64>,
    /// Weights of bending on a mesh of fourth order, [E77].
    pub smooth: SmoothBending,
}

/// Places on the mesh, and their sections in a model.
struct PlacedSections<'a> {
    model: &'a Model,
    mesh: &'a BeamMesh,
}

impl<'a> PlacedSections<'a> {
    /// Section of a segment at a number of half cells from its beginning.
    fn within(&self, segment: usize, half_cells: usize) -> &'a Section {
        let within = self.model.within.get(segment).and_then(|within| within.get(half_cells));
        within.unwrap_or_else(|| self.model.section_of(segment))
    }

    /// Value in the middle of each cell.
    fn in_cells(&self, value: fn(&Section) -> f64) -> Vec<f64> {
        let k = self.mesh.cells_per_segment;
        let of = |cell: usize| value(self.within(cell / k, 2 * (cell % k) + 1));
        (0..self.mesh.cells).map(of).collect()
    }

    /// Mean of each cell, on a mesh of second order its value in the middle.
    fn means(&self, value: fn(&Section) -> f64) -> Vec<f64> {
        let mut all = self.in_cells(value);
        if self.mesh.fourth {
            let k = self.mesh.cells_per_segment;
            for (cell, middle) in all.iter_mut().enumerate() {
                let ends = [0, 2].map(|end| value(self.within(cell / k, 2 * (cell % k) + end)));
                if ends != [*middle; 2] {
                    *middle = (ends[0] + 4.0 * *middle + ends[1]) / 6.0;
                }
            }
        }
        all
    }

    /// Sections on both sides of each node.
    fn beside_nodes(&self) -> impl Iterator<Item = [&'a Section; 2]> {
        let k = self.mesh.cells_per_segment;
        (0..self.mesh.nodes).map(move |node| {
            let (left, right) = self.mesh.segments_of_node(node);
            [left, right].map(|segment| self.within(segment, 2 * (node - segment * k)))
        })
    }

    /// Mean of both sides of each node with the given shares.
    fn at_nodes(&self, shares: &[[f64; 2]], value: impl Fn(&Section) -> f64) -> Vec<f64> {
        let each = self.beside_nodes().zip(shares);
        each.map(|([left, right], shares)| match left == right {
            true => value(left),
            false => shares[0] * value(left) + shares[1] * value(right),
        })
        .collect()
    }
}

/// In series: compliances add with their shares.
pub fn in_series([left, right]: [f64; 2], shares: [f64; 2]) -> f64 {
    match left == right {
        true => left,
        false => 1.0 / (shares[0] / left + shares[1] / right),
    }
}

impl MeshSections {
    /// Appends the sections of another beam behind an empty cell; `nodes` is the number of nodes before.
    pub(super) fn append(&mut self, next: Self, nodes: usize) {
        // the empty cell has neither stiffness nor mass
        let cells = [
            (&mut self.axial, next.axial),
            (&mut self.bending_of_cells, next.bending_of_cells),
            (&mut self.shear, next.shear),
            (&mut self.axial_viscosity, next.axial_viscosity),
            (&mut self.shear_viscosity, next.shear_viscosity),
            (&mut self.rotary, next.rotary),
        ];
        for (own, next) in cells {
            own.push(0.0);
            own.extend(next);
        }
        if !(self.offset.is_empty() && next.offset.is_empty()) {
            self.offset.resize(nodes, 0.0);
            self.offset.extend(next.offset);
            self.offset.resize(self.axial.len(), 0.0);
        }
        if !(self.laws.is_empty() && next.laws.is_empty()) {
            debug_assert_eq!(self.laws.len(), nodes, "laws are given for all beams or none");
        }
        for (own, next) in [
            (&mut self.bending, next.bending),
            (&mut self.farthest_fiber, next.farthest_fiber),
            (&mut self.fiber_of_curvature, next.fiber_of_curvature),
            (&mut self.bending_viscosity, next.bending_viscosity),
            (&mut self.mass, next.mass),
            (&mut self.weighing, next.weighing),
        ] {
            own.extend(next);
        }
        self.bending_beside.extend(next.bending_beside);
        self.laws.extend(next.laws);
        self.offset_borders
            .extend(next.offset_borders.iter().map(|node| node + nodes));
        self.ambient.extend(next.ambient);
    }

    /// Rotation between the midpoints of a cell and the next, at a place `s` of the way: its share before the place, and the compliance of
    /// both sides in parallel [rad/(N m)]. On each side it is uniform.
    pub fn turning(&self, cell: usize, s: f64, mesh: &BeamMesh) -> (f64, f64) {
        let [left, right] = [self.bending_of_cells[cell], self.bending_of_cells[cell + 1]];
        let [half, other] = [mesh.lengths[cell], mesh.lengths[cell + 1]].map(|length| 0.5 * length);
        if left == right {
            return (s, s * (1.0 - s) * (half + other) / left);
        }
        let along = s * (half + other);
        let before = along.min(half) / left + (along - half).max(0.0) / right;
        let whole = half / left + other / right;
        (before / whole, before * (whole - before) / whole)
    }

    /// Index of a node among those where neutral axes jump.
    #[inline]
    pub fn offset_border(&self, node: usize) -> Option<usize> {
        self.offset_borders.binary_search(&node).ok()
    }

    /// `EI` at the place of a node [N m^2].
    pub fn bending_at(&self, node: usize) -> f64 {
        *self.bending_at_place.get(node).unwrap_or(&self.bending[node])
    }

    /// Sections of a model on a mesh.
    pub fn new(model: &Model, mesh: &BeamMesh) -> Self {
        let placed = PlacedSections { model, mesh };
        let shares: Vec<[f64; 2]> = (0..mesh.nodes).map(|node| mesh.sides_of_node(node).1).collect();
        let masses = mesh.shares_in_mass(&shares);
        let stiffness: Vec<[f64; 2]> = placed
            .beside_nodes()
            .map(|sides| sides.map(|section| section.bending_stiffness))
            .collect();
        let beside = stiffness.iter().zip(&shares);
        let at_place: Vec<f64> = beside.map(|(sides, shares)| in_series(*sides, *shares)).collect();
        let [axial, shear] = [
            placed.means(|section| section.axial_stiffness),
            placed.means(|section| section.shear_stiffness),
        ];
        let times = |time: fn(&Section) -> f64, stiffness: &[f64]| -> Vec<f64> {
            let each = placed.in_cells(time).into_iter().zip(stiffness);
            // infinite stiffness has no strain
            each.map(|(time, stiffness)| if time > 0.0 { stiffness * time } else { 0.0 })
                .collect()
        };
        let (smooth, bending) = match mesh.fourth {
            true => SmoothBending::new(model, mesh, &stiffness),
            false => (SmoothBending::default(), at_place.clone()),
        };
        let offset = placed.in_cells(|section| section.offset);
        let law = |segment: usize| model.bending.get(segment).unwrap_or(&model.bending[0]);
        Self {
            axial_viscosity: times(|section| section.axial_damping_time, &axial),
            bending_viscosity: placed
                .beside_nodes()
                .zip(&shares)
                .zip(&bending)
                .map(|((sides, shares), bending)| {
                    let [left, right] = sides.map(|side| side.bending_damping_time);
                    if left == right {
                        return bending * left;
                    }
                    let compliant = [0, 1].map(|k| shares[k] / sides[k].bending_stiffness);
                    bending * bending * (left * compliant[0] + right * compliant[1])
                })
                .collect(),
            shear_viscosity: times(|section| section.bending_damping_time, &shear),
            axial,
            smooth,
            bending_at_place: match bending == at_place {
                true => vec![],
                false => at_place,
            },
            bending,
            laws: match model.bending.is_empty() {
                true => vec![],
                false => (0..mesh.nodes)
                    .map(|node| {
                        let ([left, right], shares) = mesh.sides_of_node(node);
                        NodeBending::new(law(left), law(right), shares)
                    })
                    .collect(),
            },
            bending_beside: stiffness,
            bending_of_cells: placed.in_cells(|section| section.bending_stiffness),
            farthest_fiber: placed
                .beside_nodes()
                .map(|[left, right]| left.farthest_fiber().max(right.farthest_fiber()))
                .collect(),
            fiber_of_curvature: placed
                .beside_nodes()
                .zip(&shares)
                .map(|(sides, shares)| {
                    let [left, right] = sides;
                    if left == right {
                        return left.farthest_fiber();
                    }
                    let mean = in_series(sides.map(|side| side.bending_stiffness), *shares);
                    let of = |side: &Section| side.farthest_fiber() * mean / side.bending_stiffness;
                    of(left).max(of(right))
                })
                .collect(),
            offset_borders: match model.bending.is_empty() && offset.iter().any(|d| *d != 0.0) {
                false => vec![],
                true => mesh
                    .parts
                    .windows(2)
                    .filter(|pair| pair.iter().all(|part| part.len() > 1))
                    .map(|pair| pair[1].start)
                    .collect(),
            },
            offset: match offset.iter().all(|d| *d == 0.0) {
                true => vec![],
                false => offset,
            },
            shear,
            rotary: placed.means(Section::rotary_inertia),
            ambient: match &model.surroundings {
                None => vec![],
                Some(_) => (0..mesh.nodes)
                    .zip(placed.beside_nodes())
                    .map(|(node, [left, right])| {
                        let [s_l, s_r] = masses[node];
                        let (left, right) = (&left.ambient, &right.ambient);
                        match left == right {
                            true => *left,
                            false => AmbientSection::mean(|value| s_l * value(left) + s_r * value(right)),
                        }
                    })
                    .collect(),
            },
            mass: placed.at_nodes(&masses, |section| section.mass_per_length),
            weighing: placed.at_nodes(&masses, Section::weighing_per_length),
        }
    }
}
