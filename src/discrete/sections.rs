//! Stiffness and inertia of the beam's sections on a mesh.

use super::BeamMesh;
use crate::model::surroundings::AmbientSection;
use crate::model::{AmbientFluid, Model, NodeBending, Section};

/// `[E83]` Sections along the beam. A cell has the section of its segment. At a node between two segments the moment is continuous, so that
/// compliances add, with those of their bladders:
///
/// ```text
/// 1/EI_i = s_l/EI_l + s_r/EI_r        α_p,i = s_l α_p,l + s_r α_p,r        m_i = s_l m_l + s_r m_r        s_l = h_l/(h_l + h_r)
/// ```
///
/// In a uniform beam all of them are equal.
#[derive(Clone, Debug)]
pub struct MeshSections {
    /// `EA` of each cell [N].
    pub axial: Vec<f64>,
    /// `EI` of each node [N m^2].
    pub bending: Vec<f64>,
    /// Moment-curvature laws of the nodes, [E91]; empty if all are linear.
    pub laws: Vec<NodeBending>,
    /// Distance of the farthest fiber from the beam's line at each node, the larger one between two segments [m].
    pub farthest_fiber: Vec<f64>,
    /// Largest strain over curvature at each node [m]: the distance of the farthest fiber, between two segments that of the side that
    /// bends more, times its share of the curvature.
    pub fiber_of_curvature: Vec<f64>,
    /// `d` of each cell, [E89] [m]; empty if all neutral axes are at the beam's line.
    pub offset: Vec<f64>,
    /// `EI` of each cell [N m^2].
    pub bending_of_cells: Vec<f64>,
    /// `kGA` of each cell [N]; infinite without shear.
    pub shear: Vec<f64>,
    /// `m y11` of each cell [kg m].
    pub rotary: Vec<f64>,
    /// Mass per length of each node [kg/m].
    pub mass: Vec<f64>,
    /// Ambient fluid at each node; empty without.
    pub ambient: Vec<AmbientSection>,
    /// Mass per length of each node less that of the displaced ambient fluid [kg/m].
    pub weighing: Vec<f64>,
}

impl MeshSections {
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

    /// Sections of a model on a mesh.
    pub fn new(model: &Model, mesh: &BeamMesh) -> Self {
        let of = |segment: usize| model.section_of(segment);
        let cells = |value: fn(&Section) -> f64| -> Vec<f64> {
            (0..mesh.cells)
                .map(|cell| value(of(cell / mesh.cells_per_segment)))
                .collect()
        };
        let nodes = |mean: &dyn Fn([&Section; 2], [f64; 2]) -> f64| -> Vec<f64> {
            let each = (0..mesh.nodes).map(|node| mesh.sides_of_node(node));
            each.map(|(sides, shares)| mean(sides.map(of), shares)).collect()
        };
        let mean = |value: fn(&Section) -> f64| {
            nodes(&|[left, right], shares| match left == right {
                true => value(left),
                false => shares[0] * value(left) + shares[1] * value(right),
            })
        };
        let ambient = |around: &AmbientFluid| -> Vec<AmbientSection> {
            let of = |segment: usize| *around.segments.get(segment).unwrap_or(&around.section);
            let each = (0..mesh.nodes).map(|node| mesh.sides_of_node(node));
            each.map(|([left, right], shares)| of(left).mean(of(right), shares))
                .collect()
        };
        Self {
            axial: cells(|section| section.axial_stiffness),
            bending: nodes(&|[left, right], shares| match left == right {
                true => left.bending_stiffness,
                false => 1.0 / (shares[0] / left.bending_stiffness + shares[1] / right.bending_stiffness),
            }),
            laws: match &model.bending[..] {
                [] => vec![],
                laws => {
                    let law = |segment: usize| laws.get(segment).unwrap_or(&laws[0]);
                    let each = (0..mesh.nodes).map(|node| mesh.sides_of_node(node));
                    each.map(|([left, right], shares)| NodeBending::new(law(left), law(right), shares))
                        .collect()
                }
            },
            bending_of_cells: cells(|section| section.bending_stiffness),
            farthest_fiber: nodes(&|[left, right], _| left.farthest_fiber().max(right.farthest_fiber())),
            fiber_of_curvature: nodes(&|[left, right], shares| {
                if left == right {
                    return left.farthest_fiber();
                }
                let compliance = shares[0] / left.bending_stiffness + shares[1] / right.bending_stiffness;
                let of = |side: &Section| side.farthest_fiber() / (side.bending_stiffness * compliance);
                of(left).max(of(right))
            }),
            offset: match cells(|section| section.offset) {
                all if all.iter().all(|d| *d == 0.0) => vec![],
                all => all,
            },
            shear: cells(|section| section.shear_stiffness),
            rotary: cells(Section::rotary_inertia),
            ambient: model.surroundings.iter().flat_map(ambient).collect(),
            mass: mean(|section| section.mass_per_length),
            weighing: mean(|section| section.weighing_per_length),
        }
    }
}
