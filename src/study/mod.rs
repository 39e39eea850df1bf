//! Studies: many runs to answer one question. Prints nothing.

pub mod accuracy;
pub mod compare;
pub mod counted;
pub mod effects;
pub mod measure;
pub mod refine;
pub mod stability;
pub mod sweep;
pub mod target;
pub mod uncertain;
pub mod verify;
