//! What surrounds the beam: drag, inertia and stream of the fluid that it moves through.

use super::solid::angle_rate;
use crate::case::schema::Effect;
use crate::discrete::ledger::EnergyRate;
use crate::discrete::{System, TimeData, Workspace};
use crate::model::{Kinematics, Surroundings};
use crate::numerics::{Planar, Scalar};

/// Forces of the surroundings on a node of so much length, each with the account of its work; none where it is stored.
///
/// Those of a stream are loads, inertia included: their work is what the stream does.
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
    let Some(around) = &system.model.surroundings else {
        return;
    };
    let streams = around.stream.is_some();
    if around.drag > 0.0 {
        let account = if streams {
            EnergyRate::Loads
        } else {
            EnergyRate::Damping
        };
        let drag = quadratic_drag(system, now, w, node, around.drag, now.stream);
        each(Some(account), drag * length);
    }
    if around.added_mass > 0.0 && system.layout.inertia {
        let account = streams.then_some(EnergyRate::Loads);
        each(account, inertia(system, now, w, node) * (-length * around.added_mass));
    }
    if streams && system.layout.inertia {
        each(Some(EnergyRate::Loads), swept(system, around, now, w, node) * length);
    }
}

/// `[E47]` Drag of what the beam moves through, per length, on the velocity across it (Morison et al. 1950), linear and the same in all
/// directions where the motion turns, so that it is smooth and never without a slope:
///
/// ```text
/// b = -c₂ [(√(v_n² + v_s²) - v_s) v_n e_n + v_s v]        v_n = v·e_n        v_s a millionth of the largest v1 that the case expects
/// ```
///
/// v is the velocity against a stream, where there is one, and v_s then a millionth of the stream's if that is more.
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

/// `[E53]` Inertia of the fluid around the beam, per length and added mass: what it takes to speed up what moves across with it,
///
/// ```text
/// b = -m_a (d/dt (v·e_n)) e_n        d/dt (v·e_n) = v_t·e_n + v·e_n,t
/// ```
///
/// v against the stream, whose own acceleration is [`swept`]. Its power in still fluid is -d/dt (m_a v_n²/2). It is Lighthill's reactive
/// force (1971) on a slender body without what the flow carries along it: in a stream along the beam half of the force at first order.
fn inertia<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> Planar<T> {
    let tangent = node_tangent(system, w, node);
    let normal = tangent.normal();
    let speeding = w.motion.a[node].dot(normal);
    let across = if system.model.kinematics == Kinematics::FiniteRotation {
        let v = felt_velocity(system, now, w, node) - Planar::constant(now.stream);
        // e_n turns as e_t does, (e_n)_t = φ_t e_t
        speeding + v.dot(tangent) * turning(system, w, node)
    } else {
        speeding
    };
    normal.times(across)
}

/// Force of a stream that speeds up, per length, on what it flows around: that which its pressure has on the displaced fluid in its place,
/// and the added mass (Froude and Krylov; Morison et al. 1950):
///
/// ```text
/// b = ρ h_s w_s U_t + m_a (U_t·e_n) e_n
/// ```
fn swept<T: Scalar>(
    system: &System,
    around: &Surroundings,
    now: &TimeData,
    w: &Workspace<T>,
    node: usize,
) -> Planar<T> {
    let normal = node_tangent(system, w, node).normal();
    let speeding = Planar::constant(now.stream_rate);
    normal.times(speeding.dot(normal) * around.added_mass) + speeding * around.displaced
}

/// `m_a (v·e_n)²/2` per length: energy of the fluid that moves across with a node.
pub fn kinetic(system: &System, now: &TimeData, w: &Workspace<f64>, node: usize) -> f64 {
    let around = system
        .model
        .surroundings
        .as_ref()
        .filter(|around| around.stream.is_none());
    around.filter(|_| system.layout.inertia).map_or(0.0, |around| {
        let across = felt_velocity(system, now, w, node).dot(node_tangent(system, w, node).normal());
        0.5 * around.added_mass * across * across
    })
}

/// Rate of the angle of [`node_tangent`] [1/s].
fn turning<T: Scalar>(system: &System, w: &Workspace<T>, node: usize) -> T {
    let (before, after) = (node.saturating_sub(1), node.min(system.mesh.cells - 1));
    // the mean of two unit vectors halves the angle between them
    (angle_rate(system, w, before) + angle_rate(system, w, after)) * 0.5
}

/// Unit tangent at a node: along the mean of those of its cells.
#[inline]
pub fn node_tangent<T: Scalar>(system: &System, w: &Workspace<T>, node: usize) -> Planar<T> {
    let cells = [node.saturating_sub(1), node.min(system.mesh.cells - 1)];
    mean_direction(cells.map(|c| w.shape.tangent[c]))
}

/// Unit vector along the mean of two.
#[inline(always)]
pub fn mean_direction<T: Scalar>([one, other]: [Planar<T>; 2]) -> Planar<T> {
    (one + other).unit()
}

/// Velocity with which a node meets what surrounds the beam: its own; along a beam that does not stretch that of its frame, [E28].
#[inline]
fn felt_velocity<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> Planar<T> {
    let own = w.motion.v[node];
    if system.model.effects.has(Effect::AxialStretch) {
        return own;
    }
    let share = node as f64 / (system.mesh.nodes - 1) as f64;
    Planar::new(own.x, T::constant(now.carried(1, share).rate))
}
