//! Which links are what: an evaluation looks at plain ones in one go, and at none that does not matter to it.

use super::fluid_mesh::{MeshLink, Place};
use crate::model::Network;

/// Numbers of links among all of the mesh.
#[derive(Clone, Debug)]
pub struct SortedLinks {
    /// Nothing but a resistance between two cells: number, cell that positive flow comes from, cell that it goes to.
    pub between_cells: Vec<[u32; 3]>,
    /// All others.
    pub others: Vec<usize>,
    /// Those of either kind with a valve that opens and shuts.
    pub valves: Vec<usize>,
    /// Those of either kind from or to a port: no other leads out of its component of the network.
    pub at_ports: Vec<usize>,
}

impl SortedLinks {
    /// Of the links of a mesh.
    pub(super) fn new(links: &[MeshLink], network: &Network) -> Self {
        let opens = |link: &MeshLink| {
            link.number
                .is_some_and(|number| network.links[number].opening.is_some())
        };
        let ends = |link: &MeshLink| {
            [link.from, link.to]
                .into_iter()
                .any(|place| matches!(place, Place::Port(_)))
        };
        let mut sorted = Self {
            between_cells: vec![],
            others: vec![],
            valves: (0..links.len()).filter(|&k| opens(&links[k])).collect(),
            at_ports: (0..links.len()).filter(|&k| ends(&links[k])).collect(),
        };
        for (k, link) in links.iter().enumerate() {
            match (link.from, link.to) {
                (Place::Cell(from), Place::Cell(to)) if link.is_plain() => {
                    sorted.between_cells.push([k, from, to].map(|number| number as u32));
                }
                _ => sorted.others.push(k),
            }
        }
        sorted
    }
}
