//! Reactions: forces and couples at ends with given motion, at springs and dashpots, and angles of ends that can rotate.

use super::evaluate::StateView;
use super::probes::HistoryColumn;
use crate::case::{Rotation, Translation};
use crate::discrete::System;
use crate::discrete::angle_unwrapping::{first_angle, nearest};
use crate::discrete::ledger::beams::{self, BeamRate};
use crate::discrete::ledger::reaction;
use crate::discrete::residual::momentum::end_tangent;
use crate::model::structure::BeamOfStructure;

/// A reaction quantity of an end or of an attachment.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ReactionKind {
    /// Force of an end's support or drive on the beam, transverse (0) or axial (1).
    End(usize, usize),
    /// Couple of an end's support or drive, positive in the direction of growing φ.
    Couple(usize),
    /// Angle of an end that can rotate.
    Angle(usize),
    /// Force of springs and dashpots of an attachment, transverse (0) or axial (1).
    Attached(usize, usize),
    /// Rotation of another part of a joint relative to the first one: numbers of both angles, and of the joint.
    Turned([usize; 2], usize),
    /// Kinetic (0) or elastic (1) energy of the beam of a structure that begins at the end.
    Energy(usize, usize),
    /// Integral of a rate of this beam, with its number in [`PASSED`].
    Passed(usize, usize),
    /// Power that a joint takes from its beams.
    Joint(usize),
}

const ENERGIES: [[&str; 2]; 2] = [
    ["kinetic_energy", "kinetic energy of the beam"],
    ["elastic_energy", "elastic energy of the beam"],
];

const PASSED: [(BeamRate, &str, &str); 4] = [
    (
        BeamRate::Work,
        "work",
        "work of loads, driven ends, springs and contacts on the beam",
    ),
    (BeamRate::Joints, "work_joints", "work of its joints on the beam"),
    (
        BeamRate::Fluid,
        "work_fluid",
        "work of the pressures of its bladders on the beam",
    ),
    (
        BeamRate::Loss,
        "dissipated",
        "dissipated by damping and drag in the beam",
    ),
];

/// First part of the names of quantities of the beam of an end; empty for a single beam.
fn beam_of(system: &System, end: usize) -> String {
    let structure = system.model.structure.as_ref();
    structure.map_or_else(String::new, |structure| format!("{}.", structure.beams[end / 2].name))
}

const ENDS: [&str; 2] = ["root", "tip"];
const AXES: [&str; 2] = ["x", "z"];

/// All reaction quantities of a system, ends first; a reduced model has those of the full one. A state at rest has no powers and integrals.
fn all(system: &System, at_rest: bool) -> Vec<ReactionKind> {
    let given = |motion: &Translation| matches!(motion, Translation::Displacement(_));
    let mut all = vec![];
    for (k, end) in system.model.ends.iter().enumerate() {
        let held = [&end.transverse, &end.axial].into_iter().enumerate();
        all.extend(
            held.filter(|(_, motion)| given(motion))
                .map(|(axis, _)| ReactionKind::End(k, axis)),
        );
        match &end.rotation {
            Rotation::Slope(_) => all.push(ReactionKind::Couple(k)),
            // the tip's angle is an observable of its own
            Rotation::Moment(_) if k % 2 == 0 && turns_freely(system, k) => all.push(ReactionKind::Angle(k)),
            Rotation::Moment(_) => {}
        }
    }
    let hinges = system.joints.hinges.iter().enumerate();
    all.extend(hinges.map(|(k, hinge)| ReactionKind::Turned(hinge.angles, k)));
    let structure = system.model.structure.iter();
    let roots = structure.flat_map(|structure| structure.beams.iter().enumerate());
    let roots = roots.filter(|(_, beam)| beam.piece.at_end[0]).map(|(k, _)| 2 * k);
    // energies of finite strain are those of beam and bladders together
    let closes = !at_rest && system.model.strain_energy().is_none();
    for root in roots {
        all.extend([0, 1].map(|kind| ReactionKind::Energy(root, kind)));
        let passed = (0..PASSED.len()).filter(|_| closes);
        all.extend(passed.map(|k| ReactionKind::Passed(root, k)));
    }
    if !at_rest {
        let joints = system.model.structure.iter().map(|structure| structure.joints.len());
        all.extend((0..joints.sum()).map(ReactionKind::Joint));
    }
    for (k, attachment) in system.model.attachments.iter().enumerate() {
        let holds = |axis: &usize| attachment.stiffness[*axis] > 0.0 || attachment.damping[*axis] > 0.0;
        all.extend((0..2).filter(holds).map(|axis| ReactionKind::Attached(k, axis)));
    }
    all
}

/// True for a root without support of its angle; in a structure, for one of a beam, not of a part of one.
fn turns_freely(system: &System, end: usize) -> bool {
    let structure = system.model.structure.as_ref();
    structure.is_none_or(|structure| structure.beams[end / 2].piece.at_end[0] && system.joints.angle_of(end).is_none())
}

/// First part of the names of quantities of an attachment, and its number on its beam, from 1.
fn attachment(system: &System, number: usize) -> (String, usize) {
    let Some(structure) = &system.model.structure else {
        return (String::new(), number + 1);
    };
    let of = |k: &usize| structure.beams[*k].of_structure[1].contains(&number);
    let own = (0..structure.beams.len()).find(of).unwrap_or(0);
    let first = structure
        .beams
        .iter()
        .find(|beam| beam.piece.beam == structure.beams[own].piece.beam);
    let first = first.map_or(0, |beam| beam.of_structure[1].start);
    (beam_of(system, 2 * own), number - first + 1)
}

/// Numbers on the mesh of all parts of the beam that begins at a root.
fn parts(system: &System, root: usize) -> impl Iterator<Item = usize> + '_ {
    let beams = system.model.structure.iter().flat_map(|structure| &structure.beams);
    let own = beams.clone().nth(root / 2).map(|beam| beam.piece.beam);
    let of = move |(_, beam): &(usize, &BeamOfStructure)| Some(beam.piece.beam) == own;
    beams.enumerate().filter(of).map(|(part, _)| part)
}

/// Indices of the integrals of a rate over all parts of the beam that begins at a root.
fn passed(system: &System, root: usize, k: usize) -> impl Iterator<Item = usize> + '_ {
    parts(system, root).map(move |part| beams::index(system, part, PASSED[k].0))
}

/// For each column of a run: the integrals of which it is the sum, if it is no part of a state.
pub fn integrals(system: &System) -> impl Iterator<Item = Vec<usize>> + '_ {
    all(system, false).into_iter().map(|one| match one {
        ReactionKind::Passed(root, k) => passed(system, root, k).collect(),
        _ => vec![],
    })
}

/// Columns of the reaction quantities of a system.
pub fn columns(system: &System, at_rest: bool) -> impl Iterator<Item = HistoryColumn> {
    all(system, at_rest).into_iter().map(|one| {
        let of = |end: usize| beam_of(system, end);
        let (name, unit, about) = match one {
            ReactionKind::End(k, axis) => (
                format!("{}reaction_{}_{}", of(k), ENDS[k % 2], AXES[axis]),
                "N",
                format!(
                    "force in {} of the support at the {} on the beam",
                    AXES[axis],
                    ENDS[k % 2]
                ),
            ),
            ReactionKind::Couple(k) => (
                format!("{}reaction_{}_couple", of(k), ENDS[k % 2]),
                "N m",
                format!(
                    "couple of the support at the {} on the beam, positive with phi",
                    ENDS[k % 2]
                ),
            ),
            ReactionKind::Angle(k) => (
                format!("{}turned_{}", of(k), ENDS[k % 2]),
                "rad",
                format!(
                    "slope angle phi of the {}, which turns, counted over full turns",
                    ENDS[k % 2]
                ),
            ),
            ReactionKind::Turned(_, k) => (
                format!("hinge_{}_angle", k + 1),
                "rad",
                "rotation of the hinge: of the further beam relative to the first one".to_owned(),
            ),
            ReactionKind::Energy(root, kind) => {
                let [name, about] = ENERGIES[kind];
                (format!("{}{name}", of(root)), "J", about.to_owned())
            }
            ReactionKind::Passed(root, k) => {
                let (_, name, about) = PASSED[k];
                (format!("{}{name}", of(root)), "J", about.to_owned())
            }
            ReactionKind::Joint(k) => (
                format!("joint_{}_power", k + 1),
                "W",
                format!("power that joint {} takes from its beams", k + 1),
            ),
            ReactionKind::Attached(k, axis) => {
                let (beam, number) = attachment(system, k);
                (
                    format!("{beam}reaction_attachment_{number}_{}", AXES[axis]),
                    "N",
                    format!("force in {} of springs and dashpots of attachment {number}", AXES[axis]),
                )
            }
        };
        HistoryColumn { name, unit, about }
    })
}

/// Values of the reaction quantities in a state; without integrals those of a state at rest.
pub fn values(look: &StateView, integrals: Option<&[f64]>, put: &mut impl FnMut(f64)) {
    let (system, now, w) = (look.system, look.now, &*look.w);
    let ends: Vec<_> = system.mesh.ends().map(|(_, end)| end).collect();
    let node = |end: usize| ends[end].node;
    for one in all(system, integrals.is_none()) {
        put(match one {
            ReactionKind::End(k, axis) => reaction(system, now, w, node(k))[axis],
            ReactionKind::Couple(k) => -ends[k].outward * system.total_moment(w, node(k)),
            ReactionKind::Angle(k) => {
                let tangent = end_tangent(system, now, w, node(k));
                nearest(tangent.x.atan2(tangent.z), first_angle(system, now, w, k / 2))
            }
            ReactionKind::Turned([first, other], _) => w.shape.joints.angle[other] - w.shape.joints.angle[first],
            ReactionKind::Energy(root, kind) => parts(system, root)
                .map(|part| {
                    let e = beams::energies(system, now, w, part);
                    [e.kinetic + e.rotary, e.axial + e.bending + e.relaxing][kind]
                })
                .sum(),
            ReactionKind::Passed(root, k) => passed(system, root, k).filter_map(|at| integrals?.get(at)).sum(),
            ReactionKind::Joint(k) => beams::power_of_joint(system, now, w, k),
            ReactionKind::Attached(k, axis) => {
                let own = system.attached.iter().filter(|attached| attached.number == k);
                own.map(|a| a.spring(w)[axis] + a.dashpot(w)[axis]).sum()
            }
        });
    }
}
