//! Cycles and their stability over parameters.
//!
//! ```text
//! tongue   growth over frequency and amplitude of a shaken root, beside Mathieu's equation
//! cycles   the cycle along one parameter, each found from the one before
//! ```

pub mod cycles;
pub mod tongue;

pub use cycles::{Along, Member, along};
pub use tongue::{Map, Sheet, map};
