//! Memory and time that a run needs, estimated from the case alone.

use crate::case::Case;

/// Memory of the program itself [byte].
const PROGRAM: f64 = 15e6;
/// Memory for each unknown of a dry beam: state, history of the integrator, pattern, Jacobian, factors [byte].
const DRY: f64 = 1.7e3;
/// Memory for each unknown of a beam with bladders [byte].
const WET: f64 = 3.5e3;
/// Memory for each pair of a beam cell and a bladder cell in the same segment [byte]. The segment's mean moment couples them all.
const PAIR: f64 = 250.0;
/// Memory for each unknown and each parameter of a sensitivity analysis [byte].
const DERIVATIVE: f64 = 1e3;
/// Set-up time before the first step for each unknown, and for each pair of cells [s].
const SET_UP: [f64; 2] = [5e-5, 1e-5];

/// Estimates from sums over blocks of unknowns with measured constants. They are accurate to a factor of three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResourceEstimate {
    /// Upper bound of the number of unknowns: with inertia, and with the cells of all bladders.
    pub unknowns: f64,
    /// Peak memory [byte].
    pub memory: f64,
    /// Wall time until the first step [s].
    pub set_up_s: f64,
}

impl ResourceEstimate {
    /// Estimates the needs of a run of a case with derivatives by `parameters` of its numbers.
    pub fn estimate(case: &Case, parameters: usize) -> Self {
        let segments = case.segments() as f64;
        let cells = case.mesh.cells_per_segment as f64;
        // position and velocity along and across
        let solid = 4.0 * (segments * cells + 1.0);
        let of_bladder = case.mesh.cells_per_bladder as f64;
        let wet = case.bladders.is_some();
        // mean moment and force of a segment; two bladders with their cells and the junctions at both ends
        let fluid = if wet {
            segments * (2.0 + 2.0 * of_bladder + 4.0)
        } else {
            0.0
        };
        let pairs = if wet { segments * cells * of_bladder } else { 0.0 };
        let unknowns = solid + fluid;
        let each = if wet { WET } else { DRY } + DERIVATIVE * parameters as f64;
        Self {
            unknowns,
            memory: PROGRAM + each * unknowns + PAIR * pairs,
            set_up_s: SET_UP[0] * unknowns + SET_UP[1] * pairs,
        }
    }
}
