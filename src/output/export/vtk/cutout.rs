//! Positions of the bladders in the beam: two rows, with walls of equal thickness above, between and below them.

use crate::case::structure::Piece;
use crate::case::{Case, spans};

/// Dimensions of the beam and of its cutouts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cutout {
    /// Half the beam's height `h_s` [m].
    pub half_height: f64,
    /// Half its width `w_s` [m].
    pub half_width: f64,
    /// Half a bladder's length `l_b` across the width, at most the beam's [m].
    pub half_across: f64,
    /// Lower and upper edge of the upper row [m]; the lower row mirrors it.
    pub row: [f64; 2],
    /// Start and end of each segment's bladders along the beam [m], equal without bladders; empty for a dry beam.
    pub windows: Vec<[f64; 2]>,
    /// Length of the beam [m].
    pub length: f64,
    /// First of its segments among those of a structure.
    pub first: usize,
}

impl Cutout {
    /// Cutout of a case. The paper gives sizes of bladders, not positions; bladders are centered in their segments.
    pub fn new(case: &Case) -> Self {
        let (beam, bladders) = (&case.beam, case.bladders.as_ref());
        let half_height = 0.5 * beam.height_m;
        let height = bladders.map_or(0.0, |b| b.height_m.min(half_height));
        let wall = (beam.height_m - 2.0 * height) / 3.0;
        let per_row = bladders.map_or(0, |b| b.per_row);
        let ends = spans::segment_ends(case);
        Self {
            half_height,
            half_width: 0.5 * beam.width_m,
            half_across: 0.5 * bladders.map_or(0.0, |b| b.length_m.min(beam.width_m)),
            row: [0.5 * wall, 0.5 * wall + height],
            windows: ends
                .windows(2)
                .take(per_row)
                .map(|ends| {
                    let middle = 0.5 * (ends[0] + ends[1]);
                    let half = 0.5 * bladders.map_or(0.0, |b| b.width_m.min(ends[1] - ends[0]));
                    [middle - half, middle + half]
                })
                .collect(),
            length: beam.length_m,
            first: 0,
        }
    }

    /// Cutout of a part of a structure, with the sizes of its first segment.
    pub fn of_part(case: &Case, piece: &Piece) -> Self {
        let mut own = piece.case(case);
        if let Some(first) = spans::segments(&own).into_iter().next() {
            own.beam.height_m = first.beam.height_m;
            own.beam.width_m = first.beam.width_m;
            if let (Some(bladders), Some([upper, _])) = (&mut own.bladders, first.bladders) {
                (bladders.height_m, bladders.width_m) = (upper.height_m, upper.width_m);
            }
        }
        let mut cutout = Self::new(&own);
        let (there, per_row) = (spans::bladders(&own), cutout.windows.len());
        for (k, window) in cutout.windows.iter_mut().enumerate() {
            if !there(k) && !there(per_row + k) {
                window[1] = window[0];
            }
            *window = window.map(|edge| edge + piece.from);
        }
        cutout.first = piece.segments[0];
        cutout
    }

    /// Window of a bladder `R j`, if the part has its segment.
    pub fn window(&self, label: i64) -> Option<[f64; 2]> {
        let segment = (label.unsigned_abs() as usize).checked_sub(1 + self.first)?;
        self.windows.get(segment).copied()
    }

    /// Coordinates of nodes and window edges, ascending.
    pub fn stations(&self, nodes: &[f64]) -> Vec<f64> {
        // An edge that differs from a node only by round-off is that node.
        let apart = 1e-9 * self.length;
        let edges = self
            .windows
            .iter()
            .filter(|window| window[0] < window[1])
            .flatten()
            .copied();
        let mut all: Vec<f64> = nodes.to_vec();
        all.extend(edges.filter(|e| nodes.iter().all(|n| (n - e).abs() > apart)));
        all.sort_by(f64::total_cmp);
        all.dedup_by(|a, b| (*a - *b).abs() <= apart);
        all
    }

    /// True if the interval between two stations lies beside a bladder.
    pub fn beside_bladder(&self, from: f64, to: f64) -> bool {
        let middle = 0.5 * (from + to);
        self.windows.iter().any(|w| w[0] < middle && middle < w[1])
    }

    /// Heights at which the beam's sides are divided, bottom to top.
    pub fn heights(&self) -> Vec<f64> {
        let (top, [low, high]) = (self.half_height, self.row);
        if self.windows.is_empty() {
            vec![-top, top]
        } else {
            vec![-top, -high, -low, low, high, top]
        }
    }
}
