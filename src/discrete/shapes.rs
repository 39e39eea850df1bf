//! Functions of place on a mesh, by their exact integrals.

use crate::case::profile::{Integrals, Profile};

/// `∫ f hat_i / ∫ hat_i` at every node: total and first moment are those of `f`.
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
    let integrals = Integrals::of(profile);
    (0..cells).map(|c| within(c, cells)).map(|(a, b)| integrals.mean(a, b)).collect()
}

/// Values at nodes of the function, straight within each cell, that is nearest to `f` in the mean square:
///
/// ```text
/// (v_{i-1} + 4 v_i + v_{i+1})/6 = ∫ f hat_i / ∫ hat_i        (2 v_0 + v_1)/3 = ∫ f hat_0 / ∫ hat_0, likewise at the other end
/// ```
///
/// A velocity on the mesh is such a function. Its total is that of `f`, straight lines (the motions of a rigid beam) stay
/// what they are, and at the ends it is of second order, which the means [`at_nodes`] are not.
pub fn nearest(profile: &Profile, cells: usize) -> Vec<f64> {
    if let Some(value) = profile.uniform() {
        return vec![value; cells + 1];
    }
    let mut values = at_nodes(profile, cells);
    // Thomas' algorithm; rows are diagonally dominant.
    let (inner, outer) = ((1.0 / 6.0, 4.0 / 6.0), (1.0 / 3.0, 2.0 / 3.0));
    let mut above = vec![0.0; cells + 1];
    for i in 0..=cells {
        let (beside, middle) = if i == 0 || i == cells { outer } else { inner };
        let (before, coupled) = if i == 0 { (0.0, 0.0) } else { (values[i - 1], above[i - 1]) };
        let pivot = middle - beside * coupled;
        values[i] = (values[i] - beside * before) / pivot;
        above[i] = beside / pivot;
    }
    for i in (0..cells).rev() {
        values[i] -= above[i] * values[i + 1];
    }
    values
}

/// Where a cell lies, as a share of the length.
pub fn within(cell: usize, cells: usize) -> (f64, f64) {
    (cell as f64 / cells as f64, (cell + 1) as f64 / cells as f64)
}

/// `∫ f hat_i dx` over [0, 1].
fn against_hats(profile: &Profile, cells: usize) -> Vec<f64> {
    let integrals = Integrals::of(profile);
    let mut values = vec![0.0; cells + 1];
    for c in 0..cells {
        let (a, b) = within(c, cells);
        let (left, right) = integrals.hats(a, b);
        values[c] += left;
        values[c + 1] += right;
    }
    values
}
