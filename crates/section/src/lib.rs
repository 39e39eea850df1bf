//! Coefficients of a beam section with bladders, from the geometry of one unit cell.
//!
//! ```
//! use slcbeam_section::{coefficients::Options, paper};
//!
//! let section = paper::section(0.49, 0.0025, 0.0049);
//! let c = section.coefficients(&Options::default())?;
//! assert!((c.numbers.bending_stiffness_factor - 0.5553).abs() < 2e-4 && c.errors.bending_stiffness_factor < 1e-3);
//! # Ok::<(), slcbeam_section::error::Error>(())
//! ```
//!
//! | room | content |
//! |---|---|
//! | [input], [error] | the user's input; its faults with their location |
//! | [materials] | elastomers by name, with their sources |
//! | [geometry], [mesh] | outlines and their rules; meshes of quadratic triangles, refined by halving |
//! | [element] | shape functions; stiffness without locking [S1] [S2]; the Laplacian |
//! | [cell] | one cell's response to stretch, curvature, lateral strain and pressures [L1] to [L4]; shear [L5] to [L7] |
//! | [level], [coefficients] | compliance of the whole width [C1] [C2]; the model's numbers [K1] to [K3] with errors [R1] |
//! | [finite] | the cell at finite strain: an energy over stretch, curvature and pressures [F1] to [F5] |
//! | [permeability], [picture] | channels [Q1]; deformed cells |
//! | [verify], [paper] | comparison with exact results, and with the paper's printed coefficients |

pub mod cell;
pub mod coefficients;
pub mod dense;
pub mod element;
pub mod error;
pub mod estimate;
pub mod finite;
pub mod geometry;
pub mod input;
pub mod level;
pub mod materials;
pub mod mesh;
pub mod paper;
pub mod permeability;
pub mod picture;
mod sparse;
pub mod three;
pub mod verify;
