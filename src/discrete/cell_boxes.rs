//! Boxes around the cells of a mesh, sorted to find those near a place.

use super::System;
use crate::numerics::{Planar, Scalar};

/// Places of all nodes, and boxes around the cells, sorted along one axis.
#[derive(Clone, Debug, Default)]
pub struct CellBoxes {
    /// Places in the axes of the case [m].
    pub places: Vec<Planar<f64>>,
    /// Axis along which the structure is longest.
    axis: usize,
    /// Begin of the box of each cell along the axis [m], and the cell.
    begins: Vec<(f64, usize)>,
    /// Length of the longest box along the axis [m].
    longest: f64,
}

impl CellBoxes {
    /// Boxes of a mesh; empty without contacts of beams.
    pub fn new(system: &System) -> Self {
        if system.beam_contacts.is_empty() {
            return Self::default();
        }
        let cells = (0..system.mesh.cells).filter(|cell| !system.mesh.is_gap(*cell));
        Self {
            places: vec![Planar::default(); system.mesh.nodes],
            begins: cells.map(|cell| (0.0, cell)).collect(),
            ..Self::default()
        }
    }

    /// Moves the boxes to displacements of the nodes.
    pub fn update<T: Scalar>(&mut self, system: &System, u: &[Planar<T>]) {
        let mut range = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for (node, place) in self.places.iter_mut().enumerate() {
            *place = plain(system.place(u, node));
            for axis in 0..2 {
                range[0][axis] = range[0][axis].min(place[axis]);
                range[1][axis] = range[1][axis].max(place[axis]);
            }
        }
        self.axis = usize::from(range[1][1] - range[0][1] > range[1][0] - range[0][0]);
        self.longest = 0.0;
        let fiber = &system.sections.farthest_fiber;
        for (begin, cell) in &mut self.begins {
            let [a, b] = [*cell, *cell + 1].map(|node| self.places[node][self.axis]);
            let around = fiber[*cell].max(fiber[*cell + 1]);
            *begin = a.min(b) - around;
            self.longest = self.longest.max((a - b).abs() + 2.0 * around);
        }
        self.begins.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    }

    /// Cells whose boxes may overlap that of a place.
    pub fn near(&self, place: Planar<f64>, around: f64) -> impl Iterator<Item = usize> + '_ {
        let [from, to] = [place[self.axis] - around - self.longest, place[self.axis] + around];
        let first = self.begins.partition_point(|(begin, _)| *begin < from);
        let near = self.begins[first..].iter().take_while(move |(begin, _)| *begin <= to);
        near.map(|(_, cell)| *cell)
    }
}

fn plain<T: Scalar>(v: Planar<T>) -> Planar<f64> {
    Planar {
        x: v.x.value().unwrap_or(0.0),
        z: v.z.value().unwrap_or(0.0),
    }
}
