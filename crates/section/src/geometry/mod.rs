//! Outlines of bladders and regions, and their rules.

pub mod check;
pub mod curve;
mod meeting;
pub mod outline;
mod rules;
