//! Structures of several beams, [E104] to [E108]: cut and joined shipped cases, frames, mechanisms, networks over beams, derivatives,
//! growth of the work with the number of beams.
//!
//! Sources: single beams, shooting in exact elastica equations, dynamic stiffness, spectral elements with Radau's method, circuit theory.
//! Reference axes are x to the right and y upwards; in the case they are z and x, so that angles grow counter-clockwise in both.

#[path = "../common/balances.rs"]
mod balances;
#[path = "../common/chance.rs"]
mod chance;
mod derivatives;
#[path = "../differences/mod.rs"]
mod differences;
mod frames;
mod growth;
mod identity;
mod ledgers;
mod mechanisms;
mod modes;
mod networks;
mod plans;
mod rearranged;
#[path = "../common/scene.rs"]
mod scene;
mod touching;
