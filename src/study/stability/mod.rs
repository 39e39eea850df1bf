//! Cycles and their stability over parameters.
//!
//! ```text
//! tongue  growth over frequency and amplitude of a shaken root, compared with Mathieu's equation
//! cycles  cycles along one parameter
//! branch  follows a branch of cycles through folds
//! backbone  cycles at the resonance of the drive
//! special_points  folds and losses of stability of a branch
//! ```

mod backbone;
mod branch;
pub mod cycles;
pub mod special_points;
pub mod tongue;

pub use backbone::backbone;
pub use cycles::{CycleMember, CyclePath, MemberKind, PathRequest, along};
pub use tongue::{Map, Sheet, map};
