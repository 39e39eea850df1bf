//! Exact results of beam and network theory, compared with the results of ordinary cases.
//!
//! ```text
//! problem      a problem with its source, goal and tolerance; selection by name
//! figure       one number of a row: computed, exact, error, observed order, verdict
//! solve        a case from JSON to its samples
//! scene        the beam of unit length, bending stiffness and mass that most problems use
//! fit          growth rates, frequencies and zeros from samples
//! statics      cantilevers under end moment, tip load, uniform load
//! buckling     Euler's column, a column under its own weight, the elastica
//! beck         flutter under a follower load
//! frequencies  free bending vibrations
//! spin_up      Simo and Vu-Quoc's rotating arm
//! mathieu      axial base acceleration
//! floquet      axial base acceleration, from multipliers of the period map
//! hill         the drained published beam under axial shaking, with six modes
//! wet          the nearly unloaded beam with bladders that the network problems use
//! decay        relaxation of chains and rings, dissipation
//! kirchhoff    a steady network as resistors
//! ducts        permeabilities of cross-sections
//! section      the cell from which coefficients of a section are computed
//! ```

mod beck;
mod buckling;
mod decay;
mod ducts;
mod figure;
mod fit;
mod floquet;
mod frequencies;
mod hill;
mod kirchhoff;
mod mathieu;
mod problem;
mod scene;
mod section;
mod solve;
mod spin_up;
mod statics;
mod wet;

pub use figure::{ErrorMeasure, ExactFigure};
pub use problem::{SolvedProblem, choose};

/// Every row, in the order of the report.
pub fn rows() -> Vec<SolvedProblem> {
    let mut all = statics::rows();
    all.extend(buckling::rows());
    all.extend(beck::rows());
    all.extend(frequencies::rows());
    all.extend(spin_up::rows());
    all.extend(mathieu::rows());
    all.extend(floquet::rows());
    all.extend(hill::rows());
    all.extend(decay::rows());
    all.extend(kirchhoff::rows());
    all.extend(ducts::rows());
    all.extend(section::rows());
    all
}
