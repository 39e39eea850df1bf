//! Fields along the beam and along the network.

use std::borrow::Cow;

use super::observables::QuantityRole;
use crate::case::wiring::bladder_label;
use crate::discrete::{BeamMesh, System, Workspace};
use crate::model::mapping::NetworkCoordinate;

/// Fixed arrays along a line: coordinates and indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldAxis {
    /// Nodes of the beam.
    Nodes,
    /// Cells of the beam.
    Cells,
    /// Cells of the bladders.
    Network,
    /// Bladder of each cell of the bladders.
    Bladder,
    /// Connected array of each cell of the bladders.
    Array,
    /// Beam of each node of a structure.
    BeamOfNode,
    /// Beam of each cell of a structure.
    BeamOfCell,
    /// Position x of the nodes of a structure at rest.
    RestX,
    /// Position z of the nodes of a structure at rest.
    RestZ,
    /// Direction of the straight beam of each node of a structure.
    RestAngle,
}

/// A quantity at every place along a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeamField {
    /// Transverse displacement.
    U1,
    /// Axial displacement.
    U3,
    /// Transverse velocity.
    V1,
    /// Axial velocity.
    V3,
    /// Curvature.
    Curvature,
    /// Angle of sections that shear.
    SectionAngle,
    /// Bending moment.
    Moment,
    /// Normal force.
    NormalForce,
    /// Pressure.
    Pressure,
    /// Area change.
    AreaChange,
}

/// One row of the table: name with unit, unit, axis, role, description, evaluation.
type Entry = (
    &'static str,
    &'static str,
    FieldAxis,
    QuantityRole,
    &'static str,
    for<'w> fn(&'w Workspace<f64>) -> Cow<'w, [f64]>,
);

impl BeamField {
    /// All fields, in the order in which they are recorded.
    pub const ALL: [Self; 10] = [
        Self::U1,
        Self::U3,
        Self::V1,
        Self::V3,
        Self::Curvature,
        Self::SectionAngle,
        Self::Moment,
        Self::NormalForce,
        Self::Pressure,
        Self::AreaChange,
    ];

    #[rustfmt::skip]
    fn entry(self) -> Entry {
        use FieldAxis::{Cells, Network, Nodes};
        use QuantityRole::{Recorded, Studied};
        match self {
            Self::U1 => ("u1_m", "m", Nodes, Studied, "transverse displacement", |w| w.motion.u.iter().map(|u| u.x).collect()),
            Self::U3 => ("u3_m", "m", Nodes, Studied, "axial displacement", |w| w.motion.u.iter().map(|u| u.z).collect()),
            Self::V1 => ("v1_m_s", "m/s", Nodes, Studied, "transverse velocity", |w| w.motion.v.iter().map(|v| v.x).collect()),
            Self::V3 => ("v3_m_s", "m/s", Nodes, Studied, "axial velocity", |w| w.motion.v.iter().map(|v| v.z).collect()),
            Self::Curvature => ("curvature_1_m", "1/m", Nodes, Recorded, "curvature, positive with the +x fibre in tension", |w| Cow::Borrowed(w.curvature())),
            Self::SectionAngle => ("section_angle_rad", "rad", Cells, Recorded, "angle of the section, where sections shear", |w| Cow::Borrowed(&w.shape.sections.angle)),
            Self::Moment => ("moment_n_m", "N m", Nodes, Recorded, "bending moment", |w| w.moments()),
            Self::NormalForce => ("normal_force_n", "N", Cells, Recorded, "normal force", |w| w.normals()),
            Self::Pressure => ("pressure_pa", "Pa", Network, Recorded, "pressure of the bladder cells", |w| Cow::Borrowed(&w.fluid.pressure)),
            Self::AreaChange => ("area_change_m2", "m^2", Network, Recorded, "area change of the bladder cells", |w| Cow::Borrowed(w.fluid.area_changes())),
        }
    }

    /// Name of the field's array, including the unit: `u1_m`.
    pub fn name(self) -> &'static str {
        self.entry().0
    }

    /// Unit.
    pub fn unit(self) -> &'static str {
        self.entry().1
    }

    /// Line along which the field is defined.
    pub fn axis(self) -> FieldAxis {
        self.entry().2
    }

    /// Role of the field in outputs.
    pub fn role(self) -> QuantityRole {
        self.entry().3
    }

    /// Description in one sentence.
    pub fn about(self) -> &'static str {
        self.entry().4
    }

    /// Values in a state, in the order of the mesh; along the network they are recorded in the order of [`cell_order`].
    pub fn values(self, w: &Workspace<f64>) -> Cow<'_, [f64]> {
        (self.entry().5)(w)
    }

    /// Field that contains the time derivative of this one.
    pub fn rate(self) -> Option<Self> {
        match self {
            Self::U1 => Some(Self::V1),
            Self::U3 => Some(Self::V3),
            _ => None,
        }
    }

    /// Field of a given name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|field| field.name() == name)
    }

    /// Fields of a system.
    pub fn recorded(system: &System) -> impl Iterator<Item = Self> {
        let wet = system.has_bladders();
        let shears = !system.layout.turning.angle.is_empty();
        Self::ALL.into_iter().filter(move |field| {
            (wet || field.axis() != FieldAxis::Network) && (shears || *field != Self::SectionAngle)
        })
    }

    /// Number of values in a system.
    pub fn len(self, system: &System) -> usize {
        match self.axis() {
            FieldAxis::Cells | FieldAxis::BeamOfCell => cells(&system.mesh).count(),
            FieldAxis::Network | FieldAxis::Bladder | FieldAxis::Array => {
                system.fluid.as_ref().map_or(0, |fluid| fluid.cells)
            }
            _ => system.mesh.nodes,
        }
    }
}

impl FieldAxis {
    const ALL: [Self; 10] = [
        Self::Nodes,
        Self::Cells,
        Self::Network,
        Self::Bladder,
        Self::Array,
        Self::BeamOfNode,
        Self::BeamOfCell,
        Self::RestX,
        Self::RestZ,
        Self::RestAngle,
    ];

    fn entry(self) -> [&'static str; 3] {
        match self {
            Self::Nodes => [
                "theta_node_m",
                "m",
                "material coordinate of the nodes, along their beam",
            ],
            Self::Cells => [
                "theta_cell_m",
                "m",
                "material coordinate of the cells' midpoints, along their beam",
            ],
            Self::Network => ["x_f", "1", "network coordinate of the bladder cells, array by array"],
            Self::Bladder => ["bladder", "1", "bladder index R j of each cell along x_f"],
            Self::Array => ["array", "1", "number of the connected array of each cell along x_f"],
            Self::BeamOfNode => ["beam_node", "1", "number of the beam of each node in /beams, from 1"],
            Self::BeamOfCell => ["beam_cell", "1", "number of the beam of each cell in /beams, from 1"],
            Self::RestX => [
                "x_node_m",
                "m",
                "position x of the nodes of the straight structure, in the axes of the case",
            ],
            Self::RestZ => [
                "z_node_m",
                "m",
                "position z of the nodes of the straight structure, in the axes of the case",
            ],
            Self::RestAngle => [
                "angle_node_rad",
                "rad",
                "angle from z towards x of the straight beam of each node",
            ],
        }
    }

    /// Name of the axis' array.
    pub fn name(self) -> &'static str {
        self.entry()[0]
    }

    /// Unit.
    pub fn unit(self) -> &'static str {
        self.entry()[1]
    }

    /// Description in one sentence.
    pub fn about(self) -> &'static str {
        self.entry()[2]
    }

    /// Axes of a system.
    pub fn recorded(system: &System) -> impl Iterator<Item = Self> {
        let (wet, placed) = (system.has_bladders(), system.model.structure.is_some());
        Self::ALL.into_iter().filter(move |axis| match axis {
            Self::Nodes | Self::Cells => true,
            Self::Network | Self::Bladder | Self::Array => wet,
            _ => placed,
        })
    }

    /// Values in a system along the beams; none for axes along the network.
    fn along_beams(self, system: &System) -> Option<Vec<f64>> {
        let mesh = &system.mesh;
        let nodes = |value: &dyn Fn(usize) -> f64| Some((0..mesh.nodes).map(value).collect());
        let of_cells = |value: &dyn Fn(usize) -> f64| Some(cells(mesh).map(value).collect());
        let piece = |node: usize| {
            let structure = system.model.structure.as_ref();
            structure.map(|structure| &structure.beams[mesh.beam_of_node(node)].piece)
        };
        let from = |node: usize| piece(node).map_or(0.0, |piece| piece.from);
        let beam = |node: usize| piece(node).map_or(1.0, |piece| piece.beam as f64 + 1.0);
        match self {
            Self::Nodes => nodes(&|i| from(i) + mesh.node_coordinate(i)),
            Self::Cells => of_cells(&|c| from(c) + mesh.cell_coordinate(c)),
            Self::BeamOfNode => nodes(&beam),
            Self::BeamOfCell => of_cells(&beam),
            Self::RestX => nodes(&|i| system.rest_position(i).x),
            Self::RestZ => nodes(&|i| system.rest_position(i).z),
            Self::RestAngle => nodes(&|i| piece(i).map_or(0.0, |piece| piece.angle)),
            Self::Network | Self::Bladder | Self::Array => None,
        }
    }

    /// Values in a system with the given length of tubes [m].
    pub fn values(self, system: &System, tube_length: f64) -> Vec<f64> {
        if let Some(values) = self.along_beams(system) {
            return values;
        }
        let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
            return vec![];
        };
        let map = NetworkCoordinate::with_table_ratio(wet, tube_length);
        let k = fluid.cells_per_bladder;
        let at = |array: usize, cell: usize| match self {
            Self::Bladder => bladder_label(cell / k, wet.per_row) as f64,
            Self::Array => array as f64,
            _ => {
                let (start, end) = map.spans[cell / k];
                start + (end - start) * ((cell % k) as f64 + 0.5) / k as f64
            }
        };
        let bladders = map
            .arrays
            .iter()
            .enumerate()
            .flat_map(|(array, all)| all.iter().map(move |&b| (array, b)));
        bladders
            .flat_map(|(array, bladder)| fluid.cells_of(bladder).map(move |cell| (array, cell)))
            .map(|(array, cell)| at(array, cell))
            .collect()
    }
}

/// Cells of the beams, without the empty ones between them.
pub fn cells(mesh: &BeamMesh) -> impl Iterator<Item = usize> + '_ {
    (0..mesh.cells).filter(|cell| !mesh.is_gap(*cell))
}

/// Cells in the order of `X_f`.
pub fn cell_order(system: &System, tube_length: f64) -> Vec<usize> {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return vec![];
    };
    let map = NetworkCoordinate::with_table_ratio(wet, tube_length);
    let bladders = map.arrays.iter().flatten();
    bladders.flat_map(|&bladder| fluid.cells_of(bladder)).collect()
}
