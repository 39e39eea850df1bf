//! Studies: many runs to answer one question. Prints nothing.

pub mod accuracy;
pub mod compare;
pub mod target;
pub mod verify;
