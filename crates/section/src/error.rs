//! What can be wrong with a section, and where.

use std::fmt;

/// One rule that a section breaks.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// JSON pointer to the offending value, from the section's root: `/bladders/upper/shape/circle/radius_m`.
    pub place: String,
    /// What is wrong with it, in one sentence.
    pub what: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.what)
    }
}

/// Why there are no coefficients.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// The section breaks these rules, all that were found.
    #[error("{}", .0.iter().map(Fault::to_string).collect::<Vec<_>>().join("\n"))]
    Section(Vec<Fault>),
    /// The cell could not be meshed.
    #[error("the cell could not be meshed: {0}")]
    Mesh(String),
    /// The stiffness matrix could not be factorised.
    #[error("the stiffness matrix of the cell is not positive definite")]
    Singular,
    /// Newton's iteration on the cell at finite strain did not converge.
    #[error("no equilibrium of the cell was found at load factor {factor} after {iterations} iterations")]
    Equilibrium {
        /// The part of the load that was reached, 0 to 1.
        factor: f64,
        /// Iterations made.
        iterations: usize,
    },
    /// The energy at finite strain has no fit that is good enough.
    #[error(
        "the cell's energy at finite strain has no polynomial with an error of at most 1 %: say \"law\": \"linear\""
    )]
    Energy,
}
