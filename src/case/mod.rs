//! What the user wrote.
pub mod schema;
pub mod signals;
pub mod profile;
