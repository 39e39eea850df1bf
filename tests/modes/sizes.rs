//! Work of computing twelve modes of twenty thousand unknowns.

use slcbeam::run::modes::{self, TimeBehavior};

use crate::common::{chains, checked, plan};

/// Source: work of shift-invert Krylov methods. Goal: a handful of solutions per mode, independent of the size. One factorization for the
/// shift and two for the bound of each eigenvalue; a solution per Krylov vector, three for the bound.
#[test]
fn work_does_not_grow_with_the_unknowns() {
    let mut work = vec![];
    for cells in [4, 89] {
        let mut case = chains(100, 8.68e-4, 5e-6);
        case["mesh"]["cells_per_bladder"] = cells.into();
        let mut asked = plan(12);
        asked.limits = false;
        let found = modes::modes(&checked(&case), &asked).unwrap();
        let unknowns = found.about.y.len();
        let moving = found.modes.iter().filter(|m| !m.kind.stays()).count();
        assert_eq!(moving, 12);
        assert_eq!(found.modes.iter().filter(|m| m.kind == TimeBehavior::Volume).count(), 2);
        assert!(found.modes.iter().all(|m| m.residual < 1e-12));
        work.push((unknowns, found.factorizations, found.solves, found.modes));
    }
    assert!(
        work[0].0 < 3000 && (19_000..21_000).contains(&work[1].0),
        "{} {}",
        work[0].0,
        work[1].0
    );
    for (unknowns, factorizations, solves, _) in &work {
        // 28 eigenvalues with conjugates: 57 factorizations; 2 restarts of 76 vectors, and 3 solutions each for the bounds
        assert!(
            *factorizations < 70 && *solves < 400,
            "{unknowns}: {factorizations}, {solves}"
        );
    }
    // finer volumes change decay rates by their square, and bending hardly
    for (coarse, fine) in work[0].3.iter().zip(&work[1].3).filter(|p| p.0.kind.swings()) {
        assert!((coarse.s - fine.s).norm() < 1e-3 * fine.s.norm());
    }
}
