//! Bar: a beam without transverse motion.

use super::solid::normal_force;
use crate::discrete::{System, Workspace};
use crate::numerics::Scalar;

/// `[E24]` A bar can only stretch; bending loads are balanced by the constraint that keeps it straight:
///
/// ```text
/// λ - 1 = u3'    N = EA (u3' - λ_p) + EA τ_a u3'_t    n = (0, N)    m a3 = b_z + N'
/// ```
///
/// It equals [`super::solid`] with u1 = 0, and is exact without transverse loads and with equal upper and lower
/// pressures.
pub fn kinematics<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    for (c, &inverse) in system.mesh.per_length.iter().enumerate() {
        let e = (w.motion.u[c + 1].z - w.motion.u[c].z) * inverse;
        w.shape.strain[c] = e;
        w.shape.stretch[c] = e + 1.0;
    }
}

/// Rate of stretch, if damping depends on it.
pub fn rates<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    if system.model.section.axial_damping_time > 0.0 {
        strain_rates(system, w);
    }
}

/// Rate of stretch in any case.
pub fn strain_rates<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    for (c, &inverse) in system.mesh.per_length.iter().enumerate() {
        w.shape.stretch_rate[c] = (w.motion.v[c + 1].z - w.motion.v[c].z) * inverse;
    }
}

/// The section force is the normal force.
pub fn section_forces<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    for c in 0..system.mesh.cells {
        w.forces.section[c].z = normal_force(system, w, c);
    }
}
