//! Studies: many runs to answer one question. Prints nothing.

pub mod verify;
