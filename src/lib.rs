//! Elastic beams with rows of fluid-filled bladders joined by slender tubes, after Matia & Gat.

pub mod error;
pub mod case;
pub mod dae;
pub mod run;
