//! Cycles and their stability over parameters.
//!
//! ```text
//! tongue  growth over frequency and amplitude of a shaken root, compared with Mathieu's equation
//! cycles  cycles along one parameter; each search starts from the previous cycle
//! ```

pub mod cycles;
pub mod tongue;

pub use cycles::{CycleMember, CyclePath, along};
pub use tongue::{Map, Sheet, map};
