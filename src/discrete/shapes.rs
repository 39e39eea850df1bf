//! Functions of the place along the beam on a mesh, by exact integrals.

use crate::functions::profile::{Integrals, Profile};

/// `∫ f hat_i / ∫ hat_i` at every node; total and first moment equal those of `f`.
pub fn at_nodes(profile: &Profile, cells: usize) -> Vec<f64> {
    if let Some(value) = profile.uniform() {
        return vec![value; cells + 1];
    }
    let share = 1.0 / cells as f64;
    let mut values = against_hats(profile, cells);
    values.iter_mut().for_each(|value| *value /= share);
    values[0] *= 2.0;
    values[cells] *= 2.0;
    values
}

/// Mean of every cell.
pub fn in_cells(profile: &Profile, cells: usize) -> Vec<f64> {
    let integrals = Integrals::new(profile);
    (0..cells)
        .map(|c| within(c, cells))
        .map(|(a, b)| integrals.mean(a, b))
        .collect()
}

/// Nodal velocities of the motion, linear within each cell, that is nearest to `f` in the mean square,
///
/// ```text
/// (v_{i-1} + 4 v_i + v_{i+1})/6 = m_i        (2 v_0 + v_1)/3 = m_0, likewise at the other end        m: the means of [`at_nodes`]
/// h_i v_i = h_i m_i + Σ_j f_ij        f_ij = h (v_i - v_j)/6 with its neighbours
/// ```
///
/// limited to the range of `f` in the cells beside the node. Where the limit is exceeded, part of the flux f_ij is omitted (Zalesak, J.
/// Comput. Phys. 31, 1979). The total always equals that of `f`. Linear functions, the motions of a rigid beam, are exact. The ends are
/// second order, unlike those of the means. Jumps do not overshoot.
pub fn nearest(profile: &Profile, cells: usize) -> Vec<f64> {
    if let Some(value) = profile.uniform() {
        return vec![value; cells + 1];
    }
    let means = at_nodes(profile, cells);
    let high = nearest_lines(&means);
    let ranges = ranges(profile, cells);
    let length = |i: usize| if i == 0 || i == cells { 0.5 } else { 1.0 };
    // Flux into the left node of each cell and out of its right one, in units of h.
    let fluxes: Vec<f64> = high.windows(2).map(|v| (v[0] - v[1]) / 6.0).collect();
    let gains = |i: usize| {
        let beside = [(i > 0).then(|| -fluxes[i - 1]), (i < cells).then(|| fluxes[i])];
        let sum = |sign: f64| beside.iter().flatten().map(|f| (sign * f).max(0.0)).sum::<f64>();
        (sum(1.0), sum(-1.0))
    };
    // Admissible fraction of the fluxes into and out of each node.
    let shares: Vec<(f64, f64)> = (0..=cells)
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
                share(length(i) * (highest - means[i]), up),
                share(length(i) * (means[i] - lowest), down),
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
        values[c] += share * flux / length(c);
        values[c + 1] -= share * flux / length(c + 1);
    }
    values
}

/// Solves `(v_{i-1} + 4 v_i + v_{i+1})/6 = m_i` by Thomas' algorithm; rows are diagonally dominant.
fn nearest_lines(means: &[f64]) -> Vec<f64> {
    let mut values = means.to_vec();
    let last = values.len() - 1;
    let mut above = vec![0.0; last + 1];
    for i in 0..=last {
        let (beside, middle) = if i == 0 || i == last {
            (1.0 / 3.0, 2.0 / 3.0)
        } else {
            (1.0 / 6.0, 4.0 / 6.0)
        };
        let (before, coupled) = if i == 0 {
            (0.0, 0.0)
        } else {
            (values[i - 1], above[i - 1])
        };
        let pivot = middle - beside * coupled;
        values[i] = (values[i] - beside * before) / pivot;
        above[i] = beside / pivot;
    }
    for i in (0..last).rev() {
        values[i] -= above[i] * values[i + 1];
    }
    values
}

/// Smallest and largest value in the cells beside each node, at the sampled places.
fn ranges(profile: &Profile, cells: usize) -> Vec<(f64, f64)> {
    let integrals = Integrals::new(profile);
    let of_cells: Vec<(f64, f64)> = (0..cells)
        .map(|c| {
            let (a, b) = within(c, cells);
            let places = places(&integrals, a, b).into_iter().chain([a, b]);
            places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                let value = profile.value(x);
                (low.min(value), high.max(value))
            })
        })
        .collect();
    (0..=cells)
        .map(|i| {
            let (left, right) = (of_cells[i.saturating_sub(1)], of_cells[i.min(cells - 1)]);
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

/// Range of a cell, as fractions of the length.
pub fn within(cell: usize, cells: usize) -> (f64, f64) {
    (cell as f64 / cells as f64, (cell + 1) as f64 / cells as f64)
}

/// `∫ f hat_i dx` over [0, 1].
fn against_hats(profile: &Profile, cells: usize) -> Vec<f64> {
    let integrals = Integrals::new(profile);
    let mut values = vec![0.0; cells + 1];
    for c in 0..cells {
        let (a, b) = within(c, cells);
        let (left, right) = integrals.hats(a, b);
        values[c] += left;
        values[c + 1] += right;
    }
    values
}
