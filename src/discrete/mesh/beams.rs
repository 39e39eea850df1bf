//! The beams of a mesh: several in a structure, one after the other.

use std::ops::Range;

use super::BeamMesh;

/// Nodes, cells and segments of one beam.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BeamRanges {
    /// Its nodes.
    pub nodes: Range<usize>,
    /// Its cells.
    pub cells: Range<usize>,
    /// Its segments.
    pub segments: Range<usize>,
}

impl BeamRanges {
    /// Its root and its tip: node, the cell beside it, and the direction from that cell to the node.
    pub fn ends(&self) -> [BeamEnd; 2] {
        let end = |node, cell, outward| BeamEnd { node, cell, outward };
        [
            end(self.nodes.start, self.cells.start, -1.0),
            end(self.nodes.end - 1, self.cells.end - 1, 1.0),
        ]
    }
}

/// An end of a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamEnd {
    /// Node of the end.
    pub node: usize,
    /// Cell beside the node.
    pub cell: usize,
    /// Direction from the cell to the node, -1 at a root and 1 at a tip.
    pub outward: f64,
}

impl BeamMesh {
    /// The mesh followed by those of further beams. Between two beams is an empty cell without length, so that a cell is between the node of
    /// its number and the next. Coordinates are those along each beam.
    #[must_use]
    pub fn followed_by(mut self, next: Self) -> Self {
        let (node, segment) = (self.nodes, self.segments);
        self.lengths.push(0.0);
        self.per_length.push(0.0);
        self.borders.push([0.5; 2]);
        let moved = |range: &Range<usize>, by: usize| range.start + by..range.end + by;
        self.beams.extend(next.beams.iter().map(|own| BeamRanges {
            nodes: moved(&own.nodes, node),
            cells: moved(&own.cells, node),
            segments: moved(&own.segments, segment),
        }));
        self.parts.extend(next.parts.iter().map(|part| moved(part, node)));
        self.lengths.extend(next.lengths);
        self.per_length.extend(next.per_length);
        self.borders.extend(next.borders);
        self.node_lengths.extend(next.node_lengths);
        self.per_node_length.extend(next.per_node_length);
        self.segment_lengths.extend(next.segment_lengths);
        self.coordinates.extend(next.coordinates);
        self.weights.extend(next.weights);
        self.within_parts.extend(next.within_parts);
        Self {
            shortest: self.shortest.min(next.shortest),
            segments: segment + next.segments,
            nodes: node + next.nodes,
            cells: node + next.nodes - 1,
            uniform: false,
            ..self
        }
    }

    /// Beam of a node.
    #[inline]
    pub fn beam_of_node(&self, node: usize) -> usize {
        match self.beams.len() {
            1 => 0,
            _ => self.beams.partition_point(|beam| beam.nodes.end <= node),
        }
    }

    /// Cells of a segment.
    #[inline]
    pub fn cells_of(&self, segment: usize) -> Range<usize> {
        let gaps = match self.beams.len() {
            1 => 0,
            _ => self.beams.partition_point(|beam| beam.segments.end <= segment),
        };
        let first = segment * self.cells_per_segment + gaps;
        first..first + self.cells_per_segment
    }

    /// Segment of a cell; of an empty cell between two beams the one before it.
    #[inline]
    pub fn segment_of(&self, cell: usize) -> usize {
        let beam = &self.beams[self.beam_of_node(cell)];
        let own = beam.segments.start + (cell - beam.cells.start) / self.cells_per_segment;
        own.min(beam.segments.end - 1)
    }

    /// True for an empty cell between two beams.
    #[inline]
    pub fn is_gap(&self, cell: usize) -> bool {
        self.per_length[cell] == 0.0
    }

    /// Ends of all beams, each with its index, `2 b` for the root of beam b and `2 b + 1` for its tip.
    pub fn ends(&self) -> impl Iterator<Item = (usize, BeamEnd)> + '_ {
        self.beams.iter().flat_map(BeamRanges::ends).enumerate()
    }

    /// The end at a node, with its index.
    #[inline]
    pub fn end_at(&self, node: usize) -> Option<(usize, BeamEnd)> {
        let beam = self.beam_of_node(node);
        let own = &self.beams[beam];
        match node {
            _ if node == own.nodes.start => Some((2 * beam, own.ends()[0])),
            _ if node + 1 == own.nodes.end => Some((2 * beam + 1, own.ends()[1])),
            _ => None,
        }
    }

    /// Cells beside a node; twice the same at an end.
    #[inline]
    pub fn cells_beside(&self, node: usize) -> [usize; 2] {
        match self.end_at(node) {
            Some((_, end)) => [end.cell; 2],
            None => [node - 1, node],
        }
    }
}
