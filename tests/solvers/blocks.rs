//! Factorization in dense blocks along a line.

use nalgebra::Complex;
use slcbeam::sparse::complex::ComplexLu;
use slcbeam::sparse::{BlockTridiagonal, KluError, Lu, Pattern};

use super::sundials::chance::Random;

/// A matrix by columns: pattern and values.
struct Matrix {
    pattern: Pattern,
    values: Vec<f64>,
}

impl Matrix {
    /// From entries (row, column, value) without duplicates.
    fn new(n: usize, entries: &[(usize, usize, f64)]) -> Self {
        let mut columns = vec![vec![]; n];
        entries.iter().for_each(|(row, column, _)| columns[*column].push(*row));
        let pattern = Pattern::from_columns(&columns);
        let mut values = vec![0.0; pattern.entries()];
        for (row, column, value) in entries {
            let own = pattern.column(*column);
            let entry = own.start + pattern.rows[own].iter().position(|r| *r as usize == *row).unwrap();
            values[entry] = *value;
        }
        Self { pattern, values }
    }

    fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut b = vec![0.0; x.len()];
        for (column, x) in x.iter().enumerate() {
            for entry in self.pattern.column(column) {
                b[self.pattern.rows[entry] as usize] += self.values[entry] * x;
            }
        }
        b
    }

    /// Largest error of a known solution.
    fn error(&self, mut solve: impl FnMut(&mut [f64])) -> f64 {
        let x: Vec<f64> = (0..self.pattern.columns()).map(|k| (1.7 * k as f64).sin()).collect();
        let mut b = self.times(&x);
        solve(&mut b);
        b.iter().zip(&x).map(|(b, x)| (b - x).abs()).fold(0.0, f64::max)
    }
}

/// Cells along a line, each with displacements `u`, velocities `v = u'` and a few more unknowns, coupled to `reach` cells on both sides; in
/// a ring the last is coupled to the first. Rows are diagonally dominant.
fn cells(count: usize, kinds: usize, reach: usize, ring: bool, cj: f64) -> Matrix {
    let mut random = Random(7 + count as u64);
    let mut entries = vec![];
    let n = count * (kinds + 1);
    for cell in 0..count {
        let own = cell * (kinds + 1);
        let (u, v) = (own, own + kinds);
        entries.push((u, u, cj));
        entries.push((u, v, -1.0));
        entries.push((v, v, 3.0 * cj));
        for shift in 0..=2 * reach {
            let other = cell as isize + shift as isize - reach as isize;
            let inside = (0..count as isize).contains(&other);
            if !inside && !ring {
                continue;
            }
            let other = other.rem_euclid(count as isize) as usize * (kinds + 1);
            for row in (1..kinds).map(|k| own + k).chain([v]) {
                for column in (0..kinds).map(|k| other + k) {
                    let diagonal = if row == column {
                        10.0 * (kinds * reach) as f64
                    } else {
                        0.0
                    };
                    entries.push((row, column, random.between(-1.0, 1.0) + diagonal));
                }
            }
        }
    }
    Matrix::new(n, &entries)
}

/// Chains and rings of several widths, in blocks and by the automatic choice.
///
/// Goal: solutions of known matrices, including all remainders of block sizes over the vector length. Tolerance: rounding times a condition
/// below 1e4.
#[test]
fn chains_and_rings_are_solved() {
    for kinds in 1..8 {
        for (count, reach, ring) in [
            (1, 1, false),
            (2, 1, false),
            (40, 1, false),
            (41, 2, false),
            (60, 1, true),
            (200, 3, false),
        ] {
            for cj in [1e-2, 1.0, 1e4] {
                let matrix = cells(count, kinds, reach, ring, cj);
                let mut blocks = BlockTridiagonal::new(&matrix.pattern, usize::MAX).unwrap();
                let what = format!("{count} cells of {kinds} kinds, reach {reach}, ring {ring}, cj {cj}");
                assert!(blocks.factor(&matrix.pattern, &matrix.values), "{what}");
                let error = matrix.error(|b| blocks.solve(b));
                assert!(error < 1e-10, "{what}: {error:.1e}");
                let mut lu = Lu::new(&matrix.pattern).unwrap();
                lu.factor(&matrix.values).unwrap();
                let error = matrix.error(|b| assert!(lu.solve(b)));
                assert!(error < 1e-10, "{what}, by choice: {error:.1e}");
            }
        }
    }
}

/// A line long enough for two threads.
///
/// Goal: the solution of a known matrix, twice the same. Tolerance: as above.
#[test]
fn a_long_line_is_solved_by_two_threads() {
    let matrix = cells(50_000, 3, 1, false, 1.0);
    let mut blocks = BlockTridiagonal::new(&matrix.pattern, usize::MAX).unwrap();
    assert!(blocks.factor(&matrix.pattern, &matrix.values));
    let error = matrix.error(|b| blocks.solve(b));
    assert!(error < 1e-10, "{error:.1e}");
    let mut solution = || {
        let mut b: Vec<f64> = (0..matrix.pattern.columns()).map(|k| (k as f64).cos()).collect();
        blocks.solve(&mut b);
        b
    };
    assert_eq!(solution(), solution());
}

/// Goal: factors do not depend on earlier factorizations, bit for bit.
#[test]
fn factors_have_no_past() {
    let (one, other) = (cells(50, 4, 1, false, 1.0), cells(50, 4, 1, false, 1e3));
    let mut blocks = BlockTridiagonal::new(&one.pattern, usize::MAX).unwrap();
    let mut solution = |values: &[f64]| {
        assert!(blocks.factor(&one.pattern, values));
        let mut b: Vec<f64> = (0..one.pattern.columns()).map(|k| (k as f64).cos()).collect();
        blocks.solve(&mut b);
        b
    };
    let first = solution(&one.values);
    solution(&other.values);
    assert_eq!(solution(&one.values), first);
}

/// Goal: long lines are cut into blocks; for random couplings, KLU's few entries are cheaper. A star needs neither: its center determines
/// its tips.
#[test]
fn the_cheaper_way_is_chosen() {
    let chosen = |matrix: &Matrix| {
        let mut lu = Lu::new(&matrix.pattern).unwrap();
        lu.factor(&matrix.values).unwrap();
        assert!(matrix.error(|b| assert!(lu.solve(b))) < 1e-9);
        lu.in_blocks()
    };
    assert!(chosen(&cells(40, 6, 1, false, 1.0)));
    let mut random = Random(3);
    let n = 400;
    let mut scattered: Vec<(usize, usize, f64)> = (0..n).map(|k| (k, k, 10.0)).collect();
    for k in 0..n {
        let others: std::collections::BTreeSet<usize> =
            (0..4).map(|_| random.below(n)).filter(|other| *other != k).collect();
        scattered.extend(others.into_iter().map(|other| (k, other, random.between(-1.0, 1.0))));
    }
    assert!(!chosen(&Matrix::new(n, &scattered)));
    let star = (1..n).flat_map(|k| {
        [
            (k, k, 10.0),
            (0, k, random.between(-0.01, 0.01)),
            (k, 0, random.between(-1.0, 1.0)),
        ]
    });
    assert!(chosen(&Matrix::new(
        n,
        &[(0, 0, 10.0)].into_iter().chain(star).collect::<Vec<_>>()
    )));
}

/// A singular block in a regular matrix would need pivots from other blocks, so KLU factors the matrix.
///
/// Goal: rejected, counted, solved. A singular matrix names a column, as KLU does. Tolerance: rounding.
#[test]
fn what_blocks_cannot_do_goes_to_klu() {
    let (count, kinds) = (30, 6);
    let sound = cells(count, kinds, 1, false, 1.0);
    let n = sound.pattern.columns();
    let mut lu = Lu::new(&sound.pattern).unwrap();
    lu.factor(&sound.values).unwrap();
    assert!(lu.in_blocks());
    // a row coupled only to the next cell is zero in its block if its cell is the last one
    let emptied = |row: usize, kept: std::ops::Range<usize>| {
        let mut values = sound.values.clone();
        for column in (0..n).filter(|column| !kept.contains(column)) {
            for entry in sound.pattern.column(column) {
                if sound.pattern.rows[entry] as usize == row {
                    values[entry] = 0.0;
                }
            }
        }
        values
    };
    let mut refused = 0;
    for cell in 0..count - 1 {
        let next = (cell + 1) * (kinds + 1);
        let values = emptied(next - 2, next..next + kinds);
        lu.forget();
        lu.factor(&values).unwrap();
        refused += u64::from(!lu.in_blocks());
        let matrix = Matrix {
            pattern: sound.pattern.clone(),
            values,
        };
        let error = matrix.error(|b| assert!(lu.solve(b)));
        assert!(error < 1e-9, "cell {cell}: {error:.1e}");
    }
    assert!(refused > 0, "no cell was the last of its block");
    assert!(lu.pivot_refreshes() >= refused);
    // after some failures blocks are no longer tried, until the state is reset
    let last = (0..count - 1).map(|cell| (cell + 1) * (kinds + 1));
    let refusing = last.map(|next| emptied(next - 2, next..next + kinds)).find(|values| {
        lu.forget();
        lu.factor(values).unwrap();
        !lu.in_blocks()
    });
    let before = lu.pivot_refreshes();
    (0..20).for_each(|_| lu.factor(refusing.as_ref().unwrap()).unwrap());
    assert!(lu.pivot_refreshes() - before < 5);
    lu.factor(&sound.values).unwrap();
    assert!(!lu.in_blocks());
    lu.forget();
    lu.factor(&sound.values).unwrap();
    assert!(lu.in_blocks());
    let fault = lu.factor(&emptied(5, 0..0));
    assert!(matches!(fault, Err(KluError::Singular { .. })), "{fault:?}");
    assert!(!lu.solve(&mut vec![1.0; n]), "no factors are left");
    lu.factor(&sound.values).unwrap();
    assert!(sound.error(|b| assert!(lu.solve(b))) < 1e-12);
}

/// A chain of cells as `A + s B` with two memory variables each, `m' = (q - m)/τ`, that act on the first unknown q of their cell.
fn remembering(count: usize, s: Complex<f64>) -> (Pattern, Vec<Complex<f64>>) {
    let kinds = 3;
    let chain = cells(count, kinds, 1, false, 1.0);
    let n = chain.pattern.columns();
    let memories = 2 * count;
    let mut entries: Vec<(usize, usize, Complex<f64>)> = vec![];
    for column in 0..n {
        for entry in chain.pattern.column(column) {
            let row = chain.pattern.rows[entry] as usize;
            entries.push((row, column, chain.values[entry] + s * 0.1 * chain.values[entry]));
        }
    }
    for memory in 0..memories {
        let (m, q) = (n + memory, memory / 2 * (kinds + 1) + 1);
        let tau = [0.5, 0.02][memory % 2];
        entries.extend([(m, m, 1.0 + s * tau), (m, q, (-1.0).into()), (q, m, 0.3.into())]);
    }
    let mut columns = vec![vec![]; n + memories];
    entries.iter().for_each(|(row, column, _)| columns[*column].push(*row));
    let pattern = Pattern::from_columns(&columns);
    let mut values = vec![Complex::default(); pattern.entries()];
    for (row, column, value) in entries {
        let own = pattern.column(column);
        let entry = own.start + pattern.rows[own].iter().position(|r| *r as usize == row).unwrap();
        values[entry] = value;
    }
    (pattern, values)
}

/// Complex matrices at several shifts by the same factors, one of them -1/τ, at which the memory has no pivot of its own.
///
/// Goal: known solutions of the matrix and of its adjoint. Tolerance: rounding times a condition below 1e4.
#[test]
fn complex_matrices_with_memory_are_solved() {
    let shifts = [
        Complex::new(0.0, 3.0),
        Complex::new(0.0, 200.0),
        Complex::new(-2.0, 0.0),
        Complex::new(1.0, -0.5),
    ];
    let (pattern, first) = remembering(40, shifts[0]);
    let mut lu = ComplexLu::new(&pattern, &first).unwrap();
    for s in shifts {
        let (_, values) = remembering(40, s);
        lu.factor(&values).unwrap();
        let x: Vec<_> = (0..pattern.columns())
            .map(|k| Complex::new((1.7 * k as f64).sin(), (0.6 * k as f64).cos()))
            .collect();
        let (mut b, mut adjoint) = (vec![Complex::default(); x.len()], vec![Complex::default(); x.len()]);
        for column in 0..x.len() {
            for entry in pattern.column(column) {
                let row = pattern.rows[entry] as usize;
                b[row] += values[entry] * x[column];
                adjoint[column] += values[entry].conj() * x[row];
            }
        }
        assert!(lu.solve(&mut b) && lu.solve_adjoint(&mut adjoint));
        for found in [b, adjoint] {
            let error = found.iter().zip(&x).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            assert!(error < 1e-10, "s = {s}: {error:e}");
        }
    }
    assert_eq!(lu.factorizations, shifts.len() as u64);
}
