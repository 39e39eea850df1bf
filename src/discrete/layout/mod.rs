//! Layout of the unknowns: order, names and characteristic sizes.
//!
//! An omitted effect has no unknowns: a driven end has no position, a quasi-static solid no velocities, a dry beam no fluid. Equation i
//! belongs to unknown i. Unknowns are grouped in the blocks [`Line`], [`SectionRotation`], [`Coupling`] and [`Network`].

mod solid;
mod wet;

use std::ops::Range;

use super::joints::MeshJoints;
use super::{BeamMesh, FluidMesh};
use crate::case::schema::Effect;
use crate::case::wiring::BladderLabels;
use crate::model::Model;

pub use solid::{JointUnknowns, LineLayout, Relaxation, SectionRotation};
pub use wet::{CouplingUnknowns, NetworkUnknowns};

/// Blocks of unknowns, in this order, and properties of each unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Transverse (`u1`) and axial (`u3`) motion of the beam.
    pub lines: [LineLayout; 2],
    /// Rotation of sections that shear.
    pub turning: SectionRotation,
    /// Angles of joints.
    pub joints: JointUnknowns,
    /// Relaxed strains of the solid.
    pub relaxation: Relaxation,
    /// Coupling variables of beam and bladders.
    pub coupling: CouplingUnknowns,
    /// Bladders and their network.
    pub network: NetworkUnknowns,
    /// Number of unknowns.
    pub len: usize,
    /// True if the solid has inertia.
    pub inertia: bool,
    /// Characteristic size of each unknown, in its unit.
    pub scales: Vec<f64>,
    /// Characteristic size of each equation.
    pub row_scales: Vec<f64>,
    /// True for each unknown that is differential.
    pub differential: Vec<bool>,
    names: Vec<Name>,
    labels: BladderLabels,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Name {
    Node(&'static str, usize),
    Cell(&'static str, usize),
    Joint(&'static str, usize),
    Relaxed(&'static str, usize, usize),
    Segment(&'static str, usize),
    Area(usize, usize),
    ExcessArea(usize),
    Junction(usize),
    Accumulator(usize),
    Stored(usize),
    Bridge(usize),
    Flow(&'static str, usize),
    Face(&'static str, usize, usize),
    LumpedNetwork(&'static str, usize),
    LetIn(usize),
}

impl Layout {
    /// Creates the unknowns of a model on a mesh.
    pub fn new(model: &Model, mesh: &BeamMesh, joints: &MeshJoints, fluid: Option<&FluidMesh>) -> Self {
        let mut build = Builder::default();
        let lines = LineLayout::both(model, mesh, &mut build);
        for (node, axis) in joints.led() {
            let line: &LineLayout = &lines[axis];
            for unknown in [Some(line.u.start), line.v.as_ref().map(|v| v.start)]
                .into_iter()
                .flatten()
            {
                build.differential[unknown + node - line.free.start] = false;
            }
        }
        let turning = SectionRotation::new(model, mesh, &mut build);
        let joints_of_structure = JointUnknowns::new(model, joints, &mut build);
        let relaxation = Relaxation::new(model, mesh, &mut build);
        let wet = model.wet.as_ref().zip(fluid);
        let coupling = wet.map_or_else(Default::default, |(wet, _)| {
            CouplingUnknowns::new(model, wet, mesh, &mut build)
        });
        let network = wet.map_or_else(Default::default, |(wet, fluid)| {
            NetworkUnknowns::new(model, wet, fluid, &mut build)
        });
        Self {
            lines,
            turning,
            joints: joints_of_structure,
            relaxation,
            coupling,
            network,
            len: build.len(),
            inertia: model.effects.has(Effect::SolidInertia),
            scales: build.scales,
            row_scales: build.row_scales,
            differential: build.differential,
            names: build.names,
            labels: wet.map_or_else(BladderLabels::default, |(wet, _)| wet.labels.clone()),
        }
    }

    /// True for transverse and for axial velocities that are unknowns.
    pub fn waves(&self) -> [bool; 2] {
        self.lines.each_ref().map(|line| line.v.is_some())
    }

    /// Every displacement or section angle, with its velocity if that is an unknown.
    pub fn moved(&self) -> impl Iterator<Item = (usize, Option<usize>)> + '_ {
        let nodes = self.lines.iter().flat_map(LineLayout::unknowns).map(|(_, u, v)| (u, v));
        let joints = self.joints.angle.clone().zip(self.joints.rate.iter().copied());
        nodes.chain(self.turning.unknowns()).chain(joints)
    }

    /// True if positions and velocities of two states are equal.
    pub fn unmoved(&self, one: &[f64], other: &[f64]) -> bool {
        let still = |k: usize| one[k] == other[k];
        self.moved().all(|(u, v)| still(u) && v.is_none_or(still))
    }

    /// True if all bladders have equal contents in two states; false if a network has one common pressure.
    pub fn unfilled(&self, one: &[f64], other: &[f64]) -> bool {
        let areas = self.network.area.clone().chain(self.coupling.excess_area.clone());
        self.network.lumped_pressure.is_empty() && areas.into_iter().all(|k| one[k] == other[k])
    }

    /// Blocks of displacements and angles whose velocities are unknowns, and the blocks of these velocities.
    pub fn moved_blocks(&self) -> impl Iterator<Item = (Range<usize>, Range<usize>)> + '_ {
        let nodes = self
            .lines
            .iter()
            .filter_map(|line| Some((line.u.clone(), line.v.clone()?)));
        let turning = self.turning.rate.iter();
        nodes.chain(turning.map(|rate| (self.turning.angle.clone(), rate.clone())))
    }

    /// Velocities among the unknowns.
    pub fn velocities(&self) -> impl Iterator<Item = usize> + '_ {
        self.moved().filter_map(|(_, velocity)| velocity)
    }

    /// Converts scaled unknowns of another layout of the same beam to this layout. Unknowns that only this layout has are 0, such as the
    /// flow through a permanently closed tube.
    pub fn take_over(&self, other: &Self, y: &[f64]) -> Vec<f64> {
        let mut next = 0;
        let mut one = |k: usize| {
            let there = (next..other.len).find(|&j| other.names[j] == self.names[k])?;
            next = there + 1;
            Some(y[there] * other.scales[there] / self.scales[k])
        };
        (0..self.len).map(|k| one(k).unwrap_or(0.0)).collect()
    }

    /// Segment of an unknown on a mesh with so many cells per segment; none for unknowns of the network. A node between two segments
    /// belongs to the second one.
    pub fn segment(&self, unknown: usize, cells_per_segment: usize) -> Option<usize> {
        match self.names[unknown] {
            Name::Node(_, place) | Name::Cell(_, place) | Name::Relaxed(_, _, place) => Some(place / cells_per_segment),
            Name::Segment(_, segment) => Some(segment),
            Name::Area(bladder, _) | Name::ExcessArea(bladder) | Name::Face(_, bladder, _) => {
                Some(bladder % self.labels.per_row)
            }
            _ => None,
        }
    }

    /// Name of an unknown, with unit and place.
    pub fn name(&self, unknown: usize) -> String {
        let bladder = |b: usize| self.labels.label(b);
        match self.names[unknown] {
            Name::Node(what, node) => format!("{what} of node {node}"),
            Name::Joint(what, joint) => format!("{what} of joint {}", joint + 1),
            Name::Cell(what, cell) => format!("{what} of cell {}", cell + 1),
            Name::Relaxed(what, branch, place) => format!("{what} {place} in branch {} of relaxation", branch + 1),
            Name::Segment(what, segment) => format!("{what} of segment {}", segment + 1),
            Name::Area(b, cell) => format!("area change [m^2] of bladder {}, cell {}", bladder(b), cell + 1),
            Name::ExcessArea(b) => format!(
                "area change [m^2] by finite strain and other pressure of bladder {}",
                bladder(b)
            ),
            Name::Junction(j) => format!("pressure [Pa] of junction {}", j + 1),
            Name::Accumulator(k) => format!("volume [m^3] in accumulator {}", k + 1),
            Name::Stored(j) => format!("fluid [m^3] in tubes at junction {}", j + 1),
            Name::LetIn(source) => format!("volume [m^3] injected by source {}", source + 1),
            Name::LumpedNetwork(what, component) => format!("{what} of network {}", component + 1),
            Name::Flow(what, tube) => format!("{what} of tube {}", tube + 1),
            Name::Face(what, b, face) => format!(
                "{what} in bladder {}, between cells {face} and {}",
                bladder(b),
                face + 1
            ),
            Name::Bridge(k) => format!("pressure drop [Pa] of turbine behind rectifier {}", k + 1),
        }
    }
}

#[derive(Default)]
struct Builder {
    scales: Vec<f64>,
    row_scales: Vec<f64>,
    differential: Vec<bool>,
    names: Vec<Name>,
}

impl Builder {
    fn len(&self) -> usize {
        self.scales.len()
    }

    /// Adds an unknown; returns its index.
    fn push(&mut self, name: Name, scale: f64, row_scale: f64, differential: bool) -> usize {
        self.scales.push(scale);
        self.row_scales.push(row_scale);
        self.differential.push(differential);
        self.names.push(name);
        self.len() - 1
    }

    /// Range of the unknowns that `add` creates.
    fn block(&mut self, add: impl FnOnce(&mut Self)) -> Range<usize> {
        let first = self.len();
        add(self);
        first..self.len()
    }

    fn nodes(
        &mut self,
        what: &'static str,
        nodes: &Range<usize>,
        scale: f64,
        row: f64,
        differential: bool,
    ) -> Range<usize> {
        self.block(|build| {
            for node in nodes.clone() {
                build.push(Name::Node(what, node), scale, row, differential);
            }
        })
    }

    fn segments(&mut self, what: &'static str, segments: usize, scale: f64) -> Range<usize> {
        self.block(|build| {
            for segment in 0..segments {
                build.push(Name::Segment(what, segment), scale, scale, false);
            }
        })
    }
}
