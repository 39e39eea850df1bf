//! Faults of a section, and errors of its solution.

use std::fmt;

/// A violated rule of a section.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// JSON pointer to the faulty value from the section's root: `/bladders/upper/shape/circle/radius_m`.
    pub place: String,
    /// Description of the fault, in one sentence.
    pub what: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.what)
    }
}

/// Reasons for missing coefficients.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// The section violates rules; all faults found.
    #[error("{}", .0.iter().map(Fault::to_string).collect::<Vec<_>>().join("\n"))]
    Section(Vec<Fault>),
    /// The cell could not be meshed.
    #[error("the cell could not be meshed: {0}")]
    Mesh(String),
    /// The stiffness matrix could not be factorized.
    #[error("the stiffness matrix of the cell is not positive definite")]
    Singular,
    /// Newton's iteration on the cell at finite strain did not converge.
    #[error("no equilibrium of the cell was found at load factor {factor} after {iterations} iterations")]
    Equilibrium {
        /// Fraction of the load that was reached, 0 to 1.
        factor: f64,
        /// Number of iterations.
        iterations: usize,
    },
    /// No polynomial fits the energy at finite strain with sufficient accuracy.
    #[error(
        "no polynomial fits the cell's energy at finite strain with an error of at most 1 %; use \"law\": \"linear\""
    )]
    Energy,
}
