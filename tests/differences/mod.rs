//! Exact derivatives of a residual against coloured central differences.

use slcbeam::dae::{BeamDae, Dae, Seeds};
use slcbeam::sparse::{Lu, Pattern, colour};

use crate::chance::Random;

/// Largest difference between exact and differenced entries, relative to the largest entry of the same row and column.
pub fn worst_difference(dae: &mut BeamDae, seed: u64, size: f64) -> f64 {
    let n = dae.len();
    let mut random = Random(seed);
    // Neighbouring nodes may move against each other by a fifth of a cell: beyond that a cell folds over.
    let (layout, h) = (&dae.system().layout, dae.system().mesh.shortest);
    let displacements = layout.lines[0].u.start..layout.lines[1].u.end;
    let reach = |i: usize| {
        if displacements.contains(&i) {
            (0.2 * h / layout.scales[i]).min(1.0)
        } else {
            1.0
        }
    };
    let y: Vec<f64> = (0..n).map(|i| size * reach(i) * random.between(-1.0, 1.0)).collect();
    let yp: Vec<f64> = (0..n).map(|_| size * random.between(-1.0, 1.0)).collect();
    let (t, cj) = (0.013, 37.0);
    let pattern = dae.pattern().clone();
    let mut exact = vec![0.0; pattern.entries()];
    dae.jacobian(t, &y, &yp, Seeds::Step { cj }, &mut exact).unwrap();
    factors_hold(&pattern, &exact);
    let (colour, count) = colour::colours(&pattern);
    // Fourth-order differences: the step balances round-off 1e-16/h against h^4 over the kink's width.
    let mut differenced = vec![0.0; pattern.entries()];
    let mut residual = vec![vec![0.0; n]; 4];
    for c in 0..count {
        let step = 6e-5;
        for (r, k) in residual.iter_mut().zip([-2.0, -1.0, 1.0, 2.0]) {
            let shifted = |v: &[f64], factor: f64| -> Vec<f64> {
                v.iter()
                    .zip(&colour)
                    .map(|(x, &of)| if of == c { x + k * step * factor } else { *x })
                    .collect()
            };
            dae.residual(t, &shifted(&y, 1.0), &shifted(&yp, cj), r).unwrap();
        }
        for j in (0..n).filter(|&j| colour[j] == c) {
            for entry in pattern.column(j) {
                let i = pattern.rows[entry] as usize;
                differenced[entry] =
                    (residual[0][i] - 8.0 * residual[1][i] + 8.0 * residual[2][i] - residual[3][i]) / (12.0 * step);
            }
        }
    }
    let mut row_size = vec![0.0_f64; n];
    for j in 0..n {
        for entry in pattern.column(j) {
            let i = pattern.rows[entry] as usize;
            row_size[i] = row_size[i].max(exact[entry].abs());
        }
    }
    let mut worst = 0.0_f64;
    for j in 0..n {
        for entry in pattern.column(j) {
            let i = pattern.rows[entry] as usize;
            worst = worst.max((exact[entry] - differenced[entry]).abs() / row_size[i]);
        }
    }
    worst
}

/// Factors of a Jacobian, where there are any: a solution has a small backward error, whichever way it was found.
fn factors_hold(pattern: &Pattern, values: &[f64]) {
    let n = pattern.columns();
    let mut lu = Lu::new(pattern).unwrap();
    if lu.factor(values).is_err() {
        return;
    }
    let b: Vec<f64> = (0..n).map(|k| (1.3 * k as f64).cos()).collect();
    let mut x = b.clone();
    assert!(lu.solve(&mut x));
    let (mut left, mut size) = (b.clone(), b.iter().map(|b| b.abs()).collect::<Vec<_>>());
    for (j, x) in x.iter().enumerate() {
        for entry in pattern.column(j) {
            let i = pattern.rows[entry] as usize;
            left[i] -= values[entry] * x;
            size[i] += (values[entry] * x).abs();
        }
    }
    let worst = left
        .iter()
        .zip(&size)
        .map(|(left, size)| left.abs() / size)
        .fold(0.0, f64::max);
    assert!(
        worst < 1e-6,
        "backward error {worst:.1e}, in blocks: {}",
        lu.in_blocks()
    );
}
