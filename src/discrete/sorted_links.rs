//! Links by type, so that an evaluation processes simple ones together and skips irrelevant ones.

use super::fluid_mesh::{LinkEnd, MeshLink};
use crate::model::ResolvedNetwork;

/// Indices of links on the mesh, by type.
#[derive(Clone, Debug)]
pub struct SortedLinks {
    /// Pure resistances between two cells: index, source cell and destination cell of positive flow.
    pub between_cells: Vec<[u32; 3]>,
    /// All other links.
    pub others: Vec<usize>,
    /// Links of either kind with a valve that opens and closes.
    pub valves: Vec<usize>,
    /// Links of either kind at a port; no other link leads out of its component of the network.
    pub at_ports: Vec<usize>,
}

impl SortedLinks {
    /// Sorts the links of a mesh.
    pub(super) fn new(links: &[MeshLink], network: &ResolvedNetwork) -> Self {
        let opens = |link: &MeshLink| {
            link.number
                .is_some_and(|number| network.links[number].opening.is_some())
        };
        let ends = |link: &MeshLink| {
            [link.from, link.to]
                .into_iter()
                .any(|place| matches!(place, LinkEnd::Port(_)))
        };
        let mut sorted = Self {
            between_cells: vec![],
            others: vec![],
            valves: (0..links.len()).filter(|&k| opens(&links[k])).collect(),
            at_ports: (0..links.len()).filter(|&k| ends(&links[k])).collect(),
        };
        for (k, link) in links.iter().enumerate() {
            match (link.from, link.to) {
                (LinkEnd::Cell(from), LinkEnd::Cell(to)) if link.is_plain() && link.pilot.is_none() => {
                    sorted.between_cells.push([k, from, to].map(|number| number as u32));
                }
                _ => sorted.others.push(k),
            }
        }
        sorted
    }
}
