//! Inertial forces in axes that rotate.

use crate::discrete::{System, TimeData, Workspace};
use crate::numerics::{Planar, Scalar};

/// `[E86]` Acceleration of a mass at rest in inertial axes, seen from axes that rotate about `c` with the angular velocity W(t),
/// positive in the direction of growing φ:
///
/// ```text
/// L = Σ m_i |v_i + W T ρ_i|²/2 + Σ h m y11 (φ_t + W)²/2 - U      ρ = r - c      T (x, z) = (z, -x)
/// m_i v_t = f + m_i (W² ρ - 2 W T v - W' T ρ)                    h r λ² gains h m y11 W'
/// F gains M (W² q - 2 W T φ_t q' - W' T q)      J φ_tt gains J W' - M q'·(W² ρ_G - 2 W T v_G - W' T ρ_G)      of bodies, [E70]
/// ```
///
/// The forces are centrifugal, of Coriolis, and of Euler. That of Coriolis does no work; the work of the others is an input of the
/// energy balance, whose kinetic energy is that of the relative motion. A solid without inertia has no force of Coriolis.
#[inline]
pub fn acceleration<T: Scalar>(system: &System, now: &TimeData, at: Planar<T>, v: Planar<T>) -> Planar<T> {
    let rotation = now.frame_rotation;
    let force = at * (rotation.value * rotation.value) + at.normal() * rotation.rate;
    match system.layout.inertia {
        true => force + v.normal() * (2.0 * rotation.value),
        false => force,
    }
}

/// Inertial force on the mass of a node [N]; none in axes at rest.
#[inline]
pub fn force<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> Option<Planar<T>> {
    let acceleration = acceleration(system, now, place(system, w, node)?, w.motion.v[node]);
    Some(acceleration * system.masses[node])
}

/// Position of a node relative to the axis of rotation [m]; none in axes at rest.
#[inline]
pub fn place<T: Scalar>(system: &System, w: &Workspace<T>, node: usize) -> Option<Planar<T>> {
    let center = system.model.frame.as_ref()?.center;
    let straight = Planar::new(-center.x, system.mesh.node_coordinate(node) - center.z);
    Some(w.motion.u[node] + Planar::constant(straight))
}
