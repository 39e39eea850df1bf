//! Outlines of bladders and regions, and the rules they must keep.

pub mod check;
pub mod curve;
mod meeting;
pub mod outline;
mod rules;
