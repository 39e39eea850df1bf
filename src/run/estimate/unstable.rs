//! Growth of the deflection and compression, which make errors larger.

use crate::run::growth::{Growth, Linear};

/// What makes errors larger than those of a vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unstable {
    /// The factor by which the deflection has grown by itself, at least 1.
    pub grown: f64,
    /// How many times as much as a part of Euler's load a deflection changes, at least 1.
    pub softened: f64,
    /// `N l²/(EI)` of compressions under which short waves grow, 0 where there was none.
    pub crushed: f64,
}

impl Unstable {
    /// Of what was followed in a run of a beam of a length [m].
    pub fn of(growth: &Growth, length: f64, linear: &Linear) -> Self {
        Self {
            grown: growth.amplification(length, linear),
            softened: growth.softened(linear),
            crushed: growth.crushed(),
        }
    }
}
