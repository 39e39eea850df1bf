//! Elastic beams with rows of fluid-filled bladders joined by slender tubes, after Matia & Gat.

pub mod error;
pub mod case;
pub mod model;
pub mod discrete;
pub mod dae;
pub mod sundials;
pub mod run;
pub mod output;
pub mod cli;
