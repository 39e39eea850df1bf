//! Stiffness and inertia of the beam's sections on a mesh.

use super::BeamMesh;
use crate::model::{Model, NodeBending, Section};

/// `[E83]` Sections along the beam. A cell has the section of its segment. At a node between two segments the moment is continuous, so that
/// compliances add, with those of their bladders:
///
/// ```text
/// EI_i = 2/(1/EI_left + 1/EI_right)        α_p,i = (α_p,left + α_p,right)/2        m_i = (m_left + m_right)/2
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
    /// Mass per length of each node less that of the displaced ambient fluid [kg/m].
    pub weighing: Vec<f64>,
}

impl MeshSections {
    /// Rotation between the midpoints of a cell and the next, at a place `s` of the way: its share before the place, and the compliance of
    /// both sides in parallel [rad/(N m)]. On each side it is uniform.
    pub fn turning(&self, cell: usize, s: f64, h: f64) -> (f64, f64) {
        let [left, right] = [self.bending_of_cells[cell], self.bending_of_cells[cell + 1]];
        if left == right {
            return (s, s * (1.0 - s) * h / left);
        }
        let before = h * (s.min(0.5) / left + (s - 0.5).max(0.0) / right);
        let whole = 0.5 * h * (1.0 / left + 1.0 / right);
        (before / whole, before * (whole - before) / whole)
    }

    /// Sections of a model on a mesh.
    pub fn new(model: &Model, mesh: &BeamMesh) -> Self {
        let of = |segment: usize| model.sections.get(segment).unwrap_or(&model.section);
        let cells = |value: fn(&Section) -> f64| -> Vec<f64> {
            (0..mesh.cells)
                .map(|cell| value(of(cell / mesh.cells_per_segment)))
                .collect()
        };
        let nodes = |mean: &dyn Fn(&Section, &Section) -> f64| -> Vec<f64> {
            let beside = |node| mesh.segments_of_node(node);
            (0..mesh.nodes)
                .map(beside)
                .map(|(left, right)| mean(of(left), of(right)))
                .collect()
        };
        let half_sum = |value: fn(&Section) -> f64| {
            nodes(&|left, right| match left == right {
                true => value(left),
                false => 0.5 * (value(left) + value(right)),
            })
        };
        Self {
            axial: cells(|section| section.axial_stiffness),
            bending: nodes(&|left, right| match left == right {
                true => left.bending_stiffness,
                false => 2.0 / (1.0 / left.bending_stiffness + 1.0 / right.bending_stiffness),
            }),
            laws: match &model.bending[..] {
                [] => vec![],
                laws => (0..mesh.nodes)
                    .map(|node| mesh.segments_of_node(node))
                    .map(|(left, right)| [left, right].map(|segment| laws.get(segment).unwrap_or(&laws[0])))
                    .map(|[left, right]| NodeBending::new(left, right))
                    .collect(),
            },
            bending_of_cells: cells(|section| section.bending_stiffness),
            farthest_fiber: nodes(&|left, right| left.farthest_fiber().max(right.farthest_fiber())),
            offset: match cells(|section| section.offset) {
                all if all.iter().all(|d| *d == 0.0) => vec![],
                all => all,
            },
            shear: cells(|section| section.shear_stiffness),
            rotary: cells(Section::rotary_inertia),
            mass: half_sum(|section| section.mass_per_length),
            weighing: half_sum(|section| section.weighing_per_length),
        }
    }
}
