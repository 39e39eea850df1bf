//! The paper's coordinate of the network, `X_f`, and its maps to and from the beam (A.59-A.61, tables A.1 and A.2).

use super::Wet;
use crate::case::schema::Case;
use crate::case::wiring::bladder_label;

/// Ratio of the tube length in the paper's tables, 0.0184 m, to that in its text, 0.020 m.
pub const TABLE_TUBE_RATIO: f64 = 0.92;

/// Gap between separate arrays in table A.2.
const GAP: f64 = 0.001;

/// Positions of bladders along `X_f`.
#[derive(Clone, Debug, PartialEq)]
pub struct NetworkCoordinate {
    /// Bladders in a row.
    pub per_row: usize,
    /// Bladder and tube length over the total length `l_b n + l_c n_c` (A.60).
    pub bladder: f64,
    /// Start and end of each bladder, table A.2.
    pub spans: Vec<(f64, f64)>,
    /// Center of each bladder, table A.1 (no gaps between arrays).
    pub centres: Vec<f64>,
    /// Bladders in the order of `X_f`, array by array; unconnected ones are arrays of one. Bladders that do not exist are last, beyond 1.
    pub arrays: Vec<Vec<usize>>,
    /// Existence of each bladder, upper row first. The tables list those that exist.
    pub there: Vec<bool>,
}

/// Length of the tubes of a case in the paper's tables [m].
pub fn tube_length(case: &Case) -> f64 {
    case.tubes.as_ref().map_or(0.0, |t| t.length_m)
}

/// Network coordinate of a case in the convention of the paper's tables.
pub fn network_coordinate(case: &Case, wet: &Wet) -> NetworkCoordinate {
    NetworkCoordinate::with_table_ratio(wet, tube_length(case))
}

impl NetworkCoordinate {
    /// Network coordinate in the convention of the paper's tables, for a tube length in SI [m].
    pub fn with_table_ratio(wet: &Wet, tube_length: f64) -> Self {
        let tube = TABLE_TUBE_RATIO * tube_length;
        Self::new(wet, tube)
    }

    /// Coordinate of a network whose tubes have length `tube_length` [m] in the tables.
    pub fn new(wet: &Wet, tube_length: f64) -> Self {
        let (network, per_row, bladder_length) = (&wet.network, wet.per_row, wet.bladder_length);
        let n = 2 * per_row;
        let there: Vec<bool> = (0..n).map(|b| wet.has(b)).collect();
        let bladders = there.iter().filter(|there| **there).count();
        let mut arrays = network.chains.clone();
        let mut seen = vec![false; n];
        for &b in arrays.iter().flatten() {
            seen[b] = true;
        }
        let mut alone: Vec<usize> = (0..n).filter(|&b| !seen[b]).collect();
        alone.sort_by_key(|&b| !there[b]);
        arrays.extend(alone.into_iter().map(|b| vec![b]));
        let chain_tubes: usize = network.chains.iter().map(|c| c.len() - 1).sum();
        let total = bladder_length * bladders as f64 + tube_length * chain_tubes as f64;
        let (bladder, tube) = (bladder_length / total, tube_length / total);
        let mut spans = vec![(0.0, 0.0); n];
        let mut centres = vec![0.0; n];
        let (mut at, mut centre) = (0.0, 0.5 * bladder);
        for (k, array) in arrays.iter().enumerate() {
            if k > 0 {
                at += GAP;
            }
            for (i, &b) in array.iter().enumerate() {
                if i > 0 {
                    at += tube;
                    centre += tube;
                }
                spans[b] = (at, at + bladder);
                centres[b] = centre;
                at += bladder;
                centre += bladder;
            }
        }
        Self {
            per_row,
            bladder,
            spans,
            centres,
            arrays,
            there,
        }
    }

    /// Table A.1: rows `(Theta R, X_f, R j)`, two for each bladder, in the order of `Theta R` (A.59).
    pub fn theta_to_xf(&self) -> Vec<(f64, f64, i64)> {
        let m = self.per_row as f64;
        let epsilon = 0.1 / m;
        let mut rows = Vec::with_capacity(4 * self.per_row);
        for j in (1..=self.per_row).rev().filter(|j| self.there[self.per_row + j - 1]) {
            let x = self.centres[self.per_row + j - 1];
            // The paper ends bladder -1 at -0.001, all others at epsilon.
            let end = if j == 1 {
                0.1 * epsilon
            } else {
                (j - 1) as f64 / m + epsilon
            };
            rows.push((-(j as f64) / m, x, -(j as i64)));
            rows.push((-end, x, -(j as i64)));
        }
        for j in (1..=self.per_row).filter(|j| self.there[j - 1]) {
            let x = self.centres[j - 1];
            let start = if j == 1 { 0.0 } else { (j - 1) as f64 / m + epsilon };
            rows.push((start, x, j as i64));
            rows.push((j as f64 / m, x, j as i64));
        }
        rows
    }

    /// Table A.2: rows `(X_f, Theta, R j)`, two for each bladder, upper row first (A.61).
    pub fn xf_to_theta(&self) -> Vec<(f64, f64, i64)> {
        let n = 2.0 * self.per_row as f64;
        (0..self.spans.len())
            .filter(|&b| self.there[b])
            .flat_map(|b| {
                let label = bladder_label(b, self.per_row);
                let theta = (2.0 * label.abs() as f64 - 1.0) / n * label.signum() as f64;
                let (start, end) = self.spans[b];
                [(start, theta, label), (end, theta, label)]
            })
            .collect()
    }
}
