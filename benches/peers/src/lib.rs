//! slcbeam's integrators beside what could be used instead, on the same equations.
//!
//! [`scene`] has the equations, their start and what is read off; [`own`], [`other`] and [`radau`] solve them; [`abi`] hands them
//! to C, [`export`] to Python. [`prices`] and [`floor`] measure single operations and large systems.

pub mod abi;
pub mod chains;
pub mod export;
pub mod floor;
pub mod other;
pub mod own;
pub mod prices;
pub mod radau;
pub mod random;
pub mod scene;
