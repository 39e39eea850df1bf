//! Unknowns of the solid.

use std::ops::Range;

use super::{Builder, Name};
use crate::case::Translation;
use crate::case::schema::Effect;
use crate::discrete::BeamMesh;
use crate::discrete::joints::{JointAngle, MeshJoints};
use crate::model::{Kinematics, Model};

/// Transverse or axial motion of the nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct LineLayout {
    /// Nodes with unknown displacement.
    pub free: Range<usize>,
    /// Displacements of these nodes.
    pub u: Range<usize>,
    /// Velocities of these nodes; none without inertia, and for axial motion without axial waves.
    pub v: Option<Range<usize>>,
}

/// Rotation of the sections of cells; empty if sections remain perpendicular to the beam.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SectionRotation {
    /// Section angles θ.
    pub angle: Range<usize>,
    /// Rates of the section angles; none without rotary inertia.
    pub rate: Option<Range<usize>>,
}

/// Angles of the joints of a structure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointUnknowns {
    /// Angles.
    pub angle: Range<usize>,
    /// Rate of each angle; none for an angle without inertia.
    pub rate: Vec<Option<usize>>,
}

/// Relaxed curvatures, stretches and shear strains of a solid, branch by branch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Relaxation {
    /// Relaxed curvatures at nodes.
    pub curvature: Range<usize>,
    /// Relaxed stretches in cells.
    pub stretch: Range<usize>,
    /// Relaxed shear strains in cells.
    pub shear: Range<usize>,
}

impl LineLayout {
    /// Every free node with its displacement and, if it is an unknown, its velocity.
    pub fn unknowns(&self) -> impl Iterator<Item = (usize, usize, Option<usize>)> {
        let velocity = self.v.as_ref().map(|v| v.start);
        let (free, u) = (self.free.clone(), self.u.start);
        free.enumerate()
            .map(move |(k, node)| (node, u + k, velocity.map(|v| v + k)))
    }

    /// Index of a node's momentum balance; none if its motion is given.
    #[inline]
    pub fn momentum(&self, node: usize) -> Option<usize> {
        let rows = self.v.as_ref().unwrap_or(&self.u);
        self.free.contains(&node).then(|| rows.start + node - self.free.start)
    }
}

impl LineLayout {
    /// Transverse and axial motion; displacements of both precede the velocities.
    pub(super) fn both(model: &Model, mesh: &BeamMesh, build: &mut Builder) -> [Self; 2] {
        let driven = |motion: &Translation| usize::from(matches!(motion, Translation::Displacement(_)));
        let [root, tip] = model.root_and_tip();
        let structure = model.structure.is_some();
        // in a structure, given motion has equations of its own
        let free = |root: &Translation, tip: &Translation| match structure {
            true => 0..mesh.nodes,
            false => driven(root)..mesh.nodes - driven(tip),
        };
        let bar = model.kinematics == Kinematics::Bar;
        let across = if bar {
            0..0
        } else {
            free(&root.transverse, &tip.transverse)
        };
        let along = if model.effects.has(Effect::AxialStretch) {
            free(&root.axial, &tip.axial)
        } else {
            0..0
        };
        let inertia = model.effects.has(Effect::SolidInertia);
        let waves = [inertia && !bar, inertia && model.effects.has(Effect::AxialInertia)];
        let damped = model.section.resists_motion();
        let bent = model.section.bends_viscously();
        // Without axial waves bending damping alone does not make u3 differential: in a straight beam it acts
        // transversely.
        let differential = [inertia || damped || bent, waves[1] || damped || (bent && !inertia)];
        let s = &model.scales;
        let (sizes, rates) = ([s.transverse, s.axial], [s.transverse_rate, s.axial_rate]);
        let forces = [s.transverse_force, s.axial_force].map(|force| force.max(1e-12));
        let free = [across, along];
        let mut lines = [0, 1].map(|k| {
            let row = if waves[k] { rates[k] } else { forces[k] };
            let u = build.nodes(["u1 [m]", "u3 [m]"][k], &free[k], sizes[k], row, differential[k]);
            let free = free[k].clone();
            Self { free, u, v: None }
        });
        for (k, line) in lines.iter_mut().enumerate().filter(|(k, _)| waves[*k]) {
            let acceleration = model.section.mass_per_length * mesh.shortest * rates[k] * s.frequency;
            line.v = Some(build.nodes(["v1 [m/s]", "v3 [m/s]"][k], &line.free, rates[k], acceleration, true));
        }
        lines
    }
}

impl SectionRotation {
    /// Every angle and, if it is an unknown, its rate, cell by cell.
    pub fn unknowns(&self) -> impl Iterator<Item = (usize, Option<usize>)> {
        let (angle, rate) = (self.angle.start, self.rate.as_ref().map(|rate| rate.start));
        (0..self.angle.len()).map(move |cell| (angle + cell, rate.map(|rate| rate + cell)))
    }

    /// Moment balances of the cells.
    pub fn moments(&self) -> Range<usize> {
        self.rate.as_ref().unwrap_or(&self.angle).clone()
    }

    pub(super) fn new(model: &Model, mesh: &BeamMesh, build: &mut Builder) -> Self {
        if !model.effects.has(Effect::Shear) {
            return Self::default();
        }
        let (s, section) = (&model.scales, &model.section);
        let swings = model.effects.has(Effect::RotaryInertia);
        let (size, rate) = (s.transverse / model.length, s.transverse_rate / model.length);
        let moment = (s.transverse_force * model.length).max(1e-12 * model.length);
        let row = if swings { rate } else { moment };
        let differential = swings || section.bends_viscously();
        let inertia = section.mass_per_length * section.gyration_radius_squared * mesh.shortest;
        let mut cells = |what: &'static str, size: f64, row: f64, differential: bool| {
            build.block(|build| {
                for cell in 0..mesh.cells {
                    build.push(Name::Cell(what, cell), size, row, differential && !mesh.is_gap(cell));
                }
            })
        };
        Self {
            angle: cells("angle [rad] of the section", size, row, differential),
            rate: swings.then(|| {
                cells(
                    "turning [rad/s] of the section",
                    rate,
                    inertia * rate * s.frequency,
                    true,
                )
            }),
        }
    }
}

impl JointUnknowns {
    /// Index of the moment balance of an angle.
    #[inline]
    pub fn moment(&self, angle: usize) -> usize {
        self.rate[angle].unwrap_or(self.angle.start + angle)
    }

    pub(super) fn new(model: &Model, joints: &MeshJoints, build: &mut Builder) -> Self {
        let s = &model.scales;
        let length = model.structure.iter().flat_map(|structure| &structure.beams);
        let length = length.map(|beam| beam.piece.length).fold(model.length, f64::min);
        let (size, speed) = (s.transverse / length, s.transverse_rate / length);
        let angle = build.block(|build| {
            for (k, angle) in joints.angles.iter().enumerate() {
                let row = if angle.moves { speed } else { s.moment };
                build.push(Name::Joint("angle [rad]", k), size, row, angle.moves || angle.damped);
            }
        });
        let mut rate = |(k, angle): (usize, &JointAngle)| {
            let moves = angle.moves;
            moves.then(|| build.push(Name::Joint("turning [rad/s]", k), speed, s.moment, true))
        };
        let rate = joints.angles.iter().enumerate().map(&mut rate).collect();
        Self { angle, rate }
    }
}

impl Relaxation {
    pub(super) fn new(model: &Model, mesh: &BeamMesh, build: &mut Builder) -> Self {
        let (s, section) = (&model.scales, &model.section);
        let mut of = |there: bool, what: &'static str, places: usize, scale: f64| {
            build.block(|build| {
                for (k, branch) in model.relaxation.iter().enumerate().filter(|_| there) {
                    for place in 0..places {
                        let rate = scale * s.frequency.max(1.0 / branch.time_s);
                        build.push(Name::Relaxed(what, k, place), scale, rate, true);
                    }
                }
            })
        };
        let bends = model.kinematics != Kinematics::Bar;
        let stretches = model.effects.has(Effect::AxialStretch);
        Self {
            curvature: of(
                bends,
                "curvature [1/m] of node",
                mesh.nodes,
                s.moment / section.bending_stiffness,
            ),
            stretch: of(
                stretches,
                "stretch of cell",
                mesh.cells,
                s.force / section.axial_stiffness,
            ),
            shear: of(
                model.effects.has(Effect::Shear),
                "shear strain of cell",
                mesh.cells,
                s.transverse_force / section.shear_stiffness,
            ),
        }
    }
}
