//! Point masses, springs, dashpots and forces attached to the beam.

use super::DistributedLoad;
use super::loads::LoadKind;
use crate::case::schema::{Attachment as Written, Case};
use crate::functions::signals::Signal;
use crate::numerics::Planar;

/// A point mass, springs and dashpots to ground, and forces, all at one place of the beam.
#[derive(Clone, Debug)]
pub struct AttachedBody {
    /// Place `θ/l_s`.
    pub at: f64,
    /// Mass [kg].
    pub mass: f64,
    /// Rotary inertia about the mass centre [kg m²].
    pub inertia: f64,
    /// Vector from the place to the mass center, across and along [m].
    pub offset: Planar<f64>,
    /// Springs across and along [N/m].
    pub stiffness: Planar<f64>,
    /// Rotational spring [N m].
    pub turning_stiffness: f64,
    /// Dashpots across and along [N s/m].
    pub damping: Planar<f64>,
    /// Forces, weight included.
    pub forces: Vec<PointForce>,
}

/// Direction of a point force relative to the beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceDirection {
    /// Constant, along x (0) or z (1).
    Dead,
    /// Constant, along x (0) or z (1), applied at the mass center.
    Weight,
    /// Turns with the beam: along `e_n` (0) or `e_t` (1).
    Follower,
}

/// The force `factor signal(t)` across (0) or along (1).
#[derive(Clone, Debug)]
pub struct PointForce {
    /// 0 across, 1 along.
    pub axis: usize,
    /// Direction and point of application.
    pub acting: ForceDirection,
    /// 1 for a given force, `M b` for a body force on the point mass [kg].
    pub factor: f64,
    /// Time function.
    pub signal: Signal,
}

impl PointForce {
    /// Body force on a point mass at a place `θ/l_s`.
    pub(super) fn weight(load: DistributedLoad, at: f64) -> Self {
        Self {
            axis: usize::from(load.kind == LoadKind::ForceZ),
            acting: ForceDirection::Weight,
            factor: load.factor * load.profile.value(at),
            signal: load.signal,
        }
    }
}

impl AttachedBody {
    /// True if the attachment has rotary inertia or an eccentric mass.
    pub fn is_body(&self) -> bool {
        self.inertia > 0.0 || self.offset != Planar::default()
    }

    /// True if a force turns with the beam.
    pub fn follows(&self) -> bool {
        self.forces.iter().any(|force| force.acting == ForceDirection::Follower)
    }

    /// Returns all attachments of a case.
    pub fn all(case: &Case) -> Vec<Self> {
        case.attachments
            .iter()
            .map(|written| Self::new(case, written))
            .collect()
    }

    fn new(case: &Case, written: &Written) -> Self {
        let given = [
            (ForceDirection::Dead, 0, &written.force_x_n),
            (ForceDirection::Dead, 1, &written.force_z_n),
            (ForceDirection::Follower, 0, &written.force_normal_n),
            (ForceDirection::Follower, 1, &written.force_tangential_n),
        ];
        let given = given.into_iter().filter_map(|(acting, axis, signal)| {
            Some(PointForce {
                axis,
                acting,
                factor: 1.0,
                signal: signal.clone()?,
            })
        });
        let body = case
            .loads
            .iter()
            .filter(|load| written.mass_kg > 0.0 && load.is_body())
            .flat_map(|load| DistributedLoad::on(load, [written.mass_kg; 2]))
            .map(|load| PointForce::weight(load, written.at));
        Self {
            at: written.at,
            mass: written.mass_kg,
            inertia: written.rotary_inertia_kg_m2,
            offset: Planar {
                x: written.offset_across_m,
                z: written.offset_along_m,
            },
            stiffness: Planar {
                x: written.stiffness_x_n_m,
                z: written.stiffness_z_n_m,
            },
            turning_stiffness: written.stiffness_rotation_n_m_rad,
            damping: Planar {
                x: written.damping_x_n_s_m,
                z: written.damping_z_n_s_m,
            },
            forces: given.chain(body).collect(),
        }
    }
}
