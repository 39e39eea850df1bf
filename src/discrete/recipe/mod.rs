//! The semi-discrete equations in the paper's order: what lies between two instants is nothing but this.

pub mod fluid;
pub mod rows;
pub mod solid;
mod unpack;

use super::{Instant, System, Workspace};
use crate::model::Scalar;

pub use unpack::unpack;

/// Everything up to forces and flows: fills the workspace from the state (SI units, not scaled).
pub fn evaluate<T: Scalar>(system: &System, now: &Instant, y: &[T], yp: &[T], w: &mut Workspace<T>) {
    unpack(system, now, y, yp, w);
    fluid::pressures(system, w);
    fluid::pressure_strains(system, w);
    solid::kinematics(system, now, w);
    solid::rates(system, now, w);
    solid::resultants(system, now, w);
    solid::section_forces(system, now, w);
    fluid::flows(system, now, w);
}

/// The residual `F(t, y, y')`, one equation an unknown, in SI units.
pub fn residual<T: Scalar>(system: &System, now: &Instant, y: &[T], yp: &[T], w: &mut Workspace<T>, r: &mut [T]) {
    evaluate(system, now, y, yp, w);
    rows::momentum(system, now, w, r);
    rows::motion(system, y, yp, r);
    rows::means(system, w, r);
    rows::storage(system, w, r);
    rows::junctions(system, w, r);
    rows::bridges(system, now, w, r);
}
