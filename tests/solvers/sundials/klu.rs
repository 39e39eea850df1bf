//! Factorization by KLU, and the guard of its pivots.

use slcbeam::sparse::Pattern;
use slcbeam::sparse::{Klu, KluError};

use super::chance::Random;

/// Dense pattern of a 2 by 2 matrix.
fn small() -> Pattern {
    Pattern::from_columns(&[vec![0, 1], vec![0, 1]])
}

/// Good pivots of one matrix may be useless for the next.
///
/// Source: found with SUNDIALS' own KLU interface. Goal: without the guard x = (0, 2) and no complaint;
/// with it x = (1, 2) and one refresh counted. Tolerance: rounding of a well-conditioned 2 by 2.
#[test]
fn guard_sees_stale_pivots() {
    // columns of [1 1; 1 2] and of [1e-16 1; 1 2]; the right-hand side of x = (1, 2)
    let (first, second) = ([1.0, 1.0, 1.0, 2.0], [1e-16, 1.0, 1.0, 2.0]);
    for guarded in [true, false] {
        let mut klu = Klu::new(&small()).unwrap();
        if !guarded {
            klu.smallest_growth = 0.0;
        }
        klu.factor(&first).unwrap();
        klu.factor(&second).unwrap();
        let mut x = [2.0, 5.0];
        assert!(klu.solve(&mut x));
        if guarded {
            assert!((x[0] - 1.0).abs() < 1e-14 && (x[1] - 2.0).abs() < 1e-14, "{x:?}");
            assert_eq!((klu.factorizations, klu.pivot_refreshes), (3, 1));
        } else {
            assert_eq!(x, [0.0, 2.0]);
            assert_eq!((klu.factorizations, klu.pivot_refreshes), (2, 0));
        }
    }
}

/// Goal: an isolated row that becomes zero is detected by the guard; pivot growth misses it.
#[test]
fn a_block_of_one_row_that_vanishes_is_singular() {
    let mut klu = Klu::new(&Pattern::from_columns(&[vec![0], vec![1]])).unwrap();
    klu.factor(&[1.0, 2.0]).unwrap();
    assert_eq!(klu.factor(&[1.0, 0.0]), Err(KluError::Singular { column: 1 }));
    klu.factor(&[1.0, 2.0]).unwrap();
}

/// A singular matrix names its column, before and after regular ones; the next regular one is factored again.
///
/// Goal: numbers and structure that are singular; recovery. Tolerance: exact small numbers.
#[test]
fn singular_matrices_name_a_column_and_are_survived() {
    let mut klu = Klu::new(&small()).unwrap();
    assert_eq!(klu.factor(&[1.0, 1.0, 0.0, 0.0]), Err(KluError::Singular { column: 1 }));
    assert!(!klu.solve(&mut [1.0, 1.0]));
    klu.factor(&[1.0, 0.0, 0.0, 2.0]).unwrap();
    assert!(matches!(
        klu.factor(&[0.0, 0.0, 1.0, 1.0]),
        Err(KluError::Singular { .. })
    ));
    klu.factor(&[1.0, 0.0, 0.0, 2.0]).unwrap();
    let mut x = [3.0, 8.0];
    assert!(klu.solve(&mut x));
    assert_eq!(x, [3.0, 4.0]);
    let empty_column = Pattern::from_columns(&[vec![0, 1], vec![]]);
    let fault = Klu::new(&empty_column).and_then(|mut klu| klu.factor(&[1.0, 1.0]));
    assert_eq!(fault, Err(KluError::Singular { column: 1 }));
}

/// Goal: rows twelve decades apart are solved to rounding. Tolerance: rounding times ten.
#[test]
fn badly_scaled_rows_are_solved() {
    let mut klu = Klu::new(&small()).unwrap();
    klu.factor(&[1e-6, 2e6, 3e-6, -1e6]).unwrap();
    let mut x = [1e-6 * 1.0 + 3e-6 * 2.0, 2e6 * 1.0 - 1e6 * 2.0];
    assert!(klu.solve(&mut x));
    assert!((x[0] - 1.0).abs() < 3e-15 && (x[1] - 2.0).abs() < 3e-15, "{x:?}");
}

/// Goal: a solution by rows equals KLU's own: with many blocks and entries above them, with one block, with fresh factors or old pivots.
///
/// Goal: solve and solve_block agree, and recover the known solution. Tolerance: rounding of dominant diagonals.
#[test]
fn rows_solve_as_klu_does() {
    let mut chance = Random(7);
    let mut blocks = [0, 0];
    for trial in 0..60 {
        let n = 1 + chance.below(30);
        // with entries only above the diagonal, every unknown is a block; a few entries below join some
        let below = trial % 3 * n / 2;
        let mut columns: Vec<Vec<usize>> = (0..n).map(|j| vec![j]).collect();
        for k in 0..3 * n + below {
            let (a, b) = (chance.below(n), chance.below(n));
            columns[if k < 3 * n { a.max(b) } else { a.min(b) }].push(if k < 3 * n { a.min(b) } else { a.max(b) });
        }
        let pattern = Pattern::from_columns(&columns);
        let mut klu = Klu::new(&pattern).unwrap();
        blocks[usize::from(below > 0)] += 1;
        for _ in 0..3 {
            let mut values = vec![0.0; pattern.entries()];
            let x: Vec<f64> = (0..n).map(|_| chance.between(-1.0, 1.0)).collect();
            let mut b = vec![0.0; n];
            for (j, x) in x.iter().enumerate() {
                for p in pattern.column(j) {
                    let row = pattern.rows[p] as usize;
                    values[p] = if row == j {
                        8.0 * n as f64
                    } else {
                        chance.between(-1.0, 1.0)
                    };
                    b[row] += values[p] * x;
                }
            }
            klu.factor(&values).unwrap();
            let mut own = b.clone();
            assert!(klu.solve(&mut own) && klu.solve_block(&mut b));
            for k in 0..n {
                assert!(
                    (own[k] - x[k]).abs() < 1e-14 && (b[k] - x[k]).abs() < 1e-14,
                    "{trial} {k}: {own:?} {b:?}"
                );
            }
        }
        assert_eq!(klu.pivot_refreshes, 0);
    }
    assert!(blocks.iter().all(|count| *count > 10), "{blocks:?}");
}
