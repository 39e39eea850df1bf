//! Outlines of bladders and regions, and the rules they must keep.

pub mod curve;
pub mod outline;
