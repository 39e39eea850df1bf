//! Eigenvalues of sparse pencils.
//!
//! Sources: second differences with fixed ends, `4 sin²(kπ/2(n + 1))`; the pencils of shipped cases. Goal: dense and sparse methods agree,
//! every copy of a repeated eigenvalue is found, and each error is within its bound.

use std::f64::consts::PI;

use nalgebra::Complex;
use slcbeam::run::modes::linearise;
use slcbeam::sparse::Pattern;
use slcbeam::spectral::{self, EigenvalueOptions, Eigenvalues, Pencil, SpectralError};
use slcbeam_dense::eigen;

use crate::common::{chains, checked};

/// `copies` times the second differences of n points, as diagonal blocks, and their exact eigenvalues, ascending.
fn differences(n: usize, copies: usize) -> (Pattern, Vec<f64>, Vec<f64>) {
    let near = |j: usize| {
        let first = j / n * n;
        (j.saturating_sub(1).max(first)..(j + 2).min(first + n)).collect::<Vec<_>>()
    };
    let pattern = Pattern::from_columns(&(0..n * copies).map(near).collect::<Vec<_>>());
    let mut values = vec![];
    for j in 0..n * copies {
        let rows = &pattern.rows[pattern.column(j)];
        values.extend(rows.iter().map(|&i| if i as usize == j { 2.0 } else { -1.0 }));
    }
    let exact = |k: usize| 4.0 * (k as f64 * PI / (2.0 * (n + 1) as f64)).sin().powi(2);
    let mut all: Vec<f64> = (1..=n).flat_map(|k| vec![exact(k); copies]).collect();
    all.sort_by(f64::total_cmp);
    (pattern, values, all)
}

#[test]
fn errors_are_within_their_bounds() {
    // three copies: a Krylov space from one vector contains only one
    let (pattern, k, exact) = differences(300, 3);
    let on_diagonal = |j: usize| {
        pattern.rows[pattern.column(j)]
            .iter()
            .map(move |&i| if i as usize == j { -1.0 } else { 0.0 })
    };
    let b: Vec<f64> = (0..900).flat_map(on_diagonal).collect();
    let pencil = Pencil {
        pattern: &pattern,
        a: &k,
        b: &b,
    };
    let found = spectral::nearest(&pencil, Complex::new(0.0, 0.0), 20, &EigenvalueOptions::default()).unwrap();
    assert!(!found.dense && found.restarts > 0);
    let mut computed: Vec<f64> = found.pairs.iter().map(|p| p.s.re).collect();
    computed.sort_by(f64::total_cmp);
    for (pair, (s, exact)) in found.pairs.iter().zip(computed.iter().zip(&exact)) {
        assert!((s - exact).abs() <= pair.error, "{s:e} {exact:e} {:e}", pair.error);
        // the bound is no larger than the rounding error of a row over the smallest eigenvalue
        assert!(pair.error < 1e-14 && pair.s.im.abs() <= pair.error);
        assert!(pair.residual < 1e-14, "{:e}", pair.residual);
    }
}

#[test]
fn a_negative_eigenvalue_tells_an_unstable_tangent() {
    let (pattern, mut k, exact) = differences(300, 1);
    // between the second and the third eigenvalue: two directions are unstable
    let by = 0.5 * (exact[1] + exact[2]);
    for j in 0..300 {
        let entry = pattern.column(j).find(|&e| pattern.rows[e] as usize == j).unwrap();
        k[entry] -= by;
    }
    let found = spectral::lowest(&pattern, &k, &[1.0; 300]).unwrap();
    assert_eq!(found.iter().filter(|mu| mu.re < 0.0).count(), 2);
    // The residual of an accepted pair is below 1e-4; the error of a symmetric one is its square.
    let least = found.iter().map(|mu| mu.re).fold(f64::INFINITY, f64::min);
    assert!((least / (exact[0] - by) - 1.0).abs() < 1e-8);
}

/// Goal: forty cyclic permutations of three axes have each cube root of 1 forty times. Copies do not make an iteration loop forever.
/// Tolerance: rounding of a hundred rotations.
#[test]
fn copies_come_at_once() {
    let turn = |i: usize, j: usize| i / 3 == j / 3 && i % 3 == (j + 1) % 3;
    let found = eigen(120, &|i, j| f64::from(u8::from(turn(i, j))).into()).unwrap();
    assert_eq!(found.len(), 120);
    for (s, x) in &found {
        assert!((s * s * s - 1.0).norm() < 1e-13, "{s}");
        for block in x.chunks(3) {
            // axis i maps to axis i + 1
            let left = (0..3)
                .map(|i| (block[(i + 2) % 3] - s * block[i]).norm())
                .fold(0.0, f64::max);
            assert!(left < 1e-13, "{left:e}");
        }
    }
}

/// Largest distance from an eigenvalue of one set to the nearest of the other.
fn apart(a: &Eigenvalues, b: &Eigenvalues) -> f64 {
    let nearest = |s: Complex<f64>| b.pairs.iter().map(|p| (p.s - s).norm()).fold(f64::INFINITY, f64::min);
    a.pairs.iter().map(|p| nearest(p.s)).fold(0.0, f64::max)
}

#[test]
fn dense_and_sparse_agree() {
    // two equal chains: volumes, and decay rates independent of bending, occur twice
    let case = checked(&chains(10, 8.68e-4, 5e-6));
    let about = linearise(&case, 0.0, None).unwrap();
    let pencil = about.pencil();
    for shift in [Complex::new(2.0, 0.0), Complex::new(0.0, 480.0)] {
        let options = |dense_up_to| EigenvalueOptions {
            dense_up_to,
            ..EigenvalueOptions::default()
        };
        let dense = spectral::nearest(&pencil, shift, 24, &options(1000)).unwrap();
        let sparse = spectral::nearest(&pencil, shift, 24, &options(0)).unwrap();
        assert!(dense.dense && !sparse.dense);
        assert_eq!((dense.pairs.len(), sparse.pairs.len()), (24, 24));
        // the last one may be one of two conjugates, or of two copies, at the same distance
        for (a, b) in dense.pairs.iter().zip(&sparse.pairs) {
            let (da, db) = ((a.s - shift).norm(), (b.s - shift).norm());
            assert!((da - db).abs() <= 2.0 * (a.error + b.error) + 1e-12 * da, "{da} {db}");
        }
        let largest = dense.pairs.iter().map(|p| p.error).fold(0.0, f64::max);
        let conjugate = |found: &Eigenvalues| {
            let mut all = found.clone();
            all.pairs.iter_mut().for_each(|p| p.s.im = p.s.im.abs());
            all
        };
        let (dense, sparse) = (conjugate(&dense), conjugate(&sparse));
        assert!(apart(&dense, &sparse) <= 1e-9 + 2.0 * largest);
        assert!(apart(&sparse, &dense) <= 1e-9 + 2.0 * largest);
    }
}

/// Source: oscillators `x'' - 2 g x' + w² x = 0`, each with an algebraic copy of x: eigenvalues `g ± i √(w² - g²)`. Goal: the growing
/// oscillations within the bounds, fastest growth first, and no others. Tolerance: the bounds of their errors.
#[test]
fn growing_oscillations_within_bounds() {
    let oscillators: Vec<[f64; 2]> = (1..=30_i32)
        .map(|k| [0.1 * f64::from(k * (1 - 2 * (k % 2))), 10.0 * f64::from(k)])
        .collect();
    let columns = |k: usize| {
        [
            vec![3 * k, 3 * k + 1, 3 * k + 2],
            vec![3 * k, 3 * k + 1],
            vec![3 * k + 2],
        ]
    };
    let pattern = Pattern::from_columns(&(0..oscillators.len()).flat_map(columns).collect::<Vec<_>>());
    let a: Vec<f64> = oscillators
        .iter()
        .flat_map(|[g, w]| [0.0, w * w, -1.0, -1.0, -2.0 * g, 1.0])
        .collect();
    let b = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0].repeat(oscillators.len());
    let pencil = Pencil {
        pattern: &pattern,
        a: &a,
        b: &b,
    };
    let bounds = spectral::Bounds {
        rate: 0.5,
        frequency: 100.0,
        count: 8,
    };
    let found = spectral::growing(&pencil, 3.0, &bounds).unwrap().unwrap();
    let within = oscillators
        .iter()
        .rev()
        .filter(|[g, w]| *g >= 0.5 && w * w - g * g >= 1e4);
    let expected: Vec<_> = within
        .take(8)
        .map(|[g, w]| Complex::new(*g, (w * w - g * g).sqrt()))
        .collect();
    assert_eq!(found.len(), 8);
    for (pair, exact) in found.iter().zip(&expected) {
        assert!(
            (pair.s - exact).norm() <= pair.error + 1e-12 * exact.norm(),
            "{:?} {exact}",
            pair.s
        );
    }
    let beyond = spectral::Bounds { rate: 3.1, ..bounds };
    assert_eq!(spectral::growing(&pencil, 3.0, &beyond).unwrap().unwrap(), []);
}

#[test]
fn all_finite_eigenvalues_and_no_other() {
    let case = checked(&chains(2, 8.68e-4, 5e-6));
    let about = linearise(&case, 0.0, None).unwrap();
    let found = spectral::nearest(
        &about.pencil(),
        Complex::new(2.0, 0.0),
        1000,
        &EigenvalueOptions::default(),
    )
    .unwrap();
    // u1, u3, v1, v3 of 8 free nodes and 4 areas; means are algebraic
    assert_eq!((found.pairs.len(), found.finite), (36, 36));
    assert!(found.pairs.iter().all(|p| p.residual < 1e-12));
}

#[test]
fn a_singular_pencil_is_told() {
    // two columns that are equal in A and absent in B
    let pattern = Pattern::from_columns(&[vec![0, 1], vec![0, 1]]);
    let pencil = Pencil {
        pattern: &pattern,
        a: &[1.0, 1.0, 1.0, 1.0],
        b: &[0.0; 4],
    };
    let one = Complex::new(1.0, 0.0);
    let failed = spectral::nearest(&pencil, one, 1, &EigenvalueOptions::default());
    assert!(matches!(failed, Err(SpectralError::Singular { .. })), "{failed:?}");
    let pencil = Pencil {
        a: &[f64::NAN, 1.0, 1.0, 1.0],
        ..pencil
    };
    let failed = spectral::nearest(&pencil, one, 1, &EigenvalueOptions::default());
    assert!(matches!(failed, Err(SpectralError::NotFinite)), "{failed:?}");
}
