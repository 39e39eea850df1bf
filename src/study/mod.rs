//! Studies: many runs that answer one question. This module prints nothing.

pub mod accuracy;
pub mod analysis;
pub mod bands;
pub mod companion;
pub mod compare;
pub mod data;
pub mod effects;
pub mod evaluations;
pub mod fit;
pub mod followed;
pub mod measure;
pub mod optimize;
pub mod refine;
pub mod response;
pub mod search_bounds;
pub mod sense;
pub mod significant;
pub mod stability;
pub mod sweep;
pub mod target;
pub mod uncertain;
pub mod verify;
