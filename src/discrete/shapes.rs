//! Functions of the place along the beam on a mesh, by exact integrals.

use crate::functions::profile::{Integrals, Profile};

/// Cells along a beam, in units of its length.
#[derive(Clone, Debug)]
pub struct Cells {
    /// Places of the nodes, from 0 to 1.
    pub nodes: Vec<f64>,
    /// Lengths of the cells.
    pub lengths: Vec<f64>,
}

impl Cells {
    /// Cells of equal length.
    pub fn equal(count: usize) -> Self {
        Self {
            nodes: (0..=count).map(|node| node as f64 / count as f64).collect(),
            lengths: vec![1.0 / count as f64; count],
        }
    }

    /// Ends of each cell.
    pub fn ends(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.nodes.windows(2).map(|pair| (pair[0], pair[1]))
    }

    /// Length of each node, half of the cells beside it, in units of the first cell.
    fn node_lengths(&self) -> Vec<f64> {
        let cell = |c: usize| self.lengths.get(c).map_or(0.0, |length| length / self.lengths[0]);
        let node = |i: usize| 0.5 * (i.checked_sub(1).map_or(0.0, cell) + cell(i));
        (0..self.nodes.len()).map(node).collect()
    }
}

/// `∫ f hat_i / ∫ hat_i` at every node; total and first moment equal those of `f`.
pub fn at_nodes(profile: &Profile, cells: &Cells) -> Vec<f64> {
    if let Some(value) = profile.uniform() {
        return vec![value; cells.nodes.len()];
    }
    let mut values = against_hats(profile, cells);
    let lengths = cells.node_lengths().into_iter().map(|length| length * cells.lengths[0]);
    values
        .iter_mut()
        .zip(lengths)
        .for_each(|(value, length)| *value /= length);
    values
}

/// Mean of every cell.
pub fn in_cells(profile: &Profile, cells: &Cells) -> Vec<f64> {
    let integrals = Integrals::new(profile);
    cells.ends().map(|(a, b)| integrals.mean(a, b)).collect()
}

/// Nodal velocities of the motion, linear within each cell, that is nearest to `f` in the mean square,
///
/// ```text
/// Σ_c h_c (2 v_i + v_j)/6 = h_i m_i        c the cells beside node i, j their other nodes        m: the means of [`at_nodes`]
/// h_i v_i = h_i m_i + Σ_j f_ij        f_ij = h_c (v_i - v_j)/6 with its neighbours
/// ```
///
/// limited to the range of `f` in the cells beside the node. Where the limit is exceeded, part of the flux f_ij is omitted (Zalesak, J.
/// Comput. Phys. 31, 1979). The total always equals that of `f`. Linear functions, the motions of a rigid beam, are exact. The ends are
/// second order, unlike those of the means. Jumps do not overshoot.
pub fn nearest(profile: &Profile, cells: &Cells) -> Vec<f64> {
    let count = cells.lengths.len();
    if let Some(value) = profile.uniform() {
        return vec![value; count + 1];
    }
    let means = at_nodes(profile, cells);
    let ratios: Vec<f64> = cells.lengths.iter().map(|length| length / cells.lengths[0]).collect();
    let lengths = cells.node_lengths();
    let high = nearest_lines(&means, &ratios, &lengths);
    let ranges = ranges(profile, cells);
    // Flux into the left node of each cell and out of its right one, in units of the first cell.
    let fluxes: Vec<f64> = high
        .windows(2)
        .zip(&ratios)
        .map(|(v, h)| h * (v[0] - v[1]) / 6.0)
        .collect();
    let gains = |i: usize| {
        let beside = [(i > 0).then(|| -fluxes[i - 1]), (i < count).then(|| fluxes[i])];
        let sum = |sign: f64| beside.iter().flatten().map(|f| (sign * f).max(0.0)).sum::<f64>();
        (sum(1.0), sum(-1.0))
    };
    // Admissible fraction of the fluxes into and out of each node.
    let shares: Vec<(f64, f64)> = (0..=count)
        .map(|i| {
            let (lowest, highest) = ranges[i];
            let (up, down) = gains(i);
            let share = |room: f64, asked: f64| {
                if asked > room.max(0.0) {
                    room.max(0.0) / asked
                } else {
                    1.0
                }
            };
            (
                share(lengths[i] * (highest - means[i]), up),
                share(lengths[i] * (means[i] - lowest), down),
            )
        })
        .collect();
    let mut values = means;
    for (c, flux) in fluxes.iter().enumerate() {
        let (left, right) = (shares[c], shares[c + 1]);
        let share = if *flux > 0.0 {
            left.0.min(right.1)
        } else {
            left.1.min(right.0)
        };
        values[c] += share * flux / lengths[c];
        values[c + 1] -= share * flux / lengths[c + 1];
    }
    values
}

/// Solves the first equation of [`nearest`] by Thomas' algorithm; rows are diagonally dominant.
fn nearest_lines(means: &[f64], cells: &[f64], nodes: &[f64]) -> Vec<f64> {
    let mut values = means.to_vec();
    let last = values.len() - 1;
    let mut above = vec![0.0; last + 1];
    for i in 0..=last {
        let beside = |cell: Option<&f64>| cell.map_or(0.0, |length| length / (6.0 * nodes[i]));
        let [left, right] = [i.checked_sub(1).and_then(|c| cells.get(c)), cells.get(i)].map(beside);
        let middle = 2.0 * (left + right);
        let (before, coupled) = if i == 0 {
            (0.0, 0.0)
        } else {
            (values[i - 1], above[i - 1])
        };
        let pivot = middle - left * coupled;
        values[i] = (values[i] - left * before) / pivot;
        above[i] = right / pivot;
    }
    for i in (0..last).rev() {
        values[i] -= above[i] * values[i + 1];
    }
    values
}

/// Smallest and largest value in the cells beside each node, at the sampled places.
fn ranges(profile: &Profile, cells: &Cells) -> Vec<(f64, f64)> {
    let integrals = Integrals::new(profile);
    let of_cells: Vec<(f64, f64)> = cells
        .ends()
        .map(|(a, b)| {
            let places = places(&integrals, a, b).into_iter().chain([a, b]);
            places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                let value = profile.value(x);
                (low.min(value), high.max(value))
            })
        })
        .collect();
    (0..=of_cells.len())
        .map(|i| {
            let (left, right) = (of_cells[i.saturating_sub(1)], of_cells[i.min(of_cells.len() - 1)]);
            (left.0.min(right.0), left.1.max(right.1))
        })
        .collect()
}

/// Sampling places of a profile inside a cell: every knot, and a number of others sufficient for its shortest waves. Multiples of the
/// golden ratio are not in phase with any wave.
pub fn places(integrals: &Integrals, a: f64, b: f64) -> Vec<f64> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let many = (8.0 * (integrals.half_waves(b - a) + 1.0)).min(256.0) as usize;
    let between = (0..many).map(|k| a + (b - a) * (0.5 + k as f64 * GOLDEN).fract());
    between.chain(integrals.knots_in(a, b).iter().copied()).collect()
}

/// `∫ f hat_i dx` over [0, 1].
fn against_hats(profile: &Profile, cells: &Cells) -> Vec<f64> {
    let integrals = Integrals::new(profile);
    let mut values = vec![0.0; cells.nodes.len()];
    for (c, (a, b)) in cells.ends().enumerate() {
        let (left, right) = integrals.hats(a, b);
        values[c] += left;
        values[c + 1] += right;
    }
    values
}
