//! Studies: many runs that answer one question. This module prints nothing.

pub mod accuracy;
pub mod analysis;
pub mod companion;
pub mod compare;
pub mod counted;
pub mod data;
pub mod effects;
pub mod evaluations;
pub mod fit;
pub mod followed;
pub mod measure;
pub mod optimize;
pub mod refine;
pub mod response;
pub mod sense;
pub mod span;
pub mod stability;
pub mod sweep;
pub mod target;
pub mod uncertain;
pub mod verify;
