//! The mesh that a search begins with: it resolves everything that is given along the beam.

use crate::case::Case;
use crate::case::schema::Companion;
use crate::discrete::{BeamMesh, System, resolution};
use crate::error::Result;
use crate::study::accuracy::plan;
use crate::study::effects::full_model::full;

/// Cells a segment to begin with: where nothing asks for more, and at most. A quarter of them is a mesh too.
pub const LEAST: usize = 4;
const MOST: usize = 32;
/// Cells of the whole beam: two meshes of fewer may agree by chance about what neither has.
const LEAST_IN_ALL: usize = 8;
/// Cells a bladder to begin with.
const LEAST_IN_BLADDERS: usize = 2;
/// Tolerance to begin with.
const LOOSEST: f64 = 1e-3;

/// Fewest cells a segment, a power of two, that resolve every load and every shape at the start. What comes of them is right on
/// every mesh; what they do between nodes is not, and two meshes that both leave that out agree about it.
pub fn least_cells(case: &Case) -> Result<usize> {
    let coarse = plan::refined(case, LEAST, case.solver.rtol);
    let system = System::new(&coarse)?;
    let [along, in_bladders] = resolution::cells_that_resolve(&coarse, &system);
    let both = (1..=MOST).find(|cells| *cells >= along && plan::fluid_cells(*cells) >= in_bladders);
    let of_order = 4 * BeamMesh::fewest(case.mesh.order());
    let least = LEAST.max(LEAST_IN_ALL.max(of_order).div_ceil(system.mesh.segments));
    let cells = both.unwrap_or(MOST).next_power_of_two();
    Ok(cells.clamp(least.next_power_of_two(), MOST))
}

/// The case at the setting to begin with, of fourth order where it can be.
///
/// # Errors
/// As [`System::new`].
pub fn setting(case: &Case, asked: f64) -> Result<Case> {
    let coarse = |mut case: Case| {
        let [_, in_bladders] = resolution::cells_that_resolve(&case, &System::new(&case)?);
        case.mesh.cells_per_segment = least_cells(&case)?;
        case.mesh.cells_per_bladder = in_bladders.max(LEAST_IN_BLADDERS);
        case.solver.rtol = LOOSEST.min(0.1 * asked);
        case.companion = Companion::On;
        System::new(&case).map(|_| case)
    };
    let best = of_best_order(case.clone()).and_then(coarse);
    best.or_else(|_| coarse(case.clone()))
}

/// The case on meshes of fourth order, where it can be computed so with everything that it leaves to the program.
pub fn of_best_order(case: Case) -> Result<Case> {
    let fourth = plan::of_best_order(&case);
    let left_out = |case: &Case| Ok(full(case)?.map(|full| full.left_out));
    Ok(if fourth == case || left_out(&fourth)? == left_out(&case)? {
        fourth
    } else {
        case
    })
}
