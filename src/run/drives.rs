//! Magnitudes of the loads and motions that drive a beam.

use crate::discrete::TimeData;
use crate::discrete::time_data::PointForces;
use crate::numerics::Planar;

/// Number of kinds of excitation: distributed loads along x and z and their moments; forces at ends and points along x and z;
/// follower forces; moments and slopes of ends; motions of ends along x and z; pressures and flows of ports; rotation of the frame.
pub(super) const KINDS: usize = 11;

/// Magnitude of each kind of excitation at an instant.
pub(super) fn sizes(now: &TimeData) -> [f64; KINDS] {
    let size = |most: f64, v: &f64| most.max(v.abs());
    let largest = |values: &[f64]| values.iter().fold(0.0, size);
    let component = |values: &[Planar<f64>], axis: usize| values.iter().fold(0.0, |most, v| size(most, &v[axis]));
    let end = |f: &dyn Fn(usize) -> f64| f(0).abs().max(f(1).abs());
    let point = |f: &dyn Fn(&PointForces) -> f64| now.point_force.iter().map(f).fold(0.0, |most, v| size(most, &v));
    let ends = &now.ends;
    [
        component(&now.force, 0),
        component(&now.force, 1),
        component(&now.moment, 0).max(component(&now.moment, 1)),
        end(&|k| ends[k].force.x).max(point(&|p| p.dead.x)),
        end(&|k| ends[k].force.z).max(point(&|p| p.dead.z)),
        end(&|k| {
            ends[k]
                .follower
                .map_or(0.0, |(normal, shear)| normal.abs().max(shear.abs()))
        })
        .max(point(&|p| p.follower.x.abs().max(p.follower.z.abs()))),
        end(&|k| ends[k].moment.value).max(end(&|k| ends[k].slope.map_or(0.0, |s| s.value))),
        end(&|k| ends[k].u[0].map_or(0.0, |u| u.value)),
        end(&|k| ends[k].u[1].map_or(0.0, |u| u.value)),
        largest(&now.port_pressure).max(largest(&now.source_flow)),
        now.frame_rotation.value.abs(),
    ]
}
