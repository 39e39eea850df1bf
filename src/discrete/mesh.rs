//! Staggered mesh of the beam: positions at nodes; stretch, angle, N and V at cell midpoints; curvature and M at nodes.

/// Mesh with `K` equal cells in each of `segments` equal segments.
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
    /// Cell length `h` [m].
    pub h: f64,
    /// Length of a segment `l_seg` [m].
    pub segment_length: f64,
    /// True if the discretization error of the beam is of fourth order, [`super::residual::fourth_order`].
    pub fourth: bool,
}

impl BeamMesh {
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

    /// Sets the order of the mesh, 2 or 4. With fewer than six cells it remains 2, because the weights of both ends would overlap.
    #[must_use]
    pub fn of_order(self, order: u8) -> Self {
        Self {
            fourth: order == 4 && self.cells >= Self::fewest(4),
            ..self
        }
    }

    /// Minimum number of cells of a beam for an order.
    pub fn fewest(order: u8) -> usize {
        if order == 4 { 6 } else { 1 }
    }

    /// Length of a node: `h`, at the ends `h/2`.
    #[inline]
    pub fn node_length(&self, node: usize) -> f64 {
        if node == 0 || node + 1 == self.nodes {
            0.5 * self.h
        } else {
            self.h
        }
    }

    /// `[E78]` Redistributes nodal loads of hat functions such that their work on a smooth motion has the order of the mesh:
    ///
    /// ```text
    /// ∫ b u dθ = Σ B_i (u_i - δ²u_i/12) + O(h^4)      B_i = ∫ b hat_i dθ      δ²u_0 = δ²u_1, at the other end alike
    /// ```
    ///
    /// Total and first moment are unchanged. A uniform load becomes `(3/8, 7/6, 23/24, 1, ..) h b` (Gregory).
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

    /// Segments on both sides of a node (equal inside a segment and at the ends).
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
