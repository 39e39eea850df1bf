//! Staggered mesh of the beam: positions at nodes; stretch, angle, N and V at cell midpoints; curvature and M at nodes.

/// `K` equal cells in each of `segments` equal segments.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Segments, `n/2` where there are bladders.
    pub segments: usize,
    /// `K`.
    pub cells_per_segment: usize,
    /// Cells, `segments K`.
    pub cells: usize,
    /// Nodes, `cells + 1`.
    pub nodes: usize,
    /// Cell length `h` [m].
    pub h: f64,
    /// Length of a segment `l_seg` [m].
    pub segment_length: f64,
    /// Whether what it leaves out of the beam is of fourth order, [`super::residual::fourth`].
    pub fourth: bool,
}

impl Mesh {
    /// Uniform mesh of a beam of the given length [m].
    pub fn new(length: f64, segments: usize, cells_per_segment: usize) -> Self {
        let cells = segments * cells_per_segment;
        Self {
            segments,
            cells_per_segment,
            cells,
            nodes: cells + 1,
            h: length / cells as f64,
            segment_length: length / segments as f64,
            fourth: false,
        }
    }

    /// The same mesh, of fourth order or of second: with fewer than six cells the weights of its two ends would meet, and it is of second.
    #[must_use]
    pub fn of_order(self, order: u8) -> Self {
        Self {
            fourth: order == 4 && self.cells >= Self::fewest(4),
            ..self
        }
    }

    /// Fewest cells of a beam that are of an order.
    pub fn fewest(order: u8) -> usize {
        if order == 4 { 6 } else { 1 }
    }

    /// Length that belongs to a node: `h`, at the ends `h/2`.
    #[inline]
    pub fn node_length(&self, node: usize) -> f64 {
        if node == 0 || node + 1 == self.nodes {
            0.5 * self.h
        } else {
            self.h
        }
    }

    /// `[E78]` Has what acts on nodes by their hat functions act so that its work on a smooth motion is of the order of the mesh:
    ///
    /// ```text
    /// ∫ b u dθ = Σ B_i (u_i - δ²u_i/12) + O(h^4)      B_i = ∫ b hat_i dθ      δ²u_0 = δ²u_1, at the other end alike
    /// ```
    ///
    /// Total and first moment stay what they are. What is uniform comes to `(3/8, 7/6, 23/24, 1, ..) h b` (Gregory).
    pub fn lump(&self, values: &mut [f64]) {
        if !self.fourth {
            return;
        }
        let last = values.len() - 1;
        let given = values.to_vec();
        for (i, part) in given.iter().enumerate() {
            let middle = i.clamp(1, last - 1);
            values[middle - 1] -= part / 12.0;
            values[middle] += part / 6.0;
            values[middle + 1] -= part / 12.0;
        }
    }

    /// Weight of a node in its segment's mean moment: trapezoid `(1/2, 1, .., 1, 1/2)/K`.
    #[inline]
    pub fn moment_weight(&self, within_segment: usize) -> f64 {
        let edge = within_segment == 0 || within_segment == self.cells_per_segment;
        (if edge { 0.5 } else { 1.0 }) / self.cells_per_segment as f64
    }

    /// Segments on the two sides of a node (the same twice inside a segment and at the ends).
    #[inline]
    pub fn segments_of_node(&self, node: usize) -> (usize, usize) {
        let right = (node / self.cells_per_segment).min(self.segments - 1);
        let left = if node == 0 {
            0
        } else {
            (node - 1) / self.cells_per_segment
        };
        (left, right)
    }

    /// Material coordinate of a node [m].
    pub fn node_coordinate(&self, node: usize) -> f64 {
        node as f64 * self.h
    }

    /// Material coordinate of a cell's midpoint [m].
    pub fn cell_coordinate(&self, cell: usize) -> f64 {
        (cell as f64 + 0.5) * self.h
    }
}
