//! Staggered mesh of the beam: positions at nodes; stretch, angle, N and V at cell midpoints; curvature and M at nodes.

use std::iter;
use std::ops::Range;

use super::shapes::Cells;

mod beams;

pub use beams::{BeamEnd, BeamRanges};

/// Mesh with `K` equal cells in each segment.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamMesh {
    /// Number of segments, `n/2` if there are bladders.
    pub segments: usize,
    /// Cells per segment `K`.
    pub cells_per_segment: usize,
    /// Number of cells, `segments K`.
    pub cells: usize,
    /// Number of nodes, `cells + 1`.
    pub nodes: usize,
    /// Length of the shortest cells, `h` in a uniform mesh [m].
    pub shortest: f64,
    /// Length `h_c` of each cell [m].
    pub lengths: Vec<f64>,
    /// `1/h_c` of each cell [1/m].
    pub per_length: Vec<f64>,
    /// Length `h_i` of each node, half of the cells beside it [m].
    pub node_lengths: Vec<f64>,
    /// `1/h_i` of each node [1/m].
    pub per_node_length: Vec<f64>,
    /// Shares of the left and the right segment in the length of each node between two segments.
    pub borders: Vec<[f64; 2]>,
    /// Length of each segment `l_seg` [m].
    pub segment_lengths: Vec<f64>,
    /// Material coordinate of each node [m].
    coordinates: Vec<f64>,
    /// Nodal loads of a uniform load on each smooth part, in units of its cells, as [`Self::lump`] distributes them.
    pub weights: Vec<Vec<f64>>,
    /// True for nodes inside of smooth parts.
    within_parts: Vec<bool>,
    /// True if all cells have one length.
    pub uniform: bool,
    /// Cells of the smooth parts of the beam: within a part, sections and cell lengths do not jump.
    pub parts: Vec<Range<usize>>,
    /// True if the discretization error of the beam is of fourth order, [`super::residual::fourth_order`].
    pub fourth: bool,
    /// Beams, one after the other.
    pub beams: Vec<BeamRanges>,
    /// Beginning and length of the mesh in units of the length of the beam of which it is a part.
    portion: [f64; 2],
}

impl BeamMesh {
    /// Mesh of a beam with segments of the given lengths [m], which has the given length in total.
    pub fn new(length: f64, segment_lengths: Vec<f64>, cells_per_segment: usize) -> Self {
        let segments = segment_lengths.len();
        let cells = segments * cells_per_segment;
        let uniform = segment_lengths.windows(2).all(|pair| pair[0] == pair[1]);
        let equal = length / cells as f64;
        let cell_of = |segment: &f64| {
            if uniform {
                equal
            } else {
                segment / cells_per_segment as f64
            }
        };
        let lengths: Vec<f64> = segment_lengths
            .iter()
            .flat_map(|segment| iter::repeat_n(cell_of(segment), cells_per_segment))
            .collect();
        let mut end = 0.0;
        let summed = lengths.iter().map(|length| {
            end += length;
            end
        });
        let coordinates = match uniform {
            true => (0..=cells).map(|node| node as f64 * equal).collect(),
            false => iter::once(0.0).chain(summed).collect(),
        };
        let node_length = |node: usize| match [node.checked_sub(1), Some(node).filter(|node| *node < cells)] {
            [Some(left), Some(right)] if lengths[left] == lengths[right] => lengths[left],
            beside => 0.5 * beside.into_iter().flatten().map(|cell| lengths[cell]).sum::<f64>(),
        };
        let node_lengths: Vec<f64> = (0..=cells).map(node_length).collect();
        let border = |pair: &[f64]| match pair[0] == pair[1] {
            true => [0.5; 2],
            false => [pair[0], pair[1]].map(|length| length / (pair[0] + pair[1])),
        };
        let inverse = |lengths: &[f64]| lengths.iter().map(|length| 1.0 / length).collect();
        Self {
            segments,
            cells_per_segment,
            cells,
            nodes: cells + 1,
            shortest: lengths.iter().copied().fold(f64::INFINITY, f64::min),
            per_length: inverse(&lengths),
            per_node_length: inverse(&node_lengths),
            lengths,
            node_lengths,
            borders: segment_lengths.windows(2).map(border).collect(),
            segment_lengths,
            coordinates,
            weights: vec![],
            within_parts: (0..=cells).map(|node| node > 0 && node < cells).collect(),
            uniform,
            parts: iter::once(0..cells).collect(),
            fourth: false,
            portion: [0.0, 1.0],
            beams: vec![BeamRanges {
                nodes: 0..cells + 1,
                cells: 0..cells,
                segments: 0..segments,
            }],
        }
    }

    /// Sets the beginning and the length of the mesh in units of the length of the beam of which it is a part.
    #[must_use]
    pub fn portion(self, portion: [f64; 2]) -> Self {
        Self { portion, ..self }
    }

    /// Divides the mesh into smooth parts at the beginning of segments.
    #[must_use]
    pub fn divided(self, jumps: &[usize]) -> Self {
        let borders = jumps.iter().map(|segment| segment * self.cells_per_segment);
        let ends: Vec<usize> = iter::once(0).chain(borders).chain([self.cells]).collect();
        let mut within_parts = vec![true; self.nodes];
        ends.iter().for_each(|node| within_parts[*node] = false);
        Self {
            within_parts,
            parts: ends.windows(2).map(|ends| ends[0]..ends[1]).collect(),
            ..self
        }
    }

    /// True for a node inside of a smooth part.
    #[inline]
    pub fn is_within_part(&self, node: usize) -> bool {
        self.within_parts[node]
    }

    /// Is a cell the first, and is it the last, of a smooth part?
    #[inline]
    pub fn at_part_ends(&self, cell: usize) -> [bool; 2] {
        [cell, cell + 1].map(|node| !self.within_parts[node])
    }

    /// Sets the order of the mesh, 2 or 4. It remains 2 with fewer than six cells, and with a part of one cell: the weights of both ends
    /// would overlap.
    #[must_use]
    pub fn of_order(self, order: u8) -> Self {
        let enough = self.cells >= Self::fewest(4) && self.parts.iter().all(|part| part.len() > 1);
        let fourth = order == 4 && enough;
        let weights = |part: &Range<usize>| {
            let mut weights = vec![1.0; part.len() + 1];
            (weights[0], weights[part.len()]) = (0.5, 0.5);
            if fourth {
                redistribute(&weights.clone(), &mut weights);
            }
            weights
        };
        Self {
            weights: self.parts.iter().map(weights).collect(),
            fourth,
            ..self
        }
    }

    /// Minimum number of cells of a beam for an order.
    pub fn fewest(order: u8) -> usize {
        if order == 4 { 6 } else { 1 }
    }

    /// `[E78]` Redistributes nodal loads of hat functions such that their work on a smooth motion has the order of the mesh:
    ///
    /// ```text
    /// ∫ b u dθ = Σ B_i (u_i - δ²u_i/12) + O(h^4)      B_i = ∫ b hat_i dθ      δ²u_0 = δ²u_1, at the other end alike
    /// ```
    ///
    /// in each smooth part; a load at a node between two parts belongs to both, by the lengths of their cells. Total and first moment are
    /// unchanged. A uniform load becomes `(3/8, 7/6, 23/24, 1, ..) h b` (Gregory).
    pub fn lump(&self, values: &mut [f64]) {
        if !self.fourth {
            return;
        }
        let share = |node: usize, side: usize| match node == 0 || node == self.cells {
            true => 1.0,
            false => self.sides_of_node(node).1[side],
        };
        let given = values.to_vec();
        for &Range { start, end } in &self.parts {
            let mut own = given[start..=end].to_vec();
            own[0] *= share(start, 1);
            own[end - start] *= share(end, 0);
            redistribute(&own, &mut values[start..=end]);
        }
    }

    /// Shares of the segments on both sides of each node in its mass, from those in its length.
    pub fn shares_in_mass(&self, shares: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut all = shares.to_vec();
        for (pair, weights) in self.parts.windows(2).zip(self.weights.windows(2)) {
            let left = weights[0][pair[0].len()] * self.lengths[pair[0].start];
            let right = weights[1][0] * self.lengths[pair[1].start];
            all[pair[1].start] = [left, right].map(|side| side / (left + right));
        }
        all
    }

    /// Weight of a node in its segment's mean moment: trapezoid `(1/2, 1, .., 1, 1/2)/K`.
    #[inline]
    pub fn moment_weight(&self, within_segment: usize) -> f64 {
        let edge = within_segment == 0 || within_segment == self.cells_per_segment;
        (if edge { 0.5 } else { 1.0 }) / self.cells_per_segment as f64
    }

    /// Segments on both sides of a node (equal inside a segment and at the ends).
    #[inline]
    pub fn segments_of_node(&self, node: usize) -> (usize, usize) {
        let beam = &self.beams[self.beam_of_node(node)];
        let (node, first) = (node - beam.nodes.start, beam.segments.start);
        let right = (node / self.cells_per_segment).min(beam.segments.len() - 1);
        let left = if node == 0 {
            0
        } else {
            (node - 1) / self.cells_per_segment
        };
        (first + left, first + right)
    }

    /// Segments on both sides of a node, with their shares in its length.
    #[inline]
    pub fn sides_of_node(&self, node: usize) -> ([usize; 2], [f64; 2]) {
        let (left, right) = self.segments_of_node(node);
        let shares = self.borders.get(left).filter(|_| left != right);
        ([left, right], *shares.unwrap_or(&[0.5; 2]))
    }

    /// Material coordinate of a node [m].
    #[inline]
    pub fn node_coordinate(&self, node: usize) -> f64 {
        self.coordinates[node]
    }

    /// Material coordinate of a cell's midpoint [m].
    pub fn cell_coordinate(&self, cell: usize) -> f64 {
        match self.uniform {
            true => (cell as f64 + 0.5) * self.lengths[cell],
            false => self.coordinates[cell] + 0.5 * self.lengths[cell],
        }
    }

    /// Place in units of cells, from 0 to their number, of a place in units of the beam's length, from 0 to 1.
    pub fn place(&self, at: f64) -> f64 {
        if self.uniform {
            return at * self.cells as f64;
        }
        let coordinate = at * self.coordinates[self.cells];
        let cell = self
            .coordinates
            .partition_point(|node| *node <= coordinate)
            .clamp(1, self.cells)
            - 1;
        cell as f64 + (coordinate - self.coordinates[cell]) * self.per_length[cell]
    }

    /// Material coordinate of a place in units of cells [m].
    pub fn coordinate(&self, place: f64) -> f64 {
        let cell = (place as usize).min(self.cells - 1);
        match self.uniform {
            true => place * self.lengths[cell],
            false => self.coordinates[cell] + (place - cell as f64) * self.lengths[cell],
        }
    }

    /// Cell, the next of which has its midpoint beyond a place in units of cells, and the place in units of the distance of both midpoints.
    /// At the ends the place is not between them; the only cell of a mesh has share 0.
    pub fn between_midpoints(&self, place: f64) -> (usize, f64) {
        let last = self.cells.saturating_sub(2);
        let cell = ((place - 0.5).max(0.0) as usize).min(last);
        if self.cells == 1 {
            return (cell, 0.0);
        }
        if self.uniform {
            return (cell, place - 0.5 - cell as f64);
        }
        let [here, next] = [cell, cell + 1].map(|cell| self.cell_coordinate(cell));
        (cell, (self.coordinate(place) - here) / (next - here))
    }

    /// Cells in units of the length of the beam of which the mesh is a part.
    pub fn shares(&self) -> Cells {
        let [begin, portion] = self.portion;
        if self.uniform && portion == 1.0 {
            return Cells::equal(self.cells);
        }
        let total = self.coordinates[self.cells] / portion;
        let relative = |lengths: &[f64], from: f64| lengths.iter().map(|length| from + length / total).collect();
        Cells {
            nodes: relative(&self.coordinates, begin),
            lengths: relative(&self.lengths, 0.0),
        }
    }

    /// Place of a node in units of the beam's length, from 0 to 1.
    pub fn share(&self, node: usize) -> f64 {
        match self.uniform {
            true => node as f64 / self.cells as f64,
            false => self.coordinates[node] / self.coordinates[self.cells],
        }
    }
}

/// Adds the correction of [`BeamMesh::lump`] for the given nodal loads of a smooth part.
fn redistribute(given: &[f64], values: &mut [f64]) {
    let last = given.len() - 1;
    for (i, part) in given.iter().enumerate() {
        let middle = i.clamp(1, last - 1);
        values[middle - 1] -= part / 12.0;
        values[middle] += part / 6.0;
        values[middle + 1] -= part / 12.0;
    }
}
