//! Sobol's indices: the share of each number in the variance of a figure.
//!
//! ```text
//! S_i  = V(E(q | p_i)) / V        of p_i alone          (Saltelli et al., Comput. Phys. Commun. 181, 259, 2010)
//! ST_i = E(V(q | all but p_i)) / V    including interactions with others          (Jansen, 1999)
//! ```
//!
//! Estimated from samples A, B and A with the i-th number of B; their errors by bootstrap, which draws rows again.

use serde::{Deserialize, Serialize};

use crate::numerics::rng::Rng;

/// Number of bootstrap repetitions.
const AGAIN: usize = 200;
/// Least number of rows.
const FEWEST: usize = 8;

/// Shares of one number in the variance of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Index {
    /// Share of the number alone.
    pub first: f64,
    /// Standard error of `first`.
    pub first_error: f64,
    /// Share including interactions with other numbers.
    pub total: f64,
    /// Standard error of `total`.
    pub total_error: f64,
}

/// Returns the indices of each number. A row contains the figure at A, at B, and at A with each number of B in turn.
/// `None` for a figure that does not vary, or for too few rows.
pub fn indices(rows: &[Vec<f64>], inputs: usize, seed: u64) -> Option<Vec<Index>> {
    if rows.len() < FEWEST {
        return None;
    }
    let all: Vec<usize> = (0..rows.len()).collect();
    let found = estimate(rows, &all, inputs)?;
    let mut chance = Rng::new(seed, u64::MAX);
    let mut moments = vec![[[0.0; 2]; 2]; inputs];
    let mut times = 0.0;
    for _ in 0..AGAIN {
        let drawn: Vec<usize> = all
            .iter()
            .map(|_| (chance.share() * rows.len() as f64) as usize)
            .collect();
        let Some(again) = estimate(rows, &drawn, inputs) else {
            continue;
        };
        times += 1.0;
        for (moments, again) in moments.iter_mut().zip(again) {
            for (moments, x) in moments.iter_mut().zip(again) {
                moments[0] += x;
                moments[1] += x * x;
            }
        }
    }
    let error = |[sum, squares]: [f64; 2]| (squares / times - (sum / times).powi(2)).max(0.0).sqrt();
    let index = |([first, total], moments): ([f64; 2], [[f64; 2]; 2])| Index {
        first,
        first_error: error(moments[0]),
        total,
        total_error: error(moments[1]),
    };
    Some(found.into_iter().zip(moments).map(index).collect())
}

/// Estimates `S_i` and `ST_i` from some of the rows.
fn estimate(rows: &[Vec<f64>], which: &[usize], inputs: usize) -> Option<Vec<[f64; 2]>> {
    let n = which.len() as f64;
    let both = || which.iter().flat_map(|k| rows[*k][..2].iter().copied());
    let mean = both().sum::<f64>() / (2.0 * n);
    let variance = both().map(|q| (q - mean).powi(2)).sum::<f64>() / (2.0 * n);
    let size = both().map(f64::abs).fold(0.0, f64::max);
    if variance.sqrt() <= 1e-9 * size {
        return None;
    }
    let of = |i: usize| {
        let (mut first, mut total) = (0.0, 0.0);
        for k in which {
            let row = &rows[*k];
            // subtracting the mean does not change the estimate, but reduces its error
            first += (row[1] - mean) * (row[2 + i] - row[0]);
            total += (row[0] - row[2 + i]).powi(2);
        }
        [first / (n * variance), total / (2.0 * n * variance)]
    };
    Some((0..inputs).map(of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::sweep::vary::VariedNumber;
    use crate::study::uncertain::SamplePlan;
    use std::f64::consts::PI;

    /// Source: the function of Ishigami & Homma (1990) with 7 and 0.1: S = 0.3139, 0.4424, 0, ST = 0.5576, 0.4424, 0.2437, exact.
    #[test]
    fn indices_of_ishigami_are_exact_within_their_errors() {
        let inputs = (1..=3).map(|k| VariedNumber::parse(&format!("/x{k}=uniform:{}:{PI}", -PI)).expect("values"));
        let plan = SamplePlan::new(inputs.collect(), 4096, 3, true).expect("a plan");
        let q = |n: usize| {
            let x = plan.values(n);
            x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin()
        };
        let rows: Vec<Vec<f64>> = (0..4096)
            .map(|k| (0..5).map(|set| q(set * 4096 + k)).collect())
            .collect();
        let found = indices(&rows, 3, 1).expect("indices");
        let exact = [[0.3139, 0.5576], [0.4424, 0.4424], [0.0, 0.2437]];
        for (one, [first, total]) in found.iter().zip(exact) {
            assert!((one.first - first).abs() < 3.0 * one.first_error + 1e-3, "{one:?}");
            assert!((one.total - total).abs() < 3.0 * one.total_error + 1e-3, "{one:?}");
            assert!(one.first_error < 0.04 && one.total_error < 0.04, "{one:?}");
        }
    }

    #[test]
    fn what_does_not_vary_has_none() {
        assert!(indices(&vec![vec![2.0; 4]; 64], 2, 1).is_none());
        assert!(indices(&vec![vec![1.0, 2.0, 3.0]; 4], 1, 1).is_none());
    }
}
