//! Factors and their guard.

use slcbeam::sparse::Pattern;
use slcbeam::sparse::{Klu, KluError, RowScaling};

/// Dense 2 by 2.
fn small() -> Pattern {
    Pattern::from_columns(&[vec![0, 1], vec![0, 1]])
}

/// Pivots that were good for one matrix are useless for the next.
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

/// A row that stands alone becomes zero: growth of pivots does not see it, the guard does.
#[test]
fn a_block_of_one_row_that_vanishes_is_singular() {
    let mut klu = Klu::new(&Pattern::from_columns(&[vec![0], vec![1]])).unwrap();
    klu.factor(&[1.0, 2.0]).unwrap();
    assert_eq!(klu.factor(&[1.0, 0.0]), Err(KluError::Singular { column: 1 }));
    klu.factor(&[1.0, 2.0]).unwrap();
}

/// A singular matrix names its column, before and after good ones, and the next good one is factored again.
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

/// Row scaling: rows twelve decades apart are solved to rounding, and the condition estimate is the scaled one or larger.
///
/// Goal: all three scalings solve; estimates bracket the condition number. Tolerance: rounding times ten.
#[test]
fn all_scalings_solve_badly_scaled_rows() {
    for scaling in [RowScaling::None, RowScaling::Sum, RowScaling::Max] {
        let mut klu = Klu::with_scaling(&small(), scaling).unwrap();
        let values = [1e-6, 2e6, 3e-6, -1e6];
        klu.factor(&values).unwrap();
        let mut x = [1e-6 * 1.0 + 3e-6 * 2.0, 2e6 * 1.0 - 1e6 * 2.0];
        assert!(klu.solve(&mut x));
        assert!(
            (x[0] - 1.0).abs() < 3e-15 && (x[1] - 2.0).abs() < 3e-15,
            "{scaling:?} {x:?}"
        );
        assert!(klu.condition(&values).unwrap() >= 1.0);
    }
}
