//! Self-crossing of the beam.

use super::{System, Workspace};
use crate::model::Kinematics;
use crate::numerics::Planar;

/// Returns two places along the undeformed beam [m] at which its line crosses itself (the first pair found), or none. A line whose
/// tangents are all within a right angle of their mean cannot cross itself. For others, only cells that are sufficiently close are
/// compared. Does not allocate.
pub fn first(system: &System, w: &Workspace<f64>) -> Option<[f64; 2]> {
    let cells = system.mesh.cells;
    if system.model.kinematics != Kinematics::FiniteRotation
        || system.model.structure.is_some()
        || !system.beam_contacts.is_empty()
    {
        return None;
    }
    let u = &w.motion.u[..=cells];
    let mesh = &system.mesh;
    let at = |node: usize| Planar::new(u[node].x, u[node].z + mesh.node_coordinate(node));
    let whole = at(cells) - at(0);
    if (0..cells).all(|c| (at(c + 1) - at(c)).dot(whole) > 0.0) {
        return None;
    }
    let longest = (0..cells).fold(0.0, |most: f64, c| most.max((at(c + 1) - at(c)).squared()));
    let longest = longest.sqrt();
    for first in 0..cells {
        let (a, b) = (at(first), at(first + 1));
        let mut second = first + 2;
        while second < cells {
            // the distance between two cells requires a minimum number of cells in between
            let apart = (at(second) - a).squared().sqrt();
            let near = apart <= 2.0 * longest;
            if near && let Some([s, t]) = meet([a, b], [at(second), at(second + 1)]) {
                return Some([mesh.coordinate(first as f64 + s), mesh.coordinate(second as f64 + t)]);
            }
            second += if near {
                1
            } else {
                ((apart / longest) as usize).saturating_sub(1).max(1)
            };
        }
    }
    None
}

/// Intersection of two straight segments, as fractions of each from 0 to 1; none if they do not intersect or are
/// parallel.
fn meet([a, b]: [Planar<f64>; 2], [c, d]: [Planar<f64>; 2]) -> Option<[f64; 2]> {
    let (along, other, between) = (b - a, d - c, c - a);
    let cross = |p: Planar<f64>, q: Planar<f64>| p.x * q.z - p.z * q.x;
    let area = cross(along, other);
    let parts = [cross(between, other) / area, cross(between, along) / area];
    parts.iter().all(|part| (0.0..=1.0).contains(part)).then_some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: the intersection of crossing segments is exact; parallel and distant segments have none.
    #[test]
    fn pieces_meet_where_they_cross() {
        let at = |x: f64, z: f64| Planar { x, z };
        let first = [at(0.0, 0.0), at(2.0, 2.0)];
        assert_eq!(meet(first, [at(0.0, 1.0), at(1.0, 0.0)]), Some([0.25, 0.5]));
        assert_eq!(meet(first, [at(0.0, 1.0), at(2.0, 3.0)]), None);
        assert_eq!(meet(first, [at(3.0, 2.0), at(2.0, 3.0)]), None);
        assert_eq!(meet(first, first), None);
    }
}
