//! Coefficients of a beam section with bladders, from the geometry of one unit cell.

pub mod cell;
pub mod coefficients;
pub mod dense;
pub mod element;
pub mod error;
pub mod estimate;
pub mod geometry;
pub mod input;
pub mod level;
pub mod mesh;
pub mod permeability;
mod sparse;
pub mod verify;
