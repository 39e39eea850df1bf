//! The semi-discrete equations, in the paper's order.

pub mod ambient_fluid;
pub mod arcs;
pub mod bar;
pub mod bending;
pub mod eccentric;
pub mod fluid;
pub mod fourth_order;
pub mod momentum;
pub mod nonlinear;
pub mod relaxation;
pub mod rotating_frame;
pub mod rows;
pub mod solid;
pub mod timoshenko;
mod unpack;
pub mod von_karman;

use super::{System, TimeData, Workspace, beam_contacts};
use crate::case::schema::Effect;
use crate::model::Kinematics;
use crate::numerics::Scalar;

pub use unpack::unpack;

/// Evaluates everything up to forces and flows: fills the workspace from the state (SI units, not scaled).
pub fn evaluate<T: Scalar>(system: &System, now: &TimeData, y: &[T], yp: &[T], w: &mut Workspace<T>) {
    until_strains(system, now, y, yp, w);
    beyond_strains(system, now, w);
}

/// Evaluates everything up to the strains by pressure.
pub fn until_strains<T: Scalar>(system: &System, now: &TimeData, y: &[T], yp: &[T], w: &mut Workspace<T>) {
    unpack(system, now, y, yp, w);
    fluid::pressures(system, w);
    fluid::pressure_strains(system, w);
}

/// Evaluates the quantities that depend on the strains by pressure.
pub fn beyond_strains<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    nonlinear::forces(system, w);
    let sheared = system.model.effects.has(Effect::Shear);
    match system.model.kinematics {
        Kinematics::Bar => {
            bar::kinematics(system, w);
            bar::rates(system, w);
            solid::normal_forces(system, now, w);
            relaxation::normal_forces(system, w);
            bar::section_forces(system, w);
        }
        Kinematics::Linear | Kinematics::SmallRotation => {
            von_karman::kinematics(system, now, w);
            if sheared {
                timoshenko::kinematics(system, now, w);
            }
            fourth_order::arcs(system, now, w);
            von_karman::rates(system, now, w);
            eccentric::end_curvatures(system, now, w);
            von_karman::normal_forces(system, now, w);
            relaxation::normal_forces(system, w);
            bending::moments(system, now, w);
            eccentric::moments(system, now, w);
            fourth_order::arc_moments(system, now, w);
            if sheared {
                timoshenko::forces(system, now, w);
            } else {
                von_karman::section_forces(system, now, w);
            }
        }
        Kinematics::FiniteRotation => {
            if sheared {
                timoshenko::kinematics(system, now, w);
            } else {
                solid::kinematics(system, now, w);
            }
            fourth_order::arcs(system, now, w);
            solid::rates(system, now, w);
            eccentric::end_curvatures(system, now, w);
            solid::normal_forces(system, now, w);
            relaxation::normal_forces(system, w);
            bending::moments(system, now, w);
            eccentric::moments(system, now, w);
            fourth_order::arc_moments(system, now, w);
            if sheared {
                timoshenko::forces(system, now, w);
            } else {
                bending::shears(system, w);
                solid::section_forces(system, now, w);
            }
        }
    }
    momentum::published_forces(system, now, w);
    beam_contacts::forces(system, w);
    fluid::flows(system, now, w);
}

/// Completes velocities and rates of strain for balances and samples, also if no equation depends on them.
pub fn complete<T: Scalar>(system: &System, now: &TimeData, yp: &[T], w: &mut Workspace<T>) {
    unpack::complete_velocities(system, now, yp, w);
    match system.model.kinematics {
        Kinematics::Bar => bar::strain_rates(system, w),
        Kinematics::Linear | Kinematics::SmallRotation => von_karman::strain_rates(system, now, w),
        Kinematics::FiniteRotation => solid::strain_rates(system, now, w),
    }
}

/// Evaluates the residual `F(t, y, y')`, one equation per unknown, in SI units.
pub fn residual<T: Scalar>(system: &System, now: &TimeData, y: &[T], yp: &[T], w: &mut Workspace<T>, r: &mut [T]) {
    evaluate(system, now, y, yp, w);
    equations(system, now, y, yp, w, r);
}

/// Computes the residual from an evaluated workspace.
pub fn equations<T: Scalar>(system: &System, now: &TimeData, y: &[T], yp: &[T], w: &Workspace<T>, r: &mut [T]) {
    momentum::momentum(system, now, w, r);
    rows::motion(system, y, yp, r);
    system.joints.rows((system, now), y, yp, w, r);
    timoshenko::rows(system, w, r);
    relaxation::rows(system, now, w, r);
    rows::means(system, w, r);
    nonlinear::areas(system, w, r);
    rows::storage(system, w, r);
    rows::lumped(system, now, y, yp, w, r);
    rows::junctions(system, w, r);
    rows::tubes(system, now, w, r);
    rows::bridges(system, now, w, r);
}
