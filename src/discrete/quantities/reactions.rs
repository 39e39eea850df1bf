//! Reactions: forces and couples at ends with given motion, at springs and dashpots, and angles of ends that can rotate.

use super::evaluate::StateView;
use super::probes::HistoryColumn;
use crate::case::{Rotation, Translation};
use crate::discrete::System;
use crate::discrete::angle_unwrapping::{first_angle, nearest};
use crate::discrete::ledger::reaction;
use crate::discrete::residual::momentum::end_tangent;

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
}

const ENDS: [&str; 2] = ["root", "tip"];
const AXES: [&str; 2] = ["x", "z"];

/// All reaction quantities of a system, ends first; a reduced model has those of the full one.
fn all(system: &System) -> Vec<ReactionKind> {
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
            Rotation::Moment(_) if k == 0 => all.push(ReactionKind::Angle(k)),
            Rotation::Moment(_) => {}
        }
    }
    for (k, attachment) in system.model.attachments.iter().enumerate() {
        let holds = |axis: &usize| attachment.stiffness[*axis] > 0.0 || attachment.damping[*axis] > 0.0;
        all.extend((0..2).filter(holds).map(|axis| ReactionKind::Attached(k, axis)));
    }
    all
}

/// Columns of the reaction quantities of a system.
pub fn columns(system: &System) -> impl Iterator<Item = HistoryColumn> {
    all(system).into_iter().map(|one| {
        let (name, unit, about) = match one {
            ReactionKind::End(k, axis) => (
                format!("reaction_{}_{}", ENDS[k], AXES[axis]),
                "N",
                format!("force in {} of the support at the {} on the beam", AXES[axis], ENDS[k]),
            ),
            ReactionKind::Couple(k) => (
                format!("reaction_{}_couple", ENDS[k]),
                "N m",
                format!(
                    "couple of the support at the {} on the beam, positive with phi",
                    ENDS[k]
                ),
            ),
            ReactionKind::Angle(k) => (
                format!("turned_{}", ENDS[k]),
                "rad",
                format!(
                    "slope angle phi of the {}, which turns, counted over full turns",
                    ENDS[k]
                ),
            ),
            ReactionKind::Attached(k, axis) => (
                format!("reaction_attachment_{}_{}", k + 1, AXES[axis]),
                "N",
                format!(
                    "force in {} of springs and dashpots of attachment {}",
                    AXES[axis],
                    k + 1
                ),
            ),
        };
        HistoryColumn { name, unit, about }
    })
}

/// Values of the reaction quantities in a state.
pub fn values(look: &StateView, put: &mut impl FnMut(f64)) {
    let (system, now, w) = (look.system, look.now, &*look.w);
    let node = |end: usize| end * (system.mesh.nodes - 1);
    for one in all(system) {
        put(match one {
            ReactionKind::End(k, axis) => reaction(system, now, w, node(k))[axis],
            ReactionKind::Couple(k) => {
                let part = |moments: &[f64]| moments.get(node(k)).copied().unwrap_or(0.0);
                let f = &w.forces;
                let moment = f.moment[node(k)] + f.viscous_moment[node(k)];
                let moment = moment
                    + part(&f.nonlinear_moment)
                    + part(&f.relaxing_moment)
                    + part(&f.arc_moment)
                    + part(&f.offset_moment);
                if k == 0 { moment } else { -moment }
            }
            ReactionKind::Angle(k) => {
                let tangent = end_tangent(system, now, w, node(k));
                nearest(tangent.x.atan2(tangent.z), first_angle(system, now, w))
            }
            ReactionKind::Attached(k, axis) => {
                let own = system.attached.iter().filter(|attached| attached.number == k);
                own.map(|a| a.spring(w)[axis] + a.dashpot(w)[axis]).sum()
            }
        });
    }
}
