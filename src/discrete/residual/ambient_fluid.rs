//! Surroundings of the beam: drag, inertia and stream of the ambient fluid.

use super::solid::angle_rate;
use crate::case::schema::Effect;
use crate::discrete::ledger::EnergyRate;
use crate::discrete::{System, TimeData, Workspace};
use crate::model::surroundings::AmbientSection;
use crate::model::{AmbientFluid, Kinematics};
use crate::numerics::{Planar, Scalar};

/// Passes the forces of the surroundings on a node of the given length to `each`, with the balance entry of their work;
/// none for stored energy.
///
/// Forces of a stream are loads, including its inertia: their work is that of the stream.
#[inline]
pub fn forces<T: Scalar>(
    system: &System,
    now: &TimeData,
    w: &Workspace<T>,
    node: usize,
    length: f64,
    each: &mut impl FnMut(Option<EnergyRate>, Planar<T>),
) {
    let section = &system.model.section;
    if section.drag > 0.0 {
        let felt = felt_velocity(system, now, w, node);
        each(Some(EnergyRate::Damping), -felt * (length * section.drag));
    }
    if section.quadratic_drag > 0.0 {
        let drag = quadratic_drag(system, now, w, node, section.quadratic_drag, Planar::default());
        each(Some(EnergyRate::Damping), drag * length);
    }
    let (Some(around), Some(here)) = (&system.model.surroundings, system.sections.ambient.get(node)) else {
        return;
    };
    let streams = around.stream.is_some();
    if here.drag > 0.0 {
        let account = if streams {
            EnergyRate::Loads
        } else {
            EnergyRate::Damping
        };
        let drag = quadratic_drag(system, now, w, node, here.drag, now.stream);
        each(Some(account), drag * length);
    }
    if here.added_mass > 0.0 && system.layout.inertia {
        let account = streams.then_some(EnergyRate::Loads);
        each(account, inertia(system, now, w, node) * (-length * here.added_mass));
    }
    if streams && system.layout.inertia {
        each(Some(EnergyRate::Loads), swept(system, here, now, w, node) * length);
    }
}

/// `[E47]` Drag per length by the transverse velocity (Morison et al. 1950). Near a reversal of motion it is linear and isotropic, so
/// that it is smooth and always has a slope:
///
/// ```text
/// b = -c₂ [(√(v_n² + v_s²) - v_s) v_n e_n + v_s v]        v_n = v·e_n        v_s a millionth of the largest v1 that the case expects
/// ```
///
/// v is the velocity relative to a stream, if there is one; v_s is then at least a millionth of the stream velocity.
fn quadratic_drag<T: Scalar>(
    system: &System,
    now: &TimeData,
    w: &Workspace<T>,
    node: usize,
    coefficient: f64,
    stream: Planar<f64>,
) -> Planar<T> {
    let normal = node_tangent(system, w, node).normal();
    let v = felt_velocity(system, now, w, node) - Planar::constant(stream);
    let across = v.dot(normal);
    let slow = 1e-6 * system.model.scales.transverse_rate;
    let beyond = (across.squared() + slow * slow).sqrt() - slow;
    (normal.times(across * beyond) + v * slow) * -coefficient
}

/// `[E53]` Inertia of the ambient fluid that moves transversely with the beam, per length and added mass:
///
/// ```text
/// b = -m_a (d/dt (v·e_n)) e_n        d/dt (v·e_n) = v_t·e_n + v·e_n,t
/// ```
///
/// v is relative to the stream, whose own acceleration is in [`swept`]. In still fluid its power is -d/dt (m_a v_n²/2). It is Lighthill's
/// reactive force (1971) on a slender body without convection along it, which is half of the force at first order in an axial stream.
fn inertia<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> Planar<T> {
    let tangent = node_tangent(system, w, node);
    let normal = tangent.normal();
    let speeding = w.motion.a[node].dot(normal);
    let across = if system.model.kinematics == Kinematics::FiniteRotation {
        let v = felt_velocity(system, now, w, node) - Planar::constant(now.stream);
        // e_n rotates with e_t, (e_n)_t = φ_t e_t
        speeding + v.dot(tangent) * turning(system, w, node)
    } else {
        speeding
    };
    normal.times(across)
}

/// Force of an accelerating stream on the beam, per length: the pressure force on the displaced volume, and the added mass (Froude and
/// Krylov; Morison et al. 1950):
///
/// ```text
/// b = ρ h_s w_s U_t + m_a (U_t·e_n) e_n
/// ```
fn swept<T: Scalar>(
    system: &System,
    around: &AmbientSection,
    now: &TimeData,
    w: &Workspace<T>,
    node: usize,
) -> Planar<T> {
    let normal = node_tangent(system, w, node).normal();
    let speeding = Planar::constant(now.stream_rate);
    normal.times(speeding.dot(normal) * around.added_mass) + speeding * around.displaced
}

/// Energy `m_a (v·e_n)²/2` per length of the fluid that moves transversely with a node.
pub fn kinetic(system: &System, now: &TimeData, w: &Workspace<f64>, node: usize) -> f64 {
    let still = |around: &AmbientFluid| around.stream.is_none() && system.layout.inertia;
    if !system.model.surroundings.as_ref().is_some_and(still) {
        return 0.0;
    }
    let across = felt_velocity(system, now, w, node).dot(node_tangent(system, w, node).normal());
    0.5 * system.sections.ambient[node].added_mass * across * across
}

/// Rate of the angle of [`node_tangent`] [1/s].
fn turning<T: Scalar>(system: &System, w: &Workspace<T>, node: usize) -> T {
    let (before, after) = (node.saturating_sub(1), node.min(system.mesh.cells - 1));
    // the direction of the mean of two unit vectors is at the mean of their angles
    (angle_rate(system, w, before) + angle_rate(system, w, after)) * 0.5
}

/// Unit tangent at a node, in the direction of the mean of its cells' tangents.
#[inline]
pub fn node_tangent<T: Scalar>(system: &System, w: &Workspace<T>, node: usize) -> Planar<T> {
    let cells = [node.saturating_sub(1), node.min(system.mesh.cells - 1)];
    mean_direction(cells.map(|c| w.shape.tangent[c]))
}

/// Unit vector in the direction of the mean of two.
#[inline(always)]
pub fn mean_direction<T: Scalar>([one, other]: [Planar<T>; 2]) -> Planar<T> {
    (one + other).unit()
}

/// Velocity of a node relative to fluid at rest; its axial part in an inextensible beam is that of the frame, [E28].
#[inline]
fn felt_velocity<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> Planar<T> {
    let own = w.motion.v[node];
    if system.model.effects.has(Effect::AxialStretch) {
        return own;
    }
    Planar::new(own.x, T::constant(now.carried(1, system.mesh.share(node)).rate))
}
